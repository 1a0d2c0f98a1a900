"""Sheets of made parts: all that the features say is on them, and it can be read."""

from __future__ import annotations

import io
import math
import re
import subprocess
from types import SimpleNamespace
from xml.etree import ElementTree

import ezdxf
import numpy as np
import pytest
from legible import assert_legible, crossed, faults, segments

from cqdd_design.design import load_design
from cqdd_design.errors import CatalogError
from cqdd_design.exporting.edm.cut_facts import _WALL_SQUARENESS, facts_of, zone_text
from cqdd_design.exporting.edm.dxf import add_classes, reproducible
from cqdd_design.exporting.edm.flat_parts import flat_parts
from cqdd_design.exporting.sheets import part_sheet
from cqdd_design.exporting.sheets.assembly_facts import AssemblyFacts
from cqdd_design.exporting.sheets.assembly_sheet import draw_assembly
from cqdd_design.exporting.sheets.canvas import render, svg_text
from cqdd_design.exporting.sheets.cut_sheet import draw_sheet
from cqdd_design.exporting.sheets.drawing import OUTLINE, SMALL, new_sheet
from cqdd_design.exporting.sheets.lettering import text_width
from cqdd_design.exporting.sheets.part_facts import PartFacts
from cqdd_design.exporting.sheets.part_sheet import draw_part, plan_sheet
from cqdd_design.exporting.sheets.title_block import SCALES
from cqdd_design.exporting.solids.bom import bill_of_materials
from cqdd_design.files import file_label
from cqdd_design.machine import resolve
from cqdd_design.machine.grease import grease_fill
from cqdd_design.roads.export import export, left_out
from cqdd_design.solids.features.flat import thickness_limits
from cqdd_design.solids.features.holes import (
    BoltCircle,
    ClearanceHole,
    Counterbore,
    FittedHole,
    PlainHole,
    TappedHole,
)
from cqdd_design.solids.features.kinds import (
    AxialThread,
    Chamfer,
    Groove,
    Seat,
    Shoulder,
    Undercut,
)

MM = 1e3
NUMBER = r"(\d+(?:\.\d+)?)"
COLUMNS = {
    "reducer.carrier.joint": "columns",
    "reducer.carrier.column_count": 5,
    "reducer.carrier.column_diameter": "6 mm",
}
NEAR = 5.1e-5
"""Half of the last figure that a sheet writes, mm."""


@pytest.fixture(scope="module")
def machine(paper_design_file):
    return resolve(load_design(paper_design_file))


def turned_parts(machine):
    return [p for p in machine.parts if p.source == "make" and p.exact_section is None]


def drawn(part, machine):
    return render(draw_part(PartFacts(part, machine.given)))


def texts_of(svg):
    root = ElementTree.fromstring(svg)
    return [node.text for node in root.iter("{http://www.w3.org/2000/svg}text")]


def near(one, two):
    return abs(float(one) - two) < NEAR


def free(value):
    """A length (m) without limits as it stands on a sheet, to 0.01 mm."""
    return round(MM * value, 2) / MM


def has_length(texts, value):
    """A height (m) with limits, or rounded without."""
    return has_text(texts, rf"^(-?[\d.]+) \u00b1{NUMBER[1:-1]}$", value) or has_text(
        texts, r"^(-?[\d.]+)$", free(value)
    )


def has_fit(texts, feature):
    """Diameter, zone and both limits as one text."""
    try:
        limits = feature.limits
    except CatalogError:
        return any(t.endswith(f" {feature.zone}") for t in texts)
    pattern = re.compile(rf"\u00d8{NUMBER} (\w+) \(([+-]?[\d.]+)/([+-]?[\d.]+)\)")
    return any(
        near(found[1], MM * feature.diameter)
        and found[2] == feature.zone
        and near(found[3], MM * limits.upper)
        and near(found[4], MM * limits.lower)
        for text in texts
        for found in pattern.finditer(text)
    )


def has_frame(texts, value, datums, lead="", tail="", beside=()):
    """A tolerance, its datums, in this order, one text each, a common one in one, and a mark."""
    cells = [*re.findall("[A-Z](?:-[A-Z])*", datums), *beside]
    for i, text in enumerate(texts):
        found = re.fullmatch(rf"{lead}{NUMBER}{tail}", text)
        if found and near(found[1], MM * value) and texts[i + 1 : i + 1 + len(cells)] == cells:
            return True
    return False


def has_text(texts, pattern, *values):
    """A text of this pattern whose numbers are these values, m."""
    return any(
        all(near(found, MM * value) for found, value in zip(match.groups(), values, strict=True))
        for text in texts
        for match in re.finditer(pattern, text)
    )


def has_roughness(texts, value):
    return any(
        abs(float(m[1]) - 1e6 * value) < 1e-3
        for t in texts
        for m in re.finditer(rf"Ra {NUMBER}", t)
    )


def check_hole(texts, hole, beside):
    count = hole.circle.count
    lead = rf"(?:^|\s){count} \u00d7 " if count > 1 else ""
    if isinstance(hole, TappedHole):
        name = re.escape(f"{hole.designation}-{hole.tolerance}")
        if hole.through:
            assert has_text(texts, rf"{lead}{name}, \u00d8{NUMBER} through", hole.drill)
        else:
            deep = rf"{lead}{name} \u00d7 {NUMBER}/\u00d8{NUMBER} \u00d7 {NUMBER}"
            assert has_text(
                texts, deep, free(hole.thread_depth), hole.drill, free(hole.drill_depth)
            )
        if hole.countersink:
            assert has_text(texts, rf"countersunk \u00d8{NUMBER} \u00d7 90", hole.countersink)
    elif isinstance(hole, ClearanceHole):
        assert has_text(texts, rf"{lead}\u00d8{NUMBER} for M", hole.diameter)
    elif isinstance(hole, Counterbore):
        deep = rf"{lead}counterbore \u00d8{NUMBER} \u00d7 {NUMBER}"
        assert has_text(texts, deep, hole.diameter, free(hole.depth))
    elif isinstance(hole, FittedHole):
        assert has_fit(texts, hole)
        assert has_roughness(texts, hole.roughness)
    else:
        assert isinstance(hole, PlainHole)
        assert has_text(texts, rf"{lead}\u00d8{NUMBER}", free(hole.diameter))
    if getattr(hole, "position", 0.0):
        tail = " CZ" if count > 1 else ""
        assert has_frame(texts, hole.position, hole.refers, "\u00d8", tail, beside), hole
    assert has_text(texts, rf"^\u00d8{NUMBER}$", 2.0 * hole.circle.radius)
    for x, y in hole.circle.centres:
        assert any(
            re.fullmatch(r"H\d+\.\d+", a) and near(b, MM * x) and near(c, MM * y)
            for a, b, c in zip(texts, texts[1:], texts[2:], strict=False)
            if re.fullmatch(r"-?[\d.]+", b) and re.fullmatch(r"-?[\d.]+", c)
        )


def check_part(part, texts):
    """Every feature's sizes and tolerances are on the sheet, with the feature's values."""
    features = part.features
    faces = [f for f in features if isinstance(f, Shoulder)]
    origin = next((f.height for f in faces if f.datum), part.shape.bottom)
    chamfers: dict[tuple[float, float], int] = {}
    # Zones of one frame, and those of all, keep their places among each other (ISO 5458:2018).
    beside = ["SIM1"] if sum(bool(getattr(f, "position", 0.0)) for f in features) > 1 else []
    assert any(t.startswith("SIM1: zones so marked") for t in texts) == bool(beside)
    for feature in features:
        if isinstance(feature, Seat):
            assert has_fit(texts, feature), feature
            assert has_roughness(texts, feature.roughness)
            assert has_frame(texts, feature.cylindricity, "")
            if feature.position:
                refers = feature.refers
                assert has_frame(texts, feature.position, refers, "\u00d8", "", beside), feature
                assert has_text(texts, rf"^{NUMBER}$", math.hypot(*feature.centre))
            elif feature.refers:
                assert has_frame(texts, feature.run_out, feature.refers), feature
            for end in (feature.bottom, feature.top):
                assert has_length(texts, end - origin), feature
        elif isinstance(feature, Shoulder):
            assert has_roughness(texts, feature.roughness)
            if feature.along:
                pattern = rf"^(-?[\d.]+) \u00b1{NUMBER}$"
                assert has_text(texts, pattern, feature.height - origin, feature.along), feature
            else:
                assert has_text(texts, r"^(-?[\d.]+)$", free(feature.height - origin)), feature
            if feature.refers:
                assert has_frame(texts, feature.run_out, feature.refers), feature
            if feature.rim:
                pattern = rf"^\u00d8{NUMBER} \(0/-{NUMBER}\)$"
                assert has_text(texts, pattern, 2.0 * feature.outer, feature.rim), feature
        elif isinstance(feature, Chamfer):
            key = (round(feature.width, 9), round(math.degrees(feature.angle), 6))
            chamfers[key] = chamfers.get(key, 0) + len(feature.centres)
        elif isinstance(feature, Undercut):
            pattern = rf"DIN 509 - E {NUMBER} \u00d7 {NUMBER}"
            assert has_text(texts, pattern, feature.radius, feature.depth)
        elif isinstance(feature, Groove):
            pattern = rf"{feature.standard}: \u00d8{NUMBER} \u00d7 {NUMBER}, R{NUMBER}"
            size = feature.top - feature.bottom
            assert has_text(texts, pattern, feature.diameter, size, feature.fillet)
        elif isinstance(feature, AxialThread):
            name = feature.designation.replace(" x ", " \u00d7 ")
            assert f"{name}-{feature.tolerance}" in texts
        elif hasattr(feature, "circle"):
            check_hole(texts, feature, beside)
        if getattr(feature, "datum", ""):
            assert any(t.startswith(f"Datum {feature.datum}: ") for t in texts)
    for (width, angle), count in chamfers.items():
        many = f"{count} \u00d7 " if count > 1 else ""
        assert f"{many}{MM * width:.4g} \u00d7 {angle:g}\u00b0" in texts, chamfers


def check_title(part, texts):
    assert part.name in texts
    assert part.material in texts
    assert str(part.count) in texts
    assert any(
        near(t[:-2], 0.0) or float(t[:-2]) > 0.0 for t in texts if re.fullmatch(r"[\d.]+ g", t)
    )
    mass = [float(t[:-2]) for t in texts if re.fullmatch(r"[\d.]+ g", t)]
    assert any(math.isclose(m, MM * part.mass, rel_tol=1e-3) for m in mass)
    assert "ISO 8015, ISO 2768-mK, sizes in mm" in texts


def test_what_features_say_is_on_the_sheets_of_plate_and_shaft(machine):
    names = {"carrier plate", "eccentric shaft"}
    parts = [part for part in turned_parts(machine) if part.name in names]
    assert len(parts) == 2
    for part in parts:
        canvas = drawn(part, machine)
        texts = texts_of(svg_text(canvas, part.name))
        check_part(part, texts)
        check_title(part, texts)
        assert_legible(canvas)
        assert plan_sheet(PartFacts(part, machine.given)).scale in SCALES


def test_a_wrong_value_would_be_seen(machine):
    part = next(part for part in turned_parts(machine) if part.name == "carrier plate")
    texts = texts_of(svg_text(drawn(part, machine), ""))
    for written, instead in (
        ("\u00d822 H7 (+0.021/0)", "\u00d822 H7 (+0.021/-0.001)"),
        ("\u00d80.018 CZ", "\u00d80.019 CZ"),
        ("\u00d80.018 CZ", "\u00d80.018"),
        ("SIM1", ""),
        ("19.2599", "19.2598"),
        ("\u00d839", "\u00d839.1"),
    ):
        assert written in texts
        with pytest.raises(AssertionError):
            check_part(part, [instead if text == written else text for text in texts])


def test_no_wire_and_no_grindstone_makes_a_printed_disc(paper_design_file):
    design = load_design(paper_design_file.with_name("printed-13.toml"))
    machine = resolve(design)
    for flat in flat_parts(machine):
        facts = facts_of(flat, machine)
        canvas = draw_sheet(facts)
        texts = texts_of(svg_text(canvas, flat.label))
        assert_legible(canvas)
        for label in canvas.labels:
            if re.match(r"\u00d8.* N7", label.text):
                assert not len(crossed(label, segments(canvas, 0.0))), label.text
        words = " ".join(texts)
        assert "printed, FDM" in words
        assert "export --to print" in words
        for of_metal in ("wire", "ground", "recast", "CUTS IN ORDER", "Ra 0.4", "+0/-0.02"):
            assert of_metal not in words, of_metal
        # A printer keeps 0.127 mm or 0.15 %; no wall is squarer than its contour is true.
        assert "25 \u00b10.13" in words
        assert texts.count(zone_text(facts.zones.profile)) == 1
        assert zone_text(_WALL_SQUARENESS) not in texts
    housing = next(part for part in machine.parts if part.name == "housing")
    assert "as printed, FDM, where not marked" in texts_of(svg_text(drawn(housing, machine), ""))
    assert (
        "no wire cuts discs (PC-CF FDM along layers) and ring" in left_out(design, "gcode,bom")[0]
    )
    assert left_out(design, "sheets,bom") == ()
    assert left_out(load_design(paper_design_file), "edm,gcode") == ()


@pytest.fixture(scope="module")
def printed(paper_design_file):
    return resolve(load_design(paper_design_file.with_name("printed-13.toml")))


def test_a_printed_ring_has_its_grooves_at_their_size(printed, machine):
    """No wire is shifted for its outside, so that none cuts them to another size."""
    ring = next(flat for flat in flat_parts(printed) if flat.label == "ring")
    grooves = 2.0 * printed.layout.dowels.radius
    arcs = ring.shape.outer.arcs()
    assert np.isclose(2.0 * arcs.radii, grooves, rtol=1e-9).sum() >= 4
    assert not any("CUTS" in told or "DRAWN" in told for told in ring.remarks)
    cut = next(flat for flat in flat_parts(machine) if flat.label == "ring")
    assert any("THE SHIFT OF THE OUTSIDE CUTS THEM TO DIA 1.5270" in told for told in cut.remarks)


def test_a_balance_weight_can_be_made_from_its_sheet(printed):
    weight = next(p for p in printed.parts if p.name == "balance weight, output end")
    canvas = drawn(weight, printed)
    assert_legible(canvas)
    (contour,) = (layer.shape.outer for layer in weight.shape.layers)
    inner = MM * float(contour.arcs().radii[np.isfinite(contour.arcs().radii)].min())
    texts = texts_of(svg_text(canvas, ""))
    said = next(text for text in texts if "ends radial" in text)
    radius, angle = map(float, re.findall(NUMBER, said))
    assert radius == pytest.approx(round(inner, 2))
    (outside,) = (text for text in texts if re.fullmatch(f"\u00d8{NUMBER}", text))
    outer = 0.5 * float(outside[1:])
    thick = MM * (weight.shape.top - weight.shape.bottom)
    area = math.radians(angle) * (outer**2 - radius**2) / 2.0
    assert area * thick == pytest.approx(1e9 * weight.shape.volume, rel=2e-3)
    assert PartFacts(weight, printed.given).number == "printed-13-balance-weight-output-end"


def test_weights_go_in_with_the_bell_that_they_are_bonded_on(printed):
    facts = AssemblyFacts(printed)
    order = facts.order()
    (told,) = (note for note in facts.notes() if "heat-set inserts" in note)
    items = {row[0] for row in facts.parts_list() if row[2] == "heat-set insert"}
    assert items
    assert items == set(re.findall(r"\d+", told))
    weights = [said for said in order if "balance weight" in said]
    assert len(weights) == 2
    assert all(said.startswith("unit of the rotor bell: ") for said in weights)
    assert any("the middle at 180\u00b0 from the shaft's lobe 1" in n for n in notes_of(printed))


def notes_of(machine):
    return AssemblyFacts(machine).notes()


@pytest.fixture(scope="module")
def screwed(printed):
    """With pins that are screws: its own are dowels."""
    tough = {"reducer.output_pins.material": "Alloy steel 12.9 (ISO 7379)"}
    return resolve(printed.given.replacing(tough))


def test_the_sheet_of_a_plastic_part_names_the_inserts_in_its_threads(screwed):
    plate = next(p for p in screwed.parts if p.name == "carrier plate")
    said = part_sheet.notes(PartFacts(plate, screwed.given))
    assert sum("heat-set insert M4 x 8.1 in holes of 5.6 mm" in note for note in said) == 2
    assert sum("after printing these surfaces are cut to size" in note for note in said) == 1


def test_half_grooves_are_made_before_their_seat_is_bored(machine, printed):
    """A drill across a seam of steel and aluminium runs off into the aluminium."""

    def said(made):
        housing = next(one for one in made.parts if one.name == "housing")
        return " ".join(part_sheet.notes(PartFacts(housing, made.given)))

    assert "drilled and reamed whole while the seat still has its stock" in said(machine)
    assert "Half grooves" not in said(printed)


def test_the_loose_cam_has_a_direction(machine):
    three = resolve(machine.given.replacing({"reducer.disc_count": 3}))
    (said,) = (note for note in notes_of(three) if "Eccentric cam pressed" in note)
    assert "lobe 3 is at 240\u00b0 from lobe 1, \u00b10.21\u00b0" in said
    assert "axis within \u00d80.012 of its place to A-B" in said


def test_no_general_size_asks_for_tenths_of_a_micrometre(machine):
    """A ring of 76 mm makes proportions uneven, such as 118.9889 mm, turned to 0.3 mm."""
    other = resolve(machine.given.replacing({"reducer.ring.outer_diameter": "76 mm"}))
    for part in turned_parts(other):
        texts = texts_of(svg_text(drawn(part, other), ""))
        assert "Sizes without limits of their own are rounded to 0.01 mm." in " ".join(texts)
        bare = [text for text in texts if re.fullmatch(rf"\u00d8?-?{NUMBER}", text)]
        table = {f"{MM * at:.4f}" for group in PartFacts(part, other.given).holes
                 for spot in group[0].circle.centres for at in spot}  # fmt: skip
        boxed = {MM * 2.0 * group[0].circle.radius for group in PartFacts(part, other.given).holes}
        boxed |= {MM * abs(complex(*one.centre)) for one in part.features if isinstance(one, Seat)}
        for text in bare:
            value = float(text.lstrip("\u00d8"))
            if text in table or any(near(value, one) for one in boxed) or value < 0.1:
                continue
            assert value == pytest.approx(round(value, 2), abs=1e-9), (part.name, text)


def test_a_plain_hole_that_the_view_hides_goes_through(machine):
    """A stator behind the gearbox has its leads go through a flange that another one covers."""
    other = resolve(machine.given.replacing({"reducer.ring.outer_diameter": "84 mm"}))
    housing = next(part for part in other.parts if part.name == "housing")
    (leads,) = (one for one in housing.features if isinstance(one, PlainHole))
    centre = np.array(leads.circle.centres[0])

    def solid(layer):
        empty = (h for h in layer.shape.holes if np.hypot(*(h.centre - centre)) < h.radius)
        return next(empty, None) is None and (
            np.hypot(*layer.shape.outer.sample(1e-5).T).max() > np.hypot(*centre)
        )

    beside = [one for one in housing.shape.layers
              if one.bottom < leads.top + 1e-9 and one.top > leads.bottom - 1e-9]  # fmt: skip
    assert len(beside) > 2
    assert not any(solid(one) for one in beside)
    texts = texts_of(svg_text(drawn(housing, other), ""))
    assert "through, from the far side" in texts


def test_a_seat_over_a_thread_right_through_is_on_the_far_side_of_the_view(screwed):
    """Seen from the output the threads come through, and the pins' seats are behind them."""
    plate = next(part for part in screwed.parts if part.name == "carrier plate")
    threads = next(one for one in plate.features if one.name == "threads of the pins")
    assert threads.through
    assert "fitted bore from the far side" in texts_of(svg_text(drawn(plate, screwed), ""))


def test_the_sheet_of_a_loose_cam_says_when_it_is_ground(machine):
    """Its lobe, before: the order of assembly has a disc and a bearing on the shaft by then."""
    three = resolve(machine.given.replacing({"reducer.disc_count": 3}))
    cam = next(part for part in three.parts if part.name == "eccentric cam")
    (said,) = (one for one in part_sheet.notes(PartFacts(cam, three.given)) if "before" in one)
    assert "bonded over the whole bore with LOCTITE 648" in said
    grown = 5.0 * 10.3 / 15.0
    assert f"At most 5 \u00b5m of interference make it grow by {grown:.1f} \u00b5m" in said
    order = AssemblyFacts(three).order()
    first = [one.split(",")[0] for one in order]
    assert first.index("eccentric shaft") > first.index("disc 2")
    assert first.index("eccentric cam") > first.index("cam bearing 2")
    lobe = next(one for one in cam.features if getattr(one, "name", "") == "lobe 3")
    assert lobe.zone == "g5"
    assert_legible(drawn(cam, three))


@pytest.mark.parametrize("name", ["cqdd-10", "printed-13"])
def test_the_parts_list_is_the_bill(name, paper_design_file):
    machine = resolve(load_design(paper_design_file.with_name(f"{name}.toml")))
    bill = bill_of_materials(machine, machine.parts)
    listed = AssemblyFacts(machine).parts_list()
    assert [(int(row[0]), int(row[1]), row[2]) for row in listed] == [
        (row.item, row.quantity, row.part) for row in bill
    ]
    stator = next(row.item for row in bill if row.part == "motor stator")
    for row, line in zip(listed, bill, strict=True):
        assert row[3] == line.designation or line.item == stator
    assert_legible(render(draw_assembly(AssemblyFacts(machine))))


def test_a_motor_that_is_not_drawn_is_in_the_parts_list_as_in_the_bill(paper_design_file):
    design = load_design(paper_design_file).replacing({"motor.name": "MAD 5010 110KV"})
    machine = resolve(design)
    bill = bill_of_materials(machine, machine.parts)
    listed = AssemblyFacts(machine).parts_list()
    assert [row[2] for row in listed] == [row.part for row in bill]


@pytest.mark.deep
def test_no_line_runs_through_words(machine, paper_design_file):
    """Thin lines neither: leaders, axes and extension lines."""
    for flat in flat_parts(machine):
        assert_untouched(draw_sheet(facts_of(flat, machine)))
    paper = load_design(paper_design_file)
    three = paper.replacing({"reducer.disc_count": 3})
    inrunner = paper.replacing({"motor.name": "CubeMars RI100 KV105"})
    for one in (machine, resolve(three), resolve(inrunner)):
        for part in turned_parts(one):
            assert_untouched(drawn(part, one))


def test_the_pocket_of_a_rotor_hub_has_its_sizes(machine):
    """Rim, web and boss are layers within each other: their walls are free but for the web."""
    inrunner = resolve(machine.given.replacing({"motor.name": "CubeMars RI100 KV105"}))
    hub = next(part for part in inrunner.parts if part.name == "rotor hub")
    texts = texts_of(svg_text(drawn(hub, inrunner), ""))
    layers = hub.shape.layers
    sizes = {2.0 * MM * c.radius for one in layers for c in (one.shape.outer, *one.shape.holes)}
    for size in sizes:
        assert any(text.startswith(f"\u00d8{size:.4g}") for text in texts), size
    for layer in layers:
        for height in (layer.bottom, layer.top):
            assert any(near(text, MM * free(height - hub.length_origin)) for text in numbers(texts))


def test_no_ring_pin_is_longer_than_the_thinnest_ring(machine):
    """Of a longer one the clamp would press the pin, and leave the ring loose."""
    rolling = resolve(machine.given.replacing({"reducer.ring_type": "pinwheel"}))
    pin = next(part for part in rolling.parts if part.name == "ring pin")
    texts = texts_of(svg_text(drawn(pin, rolling), ""))
    (said,) = (text for text in texts if text and "\u00b1" in text)
    length, either = map(float, said.split(" \u00b1"))
    lower, _ = thickness_limits(rolling.design.reducer.ring_material, 16.5e-3)
    assert length == pytest.approx(MM * (pin.shape.top - pin.shape.bottom))
    assert length + either <= 16.5 + MM * lower
    assert pin.designation == f"ground pin 7 x {length:g} mm"


def numbers(texts):
    return [text for text in texts if text and re.fullmatch(r"-?\d+(\.\d+)?", text)]


def assert_untouched(canvas):
    ends = segments(canvas, 0.0)
    assert not [label.text for label in canvas.labels if len(crossed(label, ends))]


def test_cut_sheets_name_the_axes_that_angles_are_from(machine):
    for flat in flat_parts(machine):
        texts = texts_of(svg_text(draw_sheet(facts_of(flat, machine)), ""))
        assert {"X", "Y"} <= set(texts)


@pytest.mark.parametrize("radius", [0.05, 0.123, 1.5])
def test_the_table_of_holes_is_as_wide_as_its_numbers(radius):
    facts = SimpleNamespace(holes=[[SimpleNamespace(circle=BoltCircle.even("x", 7, radius))]])
    *begins, end = part_sheet._columns(facts)
    for row in part_sheet.hole_places(facts):
        for word, begin, stop in zip(row, begins, [*begins[1:], end], strict=True):
            assert 0.8 + text_width(word, SMALL) < stop - begin - 0.4, word


def test_text_on_text_and_on_thick_lines_is_found():
    sheet = new_sheet(1.0)
    sheet.text(100.0 + 100.0j, "alone")
    sheet.text(50.0 + 200.0j, "thin is fine")
    sheet.line(40.0 + 201.0j, 90.0 + 201.0j)
    assert not faults(render(sheet))
    sheet.circle(112.0 + 101.0j, 8.0, OUTLINE)
    sheet.text(51.0 + 201.0j, "on it")
    found = faults(render(sheet))
    assert [text.split(":")[0] for text in found] == ["crossed", "on each other"]


@pytest.fixture(scope="module")
def sheets(machine, tmp_path_factory):
    design = machine.given
    return {f.path.name: f.path for f in export(design, "sheets", tmp_path_factory.mktemp("s"))}


def test_the_same_sheet_is_the_same_bytes_in_every_process_and_at_every_time():
    document = new_sheet(1.0).drawing
    add_classes(document)
    text = io.StringIO()
    with reproducible():
        document.write(text)
    # The library stamps its version and the time that it made and wrote a document.
    assert not re.search(r"@ (?!2000-01-01T)\d{4}-", text.getvalue())
    assert len(re.findall("@ 2000-01-01T", text.getvalue())) == 2
    section = text.getvalue().partition("CLASSES")[2].partition("ENDSEC")[0]
    names = re.findall(r"\n *0\nCLASS\n *1\n(\w+)\n", section)
    in_use = {"ACDBDICTIONARYWDFLT", "ACDBPLACEHOLDER", "LAYOUT", "MATERIAL", "MLEADERSTYLE"}
    used = [name for name in names if name in in_use]
    assert used == sorted(used)
    assert len(used) > 3


@pytest.mark.deep
def test_every_made_part_has_three_files_that_open(sheets, machine):
    names = [f"cqdd-10-{file_label(p.name)}" for p in machine.parts if p.source == "make"]
    names.append("cqdd-10-assembly")
    assert sorted(sheets) == sorted(f"{n}.{end}" for n in names for end in ("pdf", "svg", "dxf"))
    for name in names:
        audit = ezdxf.readfile(sheets[f"{name}.dxf"]).audit()
        assert not audit.errors, name
        assert not audit.fixes, name
        shown = ["pdftoppm", "-r", "20", "-png", "-singlefile", str(sheets[f"{name}.pdf"])]
        result = subprocess.run(shown, capture_output=True, check=True)
        assert result.stdout.startswith(b"\x89PNG")


@pytest.mark.deep
@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("cqdd-10", {}),
        ("reference-s", {}),
        ("printed-13", {}),
        ("cqdd-10", {"reducer.disc_count": 3, "reducer.ring_type": "pinwheel"}),
        ("cqdd-10", COLUMNS),
    ],
)
def test_every_feature_of_every_part_is_on_its_sheet(name, change, paper_design_file):
    design = load_design(paper_design_file.with_name(f"{name}.toml")).replacing(change)
    machine = resolve(design)
    for part in turned_parts(machine):
        canvas = drawn(part, machine)
        texts = texts_of(svg_text(canvas, part.name))
        check_part(part, texts)
        check_title(part, texts)
        assert_legible(canvas)
    assembly = AssemblyFacts(machine)
    canvas = render(draw_assembly(assembly))
    assert_legible(canvas)
    texts = texts_of(svg_text(canvas, "assembly"))
    for item, part in enumerate(machine.parts, start=1):
        assert str(item) in texts
        # A long name has two lines.
        rests = [part.name[len(t) :].strip() for t in texts if t and part.name.startswith(t)]
        assert any(not rest or rest in texts for rest in rests), part.name
    assert len(assembly.order()) >= len(machine.parts)
    free = grease_fill(machine).free
    assert 0.0 < free < np.pi * machine.layout.pack.ring_radius**2 * 0.1


@pytest.mark.parametrize("outer", ["72 mm", "69.1 mm", "71.3 mm"])
def test_lengths_run_from_a_face_with_a_circle(machine, outer):
    # Faces at odd heights are 0.1 nm off their rounded ones: no circle was drawn, but an arrow.
    for part in turned_parts(machine.changed({"reducer.ring.outer_diameter": outer})):
        facts = PartFacts(part, machine.given)
        lengths = plan_sheet(facts).section.lengths
        sheet = new_sheet(1.0)
        lengths.draw(sheet, 0j, [0.0] * len(lengths.marks))
        assert len(sheet.drawing.modelspace().query("CIRCLE")) == 1, part.name
        assert [abs(value) < NEAR for _, value, _ in lengths.marks].count(True) == 1


def test_a_pin_drawn_at_the_middle_of_its_zone_has_one_diameter(machine):
    # Beside 3.5 f9 it had 3.475, the middle of that zone, without a tolerance.
    pins = machine.changed({"reducer.output_pins.diameter": "3.5 mm"})
    pin = next(part for part in pins.parts if part.name == "dowel pin")
    found = [text for text in texts_of(svg_text(drawn(pin, pins), "")) if text.startswith("\u00d8")]
    assert len(found) == 1
    assert has_fit(found, next(f for f in pin.features if isinstance(f, Seat)))
