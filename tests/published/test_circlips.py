"""Circlips and lock nuts: slips in their tables, and why the machines use none."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

import pytest

from cqdd_design.catalog.bearings import bearings
from cqdd_design.catalog.circlips import circlip_for, circlips
from cqdd_design.catalog.lock_nuts import lock_nuts
from cqdd_design.catalog.screws import shoulder_screws
from cqdd_design.design import load_design
from cqdd_design.machine import resolve
from cqdd_design.solids.selection import ChosenBearing

REPOSITORY = Path(__file__).resolve().parents[2]
GROWING = ("axial_width", "lug_height", "beam_width", "groove_depth", "groove_diameter")


@pytest.mark.parametrize("standard", ["DIN 471", "DIN 472"])
def test_no_column_of_circlips_falls(standard: str) -> None:
    """Both standards step every size up with the diameter: a fall is a slip of who copied it."""
    rows = [one for one in circlips().values() if one.standard == standard]
    assert len(rows) > 70
    for less, more in pairwise(rows):
        assert less.nominal_diameter < more.nominal_diameter
        for name in GROWING:
            assert getattr(less, name) <= getattr(more, name) + 1e-9, (more.designation, name)
    for one in rows:
        sign = 1.0 if standard == "DIN 472" else -1.0
        # Snaps into its groove with a spring that the free ring is wound beyond.
        assert sign * (one.free_diameter - one.groove_diameter) > 0.0, one.designation
        assert sign * (one.groove_diameter - one.nominal_diameter) > 0.0, one.designation
        assert one.beam_width > one.groove_depth


@pytest.mark.parametrize(
    ("designation", "groove"),
    [("DIN 471 - 52 x 2", 49e-3), ("DIN 472 - 28 x 1.2", 29.4e-3), ("DIN 472 - 100 x 3", 103.5e-3)],
)
def test_what_was_mended_says_so(designation: str, groove: float) -> None:
    row = circlips()[designation]
    assert row.groove_diameter == pytest.approx(groove)
    assert f"groove {1e3 * groove:g} for its" in row.source
    assert sum("for its" in one.source for one in circlips().values()) == 3


def test_lock_nuts_grow_and_leave_their_threads_a_wall() -> None:
    rows = list(lock_nuts().values())
    assert [one.designation for one in rows] == [f"KM {size}" for size in range(13)]
    for less, more in pairwise(rows):
        for name in ("thread_diameter", "outer_diameter", "face_diameter", "mass"):
            assert getattr(less, name) < getattr(more, name)
    for one in rows:
        root = one.outer_diameter - 2.0 * one.slot_depth
        assert one.thread_diameter < one.face_diameter <= root + 1e-3
        # A ring of steel with slots weighs what its sizes say.
        ring = 0.25 * 3.1416 * (one.outer_diameter**2 - one.thread_diameter**2) * one.width
        assert 0.7 < one.mass / (7850.0 * ring) < 1.15


def test_no_lock_nut_is_as_narrow_as_what_it_may_touch() -> None:
    held = [one for one in bearings().values() if one.kind in ("ball", "crossed roller")]
    compared = 0
    for nut in lock_nuts().values():
        for row in held:
            if abs(row.bore_diameter - nut.thread_diameter) < 1e-9:
                compared += 1
                assert nut.outer_diameter > 2.0 * ChosenBearing(row).shoulder_radius
    assert compared > 40


def test_no_circlip_goes_on_where_a_head_does_not() -> None:
    screws = [one for one in shoulder_screws().values() if one.name.startswith("metric")]
    compared = 0
    for one in screws:
        ring = circlip_for("DIN 471", one.shoulder_diameter)
        if ring is not None and one.shoulder_diameter < 12.5e-3:
            compared += 1
            assert ring.swept_diameter > one.head_diameter
    assert compared == 6


def test_the_page_says_what_the_catalogue_has() -> None:
    page = (REPOSITORY / "docs" / "how-to-solids.md").read_text()
    said = page.partition("Nothing is held by a circlip")[2].partition("## Printed")[0]
    rows = [line for line in said.splitlines() if line.startswith("| ")]
    machine = resolve(load_design(REPOSITORY / "designs" / "cqdd-10.toml"))
    carrier, shaft = machine.layout.carrier, machine.layout.shaft
    bearing = carrier.output.bearing
    bore, outside = 1e3 * bearing.bore_diameter, 1e3 * bearing.outer_diameter
    housed, on_plate, journals, stub, pins = rows[1:6]
    near = circlip_for("DIN 472", 65e-3)
    assert near is not None
    assert circlip_for("DIN 472", bearing.outer_diameter) is None
    assert f"takes {1e3 * near.length:g} mm (groove of {1e3 * near.groove_diameter:g} mm)" in housed
    assert f"for the {outside:g} mm of this bearing" in housed
    around = circlip_for("DIN 471", bearing.bore_diameter)
    nut = next(n for n in lock_nuts().values() if abs(1e3 * n.thread_diameter - bore) < 1e-9)
    assert around is not None
    high = 1e3 * (carrier.nut_top - carrier.bearing_top)
    above = 1e3 * (carrier.plate_top - carrier.nut_top)
    assert f"made nut, {high:g} mm, and {above:g} mm of plate above it" in on_plate
    assert high + above < 1e3 * around.length
    assert f"{around.designation} takes {1e3 * around.length:.4g} mm" in on_plate
    assert f"stands out to {1e3 * around.seated_diameter:.4g} mm" in on_plate
    assert f"touched to {2e3 * carrier.output.shoulder_radius:.3g} mm" in on_plate
    wide = f"{1e3 * nut.outer_diameter:g} mm wide and {1e3 * nut.width:g} mm high"
    assert f"{nut.designation} is {wide}, the bearing {outside:g} mm wide" in on_plate
    journal = circlip_for("DIN 471", shaft.support.bearing.bore_diameter)
    assert journal is not None
    for row in (journals, stub):
        assert f"{journal.designation} takes {1e3 * journal.length:.2g} mm" in row
    pin = carrier.pin
    ring = circlip_for("DIN 471", pin.nominal_diameter)
    assert ring is not None
    assert pin.screw is not None
    head, wide_pin = 1e3 * pin.screw.head_diameter, 1e3 * pin.nominal_diameter
    assert f"{head:g} mm of {wide_pin:g} mm pins" in pins
    assert f"a circlip needs {1e3 * ring.swept_diameter:.2g} mm" in pins
    assert len(re.findall(r"^\| pins of a pinwheel", said, re.MULTILINE)) == 1
