"""Columns and pins are put in when they have something to stand in."""

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


PINS = {"reducer.ring_type": "pinwheel", "reducer.eccentricity": "1 mm"}
ROLLERS = PINS | {"reducer.ring.roller_diameter": "7 mm", "reducer.ring_pin_diameter": "4 mm"}


@pytest.mark.parametrize("change", [PINS, ROLLERS], ids=["pins", "rollers"])
@pytest.mark.parametrize("discs", [1, 2])
def test_pins_of_a_ring_come_into_pockets_that_are_there(
    change: dict[str, str], discs: int
) -> None:
    # They stood round a disc, held by nothing, and the ring came over them much later.
    paper = resolve(load_design(DESIGNS / "cqdd-10.toml"))
    machine = paper.changed(change | {"reducer.disc_count": discs})
    steps, whole = taken_apart(machine.design, machine.parts)
    assert whole
    order = [step.moved[0].part.name for step in reversed(steps)]
    last = len(order) - order[::-1].index("ring pin") - 1
    assert order.index("ring") < order.index("ring pin")
    assert last < order.index("ring clamp")


def test_output_pins_come_in_between_cap_and_plate() -> None:
    # They lay in the housing before the cap that they stand in.
    paper = resolve(load_design(DESIGNS / "cqdd-10.toml"))
    plain = {"reducer.output_pins.diameter": "3.5 mm"}
    machine = paper.changed(plain | {"reducer.disc_count": 3})
    steps, whole = taken_apart(machine.design, machine.parts)
    assert whole
    order = [step.moved[0].part.name for step in reversed(steps)]
    for there in ("carrier cap", "disc 1", "disc 2", "disc 3"):
        assert order.index(there) < order.index("dowel pin")
    assert order.index("dowel pin") == order.index("carrier plate") - 1


@pytest.mark.parametrize("discs", [1, 2, 3])
def test_a_stator_is_bonded_on_a_housing_that_is_there(discs: int) -> None:
    # It lay loose in the bell before the housing, whose register it is bonded on.
    paper = resolve(load_design(DESIGNS / "cqdd-10.toml"))
    plain = {"reducer.output_pins.diameter": "3.5 mm"}
    machine = paper.changed(plain | {"reducer.disc_count": discs})
    steps, whole = taken_apart(machine.design, machine.parts)
    assert whole
    single = [step for step in reversed(steps) if not step.is_unit]
    order = [step.moved[0].part.name for step in single]
    stator = single[order.index("motor stator")]
    assert stator.unit == "unit of the housing" or order.index("housing") < order.index(
        "motor stator"
    )
