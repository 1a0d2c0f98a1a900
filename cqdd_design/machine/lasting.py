"""What a machine holds for ever by the temperatures of all its parts: a torque, or a speed.

The winding is one of them: grease and plastics may not stand as much, warm parts lose another
amount than those that the simulated actuator's friction was found of, and they may press on each
other before any of them is too warm.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

from cqdd_design.errors import CatalogError, DesignError
from cqdd_design.gearbox.checks.allowables import BINDING_OVERLAP
from cqdd_design.gearbox.heat.network import ThermalNetwork
from cqdd_design.machine.cooling import cooled_network
from cqdd_design.machine.cures import ROUGHLY, most_that_holds
from cqdd_design.machine.machine import Machine
from cqdd_design.machine.settling import SEARCHED_STILL
from cqdd_design.machine.temperatures import MachineTemperatures, machine_temperatures

_SLOWEST = math.pi / 30.0
"""Motor speed that a design may state, rad/s: 1 rpm."""


def lasting_torque(
    machine: Machine,
    most: float,
    speed: float,
    told: Mapping[float, float] = MappingProxyType({}),
    *,
    free: bool = True,
) -> float:
    """The greatest torque, N m, up to `most`, that leaves every part as cool as it has to be.

    Parameters
    ----------
    most : float
        N m, above zero.
    speed : float
        Of the motor, rad/s.
    told : mapping of float to float
        Torques, N m, whose :func:`margin_of` is known.
    free : bool
        Whether it has to leave parts free of each other too.

    Returns
    -------
    float
        From below, to two per cent; 0 where none was found.

    Raises
    ------
    GeometryError
        When the network is not known.
    """
    turning, network = _turning(machine, speed), cooled_network(machine)
    known = dict(told)

    def margin(torque: float) -> float:
        if torque not in known:
            known[torque] = _margin(turning, network, torque, free=free)
        return known[torque]

    return most if margin(most) >= 1.0 else most_that_holds(margin, tuple(known), ROUGHLY)


def lasting_speed(machine: Machine, most: float, *, free: bool = True) -> float:
    """The greatest speed of the motor, rad/s, up to `most`, that leaves every part cool enough.

    Under the continuous torque; see :func:`lasting_torque`.
    """
    torque, network = machine.design.requirements.continuous_torque, cooled_network(machine)
    known: dict[float, float] = {}

    def margin(speed: float) -> float:
        if speed not in known:
            known[speed] = _margin(_turning(machine, speed), network, torque, free=free)
        return known[speed]

    return most if margin(most) >= 1.0 else most_that_holds(margin, tuple(known), ROUGHLY)


def margin_of(held: MachineTemperatures, *, free: bool) -> float:
    """Rise that parts bear over that which they have; 0 where it is not known.

    Or, where they have to be free and that is less, the root of what they may press on each other
    over what they do: as a margin that falls about as fast as the other.
    """
    if held.cold:
        return 0.0
    margin = 1.0 / held.heat_share
    if margin < 1.0 or not free:
        return margin
    pressed = held.tightest.overlap
    return min(margin, (1e-6 * BINDING_OVERLAP / pressed) ** 0.5) if pressed > 0.0 else margin


def _turning(machine: Machine, speed: float) -> Machine:
    """The machine with its continuous torque at a speed of the motor, rad/s.

    One that stands is looked at as turning as slowly as a design may state.
    """
    other = machine.changed({"requirements.continuous_speed": max(speed, _SLOWEST)})
    vars(other).update(contact=machine.contact, bodies=machine.bodies)
    other.loses_as(machine)
    return other


def _margin(machine: Machine, network: ThermalNetwork, torque: float, *, free: bool) -> float:
    """Of the machine under a torque, N m."""
    peak = max(machine.design.requirements.peak_torque, torque)
    try:
        under = machine.under(peak=peak, continuous=torque)
        held = machine_temperatures(under, duty=False, still=SEARCHED_STILL, network=network)
        return margin_of(held, free=free)
    except (CatalogError, DesignError):
        return 0.0
