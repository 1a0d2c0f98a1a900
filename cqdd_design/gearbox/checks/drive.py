"""Checks of balance, disc count and motor."""

from __future__ import annotations

import math
from typing import Literal

from cqdd_design.catalog.motors import Motor
from cqdd_design.gearbox.balance import BALANCING_PLANES, paper_disc_count
from cqdd_design.gearbox.checks import allowables
from cqdd_design.gearbox.checks.remedies import PEAK_KEY, Lower, lower_lasting, lower_peak
from cqdd_design.gearbox.checks.state import GearboxState, build_check
from cqdd_design.geometry.limits import rounded_down, rounded_up
from cqdd_design.geometry.scale import largest_ring
from cqdd_design.results import Check

_RPM = 30.0 / math.pi


def drive_checks(state: GearboxState) -> tuple[tuple[Check, ...], tuple[str, ...]]:
    """All checks of this chapter, and sentences about those that could not be made."""
    motor_checks, warnings = _motor(state)
    return (*_balance(state), _disc_count(state), *motor_checks), warnings


def _balance(state: GearboxState) -> tuple[Check, ...]:
    reducer, balance = state.design.reducer, state.balance
    speed = state.design.requirements.input_speed
    mass, static, couple = balance.throw_mass, balance.static_unbalance, balance.shaking_moment
    total = reducer.disc_count * mass
    permitted = total * allowables.BALANCE_GRADE / speed
    reaction = couple / (reducer.disc_count * reducer.disc_thickness)
    most = allowables.SHAKING_SHARE * state.cam_bearing.continuous_load
    moment = mass * reducer.eccentricity
    asked, missing = reducer.balance.counterweights, balance.weights_missing.rstrip(".")
    # Weights that a design asks for are part of it: what they leave is no rule of thumb.
    severity: Literal["fail"] | None = "fail" if asked else None
    weights = " with the balance weights as drawn" if asked and not missing else ""
    weights += "; no balance weights" if missing else ""
    reason = f": {missing}" if missing else ""
    gentler = (
        "lower disc_thickness or the input speed to "
        f"{rounded_down(speed * _RPM * math.sqrt(most / max(reaction, 1e-12))):g} rpm"
    )
    return (
        *([_no_weights(missing)] if missing else []),
        build_check(
            "BALANCE-STATIC",
            static * 1e6,
            permitted * 1e6,
            f"{reducer.disc_count} x {mass * 1e3:.1f} g at {reducer.eccentricity * 1e3:g} mm leave "
            f"{static * 1e6:.4g} g*mm{weights}{reason}; {total * 1e3:.1f} g x "
            f"{allowables.BALANCE_GRADE * 1e3:g} mm/s/{speed:.1f} rad/s",
            "use two discs"
            if asked
            else "use two discs, or set balance.counterweights = true, which needs a counterweight "
            f"of {moment * 1e6:.3g} g*mm",
            severity=severity,
        ),
        build_check(
            "BALANCE-COUPLE",
            reaction,
            most,
            f"{couple:.4g} N*m/({reducer.disc_count} x {reducer.disc_thickness * 1e3:g} mm) = "
            f"{reaction:.4g} N{weights}",
            gentler if asked else f"set balance.counterweights = true, or {gentler}",
            severity=severity,
        ),
    )


def _no_weights(reason: str) -> Check:
    """The line that stands where balance weights are asked for and cannot be drawn."""
    return build_check(
        "BALANCE-WEIGHTS",
        0.0,
        float(BALANCING_PLANES),
        f"none of {BALANCING_PLANES}: {reason}",
        reason,
    )


def _disc_count(state: GearboxState) -> Check:
    ratio, count = state.design.reducer.ratio, state.design.reducer.disc_count
    wanted = paper_disc_count(ratio)
    parity = "even" if ratio % 2 == 0 else "odd"
    return build_check(
        "DISC-COUNT",
        float(count),
        float(allowables.LEAST_BALANCED_DISCS),
        f"the design has {count}; ratio {ratio} is {parity}, so the paper's rule asks for {wanted}",
        f"disc_count = {allowables.LEAST_BALANCED_DISCS} balances statically"
        + (
            " and follows the paper's rule"
            if wanted == allowables.LEAST_BALANCED_DISCS
            else f"; disc_count = {wanted} follows the paper's rule"
        ),
    )


def _motor(state: GearboxState) -> tuple[tuple[Check, ...], tuple[str, ...]]:
    motor, name = state.motor, state.motor.name
    known = [
        (_peak, motor.peak_torque, "peak torque"),
        (_continuous, motor.rated_torque, "rated torque"),
        (_speed, motor.speed_constant, "speed constant"),
    ]
    if not motor.is_inrunner:  # which stands behind the gearbox
        known.append((_bore, motor.bore_diameter, "stator bore"))
    checks = [make(state, motor, value) for make, value, _ in known if value is not None]
    lacking = [what for _, value, what in known if value is None]
    if lacking:
        words = f"the catalogue has no {', no '.join(lacking)} of '{name}'"
        checks.append(_known_data(len(checks), len(known), words))
    return tuple(checks), tuple(
        f"motor '{name}' has no {what} in the catalogue; not checked." for what in lacking
    )


def _known_data(known: int, wanted: int, words: str) -> Check:
    """The line that stands where checks of the motor could not be made."""
    return build_check(
        "MOTOR-DATA",
        float(known),
        float(wanted),
        words,
        "name a motor whose row gives them, such as 'CubeMars RO100 KV55'",
        severity="warn",
    )


def _make(
    state: GearboxState, check_id: str, value: float, limit: float, numbers: str, remedy: str
) -> Check:
    """A check of the motor: a shortfall is a failure where the design names its motor."""
    severity: Literal["warn"] | None = "warn" if "motor.name" in state.design.assumed else None
    return build_check(check_id, value, limit, numbers, remedy, severity=severity)


def _torque_check(
    state: GearboxState, check_id: str, torque: float, available: float, lower: Lower
) -> Check:
    n, eta = state.design.reducer.ratio, allowables.REDUCER_EFFICIENCY
    needed, reached = torque / (n * eta), available * n * eta
    return _make(
        state,
        check_id,
        reached,
        torque,
        f"{available:g} N*m x {n} x {eta:g} = {reached:.4g} N*m",
        f"{lower(reached)}, or take a motor with {rounded_up(needed):g} N*m; both with the "
        f"assumed efficiency of {eta:g}, above what the losses leave",
    )


def _peak(state: GearboxState, motor: Motor, available: float) -> Check:
    asked = state.design.requirements

    def lower(torque: float) -> str:
        return lower_peak(torque, asked.continuous_torque, PEAK_KEY)

    return _torque_check(state, "MOTOR-PEAK", asked.peak_torque, available, lower)


def _continuous(state: GearboxState, motor: Motor, available: float) -> Check:
    asked = state.design.requirements
    torque = asked.continuous_torque
    return _torque_check(
        state, "MOTOR-CONTINUOUS", torque, available, lambda most: lower_lasting(most, asked)
    )


def _speed(state: GearboxState, motor: Motor, constant: float) -> Check:
    voltage, wanted = state.design.motor.voltage, state.design.requirements.input_speed
    reached = constant * voltage
    return _make(
        state,
        "MOTOR-SPEED",
        reached * _RPM,
        wanted * _RPM,
        f"{constant * _RPM:g} rpm/V x {voltage:g} V = {reached * _RPM:.0f} rpm",
        f"raise motor.voltage to {rounded_up(wanted / constant):g} V",
    )


def _bore(state: GearboxState, motor: Motor, bore: float) -> Check:
    outer, most = state.design.reducer.ring.outer_diameter, largest_ring(bore)
    note = f" ({motor.bore_note})" if motor.bore_note else ""
    walled = most >= 2.0 * (state.geometry.ring_root_radius + allowables.RING_WALL)
    smaller = f"lower ring.outer_diameter to {most * 1e3:.4g} mm, or " if walled else ""
    return _make(
        state,
        "MOTOR-BORE",
        outer * 1e3,
        most * 1e3,
        f"ring {outer * 1e3:.4g} mm, stator bore {bore * 1e3:.4g} mm{note}",
        f"{smaller}take a motor with a larger bore; else it stands behind the gearbox",
    )
