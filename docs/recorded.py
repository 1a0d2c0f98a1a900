"""What tests recorded for the pages of docs/: from a run of this very tree, or run for it."""

from __future__ import annotations

import contextlib
import io
import os
import pickle
from functools import cache
from pathlib import Path
from typing import Any

TESTS = Path(__file__).resolve().parents[1] / "tests"


class _Seen:
    """Pytest plugin: collects what tests recorded about their comparisons, with file and name."""

    def __init__(self) -> None:
        self.rows: list[tuple[str, str, tuple[Any, ...]]] = []

    def pytest_runtest_logreport(self, report: object) -> None:
        if getattr(report, "when", "") == "call":
            file = Path(getattr(report, "nodeid", "").partition("::")[0]).name
            properties = getattr(report, "user_properties", [])
            self.rows += [(file, name, tuple(value)) for name, value in properties]


@cache
def rows_of(test: str) -> list[tuple[str, str, tuple[Any, ...]]]:
    """What the tests of a file or folder recorded; several pages ask for some.

    A run of the daily tests of this very tree, in which they passed, has left it in the folder that
    CQDD_TEST_RUNS names; else they are run.
    """
    before = recorded_before(test)
    if before is not None:
        return before
    import pytest

    seen = _Seen()
    quiet = io.StringIO()
    place = str(TESTS / test)
    with contextlib.redirect_stdout(quiet):
        code = pytest.main([place, "-q", "-p", "no:cacheprovider", "-p", "no:xdist"], [seen])
    if code != 0:
        raise SystemExit(f"{test} does not pass:\n{quiet.getvalue()}")
    return seen.rows


def recorded_before(test: str) -> list[tuple[str, str, tuple[Any, ...]]] | None:
    """The same from an earlier run; None where it has not all files."""
    place = Path(os.environ.get("CQDD_TEST_RUNS", "")) / "recorded.pickle"
    if not os.environ.get("CQDD_TEST_RUNS") or not place.is_file():
        return None
    known = pickle.loads(place.read_bytes())
    folder = TESTS / test
    files = sorted(folder.glob("test_*.py")) if folder.is_dir() else [folder]
    names = [file.relative_to(TESTS).as_posix() for file in files]
    if not all(name in known for name in names):
        return None
    return [(Path(name).name, said, tuple(value)) for name in names for said, value in known[name]]


def records(name: str, *tests: str) -> list[tuple[Any, ...]]:
    """What the tests of some files recorded under a name, from a run of them."""
    found = []
    for test in tests:
        folder, _, file = test.rpartition("/")
        # A page has all of tests/published, which is run once for those that have some of it.
        rows = rows_of(folder if folder == "published" else test)
        found += [value for of, said, value in rows if of == file and said == name]
    return found
