"""How many examples a property test draws."""

from __future__ import annotations

import os

#: Set by the tests' own conftest: "deep" under ``pytest -m deep``, "daily" otherwise.
DEPTH = "CQDD_TEST_DEPTH"


def examples(count: int) -> int:
    """`count` under ``pytest -m deep``; a quarter of it every day, but no fewer than five."""
    return count if os.environ.get(DEPTH) == "deep" else max(5, count // 4)
