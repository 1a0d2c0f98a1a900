"""What a foreman reads off a sheet: patterns that are clocked, where depths begin, which way."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from legible import assert_legible, crossed, segments

from cqdd_design.design import load_design
from cqdd_design.exporting.bill.consumables import consumables
from cqdd_design.exporting.edm.cut_facts import facts_of
from cqdd_design.exporting.edm.flat_parts import flat_parts, reach_of
from cqdd_design.exporting.options import DEFAULTS
from cqdd_design.exporting.sheets import frame
from cqdd_design.exporting.sheets.assembly_facts import AssemblyFacts
from cqdd_design.exporting.sheets.canvas import render
from cqdd_design.exporting.sheets.cut_sheet import (
    MOST_REACH,
    SECTION,
    draw_cut_sheet,
    draw_sheet,
    sheet_scale,
)
from cqdd_design.exporting.sheets.drawing import SheetDrawing
from cqdd_design.exporting.sheets.edm_readme import readme_text
from cqdd_design.exporting.sheets.end_plan import _round_row, drilled_size
from cqdd_design.exporting.sheets.frame import cut_rows
from cqdd_design.exporting.sheets.part_facts import PartFacts
from cqdd_design.exporting.sheets.part_sheet import _fixed, draw_part
from cqdd_design.exporting.sheets.section_plan import SectionShape
from cqdd_design.exporting.sheets.section_way import section_directions
from cqdd_design.machine import resolve
from cqdd_design.solids.features.holes import BoltCircle, TappedHole

ROOT = Path(__file__).resolve().parents[2]
NARROW = {
    "requirements.ratio": 30,
    "reducer.ratio": 30,
    "reducer.ring_pitch_radius": "49.1 mm",
    "reducer.eccentricity": "0.9 mm",
    "reducer.ring_pin_diameter": "6.7 mm",
    "reducer.disc_thickness": "9 mm",
    "reducer.output_pins.count": 24,
    "reducer.output_pins.diameter": "6 mm",
    "reducer.output_pins.circle_radius": "39.4 mm",
    "reducer.cam_bearing.designation": "16008",
    "reducer.ring.outer_diameter": "100.3 mm",
}
FILLS_THE_VIEW = {
    "reducer.carrier.joint": "columns",
    "reducer.carrier.column_diameter": "6 mm",
    "reducer.cam_bearing.designation": "6803",
    "reducer.ring_pitch_radius": "38 mm",
    "reducer.ring.outer_diameter": "88 mm",
    "reducer.output_pins.count": 7,
    "reducer.output_pins.circle_radius": "22.3456 mm",
}
EXACT = "Dimensions in boxes are theoretically exact (ISO 1101)."


@pytest.fixture(scope="module")
def three():
    return resolve(load_design(ROOT / "docs" / "gallery" / "three-discs-9.toml"))


@pytest.fixture(scope="module")
def rolling():
    return resolve(load_design(ROOT / "docs" / "gallery" / "efficient-10.toml"))


def labels_of(machine, name):
    part = next(one for one in machine.parts if one.name == name)
    canvas = render(draw_part(PartFacts(part, machine.given)))
    assert_legible(canvas)
    # A note may go on in a second line.
    return [label.text for label in canvas.labels]


def test_lobes_keep_their_angle_to_each_other(three):
    """Zones of two frames to A-B turn about it apart from each other, unless marked (ISO 5458)."""
    texts = labels_of(three, "eccentric shaft")
    frames = [i for i, text in enumerate(texts) if text == "\u00d80.012"]
    assert [texts[i + 1 : i + 3] for i in frames] == [["A-B", "SIM1"]] * 2
    assert any("so the lobes are" in text for text in texts)
    # The loose cam has one lobe, and is turned by hand.
    assert "SIM1" not in labels_of(three, "eccentric cam")


def test_what_stands_beside_the_axis_is_cut_through_its_middle(three):
    """Balance weights of three discs stand beside the plane through +x, which cut nothing."""
    weighted = resolve(three.given.replacing({"reducer.balance.counterweights": True}))
    weights = [part for part in weighted.parts if part.name.startswith("balance weight")]
    assert len(weights) == 2
    for part in weights:
        shape = SectionShape(PartFacts(part, weighted.given))
        (face,) = shape.face
        assert float(np.ptp(face[:, 0])) == pytest.approx(
            1e3 * (part.shape.top - part.shape.bottom)
        )
        labels_of(weighted, part.name)
    (glue,) = [one for one in consumables(weighted) if one.name == "epoxy"]
    assert "balance weight" in glue.fitting
    assert not any(one.name == "epoxy" for one in consumables(three))


def test_holes_of_a_circle_are_one_pattern(three):
    cap = labels_of(three, "carrier cap")
    assert "\u00d80.018 CZ" in cap
    assert "SIM1" not in cap
    plate = labels_of(three, "carrier plate")
    assert plate.count("SIM1") == 4
    assert [text for text in plate if text.startswith("\u00d80.0") and "CZ" not in text] == []


def test_a_thread_below_a_seat_says_from_where_it_is_deep(three):
    """Depths of a thread stood under those of the seat that it begins in, and no word between."""
    plate = next(one for one in three.parts if one.name == "carrier plate")
    seat_floor = {f.mouth for f in plate.features if isinstance(f, TappedHole) if not f.countersink}
    assert len(seat_floor) == 1
    texts = labels_of(three, "carrier plate")
    deep = [text for text in texts if "-6H" in text]
    assert sorted(text.endswith(" from the floor") for text in deep) == [False, True]
    pins = f"{three.design.reducer.output_pins.count} \u00d7 M3-6H"
    assert next(text for text in deep if "floor" in text).lstrip().startswith(pins)


def test_ears_and_slots_say_how_far_apart_they_are(three):
    housing = labels_of(three, "housing")
    place = next(i for i, text in enumerate(housing) if "\u00d7 R" in text)
    assert housing[place].startswith("6 ")
    assert housing[place + 2 : place + 6] == ["from", "30\u00b0", "every", "60\u00b0"]
    # One hole stands at an angle, not from it.
    leads = housing.index("at")
    assert housing[leads - 1].startswith("\u00d8")
    assert housing[leads + 1] == "0\u00b0"
    nut = labels_of(three, "bearing nut")
    place = next(i for i, text in enumerate(nut) if "slot" in text)
    assert nut[place + 1 : place + 5] == ["from", "0\u00b0", "every", "90\u00b0"]


def test_arcs_that_are_not_evenly_spaced_are_not_called_so():
    places = [1.0 + 0j, 1j, -1.0 + 0j]
    assert [getattr(cell, "text", "") for cell in _round_row(places[0], places)] == [
        "from",
        "0\u00b0",
    ]


def test_places_of_opposite_holes_have_the_same_figures():
    """14.90625 mm stood as 14.9062 at one hole and as 14.9063 at its mirror image."""
    circle = BoltCircle.even("windows", 6, 29.8125e-3, math.radians(30.0))
    figures = [(_fixed(x), _fixed(y)) for x, y in circle.centres]
    assert len({y.lstrip("-") for x, y in figures if float(x)}) == 1
    for (x, y), (u, v) in zip(figures[:3], figures[3:], strict=True):
        assert (float(x), float(y)) == (-float(u), -float(v))


def test_boxes_are_explained_where_there_are_any(rolling):
    for name, has in (("pin sleeve", False), ("dowel pin", False), ("carrier cap", True)):
        assert (EXACT in labels_of(rolling, name)) == has


def test_no_line_runs_under_the_thickness_or_through_a_datum(three):
    # The section of nine lobes is cut through a valley: its largest diameter is a lobe's. Of a
    # narrow disc the bore's datum stood among the lines of lobes and valleys.
    paper = load_design(ROOT / "designs" / "cqdd-10.toml")
    narrow = resolve(paper.replacing(NARROW))
    for machine in (three, narrow):
        for flat in flat_parts(machine):
            canvas = draw_sheet(facts_of(flat, machine))
            assert_legible(canvas)
            ends = segments(canvas, 0.0)
            for label in canvas.labels:
                assert not len(crossed(label, ends)), (flat.label, label.text)
            (thick,) = (label for label in canvas.labels if label.text.endswith(" +0/-0.02"))
            assert not len(crossed(replace(thick, y=thick.y - 0.6), ends)), flat.label


@pytest.mark.parametrize(("pins", "paper"), [(28, "A3"), (29, "A2"), (60, "A2")])
def test_the_table_of_cuts_is_complete(pins, paper):
    """Of more than 30 cuts it said "n more: see the DXF"."""
    base = load_design(ROOT / "designs" / "cqdd-10.toml").replacing(NARROW)
    pin = {"reducer.output_pins.count": pins, "reducer.output_pins.diameter": "1.2 mm"}
    machine = resolve(base.replacing(pin))
    flat = flat_parts(machine)[0]
    sheet = draw_cut_sheet(facts_of(flat, machine))
    canvas = render(sheet)
    assert_legible(canvas)
    assert sheet.paper.name == paper
    assert [row[0] for row in cut_rows(facts_of(flat, machine))] == [
        str(one) for one in range(1, pins + 3)
    ]
    # Every hole by its place, to 0.1 um, in the order of its cut.
    texts = [label.text for label in canvas.labels]
    start = texts.index("cut")
    for number, hole in enumerate(flat.shape.holes, start=1):
        row = texts.index(str(number), start)
        assert texts[row + 3 : row + 5] == [f"{1e3 * one:.4f}" for one in hole.centre], number
        start = row + 1
    assert "see the DXF" not in " ".join(texts)


def test_the_section_of_a_flat_part_says_which_way_it_is_seen(three, monkeypatch):
    """Its left face is the lower one, datum B: with +X up it is seen from +Y."""
    tips, triangle = [], SheetDrawing.triangle

    def noted(sheet, tip, toward):
        tips.append((tip, toward / abs(toward)))
        triangle(sheet, tip, toward)

    monkeypatch.setattr(SheetDrawing, "triangle", noted)
    flat = flat_parts(three)[0]
    draw_sheet(facts_of(flat, three))
    down = [tip for tip, toward in tips if toward == -1j and abs(tip.imag - SECTION.imag) < 6.0]
    assert len(down) == 2
    assert all(tip.imag < SECTION.imag for tip in down)


@pytest.fixture(scope="module")
def pocketed():
    paper = load_design(ROOT / "designs" / "cqdd-10.toml")
    return resolve(paper.replacing({"reducer.ring_type": "pinwheel"}))


def test_a_disc_that_fills_its_view_stays_clear_of_where_its_columns_stand():
    """The row that places the columns ran over the lobes at the view's upper left."""
    paper = load_design(ROOT / "designs" / "cqdd-10.toml")
    wide = resolve(paper.replacing(FILLS_THE_VIEW))
    facts = facts_of(flat_parts(wide)[0], wide)
    reach = 1e3 * sheet_scale(facts) * reach_of(facts.flat.shape.outer)
    assert 0.99 * MOST_REACH < reach <= MOST_REACH
    assert_legible(draw_sheet(facts))


def test_the_table_of_cuts_has_every_hole():
    """Of sixteen contours five were left to the file."""
    wide = resolve(load_design(ROOT / "designs" / "cqdd-10.toml").replacing(FILLS_THE_VIEW))
    narrow = resolve(load_design(ROOT / "designs" / "cqdd-10.toml").replacing(NARROW))
    for machine in (wide, narrow):
        facts = facts_of(flat_parts(machine)[0], machine)
        labels = draw_sheet(facts).labels
        drawn = sorted((label.y, label.x, label.text) for label in labels)
        tops = [x for _, x, text in drawn if text == "centre X"]
        rows = {}
        for y, x, text in drawn:
            half = sum(x > top - 31.0 for top in tops)
            rows.setdefault((half, round(y, 3)), []).append(text)
        holes = facts.flat.shape.holes
        assert len(holes) + 1 > 12
        for number, hole in enumerate(holes, start=1):
            (row,) = (row for row in rows.values() if row[1:2] == [str(number)] and len(row) == 8)
            centre = [f"{round(1e3 * value, 4) + 0.0:.4f}" for value in hole.centre]
            assert row[2:5] == [f"\u00d8{2e3 * hole.radius:.4f}", *centre]
        assert not any("more" in label.text for label in labels)


def test_pockets_have_their_zone_and_the_profile_lies_about_what_is_cut(pocketed):
    """H7 of the pockets lay outside of the profile's zone about the nominal contour."""
    facts = facts_of(flat_parts(pocketed)[-1], pocketed)
    assert facts.flat.label == "ring"
    pockets = facts.pockets
    assert pockets is not None
    limits, half = pockets.limits, 0.5 * facts.zones.profile
    # Walls about the nominal contour, and about the one that is cut, m.
    assert 0.5 * limits.upper > half
    assert 0.25 * (limits.upper - limits.lower) < half
    texts = [label.text for label in draw_sheet(facts).labels]
    teeth, size = pocketed.given.reducer.ring_tooth_count, f"{1e3 * pockets.diameter:.6g}"
    assert f"{teeth} \u00d7 \u00d8{size} H7" in texts
    assert not any(text.startswith("R") and text[1:2].isdigit() for text in texts)
    cut = f"\u00d8{1e3 * pockets.middle:.4f}"
    (said,) = (note for note in frame.notes(facts) if note.startswith("Profile"))
    assert f"as it is shifted for its pockets, {cut}, after the last skim cut" in said
    disc = facts_of(flat_parts(pocketed)[0], pocketed)
    assert disc.pockets is None
    assert "pockets" not in disc.profile_text
    assert f"for its pockets, {cut.replace(chr(216), 'dia ')}" in " ".join(
        readme_text([disc, facts], DEFAULTS).split()
    )


def test_the_magnet_is_put_into_a_shaft_that_is_there(rolling):
    """It lay in the empty bell before the shaft came whose pocket it is bonded in.

    Before the cover, which closes the face that its height is measured from.
    """
    order = AssemblyFacts(rolling).order()
    magnet = order.index("encoder magnet, from the motor side")
    shaft = next(k for k, one in enumerate(order) if one.startswith("eccentric shaft"))
    assert shaft < magnet < order.index("the unit of the motor cover, from the motor side")
    # Every bench begins with something that comes from nowhere.
    units = {one.split(":")[0] for one in order if ": " in one}
    for one in units:
        first = next(step for step in order if step.startswith(f"{one}:"))
        assert first.endswith(", to begin with")
    assert len(units) == sum(one.startswith("the unit") for one in order)


def test_a_way_through_is_no_narrower_than_it_was_asked_for():
    """Ø8 under general tolerances may be 7.8, where `bore` is 8 mm at least."""
    paper = load_design(ROOT / "designs" / "cqdd-10.toml")
    for asked, limits in (("6 mm", True), (None, False)):
        change = {} if asked is None else {"requirements.bore": asked}
        machine = resolve(paper.replacing(change))
        hole = 2e3 * machine.layout.shaft.bore_radius
        texts = labels_of(machine, "eccentric shaft")
        either = 0.1 if hole <= 6.0 else 0.2
        assert (f"\u00d8{hole:.4g} (+{either}/0)" in texts) == limits
        # What is wide enough in any case has no limits.
        cover = labels_of(machine, "output cover")
        assert not any("(+0.2/0)" in text or "(+0.3/0)" in text for text in cover)


def test_a_section_cuts_holes_through_their_axes(three, rolling):
    """Threads 2 degrees beside the plane were cut narrower than they are, with a flat end."""
    for machine in (three, rolling):
        for part in machine.parts:
            if part.source != "make" or part.exact_section is not None:
                continue
            facts = PartFacts(part, machine.given)
            for direction in section_directions(facts):
                for group in facts.holes:
                    size = max(drilled_size(hole) for hole in group)
                    for angle in group[0].circle.angles:
                        across = group[0].circle.radius * abs(math.sin(angle - direction))
                        if math.cos(angle - direction) > 0.0:
                            assert across < 1e-6 or across > 0.5 * size, part.name
