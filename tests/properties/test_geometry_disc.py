"""Holes, phases and ligaments of the disc."""

from __future__ import annotations

import math

import numpy as np
import pytest
from examples import examples
from geometry_designs import PAPER, design_of, discs
from hypothesis import given, settings
from hypothesis import strategies as st

from cqdd_design.design import Design
from cqdd_design.errors import UsageError
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.disc import (
    disc_contour,
    hole_centres,
    hole_diameter,
    ligament_hole_to_bore,
    ligament_hole_to_hole,
    ligaments,
)
from cqdd_design.geometry.kinematics import disc_pose

UNIT = np.array([1.0, 1j])


def _design(disc: CycloidDisc = PAPER, discs_in: int = 2, **pins: object) -> Design:
    return design_of(
        disc,
        disc_count=discs_in,
        output_pins={"count": 5, "diameter": 0.004, "circle_radius": 0.0195, **pins},
    )


def test_hole_is_measured_to_the_mean_pin_or_to_the_sleeve() -> None:
    assert hole_diameter(_design(hole_clearance=16e-6)) == pytest.approx(0.007191)
    sleeved = _design(hole_clearance=16e-6, sleeve_diameter=0.006)
    assert hole_diameter(sleeved) == pytest.approx(0.006 + 0.0032 + 16e-6)


@settings(max_examples=examples(30), deadline=None)
@given(
    discs(least_lobes=4, most_lobes=30),
    st.integers(1, 3),
    st.integers(3, 12),
    st.floats(-math.pi, math.pi),
    st.floats(0.0, 50.0),
)
def test_a_pin_of_the_carrier_stays_one_throw_from_its_hole(
    disc: CycloidDisc, discs_in: int, count: int, clocking: float, phi: float
) -> None:
    """Every hole of every disc, in the world, is e from a carrier pin: hole = pin + 2 e."""
    design = design_of(
        disc,
        disc_count=discs_in,
        output_pins={
            "count": count,
            "circle_radius": 0.5 * disc.ring_pitch_radius,
            "hole_clocking": clocking,
        },
    )
    n = disc.lobe_count
    pins = (
        0.5
        * disc.ring_pitch_radius
        * np.exp(1j * (-phi / n + clocking + 2.0 * math.pi * np.arange(count) / count))
    )
    for index in range(discs_in):
        turn, shift = disc_pose(disc, phi + 2.0 * math.pi * index / discs_in)
        holes = turn * (hole_centres(design, index) @ UNIT) + shift
        assert np.abs(np.abs(holes - pins) - disc.eccentricity).max() < 1e-12


@pytest.mark.parametrize(("n", "count"), [(10, 5), (10, 6), (7, 5), (9, 4), (12, 7)])
def test_quarter_pitch_clocking_makes_two_discs_one_part_flipped(n: int, count: int) -> None:
    disc = CycloidDisc(n, 0.032, 0.5 * 0.032 / (n + 1), 0.0025, rotation=math.radians(1 / 60))
    design = _design(disc, count=count)
    assert design.reducer.output_pins.hole_clocking == pytest.approx(math.pi / (2 * n))
    first, second = (disc_contour(design, index, bore_diameter=0.024) for index in (0, 1))
    # Flipped about the +x axis and turned by some whole number of lobes, the parts coincide.
    holes = first.transformed(mirror=True).holes[1:]
    flipped = np.array([hole.centre @ UNIT for hole in holes])
    target = np.array([hole.centre @ UNIT for hole in second.holes[1:]])
    misfits = [
        np.abs(flipped[:, None] * np.exp(2j * math.pi * k / n) - target).min(axis=1).max()
        for k in range(n)
    ]
    assert min(misfits) < 1e-12
    assert second.outer.distances(first.outer.transformed(mirror=True).points).max() < 1e-12


def test_paper_ligaments_by_hand() -> None:
    found = ligaments(_design(hole_clearance=16e-6), bore_diameter=0.028)
    by_kind = {one.kind: one.thickness for one in found}
    assert found[0].kind == "hole to bore"
    assert by_kind["hole to bore"] == pytest.approx(0.0195 - 0.0035955 - 0.014)
    chord = 2.0 * 0.0195 * math.sin(math.pi / 5.0)
    assert by_kind["hole to hole"] == pytest.approx(chord - 0.007191)
    assert by_kind["bore to profile"] == pytest.approx(0.0269 - 0.014)
    assert [one.thickness for one in found] == sorted(by_kind.values())


@settings(max_examples=examples(30), deadline=None)
@given(
    discs(least_lobes=4, most_lobes=30), st.integers(3, 9), st.integers(1, 3), st.floats(-0.5, 0.5)
)
def test_hole_to_profile_is_the_distance_to_the_nearest_point(
    disc: CycloidDisc, count: int, discs_in: int, clocking: float
) -> None:
    radius = 0.7 * disc.valley_distance
    design = design_of(
        disc,
        disc_count=discs_in,
        output_pins={"count": count, "circle_radius": radius, "hole_clocking": clocking},
    )
    hole = hole_diameter(design)
    found = {one.kind: one for one in ligaments(design, bore_diameter=0.01)}["hole to profile"]
    profile = disc.flank(np.linspace(0.0, 2.0 * math.pi, 4000 * disc.lobe_count)) @ UNIT
    nearest = min(
        np.abs(hole_centres(design, index)[:, None] @ UNIT - profile).min()
        for index in range(discs_in)
    )
    assert found.thickness == pytest.approx(nearest - hole / 2.0, abs=1e-4 * disc.ring_pitch_radius)
    assert found.thickness <= nearest - hole / 2.0 + 1e-12
    # The closed form for screens never promises more.
    screened = disc.valley_distance - radius - hole / 2.0
    assert screened <= found.thickness + 1e-12


def test_closed_form_ligaments_broadcast() -> None:
    radius = np.array([0.018, 0.0195, 0.021])
    counts = np.array([[5], [6]])
    assert ligament_hole_to_hole(radius, counts, 0.007).shape == (2, 3)
    assert np.all(np.diff(ligament_hole_to_bore(radius, 0.007, 0.028)) > 0.0)


def test_a_disc_that_is_not_there() -> None:
    with pytest.raises(UsageError, match="disc 2 does not exist; the design has 0 to 1"):
        hole_centres(_design(), 2)
