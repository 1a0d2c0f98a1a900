"""Arc contours: moments, transformations, sampling and distances against independent routes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from examples import examples
from geometry_designs import discs, joint_angles
from hypothesis import given, settings
from hypothesis import strategies as st

from cqdd_design.errors import GeometryError
from cqdd_design.geometry.contours import ArcContour, Circle, PlanarPart
from cqdd_design.geometry.disc import lobed_outline


def _slot(length: float, radius: float) -> ArcContour:
    """Two lines and two half circles, centred on the origin, along x."""
    half = length / 2.0
    points = [[-half, -radius], [half, -radius], [half, radius], [-half, radius]]
    return ArcContour(np.array(points), np.array([0.0, 1.0, 0.0, 1.0]))


def _polygon_moments(points: np.ndarray) -> tuple[float, ...]:
    """Shoelace formulas of a fine polygon: area, x, y, xx, yy, xy."""
    x, y = points.T
    u, v = np.roll(x, -1), np.roll(y, -1)
    c = x * v - u * y
    return (
        c.sum() / 2.0,
        ((x + u) * c).sum() / 6.0,
        ((y + v) * c).sum() / 6.0,
        ((x * x + x * u + u * u) * c).sum() / 12.0,
        ((y * y + y * v + v * v) * c).sum() / 12.0,
        ((x * v + 2.0 * x * y + 2.0 * u * v + u * y) * c).sum() / 24.0,
    )


@given(st.floats(0.001, 10.0), st.floats(0.001, 10.0))
def test_slot_has_its_textbook_moments(length: float, radius: float) -> None:
    slot = _slot(length, radius)
    area = 2.0 * length * radius + math.pi * radius**2
    moments = slot.moments()
    assert moments.area == pytest.approx(area, rel=1e-13)
    assert slot.length() == pytest.approx(2.0 * length + 2.0 * math.pi * radius, rel=1e-13)
    about_x = length * (2.0 * radius) ** 3 / 12.0 + math.pi * radius**4 / 4.0
    assert moments.yy == pytest.approx(about_x, rel=1e-12)
    assert moments.centroid == pytest.approx([0.0, 0.0], abs=1e-12 * (length + radius))


@settings(max_examples=examples(30), deadline=None)
@given(discs(modified=True), st.floats(-4.0, 4.0), st.floats(-0.1, 0.1), st.booleans())
def test_moments_follow_a_moved_contour_and_a_fine_polygon(
    disc: object, rotation: float, shift: float, mirror: bool
) -> None:
    outline = lobed_outline(disc, 1e-6)
    moved = outline.transformed(rotation, (shift, -shift / 2.0), mirror)
    assert moved.moments().area == pytest.approx(outline.moments().area, rel=1e-12)
    assert moved.length() == pytest.approx(outline.length(), rel=1e-12)
    assert moved.moments().about_centroid().polar == pytest.approx(
        outline.moments().about_centroid().polar, rel=1e-9
    )
    scale = outline.moments().area * 0.2**2
    found = moved.moments()
    values = (found.area, found.x, found.y, found.xx, found.yy, found.xy)
    for value, polygon in zip(values, _polygon_moments(moved.sample(1e-8)), strict=True):
        assert value == pytest.approx(polygon, rel=2e-5, abs=2e-5 * scale)
    assert outline.scaled(1e3).moments().area == pytest.approx(
        1e6 * outline.moments().area, rel=1e-12
    )


@given(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), st.floats(0.1, 2.0))
def test_circle_agrees_with_two_half_circles(x: float, y: float, radius: float) -> None:
    circle = Circle(np.array([x, y]), radius)
    halves = ArcContour(np.array([[x + radius, y], [x - radius, y]]), np.ones(2))
    one, two = circle.moments(), halves.moments()
    for name in ("area", "x", "y", "xx", "yy", "xy"):
        assert getattr(one, name) == pytest.approx(getattr(two, name), rel=1e-12, abs=1e-12)
    turned = circle.transformed(0.7, (1.0, 2.0), mirror=True)
    also = halves.transformed(0.7, (1.0, 2.0), mirror=True)
    assert turned.moments().xy == pytest.approx(also.moments().xy, rel=1e-10, abs=1e-10)
    assert circle.length() == pytest.approx(halves.length())
    sample = circle.sample(1e-3 * radius)
    assert np.abs(np.linalg.norm(sample - circle.centre, axis=1) - radius).max() < 1e-12
    assert circle.scaled(2.0).moments().area == pytest.approx(4.0 * circle.moments().area)


def test_sample_keeps_its_tolerance_and_every_joint() -> None:
    slot = _slot(0.05, 0.01)
    points = slot.sample(1e-6)
    ahead = np.roll(points, -1, axis=0)
    assert slot.distances(points).max() < 1e-15
    worst = slot.distances(0.5 * (points + ahead)).max()
    assert 1e-7 < worst <= 1e-6 * (1 + 1e-9)
    for joint in slot.points:
        assert np.linalg.norm(points - joint, axis=1).min() == 0.0


def test_distances_to_arcs_lines_and_ends() -> None:
    slot = _slot(0.04, 0.01)
    points = np.array([[0.0, 0.0], [0.0, 0.05], [0.05, 0.0], [0.02, 0.0], [-0.03, 0.01]])
    corner = math.hypot(0.01, 0.01) - 0.01
    assert slot.distances(points) == pytest.approx([0.01, 0.04, 0.02, 0.01, corner])
    # A three-quarter arc: its centre of gap is nearest to an end, not to the missing circle.
    part = ArcContour(
        np.array([[0.0, -1.0], [-1.0, 0.0]]), np.array([math.tan(1.5 * math.pi / 4), 0.0])
    )
    assert part.distances(np.array([[-2.0, -2.0]])) == pytest.approx([1.5 * math.sqrt(2.0)])
    assert part.distances(np.array([[-1.2, 0.0]])) == pytest.approx([0.2])


def test_arcs_give_back_centre_radius_and_sweep() -> None:
    arcs = _slot(0.04, 0.01).arcs()
    assert arcs.centres[1] == pytest.approx([0.02, 0.0])
    assert arcs.radii[[1, 3]] == pytest.approx([0.01, 0.01])
    assert np.isinf(arcs.radii[[0, 2]]).all()
    assert arcs.sweeps == pytest.approx([0.0, math.pi, 0.0, math.pi])
    assert arcs.start_angles[1] == pytest.approx(-math.pi / 2.0)


def test_joint_angles_find_a_corner() -> None:
    square = ArcContour(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), np.zeros(4))
    assert joint_angles(square) == pytest.approx(np.full(4, math.pi / 2.0))
    assert np.abs(joint_angles(_slot(1.0, 0.3))).max() < 1e-12


def test_part_takes_its_holes_away() -> None:
    part = PlanarPart(
        "plate", _slot(0.04, 0.02), (Circle(np.array([0.02, 0.0]), 0.01), _slot(0.01, 0.002))
    )
    area = _slot(0.04, 0.02).moments().area - math.pi * 1e-4 - _slot(0.01, 0.002).moments().area
    assert part.moments().area == pytest.approx(area)
    assert part.moments().centroid[0] == pytest.approx(-0.02 * math.pi * 1e-4 / area)
    moved = part.transformed(1.0, (0.3, -0.2))
    own, turned = part.moments().about_centroid(), moved.moments().about_centroid()
    assert turned.polar == pytest.approx(own.polar)
    assert turned.xx + turned.yy == pytest.approx(own.polar)
    principal = np.linalg.eigvalsh([[own.xx, own.xy], [own.xy, own.yy]])
    both = [[turned.xx, turned.xy], [turned.xy, turned.yy]]
    assert np.linalg.eigvalsh(both) == pytest.approx(principal)


@pytest.mark.parametrize(
    ("points", "bulges"),
    [
        ([[0.0, 0.0]], [0.0]),
        ([[0.0, 0.0], [1.0, math.nan]], [0.0, 0.0]),
        ([[0.0, 0.0], [0.0, 0.0], [1.0, 0.0]], [0.0, 0.0, 0.0]),
        ([[0.0, 0.0], [1.0, 0.0]], [0.0]),
    ],
)
def test_what_is_no_contour_is_refused(points: list[list[float]], bulges: list[float]) -> None:
    with pytest.raises(GeometryError):
        ArcContour(np.array(points), np.array(bulges))


@pytest.mark.parametrize("radius", [0.0, -1.0, math.nan])
def test_a_circle_has_a_size(radius: float) -> None:
    with pytest.raises(GeometryError, match="above 0 mm"):
        Circle(np.zeros(2), radius)


def test_contours_are_immutable_and_leave_their_input_alone() -> None:
    points = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    contour = ArcContour(points, np.zeros(3))
    points[0] = 5.0
    assert contour.moments().area == pytest.approx(0.5)
    with pytest.raises(ValueError, match="read-only"):
        contour.points[0] = 1.0
