"""Looks at a design before its whole verdict: at the motor, at heat, at a few toleranced gearboxes.

They say what to ask of the next search: other torques where none were stated, more clearance, or
more reserve.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.design import Requirements
from cqdd_design.errors import ContactError, DesignError
from cqdd_design.gearbox.checks.heat import cooling_remedy
from cqdd_design.gearbox.tolerance.run import BLOCK
from cqdd_design.machine import Machine
from cqdd_design.machine.temperatures import (
    MachineTemperatures,
    judged_temperatures,
    known_temperatures,
    rise_line,
    undisturbed_temperatures,
)
from cqdd_design.results import Check
from cqdd_design.sizing.able import CONTINUOUS, PEAK, cooler, what_it_can
from cqdd_design.sizing.bearable import LASTING, weaker
from cqdd_design.sizing.exact import yielding_checks
from cqdd_design.sizing.finish import torque_reserve
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.shafts import stronger_shaft
from cqdd_design.sizing.spaces import FITS, Found, spaces
from cqdd_design.sizing.trial_gearboxes import TRIAL_SAMPLES, calibrate, drawn_alike
from cqdd_design.solids.motor_rules import undrawn_sizes
from cqdd_design.verdict.drawn import (
    SOFT,
    TIGHT,
    Allowed,
    Drawn,
    drawn_gearboxes,
    good_gearboxes,
    used,
)
from cqdd_design.verdict.joint_lines import bell_line
from cqdd_design.verdict.motor import held_up_to, motor_lines

HOT = "THERMAL-RISE"
BY_HEAT = frozenset({"MOTOR-CONTINUOUS", HOT})
"""Lines that less of the continuous torque, or of its speed, helps by itself."""
_LEAST_STEP = 1e-6
"""Clearance that has to grow at all, m: to the next fit."""
_LESS = 0.9
"""Share of both torques that is tried next where a gearbox has no equilibrium."""
_SPARE = 1.02
"""Reserve over what 95 % of the gearboxes need, so that the next design's are not just short."""
_BESIDE = 0.98
"""Of the reserve that a sound gearbox keeps, what one on the next place of the grid has to show: by
clearance that was given since, the very gearbox may have to move there."""
_WIDEST = 0.995
"""Share of the largest ring beyond which no wider one is asked for."""
_LOOKS = 12
"""At one design before the search is repeated."""


_FAR_SHORT = {"MOTOR-PEAK": (PEAK, 0.7), "MOTOR-CONTINUOUS": (CONTINUOUS, 0.5)}
"""Torques, and margins of a motor's lines that no other gearbox brings to 1: one with pins on
needles loses some 10 % of a peak torque instead of some 30, and warms the winding less."""
_TOO_HOT = 0.9
"""Margin of the heat of a duty, which nothing but a gearbox that loses less brings to 1."""


class NothingWiderError(Exception):
    """More clearance is asked for than is tried."""


def learn(hunt: Hunt, found: Found) -> bool:
    """Look at a design until it asks for nothing more; whether the search has to be repeated.

    Torques and clearances that are asked for are given to the very design, and looked at again:
    what they have to be hardly hangs on the sizes that a repeated search would change. The reserve
    that part errors ask for does.

    Raises
    ------
    NothingWiderError
    """
    machine, can, step = found.sized.machine, None, None
    hunt.borne = None
    for turn in range(_LOOKS):
        rigid = machine.rigid
        calm = machine.design, hunt.may_rise(found.cam)
        nothing = calm == hunt.calm
        can, step = (None, None) if nothing else look(hunt, rigid, heat_first=step is not None)
        if can is None and step is None:
            hunt.calm = calm
            if loosened(hunt, found, rigid):
                return True
            step = closer_look(hunt, found, machine)
            if not step:
                return turn > 0 or step is not None
        take(hunt, can, step, found.cam)
        machine = machine.changed(_asked(hunt))
    return True


def motor_far_short(hunt: Hunt, machine: Machine, least: float = 0.0) -> tuple[Check, ...]:
    """Lines of stated torques of which the motor is too far short for another gearbox to help.

    Under a duty its heat stands for the continuous torque.

    Parameters
    ----------
    least : float
        Margin that they have to have at least, of a gearbox that loses as little as any.
    """
    free, duty = hunt.requirements.derived, bool(hunt.requirements.load_cases)
    if free >= {PEAK, CONTINUOUS} and not duty:
        return ()
    rigid = machine.rigid
    hot = hot_undisturbed(rigid) if duty else ()
    far = [line for line in hot if line.margin < (least or _TOO_HOT)]
    # How a motor is cooled that is not drawn nobody knows, unless it is stated.
    cooled = machine.design.drive.thermal_resistance or not undrawn_sizes(machine.motor)
    try:
        actuator = actuator_parameters(rigid)
        lines = motor_lines(rigid, actuator, "", uncooled="" if cooled else "not drawn")
    except DesignError:
        return tuple(far)
    for line in lines:
        torque, near = _FAR_SHORT.get(line.id, (PEAK, 0.0))
        if line.known and line.margin < max(near, least) and torque not in free:
            far.append(line)
    if not duty and any(line.id == "MOTOR-CONTINUOUS" for line in far):
        hunt.held_up_to = held_up_to(actuator, rigid.design.requirements)
    return tuple(far)


def hot_undisturbed(machine: Machine) -> tuple[Check, ...]:
    """How warm parts get that do not press on each other: clearance is another matter.

    Nothing where that is not known.
    """
    found = undisturbed_temperatures(machine)
    if found is None:
        return ()
    line = rise_line(found)
    remedy = cooling_remedy(duty=bool(machine.design.requirements.load_cases))
    return (replace(line, remedy=remedy),) if line.known else ()


def take(hunt: Hunt, can: Requirements | None, step: float | None, cam: str = "") -> None:
    """What `look` and `read_spread` say, as what the hunt is for from now on.

    Raises
    ------
    NothingWiderError
    """
    if can is not None:
        less = can.continuous_torque < hunt.requirements.continuous_torque
        hunt.risen += hunt.lowered and not less
        if less:
            hunt.lowered, hunt.lowered_by = True, cam
        hunt.requirements = can
    elif step:
        least = hunt.fit.hole_clearance + step
        fits = (one for one in FITS if one.hole_clearance >= least)
        fit = next(fits, None)
        if fit is None:
            raise NothingWiderError
        hunt.fit = fit


def _asked(hunt: Hunt) -> dict[str, float]:
    """Keys of a design that the hunt has learnt."""
    asked, fit = hunt.requirements, hunt.fit
    return {
        "requirements.peak_torque": asked.peak_torque,
        "requirements.continuous_torque": asked.continuous_torque,
        "reducer.modification.equidistant": fit.equidistant,
        "reducer.output_pins.hole_clearance": fit.hole_clearance,
    }


def look(
    hunt: Hunt, machine: Machine, *, heat_first: bool = False
) -> tuple[Requirements | None, float | None]:
    """What the motor can do, where that was asked, and clearance that heat needs more, m.

    With rigid discs and ring first: their finite elements cost more than all else here, and change
    either by a per cent.

    Parameters
    ----------
    heat_first : bool
        Whether more clearance is what is most likely asked for.
    """
    ways = [_motor, _heat]
    for way in reversed(ways) if heat_first else ways:
        found = way(hunt, machine)
        if found != (None, None):
            return found
    return None, None


def _motor(hunt: Hunt, machine: Machine) -> tuple[Requirements | None, None]:
    """Other torques, where none were stated."""
    if not hunt.requirements.derived:
        return None, None
    try:
        may_rise = hunt.may_rise(machine.design.reducer.cam_bearing.designation)
        return what_it_can(machine, hunt.requirements, may_rise=may_rise), None
    except ContactError:
        # Beyond this gearbox at some angle or torque that the search did not look at.
        return weaker(hunt.requirements, _LESS, _LESS), None


def _heat(hunt: Hunt, machine: Machine) -> tuple[Requirements | None, float | None]:
    """More clearance, or less torque where warm parts are free and still too hot."""
    found, checks, _ = judged_temperatures(machine)
    step = clearance_needed(found, checks)
    if step > 0.0:
        return None, step
    # Parts that press on each other are hot for that; without that, less torque is cooler.
    hot = any(line.id == HOT and line.known and not line.satisfied for line in checks)
    return (cooler(hunt.requirements) if hot else None), None


def loosened(hunt: Hunt, found: Found, machine: Machine) -> bool:
    """Whether the bond between shaft and bell gives way, and a stronger shaft is searched for."""
    warm, lines, _ = judged_temperatures(machine)
    line = bell_line(machine, warm)
    # No shaft helps a bond that is hotter than a motor may be.
    too_hot = any(one.id == HOT and one.known and not one.satisfied for one in lines)
    if line.status != "fail" or too_hot:
        return False
    hunt.loose.add(found.cam)
    stronger_shaft(hunt, found, (line,))
    return True


def closer_look(hunt: Hunt, found: Found, machine: Machine) -> float | None:
    """What a few gearboxes ask for: see `read_spread`.

    Limits are the same whether discs and ring yield or not; the quicker way leads to them.
    """
    hunt.say("looking at toleranced gearboxes of a design")
    try:
        drawn = drawn_alike(hunt, machine)
    except ContactError:
        return _LEAST_STEP
    rigid = machine.rigid
    return read_spread(hunt, rigid, drawn, hunt.held_against(rigid)[1])


def last_look(hunt: Hunt, machine: Machine) -> float | None:
    """What the first of the verdict's own gearboxes ask for, discs and ring yielding.

    As `closer_look`, which only guesses how they yield; a few first, as these tell most of what is
    missing. The verdict goes on from the others.
    """
    warm = partial(known_temperatures, machine)
    for samples in (TRIAL_SAMPLES, BLOCK):
        try:
            drawn = drawn_gearboxes(machine, samples, sensitivity=False, warm=warm)
            lines = yielding_checks(machine)
        except ContactError:
            return _LEAST_STEP
        calibrate(hunt, machine, drawn)
        step = read_spread(hunt, machine, drawn, lines)
        if step is not None:
            return step
    return None


def clearance_needed(found: MachineTemperatures | None, checks: Iterable[Check]) -> float:
    """Clearance that holes need more, or the least step, where warm parts overlap, m; else 0."""
    for one in checks:
        if one.id == "THERMAL-CLEARANCE" and not one.satisfied:
            return max(2.0 * (found.lacking_clearance if found else 0.0), _LEAST_STEP)
    return 0.0


def read_spread(
    hunt: Hunt, machine: Machine, drawn: Drawn, lines: tuple[Check, ...]
) -> float | None:
    """More clearance of the holes that part errors ask for, m; None where they ask for nothing.

    0 where they ask for reserve or a wider ring instead, which is noted.
    """
    good, hunt.borne = good_gearboxes(machine, drawn, lines), None
    if good is None:
        return None
    numbers, fails = good
    allowed = Allowed.of(machine, lines)
    assert allowed is not None
    count = len(drawn.continuous.values) + drawn.continuous.lost
    share = machine.design.requirements.yield_share
    if len(numbers) >= share * count:
        if machine.design.reducer.cam_bearing.designation not in hunt.extra_of:
            # What they need is known now, where only what is usual was.
            enough = _over(used(allowed, drawn), share)
            _ask_extra(hunt, machine, {check: _BESIDE * one for check, one in enough.items()})
        return None
    # No clearance makes a gearbox tighter or stiffer, but a stronger one is stiffer.
    most = (1.0 - share) * count
    slack = fails.get("backlash", 0) > most
    soft = max(fails.get("stiffness", 0), fails.get(SOFT, 0)) > most
    loose = slack or soft
    jams = max(one.lost for one in drawn.every)
    binds = max(fails["bind"], fails.get(TIGHT, 0))
    # Half of what may fail, all of it where backlash matters: clearance would cost that.
    tight = machine.design.requirements.backlash is not None or hunt.goal == "backlash"
    may = (1.0 if tight else 0.5) * (1.0 - share) * count
    if not (slack or (soft and not hunt.may_be_sturdier)) and binds + jams > may:
        return _LEAST_STEP
    # What may fail is shared among the lines that do.
    quantile = 1.0 - (1.0 - share) / max(sum(1 for number in fails.values() if number), 1)
    ratios = used(allowed, drawn)
    over = _over(ratios, quantile)
    overloaded = sum(int(np.sum(ratio > 1.0)) for ratio in ratios.values())
    if overloaded and overloaded >= binds + jams and max(over.values()) <= 1.0:
        # Of few gearboxes the one that is overloaded is hardly in the quantile.
        over = {check: float(ratio.max()) for check, ratio in ratios.items()}
    short = any(ratio > 1.0 for ratio in over.values())
    if short:
        _ask_extra(hunt, machine, over)
        hunt.borne = _borne(over)
        hunt.nearly[machine.design.reducer.cam_bearing.designation] = min(hunt.borne)
    wider = fails.get("backlash", 0) > binds + jams and _asks_for_a_wider_ring(
        hunt, machine, drawn, quantile
    )
    if short or wider:
        return 0.0
    return None if loose else _LEAST_STEP


def _over(ratios: Mapping[str, NDArray[np.float64]], share: float) -> dict[str, float]:
    """What a share of the gearboxes stays below, by the line it stands for."""
    return {check: float(np.quantile(ratio, share)) for check, ratio in ratios.items()}


def _ask_extra(hunt: Hunt, machine: Machine, over: Mapping[str, float]) -> None:
    """Note the reserve with which designs like one stay within their limits.

    By the lines of rigid discs and ring, whatever the gearboxes did: it is these that searches
    compare it with, and where bodies yield a design has more.
    """
    lines = hunt.held_against(machine)[1]
    had = {one.id: torque_reserve(one, machine.design) for one in lines if one.id in over}
    hunt.ask_extra(
        machine.design.reducer.cam_bearing.designation,
        {check: max(had[check] * _torque(check, ratio), 1.0) for check, ratio in over.items()},
        had,
    )


def _borne(over: Mapping[str, float]) -> tuple[float, float]:
    """Shares of the peak and of the continuous torque at which lines are on their limits."""
    shares = {check: min(1.0 / _torque(check, ratio), 1.0) for check, ratio in over.items()}
    lasting = [share for check, share in shares.items() if check.endswith(LASTING)]
    peak = [share for check, share in shares.items() if not check.endswith(LASTING)]
    return min(peak, default=1.0), min(lasting, default=1.0)


def _asks_for_a_wider_ring(hunt: Hunt, machine: Machine, drawn: Drawn, quantile: float) -> bool:
    """Whether a wider ring may turn less within the same clearances; if so it is noted.

    The angle is that of a clearance at the ring's radius.
    """
    asked, own = machine.design.requirements, machine.design.reducer.ring.outer_diameter
    assert asked.backlash is not None
    found = float(np.quantile(drawn.continuous.columns["backlash_arcmin"], quantile))
    ring = _SPARE * own * math.radians(found / 60.0) / asked.backlash
    space = next(spaces(hunt.requirements, hunt.fit))
    most = 2.0 * hunt.frame(space, {}).outer_radius
    if ring <= own or own > _WIDEST * most:
        return False
    hunt.least_ring = min(ring, most)
    return True


def _torque(check: str, ratio: float) -> float:
    """By how much less torque a line that is so far over its limit comes to it; see `_SPARE`.

    Pressure is a root of torque.
    """
    more = _SPARE * ratio
    return more**2 if check.startswith("CONTACT-") else more
