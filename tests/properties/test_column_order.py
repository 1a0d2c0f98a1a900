"""Columns of a carrier are put in when they have something to stand on."""

from __future__ import annotations

from pathlib import Path

import pytest

from cqdd_design.design import load_design
from cqdd_design.machine import resolve
from cqdd_design.solids.apart import taken_apart

DESIGNS = Path(__file__).resolve().parents[2] / "designs"
COLUMNS = {
    "reducer.carrier.joint": "columns",
    "reducer.carrier.column_count": 5,
    "reducer.carrier.column_diameter": "5 mm",
    "reducer.output_pins.count": 5,
}


@pytest.mark.parametrize("name", ["cqdd-10", "reference-s"])
def test_columns_come_between_plate_and_cap_through_discs_that_are_there(name: str) -> None:
    machine = resolve(load_design(DESIGNS / f"{name}.toml")).changed(COLUMNS)
    steps, whole = taken_apart(machine.design, machine.parts)
    assert whole
    order = [step.moved[0].part.name for step in reversed(steps)]
    at = order.index("carrier column")
    first, last = sorted(order.index(one) for one in ("carrier cap", "carrier plate"))
    assert first < at
    assert at == last - 1
    assert order.index("disc") < at < order.index("column screw")
