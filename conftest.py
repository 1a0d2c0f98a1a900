"""What every run of pytest needs to know of doctests: which of them take long."""

from __future__ import annotations

import pytest
from _pytest.doctest import DoctestItem

#: Examples of the library that judge, mesh, search or fit: seconds each, so that they are deep.
DEAR = {
    f"cqdd_design.library.{name}"
    for name in (
        "actuators.calibrate",
        "designs.size",
        "gearboxes.compare",
        "gearboxes.inertia",
        "judging.analyse",
        "judging.check",
        "writing.report",
    )
}


def pytest_itemcollected(item: pytest.Item) -> None:
    """Mark the dear ones."""
    if isinstance(item, DoctestItem) and item.name in DEAR:
        item.add_marker("deep")
