"""Notes for fitting of the parts of a bill: seats, torques, bonds, gaps."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from cqdd_design.catalog.adhesives import ROTOR_COMPOUND
from cqdd_design.catalog.bearings import Bearing, find_bearing
from cqdd_design.catalog.internal_clearance import clearance_group
from cqdd_design.catalog.tightening import torque_words
from cqdd_design.errors import CatalogError
from cqdd_design.exporting.bill.known import catalogue_designations
from cqdd_design.machine.output_seat import ordered_clearance, seated_states
from cqdd_design.machine.screws import tightening_torques
from cqdd_design.machine.sealing import bearing_seals
from cqdd_design.solids.features import zones

if TYPE_CHECKING:
    from cqdd_design.machine import Machine
    from cqdd_design.solids.layout import Layout
    from cqdd_design.solids.motor_layout import MotorEnd
    from cqdd_design.solids.part import Part

_SAME = 1e-7
_MM, _UM = 1e3, 1e6


def fitting_notes(machine: Machine) -> dict[str, str]:
    """How bought parts are put in, by the name of the part; those without are left out."""
    layout, parts = machine.layout, {part.name: part for part in machine.parts}
    notes = {**_bearings(machine, parts), **_needles(parts), **_motor(machine)}
    for name, torque in tightening_torques(machine).items():
        if name in parts:
            notes[name] = f"tighten to {torque_words(torque)} N m, thread and head lightly oiled"
    notes["encoder screw"] = "holds the board alone; tighten by hand"
    carrier = layout.carrier
    if carrier.bonded_in_cap and carrier.pin.screw is not None:
        notes["shoulder screw"] += f"; seat in the cap bonded with {ROTOR_COMPOUND.name}"
    for name, part in parts.items():
        if name.endswith("screw") and part.designation not in catalogue_designations():
            told = "no such length is sold: turned to order"
            notes[name] = f"{notes[name]}; {told}" if name in notes else told
    notes |= _shims(machine)
    for name in ("shaft bearing", "output bearing"):
        notes[name] += f"; {bearing_seals(machine)}"
    if layout.dowels.radius:
        notes["ring dowel"] = (
            "slid in with the ring in its seat, half in its grooves and half in the housing's, "
            f"with {ROTOR_COMPOUND.name}, which takes the play of {zones.DOWEL} in "
            f"{zones.SEAM_GROOVE}; the clamp keeps them"
        )
    return {name: note for name, note in notes.items() if name in parts}


def _shims(machine: Machine) -> dict[str, str]:
    """How packs of shims are chosen, by the stacks of their bearings."""
    notes = {}
    for stack in machine.axial_stacks:
        if stack.shims is None or stack.kit is None:
            continue
        name = "shaft shim" if stack.shims is machine.layout.carrier.shaft_shim else "output shim"
        least, most = (_MM * value for value in stack.play)
        room = " to ".join(f"{_MM * value:.2f}" for value in stack.worst)
        told = (
            f"take the thickest pack that leaves {least:.2f} mm: the play is then {least:.2f} to "
            f"{most:.2f} mm"
        )
        if stack.clamped:
            told = (
                f"grind a pack to it, or up to {-least:.2f} mm more: it clamps the split outer "
                "ring, whose halves play would let apart"
            )
        notes[name] = (
            f"{stack.kit.told}: measure the parts' lengths singly before any is fitted, whose sum "
            f"is the room, {room} mm, and {told}; drawn {_MM * stack.shims.pack:g} mm; a price is "
            "that of all of them"
        )
    return notes


def _bearings(machine: Machine, parts: dict[str, Part]) -> dict[str, str]:
    layout = machine.layout
    return {
        "cam bearing": _seated(
            layout.pack.cam.bearing.bore_diameter,
            layout.pack.cam.bearing.outer_diameter,
            parts.values(),
            ("eccentric shaft", "disc"),
        )
        + _inner_rings(layout)
        + _clearance(
            layout.pack.cam.bearing,
            (zones.LOBE, zones.DISC_BORE),
            machine.design.reducer.cam_bearing.radial_clearance,
        )
        + _on_loose_cam(machine, parts),
        "shaft bearing": _seated(
            layout.shaft.support.bearing.bore_diameter,
            layout.shaft.support.bearing.outer_diameter,
            parts.values(),
            ("eccentric shaft", "housing", "carrier plate"),
        )
        + f"; the load turns with the shaft, so {ROTOR_COMPOUND.name} keeps the outer rings from "
        "creeping in their seats"
        + _clearance(layout.shaft.support.bearing, (zones.JOURNAL, zones.HOUSED)),
        "output bearing": _seated(
            layout.carrier.output.bearing.bore_diameter,
            layout.carrier.output.bearing.outer_diameter,
            parts.values(),
            ("carrier plate", "output cover"),
        )
        + "; locked with the bearing nut"
        + _output_clearance(machine),
    }


def _output_clearance(machine: Machine) -> str:
    """The clearance of the output bearing to order; OUTPUT-PRELOAD judges it."""
    row = machine.layout.carrier.output.bearing
    try:
        found = ordered_clearance(row, machine.design.carrier_material)
        fitted = seated_states(machine, None)[0].seated
    except CatalogError as error:
        return f"; radial clearance: {error.message}"
    return (
        f"; radial clearance {found.name}, {_UM * found.least:.0f} to {_UM * found.most:.0f} "
        f"\u00b5m: its seats leave {_UM * fitted.mean:.0f} \u00b1{_UM * fitted.spread:.0f} "
        "\u00b5m; what heat takes OUTPUT-PRELOAD judges"
    )


def _clearance(bearing: Bearing, seats: tuple[str, str], wanted: float | None = None) -> str:
    """The clearance to order: of what a group has, its seats take a part.

    Parameters
    ----------
    wanted : float or None
        That the design counts with, m.
    """
    if bearing.kind != "ball":
        return ""
    found = clearance_group(bearing.bore_diameter, bearing.outer_diameter, *seats, wanted or 0.0)
    if found is None:
        return ""
    counted = "" if wanted is None else f" (the design counts with {_UM * wanted:.3g})"
    return (
        f"; radial clearance {found.name}, {_UM * found.least:.0f} to {_UM * found.most:.0f} "
        f"\u00b5m: its seats leave {_UM * found.left:.0f} \u00b1{_UM * found.spread:.0f} \u00b5m"
        f"{counted}"
    )


def _inner_rings(layout: Layout) -> str:
    """What holds the inner rings of needle bearings, along which their needles slide."""
    if layout.pack.cam.bearing.raceway_diameter is None:
        return ""
    return (
        f"; inner rings bonded on their lobes with {ROTOR_COMPOUND.name} in the middle of the "
        "outer ones, for needles hold nothing along the shaft"
    )


def _on_loose_cam(machine: Machine, parts: dict[str, Part]) -> str:
    """The seat of the one cam bearing that is not on the shaft itself."""
    loose, bore = parts.get("eccentric cam"), machine.layout.pack.cam.bearing.bore_diameter
    if loose is None:
        return ""
    lobe = next(fit for fit in loose.fits if abs(fit.diameter - bore) < _SAME)
    return f"; the third on the eccentric cam {_MM * bore:g} {lobe.zone}"


def _seated(bore: float, outer: float, parts: Iterable[Part], names: tuple[str, ...]) -> str:
    """Seats of the inner and of the outer rings, as the fits of the parts around them say."""

    def zone(name: str, diameter: float) -> str:
        for part in parts_list:
            for fit in part.fits:
                if _is(part, name) and abs(fit.diameter - diameter) < _SAME:
                    return f"{_MM * diameter:g} {fit.zone}"
        return f"{_MM * diameter:g}"

    parts_list = tuple(parts)
    inner, *outside = names
    seats = " and the ".join(f"{name} {zone(name, outer)}" for name in outside)
    return f"on the {inner} {zone(inner, bore)}, in the {seats}"


def _is(part: Part, name: str) -> bool:
    """Whether a part is called so; ``disc`` stands for every disc."""
    return part.name == name or (name == "disc" and part.name.startswith("disc "))


def _needles(parts: dict[str, Part]) -> dict[str, str]:
    notes = {}
    for name, part in parts.items():
        if name.endswith(("needle cage", "needle bearing")):
            row = find_bearing(part.designation)
            on = "on hardened pins" if row.raceway_diameter is None else "on its inner ring"
            notes[name] = f"packed with grease, {on}"
    return notes


def _motor(machine: Machine) -> dict[str, str]:
    layout: Layout = machine.layout
    motor, outside = layout.motor_end, layout.motor is not None
    if motor is None:
        return {}
    return {
        "motor stator": (
            f"bonded on the housing's register, {2.0 * _MM * motor.stack_inner:g} {zones.REGISTER}"
            if outside
            else f"bonded into its seat in the cover, {2.0 * _MM * motor.stack_outer:g} "
            f"{zones.HOUSED}"
        ),
        "motor rotor": f"bonded {'into the bell' if outside else 'on the hub'} with "
        f"{ROTOR_COMPOUND.name}; comes with the stator",
        **(_ring_encoder(motor) if motor.open else _encoder(motor, layout.shaft.bottom)),
    }


def _encoder(motor: MotorEnd, shaft_end: float) -> dict[str, str]:
    """Under the end of a shaft, whose height is told, m."""
    inside = motor.magnet_bottom >= shaft_end - _SAME
    place = "into the shaft's end" if inside else "on the shaft's end, centred by a sleeve"
    gap = motor.magnet_bottom - motor.sensor_top
    return {
        "encoder magnet": f"bonded {place} with {ROTOR_COMPOUND.name}",
        "encoder board": (
            f"{_MM * gap:g} mm from magnet to sensor; the sensor stands in the middle of a round "
            f"board of {_board(motor)}, on three screws, bought with it or made to the outline in "
            "STEP; its cable leaves through the hole under it in the motor cover"
        ),
    }


def _ring_encoder(motor: MotorEnd) -> dict[str, str]:
    """Round a hollow shaft."""
    gap, hole = motor.board_inner - motor.magnet_radius, 2.0 * motor.board_inner
    return {
        "encoder magnet": (
            f"slid on the shaft's stub last, flush with its end, and bonded with "
            f"{ROTOR_COMPOUND.name}"
        ),
        "encoder board": (
            f"sensor at half the magnet's height, the board's edge {_MM * gap:g} mm beside it; a "
            f"round board of {_board(motor)}, with a hole of {_MM * hole:g} mm, on three screws, "
            "bought with it or made to the outline in STEP; its cable leaves through the hole "
            "under it in the motor cover; trim and calibrate the sensor for its place beside the "
            "shaft"
        ),
    }


def _board(motor: MotorEnd) -> str:
    thick = motor.board_top - motor.board_bottom
    return f"{2.0 * _MM * motor.board_radius:g} mm, {_MM * thick:g} mm thick"
