"""Whether mere chance finds what `size` refuses: random designs of the same space, judged whole.

    python benchmarks/sizing_refused.py [--seeds 14,22,35] [--discs 1-3]

The seeds are those of `sizing_yes.py` that it refused. For each number of discs and each of the
two usual materials 800 designs are drawn, at random and in random steps from the strongest of them
(`tests/oracles/brute_search.py`, which uses nothing of `cqdd_design.sizing`), once with the
clearances of a shop and once with wide ones. The one with the most reserve is judged by the whole
verdict; a row says what it is short of, the tightest line first. Exit code 1 where one meets
everything.
"""

from __future__ import annotations

import argparse
import sys
import time
import tomllib
from pathlib import Path

import numpy as np

REPOSITORY = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(REPOSITORY / "tests" / "oracles"), str(REPOSITORY / "benchmarks")]

from brute_search import Space, drawn_design, reserve, strongest_place  # noqa: E402
from sizing_yes import Row, numbers, of_seed  # noqa: E402

from cqdd_design.machine import resolve  # noqa: E402
from cqdd_design.verdict import judge  # noqa: E402

LIKE = "CubeMars RO100 KV55"
MATERIALS = ("AISI 4140 Q&T 540C", "AISI 52100 / 100Cr6 hardened")
CLEARANCES = (("8 um", "28 um"), ("16 um", "56 um"))


def asked_of(row: Row) -> Space:
    """The space of a row of requirements, of one disc in the first material."""
    words = [one.removeprefix("--") for one in row.options]
    asked = dict(zip(words[::2], words[1::2], strict=True))
    number = {key: float(text.split()[0]) for key, text in asked.items() if "motor" not in key}
    tables: dict[str, object] = {"environment": {"ambient": asked["ambient"]}}
    if row.motor:
        tables["motor"] = tomllib.loads(row.motor)
    return Space(
        int(number["ratio"]),
        1e-3 * number["outer-diameter"],
        1e-3 * number["length"],
        1,
        MATERIALS[0],
        number["peak-torque"],
        number["continuous-torque"],
        number["life"],
        asked["continuous-speed"],
        asked.get("motor", LIKE),
        tables,
    )


def looked_at(space: Space) -> tuple[str, bool]:
    """What is told of the strongest design of a space, and whether it meets everything."""
    place = strongest_place(space, seed=1)
    design = None if place is None else drawn_design(space, place)
    if design is None:
        return "nothing that chance draws fits", False
    with np.errstate(all="ignore"):
        judged = judge(resolve(design))
    short = [line for line in judged.limits if line.status in {"fail", "unknown"}]
    told = ", ".join(
        f"{line.id} {line.margin:.2f}" if line.known else line.id for line in short[:4]
    )
    return f"loads {reserve(design):.2f}; {told or 'MEETS EVERYTHING'}", judged.meets == "yes"


def main() -> None:
    """Print a row after another."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--seeds", default="14,22,35,43,44,48,53,56")
    parser.add_argument("--discs", default="1-3")
    given = parser.parse_args()
    found = 0
    for seed in numbers(given.seeds):
        asked = asked_of(of_seed(seed))
        for discs in numbers(given.discs):
            for material in MATERIALS:
                for clearances in CLEARANCES:
                    began = time.perf_counter()
                    space = asked._replace(
                        disc_count=discs, material=material, clearances=clearances
                    )
                    text, meets = looked_at(space)
                    found += meets
                    took = time.perf_counter() - began
                    kind = "hard" if material == MATERIALS[1] else "soft"
                    print(
                        f"seed {seed:2d}, {discs} discs, {kind}, {clearances[1]}: {took:4.0f} s  "
                        f"{text}",
                        flush=True,
                    )
    print(f"{found} that meet everything")
    sys.exit(found > 0)


if __name__ == "__main__":
    main()
