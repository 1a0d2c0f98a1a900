"""The reading back of DXF files: right about good files, and refusing every kind of bad one.

The deviation it reports is checked by a second road: the profile written out from its formula
here, the file opened by ezdxf, and every distance searched, not projected.
"""

from __future__ import annotations

import math

import ezdxf
import numpy as np
import pytest
from examples import examples
from geometry_designs import design_of, discs
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from cqdd_design.design import load_design
from cqdd_design.errors import ReadBackError
from cqdd_design.exporting.edm.dxf import contour_fit, draw, write_flat_part
from cqdd_design.exporting.edm.exact_curves import disc_curve, ring_curve
from cqdd_design.exporting.edm.flat_parts import flat_parts
from cqdd_design.exporting.edm.loops import Loop, fit_of
from cqdd_design.exporting.edm.readback import read_back
from cqdd_design.geometry.contours import ArcContour, as_complex
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.disc import lobed_outline
from cqdd_design.geometry.ring import ring_contour, ring_moments
from cqdd_design.machine import resolve

FEW = settings(
    max_examples=examples(15), deadline=None, suppress_health_check=[HealthCheck.filter_too_much]
)


@pytest.fixture(scope="module")
def paper(paper_design_file):
    return load_design(paper_design_file)


@pytest.fixture(scope="module")
def disc(paper):
    return flat_parts(resolve(paper))[0]


@pytest.fixture(scope="module")
def ring(paper):
    return flat_parts(resolve(paper))[1]


@pytest.fixture
def written(paper, disc, tmp_path):
    """A good file of the disc."""
    path = tmp_path / "disc.dxf"
    write_flat_part(disc, paper, path)
    return path


def _sampled_arcs(path, per_arc):
    """Points on the arcs of the one polyline of a file, by ezdxf's own bulge arithmetic, m."""
    (line,) = ezdxf.readfile(path).modelspace().query("LWPOLYLINE")
    rows = line.get_points("xyb")
    points = []
    for (x0, y0, bulge), (x1, y1, _) in zip(rows, rows[1:] + rows[:1], strict=True):
        centre, start, end, radius = ezdxf.math.bulge_to_arc((x0, y0), (x1, y1), bulge)
        span = (end - start) % (2.0 * math.pi)
        angles = start + span * np.linspace(0.0, 1.0, per_arc)
        points.append(complex(*centre) + radius * np.exp(1j * angles))
    return np.concatenate(points) * 1e-3


def _psi_form(design, count):
    """The profile by the angle psi of the literature, leading minus included, m."""
    reducer = design.reducer
    R, r, e, n = (
        reducer.ring_pitch_radius,
        reducer.ring_pin_diameter / 2.0 + reducer.modification.equidistant,
        reducer.eccentricity,
        reducer.ratio,
    )
    t = np.linspace(0.0, 2.0 * math.pi, count, endpoint=False)
    psi = -np.arctan2(np.sin(n * t), R / (e * (n + 1)) - np.cos(n * t))
    x = R * np.cos(t) - r * np.cos(t + psi) - e * np.cos((n + 1) * t)
    y = R * np.sin(t) - r * np.sin(t + psi) - e * np.sin((n + 1) * t)
    return x + 1j * y


def test_deviation_agrees_with_a_search_over_the_whole_curve(paper, disc, written):
    exact = _psi_form(paper, 400_000)
    angle = np.unwrap(np.angle(exact))
    on_file = _sampled_arcs(written, 9)
    place = np.searchsorted(angle, np.mod(np.angle(on_file), 2.0 * math.pi))
    around = (place[:, None] + np.arange(-20, 20)) % len(exact)
    chord = exact[(around + 1) % len(exact)] - exact[around]
    local = (on_file[:, None] - exact[around]) / chord
    beside = np.abs(local - np.clip(local.real, 0.0, 1.0)) * np.abs(chord)
    found = read_back(written, disc, paper.edm)
    assert found.largest_deviation <= 0.5e-6
    assert math.isclose(beside.min(axis=1).max(), found.largest_deviation, rel_tol=0.01)


def test_numbers_of_the_paper_disc(paper, disc, written):
    fit = read_back(written, disc, paper.edm)
    assert fit.segments <= 300
    assert abs(fit.area_error) < 5e-6 * fit.area
    assert abs(fit.perimeter_error) < 1e-5 * fit.perimeter
    assert fit.tangent_break < 1e-9
    valley = 0.032 * (1.0 - 0.55) ** 2 / (11.0 * 0.55 - 1.0) + 0.003506
    assert math.isclose(fit.least_concave_radius, valley, rel_tol=0.005)
    exact = _psi_form(paper, 200_000)
    area = 0.5 * np.sum((np.conj(exact) * np.roll(exact, -1)).imag)
    assert math.isclose(fit.area - fit.area_error, area, rel_tol=1e-8)


@FEW
@given(discs(modified=True, least_lobes=4, most_lobes=30), st.sampled_from([0.2e-6, 0.5e-6, 5e-6]))
def test_every_disc_contour_measures_within_its_tolerance(disc, tolerance):
    contour = lobed_outline(disc, tolerance)
    joints = as_complex(contour.points)
    assume(math.degrees(disc.rotation) < 1.0)
    fit = fit_of(
        Loop(joints, np.roll(joints, -1), contour.bulges), disc_curve(design_of(disc)), outer=True
    )
    assert fit.largest_deviation <= tolerance
    assert fit.rms_deviation <= fit.largest_deviation
    assert fit.tangent_break < 1e-9


@FEW
@given(
    discs(least_lobes=4, most_lobes=30),
    st.sampled_from(["solid", "conjugate", "pinwheel"]),
)
def test_ring_curves_agree_with_the_moments_of_the_ring(disc, ring_type):
    design = design_of(disc, ring_type=ring_type)
    try:
        part = ring_contour(design)
    except Exception:
        assume(False)
    exact = ring_curve(design)
    assert math.isclose(
        exact.area, part.outer.moments().area - ring_moments(design).area, rel_tol=1e-9
    )
    t = np.linspace(0.0, 2.0 * math.pi, 5000, endpoint=False)
    (inner,) = part.holes
    off = inner.distances(np.stack([exact.point(t).real, exact.point(t).imag], axis=-1))
    assert off.max() <= 0.5e-6 if ring_type == "conjugate" else off.max() < 1e-12
    step = 1e-7
    slope = (exact.point(t + step) - exact.point(t - step)) / (2.0 * step)
    smooth = np.abs(np.angle(slope / exact.tangent(t)))
    assert np.quantile(smooth, 0.99) < 1e-4


def _edited(written, edit):
    drawing = ezdxf.readfile(written)
    edit(drawing, drawing.modelspace())
    drawing.saveas(written)


def _line(space):
    (line,) = space.query("LWPOLYLINE")
    return line


def _holes(space):
    return list(space.query('CIRCLE[layer=="CUT_INNER"]'))


def _move_joint(drawing, space):
    with _line(space).points("xyb") as points:
        points[7] = (points[7][0] + 0.001, points[7][1], points[7][2])


def _flip_bulge(drawing, space):
    with _line(space).points("xyb") as points:
        points[5] = (points[5][0], points[5][1], -points[5][2])


def _straighten(drawing, space):
    with _line(space).points("xyb") as points:
        points[3] = (points[3][0], points[3][1], 0.0)


def _double_joint(drawing, space):
    with _line(space).points("xyb") as points:
        points.insert(4, (points[4][0], points[4][1], 0.0))


def _spike(drawing, space):
    with _line(space).points("xyb") as points:
        x, y, _ = points[0]
        points[0:0] = [(x, y, 0.0), (x + 1e-5, y, 0.0)]


def _reverse(drawing, space):
    with _line(space).points("xyb") as points:
        rows = list(points)
        points.clear()
        bulges = [row[2] for row in rows]
        for index in range(len(rows) - 1, -1, -1):
            points.append((rows[index][0], rows[index][1], -bulges[index - 1]))


def _open(drawing, space):
    _line(space).closed = False


def _twice(drawing, space):
    space.add_lwpolyline(
        _line(space).get_points("xyb"), "xyb", close=True, dxfattribs={"layer": "CUT_OUTER"}
    )


def _missing(drawing, space):
    space.delete_entity(_line(space))


def _shift_hole(drawing, space):
    hole = _holes(space)[2]
    hole.dxf.center = hole.dxf.center + ezdxf.math.Vec3(1e-5, 0)


def _swell_hole(drawing, space):
    _holes(space)[2].dxf.radius += 1e-5


def _double_hole(drawing, space):
    hole = _holes(space)[2]
    space.add_circle(hole.dxf.center, hole.dxf.radius, dxfattribs={"layer": "CUT_INNER"})


def _lose_hole(drawing, space):
    space.delete_entity(_holes(space)[2])


def _stray_line(drawing, space):
    space.add_line((0, 0), (1, 1), dxfattribs={"layer": "CUT_INNER"})


def _inches(drawing, space):
    drawing.header["$INSUNITS"] = 1


def _start_on_wall(drawing, space):
    start = space.query('CIRCLE[layer=="START_HOLE"]')[1]
    start.dxf.center = (14.0, 0.0)


def _start_outside(drawing, space):
    start = space.query('CIRCLE[layer=="START_HOLE"]')[1]
    start.dxf.center = (60.0, 0.0)


def _start_lost(drawing, space):
    space.delete_entity(space.query('CIRCLE[layer=="START_HOLE"]')[1])


@pytest.mark.parametrize(
    ("edit", "said"),
    [
        (_move_joint, "leaves the exact curve by"),
        (_flip_bulge, "leaves the exact curve by"),
        (_straighten, "exact curve by|turns by"),
        (_double_joint, "twice in the same place"),
        (_spike, "turns by|leaves the exact curve by"),
        (_reverse, "clockwise"),
        (_open, "not closed"),
        (_twice, "2 polylines on CUT_OUTER"),
        (_missing, "0 polylines on CUT_OUTER"),
        (_shift_hole, "no circle of 7.191000 mm"),
        (_swell_hole, "no circle of 7.191000 mm"),
        (_double_hole, "7 circles are on CUT_INNER; the part has 6"),
        (_lose_hole, "no circle of 7.191000 mm"),
        (_stray_line, "stray LINE"),
        (_inches, "INSUNITS"),
        (_start_on_wall, "cuts into a contour"),
        (_start_outside, "do not serve"),
        (_start_lost, "6 start holes do not serve 7"),
    ],
)
def test_a_spoilt_file_is_refused(paper, disc, written, edit, said):
    read_back(written, disc, paper.edm)
    _edited(written, edit)
    with pytest.raises(ReadBackError, match=said) as caught:
        read_back(written, disc, paper.edm)
    assert caught.value.exit_code == 4


@pytest.mark.parametrize("keep", [0, 1, 100, 20_000, -40])
def test_half_a_file_is_refused(paper, disc, written, keep):
    written.write_bytes(written.read_bytes()[:keep])
    with pytest.raises(ReadBackError):
        read_back(written, disc, paper.edm)


def test_a_binary_file_is_refused(paper, disc, written):
    written.write_bytes(bytes(range(256)) * 50)
    with pytest.raises(ReadBackError, match="not an ASCII DXF"):
        read_back(written, disc, paper.edm)


def test_the_wrong_part_is_refused(paper, ring, written):
    with pytest.raises(ReadBackError):
        read_back(written, ring, paper.edm)


def test_a_wire_too_thick_for_a_corner_names_the_one_that_fits(tmp_path):
    lobes, R = 40, 0.030
    tooth = 0.85 * R * math.sin(math.pi / (lobes + 1))
    sharp = CycloidDisc(lobes, R, 0.7 * R / (lobes + 1), tooth)
    design = design_of(sharp, cam_bearing={"designation": "6801"}, output_pins={"diameter": 0.003})
    ring = flat_parts(resolve(design))[-1]
    least = contour_fit(ring).least_concave_radius
    thick = design.replacing({"edm.wire_diameter": "0.5 mm", "edm.spark_gap": "100 um"})
    assert least < 0.35e-3
    with pytest.raises(
        ReadBackError, match=f"at most {math.floor((least - 0.1e-3) * 2e6) / 1e3:.3f} mm"
    ):
        write_flat_part(ring, thick, tmp_path / "ring.dxf")
    assert list(tmp_path.iterdir()) == []
    thin = thick.replacing({"edm.wire_diameter": 2.0 * (least - 0.1001e-3)})
    write_flat_part(ring, thin, tmp_path / "ring.dxf")


def test_a_contour_beyond_the_tolerance_is_refused(paper, disc, tmp_path):
    coarse = CycloidDisc.from_design(paper)
    loose = type(disc)(
        **{
            **disc.__dict__,
            "shape": type(disc.shape)(
                disc.shape.name, lobed_outline(coarse, 0.6e-6), disc.shape.holes
            ),
        }
    )
    path = tmp_path / "loose.dxf"
    draw(loose, paper, contour_fit(loose)).saveas(path)
    with pytest.raises(ReadBackError, match="profile_tolerance"):
        read_back(path, loose, paper.edm)


def test_area_and_perimeter_of_loops_match_the_integrals_of_contours(disc):
    contour = disc.shape.outer
    assert isinstance(contour, ArcContour)
    joints = as_complex(contour.points)
    loop = Loop(joints, np.roll(joints, -1), contour.bulges)
    assert math.isclose(loop.area, contour.moments().area, rel_tol=1e-12)
    assert math.isclose(loop.perimeter, contour.length(), rel_tol=1e-12)
    angle = np.linspace(0.0, 2.0 * math.pi, 50)
    for radius in (0.02, 0.04):
        points = radius * np.exp(1j * angle)
        expected = contour.distances(np.stack([points.real, points.imag], axis=-1))
        found = [loop.clearance(point) for point in points]
        assert np.allclose(np.abs(found), expected, atol=1e-15)
        assert (np.array(found) > 0.0).all() == (radius > 0.03)
