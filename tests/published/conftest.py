"""Rows of the published table: what a test computes for one is held to it, and it to the test."""

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

# Tests are collected by importlib.
sys.path.insert(0, str(Path(__file__).parents[1] / "oracles"))

from published_rows import BASES, Row, holds
from wrong_by_half import Exercised, name_of, wrong_by_half

from cqdd_design.errors import CqddError

Compared = Callable[..., None]


@pytest.fixture
def compared(record_property: Callable[[str, object], None]) -> Compared:
    """Hold a result to its row, and see that the row falls when a function is wrong by half.

    The functions are those that the row validates: each in turn gives 1.5 times its result, and
    the comparison must then fail. `docs/validation.md` is written from what is recorded here.
    """

    def check(row: Row, ours: Callable[[], float], *exercised: Exercised) -> None:
        assert row["basis"] in BASES
        found = ours()
        assert holds(row, found), f"{row['quantity']} of {row['case']}: {found:.9g}"
        assert exercised, "a row names what it validates"
        for function in exercised:
            with wrong_by_half(function):
                assert _falls(row, ours), f"blind to {name_of(function)}"
        record_property("published", (row, float(found), tuple(map(name_of, exercised))))

    return check


def _falls(row: Row, ours: Callable[[], float]) -> bool:
    """Whether a result is off its row, or refused on the way there."""
    try:
        return not holds(row, ours())
    except CqddError:
        return True
