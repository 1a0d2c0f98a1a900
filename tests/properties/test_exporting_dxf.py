"""DXF files: what is in them, how many programs a stack needs, that nothing stray stays."""

from __future__ import annotations

import errno
import math
import os
import subprocess
from collections import Counter
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from examples import examples
from ezdxf.document import Drawing
from geometry_designs import PAPER, design_of, discs
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cqdd_design.catalog import find_bearing
from cqdd_design.design import load_design
from cqdd_design.errors import CqddError, GeometryError, ReadBackError, UsageError
from cqdd_design.exporting import KINDS, read_kinds
from cqdd_design.exporting.edm import dxf, flat_parts
from cqdd_design.exporting.edm.start_holes import start_holes
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.disc import hole_centres, lobed_outline
from cqdd_design.geometry.output_pins import mean_pin_diameter
from cqdd_design.machine import resolve
from cqdd_design.roads.export import export
from cqdd_design.solids.clocking import disc_groups

FLIPPED = "TURNED OVER ABOUT THE X AXIS"
SEVERAL = settings(
    max_examples=examples(12), deadline=None, suppress_health_check=[HealthCheck.filter_too_much]
)


@pytest.fixture(scope="module")
def paper(paper_design_file):
    return load_design(paper_design_file)


@pytest.fixture(scope="module")
def drawings(paper, tmp_path_factory):
    folder = tmp_path_factory.mktemp("dxf")
    written = export(paper, "dxf", folder)
    return {file.path.name: ezdxf.readfile(file.path) for file in written}


def test_one_program_for_the_discs_and_one_for_the_ring(drawings):
    assert sorted(drawings) == ["cqdd-10-disc.dxf", "cqdd-10-ring.dxf"]


def test_layers_hold_what_they_say(drawings):
    def kinds(name, layer):
        return Counter(e.dxftype() for e in drawings[name].modelspace() if e.dxf.layer == layer)

    assert kinds("cqdd-10-disc.dxf", "CUT_OUTER") == {"LWPOLYLINE": 1}
    assert kinds("cqdd-10-disc.dxf", "CUT_INNER") == {"CIRCLE": 6}
    assert kinds("cqdd-10-disc.dxf", "START_HOLE") == {"CIRCLE": 7}
    assert kinds("cqdd-10-ring.dxf", "CUT_OUTER") == {"LWPOLYLINE": 1}
    assert kinds("cqdd-10-ring.dxf", "CUT_INNER") == {"LWPOLYLINE": 1}
    assert kinds("cqdd-10-ring.dxf", "START_HOLE") == {"CIRCLE": 2}
    for drawing in drawings.values():
        layers = {e.dxf.layer for e in drawing.modelspace()}
        assert layers == {"CUT_OUTER", "CUT_INNER", "START_HOLE", "REF", "NOTES"}


def test_holes_for_columns_are_circles_to_cut_with_start_holes(paper, tmp_path):
    columns = {"reducer.carrier.joint": "columns", "reducer.carrier.column_diameter": "4 mm"}
    files = export(paper.replacing(columns), "dxf", tmp_path)
    (path,) = (file.path for file in files if file.path.name == "cqdd-10-disc.dxf")
    space = ezdxf.readfile(path).modelspace()
    cut = [e for e in space if e.dxf.layer == "CUT_INNER"]
    assert Counter(round(2.0 * e.dxf.radius, 4) for e in cut) == {28.0: 1, 7.191: 5, 7.616: 5}
    assert sum(e.dxf.layer == "START_HOLE" for e in space) == 12
    text = "\n".join(e.dxf.text for e in space.query("TEXT"))
    assert "HOLES 1 x dia 28.0000, 5 x dia 7.1910, 5 x dia 7.6160" in text
    assert "CUT 2, FLIP 1" in text


def test_files_are_clean_metric_and_start_where_they_should(drawings):
    for drawing in drawings.values():
        audit = drawing.audit()
        assert (audit.errors, audit.fixes) == ([], [])
        assert drawing.header["$INSUNITS"] == 4
        assert drawing.header["$MEASUREMENT"] == 1
        contours = drawing.modelspace().query("LWPOLYLINE")
        assert all(contour.closed for contour in contours)
        x, y, _ = contours[-1].get_points("xyb")[0]
        assert (x > 0.0, y) == (True, 0.0)


def test_notes_say_what_a_shop_must_know(drawings, paper):
    text = "\n".join(e.dxf.text for e in drawings["cqdd-10-disc.dxf"].modelspace().query("TEXT"))
    for phrase in (
        "PART cqdd-10-disc",
        "UNITS mm",
        "MATERIAL AISI 4140 Q&T 540C",
        "THICKNESS 8",
        "QUANTITY 2",
        "CUT 2, FLIP 1",
        "NO KERF OFFSET",
        "WIRE DIA 0.25",
        "PROFILE TOLERANCE OF THIS FILE 0.5 um",
        "HOLES 1 x dia 28.0000, 5 x dia 7.1910",
        paper.sha256[:16],
    ):
        assert phrase in text
    assert text.isascii()


def test_bytes_are_the_same_in_every_process(in_two_processes):
    code = (
        "import sys; from pathlib import Path; from cqdd_design.design import load_design\n"
        "from cqdd_design.roads.export import export\n"
        "files = export(load_design(Path(sys.argv[1])), 'dxf,svg', Path(sys.argv[2]))\n"
        "print([file.sha256 for file in files])\n"
        "heavy = {'cadquery', 'OCP', 'scipy', 'pint', 'matplotlib', 'trimesh'} & set(sys.modules)\n"
        "assert not heavy, heavy\n"
    )
    first, second = in_two_processes(code)
    assert first.out == second.out


@SEVERAL
@given(st.integers(4, 40), st.integers(3, 12))
def test_quarter_pitch_clocking_makes_two_discs_one_part_for_every_count(lobes, pins):
    """The second disc, turned over about the x axis, is the first: outline and holes alike."""
    R = 0.032
    e = 0.5 * R / (lobes + 1)
    radius = 0.3 * R * math.sin(math.pi / (lobes + 1))
    design = design_of(
        CycloidDisc(lobes, R, e, radius), output_pins={"count": pins, "diameter": 0.001}
    )
    (group,) = disc_groups(design)
    turned_over = group.placements[1].turned_over
    one = hole_centres(design, 0) @ [1.0, 1j]
    two = np.conj(hole_centres(design, 1) @ [1.0, 1j])
    if not turned_over:
        two = np.conj(two)
    # Any whole number of lobe pitches brings lobes onto lobes.
    pitches = np.exp(2j * math.pi * np.arange(lobes) / lobes)
    misses = [np.abs(one[:, None] - turn * two).min(axis=1).max() for turn in pitches]
    assert min(misses) < 1e-12
    outline = lobed_outline(CycloidDisc.from_design(design), 2e-6)
    turned = outline.transformed(mirror=True)
    assert turned.distances(outline.sample(1e-5)).max() < 1e-12


@pytest.mark.parametrize(
    ("clocking", "count", "discs_", "programs"),
    [
        ("9 deg", 5, 2, [(2, f"CUT 2, FLIP 1: DISC 1 AS DRAWN, DISC 2 {FLIPPED}")]),
        ("0 deg", 5, 2, [(1, "DISC 1 OF 2, AS DRAWN"), (1, "DISC 2 OF 2, AS DRAWN")]),
        # 4 holds 2 more often than 10 does: the discs are alike without turning over.
        ("0 deg", 4, 2, [(2, "DISCS 1, 2 OF 2, AS DRAWN")]),
        ("9 deg", 5, 1, [(1, "DISC 1 OF 1, AS DRAWN")]),
        ("9.001 deg", 5, 2, [(1, "DISC 1 OF 2, AS DRAWN"), (1, "DISC 2 OF 2, AS DRAWN")]),
    ],
)
def test_programs_of_a_stack(paper, clocking, count, discs_, programs):
    design = paper.replacing(
        {
            "reducer.output_pins.hole_clocking": clocking,
            "reducer.output_pins.count": count,
            "reducer.disc_count": discs_,
        }
    )
    found = [flat for flat in flat_parts.flat_parts(resolve(design)) if flat.label != "ring"]
    assert [(flat.quantity, flat.remarks[0]) for flat in found] == programs


@pytest.mark.parametrize("diameter", ["4 mm", "5 mm", "2 mm", "7.3 mm"])
def test_holes_are_made_for_the_pins_that_the_loads_are_computed_with(paper, diameter):
    design = paper.replacing({"reducer.output_pins.diameter": diameter})
    mean = mean_pin_diameter(design.reducer.output_pins)
    assert flat_parts.pin_diameter(design) == pytest.approx(mean, abs=1e-12)


def test_an_automatic_bearing_is_that_of_the_checks(paper):
    design = paper.replacing({"reducer.cam_bearing.designation": "auto"})
    chosen = resolve(design).cam.designation
    bore = flat_parts.flat_parts(resolve(design))[0].shape.holes[0]
    assert bore.radius == find_bearing(chosen).outer_diameter / 2.0


def test_discs_that_differ_get_a_file_each(paper, tmp_path):
    design = paper.replacing({"reducer.output_pins.hole_clocking": "0 deg"})
    names = [file.path.name for file in export(design, "dxf", tmp_path)]
    assert names == ["cqdd-10-disc-1.dxf", "cqdd-10-disc-2.dxf", "cqdd-10-ring.dxf"]


@SEVERAL
@given(discs(modified=True, least_lobes=4), st.sampled_from(["solid", "conjugate", "pinwheel"]))
def test_any_design_is_written_or_refused_in_a_sentence(tmp_path_factory, disc, ring_type):
    folder = tmp_path_factory.mktemp("any")
    try:
        design = design_of(disc, ring_type=ring_type)
        files = export(design, "dxf", folder)
    except CqddError:
        assert list(folder.iterdir()) == []
        return
    for file in files:
        audit = ezdxf.readfile(file.path).audit()
        assert (audit.errors, audit.fixes) == ([], [])


@SEVERAL
@given(st.integers(4, 40), st.floats(0.3, 0.8), st.sampled_from(["solid", "conjugate", "pinwheel"]))
def test_start_holes_are_clear_of_every_wall(lobes, shortening, ring_type):
    R = 0.032
    e = shortening * R / (lobes + 1)
    radius = 0.4 * R * math.sin(math.pi / (lobes + 1))
    try:
        design = design_of(
            CycloidDisc(lobes, R, e, radius),
            ring_type=ring_type,
            cam_bearing={"designation": "6801"},
            output_pins={"count": 4, "diameter": 0.003},
        )
        parts = flat_parts.flat_parts(resolve(design))
    except GeometryError:
        return
    for flat in parts:
        holes = start_holes(flat, design.edm.wire_diameter)
        contours = [flat.shape.outer, *flat.shape.holes]
        assert len(holes) == len(contours)
        for hole, own in zip(holes, contours, strict=True):
            for contour in contours:
                wall = contour.sample(1e-6)
                clear = np.hypot(*(wall - hole.centre).T).min() - hole.radius
                assert clear > 0.2e-3, (flat.label, own)


def test_a_contour_too_small_for_the_wire_is_named(paper):
    design = paper.replacing(
        {"reducer.output_pins.diameter": "0.5 mm", "reducer.eccentricity": "0.1 mm"}
    )
    (flat, _) = flat_parts.flat_parts(resolve(design))
    with pytest.raises(GeometryError, match=r"inner contour 2 .* start hole"):
        start_holes(flat, 0.5e-3)


def test_a_file_that_fails_its_reading_back_is_not_left(paper, tmp_path, monkeypatch):
    original = dxf._add_contour

    def careless(space, contour, layer, options):
        original(space, contour.scaled(1.0001), layer, options)

    monkeypatch.setattr(dxf, "_add_contour", careless)
    with pytest.raises(ReadBackError, match=r"cqdd|disc") as caught:
        export(paper, "dxf", tmp_path / "new")
    assert caught.value.exit_code == 4
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_leaves_the_folder_as_it_was(paper, tmp_path, monkeypatch):
    export(paper, "dxf", tmp_path)
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    changed = paper.replacing({"reducer.disc_thickness": "7 mm"})
    original, calls = Drawing.saveas, []

    def filling(self, path, *rest, **options):
        original(self, path, *rest, **options)
        calls.append(path)
        if len(calls) == 2:  # the first file is written whole, the second meets the end
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Drawing, "saveas", filling)
    with pytest.raises(UsageError, match="disk is full") as caught:
        export(changed, "dxf", tmp_path, force=True)
    assert str(tmp_path / "cqdd-10-ring.dxf") in str(caught.value)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="mounting needs root")
def test_a_disk_that_is_really_full(paper, tmp_path):
    room = tmp_path / "room"
    room.mkdir()
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=48k", "tmpfs", str(room)], check=False
    )
    if mounted.returncode != 0:
        pytest.skip("no right to mount here")
    try:
        with pytest.raises(UsageError, match="disk is full"):
            export(paper, "dxf,svg", room)
        assert list(room.iterdir()) == []
        with pytest.raises(UsageError, match="disk is full"):
            export(paper, "dxf", room / "deep" / "er")
        assert list(room.iterdir()) == []
        subprocess.run(["mount", "-o", "remount,ro", str(room)], check=True)
        with pytest.raises(UsageError, match="read-only"):
            export(paper, "dxf", room)
    finally:
        subprocess.run(["umount", str(room)], check=True)


@pytest.mark.skipif(not os.path.isdir("/proc/self"), reason="needs /proc")
def test_a_folder_that_cannot_be_made(paper, tmp_path):
    with pytest.raises(UsageError, match="cannot write"):
        export(paper, "dxf", Path("/proc/cqdd/files"))
    (tmp_path / "file").write_text("")
    with pytest.raises(UsageError, match="cannot write"):
        export(paper, "dxf", tmp_path / "file" / "inside")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_a_named_folder_keeps_its_files_unless_forced(paper, tmp_path):
    (tmp_path / "cqdd-10-ring.dxf").write_text("mine")
    with pytest.raises(UsageError, match="--force"):
        export(paper, "dxf", tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["cqdd-10-ring.dxf"]
    assert (tmp_path / "cqdd-10-ring.dxf").read_text() == "mine"
    export(paper, "dxf", tmp_path, force=True)
    assert (tmp_path / "cqdd-10-ring.dxf").read_text() != "mine"


def test_the_default_folder_is_the_commands_own(paper, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    told = []
    for _ in range(2):
        files = export(paper, ["dxf"], progress=told.append)
    assert {str(file.path.parent) for file in files} == {"exports/cqdd-10"}
    assert all(file.path.stat().st_size == file.bytes for file in files)
    assert told == ["writing dxf"] * 2


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("dfx", "did you mean 'dxf'"),
        ("dxf,stepp", "'step'"),
        (" , ", "dxf, edm, gcode, step"),
        ("x", "svg"),
    ],
)
def test_unknown_kinds_name_the_nearest(text, said):
    with pytest.raises(UsageError, match=said):
        read_kinds(text)


def test_kinds_are_those_of_this_release():
    assert {"dxf", "edm", "gcode", "step", "stl", "3mf", "glb", "svg", "bom"} <= set(KINDS)


def test_tighter_tolerance_gives_more_arcs(paper):
    counts = [
        len(lobed_outline(CycloidDisc.from_design(paper), tolerance))
        for tolerance in (5e-6, 0.5e-6, 0.1e-6)
    ]
    assert counts == sorted(counts)
    assert counts[1] <= 300
    assert len(lobed_outline(PAPER, 0.5e-6)) <= 300
