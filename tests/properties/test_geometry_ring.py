"""Rings against the moving disc: clearance of the relief, conjugacy, pockets, exact moments."""

from __future__ import annotations

import math

import numpy as np
import pytest
from examples import examples
from geometry_designs import PAPER, design_of, discs, joint_angles
from hypothesis import given, settings
from hypothesis import strategies as st

from cqdd_design.errors import GeometryError
from cqdd_design.geometry.conjugate import SecondEnvelope, active_angle, swept_radius
from cqdd_design.geometry.contours import ArcContour
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.disc import lobed_outline
from cqdd_design.geometry.kinematics import disc_pose
from cqdd_design.geometry.meshing import project
from cqdd_design.geometry.relief import solid_relief
from cqdd_design.geometry.ring import (
    ring_contour,
    ring_min_concave_radius,
    ring_moments,
    ring_pins,
    ring_root_radius,
)
from cqdd_design.geometry.trochoid import undercut_radius_limit

UNIT = np.array([1.0, 1j])


def _points(values: np.ndarray) -> np.ndarray:
    return np.stack([values.real, values.imag], axis=-1)


def _nearest_ever(disc: CycloidDisc, points: np.ndarray, angles: int) -> np.ndarray:
    """Least signed distance of fixed points (m,) from the disc over one crank turn.

    After a turn of the crank the disc has turned one whole lobe: one turn is the whole period.
    """
    phi = np.linspace(0.0, 2.0 * math.pi, angles, endpoint=False)
    turn, shift = disc_pose(disc, phi)
    moved = (points[None, :] - shift[:, None]) / turn[:, None]
    return np.asarray(project(disc, _points(moved)).distance.min(axis=0))


def _half_gap(disc: CycloidDisc, contour: ArcContour, tolerance: float) -> np.ndarray:
    """Points of an inner contour from tooth 0 to midway to tooth 1."""
    points = contour.sample(tolerance) @ UNIT
    angle = np.angle(points)
    return points[(angle >= 0.0) & (angle <= math.pi / disc.ring_tooth_count + 1e-9)]


@settings(max_examples=examples(15), deadline=None)
@given(discs(most_lobes=40), st.floats(0.02, 0.3))
def test_solid_relief_clears_the_disc_over_the_whole_period(
    disc: CycloidDisc, share: float
) -> None:
    clearance = share * 0.2 * disc.tooth_radius
    try:
        relief = solid_relief(disc, clearance)
    except GeometryError:
        # Only where a much smaller clearance would do, or the throw is larger than the tooth.
        assert share > 0.04 or 2.0 * disc.eccentricity > disc.tooth_radius
        return
    fillet = np.linspace(-relief.tooth_angle, relief.root_angle, 60)
    root = np.linspace(relief.root_angle, math.pi / disc.ring_tooth_count, 25)
    points = np.concatenate(
        [
            relief.fillet_centre + relief.fillet_radius * np.exp(1j * fillet),
            relief.root_radius * np.exp(1j * root),
        ]
    )
    assert _nearest_ever(disc, points, 600).min() > clearance - 1e-9
    assert relief.tooth_angle > active_angle(disc)
    assert relief.neck_half_width >= 0.5 * disc.tooth_radius


def test_solid_relief_of_the_paper_disc_uses_its_clearance_and_no_more() -> None:
    """Fine sweep, with the finished arcs: the clearance asked for is met and used up."""
    design = design_of(PAPER)
    contour = ring_contour(design).holes[0]
    points = _half_gap(PAPER, contour, 1e-6)
    relief = solid_relief(PAPER, design.reducer.ring.relief_clearance)
    from_tooth = np.angle(-(points - PAPER.ring_pitch_radius).conjugate())
    beyond = from_tooth > relief.tooth_angle - 1e-9
    least = _nearest_ever(PAPER, points[beyond], 3600).min()
    assert 0.1e-3 - 1e-9 < least < 0.1e-3 + 1e-7
    # The tooth itself is touched over its active arc, and never cut.
    on_tooth = points[~beyond]
    distance = _nearest_ever(PAPER, on_tooth, 7200)
    active = np.abs(np.angle(-(on_tooth - PAPER.ring_pitch_radius))) < active_angle(PAPER)
    assert distance.min() > -1e-9
    assert distance[active].max() < 1e-7


def test_a_larger_fillet_would_not_clear() -> None:
    relief = solid_relief(PAPER, 1e-4)
    larger = relief.fillet_radius * 1.01
    reach = relief.root_radius - larger
    R, r = PAPER.ring_pitch_radius, PAPER.tooth_radius
    angle = math.acos((reach**2 + R**2 - (r + larger) ** 2) / (2.0 * R * reach))
    centre = reach * np.exp(1j * angle)
    # Where it would leave the tooth.
    start = centre + larger * (R - centre) / abs(R - centre)
    assert abs(start - R) == pytest.approx(r)
    assert _nearest_ever(PAPER, np.array([start]), 7200).min() < 1e-4 - 1e-7


@settings(max_examples=examples(25), deadline=None)
@given(discs())
def test_second_envelope_is_touched_and_never_cut(disc: CycloidDisc) -> None:
    envelope = SecondEnvelope.of(disc)
    t = np.linspace(envelope.start, envelope.end, 40)
    distance = _nearest_ever(disc, envelope.point(t), 1200)
    assert distance.min() > -1e-9
    # Contact falls between two of the 1200 angles; nearer than the square of that step.
    assert distance.max() < disc.ring_pitch_radius * (2.0 * math.pi / 1200) ** 2
    # At the closed-form crank angle the touch is exact, with the common normal.
    phi = envelope.crank_angle(t)
    turn, shift = disc_pose(disc, phi)
    found = project(disc, _points((envelope.point(t) - shift) / turn))
    assert np.abs(found.distance).max() < 1e-12
    normal = (found.normal @ UNIT) * turn
    assert np.abs(normal - envelope.normal(t)).max() < 1e-6


@settings(max_examples=examples(25), deadline=None)
@given(discs())
def test_second_envelope_joins_the_teeth_smoothly(disc: CycloidDisc) -> None:
    envelope = SecondEnvelope.of(disc)
    ends = np.array([envelope.start, envelope.end])
    first, last = envelope.point(ends)
    tooth_end = disc.ring_pitch_radius - disc.tooth_radius * np.exp(-1j * active_angle(disc))
    assert abs(first - tooth_end) < 1e-12
    half = math.pi / disc.ring_tooth_count
    assert abs(last - swept_radius(disc) * np.exp(1j * half)) < 1e-12
    toward_tooth = np.exp(-1j * active_angle(disc))
    assert abs(envelope.normal(ends)[0] - toward_tooth) < 1e-7
    assert abs(envelope.normal(ends)[1] - np.exp(1j * half)) < 1e-12
    inside = np.linspace(envelope.start, envelope.end, 102)[1:-1]
    step = 1e-6 * (envelope.end - envelope.start)
    slope = (envelope.point(inside + step) - envelope.point(inside - step)) / (2.0 * step)
    speed = envelope.speed(inside)
    assert speed.min() > 0.0
    assert np.abs(slope - 1j * envelope.normal(inside) * speed).max() < 1e-4 * speed.max()
    turn = np.angle(envelope.normal(inside + step) / envelope.normal(inside - step))
    bend = turn / (2.0 * step) / speed
    assert np.allclose(bend, envelope.curvature(inside), rtol=1e-3, atol=1e-3 * np.abs(bend).max())


@settings(max_examples=examples(15), deadline=None)
@given(discs(least_lobes=4, most_lobes=40), st.sampled_from(["solid", "conjugate", "pinwheel"]))
def test_ring_parts_are_closed_symmetric_and_clear(disc: CycloidDisc, kind: str) -> None:
    design = design_of(disc, ring_type=kind, ring={"outer_diameter": 3.0 * disc.ring_pitch_radius})
    try:
        part = ring_contour(design)
    except GeometryError:
        # A conjugate ring exists for every disc; the others need a throw below the tooth's size.
        assert kind != "conjugate"
        assert 2.0 * disc.eccentricity > disc.tooth_radius
        return
    inner = part.holes[0]
    assert isinstance(inner, ArcContour)
    assert np.linalg.norm(inner.points, axis=1).max() <= ring_root_radius(design) + 1e-9
    assert design.reducer.ring.outer_diameter > 2.0 * ring_root_radius(design)
    turned = inner.transformed(rotation=2.0 * math.pi / disc.ring_tooth_count)
    assert inner.distances(turned.points).max() < 1e-12
    assert inner.distances(inner.transformed(mirror=True).points).max() < 1e-12
    if kind != "pinwheel":
        assert np.abs(joint_angles(inner)).max() < 1e-6
        assert not ring_pins(design)
    tolerance = design.edm.profile_tolerance if kind == "conjugate" else 1e-9
    points = _half_gap(disc, inner, 1e-5)
    assert _nearest_ever(disc, points, 400).min() > -tolerance
    exact = ring_moments(design)
    assert part.moments().area == pytest.approx(exact.area, rel=1e-4)
    assert part.moments().polar == pytest.approx(exact.polar, rel=1e-4)


def test_least_concave_radius_is_that_of_the_arcs() -> None:
    for kind in ("solid", "conjugate", "pinwheel"):
        design = design_of(PAPER, ring_type=kind, ring={"outer_diameter": 0.08})
        inner = ring_contour(design, 1e-8).holes[0]
        assert isinstance(inner, ArcContour)
        arcs = inner.arcs()
        concave = arcs.radii[arcs.sweeps > 0.0].min()
        assert concave == pytest.approx(ring_min_concave_radius(design), rel=5e-3)


def test_conjugate_contour_is_wider_by_nothing_but_the_tolerance() -> None:
    """Swept area by brute force equals the area inside the conjugate contour."""
    from scipy.spatial import cKDTree

    design = design_of(PAPER, ring_type="conjugate")
    inner = ring_contour(design).holes[0]
    assert isinstance(inner, ArcContour)
    points = _half_gap(PAPER, inner, 1e-7)
    reached = []
    outline = PAPER.flank(np.linspace(0.0, 2.0 * math.pi, 6000)) @ UNIT
    turn, shift = disc_pose(PAPER, np.linspace(0.0, 2.0 * math.pi, 1500))
    for at, by in zip(turn, shift, strict=True):
        moved = at * outline + by
        reached.append(moved[np.abs(np.angle(moved) - 0.14) < 0.16])
    swept = np.concatenate(reached)
    away, _ = cKDTree(_points(swept)).query(_points(points))
    assert away.max() < 3e-5
    assert _nearest_ever(PAPER, points, 1200).min() > -0.5e-6


def test_pinwheel_has_a_pin_in_every_pocket() -> None:
    design = design_of(PAPER, ring_type="pinwheel", ring={"outer_diameter": 0.08})
    pins = ring_pins(design)
    inner = ring_contour(design).holes[0]
    assert len(pins) == 11
    # The outer half of each pin lies on its pocket.
    for pin in pins:
        out = np.angle(pin.centre @ UNIT)
        back = pin.centre @ UNIT + pin.radius * np.exp(1j * (out + np.linspace(-1.5, 1.5, 31)))
        assert inner.distances(_points(back)).max() < 1e-12
    with pytest.raises(GeometryError, match="too small for pockets"):
        ring_contour(design_of(CycloidDisc(10, 0.032, 0.0024, 0.002), ring_type="pinwheel"))


def test_impossible_rings_say_what_would_work() -> None:
    with pytest.raises(GeometryError, match=r"raise it to 68.7 mm"):
        ring_contour(design_of(PAPER, ring={"outer_diameter": 0.060}))
    assert ring_contour(design_of(PAPER, ring={"outer_diameter": 0.0687})).moments().area > 0.0
    with pytest.raises(GeometryError, match="relief_clearance 6 mm is above") as caught:
        solid_relief(PAPER, 6e-3)
    allowed = float(str(caught.value).split("is above ")[1].split(" mm")[0]) * 1e-3
    assert solid_relief(PAPER, allowed).fillet_radius > 0.0


@settings(max_examples=examples(10), deadline=None)
@given(discs(least_lobes=4, most_lobes=30))
def test_conjugate_ring_and_finished_disc_arcs_do_not_cut_each_other(disc: CycloidDisc) -> None:
    """The two cut contours themselves, in contact, overlap by no more than their tolerances."""
    tolerance = 1e-7
    inner = ring_contour(
        design_of(
            disc, ring_type="conjugate", ring={"outer_diameter": 3.0 * disc.ring_pitch_radius}
        ),
        tolerance,
    ).holes[0]
    outline = lobed_outline(disc, tolerance).sample(2e-5) @ UNIT
    assert float(undercut_radius_limit(disc.lobe_count, disc.ring_pitch_radius, disc.eccentricity))
    for phi in (0.0, 0.4, 2.1):
        turn, shift = disc_pose(disc, phi)
        moved = turn * outline + shift
        sector = moved[np.abs(np.angle(moved)) < 3.0 * math.pi / disc.ring_tooth_count]
        out = _outside(inner.sample(1e-8) @ UNIT, sector)
        gap = inner.distances(_points(sector))
        assert gap[out].max(initial=0.0) < 2.5 * tolerance


def _outside(polygon: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Winding-number test of points against a polygon."""
    ahead, here = np.roll(polygon, -1) - points[:, None], polygon - points[:, None]
    edges = np.angle(ahead * np.conj(here))
    return np.asarray(np.abs(edges.sum(axis=1)) < math.pi)
