"""Tips against roots: what rolling teeth generated from their tools says, no formula shared."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from planetary_teeth import inv, rack_fillet, ring_fillet

from cqdd_design.errors import GeometryError, UsageError
from cqdd_design.planetary.cutting_tools import (
    ISO_53_A,
    PinionCutter,
    full_tip_radius,
    rack_form_roll,
    ring_form_roll,
)
from cqdd_design.planetary.gear_set import build_gear_set
from cqdd_design.planetary.iso6336.pitting import single_pair_factors
from cqdd_design.planetary.kinematics import PlanetaryTeeth
from cqdd_design.planetary.profile_shift import ProfileShifts, least_shift_without_undercut
from cqdd_design.planetary.settings import RatingSettings
from cqdd_design.planetary.tooth_geometry import GearPair

ALPHA = math.radians(20.0)
PAPER = PlanetaryTeeth(12, 36, 22, 70)


def overlap(planet: int, ring: int, tip_radius: float) -> float:
    """How deep the corner of a ring's tooth dips into a rack-cut planet, module 1, x = 0.

    The planet stands with a space on +x, the ring's centre on -x, and the ring's tooth rolls
    through the space. Along the arc; next to nothing where it touches.
    """
    fillet, _ = rack_fillet(planet, 0.0)
    radius, angle = np.hypot(*fillet.T), np.arctan2(fillet[:, 1], fillet[:, 0])
    base = planet / 2.0 * math.cos(ALPHA)

    def space(at: np.ndarray) -> np.ndarray:
        """Half the angle of the planet's space: what the tool's rounding or its flank removed."""
        pressure = np.arccos(np.minimum(base / at, 1.0))
        involute = math.pi / (2 * planet) - inv(ALPHA) + np.tan(pressure) - pressure
        return np.where(at < radius[-1], np.interp(at, radius, angle), involute)

    pressure = math.acos(ring / 2.0 * math.cos(ALPHA) / tip_radius)
    half = math.pi / (2 * ring) - inv(ALPHA) + inv(pressure)
    turn = np.linspace(-0.25, 0.25, 200_001)
    distance = (ring - planet) / 2.0
    corner = tip_radius * np.exp(1j * (half + turn)) - distance
    corner = corner * np.exp(-1j * turn * ring / planet)
    at, where = np.abs(corner), np.angle(corner)
    inside = (at > radius[0]) & (at < planet / 2.0 + 1.0)
    at, where = at[inside], where[inside]
    return float(((where - space(at)) * at).max())


def test_the_full_depth_ring_of_the_papers_planetary_runs_into_the_planets_root():
    """10.4 um at the 34 mm tip radius of the rack, nothing at 34.111: a second implementation's."""
    assert overlap(22, 70, 34.0) * 1e3 == pytest.approx(10.4, abs=0.3)
    assert abs(overlap(22, 70, 34.111)) < 1e-4
    pair = GearPair(22, -70, 1e-3, 12e-3)
    assert pair.tip_diameters[1] / -2.0 == pytest.approx(34.111e-3, abs=0.5e-6)
    assert pair.transverse_contact_ratio == pytest.approx(1.781, abs=5e-4)
    assert pair.interference_free_contact_ratio == pytest.approx(pair.transverse_contact_ratio)


@settings(max_examples=examples(40))
@given(st.integers(18, 60), st.integers(20, 80))
def test_a_default_ring_just_clears(planet, more):
    """Its tip is that of the rack where that clears, and else reaches the last involute."""
    ring = planet + more
    pair = GearPair(planet, -ring, 1.0e-3, 12e-3)
    tip = pair.tip_diameters[1] / -2e-3
    assert overlap(planet, ring, tip) < 2e-4
    nominal = ring / 2.0 - 1.0
    if tip > nominal + 0.02:
        assert overlap(planet, ring, tip - 0.01) > 0.0
    else:
        assert tip == pytest.approx(nominal, abs=0.02)


def test_a_given_ring_that_interferes_is_warned_of():
    found = build_gear_set(PAPER, 1e-3, 12e-3, RatingSettings(ring_tip_diameter=68e-3))
    (warning,) = found.warnings
    for text in ("0.411 mm", "0.839 mm", "root fillet", "68.222 mm"):
        assert text in warning
    assert found.ring_mesh.pair.interference_free_contact_ratio == pytest.approx(1.781, abs=5e-4)
    assert found.ring_mesh.pair.transverse_contact_ratio == pytest.approx(1.925, abs=5e-4)
    assert not build_gear_set(PAPER, 1e-3, 12e-3).warnings


@pytest.mark.parametrize(
    "teeth",
    [(12, 36, 22, 70), (20, 40, 40, 100), (18, 42, 30, 90), (15, 30, 20, 65), (24, 36, 30, 90),
     (12, 24, 18, 54)],
)  # fmt: skip
def test_no_default_set_interferes(teeth):
    gears = build_gear_set(PlanetaryTeeth(*teeth), 1e-3, 12e-3)
    for mesh in (gears.sun_mesh, gears.ring_mesh):
        assert max(mesh.pair.root_interference) <= 1e-12
        assert mesh.pair.interference_free_contact_ratio > 1.2


@pytest.mark.parametrize(
    ("teeth", "shift"), [(22, 0.0), (17, 0.1), (40, -0.5), (12, 0.0), (8, 0.2)]
)
def test_the_involute_ends_where_the_rack_s_rounding_leaves_it(teeth, shift):
    """Outermost point that the rounding removes to the flank, undercut or not."""
    points, _ = rack_fillet(teeth, shift)
    radius, angle = np.hypot(*points.T), np.arctan2(points[:, 1], points[:, 0])
    base = teeth / 2.0 * math.cos(ALPHA)
    pressure = np.arccos(np.minimum(base / radius, 1.0))
    flank = (math.pi / 2.0 - 2.0 * shift * math.tan(ALPHA)) / teeth - inv(ALPHA)
    flank = flank + np.tan(pressure) - pressure
    reached = (radius > base) & (angle > flank - 1e-6)
    form = math.hypot(rack_form_roll(teeth, shift), base)
    assert radius[reached].max() == pytest.approx(form, abs=0.012)
    undercut = shift < least_shift_without_undercut(teeth)
    assert undercut == (teeth / 2.0 * math.sin(ALPHA) * math.sin(ALPHA) < 1.0 - shift)


@pytest.mark.parametrize(
    ("ring", "teeth", "radius"), [(70, 20, 0.3), (70, 20, 0.1), (120, 35, 0.38)]
)
def test_a_ring_s_involute_ends_where_the_cutter_s_rounding_leaves_it(ring, teeth, radius):
    points, _ = ring_fillet(ring, teeth, replace(ISO_53_A, fillet_radius=radius))
    at, angle = np.hypot(*points.T), np.abs(np.arctan2(points[:, 1], points[:, 0]))
    base = ring / 2.0 * math.cos(ALPHA)
    pressure = np.arccos(np.minimum(base / at, 1.0))
    # A ring's space is as wide as an external tooth: it grows narrower outward.
    space = math.pi / 2.0 / ring + inv(ALPHA) - (np.tan(pressure) - pressure)
    reached = (angle > space - 1e-6) & (at > ring / 2.0)
    form = math.hypot(ring_form_roll(ring, 0.0, PinionCutter(teeth, radius)), base)
    assert at[reached].min() == pytest.approx(form, abs=0.012)


def test_a_cutter_s_tip_is_at_most_round():
    """The full radius of 20 teeth is 0.346 modules, so the rack's 0.38 cannot be on it."""
    assert full_tip_radius(20) == pytest.approx(0.346, abs=5e-4)
    with pytest.raises(UsageError, match=r"0\.346"):
        PinionCutter(20, 0.38)
    for teeth in (30, 40, 70, 300):
        usual = PinionCutter.usual(teeth)
        assert usual.tip_radius <= full_tip_radius(usual.teeth)
    assert GearPair(22, -70, 1e-3, 12e-3).ring_cutter == PinionCutter.usual(70, 22)


def test_z_d_of_a_ring_is_one():
    """ISO 6336-2, 6.2: the inner point of single contact decides for the pinion alone."""
    for planet, ring in ((22, 70), (40, 100), (30, 90)):
        assert single_pair_factors(GearPair(planet, -ring, 1e-3, 12e-3))[1] == 1.0
    assert single_pair_factors(GearPair(36, 12, 1e-3, 12e-3))[1] > 1.2


def test_tips_that_foul_beside_the_line_of_action():
    """At 20 deg and full depth a ring needs about eight teeth more than its pinion."""
    assert GearPair(22, -30, 1e-3, 12e-3).tip_fouling > 0.0
    assert GearPair(22, -28, 1e-3, 12e-3).tip_fouling < 0.0


def test_shifts_are_taken_where_both_meshes_stay_on_one_pin():
    asked = RatingSettings(shifts=ProfileShifts(0.4, -0.4, 0.2, -0.2))
    gears = build_gear_set(PAPER, 1e-3, 12e-3, asked)
    assert gears.shifts == asked.shifts
    assert gears.sun_mesh.pair.shifts == (0.4, -0.4)
    with pytest.raises(GeometryError, match="one pin"):
        build_gear_set(PAPER, 1e-3, 12e-3, RatingSettings(shifts=ProfileShifts(0.4, 0.0, 0.0, 0.0)))
    with pytest.raises(UsageError, match="one gear"):
        build_gear_set(
            PlanetaryTeeth(20, 40, 40, 100), 1e-3, 12e-3,
            RatingSettings(shifts=ProfileShifts(0.1, -0.1, 0.2, -0.2)),
        )  # fmt: skip
