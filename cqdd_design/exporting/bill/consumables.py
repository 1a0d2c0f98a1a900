"""What a machine takes beside its parts: inserts, compound, lubricant, and how much of each."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from cqdd_design.catalog.adhesives import EPOXY, RING_COMPOUND, ROTOR_COMPOUND
from cqdd_design.catalog.fits import fit_limits
from cqdd_design.catalog.materials import find_material
from cqdd_design.catalog.printing import Insert, printed_materials
from cqdd_design.errors import CatalogError
from cqdd_design.exporting.bill.substitutes import other_lubricants
from cqdd_design.exporting.printing.threads import with_inserts
from cqdd_design.geometry.output_pins import pin_zone
from cqdd_design.machine.grease import grease_fill
from cqdd_design.machine.ring_seating import is_bonded
from cqdd_design.solids.counterweights import NAMES as WEIGHTS
from cqdd_design.solids.features import zones

if TYPE_CHECKING:
    from cqdd_design.machine import Machine

_WASTE = 2.0
"""What is spread over what stays in the gap."""
_LEAST_GAP = 20e-6
"""Mean radial gap of a bond whose fit is tighter, m."""
_ML = 1e6

INSERT = "heat-set insert"
"""What a bill calls those in plastic."""


@dataclass(frozen=True)
class Consumable:
    """A line of the bill that is no part.

    Attributes
    ----------
    name, designation, fitting, substitutes, source : str
        As the columns of the bill.
    quantity : int
        Pieces; packs of what comes in packs.
    """

    name: str
    designation: str
    fitting: str
    substitutes: str
    source: str
    quantity: int = 1


@dataclass(frozen=True)
class Bond:
    """A cylindrical bond, m: all of `count` of them together."""

    place: str
    diameter: float
    length: float
    gap: float
    count: int = 1

    @property
    def volume(self) -> float:
        """Of the compound that is spread, m^3."""
        return _WASTE * self.count * math.pi * self.diameter * self.length * self.gap


def bonds(machine: Machine) -> tuple[Bond, ...]:
    """Every cylindrical bond of metals that is drawn."""
    layout = machine.layout
    stub = layout.shaft.support.bearing.bore_diameter
    motor, around, found = layout.motor_end, layout.motor is not None, []
    if motor is not None:
        ring, stack = motor.ring_top - motor.ring_bottom, motor.stack_top - motor.stack_bottom
        hub, held = motor.hub_top - motor.hub_bottom, _gap("F7", "k6", stub)
        on_stub, in_rotor, seat = "hub on the shaft", "rotor on its hub", "stator in the cover"
        wide, stator = motor.rotor_inner, motor.stack_outer
        if around:
            on_stub, in_rotor = "bell on the shaft", "magnets in the bell"
            seat = "stator on the housing"
            wide, stator = motor.rotor_outer, motor.stack_inner
        found += [
            Bond(on_stub, stub, hub, held),
            Bond(in_rotor, 2.0 * wide, ring, _LEAST_GAP),
            Bond(seat, 2.0 * stator, stack, _LEAST_GAP),
        ]
    support = layout.shaft.support.bearing
    outside, gap = support.outer_diameter, _gap(zones.HOUSED, "h6", support.outer_diameter)
    found.append(Bond("outer rings of the shaft bearings", outside, support.width, gap, 2))
    cam = layout.pack.cam.bearing
    if cam.raceway_diameter is not None:
        gap, count = _gap("H6", zones.LOBE, cam.bore_diameter), layout.pack.disc_count
        found.append(Bond("inner rings on the lobes", cam.bore_diameter, cam.width, gap, count))
    found += _pin_bonds(machine) if _pins_in_metal(machine) else []
    if layout.pack.disc_count > 2:
        size = 2.0 * layout.shaft.shoulder_radius
        long = layout.pack.cam_top(2) - layout.pack.cam_top(1)
        found.append(Bond("loose cam on the shaft", size, long, _LEAST_GAP))
    dowels = layout.dowels
    if dowels.radius:
        size = 2.0 * dowels.radius
        gap = _gap(zones.SEAM_GROOVE, zones.DOWEL, size)
        found.append(Bond("ring dowels", size, dowels.bearing_length, gap, len(dowels.angles)))
    return tuple(found)


def _pins_in_metal(machine: Machine) -> bool:
    """Whether plate and cap are of what a retaining compound cures on."""
    return ROTOR_COMPOUND.share_on(find_material(machine.design.carrier_material)) > 0.0


def _pin_bonds(machine: Machine) -> list[Bond]:
    """Of the output pins in cap and plate, whatever these are of."""
    carrier, found = machine.layout.carrier, []
    pin, zone = carrier.pin.nominal_diameter, pin_zone(machine.design.reducer.output_pins)
    gap = _gap("H7", zone, pin)
    if carrier.bonded_in_cap:
        depth = -machine.layout.pack.gap - carrier.shoulder_bottom
        found.append(Bond("pins in the cap", pin, depth, gap, carrier.pin_count))
    if carrier.pin.screw is None:
        depth = carrier.shoulder_top - carrier.plate_bottom
        found.append(Bond("pins in the plate", pin, depth, gap, carrier.pin_count))
    return found


def _gap(hole: str, shaft: str, diameter: float) -> float:
    """Mean radial gap of a fit, m; the least where the table of a zone does not know the size."""
    try:
        outer, inner = fit_limits(hole, diameter), fit_limits(shaft, diameter)
    except CatalogError:
        return _LEAST_GAP
    mean = 0.5 * (outer.lower + outer.upper - inner.lower - inner.upper)
    return max(0.5 * mean, _LEAST_GAP)


def consumables(machine: Machine) -> tuple[Consumable, ...]:
    """Inserts in its plastic, compound and lubricant of a machine."""
    places = bonds(machine)
    found = _inserts(machine)
    if places:
        amount = _ML * sum(one.volume for one in places)
        found.append(
            Consumable(
                "retaining compound",
                ROTOR_COMPOUND.name,
                f"about {amount:.2g} ml: {', '.join(one.place for one in places)}; surfaces clean "
                "and dry",
                "",
                ROTOR_COMPOUND.source,
            )
        )
    if is_bonded(machine):
        found.append(_round_the_ring(machine))
    found += _epoxy(machine)
    fill = grease_fill(machine)
    found.append(
        Consumable(
            "lubricant",
            fill.lubricant.name,
            f"about {1e3 * fill.mass:.2g} g ({_ML * fill.volume:.2g} ml), a third of the free "
            "space inside the ring: on teeth, lobes and pins, and in open bearings",
            "; ".join(other_lubricants(machine)),
            fill.lubricant.source,
        )
    )
    return tuple(found)


def _epoxy(machine: Machine) -> list[Consumable]:
    """Under balance weights, and round pins in plastic."""
    places = [] if _pins_in_metal(machine) else [one.place for one in _pin_bonds(machine)]
    if any(part.name in WEIGHTS for part in machine.parts):
        places.append("a film between each balance weight and the bell")
    source = f"Henkel, {EPOXY} technical data sheet: two parts, to 120 degC"
    told = f"{', '.join(places)}; faces roughened, clean and dry"
    return [Consumable("epoxy", EPOXY, told, "", source)] if places else []


def _round_the_ring(machine: Machine) -> Consumable:
    pack = machine.layout.pack
    wide = 2.0 * pack.ring_radius
    seat = Bond("ring", wide, pack.top, _gap(zones.RING_SEAT, zones.RING_OUTSIDE, wide))
    return Consumable(
        "ring's compound",
        RING_COMPOUND,
        f"about {_ML * seat.volume:.2g} ml: round the ring in its seat; surfaces clean and dry",
        "",
        "Henkel, LOCTITE 641 technical data sheet: for joints that are to be taken apart",
    )


def _inserts(machine: Machine) -> list[Consumable]:
    """Heat-set inserts, a line a size: what the files of printed parts have holes for."""
    counts: dict[Insert, dict[str, int]] = {}
    for part in machine.parts:
        material = printed_materials().get(part.material)
        if material is None or part.source != "make":
            continue
        for threads in with_inserts(part, material.least_wall)[1]:
            if threads.insert is not None:
                where = counts.setdefault(threads.insert, {})
                where[part.name] = where.get(part.name, 0) + part.count * threads.count
    found = []
    for insert, where in sorted(counts.items(), key=lambda one: (one[0].thread, one[0].length)):
        places = ", ".join(f"{count} in the {part}" for part, count in where.items())
        how = f"melted into holes of {1e3 * insert.hole:g} mm: {places}"
        count = sum(where.values())
        found.append(Consumable(INSERT, insert.name, how, "", insert.source, count))
    return found
