"""Lines of the joints that carry the torque: dowels, and the bond of the motor's bell."""

from __future__ import annotations

from dataclasses import replace

from cqdd_design.catalog.adhesives import ROTOR_COMPOUND, joint_shear
from cqdd_design.catalog.materials import find_material
from cqdd_design.errors import CatalogError, ContactError, GeometryError
from cqdd_design.gearbox.checks.allowables import (
    GREASE_MOST,
    Allowable,
    bond_limit,
    dowel_limit_shear,
)
from cqdd_design.gearbox.checks.remedies import lower_peak
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.geometry.limits import rounded_down
from cqdd_design.machine import Machine
from cqdd_design.machine.cures import ROUGHLY, torques_that_hold
from cqdd_design.machine.dowels import LoadedDowels, loaded_dowels, loaded_pin_seats
from cqdd_design.machine.temperatures import MachineTemperatures
from cqdd_design.results import Check
from cqdd_design.solids.motor_rules import MOST_HUB, bell_material, bell_torque, bonded_length

_MEGA = 1e6
_CURRENT = "motor.current_limit"
_WIDER = (
    "leave room for larger support bearings, whose bore is the stub's diameter (a cam bearing with "
    "a larger bore)"
)
DOWELS = ("DOWEL-SHEAR", "DOWEL-BEARING")


def joint_lines(machine: Machine, warm: MachineTemperatures | None) -> tuple[Check, ...]:
    """Dowels and pins' seats at the peak torque, the bell's bond at the motor's.

    Parameters
    ----------
    warm : MachineTemperatures or None
        Where they are not known, the bond is as warm as grease may be.
    """
    return (*_dowels(machine), bell_line(machine, warm))


def _dowels(machine: Machine) -> tuple[Check, ...]:
    try:
        found, seats = loaded_dowels(machine), loaded_pin_seats(machine)
        lacking = _lacking(machine)
    except (CatalogError, ContactError, GeometryError) as error:
        return tuple(
            build_check(one, None, None, error.message, "see why it is not known") for one in DOWELS
        )
    if lacking:
        remedy = "raise ring.outer_diameter, or lower output_pins.diameter"
        return tuple(build_check(one, None, None, lacking, remedy) for one in DOWELS)
    asked, lines = machine.design.requirements, _judged(found, seats)
    cures = torques_that_hold(
        lambda torque: dowels(machine.under(peak=torque)),
        asked.peak_torque,
        lines,
        near=ROUGHLY,
    )
    return tuple(
        replace(
            line,
            remedy=f"{line.remedy}; or {lower_peak(cures[line.id], asked.continuous_torque)}",
        )
        if line.id in cures
        else line
        for line in lines
    )


def dowels(machine: Machine) -> tuple[Check, Check]:
    """Both lines at the peak torque; errors as of `loaded_dowels`."""
    return _judged(loaded_dowels(machine), loaded_pin_seats(machine))


def _judged(
    found: tuple[LoadedDowels, ...], seats: tuple[LoadedDowels, ...]
) -> tuple[Check, Check]:
    """Both lines of some dowels, and of seats of pins, whose shear is another line's."""
    shear, press = (
        [(one, one.stress.shear, dowel_limit_shear()) for one in found],
        [(one, one.stress.pressure, one.seat) for one in (*found, *seats)],
    )
    return (
        _dowel("DOWEL-SHEAR", shear, "larger dowels ask for a thicker ring"),
        _dowel("DOWEL-BEARING", press, "take a stronger {one.metal}, or {one.wider}"),
    )


def bell_line(machine: Machine, warm: MachineTemperatures | None) -> Check:
    """The bond between the shaft and the motor's bell, at the motor's torque; see `joint_lines`."""
    line = _bell(machine, warm)
    if line.status != "fail" or machine.stiff or not line.limit:
        return line
    # The hub is as long as its torque asks for, so that less of it need not help.
    held = torques_that_hold(
        lambda current: (_bell(machine.changed({_CURRENT: current}), warm),),
        machine.design.motor.current_limit,
        (line,),
        near=ROUGHLY,
    )
    ways = [_WIDER]
    if current := held[line.id]:
        ways.append(
            f"lower {_CURRENT} to {rounded_down(current):g} A (and with it what MOTOR-PEAK reaches)"
        )
    return replace(line, remedy="; or ".join((*ways, "cool it")))


def bell_strength(machine: Machine) -> Check:
    """The line of the bell where temperatures are not known, without what to change."""
    return _bell(machine, None)


def _bell(machine: Machine, warm: MachineTemperatures | None) -> Check:
    name, design = "BELL-JOINT", machine.design
    try:
        layout = machine.layout
    except (CatalogError, GeometryError) as error:
        return build_check(name, None, None, error.message, "see why it is not known")
    motor = layout.motor_end
    if motor is None:
        return build_check(
            name, None, None, f"no bell or hub is drawn: {layout.motor_missing}",
            "name a motor whose sizes are known and which leaves a hub on the shaft room",
        )  # fmt: skip
    hot, guessed = GREASE_MOST, " (not known, what grease bears)"
    if warm is not None:
        hot, guessed = max(warm.hottest("rotor"), warm.hottest("shaft")), ""
    metal = find_material(bell_material(design))
    limit = bond_limit(ROTOR_COMPOUND, metal, hot)
    stub, hub = layout.shaft.support.bearing.bore_diameter, bonded_length(motor)
    long = min(hub, MOST_HUB * stub)
    idle = f" (of which {1e3 * long:.3g} carry)" if long < hub - 1e-9 else ""
    torque = bell_torque(design, layout.motor_row)
    value = joint_shear(torque, stub, long)
    cure = _WIDER
    if not limit.value:
        cure = (
            f"cool it: no strength of {ROTOR_COMPOUND.name} is known beyond "
            f"{ROTOR_COMPOUND.hottest:g} degC"
        )
    return build_check(
        name,
        value / _MEGA,
        limit.value / _MEGA,
        f"{torque:.3g} N*m on a stub of {1e3 * stub:g} mm, bonded over {1e3 * hub:.3g} mm{idle} at "
        f"{hot:.0f} degC{guessed}: "
        f"{value / _MEGA:.2f} MPa",
        cure,
        basis=limit.basis,
    )


def _lacking(machine: Machine) -> str:
    """What has no dowel, in words."""
    layout = machine.layout
    if not layout.dowels.radius:
        return "no dowel goes between the ring and its seat: nothing but the clamp holds it"
    if not layout.carrier.flange_dowels.count:
        return "no dowel goes into the output's face between the pins and the shaft's bearing"
    return ""


def _dowel(name: str, every: list[tuple[LoadedDowels, float, Allowable]], cure: str) -> Check:
    """The line of the dowels with least reserve, the others beside it.

    Parameters
    ----------
    cure : str
        With ``{one}`` for these.
    """
    told = "; ".join(
        f"{one.place}: {one.size}, {value / _MEGA:.4g} of {limit.value / _MEGA:.4g} MPa under "
        f"{one.torque:.4g} N*m" + (f" and {one.across:.4g} N across" if one.across else "")
        for one, value, limit in every
    )
    worst, value, limit = min(every, key=lambda row: row[2].value / row[1])
    return build_check(
        name,
        value / _MEGA,
        limit.value / _MEGA if limit.value else None,
        told,
        cure.format(one=worst),
        basis=limit.basis,
    )
