"""The bearings at the ends of the eccentric shaft: named, by load, and clear of its shoulder."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cqdd_design.catalog.bearings import bearings, find_bearing
from cqdd_design.design import Requirements, load_design
from cqdd_design.errors import GeometryError
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.end_bearing import on_stronger_ends
from cqdd_design.sizing.kinds import lightest
from cqdd_design.sizing.shafts import weak_lines, with_sound_ends
from cqdd_design.sizing.spaces import Found
from cqdd_design.sizing.verified import new_hunt
from cqdd_design.solids import shaft_bearings as shaft_bearings_module
from cqdd_design.solids.proportions import shaft_bearings
from cqdd_design.solids.shaft_bearings import (
    ShaftRoom,
    fitting_support_bearings,
    named_support_bearing,
)
from cqdd_design.verdict.shaft_lines import shaft_lines

ROOT = Path(__file__).resolve().parents[2]
KEY = "reducer.support_bearing.designation"
ROOM = ShaftRoom(10.5e-3, 0.84e-3, 24e-3, 24e-3)


@pytest.fixture(scope="module")
def machine() -> Machine:
    return resolve(load_design(ROOT / "docs" / "gallery" / "three-discs-9.toml"))


@pytest.mark.parametrize("shoulder", np.arange(5e-3, 30e-3, 0.83e-3))
def test_no_shoulder_reaches_the_outer_ring(shoulder: float) -> None:
    """Which turns against it; the cage between the rings lies deeper than their faces."""
    room = ShaftRoom(shoulder, 0.08 * shoulder, 3.0 * shoulder, 3.0 * shoulder)
    for one in fitting_support_bearings(room):
        assert 2.0 * one.lip_radius >= shoulder + 0.4e-3 - 1e-9
    wide = ShaftRoom(8.2e-3, 0.4e-3, 20e-3, 20e-3)
    assert not wide.misfit(find_bearing("SKF 618/6"))
    assert "would rub" in wide.misfit(find_bearing("SKF 618/4"))


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("6800", "smaller bore"),
        ("SKF * 629", "is 26 mm outside"),
        ("SKF 623", "would rub there"),
        ("THK RB3010", "crossed roller bearing"),
    ],
)
def test_what_does_not_go_there_is_refused_with_its_reason(name: str, why: str) -> None:
    with pytest.raises(GeometryError, match=why) as caught:
        named_support_bearing(find_bearing(name), ROOM)
    assert '"auto"' in caught.value.message
    assert KEY.removeprefix("reducer.") in caught.value.message


def test_any_that_fits_can_be_named_and_is_drawn(machine: Machine) -> None:
    fitting = shaft_bearings(machine.design, machine.cam)
    assert len(fitting) > 3
    assert machine.seats[0] == fitting[0]
    for one in fitting[1:3]:
        other = machine.changed({KEY: one.bearing.designation})
        assert other.seats[0] == one
        assert other.layout.shaft.support == one
        (part,) = (part for part in other.parts if part.name == "shaft bearing")
        assert part.designation == one.bearing.designation


def test_a_thin_bearing_is_told_which_other_bears(machine: Machine) -> None:
    """The largest bore that fits is a thin ring of 340 N, where one of 9 mm less high bears."""
    thin = machine.changed({KEY: "SKF 618/9"})
    (line,) = (one for one in shaft_lines(thin) if one.id == "SUPPORT-STATIC")
    assert line.status == "fail"
    told = re.search(r"set support_bearing.designation to '(.+?)'", line.remedy)
    assert told is not None
    cured = thin.changed({KEY: told[1]})
    lines = {one.id: one.status for one in shaft_lines(cured)}
    assert lines["SUPPORT-STATIC"] == lines["SUPPORT-LIFE"] == lines["SHAFT-STRENGTH"] == "pass"
    for other in on_stronger_ends(thin):
        assert (other.seats[0].bearing.static_rating or 0.0) > 340.0
        assert other.contact is thin.contact


def test_a_search_takes_another_bearing_and_leaves_the_gearbox(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What is found with thin bearings keeps its sizes on others that bear what it asks."""
    hunt = new_hunt(Requirements(ratio=9, peak_torque="30 N*m"), lambda _: None, None, None, "mass")
    found = lightest(hunt)
    assert isinstance(found, Found)
    named = found.sized.machine.seats[0].bearing
    weaker = replace(named, static_rating=0.3 * (named.static_rating or 0.0))
    table = {
        name: row for name, row in bearings().items() if row.bore_diameter < named.bore_diameter
    } | {named.designation: weaker}
    monkeypatch.setattr(shaft_bearings_module, "bearings", lambda: table)
    machine = resolve(found.sized.design, found.sized.machine.motor)
    assert machine.seats[0].bearing == weaker
    short = {line.id for line in weak_lines(machine)}
    assert short
    assert short <= {"SUPPORT-STATIC", "SUPPORT-LIFE"}
    sound = with_sound_ends(replace(found, sized=replace(found.sized, machine=machine)))
    assert not sound.weak
    assert sound.sized.design.reducer.support_bearing.designation != "auto"
    plain = sound.sized.design.replacing({KEY: "auto"})
    assert plain.reducer == found.sized.design.reducer
