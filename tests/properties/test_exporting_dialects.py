"""DXF dialects and styles: all read back to the same loops, and spoilt ones are refused."""

from __future__ import annotations

import math
from itertools import product

import ezdxf
import numpy as np
import pytest

from cqdd_design.design import load_design
from cqdd_design.errors import ReadBackError, UsageError
from cqdd_design.exporting import ExportOptions
from cqdd_design.exporting.edm import wire_check
from cqdd_design.exporting.edm.dxf import write_flat_part
from cqdd_design.exporting.edm.dxf_reader import DxfContents, Entity, circles_of, loops_of, read_dxf
from cqdd_design.exporting.edm.flat_parts import flat_parts
from cqdd_design.exporting.edm.readback import read_back
from cqdd_design.exporting.edm.wire_check import nearest_distances
from cqdd_design.exporting.edm.wire_path import wire_paths
from cqdd_design.exporting.options import CHOICES
from cqdd_design.machine import resolve
from cqdd_design.roads.export import export

DIALECTS = [
    ExportOptions(dxf_version=version, dxf_style=style)
    for version, style in product(CHOICES["dxf_version"], CHOICES["dxf_style"])
]
RELEASE = {"R12": "AC1009", "R2000": "AC1015", "R2010": "AC1024"}
LAYERS = ("CUT_OUTER", "CUT_INNER", "WIRE_PATH")


def _name(options):
    return f"{options.dxf_version}-{options.dxf_style}"


@pytest.fixture(scope="module")
def paper(paper_design_file):
    return load_design(paper_design_file)


@pytest.fixture(
    scope="module",
    params=[
        "solid",
        *(pytest.param(name, marks=pytest.mark.deep) for name in ("conjugate", "pinwheel")),
    ],
)
def parts(request, paper):
    design = paper.replacing({"reducer.ring_type": request.param})
    return design, flat_parts(resolve(design))


def _write(flat, design, folder, options, *, wire=True):
    path = folder / f"{flat.label}-{_name(options)}.dxf"
    paths = wire_paths(flat, design.edm) if wire else ()
    write_flat_part(flat, design, path, options, wire=paths)
    return path


@pytest.mark.deep
def test_every_dialect_reads_back_to_the_same_loops(parts, tmp_path, monkeypatch):
    design, flats = parts
    measured = []

    def watched(path, contour):
        measured.append(nearest_distances(path, contour))
        return measured[-1]

    monkeypatch.setattr(wire_check, "nearest_distances", watched)
    for flat in flats:
        seen = []
        for options in DIALECTS:
            path = _write(flat, design, tmp_path, options)
            drawing = ezdxf.readfile(path)
            audit = drawing.audit()
            assert (audit.errors, audit.fixes) == ([], [])
            assert drawing.dxfversion == RELEASE[options.dxf_version]
            contents = read_dxf(path)
            seen.append([loop for at in LAYERS for loop in loops_of(contents, at, "", options)])
            measured.clear()  # writing measures too
            back = read_back(path, flat, design.edm, options, wire_paths=True)
            assert back.largest_deviation <= design.edm.profile_tolerance
            assert back.tangent_break < 1e-6
            assert back.segments <= 300
            # The reader refuses a tenth of a micrometre; what is written is nearer by far.
            paths = loops_of(contents, "WIRE_PATH", "", options)
            assert len(measured) == len(paths) + len(circles_of(contents, "WIRE_PATH")) > 0
            for distances in measured:
                assert np.abs(distances - design.edm.wire_offset).max() < 1e-9
        for loops in seen[1:]:
            assert len(loops) == len(seen[0]) > 1
            for one, other in zip(seen[0], loops, strict=True):
                assert np.abs(one.start - other.start).max() < 1e-12
                assert np.abs(one.bulge - other.bulge).max() < 1e-9
                assert math.isclose(one.area, other.area, rel_tol=1e-11)
                assert math.isclose(one.perimeter, other.perimeter, rel_tol=1e-11)


@pytest.mark.parametrize("options", DIALECTS, ids=_name)
def test_ezdxf_finds_the_entities_of_the_style(paper, tmp_path, options):
    disc = flat_parts(resolve(paper))[0]
    space = ezdxf.readfile(_write(disc, paper, tmp_path, options)).modelspace()
    kinds = [e.dxftype() for e in space.query('*[layer=="CUT_OUTER"]')]
    if options.dxf_style == "entities":
        assert set(kinds) == {"ARC"}
        assert len(kinds) == 270
    else:
        assert kinds == ["POLYLINE" if options.dxf_version == "R12" else "LWPOLYLINE"]
        (line,) = space.query('*[layer=="CUT_OUTER"]')
        assert line.is_closed if options.dxf_version == "R12" else line.closed


def test_ezdxf_sees_arcs_end_to_end_as_long_as_the_contour(paper, tmp_path):
    disc = flat_parts(resolve(paper))[0]
    path = _write(disc, paper, tmp_path, ExportOptions(dxf_style="entities"), wire=False)
    arcs = list(ezdxf.readfile(path).modelspace().query('ARC[layer=="CUT_OUTER"]'))
    for one, two in zip(arcs, arcs[1:] + arcs[:1], strict=True):
        ends = [(arc.start_point, arc.end_point) for arc in (one, two)]
        assert min(a.distance(b) for a in ends[0] for b in ends[1]) < 1e-9
    turns = [(arc.dxf.end_angle - arc.dxf.start_angle) % 360.0 for arc in arcs]
    length = sum(arc.dxf.radius * math.radians(t) for arc, t in zip(arcs, turns, strict=True))
    assert math.isclose(length * 1e-3, disc.shape.outer.length(), rel_tol=1e-12)


def _first(space, kind, layer="CUT_OUTER"):
    return space.query(f'{kind}[layer=="{layer}"]')[0]


def _move(space):
    arc = _first(space, "ARC")
    arc.dxf.center = arc.dxf.center + ezdxf.math.Vec3(1e-4, 0)


def _lose(space):
    space.delete_entity(_first(space, "ARC"))


def _lose_last(space):
    space.delete_entity(space.query('ARC[layer=="CUT_OUTER"]')[-1])


def _stray(space):
    space.add_line((0, 0), (1, 1), dxfattribs={"layer": "CUT_OUTER"})


def _joined(space):
    space.add_lwpolyline([(0, 0), (1, 1)], dxfattribs={"layer": "CUT_OUTER"})


def _grow(space):
    arc = space.query('ARC[layer=="CUT_OUTER"]')[5]
    arc.dxf.radius *= 1.0 + 1e-4


@pytest.mark.parametrize("edit", [_move, _lose, _lose_last, _stray, _grow])
def test_a_broken_chain_is_refused_with_its_place(paper, tmp_path, edit):
    options = ExportOptions(dxf_style="entities")
    disc = flat_parts(resolve(paper))[0]
    path = _write(disc, paper, tmp_path, options, wire=False)
    drawing = ezdxf.readfile(path)
    edit(drawing.modelspace())
    drawing.saveas(path)
    with pytest.raises(ReadBackError, match=r"loose end at \(-?[\d.]+, -?[\d.]+\) mm"):
        read_back(path, disc, paper.edm, options)


def test_the_other_style_is_refused(paper, tmp_path):
    disc = flat_parts(resolve(paper))[0]
    loose, joined = (ExportOptions(dxf_style=style) for style in ("entities", "polyline"))
    path = _write(disc, paper, tmp_path, loose, wire=False)
    with pytest.raises(ReadBackError, match="stray ARC"):
        read_back(path, disc, paper.edm, joined)
    drawing = ezdxf.readfile(path)
    _joined(drawing.modelspace())
    drawing.saveas(path)
    with pytest.raises(ReadBackError, match="stray LWPOLYLINE"):
        read_back(path, disc, paper.edm, loose)


def test_units_must_stand_in_the_notes_of_every_dialect(paper, tmp_path):
    disc = flat_parts(resolve(paper))[0]
    for options in DIALECTS[::2]:
        path = _write(disc, paper, tmp_path, options, wire=False)
        drawing = ezdxf.readfile(path)
        (note,) = [t for t in drawing.modelspace().query("TEXT") if t.dxf.text == "UNITS mm"]
        note.dxf.text = "UNITS in"
        drawing.saveas(path)
        with pytest.raises(ReadBackError, match="UNITS mm"):
            read_back(path, disc, paper.edm, options)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"dxf_version": "R13"}, "R12, R2000, R2010"),
        ({"dxf_style": "polylines"}, "did you mean 'polyline'"),
        ({"step_schema": "AP203"}, "AP214, AP242"),
        ({"tab_length": 0.0}, "nearest is 0.1 mm"),
        ({"tab_length": 1.0}, "nearest is 50 mm"),
        ({"tab_length": math.nan}, "0.1 mm to 50 mm"),
    ],
)
def test_options_name_their_choices(given, said):
    with pytest.raises(UsageError, match=said):
        ExportOptions(**given)


def test_options_reach_the_writers(paper, tmp_path):
    options = ExportOptions(dxf_version="R12")
    files = export(paper, "dxf", tmp_path, options=options)
    assert {ezdxf.readfile(file.path).dxfversion for file in files} == {"AC1009"}


@pytest.mark.parametrize("tolerance", ["0.1 um", "0.5 um", "50 um"])
def test_the_fit_follows_the_tolerance_that_is_set(paper, tmp_path, tolerance):
    design = paper.replacing({"edm.profile_tolerance": tolerance})
    (disc, _) = flat_parts(resolve(design))
    path = _write(disc, design, tmp_path, DIALECTS[0], wire=False)
    fit = read_back(path, disc, design.edm, DIALECTS[0])
    assert 0.5 * design.edm.profile_tolerance < fit.largest_deviation
    assert fit.largest_deviation <= design.edm.profile_tolerance


def test_classes_of_the_newest_dialect_stand_in_an_order_of_their_own(paper, tmp_path):
    options = ExportOptions(dxf_version="R2010")
    for file in export(paper, "dxf", tmp_path, options=options):
        drawing = ezdxf.readfile(file.path)
        used = drawing.entitydb.dxf_types_in_use()
        names = [one.dxf.name for one in drawing.classes if one.dxf.name in used]
        assert names == sorted(names)
        assert len(names) > 1


def test_an_arc_may_cross_the_axis_from_which_angles_count():
    """Half a round plate: an arc of 10 mm from 270 to 90 degrees, and the chord that closes it."""
    arc = {8: "C", 10: 5.0, 20: 0.0, 40: 10.0, 50: 270.0, 51: 90.0}
    chord = {8: "C", 10: 5.0, 20: 10.0, 11: 5.0, 21: -10.0}
    entities = tuple(
        Entity(kind, tuple((code, str(value)) for code, value in tags.items()))
        for kind, tags in (("ARC", arc), ("LINE", chord))
    )
    contents = DxfContents({}, entities)
    (loop,) = loops_of(contents, "C", "plate", ExportOptions(dxf_style="entities"))
    assert loop.area == pytest.approx(0.5 * math.pi * 0.01**2, rel=1e-12)
    assert loop.perimeter == pytest.approx(math.pi * 0.01 + 0.02, rel=1e-12)
