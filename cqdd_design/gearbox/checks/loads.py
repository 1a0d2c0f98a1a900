"""Checks of loads: Hertz pressures, output pins, cam bearing."""

from __future__ import annotations

import math
from collections.abc import Callable

from cqdd_design.catalog.bearings import Bearing
from cqdd_design.catalog.materials import Material, find_material, materials
from cqdd_design.catalog.screws import shoulder_screws
from cqdd_design.gearbox import cam_bearing
from cqdd_design.gearbox.bearing_life import load_for_life
from cqdd_design.gearbox.checks import allowables
from cqdd_design.gearbox.checks.allowables import UNEVEN_SHARING, Allowable
from cqdd_design.gearbox.checks.state import GearboxState, build_check
from cqdd_design.gearbox.loads import RigidMaxima
from cqdd_design.geometry.limits import rounded_down, rounded_up
from cqdd_design.results import Check

_MEGA = 1e6
_MOST_THICKENING = 2.0
"""A thicker disc is offered as a remedy up to this many times its thickness."""

_MaterialRule = Callable[[Material], Allowable]


def load_checks(state: GearboxState) -> tuple[Check, ...]:
    """All checks of this chapter."""
    return (*_contact(state), *_pins(state), *_bearing(state))


def _torque(value: float) -> str:
    return f"{rounded_down(value):g} N*m"


def _contact(state: GearboxState) -> tuple[Check, ...]:
    reducer = state.design.reducer
    disc = find_material(reducer.disc_material)
    ring, pin = find_material(reducer.ring_material), find_material(reducer.output_pins.material)
    static, fatigue = allowables.contact_limit_static, allowables.contact_limit_fatigue

    def one(check_id: str, load: RigidMaxima, rule: _MaterialRule, other: Material) -> Check:
        at_ring = other is ring
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
            _softer_contact(reducer.disc_thickness, load.torque, pressure, allowed.value)
            + _harder_parts(parts, rule, pressure),
            basis=allowed.basis,
        )

    return (
        one("CONTACT-RING-PEAK", state.rigid_peak, static, ring),
        one("CONTACT-RING-CONTINUOUS", state.rigid_continuous, fatigue, ring),
        one("CONTACT-PIN-PEAK", state.rigid_peak, static, pin),
        one("CONTACT-PIN-CONTINUOUS", state.rigid_continuous, fatigue, pin),
    )


def _softer_contact(thickness: float, torque: float, pressure: float, limit: float) -> str:
    """Say what brings a Hertz pressure down to a limit: it grows with sqrt(T/b)."""
    if limit <= 0.0:
        return ""
    share = (pressure / limit) ** 2
    words = f"lower the torque to {_torque(torque / share)}, or "
    if share <= _MOST_THICKENING:
        words = f"raise disc_thickness to {rounded_up(thickness * 1e3 * share):g} mm, or " + words
    return words


def _harder_parts(parts: dict[str, Material], rule: _MaterialRule, pressure: float) -> str:
    """Name, for every part too weak, the catalogue's mildest material that allows the pressure."""
    words = []
    for part, material in parts.items():
        if rule(material).value >= pressure:
            continue
        enough = [
            (rule(other).value, other.name)
            for other in materials().values()
            if rule(other).value >= pressure and (part == "pins" or other.form != "fastener")
        ]
        if not enough:
            most = rounded_up(pressure / _MEGA)
            return f"spread the load: no catalogue material allows {most:g} MPa"
        value, name = min(enough)
        words.append(f"the {part} of '{name}' ({value / _MEGA:.0f} MPa)")
    return "make " + " and ".join(words)


def _pins(state: GearboxState) -> tuple[Check, ...]:
    pins, reducer = state.design.reducer.output_pins, state.design.reducer
    strength, peak, continuous = state.output_pins, state.rigid_peak, state.rigid_continuous
    material = find_material(pins.material)
    bending_limit = allowables.pin_limit_peak(material)
    shear_limit = allowables.pin_shear_limit_peak(material)
    bearing_limit = allowables.weaker(
        bending_limit, allowables.pin_limit_peak(find_material(reducer.disc_material))
    )
    d = pins.diameter * 1e3
    # What bears on the hole is the sleeve where there is one; bent and sheared is the pin.
    runner = max(pins.diameter, pins.sleeve_diameter)
    needed = peak.torque

    def capacity(check_id: str, torque: float, substituted: str) -> Check:
        thicker = d * math.sqrt(needed / torque)
        return build_check(
            check_id,
            torque,
            needed,
            substituted,
            f"use pins of {_pin_size(thicker)}, or lower the peak torque to {_torque(torque)}",
        )

    def stress(
        check_id: str, raw: float, allowed: Allowable, load: RigidMaxima, power: int
    ) -> Check:
        value = UNEVEN_SHARING * raw
        force = UNEVEN_SHARING * load.output_pin_force
        where = {
            1: f"{runner * 1e3:g} mm x {reducer.disc_thickness * 1e3:g} mm",
            2: f"{d:g} mm",
            3: f"{d:g} mm, arm {strength.bending_arm * 1e3:.4f} mm ({pins.support})",
        }[power]
        return build_check(
            check_id,
            value / _MEGA,
            allowed.value / _MEGA,
            f"{UNEVEN_SHARING:g} x {raw / _MEGA:.1f} MPa = {value / _MEGA:.1f} MPa "
            f"(F {force:.1f} N on {where}) at {load.torque:g} N*m",
            _stronger_pins(state, value, allowed, load.torque, power),
            basis=allowed.basis,
        )

    fatigue = allowables.pin_bending_limit_continuous(
        material, duty_reverses=strength.duty_reverses
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
        stress("PIN-SHEAR-PEAK", strength.shear_stress_peak, shear_limit, peak, 2),
        stress("PIN-BENDING-PEAK", strength.bending_stress_peak, bending_limit, peak, 3),
        stress(
            "PIN-BENDING-CONTINUOUS", strength.bending_stress_continuous, fatigue, continuous, 3
        ),
        stress("PIN-BEARING-PEAK", strength.bearing_pressure_peak, bearing_limit, peak, 1),
    )


def _pin_size(least_mm: float) -> str:
    """Name the thinnest catalogue shoulder of at least this diameter, or the number itself."""
    sizes = sorted(screw.shoulder_diameter * 1e3 for screw in shoulder_screws().values())
    enough = [size for size in sizes if size >= least_mm]
    wanted = f"{rounded_up(least_mm):g} mm"
    return f"{enough[0]:g} mm (at least {wanted})" if enough else f"at least {wanted}"


def _stronger_pins(
    state: GearboxState, value: float, allowed: Allowable, torque: float, power: int
) -> str:
    """Remedy for a pin stress that falls with d^power and with the number of pins."""
    if allowed.value <= 0.0:
        return f"choose a pin material the catalogue knows strengths of: {allowed.basis}"
    pins = state.design.reducer.output_pins
    ratio = value / allowed.value
    lower = f"lower the torque to {_torque(torque / ratio)}"
    if power == 1 and pins.sleeve_diameter > 0.0:
        wider = rounded_up(pins.sleeve_diameter * 1e3 * ratio)
        return f"raise output_pins.sleeve_diameter to {wider:g} mm, or {lower}"
    thicker = pins.diameter * 1e3 * ratio ** (1.0 / power)
    # An even count, whose peak factor is exactly four.
    count = 2 * math.ceil(0.5 * pins.count * ratio * 4.0 / state.output_pins.peak_force_factor)
    # Twice the count on the same circle needs room between the holes.
    reach = 2.0 * pins.circle_radius * math.sin(math.pi / count)
    room = reach - state.geometry.hole_diameter >= allowables.LIGAMENT
    more = f", or {count} of them" if room else ""
    held = ", or hold the pins at both ends" if power == 3 and pins.support != "both" else ""
    return f"use pins of {_pin_size(thicker)}{more}{held}, or {lower}"


def _bearing(state: GearboxState) -> tuple[Check, ...]:
    cam, requirements = state.cam_bearing, state.design.requirements
    bearing, exponent = cam.bearing, cam.exponent
    rpm = cam.speed * 30.0 / math.pi
    safety, life = cam.static_safety or 0.0, cam.life_hours or 0.0
    static, dynamic = bearing.static_rating or 0.0, bearing.dynamic_rating or 0.0
    at_life = float(load_for_life(dynamic, allowables.LIFE_HOURS, cam.speed, exponent))
    other = _other_bearing(state)
    needed = cam.continuous_load * dynamic / at_life if at_life > 0.0 else math.nan
    checks = [
        build_check(
            "BEARING-STATIC",
            safety,
            allowables.STATIC_SAFETY,
            f"{bearing.designation}: {static:.0f} N/{cam.peak_load:.1f} N = {safety:.3f}",
            f"needs C0 of {cam.peak_load / 1e3 * allowables.STATIC_SAFETY:.3g} kN: {other}; or "
            + _lower_torque(requirements.peak_torque, safety / allowables.STATIC_SAFETY),
        ),
        build_check(
            "BEARING-LIFE",
            life,
            allowables.LIFE_HOURS,
            f"{bearing.designation}: 1e6 ({dynamic:.0f} N/{cam.continuous_load:.1f} N)^"
            f"{exponent:.3g}/(60 x {rpm:.0f} rpm) = {life:.0f} h",
            (f"needs C of {needed / 1e3:.3g} kN: " if math.isfinite(needed) else "")
            + f"{other}; or "
            + _lower_torque(requirements.continuous_torque, at_life / cam.continuous_load),
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


def _lower_torque(torque: float, share: float) -> str:
    if share <= 0.0:
        return "choose a bearing with catalogue ratings"
    return f"lower the torque to {_torque(torque * share)}"


def _other_bearing(state: GearboxState) -> str:
    """Say what the catalogue offers in the same space."""
    fitting = cam_bearing.fitting_bearings(state.design, state.geometry.largest_cam_bearing)
    cam = state.cam_bearing
    best = cam_bearing.choose(fitting, cam.peak_load, cam.continuous_load, cam.speed)
    most = state.geometry.largest_cam_bearing * 1e3
    if best is None:
        return f"no catalogue bearing fits the {most:.1f} mm there are"
    if cam_bearing.passes(best):
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
