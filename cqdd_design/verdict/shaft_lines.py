"""Lines of the shaft, of the bearings at its ends, and of that between carrier and housing."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from cqdd_design.catalog.bearings import Bearing
from cqdd_design.design.requirements import EXTERNAL_LOADS
from cqdd_design.errors import CatalogError, ContactError, DesignError, GeometryError
from cqdd_design.gearbox.bearing_life import basic_rating_life_hours, life_exponent
from cqdd_design.gearbox.cam_bearing import rolling_element
from cqdd_design.gearbox.checks.allowables import STATIC_SAFETY, shaft_limit_peak
from cqdd_design.gearbox.checks.equilibrium import DUTY_MODEL, ENDLESS, lower_duty
from cqdd_design.gearbox.checks.remedies import lower_outside, lower_peak
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.gearbox.life.cam import equivalent_load, set_life
from cqdd_design.gearbox.output_bearing import (
    OutputLoad,
    axial_share,
    dynamic_load,
    static_load,
    static_safety,
)
from cqdd_design.gearbox.pack_loads import PackLoads
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.machine import Machine
from cqdd_design.machine.carrier_bearing import bearing_for_loads
from cqdd_design.machine.cures import ROUGHLY, SEARCHED_CASES, borne_out, torques_that_hold
from cqdd_design.machine.end_bearing import on_stronger_ends
from cqdd_design.machine.output_loads import output_loads
from cqdd_design.machine.rotor_overhang import rotor_overhang
from cqdd_design.machine.shaft_strength import (
    shaft_strength,
    support_loads,
    with_still_force,
)
from cqdd_design.results import Check
from cqdd_design.terms import life_text
from cqdd_design.verdict.bore_line import bore_line
from cqdd_design.verdict.joint_lines import bell_strength

_MEGA = 1e6
_WIDER = "leave room for larger support bearings (a cam bearing with a larger bore)"
_LIGHTER = "lower the torque or the external loads"
_RATED = (
    "name a carrier_bearing.designation whose ratings are known, or, where none of the catalogue "
    "goes round this carrier, change output_pins.circle_radius so that one does"
)
_HALVINGS = 20
"""Of the share of external loads that a bearing bears."""


def shaft_lines(machine: Machine) -> tuple[Check, ...]:
    """Strength and fatigue of the shaft; static safety and life of its bearings and the output's.

    Of perfect parts in contact equilibrium, driving with friction: at the peak torque in both
    senses, and over the duty.
    """
    names = (*AT_PEAK, *_OVER_DUTY)
    try:
        peak, duty = machine.peak_pack, machine.life.pack
        rotor = _rotor(machine)
        ends = _other_ends(machine, peak, duty, rotor)
        return (
            *_cured(machine, peak, duty, rotor, ends),
            _support_life_cured(machine, duty, rotor, ends),
            *_output(machine, peak, duty, rotor),
        )
    except (CatalogError, ContactError, GeometryError) as error:
        return tuple(
            build_check(one, None, None, error.message, "see why it is not known") for one in names
        )


AT_PEAK = ("SHAFT-STRENGTH", "SUPPORT-STATIC", "OUTPUT-STATIC")
_OVER_DUTY = ("SHAFT-FATIGUE", "SUPPORT-LIFE", "OUTPUT-LIFE")


def _other_ends(machine: Machine, peak: PackLoads, duty: PackLoads, rotor: _Rotor) -> str:
    """What to do where the bearings at the shaft's ends bear too little."""

    def passes(one: Machine, held: _Rotor) -> bool:
        lines = _support_static(one, peak, held), _support_life(one, duty, held)
        return all(line.status == "pass" for line in lines)

    # Of a look in a search nobody reads remedies.
    if machine.stiff or passes(machine, rotor):
        return _WIDER
    weak = {line.id for line in _strength(machine, peak, duty) if line.status != "pass"}
    for other in on_stronger_ends(machine):
        with suppress(CatalogError, GeometryError):
            thinner = {line.id for line in _strength(other, peak, duty) if line.status != "pass"}
            if thinner <= weak and passes(other, _rotor(other)) and not _looser(other, machine):
                named = other.seats[0].bearing.designation
                return f"set support_bearing.designation to '{named}', or {_WIDER}"
    return _WIDER


def _looser(other: Machine, machine: Machine) -> bool:
    """Whether a shaft with other ends loses the rotor's bond, or the way through, that it had."""
    for line_of in (bell_strength, bore_line):
        before, after = line_of(machine), line_of(other)
        had = before is not None and before.status == "pass"
        if had and (after is None or after.status != "pass"):
            return True
    return False


def _cured(
    machine: Machine, peak: PackLoads, duty: PackLoads, rotor: _Rotor, ends: str
) -> tuple[Check, Check, Check]:
    """Strength, fatigue and static safety, with torques at which those that fail would hold."""
    strength, fatigue = _strength(machine, peak, duty)
    static = _support_static(machine, peak, rotor, ends)
    if machine.stiff:
        # Of a look in a search nobody reads remedies.
        return strength, fatigue, static

    def at_peak(torque: float) -> tuple[Check, Check]:
        found = machine.under(peak=torque).peak_pack
        return _strength(machine, found, duty)[0], _support_static(machine, found, rotor)

    def over_duty(share: float) -> tuple[Check]:
        return (_strength(machine, peak, machine.under(duty_share=share).life.pack)[1],)

    asked, cases = machine.design.requirements, len(machine.life.duty)

    def passes(torque: float) -> bool:
        other = machine.under(peak=torque)
        return _support_static(other, other.peak_pack, _rotor(other)).status == "pass"

    cures = torques_that_hold(at_peak, asked.peak_torque, (strength, static), near=ROUGHLY)
    if static.id in cures:
        cures[static.id] = borne_out(cures[static.id], passes)
    lower = {name: lower_peak(torque, asked.continuous_torque) for name, torque in cures.items()}
    if fatigue.status == "fail":
        shares = {}
        if cases <= SEARCHED_CASES:
            shares = torques_that_hold(over_duty, 1.0, (fatigue,), near=ROUGHLY)
        lower[fatigue.id] = lower_duty(machine.life, shares.get(fatigue.id))
    with_torque = [
        replace(one, remedy=f"{one.remedy}; or {lower[one.id]}") if one.id in lower else one
        for one in (strength, fatigue, static)
    ]
    return with_torque[0], with_torque[1], with_torque[2]


def _strength(machine: Machine, peak: PackLoads, duty: PackLoads) -> tuple[Check, Check]:
    asked, found = machine.design.requirements, shaft_strength(machine, peak, duty)
    allowed = shaft_limit_peak(found.material)
    static, lasting = found.static, found.lasting
    thicker = "a cam bearing with a larger bore leaves room for a thicker shaft"
    return (
        build_check(
            "SHAFT-STRENGTH",
            static.static / _MEGA,
            allowed.value / _MEGA if allowed.value else None,
            f"{static.static / _MEGA:.1f} MPa at the {static.step.place}, of "
            f"{2e3 * static.step.radius:.3g} mm, at {asked.peak_torque:g} N*m",
            thicker,
            basis=allowed.basis,
        ),
        build_check(
            "SHAFT-FATIGUE",
            lasting.reversed_amplitude / _MEGA,
            found.limit / _MEGA if found.limit else None,
            f"{lasting.reversed_amplitude / _MEGA:.1f} MPa reversed at the {lasting.step.place}, "
            f"of {2e3 * lasting.step.radius:.3g} mm, notch factors {lasting.bending_factor:.2f} "
            f"in bending and {lasting.torsion_factor:.2f} in torsion",
            thicker,
            basis=found.basis,
            model=DUTY_MODEL,
        ),
    )


class _Rotor(NamedTuple):
    """What hangs on the stub puts on the shaft's bearings."""

    on_bearings: FloatArray
    """On the lower and the upper one, (2,), N; zero where it is not known."""
    missing: str = ""
    """Why it is not."""

    def told(self, place: int) -> str:
        return self.missing or f"{self.on_bearings[place]:.0f} N of it from the rotor"


def _rotor(machine: Machine) -> _Rotor:
    try:
        on_bearings = rotor_overhang(machine).on_bearings
    except (CatalogError, DesignError):
        return _Rotor(np.zeros(2), "without the rotor, of which SHAFT-ROTOR-GAP knows nothing")
    if math.isinf(max(on_bearings)):
        return _Rotor(np.zeros(2), "without the rotor, whose pull is not held (SHAFT-ROTOR-GAP)")
    return _Rotor(np.array(on_bearings))


def shaft_at_peak(machine: Machine, duty: PackLoads) -> tuple[Check, Check, Check]:
    """Lines of `AT_PEAK`.

    Raises
    ------
    CatalogError, ContactError, GeometryError
        Where they are not known.
    """
    peak, rotor = machine.peak_pack, _rotor(machine)
    return (
        _strength(machine, peak, duty)[0],
        _support_static(machine, peak, rotor),
        _output_static(machine, output_loads(machine, peak), _LIGHTER, rotor),
    )


def _support_static(
    machine: Machine, peak: PackLoads, rotor: _Rotor, remedy: str = _WIDER
) -> Check:
    asked, chosen = machine.design.requirements, machine.seats[0]
    discs, seat = support_loads(machine, peak).max(axis=(0, 1)), chosen.bearing
    both = discs + rotor.on_bearings
    most = float(both.max())
    if chosen.source == "bush" or seat.static_rating is None:
        told = f"{most:.0f} N on {seat.designation}: its rating is not known"
        return build_check(
            "SUPPORT-STATIC", None, STATIC_SAFETY, told,
            "leave room for a bearing (a wider cam bearing)",
        )  # fmt: skip
    safety = seat.static_rating / most
    return build_check(
        "SUPPORT-STATIC",
        safety,
        STATIC_SAFETY,
        f"{seat.designation}: {seat.static_rating:.0f} N/{most:.1f} N = {safety:.3f} at "
        f"{asked.peak_torque:g} N*m, {rotor.told(int(both.argmax()))}",
        remedy,
    )


def _support_life(machine: Machine, duty: PackLoads, rotor: _Rotor, remedy: str = _WIDER) -> Check:
    chosen, ratio = machine.seats[0], machine.design.reducer.ratio
    # The lower one stands in the housing, the upper one turns back with the carrier.
    slip = np.array([ratio, ratio + 1.0])
    # The discs' forces turn with the crank, that on the rotor stands still.
    loads = with_still_force(support_loads(machine, duty), rotor.on_bearings)
    known = chosen.source != "bush"
    return _life("SUPPORT-LIFE", machine, chosen.bearing if known else None, loads, slip, remedy)


def _support_life_cured(machine: Machine, duty: PackLoads, rotor: _Rotor, remedy: str) -> Check:
    """With the torques of the duty at which both last, where there are any."""
    line = _support_life(machine, duty, rotor, remedy)
    if line.status != "fail" or machine.stiff or len(machine.life.duty) > SEARCHED_CASES:
        return line

    def over_duty(share: float) -> tuple[Check]:
        return (_support_life(machine, machine.under(duty_share=share).life.pack, rotor),)

    share = torques_that_hold(over_duty, 1.0, (line,), near=ROUGHLY)[line.id]
    if not share:
        return line
    return replace(line, remedy=f"{line.remedy}; or {lower_duty(machine.life, share)}")


def _output(
    machine: Machine, peak: PackLoads, duty: PackLoads, rotor: _Rotor
) -> tuple[Check, Check]:
    """Static safety and life, and another bearing where this one has too little of either."""

    def both(remedy: str, external: float = 1.0, on: Machine = machine) -> tuple[Check, Check]:
        return (
            _output_static(on, output_loads(on, peak, external), remedy, rotor),
            _output_life(on, output_loads(on, duty, external), remedy),
        )

    def passes(external: float, on: Machine = machine) -> bool:
        return all(line.status == "pass" for line in both("", external, on))

    if passes(1.0):
        return both(_LIGHTER)
    ways = []
    other = bearing_for_loads(machine)
    if other is not None and other.bears and other.bearing != machine.seats[1].bearing:
        ways.append(f"set carrier_bearing.designation to '{other.bearing.designation}'")
    ways += [less] if (less := _less_from_outside(machine, passes)) else []
    rated = machine.seats[1].bearing.static_rating is not None
    lines = both(", or ".join(ways) or (_LIGHTER if rated else _RATED))
    lower = {} if machine.stiff else _less_torque(machine, lines)
    told = [
        replace(one, remedy=", or ".join((*ways, lower[one.id]))) if one.id in lower else one
        for one in lines
    ]
    return told[0], told[1]


def _less_torque(machine: Machine, lines: tuple[Check, Check]) -> dict[str, str]:
    """Torques at which those that fail would hold, in words by line, as far as there are any."""
    static, life = lines
    lower, asked = {}, machine.design.requirements
    if static.status == "fail":
        held = torques_that_hold(
            lambda torque: shaft_at_peak(machine.under(peak=torque), machine.life.pack)[2:],
            asked.peak_torque,
            (static,),
            near=ROUGHLY,
        )
        if torque := held[static.id]:
            lower[static.id] = lower_peak(torque, asked.continuous_torque)
    if life.status == "fail" and len(machine.life.duty) <= SEARCHED_CASES:

        def over_duty(share: float) -> tuple[Check]:
            pack = machine.under(duty_share=share).life.pack
            return (_output_life(machine, output_loads(machine, pack), ""),)

        shares = torques_that_hold(over_duty, 1.0, (life,), near=ROUGHLY)
        if share := shares[life.id]:
            lower[life.id] = lower_duty(machine.life, share)
    return lower


def _less_from_outside(machine: Machine, passes: Callable[..., bool]) -> str:
    """External loads that the bearing bears, in words; nothing where it bears none, or has none."""
    asked = machine.design.requirements
    stated = any(getattr(asked, key) for key in EXTERNAL_LOADS)
    if not stated or not passes(0.0):
        return ""
    low, high = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if passes(middle) else (low, middle)
    if not machine.stiff:
        low = borne_out(low, lambda share: passes(1.0, machine.under_outside(share)))
    if not low:
        return ""
    return lower_outside(asked, low)


def _output_static(machine: Machine, load: OutputLoad, remedy: str, rotor: _Rotor) -> Check:
    asked, row = machine.design.requirements, machine.seats[1].bearing
    words = (
        f"{load.radial.max():.0f} N across, {rotor.told(1)}, "
        f"{load.axial.max():.0f} N along, {load.moment.max():.3g} N*m tilting"
    )
    if row.static_rating is None:
        told = f"{row.designation} under {words}: its rating is not known"
        return build_check("OUTPUT-STATIC", None, STATIC_SAFETY, told, remedy)
    safety, most = static_safety(row, load), float(static_load(row, load).max())
    rating, told = row.static_rating, "N"
    if safety < rating / most * (1.0 - 1e-9):
        rating *= axial_share(row)
        told, most = f"N, {axial_share(row):.0%} of its rating, along the axis", rating / safety
    return build_check(
        "OUTPUT-STATIC",
        safety,
        STATIC_SAFETY,
        f"{row.designation}: {rating:.0f} {told}/{most:.1f} N = {safety:.3f}, from {words} at "
        f"{asked.peak_torque:g} N*m",
        remedy,
    )


def _output_life(machine: Machine, load: OutputLoad, remedy: str) -> Check:
    row = machine.seats[1].bearing
    known = row if row.static_rating is not None else None
    loads = dynamic_load(row, load)[..., None]
    return _life("OUTPUT-LIFE", machine, known, loads, np.ones(1), remedy)


def _life(
    name: str,
    machine: Machine,
    row: Bearing | None,
    loads: FloatArray,
    slip: FloatArray,
    remedy: str,
) -> Check:
    """L10 of B bearings together under loads (C, A, B) at `slip` (B,) times the output's speed."""
    cases, required = machine.life.duty, machine.life.required_hours
    if row is None or row.dynamic_rating is None:
        told = "the rating of the bearing is not known"
        return build_check(name, None, required, told, remedy, model=DUTY_MODEL)
    element = rolling_element(row)
    exponent = life_exponent(element)
    shares = np.array([case.share for case in cases])
    speeds = np.array([case.speed for case in cases])
    equal = equivalent_load(loads, shares, speeds, exponent)
    speed = float(shares @ speeds)
    each = [
        float(basic_rating_life_hours(row.dynamic_rating, load, speed * turn, exponent))
        for load, turn in zip(equal, slip, strict=True)
        if load > 0.0 and speed > 0.0
    ]
    hours = min(set_life(each, element), ENDLESS) if each else ENDLESS
    told = f"{row.designation}: C {row.dynamic_rating:.0f} N under {max(equal):.1f} N"
    return build_check(
        name, hours, required, f"{told}: {life_text(hours)} together", remedy, model=DUTY_MODEL
    )
