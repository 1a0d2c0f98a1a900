"""Spigots that centre clamp and covers, and the gaps that seal, read off the parts as drawn."""

from __future__ import annotations

import math

import numpy as np
import pytest
from solids_designs import CHANGES, known_design, known_parts, part_named

from cqdd_design.errors import CatalogError
from cqdd_design.exporting.sheets.assembly_facts import AssemblyFacts
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.part_errors import GearboxErrors
from cqdd_design.gearbox.contact.sweep import output_turn_angles
from cqdd_design.gearbox.precision.backlash import backlash
from cqdd_design.geometry.contours import Circle
from cqdd_design.machine import resolve
from cqdd_design.machine.centring import centring, most_off_centre
from cqdd_design.solids.features.holes import Counterbore
from cqdd_design.solids.features.kinds import Chamfer, Seat
from cqdd_design.solids.part import Part
from cqdd_design.solids.registers import LEAD_IN

MATES = (
    ("housing", "ring seat", "ring clamp", "spigot in the housing", "H7", "h6"),
    ("output cover", "seat of the output bearing", "ring clamp", "spigot in the cover", "H7", "h6"),
    (
        "motor cover",
        "bore on the flange's spigot",
        "housing",
        "spigot of the motor's cover",
        "H8",
        "h7",
    ),
)
"""Parts with a bore and with what centres them in it, and the fits."""


def seat_of(part: Part, name: str) -> Seat:
    return next(one for one in part.features if isinstance(one, Seat) and one.name == name)


def radii_at(part: Part, height: float) -> tuple[float, float]:
    """Bore and outside radius about the axis at a height, as drawn, m; of round layers."""
    layers = [layer for layer in part.shape.layers if layer.bottom < height < layer.top]
    bores = [
        hole.radius
        for layer in layers
        for hole in layer.shape.holes
        if isinstance(hole, Circle) and not np.any(hole.centre)
    ]
    rounds = [one.shape.outer.radius for one in layers if isinstance(one.shape.outer, Circle)]
    return min(bores), max(rounds, default=math.nan)


@pytest.mark.parametrize("name", CHANGES)
def test_spigots_stand_in_their_bores(name: str) -> None:
    parts = known_parts(name)
    layout = resolve(known_design(name)).layout
    for outer_name, bore_name, inner_name, spigot_name, hole_zone, shaft_zone in MATES:
        if outer_name == "motor cover" and layout.motor is None:
            continue
        outer, inner = part_named(parts, outer_name), part_named(parts, inner_name)
        bore, spigot = seat_of(outer, bore_name), seat_of(inner, spigot_name)
        assert (bore.inside, spigot.inside) == (True, False)
        assert (bore.zone, spigot.zone) == (hole_zone, shaft_zone)
        assert bore.diameter == spigot.diameter
        # All of the spigot is in the bore, and both are there in the solid.
        assert bore.bottom - 1e-9 <= spigot.bottom < spigot.top <= bore.top + 1e-9
        deep = spigot.top - spigot.bottom
        assert deep >= 0.4 * layout.unit
        middle = 0.5 * (spigot.bottom + spigot.top)
        solid = [radii_at(part, middle) for part in (inner,) if inner_name == "ring clamp"]
        assert all(one[1] == pytest.approx(0.5 * spigot.diameter) for one in solid)
        # What their chamfers leave still centres.
        for part in (outer, inner):
            ends = [
                one.width
                for one in part.features
                if isinstance(one, Chamfer)
                and abs(one.radius - 0.5 * bore.diameter) < 1e-9
                and spigot.bottom - 1e-9 <= one.height <= spigot.top + 1e-9
            ]
            assert sum(ends) <= LEAD_IN + 1e-12
        try:
            play = bore.limits.lower - spigot.limits.upper
        except CatalogError:
            continue
        assert play >= 0.0


@pytest.mark.parametrize("name", CHANGES)
def test_gaps_are_as_narrow_as_the_table_says(name: str) -> None:
    """NTN: from 0.2 mm for shafts up to 50 mm, from 0.5 mm beyond."""
    parts = known_parts(name)
    housing = resolve(known_design(name)).layout.housing
    places = (
        (housing.output_seal, "output cover", "bearing nut", 1.0),
        (housing.shaft_seal, "housing", "eccentric shaft", -1.0),
    )
    for seal, still, turning, outward in places:
        least, most = (0.2e-3, 0.4e-3) if 2.0 * seal.inner <= 50e-3 else (0.5e-3, 1e-3)
        facing = seal.bottom + 0.5 * seal.length if outward > 0.0 else seal.top - 0.5 * seal.length
        bore = radii_at(part_named(parts, still), facing)[0]
        layer = next(
            one for one in part_named(parts, turning).shape.layers if one.bottom < facing < one.top
        )
        assert isinstance(layer.shape.outer, Circle)
        assert least <= bore - layer.shape.outer.radius <= most + 1e-12
        assert seal.length >= max(0.6e-3, 2.0 * seal.gap)
        # What seals is dimensioned on both parts.
        sizes = [
            round(1e3 * one.diameter, 6)
            for part in (part_named(parts, still), part_named(parts, turning))
            for one in part.features
            if isinstance(one, Seat) and one.bottom - 1e-9 <= facing <= one.top + 1e-9
        ]
        assert {round(2e3 * seal.outer, 6), round(2e3 * seal.inner, 6)} <= set(sizes)


@pytest.mark.parametrize("name", CHANGES)
def test_gaps_stand_clear_of_the_bearings_inner_rings(name: str) -> None:
    """Three tenths of a millimetre at least from the rings that turn beside them."""
    layout = resolve(known_design(name)).layout
    housing = layout.housing
    assert housing.output_seal.bottom >= layout.carrier.output_seat_top + 0.3e-3 - 1e-9
    seat = seat_of(part_named(known_parts(name), "housing"), "seat of the shaft bearing")
    assert housing.shaft_seal.top <= seat.bottom - 0.3e-3 + 1e-9


def test_how_far_the_output_stands_off_is_told() -> None:
    """Two times H7/h6 of 49 um of play at 66 and 72 mm, and 6.5 um of run-out."""
    machine = resolve(known_design("paper"))
    assert most_off_centre(machine) == pytest.approx(0.5 * (49e-6 + 49e-6 + 6.5e-6))
    assert "leaves the output's axis 0.052 mm off at most" in centring(machine)
    assert centring(machine) in AssemblyFacts(machine).notes()


@pytest.mark.parametrize(("off", "tight"), [(10e-6, False), (30e-6, True)])
def test_an_output_off_the_rings_axis_takes_the_backlash(off: float, tight: bool) -> None:
    """A third at 10 um, and all but a little, with micrometres of overlap, at 30."""
    model = ContactModel.from_design(known_design("paper"))
    errors = GearboxErrors.none(model)
    errors.output_axis[0] = off
    perfect = backlash(model).mean
    found = backlash(model, output_turn_angles(model, 44), errors=errors)
    assert bool(found.overlap.max() > 5e-6) == tight
    assert (found.free.min() == 0.0) == tight
    assert found.mean < (0.07 if tight else 0.8) * perfect


def test_counterbores_of_shoulder_screws_are_those_of_din_974() -> None:
    """Heads of 7 mm are those of M4 cap screws, for which DIN 974-1 has 8 mm."""
    cap = part_named(known_parts("paper"), "carrier cap")
    (found,) = (one for one in cap.features if isinstance(one, Counterbore))
    assert found.diameter == pytest.approx(8e-3)
    screw = part_named(known_parts("paper"), "shoulder screw")
    assert 2.0 * screw.shape.outside_radius == pytest.approx(7e-3)
