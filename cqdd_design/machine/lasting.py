"""What a machine holds for ever by the temperatures of all its parts: a torque, or a speed.

The winding is one of them: grease and plastics may not stand as much, warm parts lose another
amount than those that the simulated actuator's friction was found of, and they may press on each
other before any of them is too warm.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from cqdd_design.gearbox.checks.allowables import BINDING_OVERLAP
from cqdd_design.machine.machine import Machine
from cqdd_design.machine.temperatures import machine_temperatures

_NEAR = 1e-2
"""Of what is looked for, how much may be left of it."""
_LOOKS = 10
_FARTHEST = 0.1
"""Share of what is too much, below which nothing is tried next."""
_LEAST = 0.02
"""Share of the most, below which nothing is looked for."""


def lasting_torque(
    machine: Machine, most: float, speed: float, holds: float = 0.0, *, free: bool = True
) -> float:
    """The greatest torque, N m, up to `most`, that leaves every part as cool as it has to be.

    Parameters
    ----------
    most : float
        N m, above zero.
    speed : float
        Of the motor, rad/s.
    holds : float
        A torque below that, N m, that is known to; 0 where none is.
    free : bool
        Whether it has to leave parts free of each other too.

    Returns
    -------
    float
        Within a per cent, from below; 0 where none was found.

    Raises
    ------
    GeometryError, DesignError, ContactError
        When the network or the losses are not known.
    """
    turning = _turning(machine, speed)
    return _greatest(lambda torque: _used(turning, torque, free=free), most, holds)


def lasting_speed(machine: Machine, most: float, *, free: bool = True) -> float:
    """The greatest speed of the motor, rad/s, up to `most`, that leaves every part cool enough.

    Under the continuous torque; see :func:`lasting_torque`.
    """
    torque = machine.design.requirements.continuous_torque
    return _greatest(lambda speed: _used(_turning(machine, speed), torque, free=free), most, 0.0)


def _turning(machine: Machine, speed: float) -> Machine:
    """The machine with its continuous torque at a speed of the motor, rad/s."""
    other = machine.changed({"requirements.continuous_speed": speed})
    vars(other).update(contact=machine.contact, bodies=machine.bodies)
    return other


def _used(machine: Machine, torque: float, *, free: bool) -> float:
    """Of the rise that parts bear under a torque, N m; infinite where they are not known to.

    And where warm parts press on each other, if they have to be free.
    """
    peak = max(machine.design.requirements.peak_torque, torque)
    held = machine_temperatures(machine.under(peak=peak, continuous=torque), duty=False)
    share = held.heat_share
    if share > 1.0:
        return share
    pressing = free and held.tightest.overlap > 1e-6 * BINDING_OVERLAP
    return math.inf if held.cold or pressing else share


def _greatest(used: Callable[[float], float], most: float, holds: float) -> float:
    """The greatest up to `most` of which no more than all is used; 0 where none was found."""
    known = {most: used(most)}
    if known[most] <= 1.0:
        return most
    below, above = holds, most
    for _ in range(_LOOKS):
        if above - below <= _NEAR * above or above < _LEAST * most:
            break
        at = _next(known, below, above)
        known[at] = used(at)
        below, above = (at, above) if known[at] <= 1.0 else (below, at)
    return below


def _next(known: dict[float, float], below: float, above: float) -> float:
    """Where to look between what holds and what is too much.

    Where a line over its square through the last two meets all that may be used, if it does there,
    and otherwise in the middle.
    """
    least, most = max(below, _FARTHEST * above), above * (1.0 - 0.5 * _NEAR)
    middle = 0.5 * (least + above)
    (one, first), *others = reversed(known.items())
    # Without another it is as if all heat came with it.
    other, second = others[0] if others else (0.0, 0.0)
    if math.isinf(first) or math.isinf(second) or first == second:
        return middle
    square = one**2 + (1.0 - first) / (second - first) * (other**2 - one**2)
    at = math.sqrt(max(square, 0.0)) * (1.0 - 0.4 * _NEAR)
    return at if least < at < most else middle
