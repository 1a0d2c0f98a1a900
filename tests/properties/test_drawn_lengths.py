"""Lengths that nothing fixes but the machine's scale are told in hundredths of a millimetre."""

import re
from pathlib import Path

import pytest

from cqdd_design.design import requirements_from_mapping
from cqdd_design.exporting.job import ExportJob
from cqdd_design.exporting.sheets.canvas import render
from cqdd_design.exporting.sheets.sheet_files import sheets_of
from cqdd_design.geometry.scale import Unit, millimetre_unit
from cqdd_design.machine import resolve
from cqdd_design.sizing.size import size

TOLERANCED = re.compile(r"^(\d+ . )?[ØRM]?(\d+\.?\d*) ?(±0\.(05|[1-9])|[a-zA-Z]+\d+)\b")
"""A length with a general tolerance or an ISO 286 zone, as sheets tell it."""
WHOLE = re.compile(r"^\d+(\.\d{1,2})?$")


@pytest.mark.parametrize(
    "asked",
    [
        {"outer_diameter": "61 mm"},
        {"outer_diameter": "66 mm", "motor": "CubeMars RI80 V2.0 KV75"},
    ],
    ids=["in the stator", "inrunner"],
)
def test_sheets_of_a_scaled_machine_tell_hundredths(asked):
    """A ring of 55.5 mm had a housing of Ø115.0417 h7 and a shaft of 27.5108 ±0.05."""
    torques = {"ratio": 14, "peak_torque": "12 N*m", "continuous_torque": "1.2 N*m"}
    machine = resolve(size(requirements_from_mapping(torques | asked)).design)
    assert machine.layout.unit != pytest.approx(1e-3)
    told = []
    for _, title, sheet in sheets_of(ExportJob(machine, Path(), lambda _: None)):
        for label in render(sheet).labels:
            found = TOLERANCED.match(label.text)
            if found is not None:
                told.append((title, label.text, found[2]))
    assert len(told) > 30
    assert [one for one in told if not WHOLE.match(one[2])] == []


def test_so_many_units_are_a_length_as_drawn():
    unit = Unit(millimetre_unit(55.5e-3))
    assert unit == pytest.approx(55.5e-3 / 72.0, rel=1e-12)
    for count in (0.15, 1.0, 2.5, 12.0):
        assert count * unit == unit * count
        assert count * unit == pytest.approx(count * float(unit), abs=0.5e-5 + 1e-12)
        assert round(1e5 * (count * unit), 6) % 1.0 == 0.0
