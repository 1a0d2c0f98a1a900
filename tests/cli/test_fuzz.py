"""A small part of the fuzz campaign of `tools/fuzz`: some hundred cases of every cheap group."""

import os
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="cases run in forked processes")
sys.path.insert(0, str(Path(__file__).parents[2]))

CASES = {
    "values": 25,
    "bytes": 12,
    "units": 4,
    "motors": 30,
    "maps": 30,
    "calibrations": 30,
    "tables": 30,
    "archives": 40,
    "networks": 3,
    "manifests": 20,
}


@pytest.mark.parametrize("group", CASES)
def test_cases_keep_what_is_promised(group):
    if group == "manifests":
        pytest.importorskip("pyarrow")
    from tools.fuzz.__main__ import campaign

    outcomes = campaign(group, 0, range(CASES[group]))
    assert [broken for _, outcome in outcomes for broken in outcome.broken] == []


def test_a_broken_promise_is_told():
    from tools.fuzz.case import Case, run

    def bug():
        raise ValueError("no error of ours")

    assert any("Traceback" in broken for broken in run(Case(call=bug)).broken)
    assert run(Case(arguments=("check", "nothing.toml", "--json"))).broken == ()
    assert run(Case(arguments=("check", "nothing.toml"))).code == 2
    hungry = run(Case(call=lambda: len(b"x" * 1_100_000_000)))
    assert any(" MB" in broken for broken in hungry.broken)


def test_the_same_case_is_drawn_again():
    from tools.fuzz.__main__ import drawn

    first, again = (drawn("values", 3, 14) for _ in range(2))
    assert first == again
    assert first != drawn("values", 4, 14)
