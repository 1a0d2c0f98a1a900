"""A bond that gives way asks for a thicker shaft: in a wider cam bearing, or with less throw."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest

from cqdd_design.design import load_design, requirements_from_mapping
from cqdd_design.machine import Machine, resolve
from cqdd_design.results import Check
from cqdd_design.sizing import verified
from cqdd_design.sizing.agreement import agreed
from cqdd_design.sizing.eased import given
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.shafts import SHAFT, stronger_shaft, turn_to_less_throw, weak_lines
from cqdd_design.sizing.spaces import FITS, MATERIALS, USUAL_FIT, Space
from cqdd_design.sizing.stage_tables import stage_tables
from cqdd_design.verdict.joint_lines import bell_line
from cqdd_design.verdict.retention_lines import retention_lines, shoulder_on_shaft
from cqdd_design.verdict.shaft_lines import shaft_lines

GALLERY = Path(__file__).resolve().parents[2] / "docs" / "gallery"


@pytest.fixture(scope="module")
def machine() -> Machine:
    """Three discs on a shaft of 9 mm, as thick as its bond needs."""
    return resolve(load_design(GALLERY / "three-discs-9.toml"))


def asked(machine: Machine, line: Check) -> Hunt:
    """A hunt that has found the bond of a machine too weak."""
    requirements = machine.given.requirements
    hunt = Hunt(requirements, None, None, print, stage_tables(requirements.ratio), "mass")
    space = Space(3, machine.design.reducer.disc_material, "", USUAL_FIT)
    stronger_shaft(
        hunt, SimpleNamespace(space=space, sized=SimpleNamespace(machine=machine)), [line]
    )
    return hunt


def weaker(machine: Machine, margin: float) -> Check:
    line = bell_line(machine, None)
    assert line.value is not None
    assert line.limit is not None
    return replace(line, value=line.limit / margin)


def test_less_eccentricity_leaves_room_for_the_next_bearing(machine: Machine) -> None:
    """9 mm at a margin of 0.9 ask for 9.49 mm, so for a journal of 10 mm."""
    assert machine.seats[0].bearing.bore_diameter == pytest.approx(9e-3)
    line = weaker(machine, 0.9)
    assert line.status == "fail"
    hunt = asked(machine, line)
    bore = machine.cam.bore_diameter
    assert hunt.least_bore > bore
    assert turn_to_less_throw(hunt)
    assert hunt.least_bore < bore
    throw = machine.design.reducer.eccentricity
    assert 0.6 * throw < hunt.most_throw < throw
    slim = machine.changed({"reducer.eccentricity": hunt.most_throw})
    assert slim.seats[0].bearing.bore_diameter == pytest.approx(10e-3)
    # A little more would not do.
    still = machine.changed({"reducer.eccentricity": hunt.most_throw + 0.03e-3})
    assert still.seats[0].bearing.bore_diameter == pytest.approx(9e-3)
    # Once: what this finds may ask again.
    assert not turn_to_less_throw(hunt)


def test_less_eccentricity_leaves_room_for_bearings_that_bear_more(machine: Machine) -> None:
    """432 N of a thin bearing of 10 mm at a margin of 0.9 ask for 480 N."""
    thin = machine.changed({"reducer.eccentricity": 2.15e-3})
    assert thin.seats[0].bearing.static_rating == pytest.approx(432.0)
    line = next(one for one in shaft_lines(thin) if one.id == "SUPPORT-STATIC")
    assert line.limit is not None
    hunt = asked(thin, replace(line, value=0.9 * line.limit))
    assert hunt.thicker is not None
    slim = thin.changed({"reducer.eccentricity": hunt.thicker[1]}).seats[0].bearing
    assert slim.static_rating is not None
    assert slim.static_rating >= 432.0 / 0.9
    fatigue = next(one for one in shaft_lines(machine) if one.id == "SHAFT-FATIGUE")
    assert fatigue.limit is not None
    # What else it may be that is weak has ways of its own.
    assert asked(machine, replace(fatigue, value=1.1 * fatigue.limit)).thicker is None


def test_a_bond_that_is_far_too_weak_is_not_searched_for_so(machine: Machine) -> None:
    hunt = asked(machine, weaker(machine, 0.2))
    assert hunt.least_bore > machine.cam.bore_diameter
    assert not turn_to_less_throw(hunt)


def test_nothing_is_searched_for_with_a_larger_eccentricity_than_that(machine: Machine) -> None:
    hunt = asked(machine, weaker(machine, 0.9))
    space = Space(
        3, machine.design.reducer.disc_material, machine.design.reducer.ring_material, USUAL_FIT
    )
    before = hunt.fixed
    turn_to_less_throw(hunt)
    assert hunt.frame(space, {}).throw_limit == hunt.most_throw
    assert hunt.fixed != before


def test_it_is_tried_where_no_wider_cam_bearing_leads_to_a_design(
    machine: Machine, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What the search finds then is taken, before torques are lowered or the hunt ends."""
    hunt, throws = asked(machine, weaker(machine, 0.9)), []

    def searched(one: Hunt) -> str | None:
        throws.append(one.most_throw)
        return None if len(throws) < 2 else "a design"

    monkeypatch.setattr(verified, "lightest", searched)
    assert verified._again(hunt, SimpleNamespace()) == "a design"
    assert throws[0] == math.inf
    assert throws[1] < machine.design.reducer.eccentricity


def test_low_shoulders_beside_the_shafts_bearings_ask_for_a_wider_cam_bearing(
    machine: Machine, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Found in the last verdict alone they ended a search that one wider cam bearing would have."""
    line = next(one for one in retention_lines(machine) if one.id == "RETENTION-SHOULDER")
    there = shoulder_on_shaft(machine)
    assert there is None or there == line
    low = replace(line, value=0.5 * line.compared[1])
    assert low.status == "fail"
    assert low.id in SHAFT
    before = weak_lines(machine)
    monkeypatch.setattr("cqdd_design.sizing.shafts.shoulder_on_shaft", lambda _: low)
    assert weak_lines(machine) == (*before, low)
    monkeypatch.setattr("cqdd_design.sizing.shafts.shoulder_on_shaft", lambda _: line)
    assert weak_lines(machine) == before


def test_a_gearbox_for_less_torque_has_its_shafts_ends_looked_at_again() -> None:
    """They are chosen with a design: made anew it has others, which may bear far too little."""
    torques = {"peak_torque": "81 N*m", "continuous_torque": "13 N*m"}
    less = requirements_from_mapping({"ratio": 16, "continuous_speed": "300 rpm", **torques})
    hunt = Hunt(less, None, None, print, stage_tables(16), "mass", usual={})
    space = Space(2, MATERIALS[1], MATERIALS[1], FITS[0], cam="6904")
    found = agreed(hunt, space, None)
    assert found is not None
    again = given(hunt, replace(found, weak=()))
    assert again is not None
    # As they are laid out they bear too little; others are named that bear enough.
    assert [line.id for line in weak_lines(found.sized.machine)] == ["SUPPORT-STATIC"]
    before, after = (one.sized.machine.seats[0].bearing for one in (found, again))
    assert again.sized.design.reducer.support_bearing.designation == after.designation
    assert after.static_rating > before.static_rating
    assert again.weak == weak_lines(again.sized.machine) == ()
