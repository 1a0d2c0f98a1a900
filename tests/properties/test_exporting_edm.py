"""The EDM package: what is in it, sheets without collisions, the same bytes every time."""

from __future__ import annotations

import math
import os
import re
import tomllib
from datetime import UTC, datetime

import numpy as np
import pytest
from examples import examples
from hypothesis import HealthCheck, given, settings
from legible import assert_legible
from lxml import etree
from solids_designs import MANY_POCKETS, machines

from cqdd_design.catalog import find_material, materials
from cqdd_design.design import Design, load_design
from cqdd_design.design.templates import example_text
from cqdd_design.errors import CqddError, UsageError
from cqdd_design.exporting import ExportOptions
from cqdd_design.exporting.edm.cut_facts import facts_of, zone_text
from cqdd_design.exporting.edm.flat_parts import flat_parts, seats_of
from cqdd_design.exporting.sheets.canvas import pdf_bytes
from cqdd_design.exporting.sheets.cut_sheet import FRONT, draw_sheet, sheet_scale
from cqdd_design.exporting.sheets.drawing import OUTLINE, THIN, SheetDrawing
from cqdd_design.exporting.sheets.lettering import WIDTHS, fitting_height, printable, text_width
from cqdd_design.exporting.sheets.title_block import SCALES
from cqdd_design.machine import resolve
from cqdd_design.report.drawings.wire_edm import edm_view
from cqdd_design.roads.export import export

COLUMNS = {"reducer.carrier.joint": "columns", "reducer.carrier.column_diameter": "4 mm"}
SEVERAL = settings(
    max_examples=examples(8), deadline=None, suppress_health_check=[HealthCheck.filter_too_much]
)


@pytest.fixture(scope="module")
def paper(paper_design_file):
    return load_design(paper_design_file)


@pytest.fixture(scope="module")
def package(paper, tmp_path_factory):
    folder = tmp_path_factory.mktemp("package")
    return {file.path.name: file for file in export(paper, "edm,gcode", folder)}


def test_a_folder_of_its_own_with_a_set_for_every_part(package):
    parts = ("disc", "ring")
    assert sorted(package) == sorted(
        ["README.txt", *(f"cqdd-10-{p}.{e}" for p in parts for e in ("dxf", "nc", "pdf", "svg"))]
    )
    assert {file.path.parent.name for file in package.values()} == {"edm"}
    assert sorted(p.name for p in package["README.txt"].path.parent.iterdir()) == sorted(package)


def test_the_readme_answers_what_a_shop_asks(package):
    text = package["README.txt"].path.read_text(encoding="ascii")
    flowing = " ".join(text.split())
    for phrase in (
        "All files are in millimetres",
        "Quantity 2, plate 8 mm thick",
        "AISI 4140 Q&T 540C: quenched and tempered at 540 deg C before cutting",
        "hardness 335 to 370 HB",
        "270 arcs; largest deviation from the exact curve 0.488 um, rms 0.252 um",
        "Wire of diameter 0.25 mm, spark gap 0.012 mm",
        "holes first, the outer contour last",
        "zone 0.004 mm wide",
        "28 N7 (-0.007/-0.028)",
        "2 discs are one program, cut 2 times without change; 1 of them goes in turned over",
        "Mark the upper face of every disc",
        "M60",
    ):
        assert phrase in flowing
    assert max(map(len, text.splitlines())) <= 78


def test_what_the_next_at_the_bench_needs_is_on_sheet_and_readme(paper, package, tmp_path):
    """Where the cam bearing goes, edges above the corner of the seat, and which disc is which."""
    text = " ".join(package["README.txt"].path.read_text().split())
    assert "middle of the thickness, 0.50 +-0.05 mm below either face" in text
    assert "Outer edges of both faces broken 0.3 to 0.5 mm at 45 deg before the teeth" in text
    assert "Engrave" not in text
    three = resolve(paper.replacing({"reducer.disc_count": 3}))
    marks = [facts_of(flat, three).fitting[-1] for flat in flat_parts(three)]
    assert sum(mark.startswith("Engrave 'disc ") for mark in marks) == len(marks) - 1 > 1
    printed = Design.from_mapping(tomllib.loads(example_text("printed-13")))
    export(printed, "edm", tmp_path)
    (readme,) = tmp_path.rglob("README.txt")
    said = " ".join(readme.read_text().split())
    assert "NO WIRE CUTS disc (PC-CF FDM along layers) AND ring (PC-CF FDM along layers)" in said
    assert "NO WIRE CUTS" not in text


def test_discs_that_are_not_one_part_are_not_said_to_be(paper, tmp_path):
    design = paper.replacing({"reducer.output_pins.hole_clocking": "0 deg"})
    files = {file.path.name: file.path for file in export(design, "edm", tmp_path)}
    assert "cqdd-10-disc-2.dxf" in files
    assert "turned over" not in files["README.txt"].read_text(encoding="ascii")
    sheet = files["cqdd-10-disc-1.svg"].read_text(encoding="utf-8")
    assert "turned over" not in sheet
    assert "mark upper face" not in sheet


@pytest.mark.parametrize(
    "change",
    [
        {},
        pytest.param({"reducer.ring_type": "conjugate"}, marks=pytest.mark.deep),
        {"reducer.ring_type": "pinwheel"},
        # So many pockets that their note is longer than the way to the wall.
        MANY_POCKETS,
        pytest.param({"reducer.disc_count": 3}, marks=pytest.mark.deep),
        pytest.param({"reducer.output_pins.hole_clocking": "0 deg"}, marks=pytest.mark.deep),
        pytest.param({"reducer.output_pins.hole_clocking": "-40 deg"}, marks=pytest.mark.deep),
        pytest.param(COLUMNS, marks=pytest.mark.deep),
        {**COLUMNS, "reducer.output_pins.count": 8, "reducer.carrier.column_count": 4},
    ],
)
def test_text_of_a_sheet_is_apart_and_on_the_page(paper, change):
    design = paper.replacing(change)
    for flat in flat_parts(resolve(design)):
        assert_legible(draw_sheet(facts_of(flat, resolve(design))))


@pytest.mark.deep
@SEVERAL
@given(machines())
def test_sheets_of_any_design_are_legible(machine):
    design, _ = machine
    try:
        facts = [facts_of(flat, resolve(design)) for flat in flat_parts(resolve(design))]
    except CqddError:
        return
    for one in facts:
        assert_legible(draw_sheet(one))
        assert sheet_scale(one) in SCALES


def _words(package, name):
    tree = etree.parse(package[name].path)
    return [e.text for e in tree.iter("{http://www.w3.org/2000/svg}text")]


def test_the_disc_sheet_shows_what_it_must(package):
    words = _words(package, "cqdd-10-disc.svg")
    for phrase in (
        "5 \u00d7 \u00d87.191 \u00b10.002",
        "\u00d80.012 CZ",
        "SIM1",
        "\u00d828 N7 (-0.007/-0.028)",
        "\u00d839",
        "9\u00b0",
        "R4.783",
        "8 +0/-0.02",
        "(\u00d860.188)",
        "0.004 CZ",
        "0.005",
        "AISI 4140 Q&T 540C",
        "335 to 370 HB",
        "2, 1 turned over",
        "mark upper face",
        "2 : 1",
        "ISO 8015, ISO 2768-fH, sizes in mm",
        "outside -0.3, inside +0.3",
        "Cut 2, flip 1: disc 1 as drawn, disc 2 turned over about the X axis.",
    ):
        assert phrase in words, phrase
    assert any("270 arcs" in line for line in words)


def test_holes_for_columns_are_cut_and_said_apart_from_output_holes(paper, tmp_path):
    design = paper.replacing(COLUMNS)
    written = {file.path.name: file for file in export(design, "edm,gcode", tmp_path)}
    words = _words(written, "cqdd-10-disc.svg")
    for phrase in (
        "5 \u00d7 \u00d87.191 \u00b10.002",
        "5 \u00d7 \u00d87.616 \u00b10.002",
        "cycloidal disc of 10 lobes, 5 output holes, 5 for columns; cut by wire EDM",
        "Cut 2, flip 1: disc 1 as drawn, disc 2 turned over about the X axis.",
        "9\u00b0",
    ):
        assert phrase in words, phrase
    readme = " ".join(written["README.txt"].path.read_text(encoding="ascii").split())
    assert "output holes and those for columns +-0.002 mm" in readme
    program = written["cqdd-10-disc.nc"].path.read_text(encoding="ascii")
    assert program.count("DIA 7.6160") == 5


@pytest.mark.parametrize("change", [{}, COLUMNS, {**COLUMNS, "reducer.output_pins.count": 7}])
def test_the_face_is_marked_on_metal(paper, change, monkeypatch):
    drawn, circle = [], SheetDrawing.circle

    def noted(sheet, centre, radius, layer=THIN):
        drawn.append((centre, radius, layer, sheet.scale))
        circle(sheet, centre, radius, layer)

    monkeypatch.setattr(SheetDrawing, "circle", noted)
    machine = resolve(paper.replacing(change))
    flat = flat_parts(machine)[0]
    draw_sheet(facts_of(flat, machine))
    (spot,) = (
        (c - FRONT) / s for c, radius, layer, s in drawn if (radius, layer) == (1.0, OUTLINE)
    )
    for hole in flat.shape.holes:
        assert abs(1e-3 * spot - complex(*hole.centre)) > hole.radius + 0.5e-3


def test_the_ring_sheet_shows_what_it_must(package):
    words = _words(package, "cqdd-10-ring.svg")
    for phrase in (
        "\u00d872 n6 (+0.039/+0.020)",
        "\u00d864",
        "32.7273\u00b0",
        "R5.002",
        "0.0089 CZ",
    ):
        assert phrase in words, phrase


def test_the_mass_on_the_sheet_is_area_times_thickness_times_density(paper):
    for flat in flat_parts(resolve(paper)):
        facts = facts_of(flat, resolve(paper))
        # Area by Green's theorem over fine polygons of every contour.
        area = 0.0
        for sign, contour in ((1, flat.shape.outer), *((-1, h) for h in flat.shape.holes)):
            x, y = contour.sample(1e-8).T
            area += sign * 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
        density = find_material(flat.material).density
        assert math.isclose(facts.mass, area * flat.thickness * density, rel_tol=1e-5)


def test_a_pdf_is_one_whole_page(package):
    data = package["cqdd-10-disc.pdf"].path.read_bytes()
    assert data.startswith(b"%PDF-1.4")
    assert data.endswith(b"%%EOF\n")
    # A3 lying, in points.
    assert b"/MediaBox [0 0 1190.551 841.890]" in data
    place = int(re.search(rb"startxref\n(\d+)\n", data).group(1))
    assert data[place:].startswith(b"xref\n0 7\n")
    entries = re.findall(rb"(\d{10}) 00000 n", data[place:])
    for number, offset in enumerate(entries, start=1):
        assert data[int(offset) :].startswith(b"%d 0 obj" % number)
    length = int(re.search(rb"/Length (\d+)", data).group(1))
    begin = data.index(b"stream\n") + len(b"stream\n")
    assert data[begin + length :].startswith(b"\nendstream")


def test_page_and_package_say_the_same_of_a_part(paper):
    """Holes of D8 stood on the page as shafts of d8."""
    machine = resolve(paper)
    told = edm_view(machine)["remarks"]
    package = [(flat.label, facts_of(flat, machine).remarks) for flat in flat_parts(machine)]
    assert list(told) == [
        f"{label}: {one[0].lower()}{one[1:].removesuffix('.')}"
        for label, all_ in package
        for one in all_
    ]
    assert any(" D8 for dowels" in one for one in told)
    assert any("about the X axis" in one for one in told)


def test_a_date_is_that_of_source_date_epoch_or_of_today(paper, monkeypatch):
    facts = facts_of(flat_parts(resolve(paper))[1], resolve(paper))
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)
    days = [datetime.now(UTC)]
    canvas = draw_sheet(facts)
    days.append(datetime.now(UTC))
    (on_it,) = {f"{day:%Y-%m-%d}" for day in days} & {label.text for label in canvas.labels}
    assert f"/CreationDate (D:{on_it.replace('-', '')}".encode() in pdf_bytes(canvas, "x")
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    canvas = draw_sheet(facts)
    assert b"/CreationDate (D:19700102000000Z)" in pdf_bytes(canvas, "x")
    assert "1970-01-02" in [label.text for label in canvas.labels]


@pytest.mark.deep
def test_bytes_are_the_same_in_every_process(in_two_processes):
    code = (
        "import sys; from pathlib import Path; from cqdd_design.design import load_design\n"
        "from cqdd_design.exporting import ExportOptions\n"
        "from cqdd_design.roads.export import export\n"
        "for style in ('polyline', 'entities'):\n"
        "    options = ExportOptions(dxf_version='R12', dxf_style=style)\n"
        "    files = export(load_design(Path(sys.argv[1])), 'edm,gcode', Path(sys.argv[2]),\n"
        "                   force=True, options=options)\n"
        "    print([file.sha256 for file in files])\n"
        "heavy = {'cadquery', 'OCP', 'matplotlib', 'trimesh', 'scipy'} & set(sys.modules)\n"
        "assert not heavy, heavy\n"
    )
    first, second = in_two_processes(code)
    assert first.out == second.out
    assert "INSUNITS" not in first.err + second.err


def test_files_in_a_folder_of_the_package_are_kept_unless_forced(paper, tmp_path):
    (tmp_path / "edm").mkdir()
    (tmp_path / "edm" / "README.txt").write_text("mine")
    with pytest.raises(UsageError, match=r"edm.README\.txt exists already"):
        export(paper, "dxf,edm", tmp_path)
    assert [str(p.relative_to(tmp_path)) for p in tmp_path.rglob("*") if p.is_file()] == [
        os.path.join("edm", "README.txt")
    ]
    assert (tmp_path / "edm" / "README.txt").read_text() == "mine"
    export(paper, "edm", tmp_path, force=True, options=ExportOptions(dxf_style="entities"))
    text = (tmp_path / "edm" / "README.txt").read_text(encoding="ascii")
    assert "lines and arcs end to end" in text


def test_a_file_where_the_folder_should_be(paper, tmp_path):
    (tmp_path / "edm").write_text("mine")
    with pytest.raises(UsageError, match="cannot write"):
        export(paper, "dxf,edm", tmp_path)
    assert [p.name for p in tmp_path.iterdir()] == ["edm"]


def test_seats_are_brought_to_the_middle_of_their_zones(paper):
    disc, ring = flat_parts(resolve(paper))
    (bore,) = seats_of(disc)
    (outside,) = seats_of(ring)
    for seat in (bore, outside):
        low, high = (seat.diameter + d for d in (seat.limits.lower, seat.limits.upper))
        assert low < seat.middle < high
        # Into the waste makes a hole smaller and the outside larger.
        sign = 1.0 if seat.contour == 0 else -1.0
        assert math.isclose(seat.diameter + sign * 2.0 * seat.shift, seat.middle, rel_tol=1e-12)
    assert (bore.contour, bore.limits.zone) == (1, "N7")
    assert (outside.contour, outside.limits.zone) == (0, "n6")


def test_seats_are_those_of_the_machine(paper):
    parts = {part.name: part for part in resolve(paper).parts}
    for flat in flat_parts(resolve(paper)):
        (seat,) = seats_of(flat)
        fits = parts["ring" if flat.label == "ring" else "disc"].fits
        (fit,) = [one for one in fits if math.isclose(one.diameter, seat.diameter)]
        assert fit.limits == seat.limits


def test_half_grooves_of_the_ring_are_cut_with_it(paper, package):
    _, ring = (facts_of(flat, resolve(paper)) for flat in flat_parts(resolve(paper)))
    (said,) = (one for one in ring.remarks if "half grooves" in one)
    assert said.startswith("8 half grooves \u00d81.5 D8 for dowels")
    assert "327.2727 deg, each within \u00d80.01 of its place, drawn" in said
    (seat,) = ring.seats
    # 72 n6 is +20 to +39 um, 1.5 D8 is +20 to +34 um.
    assert seat.shift == pytest.approx(0.25 * 59e-6)
    drawn = 1.527e-3 + 2.0 * seat.shift
    end = "the shift of the outside cuts them to \u00d81.5270."
    assert said.endswith(f"drawn \u00d8{1e3 * drawn:.4f}: {end}")
    readme = " ".join(package["README.txt"].path.read_text(encoding="ascii").split())
    assert said.replace("\u00d8", "dia ") in readme
    assert "drilled" not in readme


def test_a_drawing_says_the_treatment_as_the_catalogue_has_it(paper):
    for name, said in (("17-4PH H900", "condition H900"), ("Brass CuZn39Pb3", "as delivered")):
        machine = resolve(paper.replacing({"reducer.disc_material": name}))
        assert said in facts_of(flat_parts(machine)[0], machine).heat_treatment


def test_notes_of_treatment_can_be_printed_and_agree_with_the_name():
    found = {name: row.drawing_note for name, row in materials().items()}
    assert found["AISI 4140 Q&T 205C"].startswith("quenched and tempered at 205")
    assert found["17-4PH H900"].startswith("precipitation hardened, condition H900")
    assert found["SCM415/16MnCr5 case hardened"].startswith("case hardened")
    assert found["AISI 52100 / 100Cr6 hardened"].startswith("through hardened")
    assert found["AISI 4140 QT 28-32 HRC prehard (lib)"].startswith("prehardened to 28-32 HRC")
    assert all(printable(words) == words for words in found.values())


def test_zones_follow_the_tolerances_of_the_design(paper):
    disc = flat_parts(resolve(paper))[0]
    wide = paper.replacing({"tolerances.disc_profile": "2 um", "tolerances.hole_position": "5 um"})
    even = paper.replacing({"tolerances.distribution": "uniform"})
    assert zone_text(facts_of(disc, resolve(paper)).zones.profile) == "0.004"
    assert zone_text(facts_of(disc, resolve(wide)).zones.profile) == "0.008"
    assert zone_text(facts_of(disc, resolve(wide)).zones.hole_position) == "0.02"
    assert math.isclose(facts_of(disc, resolve(even)).zones.profile, 2e-6 * math.sqrt(3.0))


def test_widths_are_those_of_helvetica():
    # Adobe's own metrics of some words, summed from the AFM file.
    assert text_width("HAMBURGEFONTS", 0.718) == pytest.approx(9.167)
    assert text_width("0123456789", 0.718) == pytest.approx(5.56)
    assert len(WIDTHS) > 90
    assert fitting_height("0" * 100, 2.5, 50.0) < 1.0
