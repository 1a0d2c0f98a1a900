"""Arcs through the profile: bound, tangency, symmetry, count, exact integrals."""

from __future__ import annotations

import math

import numpy as np
import pytest
from examples import examples
from geometry_designs import PAPER, design_of, discs, joint_angles
from hypothesis import given, settings
from hypothesis import strategies as st

from cqdd_design.errors import GeometryError
from cqdd_design.geometry.biarc import fit_biarcs, mirrored_contour
from cqdd_design.geometry.contours import ArcContour
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.disc import (
    disc_contour,
    disc_moments,
    lobed_outline,
    profile_moments,
    profile_perimeter,
)
from cqdd_design.geometry.meshing import project


@settings(max_examples=examples(30), deadline=None)
@given(discs(modified=True), st.sampled_from([2e-8, 0.5e-6, 5e-6, 1e-4]))
def test_outline_is_within_its_bound_and_tangent_continuous(
    disc: CycloidDisc, tolerance: float
) -> None:
    outline = lobed_outline(disc, tolerance)
    assert np.abs(joint_angles(outline)).max() < 1e-6
    # Curve to arcs and arcs to curve, on two lobes.
    t = np.linspace(0.0, 4.0 * disc.half_pitch, 1501)
    assert outline.distances(disc.flank(t)).max() <= tolerance + 1e-14
    first = 2 * len(outline) // disc.lobe_count
    inside = outline.evaluate(np.linspace(0.0, 1.0, 9))[0][:first].reshape(-1, 2)
    assert np.abs(project(disc, inside).distance).max() <= tolerance + 1e-14
    assert outline.points[0] == pytest.approx([disc.valley_distance, 0.0], abs=1e-12)


@settings(max_examples=examples(30), deadline=None)
@given(discs(modified=True))
def test_outline_has_the_symmetry_of_the_lobes(disc: CycloidDisc) -> None:
    outline = lobed_outline(disc, 0.5e-6)
    points = outline.points @ np.array([1.0, 1j])
    per_lobe, rest = divmod(len(outline), disc.lobe_count)
    assert rest == 0
    turned = points * np.exp(2j * disc.half_pitch)
    assert np.abs(np.roll(points, -per_lobe) - turned).max() < 1e-15
    assert np.abs(np.roll(points[::-1], 1) - np.conj(points)).max() < 1e-14
    assert np.array_equal(outline.bulges, np.roll(outline.bulges, per_lobe))
    assert np.allclose(outline.bulges, outline.bulges[::-1], rtol=0, atol=0)


@settings(max_examples=examples(30), deadline=None)
@given(discs(modified=True))
def test_area_and_inertia_of_arcs_match_the_exact_integrals(disc: CycloidDisc) -> None:
    tolerance = 0.2e-6
    outline, exact = lobed_outline(disc, tolerance), profile_moments(disc)
    # An outline moved by the tolerance everywhere changes the area by perimeter x tolerance.
    change = tolerance * profile_perimeter(disc)
    moments = outline.moments()
    assert abs(moments.area - exact.area) <= change
    assert abs(moments.polar - exact.polar) <= change * disc.tip_distance**2
    assert moments.xx == pytest.approx(exact.xx, rel=1e-3)
    assert abs(moments.x) + abs(moments.y) < 1e-12
    assert outline.length() == pytest.approx(profile_perimeter(disc), rel=1e-4)


@settings(max_examples=examples(30), deadline=None)
@given(discs())
def test_exact_area_by_the_parallel_curve_theorem(disc: CycloidDisc) -> None:
    """Steiner: A(r) = A(locus) - r L(locus) + pi r^2; L is a complete elliptic integral."""
    from scipy.special import ellipe

    R, e, r = disc.ring_pitch_radius, disc.eccentricity, disc.tooth_radius
    K = disc.shortening_coefficient
    length = 4.0 * R * (1.0 + K) * ellipe(4.0 * K / (1.0 + K) ** 2)
    area = math.pi * (R**2 + disc.ring_tooth_count * e**2) - r * length + math.pi * r**2
    assert profile_moments(disc).area == pytest.approx(area, rel=1e-12)
    assert profile_perimeter(disc) == pytest.approx(length - 2.0 * math.pi * r, rel=1e-12)


def test_modified_area_against_a_fine_polygon() -> None:
    disc = CycloidDisc(10, 0.032, 0.0016, 0.0035, 6e-6, 3e-6, math.radians(3.0 / 60.0))
    p = disc.flank(np.linspace(0.0, 2.0 * math.pi, 2_000_001)[:-1]) @ np.array([1.0, 1j])
    cross = (np.conj(p) * np.roll(p, -1)).imag
    polar = (
        cross * (np.abs(p) ** 2 + (np.conj(p) * np.roll(p, -1)).real + np.abs(np.roll(p, -1)) ** 2)
    ).sum() / 12
    assert profile_moments(disc).area == pytest.approx(cross.sum() / 2.0, rel=1e-10)
    assert profile_moments(disc).polar == pytest.approx(polar, rel=1e-10)


@pytest.mark.parametrize("rotation", [0.0, 3.0])
def test_paper_disc_needs_at_most_300_arcs_for_half_a_micrometre(rotation: float) -> None:
    disc = CycloidDisc(10, 0.032, 0.0016, 0.0035, 6e-6, 0.0, math.radians(rotation / 60.0))
    assert len(lobed_outline(disc, 0.5e-6)) <= 300


@settings(max_examples=examples(20), deadline=None)
@given(discs(least_lobes=4, most_lobes=20), st.integers(3, 8), st.integers(1, 3))
def test_disc_part_against_exact_moments(disc: CycloidDisc, pins: int, discs_in: int) -> None:
    room = disc.valley_distance
    design = design_of(
        disc,
        disc_count=discs_in,
        output_pins={
            "count": pins,
            "circle_radius": max(0.6 * room, 1.1e-3),
            "diameter": max(0.1 * room, 0.6e-3),
        },
    )
    for index in range(discs_in):
        part = disc_contour(design, index, bore_diameter=0.5 * room)
        exact = disc_moments(design, index, bore_diameter=0.5 * room)
        change = 0.5e-6 * profile_perimeter(disc)
        assert abs(part.moments().area - exact.area) <= change
        assert abs(part.moments().polar - exact.polar) <= change * disc.tip_distance**2
        assert len(part.holes) == 1 + pins
        assert part.name == f"disc {index + 1}"


def test_true_arcs_stay_single_arcs() -> None:
    chain = fit_biarcs(
        lambda a: np.exp(1j * a), lambda a: 1j * np.exp(1j * a), (0.0, math.pi / 3.0), 1e-6
    )
    assert len(chain.bulges) == 1
    circle = mirrored_contour(chain, 3)
    assert isinstance(circle, ArcContour)
    assert circle.moments().area == pytest.approx(math.pi, rel=1e-12)


def test_inflections_and_straight_stretches() -> None:
    """A sine has an inflection in the middle; a line has no curvature at all."""
    sine = fit_biarcs(
        lambda x: x + 1j * np.sin(x),
        lambda x: (1.0 + 1j * np.cos(x)) / np.abs(1.0 + 1j * np.cos(x)),
        (0.0, 2.0 * math.pi),
        1e-5,
    )
    assert 0.0 < sine.deviation <= 1e-5
    line = fit_biarcs(lambda x: x + 0j, lambda x: np.ones_like(x) + 0j, (0.0, 2.0), 1e-6)
    assert np.abs(line.bulges).max() == 0.0
    assert len(line.bulges) == 1


@pytest.mark.parametrize("tolerance", [0.0, -1e-6, 1e-12, math.nan])
def test_senseless_tolerance_is_refused(tolerance: float) -> None:
    with pytest.raises(GeometryError, match="profile_tolerance"):
        lobed_outline(PAPER, tolerance)
