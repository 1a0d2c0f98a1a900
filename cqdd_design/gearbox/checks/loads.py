"""Checks of loads: Hertz pressures, output pins, cam bearing."""

from __future__ import annotations

import math
from functools import partial

from cqdd_design.catalog.bearings import Bearing
from cqdd_design.catalog.materials import find_material
from cqdd_design.gearbox import cam_bearing
from cqdd_design.gearbox.bearing_life import load_for_life
from cqdd_design.gearbox.checks import allowables
from cqdd_design.gearbox.checks.allowables import UNEVEN_SHARING, Allowable
from cqdd_design.gearbox.checks.remedies import (
    MaterialRule,
    harder_parts,
    lower_screened,
    softer_contact,
    stronger_capacity,
    stronger_pins,
)
from cqdd_design.gearbox.checks.state import GearboxState, build_check
from cqdd_design.gearbox.loads import RigidMaxima
from cqdd_design.results import Check
from cqdd_design.terms import life_text

_MEGA = 1e6
_SPREAD = {
    True: "raise ring_pitch_radius or disc_count",
    False: "raise output_pins.circle_radius or count",
}
"""What spreads the load of the ring, and of the pins."""


def load_checks(state: GearboxState) -> tuple[Check, ...]:
    """All checks of this chapter."""
    return (*_contact(state), *_pins(state), *_bearing(state))


def _contact(state: GearboxState) -> tuple[Check, ...]:
    reducer = state.design.reducer
    disc = find_material(reducer.disc_material)
    ring, pin = find_material(reducer.ring_material), find_material(reducer.output_pins.material)
    static, fatigue = allowables.contact_limit_static, allowables.contact_limit_fatigue

    def one(check_id: str, load: RigidMaxima, rule: MaterialRule) -> Check:
        at_ring = check_id.startswith("CONTACT-RING")
        other = ring if at_ring else pin
        raw = load.ring_pressure if at_ring else load.output_pressure
        force = load.ring_force if at_ring else load.output_pin_force
        pressure = math.sqrt(UNEVEN_SHARING) * raw
        allowed = allowables.weaker(rule(disc), rule(other))
        parts = {"disc": disc, "ring" if at_ring else "pins": other}
        return build_check(
            check_id,
            pressure / _MEGA,
            allowed.value / _MEGA,
            f"sqrt({UNEVEN_SHARING:g}) x {raw / _MEGA:.1f} MPa = {pressure / _MEGA:.1f} MPa "
            f"(F up to {force:.1f} N a disc, b {reducer.disc_thickness * 1e3:g} mm) at "
            f"{load.torque:g} N*m",
            softer_contact(
                reducer.disc_thickness,
                pressure,
                allowed.value,
                lambda share: lower_screened(state, load, share),
            )
            + harder_parts(parts, rule, pressure, _SPREAD[at_ring]),
            basis=allowed.basis,
        )

    return (
        one("CONTACT-RING-PEAK", state.rigid_peak, static),
        one("CONTACT-RING-CONTINUOUS", state.rigid_continuous, fatigue),
        one("CONTACT-PIN-PEAK", state.rigid_peak, static),
        one("CONTACT-PIN-CONTINUOUS", state.rigid_continuous, fatigue),
    )


def _pins(state: GearboxState) -> tuple[Check, ...]:
    pins, reducer = state.design.reducer.output_pins, state.design.reducer
    strength, peak, continuous = state.output_pins, state.rigid_peak, state.rigid_continuous
    material = find_material(pins.material)
    bending, shear = allowables.pin_limit_peak, allowables.pin_shear_limit_peak
    fatigue = partial(allowables.pin_bending_limit_continuous, duty_reverses=strength.duty_reverses)
    bearing_limit = allowables.weaker(
        bending(material), bending(find_material(reducer.disc_material))
    )
    d = pins.diameter * 1e3
    held = reducer.carrier.joint if pins.support == "both" else pins.support
    # What bears on the hole is the sleeve where there is one; bent and sheared is the pin.
    runner = max(pins.diameter, pins.sleeve_diameter)
    needed = peak.torque

    def capacity(check_id: str, torque: float, substituted: str) -> Check:
        remedy = stronger_capacity(state, torque, needed)
        return build_check(check_id, torque, needed, substituted, remedy)

    def stress(
        check_id: str,
        raw: float,
        limits: tuple[MaterialRule, Allowable],
        load: RigidMaxima,
        power: int,
    ) -> Check:
        allowed = limits[1]
        value = UNEVEN_SHARING * raw
        force = UNEVEN_SHARING * load.output_pin_force
        where = {
            1: f"{runner * 1e3:g} mm x {reducer.disc_thickness * 1e3:g} mm",
            2: f"{d:g} mm",
            3: f"{d:g} mm, arm {strength.bending_arm * 1e3:.4f} mm ({held})",
        }[power]
        return build_check(
            check_id,
            value / _MEGA,
            allowed.value / _MEGA,
            f"{UNEVEN_SHARING:g} x {raw / _MEGA:.1f} MPa = {value / _MEGA:.1f} MPa "
            f"(F {force:.1f} N on {where}) at {load.torque:g} N*m",
            stronger_pins(
                state, value, limits, lower_screened(state, load, limits[1].value / value), power
            ),
            basis=allowed.basis,
        )

    factor = strength.peak_force_factor
    return (
        capacity(
            "PIN-PAPER",
            strength.paper_torque_total,
            f"{pins.count} x {strength.paper_torque_per_pin:.2f} N*m "
            f"= {strength.paper_torque_total:.2f} N*m",
        ),
        capacity(
            "PIN-SHARED",
            strength.shared_torque_capacity,
            f"{reducer.disc_count} x {strength.paper_torque_total:.2f} N*m/{factor:.3f} "
            f"= {strength.shared_torque_capacity:.2f} N*m",
        ),
        stress("PIN-SHEAR-PEAK", strength.shear_stress_peak, (shear, shear(material)), peak, 2),
        stress(
            "PIN-BENDING-PEAK", strength.bending_stress_peak, (bending, bending(material)), peak, 3
        ),
        stress(
            "PIN-BENDING-CONTINUOUS",
            strength.bending_stress_continuous,
            (fatigue, fatigue(material)),
            continuous,
            3,
        ),
        stress(
            "PIN-BEARING-PEAK", strength.bearing_pressure_peak, (bending, bearing_limit), peak, 1
        ),
    )


def _bearing(state: GearboxState) -> tuple[Check, ...]:
    cam = state.cam_bearing
    bearing, exponent = cam.bearing, cam.exponent
    rpm = cam.speed * 30.0 / math.pi
    safety, life = cam.static_safety or 0.0, cam.life_hours or 0.0
    static, dynamic = bearing.static_rating or 0.0, bearing.dynamic_rating or 0.0
    hours = state.design.requirements.life_hours
    at_life = float(load_for_life(dynamic, hours, cam.speed, exponent))
    other = _other_bearing(state)
    needed = cam.continuous_load * dynamic / at_life if at_life > 0.0 else math.nan
    checks = [
        build_check(
            "BEARING-STATIC",
            safety,
            allowables.STATIC_SAFETY,
            f"{bearing.designation}: {static:.0f} N/{cam.peak_load:.1f} N = {safety:.3f}",
            f"needs C0 of {cam.peak_load / 1e3 * allowables.STATIC_SAFETY:.3g} kN: {other}; or "
            + lower_screened(state, state.rigid_peak, safety / allowables.STATIC_SAFETY),
        ),
        build_check(
            "BEARING-LIFE",
            life,
            hours,
            f"{bearing.designation}: 1e6 ({dynamic:.0f} N/{cam.continuous_load:.1f} N)^"
            f"{exponent:.3g}/(60 x {rpm:.0f} rpm) = {life_text(life)}",
            (f"needs C of {needed / 1e3:.3g} kN: " if math.isfinite(needed) else "")
            + f"{other}; or "
            + lower_screened(state, state.rigid_continuous, at_life / cam.continuous_load),
        ),
    ]
    if bearing.kind == "needle cage":
        disc = find_material(state.design.reducer.disc_material)
        checks.append(
            build_check(
                "BEARING-RACEWAY",
                disc.rockwell_hardness or 0.0,
                allowables.HARDENED_HRC,
                f"{disc.name}: {disc.hardness or 'no hardness given'}",
                "make the disc of 'AISI 52100 / 100Cr6 hardened', or use a bearing with rings",
            )
        )
    return tuple(checks)


def _other_bearing(state: GearboxState) -> str:
    """Say what the catalogue offers in the same space."""
    fitting = cam_bearing.fitting_bearings(state.design, state.geometry.largest_cam_bearing)
    cam = state.cam_bearing
    hours = state.design.requirements.life_hours
    best = cam_bearing.choose(fitting, cam.peak_load, cam.continuous_load, cam.speed, hours)
    most = state.geometry.largest_cam_bearing * 1e3
    if best is None:
        return f"no catalogue bearing fits the {most:.1f} mm there are"
    if cam_bearing.passes(best, hours):
        return f"{_describe(best.bearing)} fits and carries it"
    return (
        f"none that fits {most:.1f} mm carries it (the best is {_describe(best.bearing)}), so "
        "raise output_pins.circle_radius and ring_pitch_radius to make room"
    )


def _describe(bearing: Bearing) -> str:
    return (
        f"{bearing.designation} ({bearing.bore_diameter * 1e3:g} x "
        f"{bearing.outer_diameter * 1e3:g} x {bearing.width * 1e3:g} mm)"
    )
