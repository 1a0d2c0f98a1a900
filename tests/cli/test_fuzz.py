"""A small part of the fuzz campaign of `tools/fuzz`: one case of every cheap group."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="cases run in forked processes")
REPOSITORY = Path(__file__).resolve().parents[2]

CHEAP = (
    *("values", "bytes", "units", "motors", "maps", "calibrations", "tables", "archives"),
    *("networks", "manifests"),
)


def fresh(*arguments: str) -> subprocess.CompletedProcess[str]:
    """Run Python anew: a forked case weighs at least what the process weighs that it comes from."""
    path = os.pathsep.join(p for p in (str(REPOSITORY), os.environ.get("PYTHONPATH")) if p)
    return subprocess.run(
        [sys.executable, *arguments],
        cwd=REPOSITORY,
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        encoding="utf-8",
        check=False,
    )


def test_cases_keep_what_is_promised():
    groups = [word for name in CHEAP for word in ("--group", name)]
    # Among other workers, kernels are compiled before they start.
    ready = ["--compiled"] if "PYTEST_XDIST_WORKER" in os.environ else []
    done = fresh("-m", "tools.fuzz", "--seed", "0", "--cases", "1", *ready, *groups)
    assert done.returncode == 0, done.stdout + done.stderr
    told = done.stdout.splitlines()
    assert [line.partition(":")[0] for line in told] == list(CHEAP)
    assert all(line.endswith(" 0 broken") and ": 1 cases" in line for line in told)


PROMISES = """
from tools.fuzz.case import Case, run

def bug():
    raise ValueError("no error of ours")

assert any("Traceback" in broken for broken in run(Case(call=bug)).broken)
assert run(Case(arguments=("check", "nothing.toml", "--json"))).broken == ()
assert run(Case(arguments=("check", "nothing.toml"))).code == 2
hungry = run(Case(call=lambda: len(b"x" * 1_100_000_000)))
assert any(" MB" in broken for broken in hungry.broken)
"""


@pytest.mark.deep
def test_a_broken_promise_is_told():
    done = fresh("-c", PROMISES)
    assert done.returncode == 0, done.stderr


def test_the_same_case_is_drawn_again():
    sys.path.insert(0, str(REPOSITORY))
    from tools.fuzz.__main__ import drawn

    first, again = (drawn("values", 3, 14) for _ in range(2))
    assert first == again
    assert first != drawn("values", 4, 14)
