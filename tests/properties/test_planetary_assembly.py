"""Kinematics, assembly and fit of the compound planetary, over random tooth counts."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from cqdd_design.errors import GeometryError, UsageError
from cqdd_design.planetary.assembly import (
    assembles,
    most_planets_that_fit,
    neighbour_gap,
    validate_planets,
)
from cqdd_design.planetary.gear_set import build_gear_set
from cqdd_design.planetary.kinematics import (
    PlanetaryTeeth,
    ratio_carrier_fixed,
    ratio_ring_fixed,
    speeds,
    tangential_force,
    torques,
)
from cqdd_design.planetary.profile_shift import (
    default_shifts,
    least_shift_without_undercut,
)


@st.composite
def gear_sets(draw, most: int = 60) -> PlanetaryTeeth:
    """Tooth counts that share one centre distance."""
    sun, first, second = (draw(st.integers(12, most)) for _ in range(3))
    return PlanetaryTeeth(sun, first, second, sun + first + second)


@given(gear_sets(), st.floats(-500.0, 500.0), st.floats(0.1, 1e3), st.integers(1, 12))
def test_power_and_torque_balance(teeth, sun_speed, torque, planets):
    load, moving = torques(teeth, torque, planets), speeds(teeth, sun_speed)
    scale = abs(load.sun * sun_speed) + 1e-30
    assert load.sun + load.ring + load.carrier == pytest.approx(0.0, abs=1e-9 * torque)
    assert load.sun * moving.sun + load.carrier * moving.carrier == pytest.approx(
        0.0, abs=1e-9 * scale
    )


@given(gear_sets(), st.floats(0.1, 1e3), st.integers(1, 12))
def test_every_mesh_carries_its_own_torque(teeth, torque, planets):
    """The planet is in balance: both meshes give the same torque about its pin, and the two
    tangential forces together push the carrier with the whole output torque."""
    load, module = torques(teeth, torque, planets), 1e-3
    at_sun = tangential_force(load.sun / planets, teeth.sun, module)
    at_ring = tangential_force(load.planet, teeth.planet_ring, module)
    assert at_sun * teeth.planet_sun == pytest.approx(at_ring * teeth.planet_ring)
    assert at_ring * teeth.ring * module / 2.0 * planets == pytest.approx(load.ring)
    arm = module * (teeth.sun + teeth.planet_sun) / 2.0
    assert planets * (at_sun + at_ring) * arm == pytest.approx(torque)


@given(gear_sets())
def test_ratio_by_rolling(teeth):
    """The ring mesh rolls: the planet's rim stands still where it touches the ring, and moves with
    the sun's rim where it touches the sun."""
    moving = speeds(teeth, 1.0)
    arm = (teeth.sun + teeth.planet_sun) / 2.0
    rim_at_ring = moving.carrier * arm + moving.planet * teeth.planet_ring / 2.0
    rim_at_sun = moving.carrier * arm - moving.planet * teeth.planet_sun / 2.0
    assert rim_at_ring == pytest.approx(0.0, abs=1e-12 * arm)
    assert rim_at_sun == pytest.approx(teeth.sun / 2.0, rel=1e-9)
    assert ratio_ring_fixed(teeth) + -ratio_carrier_fixed(teeth) == pytest.approx(
        2.0 * ratio_ring_fixed(teeth) - 1.0
    )


def can_be_spaced(teeth: PlanetaryTeeth, planets: int) -> bool:
    """By trying every tooth: does each planet find a position in which both its gears mesh?

    In tooth pitches. Sun and ring stand still with a tooth (space) on +x; a planet at the share
    t of a turn sees the ring's teeth shifted by Z_r t and the sun's by Z_s t. It may enter the ring
    k teeth on, which turns it by (k - Z_r t)/Z_p2 of a turn and its other gear by Z_p1 times that.
    """
    for index in range(planets):
        t = Fraction(index, planets)
        if not any(
            (Fraction(teeth.planet_sun) * (k - teeth.ring * t) / teeth.planet_ring - teeth.sun * t)
            % 1
            == 0
            for k in range(teeth.planet_ring)
        ):
            return False
    return True


@given(gear_sets(most=30), st.integers(1, 9))
def test_assembly_condition_by_trying_every_tooth(teeth, planets):
    assert assembles(teeth, planets) == can_be_spaced(teeth, planets)


@given(st.floats(0.5, 200.0), st.floats(0.3, 300.0))
def test_the_most_that_fit_are_the_most_that_fit(distance, tip):
    assume(tip < 2.0 * distance)
    most = most_planets_that_fit(distance, tip)
    assert neighbour_gap(distance, tip, most) > 0.0
    assert most == 24 or neighbour_gap(distance, tip, most + 1) <= 0.0


def test_the_papers_planetary():
    gears = build_gear_set(PlanetaryTeeth(12, 36, 22, 70), 1e-3, 12e-3)
    assert gears.centre_distance == pytest.approx(24e-3, rel=1e-12)
    assert [gears.fits(n) for n in (2, 3, 4, 6)] == [True, True, False, False]
    assert [n for n in range(1, 13) if assembles(gears.teeth, n)] == [1, 2, 3, 4, 6, 8, 12]
    # The planet gear at the sun alone sweeps more than any of the motor's stator leaves.
    assert gears.envelope.planet_sweep_diameter == pytest.approx(2 * 24e-3 + 37.4e-3)
    assert gears.envelope.ring_outer_diameter == pytest.approx(72.5e-3 + 5e-3)
    assert not gears.envelope.fits(76e-3)


@given(gear_sets())
def test_default_shifts_keep_the_centre_distance_and_prevent_undercut(teeth):
    shifts = default_shifts(teeth)
    assert shifts.sun + shifts.planet_sun == 0.0
    assert shifts.planet_ring + shifts.ring == 0.0
    enough = -least_shift_without_undercut(teeth.planet_sun)
    if least_shift_without_undercut(teeth.sun) <= enough:
        assert shifts.sun >= least_shift_without_undercut(teeth.sun) - 1e-9
        assert shifts.planet_sun >= least_shift_without_undercut(teeth.planet_sun) - 1e-9
    if teeth.stepped:
        assert shifts.planet_ring >= least_shift_without_undercut(teeth.planet_ring) - 1e-9
    else:
        assert shifts.planet_ring == shifts.planet_sun


def test_teeth_that_are_undercut_are_named():
    """Too few teeth on sun and planet together: both stay a little undercut."""
    gears = build_gear_set(PlanetaryTeeth(9, 20, 20, 49), 1e-3, 12e-3)
    assert any("sun of 9 teeth is undercut" in text for text in gears.warnings)
    assert build_gear_set(PlanetaryTeeth(12, 36, 22, 70), 1e-3, 12e-3).warnings == ()


@pytest.mark.parametrize("planets", [0, -1, 25, 2.0, True, math.nan])
def test_numbers_of_planets_that_are_none(planets):
    with pytest.raises(UsageError, match="1 to 24"):
        validate_planets(planets)


@pytest.mark.parametrize(
    ("counts", "error", "fix"),
    [
        ((12, 36, 22, 20), GeometryError, "70 teeth"),
        ((12, 36, 22, 22), GeometryError, "70 teeth"),
        ((12, 36, 22, 71), GeometryError, "ring of 70 teeth"),
        ((12, 36, 22, 30), GeometryError, "ring of 70 teeth"),
        ((4, 36, 22, 62), UsageError, "nearest is 5"),
        ((12, 36, 22, 10**9), UsageError, "nearest is 1000"),
        ((12, 36, 22, math.inf), UsageError, "nearest is 1000"),
        ((12, 36, 22, math.nan), UsageError, "nearest is 5"),
        ((12.5, 36, 22, 70), UsageError, "nearest is 12"),
        ((5, 36, 22, 63), GeometryError, "come to a point"),
    ],
)
def test_teeth_that_make_no_gear_set(counts, error, fix):
    with pytest.raises(error, match=fix):
        build_gear_set(PlanetaryTeeth(*counts), 1e-3, 12e-3)


@pytest.mark.parametrize("module", [0.0, -1e-3, 1.0, math.nan, math.inf])
def test_modules_that_are_none(module):
    with pytest.raises(UsageError, match="module"):
        build_gear_set(PlanetaryTeeth(12, 36, 22, 70), module, 12e-3)


@pytest.mark.parametrize("width", [0.0, -1e-3, math.nan, math.inf])
def test_widths_that_are_none(width):
    with pytest.raises(UsageError, match="face width"):
        build_gear_set(PlanetaryTeeth(12, 36, 22, 70), 1e-3, width)
