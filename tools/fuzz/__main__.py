"""Run the fuzz campaign, or one case of it again.

    python -m tools.fuzz                                  # all groups, some 7,900 cases
    python -m tools.fuzz --group designs --seed 7         # one group with another seed
    python -m tools.fuzz --group designs --seed 7 --case 41 --show    # one case, with its files
    python -m tools.fuzz --properties                     # the property tests, at random
    python -m tools.fuzz --properties tests/properties/test_units.py     # those of one file

Every case is drawn from its group, seed and number alone, and runs in a process of its own, forked
from one that has its imports done. What must hold: an exit code of docs/cli.md, never that of a
bug; no traceback and no control character on the terminal; one JSON document without nan where one
is asked for; at most 60 s (of a processor) and 1 GB. Kernels are compiled before the first case.
"""

from __future__ import annotations

import argparse
import importlib
import os
import random
import subprocess
import sys
import time
import warnings
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from tools.fuzz.case import Case, Outcome, run
from tools.fuzz.groups import GROUPS

_PRELOADED = (
    *("numpy", "scipy.optimize", "numba", "pint", "tomlkit", "pyarrow.parquet", "ezdxf"),
    *("cqdd_design.cli.main", "cqdd_design.design", "cqdd_design.exporting"),
    *("cqdd_design.machine.contact_analysis", "cqdd_design.actuator.simulate"),
)


def drawn(group: str, seed: int, number: int) -> Case:
    """A case by its name."""
    return GROUPS[group].draw(random.Random(f"{group} {seed} {number}"))


def campaign(group: str, seed: int, numbers: Sequence[int]) -> list[tuple[int, Outcome]]:
    """Run cases of a group, telling each that breaks a promise with the line that repeats it."""
    found = []
    for number in numbers:
        outcome = run(drawn(group, seed, number))
        found.append((number, outcome))
        for broken in outcome.broken:
            print(f"python -m tools.fuzz --group {group} --seed {seed} --case {number}: {broken}")
            sys.stdout.flush()
    return found


def preload(*, compiled: bool = False) -> None:
    """Compile and import once what the cases need."""
    script = Path(__file__).resolve().parents[2] / "tests" / "compile_kernels.py"
    for half in () if compiled else ("elastic", "moving", "gearboxes"):
        subprocess.run([sys.executable, str(script), half], check=True)
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    for name in _PRELOADED:
        importlib.import_module(name)


def main() -> int:
    """Run the campaign; the exit code is 1 where a promise was broken."""
    asked = _parser().parse_args()
    if asked.properties:
        command = [sys.executable, "-m", "pytest", "-q", "--hypothesis-profile=random"]
        return subprocess.call([*command, *(asked.rest or ["tests/properties"])])
    warnings.simplefilter("ignore")  # of forks beside threads, and names twice in an archive
    preload(compiled=asked.compiled)
    failed = 0
    for name in asked.group or GROUPS:
        numbers = range(asked.cases or GROUPS[name].cases)
        if asked.case is not None:
            numbers = range(asked.case, asked.case + 1)
        if asked.show:
            _show(drawn(name, asked.seed, numbers[0]))
        began = time.monotonic()
        found = campaign(name, asked.seed, numbers)
        failed += sum(bool(outcome.broken) for _, outcome in found)
        _tell(name, found, time.monotonic() - began)
    return int(failed > 0)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tools.fuzz", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("--group", action="append", choices=list(GROUPS))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--cases", type=int, help="of each group; default its own number")
    parser.add_argument("--case", type=int, help="this one alone")
    parser.add_argument("--compiled", action="store_true", help="kernels are, as in a test's run")
    parser.add_argument("--show", action="store_true", help="print the case before it runs")
    parser.add_argument("--properties", action="store_true", help="hypothesis at random instead")
    parser.add_argument("rest", nargs="*", help="files of property tests")
    return parser


def _show(case: Case) -> None:
    print(" ".join(map(repr, case.arguments)) or case.call, dict(case.environment) or "")
    for name, content in case.files.items():
        print(f"--- {name!r}, {len(content)} bytes\n{content[:3000]!r}")


def _tell(name: str, found: Sequence[tuple[int, Outcome]], seconds: float) -> None:
    codes = Counter(outcome.code for _, outcome in found)
    slowest = max(found, key=lambda one: one[1].seconds)
    largest = max(found, key=lambda one: one[1].memory)
    told = ", ".join(f"{code}: {count}" for code, count in sorted(codes.items()))
    print(
        f"{name}: {len(found)} cases in {seconds:.0f} s, exit codes {told}; "
        f"longest {slowest[1].seconds:.1f} s (case {slowest[0]}), "
        f"most {largest[1].memory / 1e6:.0f} MB (case {largest[0]}), "
        f"{sum(bool(outcome.broken) for _, outcome in found)} broken"
    )
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
