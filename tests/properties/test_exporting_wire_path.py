"""Paths of the wire: at their distance everywhere, free of crossings, refused when they are not.

Distances are searched here over every arc of the contour, crossings over every pair of chords.
"""

from __future__ import annotations

import dataclasses
import math

import ezdxf
import numpy as np
import pytest
from examples import examples
from geometry_designs import design_of, discs
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from solids_designs import MANY_POCKETS

from cqdd_design.design import load_design
from cqdd_design.errors import CqddError, GeometryError, ReadBackError
from cqdd_design.exporting.edm.begin import NO_PIECE, begun, tab_of, tab_on
from cqdd_design.exporting.edm.dxf import write_flat_part
from cqdd_design.exporting.edm.flat_parts import flat_parts
from cqdd_design.exporting.edm.gcode import program
from cqdd_design.exporting.edm.gcode_check import check_program
from cqdd_design.exporting.edm.loops import Loop
from cqdd_design.exporting.edm.readback import read_back
from cqdd_design.exporting.edm.wire_check import nearest_distances
from cqdd_design.exporting.edm.wire_path import (
    OpenChain,
    offset_contour,
    segmented,
    split_for_tab,
    wire_paths,
)
from cqdd_design.exporting.options import ExportOptions
from cqdd_design.geometry.contours import ArcContour, Circle, as_complex
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.machine import resolve
from cqdd_design.roads.export import export

SEVERAL = settings(
    max_examples=examples(8), deadline=None, suppress_health_check=[HealthCheck.filter_too_much]
)


@pytest.fixture(scope="module")
def paper(paper_design_file):
    return load_design(paper_design_file)


@pytest.fixture(scope="module")
def disc(paper):
    return flat_parts(resolve(paper))[0]


def _crossings(contour):
    """Pairs of chords of a fine polygon that cross, neighbours apart."""
    start = as_complex(contour.sample(2e-6))
    end = np.roll(start, -1)

    def side(a, b, c):
        return ((b - a).conjugate() * (c - a)).imag

    one, two = start[:, None], end[:, None]
    apart = side(one, two, start) * side(one, two, end) < 0.0
    return int(np.sum(apart & apart.T)) // 2


@SEVERAL
@given(
    discs(modified=True, least_lobes=4, most_lobes=25),
    st.sampled_from(["solid", "conjugate", "pinwheel"]),
    st.sampled_from([0.05e-3, 0.1e-3, 0.25e-3]),
)
def test_any_path_keeps_its_distance_and_does_not_cross(disc, ring_type, wire):
    try:
        design = design_of(disc, ring_type=ring_type).replacing({"edm.wire_diameter": wire})
        parts = flat_parts(resolve(design))
        found = [wire_paths(flat, design.edm) for flat in parts]
    except CqddError:
        assume(False)
    offset = wire / 2.0 + design.edm.spark_gap
    for flat, paths in zip(parts, found, strict=True):
        for contour, path in zip((flat.shape.outer, *flat.shape.holes), paths, strict=True):
            points = path.contour.evaluate(np.linspace(0.0, 1.0, 5))[0].reshape(-1, 2)
            away = segmented(contour).distances(points)
            assert np.abs(away - offset).max() < 1e-10
            assert _crossings(path.contour) == 0
            # On the waste side: outside the outer contour, inside the inner ones.
            assert (path.contour.moments().area > segmented(contour).moments().area) == path.outer
            lead = path.start - path.joint
            _, slopes = path.contour.evaluate(np.zeros(1))
            slope = complex(*slopes[0, 0])
            assert abs((lead * slope.conjugate()).real) < 1e-9 * abs(lead) * abs(slope)


@pytest.mark.parametrize("tab", [0.5e-3, 3e-3, 20e-3])
def test_a_contour_begins_half_a_tab_past_its_quiet_place_and_stays_the_same(paper, tab):
    for flat in flat_parts(resolve(paper)):
        for number, contour in enumerate(flat.contours):
            found, same = begun(flat, number, tab), segmented(contour)
            assert found.length() == pytest.approx(contour.length(), rel=1e-12)
            assert found.moments().area == pytest.approx(same.moments().area, rel=1e-12)
            points = found.evaluate(np.linspace(0.0, 1.0, 4))[0].reshape(-1, 2)
            assert same.distances(points).max() < 1e-12
            before, after = split_for_tab(found, 0.5 * tab_of(contour, tab))
            quiet = complex(after.points[0])
            assert before.length + after.length == pytest.approx(contour.length())
            if isinstance(contour, Circle):
                out = complex(*contour.centre)
                expected = 0.0 if abs(out) < contour.radius else np.angle(out)
                assert np.angle(quiet - out) == pytest.approx(expected, abs=1e-9)
            else:
                # To the next of the places that were looked at.
                assert np.angle(quiet) == pytest.approx(flat.quiet_angle, abs=1e-4)


def test_a_tab_between_pockets_ends_before_them(paper):
    """A ring of 41 narrow lands, over which the usual tab would run into the pockets' walls."""
    many = paper.replacing(MANY_POCKETS)
    ring = flat_parts(resolve(many))[-1]
    number = next(i for i, one in enumerate(ring.contours) if one is ring.fitted)
    bore = np.abs(as_complex(ring.fitted.points)).min()
    tab = tab_on(ring, number)
    assert 1e-3 < tab < tab_of(ring.fitted) == 3e-3
    _, after = split_for_tab(begun(ring, number), tab)
    assert np.abs(after.points) == pytest.approx(bore)
    # Straight off the land, towards the axis.
    path = wire_paths(ring, many.edm)[number]
    assert abs(path.start) < bore - 0.5 * path.start_diameter
    usual = flat_parts(resolve(paper.replacing({"reducer.ring_type": "pinwheel"})))[-1]
    assert tab_on(usual, number) == 3e-3


def test_an_arc_moved_sideways_keeps_centre_and_sweep(paper, disc):
    path = wire_paths(disc, paper.edm)[0]
    begins = begun(disc, 0)
    nominal, moved = begins.arcs(), path.contour.arcs()
    assert np.abs(nominal.centres - moved.centres).max() < 1e-12
    assert np.array_equal(nominal.sweeps, moved.sweeps)
    wider = np.where(nominal.sweeps > 0.0, 1.0, -1.0) * paper.edm.wire_offset
    assert np.abs(moved.radii - nominal.radii - wider).max() < 1e-12


def test_a_corner_of_the_material_is_rounded_by_the_wire(paper):
    edm = paper.edm
    square = ArcContour(np.array([[0, 0], [0.01, 0], [0.01, 0.01], [0, 0.01]]), np.zeros(4))
    path = offset_contour(square, edm, outer=True, feature="square")
    offset = edm.wire_offset
    assert len(path) == 8
    assert math.isclose(path.length(), 0.04 + 2.0 * math.pi * offset, rel_tol=1e-12)
    with pytest.raises(ReadBackError, match=r"square: .*sharp inner corner .*round it to 0\.1370"):
        offset_contour(square, edm, outer=False, feature="square")


@pytest.mark.parametrize("radius", [0.137e-3, 0.1e-3, 0.011e-3])
def test_a_wire_too_thick_for_a_hole_names_the_one_that_fits(paper, radius):
    hole = Circle(np.zeros(2), radius)
    most = (round(2e6 * (radius - paper.edm.spark_gap)) - 1) / 1e3
    said = rf"inner contour 3: edm\.wire_diameter 0\.25 mm.*at most {most:.3f} mm"
    if radius < paper.edm.spark_gap:
        said = r"lower edm\.spark_gap below 11 um"
    with pytest.raises(ReadBackError, match=said):
        offset_contour(hole, paper.edm, outer=False, feature="inner contour 3")


@pytest.mark.parametrize("tab", [1e-5, 1e-3, 3e-3, 20e-3])
def test_contour_and_tab_are_the_whole(disc, tab):
    contour = disc.shape.outer
    first, last = split_for_tab(contour, tab)
    lengths = []
    for chain in (first, last):
        chord = np.abs(np.diff(chain.points))
        sweep = 4.0 * np.arctan(chain.bulges)
        lengths.append(float(np.sum(chord / np.sinc(sweep / (2.0 * math.pi)))))
    # To the next joint where one is within this.
    assert math.isclose(lengths[1], tab, rel_tol=1e-9, abs_tol=NO_PIECE)
    assert math.isclose(sum(lengths), contour.length(), rel_tol=1e-12)
    assert first.points[0] == last.points[-1] == complex(*contour.points[0])
    assert first.points[-1] == last.points[0]


@pytest.mark.parametrize("beyond", [-0.8e-6, 0.0, 0.8e-6])
def test_a_cut_leaves_no_piece_that_the_grid_of_coordinates_turns(paper, disc, beyond):
    # A tab whose edge is next to a joint of the profile left 0.8 um of an arc; rounded to 0.1 um
    # it pointed elsewhere, and the program was refused: the wire ran 1.3 um off its way.
    whole = begun(disc, 0, 1e-9)  # from the quiet place on
    joints = np.append(as_complex(whole.points), complex(*whole.points[0]))
    to_joint = OpenChain(joints[:5], whole.bulges[:4]).length
    tab = 2.0 * (to_joint + beyond)
    options = ExportOptions(tab_length=tab)
    for chain in split_for_tab(begun(disc, 0, tab), tab):
        assert np.abs(np.diff(chain.points)).min() > NO_PIECE
        assert len(chain.bulges) == len(chain.points) - 1
    check_program(program(disc, paper, options), disc, paper.edm)


@pytest.fixture
def written(paper, disc, tmp_path):
    path = tmp_path / "disc.dxf"
    write_flat_part(disc, paper, path, wire=wire_paths(disc, paper.edm))
    return path


def _path(space, index=0):
    return space.query('LWPOLYLINE[layer=="WIRE_PATH"]')[index]


def _lead(space, index=0):
    return space.query('LINE[layer=="LEAD_IN"]')[index]


def _shift(space):
    path = _path(space)
    path.translate(0.0005, 0.0, 0.0)


def _bump(space):
    with _path(space).points("xyb") as points:
        x, y, bulge = points[50]
        points[50] = (x * 1.00001, y * 1.00001, bulge)


def _lose_path(space):
    space.delete_entity(_path(space, 3))


def _contour_itself(space):
    line = space.query('LWPOLYLINE[layer=="CUT_OUTER"]')[0]
    path = _path(space)
    with path.points("xyb") as points:
        points[:] = line.get_points("xyb")


def _lose_lead(space):
    space.delete_entity(_lead(space))


def _skew_lead(space):
    lead, hole = _lead(space), space.query('CIRCLE[layer=="START_HOLE"]')[0]
    moved = lead.dxf.start + ezdxf.math.Vec3(0.0, 0.05)
    lead.dxf.start = hole.dxf.center = moved


def _short_lead(space):
    lead = _lead(space)
    lead.dxf.start = lead.dxf.start + ezdxf.math.Vec3(0.1, 0.0)


def _long_lead(space):
    lead = _lead(space)
    lead.dxf.end = lead.dxf.end - ezdxf.math.Vec3(0.05, 0.0)


@pytest.mark.parametrize(
    ("edit", "said"),
    [
        (_shift, "wire path 1: .*from the contour, not 0.13700 mm"),
        (_bump, "wire path 1: .*from the contour, not"),
        (_contour_itself, "from the contour, not"),
        (_lose_path, "6 wire paths and 7 lead-ins for 7 contours"),
        (_lose_lead, "7 wire paths and 6 lead-ins"),
        (_skew_lead, "not square"),
        (_short_lead, "does not join start hole and path"),
        (_long_lead, "does not join start hole and path"),
    ],
)
def test_a_spoilt_path_is_refused(paper, disc, written, edit, said):
    read_back(written, disc, paper.edm, wire_paths=True)
    drawing = ezdxf.readfile(written)
    edit(drawing.modelspace())
    drawing.saveas(written)
    read_back(written, disc, paper.edm)
    with pytest.raises(ReadBackError, match=said):
        read_back(written, disc, paper.edm, wire_paths=True)


def test_a_path_that_runs_twice_round_is_refused(paper, disc, written):
    """Its distance is right everywhere; its length and area are not."""
    drawing = ezdxf.readfile(written)
    path = _path(drawing.modelspace(), 1)
    with path.points("xyb") as points:
        points[:] = [*points, *points]
    drawing.saveas(written)
    with pytest.raises(ReadBackError, match="crosses itself or leaves a stretch out"):
        read_back(written, disc, paper.edm, wire_paths=True)


def test_a_lead_in_through_the_part_is_refused(paper, disc, written):
    """From a start hole straight over the axis, square to the path but through the bore's wall."""
    drawing = ezdxf.readfile(written)
    space = drawing.modelspace()
    lead, hole = _lead(space), space.query('CIRCLE[layer=="START_HOLE"]')[0]
    begin, end = (complex(*point.vec2) for point in (lead.dxf.start, lead.dxf.end))
    across = end - 67.0 * (begin - end) / abs(begin - end)
    lead.dxf.start = hole.dxf.center = (across.real, across.imag)
    drawing.saveas(written)
    with pytest.raises(ReadBackError, match="it would cut into the part"):
        read_back(written, disc, paper.edm, wire_paths=True)


@pytest.mark.parametrize("kinds", ["edm", "gcode", "dxf,edm,gcode"])
def test_a_wire_too_thick_leaves_no_file_and_names_one_that_works(tmp_path, kinds):
    lobes, R = 40, 0.030
    tooth = 0.85 * R * math.sin(math.pi / (lobes + 1))
    sharp = CycloidDisc(lobes, R, 0.7 * R / (lobes + 1), tooth)
    design = design_of(sharp, cam_bearing={"designation": "6801"}, output_pins={"diameter": 0.003})
    thick = design.replacing({"edm.wire_diameter": "0.5 mm", "edm.spark_gap": "100 um"})
    with pytest.raises(ReadBackError, match=r"choose a wire of at most 0\.\d+ mm") as caught:
        export(thick, kinds, tmp_path / "new")
    assert caught.value.exit_code == 4
    assert list(tmp_path.iterdir()) == []
    most = float(str(caught.value).rpartition("at most ")[2].removesuffix(" mm."))
    works = thick.replacing({"edm.wire_diameter": most * 1e-3})
    assert export(works, kinds, tmp_path / "new")


def test_a_start_hole_that_does_not_fit_names_a_wire_that_does(paper, tmp_path):
    small = paper.replacing(
        {
            "reducer.output_pins.diameter": "0.5 mm",
            "reducer.eccentricity": "0.1 mm",
            "edm.wire_diameter": "0.3 mm",
        }
    )
    with pytest.raises(GeometryError, match=r"disc: inner contour 2 .* start hole") as caught:
        export(small, "edm,gcode", tmp_path / "new")
    assert list(tmp_path.iterdir()) == []
    most = float(str(caught.value).rpartition("at most ")[2].removesuffix(" mm."))
    fits = small.replacing({"edm.wire_diameter": most * 1e-3})
    assert wire_paths(flat_parts(resolve(fits))[0], fits.edm)
    thicker = small.replacing({"edm.wire_diameter": (most + 2e-3) * 1e-3})
    with pytest.raises(GeometryError):
        wire_paths(flat_parts(resolve(thicker))[0], thicker.edm)


def test_the_paths_are_frozen(paper, disc):
    with pytest.raises(dataclasses.FrozenInstanceError):
        wire_paths(disc, paper.edm)[0].offset = 0.0


@pytest.mark.parametrize("place", [0.0, 0.09 - 0.05j])
def test_the_nearest_segment_is_found_wherever_the_part_lies(place):
    """Looking only at segments that can be nearest gives what looking at all of them gives."""
    generator = np.random.default_rng(3)

    def star(count, size):
        corners = (
            size
            * generator.uniform(0.6, 1.0, count)
            * np.exp(2j * np.pi * np.arange(count) / count)
        )
        return Loop(
            place + corners, place + np.roll(corners, -1), generator.uniform(-0.4, 0.4, count)
        )

    contour, path = star(60, 0.03), star(23, 0.032)
    points, _ = path.sampled()
    every = np.arange(60)
    brute = [[contour.distances(np.full(60, one), every).min() for one in row] for row in points]
    np.testing.assert_allclose(nearest_distances(path, contour), brute, rtol=0.0, atol=1e-15)
