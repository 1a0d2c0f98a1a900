"""Stress that the continuous torque holds in housing, covers and carrier, place by place.

Forces are those of the contact equilibrium of perfect parts, the motor driving against friction, in
both senses of torque and wherever the crank stops; external loads count in full. Sizes are those of
the parts' features and of the layout. Of screws' heads and threads `screws` tells.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from cqdd_design.catalog.dowels import across_a_joint, along_a_seam
from cqdd_design.catalog.threads import Thread
from cqdd_design.gearbox import wall_stress as stress
from cqdd_design.gearbox.contact.rubbing import ContactFriction
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
from cqdd_design.gearbox.output_bearing import OutputLoad
from cqdd_design.gearbox.pack_loads import PackLoads
from cqdd_design.geometry.contours import ComplexArray, FloatArray
from cqdd_design.machine.machine import Machine
from cqdd_design.machine.output_loads import output_loads
from cqdd_design.machine.shaft import disc_heights, knife_edges
from cqdd_design.machine.shaft_strength import carried_shares
from cqdd_design.solids.features.carrier import OUTPUT_BOLTS, cap_features, plate_features
from cqdd_design.solids.features.holes import FittedHole, TappedHole
from cqdd_design.solids.features.kinds import AxialThread, Feature

_ANGLES = 120
"""Crank angles over the period."""


@dataclass(frozen=True)
class HeldStress:
    """What a place of a part bears for long.

    Attributes
    ----------
    part, place : str
        Where, in words.
    stress : float
        Nominal, without its sign, Pa.
    told : str
        What makes it.
    """

    part: str
    place: str
    stress: float
    told: str


class PinEnds(NamedTuple):
    """What pins put on plate and cap, (..., A, P)."""

    plate: ComplexArray
    """Force on the seat in the plate, x + i y in the ring's frame, N."""
    cap: ComplexArray
    plate_moment: FloatArray
    """With which the pin bends at the plate's face, N m."""
    cap_moment: FloatArray


class PressedSeat(NamedTuple):
    """A seat that holds the end of an output pin alone, at its greatest pressure."""

    part: str
    name: str
    """Of the feature."""
    diameter: float
    depth: float
    """m."""
    pressure: float
    """Pa."""
    force: float
    moment: float
    """Of the pin at the mouth of the seat, N and N m."""

    @property
    def held(self) -> HeldStress:
        """As a place among others."""
        of_pin = f"{self.force:.0f} N and {self.moment:.2g} N*m of a pin"
        return HeldStress(
            self.part, self.name, self.pressure, f"{of_pin} on {1e3 * self.depth:.3g} mm"
        )


@dataclass(frozen=True, eq=False)
class HeldLoads:
    """What housing and carrier hold; C senses of torque at A crank angles.

    Attributes
    ----------
    pack : PackLoads
        Forces of the discs.
    output : OutputLoad
        On the bearing between carrier and housing, (C, A).
    lower, upper : complex array (C, A)
        Force of the shaft on its bearing in the housing, and in the carrier, N.
    pins : PinEnds
        (C, A, P).
    """

    pack: PackLoads
    output: OutputLoad
    lower: ComplexArray
    upper: ComplexArray
    pins: PinEnds

    @property
    def crank_torque(self) -> float:
        """Greatest on the crank, N m."""
        return float(np.abs(self.pack.torque.sum(axis=2)).max())


def held_loads(machine: Machine) -> HeldLoads:
    """At the continuous torque.

    Raises
    ------
    ContactError
        When it has no equilibrium.
    GeometryError
        When the machine cannot be laid out.
    """
    model, torque = machine.contact, machine.lasting_torque
    rubbed, angles = ContactFriction.of(model, "drive"), perfect_angles(model, _ANGLES)
    sweeps = [contact_sweep(model, one, angles, friction=rubbed) for one in (torque, -torque)]
    pack, layout = PackLoads.of(sweeps), machine.layout
    shares = carried_shares(disc_heights(layout.pack), knife_edges(layout.shaft))
    lower, upper = (np.asarray(pack.on_shaft @ one) for one in shares)
    return HeldLoads(pack, output_loads(machine, pack), lower, upper, ends_of_pins(sweeps))


def ends_of_pins(sweeps: Sequence[ContactSweep]) -> PinEnds:
    """Forces and moments at the ends of the pins of some sweeps, (C, A, P); see `pin_ends`."""
    return PinEnds(*(np.stack(one) for one in zip(*map(pin_ends, sweeps), strict=True)))


def pin_ends(sweep: ContactSweep) -> PinEnds:
    """Forces and moments at both ends of every pin, (A, P); see `gearbox.pin_beam`."""
    model, moment = sweep.model, np.abs(sweep.pin_moment)
    pin = model.pin
    assert pin is not None  # else the moments are not known
    pushed = -_complex(sweep.pin_load)
    cap = np.einsum("d,adp->ap", pin.at_cap, pushed)
    if sweep.cap_angle_error is not None:
        # The cap runs ahead of the plate, and every pin holds it back along the circle.
        outward = _complex(sweep.pin_point - model.pin_contact_radius * sweep.pin_normal)[:, 0]
        sway = model.pin_circle_radius * (sweep.cap_angle_error - sweep.carrier_angle_error)
        cap = cap - 1j * outward / np.abs(outward) * (pin.joint * sway)[:, None]
    return PinEnds(pushed.sum(axis=1) - cap, cap, moment[:, 0], moment[:, -1])


def _complex(vectors: FloatArray) -> ComplexArray:
    return np.asarray(vectors[..., 0] + 1j * vectors[..., 1])


def held_stresses(machine: Machine, loads: HeldLoads | None = None) -> tuple[HeldStress, ...]:
    """Every place that is worked out, in the order of the parts.

    Parameters
    ----------
    loads : HeldLoads, optional
        Default those of the continuous torque; errors as :func:`held_loads`.
    """
    held = held_loads(machine) if loads is None else loads
    return (
        *_housing(machine, held),
        *_cover(machine, held),
        *_plate(machine, held),
        *_cap(machine, held),
    )


def _housing(machine: Machine, held: HeldLoads) -> Iterator[HeldStress]:
    layout = machine.layout
    housing, pack, support = layout.housing, layout.pack, layout.shaft.support.bearing
    seat_middle, _ = knife_edges(layout.shaft)
    push = np.abs(held.lower)
    most = float(push.max())
    pressed = stress.seat_pressure(most, support.outer_diameter, support.width)
    yield HeldStress("housing", "seat of the shaft bearing", pressed, f"{most:.0f} N across")
    cantilever = seat_middle - housing.floor_top
    seat = 0.5 * support.outer_diameter
    if cantilever > 0.0:
        moment = most * cantilever
        bent = stress.tube_stress(housing.boss_radius, seat, moment, 0.0)
        yield HeldStress("housing", "boss of the shaft bearing", bent, f"{moment:.3g} N*m bend it")
    thick = housing.floor_top - housing.bottom
    moment = most * abs(seat_middle - 0.5 * (housing.floor_top + housing.bottom))
    bent = stress.tilted_plate_stress(housing.boss_radius, pack.ledge_radius, thick, moment)
    yield HeldStress("housing", "floor about its boss", bent, f"{moment:.3g} N*m tilt it")

    torque = machine.lasting_torque + held.crank_torque
    dowels = layout.dowels
    if dowels.radius:
        size = 2.0 * dowels.radius
        seam = along_a_seam(
            torque, len(dowels.angles), pack.ring_radius, size, dowels.bearing_length
        )
        yield HeldStress(
            "housing", "half holes of the ring's dowels", seam.pressure, f"{torque:.3g} N*m on them"
        )
    moment, inner, over = float(_tube_moment(machine, held).max()), pack.ring_radius, torque
    if dowels.radius and dowels.bottom >= housing.flange_bottom:
        # The flange takes what the dowels hand on; the wall holds what the stator puts on it.
        over = held.crank_torque
    else:
        # Grooves all round would leave the wall its least section.
        inner += dowels.radius
    twisted = stress.tube_stress(housing.register_radius, inner, moment, over)
    told = f"{moment:.3g} N*m bend and {over:.3g} N*m twist it"
    yield HeldStress("housing", "wall round the ring", twisted, told)
    flange = stress.tilted_plate_stress(
        housing.register_radius,
        housing.bolt_circle_radius,
        housing.face - housing.flange_bottom,
        moment,
    )
    yield HeldStress("housing", "flange up to its screws", flange, f"{moment:.3g} N*m tilt it")
    back = held.crank_torque
    inrunner, motor, told = layout.inrunner, layout.motor, f"{back:.3g} N*m twist it"
    if inrunner is not None:
        twisted = stress.tube_stress(inrunner.cover_outer, inrunner.cover_inner, 0.0, back)
        yield HeldStress("motor cover", "wall round the stator", twisted, told)
    if motor is not None and motor.behind:
        twisted = stress.tube_stress(motor.stack_inner, motor.neck_inner, 0.0, back)
        yield HeldStress("housing", "neck under the stator", twisted, told)


def _tube_moment(machine: Machine, held: HeldLoads) -> FloatArray:
    """Bending moment of the tube at its flange, (C, A), N m: floor and ring push it to the side."""
    layout = machine.layout
    root, at = layout.housing.flange_bottom, disc_heights(layout.pack)
    seat_middle, _ = knife_edges(layout.shaft)
    below = held.lower * (root - seat_middle)
    on_ring = -(held.pack.on_shaft + held.pack.on_carrier)
    return np.abs(below + on_ring @ np.maximum(root - at, 0.0))


def _cover(machine: Machine, held: HeldLoads) -> Iterator[HeldStress]:
    """Cover, and ring clamp under the same bearing."""
    layout, loads = machine.layout, held.output
    housing, carrier = layout.housing, layout.carrier
    output = carrier.output.bearing
    outside, across = output.outer_diameter, float(loads.radial.max())
    pressed = stress.seat_pressure(across, outside, output.width)
    yield HeldStress(
        "output cover", "seat of the output bearing", pressed, f"{across:.0f} N across"
    )
    pushed = float(stress.line_load(outside, loads.axial, loads.moment).max())
    told = f"{1e-3 * pushed:.3g} N/mm at most"
    radius = 0.5 * outside
    lip = radius - carrier.output.lip_radius
    thick = housing.cover_top - carrier.output_seat_top
    bent = stress.lip_stress(pushed, 0.5 * lip, thick)
    yield HeldStress("output cover", "lip over the output bearing", bent, told)
    yield HeldStress("output cover", "face of that lip", pushed / lip, told)
    below = radius - housing.clamp_inner
    yield HeldStress("ring clamp", "face under the output bearing", pushed / below, told)
    axial, moment = float(loads.axial.max()), float(loads.moment.max())
    sizes = (
        housing.cover_hub_radius,
        housing.bolt_circle_radius,
        housing.cover_flange_top - housing.cover_bottom,
    )
    bent = stress.tilted_plate_stress(*sizes, moment) + stress.pushed_plate_stress(*sizes, axial)
    told = f"{moment:.3g} N*m tilt and {axial:.0f} N push it"
    yield HeldStress("output cover", "flange up to its screws", bent, told)


def _plate(machine: Machine, held: HeldLoads) -> Iterator[HeldStress]:
    layout, design = machine.layout, machine.design
    carrier, support = layout.carrier, layout.shaft.support.bearing
    features = plate_features(carrier, layout.shaft, 0.0)
    part, output, loads = "carrier plate", carrier.output.bearing, held.output
    yield pressed_seats(machine, held.pins)[0].held
    push, across = float(np.abs(held.upper).max()), float(loads.radial.max())
    pressed = stress.seat_pressure(push, support.outer_diameter, support.width)
    yield HeldStress(part, "seat of the shaft bearing", pressed, f"{push:.0f} N across")
    pressed = stress.seat_pressure(across, output.bore_diameter, output.width)
    yield HeldStress(part, "seat of the output bearing", pressed, f"{across:.0f} N across")

    bore = 0.5 * output.bore_diameter
    pushed = float(stress.line_load(output.bore_diameter, loads.axial, loads.moment).max())
    face, told = carrier.shoulder_radius - bore, f"{1e-3 * pushed:.3g} N/mm at most"
    yield HeldStress(part, "shoulder of the output bearing", pushed / face, told)
    thread = next(one for one in features if isinstance(one, AxialThread))
    pulled = pushed * math.pi * output.bore_diameter
    sheared = stress.thread_stress(
        Thread(thread.thread, thread.pitch), carrier.nut_top - carrier.bearing_top, pulled
    )
    yield HeldStress(part, "thread of the bearing's nut", sheared, told)

    torque, dowels = machine.lasting_torque, carrier.flange_dowels
    circle = carrier.bolt_circle_radius
    if dowels.count:
        found = across_a_joint(torque, dowels.count, circle, dowels.diameter, dowels.depth)
        place = "dowel holes of the output's face"
        yield HeldStress(part, place, found.pressure, f"{torque:.3g} N*m on them")
    if carrier.bolt_thread:
        threads = next(
            one for one in features if isinstance(one, TappedHole) and one.name.endswith("output")
        )
        # What is left between the holes of bolts and dowels on their circle.
        holes = OUTPUT_BOLTS * threads.thread + dowels.count * dowels.diameter
        left = 1.0 - holes / (2.0 * math.pi * circle)
        asked = design.requirements.external_moment or 0.0
        thick = carrier.plate_top - carrier.plate_bottom
        bent = stress.tilted_plate_stress(circle, bore, thick, asked)
        sheared = stress.disc_shear(torque, circle, thick)
        yield HeldStress(
            part,
            "between the holes of the output's face",
            math.hypot(bent, sheared) / left,
            f"{asked:.3g} N*m tilt and {torque:.3g} N*m twist it",
        )


def _cap(machine: Machine, held: HeldLoads) -> Iterator[HeldStress]:
    carrier = machine.layout.carrier
    if not carrier.cap:
        return
    part, gap = "carrier cap", machine.layout.pack.gap
    seat = pressed_seats(machine, held.pins)[1]
    yield seat.held
    # A bar between two pins, at most half of all forces in it, out of line by the circle's rise.
    circle = carrier.pin_circle_radius
    most = 0.5 * float(np.abs(held.pins.cap).sum(axis=2).max())
    width = carrier.cap_outer - carrier.cap_inner - max(
        2.0 * carrier.counterbore_radius, seat.diameter
    )  # fmt: skip
    thick, rise = -gap - carrier.cap_bottom, circle * (1.0 - math.cos(math.pi / carrier.pin_count))
    drawn = most / (width * thick) * (1.0 + 6.0 * rise / width)
    yield HeldStress(part, "ring between its pins", drawn, f"{most:.0f} N along it at most")


def pressed_seats(machine: Machine, ends: PinEnds) -> tuple[PressedSeat, ...]:
    """The most pressed seat of a pin in the plate, and in the cap where there is one.

    Raises
    ------
    GeometryError
        When the machine cannot be laid out.
    """
    layout = machine.layout
    carrier, gap = layout.carrier, layout.pack.gap
    plate = _pressed(
        "carrier plate", plate_features(carrier, layout.shaft, 0.0), ends.plate, ends.plate_moment
    )
    if not carrier.cap:
        return (plate,)
    features = cap_features(carrier, gap, 0.0)
    return plate, _pressed("carrier cap", features, ends.cap, ends.cap_moment)


def _pressed(
    part: str, features: Sequence[Feature], on_it: ComplexArray, moment: FloatArray
) -> PressedSeat:
    seat = next(one for one in features if isinstance(one, FittedHole) and "pin" in one.name)
    long, force = seat.top - seat.bottom, np.abs(on_it)
    pressed = stress.socket_pressure(force, moment, seat.diameter, long)
    worst = np.unravel_index(int(pressed.argmax()), pressed.shape)
    most = (float(one[worst]) for one in (pressed, force, moment))
    return PressedSeat(part, seat.name, seat.diameter, long, *most)
