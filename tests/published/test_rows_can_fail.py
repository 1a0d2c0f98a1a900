"""The table of published numbers as a whole, and what holds its rows to the functions they name."""

from __future__ import annotations

import csv
from collections.abc import Callable

import pytest
from published_rows import BASES, TABLE, Row
from wrong_by_half import wrong_by_half

from cqdd_design.gearbox import output_pins, rigid
from cqdd_design.planetary.kinematics import PlanetaryTeeth, speeds
from cqdd_design.planetary.tooth_geometry import GearPair

with TABLE.open(encoding="utf-8", newline="") as _file:
    ROWS = list(csv.DictReader(_file))


def _torque() -> float:
    return float(output_pins.single_shear_torque_per_pin(4e-3, 241e6, 19.5e-3))


def test_labels_tell_rows_apart() -> None:
    labels = [(row["group"], row["case"], row["quantity"]) for row in ROWS]
    assert len(set(labels)) == len(labels)
    assert {row["basis"] for row in ROWS} == set(BASES)
    assert all(row["source"] for row in ROWS)


def test_what_is_held_wider_than_half_a_per_cent_says_why() -> None:
    loose = [row for row in ROWS if float(row["tol"]) > 5e-3 * abs(float(row["value"]))]
    told = {"printed": "read from a figure", "second": "held to", "trend": "Chosen here"}
    for row in loose:
        assert row["basis"] == "not met" or told[row["basis"]] in row["note"], row


@pytest.mark.parametrize("blind", [rigid.ring_forces, GearPair.virtual_teeth])
def test_a_row_that_does_not_use_what_it_names_is_refused(
    blind: object, compared: Callable[..., None]
) -> None:
    row: Row = {"basis": "printed", "value": "59.05", "tol": "0.01", "case": "", "quantity": ""}
    with pytest.raises(AssertionError, match="blind to"):
        compared(row, _torque, blind)


def test_wrong_by_half_reaches_functions_methods_and_properties_and_ends() -> None:
    pair = GearPair(17, 31, 1e-3, 12e-3)
    teeth, right = PlanetaryTeeth(16, 28, 28, 74), _torque()
    with wrong_by_half(output_pins.single_shear_torque_per_pin):
        assert _torque() == pytest.approx(1.5 * right)
    with wrong_by_half(GearPair.reference_diameter):
        assert pair.reference_diameter(17) == pytest.approx(1.5 * 17e-3)
    with wrong_by_half(GearPair.virtual_teeth):
        assert pair.virtual_teeth == pytest.approx((1.5 * 17, 1.5 * 31))
    with wrong_by_half(speeds):
        assert speeds(teeth, 5.625).carrier == pytest.approx(1.5)
    assert _torque() == right
    assert pair.virtual_teeth == pytest.approx((17, 31))
    assert speeds(teeth, 5.625).carrier == pytest.approx(1.0)
