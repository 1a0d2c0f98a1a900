"""Checks of loads by the contact equilibrium: the same limits as of :mod:`.loads`, closer values.

At the peak torque stresses stand against what yields. At the continuous torque they stand against
what lasts the required hours over the duty, every place with the cycles that it sees.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import NamedTuple

from cqdd_design.catalog.materials import Material, find_material
from cqdd_design.gearbox import output_pins
from cqdd_design.gearbox.bearing_life import static_safety
from cqdd_design.gearbox.cam_bearing import BearingResult
from cqdd_design.gearbox.carrier import slender_bending_arm
from cqdd_design.gearbox.checks import allowables
from cqdd_design.gearbox.checks.allowables import Allowable
from cqdd_design.gearbox.checks.remedies import (
    MaterialRule,
    better_held,
    harder_parts,
    lower_peak,
    lower_shares,
    lower_to,
    stronger_pins,
    thicker_ring_pin,
)
from cqdd_design.gearbox.checks.state import GearboxState, build_check
from cqdd_design.gearbox.life import LifeResult
from cqdd_design.gearbox.life.result import PartLife
from cqdd_design.gearbox.life.runners import RunnerLife
from cqdd_design.gearbox.pin_beam import HELD
from cqdd_design.results import Check
from cqdd_design.terms import life_text

MODEL = "contact equilibrium of perfect parts, driving with friction"
DUTY_MODEL = f"fatigue over the duty by the {MODEL}"
ENDLESS = 1e9
"""Hours told of what does not wear out or never turns."""
Cures = Mapping[str, float]
"""What makes failing lines hold, by check: peak torques, N m, for lines of the peak, shares of the
duty's torques for lines of the duty; 0 where nothing does. A line without one is told by
proportion, which misses where fewer teeth share less torque."""
NO_CURES: Cures = MappingProxyType({})
_MEGA = 1e6
_UNEVEN = 1.2
"""Pins over those of a rigid law: where they yield within clearances, few share less evenly."""
_RING_SPREAD = "raise ring_pitch_radius or disc_count"
_PIN_SPREAD = "raise output_pins.circle_radius or count"


class PeakLoads(NamedTuple):
    """Greatest loads of both senses of the peak torque over the period, N and Pa.

    `pin_bending` is None where the pins' moments are not known.
    """

    torque: float
    ring_force: float
    pin_force: float
    cam_load: float
    ring_pressure: float
    pin_pressure: float
    pin_bending: float | None

    @classmethod
    def of(cls, torque: float, maxima: dict[str, float]) -> PeakLoads:
        """From the maxima of contact sweeps by their JSON keys, at a torque (N m)."""
        bending = maxima.get("output_pin_bending_max_MPa")
        return cls(
            torque,
            maxima["ring_force_max_N"],
            maxima["output_pin_force_max_N"],
            maxima["cam_bearing_load_max_N"],
            _MEGA * maxima["ring_pressure_max_MPa"],
            _MEGA * maxima["output_pressure_max_MPa"],
            None if bending is None else _MEGA * bending,
        )


def peak_checks(
    state: GearboxState, loads: PeakLoads, cures: Cures = NO_CURES
) -> tuple[Check, ...]:
    """Checks at the peak torque, by ids of :mod:`.loads` and :mod:`.runners`."""
    return (
        *_pressures(state, loads, cures),
        *_pins(state, loads, cures),
        *_statics(state, loads, cures),
    )


def lasting_checks(
    state: GearboxState, life: LifeResult, cures: Cures = NO_CURES
) -> tuple[Check, ...]:
    """Checks over the required hours of the duty, likewise."""
    ring, flanks, holes, pins, bending = life.parts
    return (
        _lasting("CONTACT-RING-CONTINUOUS", state, life, (ring, flanks), cures),
        _lasting("CONTACT-PIN-CONTINUOUS", state, life, (holes, pins), cures),
        _lasting("PIN-BENDING-CONTINUOUS", state, life, (bending,), cures),
        _cam_life(state, life, cures),
        *(_runner_life(state, life, one, cures) for one in life.runners),
        *_ring_pin_lasting(state, life, cures),
    )


def _lower_peak(
    check_id: str, state: GearboxState, torque: float, share: float, cures: Cures
) -> str:
    """How far to lower the peak torque (N m) of which a line bears a share."""
    lasting = state.design.requirements.continuous_torque
    return lower_peak(cures.get(check_id, torque * share), lasting)


def _lower_duty(check_id: str, life: LifeResult, share: float, cures: Cures) -> str:
    """The same of the continuous torque; of a duty its torques are meant."""
    return lower_duty(life, cures.get(check_id, share if life.assumed else None))


def lower_duty(life: LifeResult, share: float | None) -> str:
    """What to do where a line holds up to a share of the duty's torques; None where not known."""
    if life.assumed and share is not None:
        return lower_to(share * life.duty[0].torque, "continuous torque")
    return "lower the continuous torque" if life.assumed else lower_shares(share)


def _limited(
    check_id: str, value: float, allowed: Allowable, told: str, remedy: str, model: str = MODEL
) -> Check:
    """A check of a stress, Pa; unknown where the catalogue supports no limit."""
    known = allowed.value > 0.0
    return build_check(
        check_id,
        value / _MEGA,
        allowed.value / _MEGA if known else None,
        told if known else f"{told}; {allowed.basis}",
        remedy if known else "name a material whose strength the catalogue has",
        basis=allowed.basis,
        model=model,
    )


def _pressures(state: GearboxState, loads: PeakLoads, cures: Cures) -> tuple[Check, ...]:
    reducer, rule = state.design.reducer, allowables.contact_limit_static
    disc = find_material(reducer.disc_material)

    def one(
        check_id: str, pressure: float, force: float, part: str, other: Material, spread: str
    ) -> Check:
        allowed = allowables.weaker(rule(disc), rule(other))
        thickness = reducer.disc_thickness
        return _limited(
            check_id,
            pressure,
            allowed,
            f"{pressure / _MEGA:.1f} MPa (F up to {force:.1f} N a disc, b {thickness * 1e3:g} mm) "
            f"at {loads.torque:g} N*m",
            _lower_peak(
                check_id, state, loads.torque, (allowed.value / max(pressure, 1.0)) ** 2, cures
            )
            + ", or "
            + harder_parts({"disc": disc, part: other}, rule, pressure, spread),
        )

    ring, pin = find_material(reducer.ring_material), find_material(reducer.output_pins.material)
    return (
        one("CONTACT-RING-PEAK", loads.ring_pressure, loads.ring_force, "ring", ring, _RING_SPREAD),
        one("CONTACT-PIN-PEAK", loads.pin_pressure, loads.pin_force, "pins", pin, _PIN_SPREAD),
    )


def _pins(state: GearboxState, loads: PeakLoads, cures: Cures) -> tuple[Check, ...]:
    reducer, pins = state.design.reducer, state.design.reducer.output_pins
    material = find_material(pins.material)
    bending, shear = allowables.pin_limit_peak, allowables.pin_shear_limit_peak
    hole = allowables.weaker(bending(material), bending(find_material(reducer.disc_material)))
    # What bears on the hole is the sleeve where there is one; bent and sheared is the pin.
    runner, force = max(pins.diameter, pins.sleeve_diameter), loads.pin_force

    def one(
        check_id: str,
        stress: float | None,
        rule: MaterialRule,
        allowed: Allowable,
        where: str,
        power: int,
    ) -> Check:
        if stress is None:
            why = "plates that are one body: the pins' moments are not known"
            return build_check(check_id, None, allowed.value / _MEGA, why, why, model=MODEL)
        return _limited(
            check_id,
            stress,
            allowed,
            f"{stress / _MEGA:.1f} MPa (F {force:.1f} N on {where}) at {loads.torque:g} N*m",
            stronger_pins(
                state,
                stress,
                (rule, allowed),
                _lower_peak(check_id, state, loads.torque, allowed.value / max(stress, 1.0), cures),
                power,
                uneven=_UNEVEN,
            ),
        )

    diameter, thickness = f"{pins.diameter * 1e3:g} mm", f"{reducer.disc_thickness * 1e3:g} mm"
    return (
        one(
            "PIN-SHEAR-PEAK",
            float(output_pins.shear_stress(force, pins.diameter)),
            shear,
            shear(material),
            diameter,
            2,
        ),
        one("PIN-BENDING-PEAK", loads.pin_bending, bending, bending(material), diameter, 3),
        one(
            "PIN-BEARING-PEAK",
            float(output_pins.bearing_pressure(force, runner, reducer.disc_thickness)),
            bending,
            hole,
            f"{runner * 1e3:g} mm x {thickness}",
            1,
        ),
    )


def _statics(state: GearboxState, loads: PeakLoads, cures: Cures) -> tuple[Check, ...]:
    """Static safety of the cam bearing and of needles, bending of ring pins under rollers."""
    seats: list[tuple[str, BearingResult, float, str]] = [
        ("BEARING-STATIC", state.cam_bearing, loads.cam_load, "a larger cam bearing"),
    ]
    if state.sleeves is not None:
        seats.append(("SLEEVE-STATIC", state.sleeves, loads.pin_force, "larger output_pins"))
    if state.rollers is not None:
        seats.append(("ROLLER-STATIC", state.rollers, loads.ring_force, "larger ring pins"))
    return (
        *(_static(state, loads.torque, *seat, cures) for seat in seats),
        *_ring_pin(
            state,
            "PEAK",
            loads.ring_force,
            lambda check_id, share: _lower_peak(check_id, state, loads.torque, share, cures),
            allowables.pin_limit_peak(find_material(state.design.reducer.ring_material)),
            MODEL,
        ),
    )


def _static(
    state: GearboxState,
    torque: float,
    check_id: str,
    seat: BearingResult,
    load: float,
    larger: str,
    cures: Cures,
) -> Check:
    rating, name = seat.bearing.static_rating, seat.bearing.designation
    if not rating:
        told = f"the catalogue has no static rating of {name}"
        return build_check(check_id, None, allowables.STATIC_SAFETY, told, told, model=MODEL)
    safety = float(static_safety(rating, load))
    return build_check(
        check_id,
        safety,
        allowables.STATIC_SAFETY,
        f"{name}: {rating:.0f} N/{load:.1f} N = {safety:.3f} at {torque:g} N*m",
        f"needs C0 of {load / 1e3 * allowables.STATIC_SAFETY:.3g} kN: take {larger}; or "
        + _lower_peak(check_id, state, torque, safety / allowables.STATIC_SAFETY, cures),
        model=MODEL,
    )


def _ring_pin(
    state: GearboxState,
    load: str,
    force: float,
    lower: Callable[[str, float], str],
    allowed: Allowable,
    model: str,
) -> tuple[Check, ...]:
    """Bending of ring pins that rollers leave free from housing to clamp; none without rollers."""
    reducer = state.design.reducer
    if reducer.ring.roller_diameter <= 0.0:
        return ()
    stack = reducer.disc_count, reducer.disc_thickness, reducer.disc_spacing
    arm = float(slender_bending_arm(*stack, HELD["both"], 4.0))
    diameter = reducer.ring_pin_diameter
    stress = float(output_pins.bending_stress(force, arm, diameter))
    thicker = diameter * (stress / max(allowed.value, 1.0)) ** (1.0 / 3.0)
    check_id = f"RING-PIN-BENDING-{load}"
    check = _limited(
        check_id,
        stress,
        allowed,
        f"32 x {force:.1f} N x {arm * 1e3:.4f} mm/(pi ({diameter * 1e3:g} mm)^3) = "
        f"{stress / _MEGA:.1f} MPa",
        f"{thicker_ring_pin(reducer, thicker)}, or "
        + lower(check_id, allowed.value / max(stress, 1.0)),
        model=model,
    )
    return (check,)


def _lasting(
    check_id: str,
    state: GearboxState,
    life: LifeResult,
    parts: tuple[PartLife, ...],
    cures: Cures,
) -> Check:
    """The part with the least reserve, against the stress that lasts the required hours."""
    reducer = state.design.reducer
    unknown = [part for part in parts if part.limit <= 0.0]
    if unknown:
        told = f"{unknown[0].part}: {unknown[0].stress / _MEGA:.1f} MPa; {unknown[0].basis}"
        return build_check(
            check_id,
            unknown[0].stress / _MEGA,
            None,
            told,
            "name a material whose fatigue limit the catalogue has",
            basis=unknown[0].basis,
            model=DUTY_MODEL,
        )
    worst = min(parts, key=lambda part: math.inf if part.reserve is None else part.reserve)
    if worst.reserve is None:
        # Nothing moves over the duty, or nothing is loaded: no cycle wears it.
        limit, told = max(worst.limit, worst.stress), "no load cycles over the duty"
    else:
        limit = worst.stress * worst.reserve
        hours = "no end" if worst.hours is None else life_text(worst.hours, 3)
        told = f"{worst.stress / _MEGA:.1f} MPa at the {worst.part}, {worst.place}: lasts {hours}"
    reserve = limit / worst.stress if worst.stress else 0.0
    if check_id != "PIN-BENDING-CONTINUOUS":
        share = limit / worst.limit

        def rule(material: Material) -> Allowable:
            """What a material bears of as many cycles."""
            knee = allowables.contact_limit_fatigue(material)
            return Allowable(share * knee.value, knee.basis)

        disc = find_material(reducer.disc_material)
        at_ring = check_id.startswith("CONTACT-RING")
        other = find_material(reducer.ring_material if at_ring else reducer.output_pins.material)
        pair = {"disc": disc, "ring" if at_ring else "pins": other}
        spread = _RING_SPREAD if at_ring else _PIN_SPREAD
        ways = [
            _lower_duty(check_id, life, reserve**2, cures),
            harder_parts(pair, rule, worst.stress, spread),
        ]
    else:
        ways = ["take thicker output_pins", *better_held(reducer)]
        ways.append(_lower_duty(check_id, life, reserve, cures))
    return build_check(
        check_id,
        worst.stress / _MEGA,
        limit / _MEGA,
        told,
        ", or ".join(ways),
        basis=f"lasts {life.required_hours:g} h over the duty; {worst.basis} at the knee",
        model=DUTY_MODEL,
    )


def _cam_life(state: GearboxState, life: LifeResult, cures: Cures) -> Check:
    cam, required = life.cam, life.required_hours
    rating = state.cam_bearing.bearing.dynamic_rating
    if not rating:
        told = f"the catalogue has no dynamic rating of {cam.designation}"
        return build_check("BEARING-LIFE", None, required, told, told, model=DUTY_MODEL)
    if cam.set_hours is None:
        told = f"{cam.designation} never turns under load over the duty"
        return build_check("BEARING-LIFE", ENDLESS, required, told, "", model=DUTY_MODEL)
    load = max(cam.equivalent_load)
    share = (cam.set_hours / required) ** (1.0 / state.cam_bearing.exponent)
    return build_check(
        "BEARING-LIFE",
        cam.set_hours,
        required,
        f"{len(cam.equivalent_load)} x {cam.designation}, C {rating:.0f} N, equivalent load up to "
        f"{load:.1f} N: {life_text(cam.set_hours)} together",
        f"needs C of {rating / share / 1e3:.3g} kN: take a larger cam bearing; or "
        + _lower_duty("BEARING-LIFE", life, share, cures),
        model=DUTY_MODEL,
    )


def _runner_life(state: GearboxState, life: LifeResult, runner: RunnerLife, cures: Cures) -> Check:
    check_id = "SLEEVE-LIFE" if runner.name == "sleeves" else "ROLLER-LIFE"
    required = life.required_hours
    needles = state.sleeves if check_id == "SLEEVE-LIFE" else state.rollers
    if runner.unknown:
        return build_check(
            check_id,
            None,
            required,
            f"{runner.name} on their pins: {runner.unknown}",
            "see why it is not known" if needles else "take needles, whose life is known",
            model=DUTY_MODEL,
        )
    hours = ENDLESS if runner.set_hours is None else runner.set_hours
    share = (hours / required) ** 0.3
    return build_check(
        check_id,
        hours,
        required,
        f"{runner.designation}: equivalent load {runner.equivalent_load:.1f} N, "
        f"{life_text(hours)} together",
        "use larger ones, or more; or " + _lower_duty(check_id, life, share, cures),
        model=DUTY_MODEL,
    )


def _ring_pin_lasting(state: GearboxState, life: LifeResult, cures: Cures) -> tuple[Check, ...]:
    """Bending of ring pins under rollers at the greatest force over the duty."""
    material = find_material(state.design.reducer.ring_material)
    return _ring_pin(
        state,
        "CONTINUOUS",
        max(one.ring_force for one in life.loads),
        lambda check_id, share: _lower_duty(check_id, life, share, cures),
        # A pin of the ring is pushed outward, and by the one disc that passes.
        allowables.pin_bending_limit_continuous(material, duty_reverses=False),
        DUTY_MODEL,
    )
