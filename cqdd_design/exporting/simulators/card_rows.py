"""Rows of the actuator card: each parameter on both sides of the gear, its origin and its names."""

from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from cqdd_design.actuator.joint_side import (
    JointSide,
    delivered_peak_torque,
    motor_breakaway,
    motor_coulomb,
    motor_viscous,
    ripple_harmonics,
    ripple_rms,
)
from cqdd_design.catalog.reader import read_rows
from cqdd_design.exporting.simulators.stated import effort_limit, origin_of, value_of

if TYPE_CHECKING:
    from cqdd_design.actuator.parameters import ActuatorParameters


@dataclass(frozen=True, eq=False)
class Quantity:
    """One parameter of the card.

    Attributes
    ----------
    key, title : str
        For programs and for people.
    motor, joint : float or None
        Its value on either side; None on the side where it has no meaning.
    unit : str
        Of both.
    reflection : str
        How one follows from the other, with numbers; empty where it does not.
    origin : str
        Where it comes from.
    clients : mapping of str to str
        Client (see `card_clients.CLIENTS`) to what it calls it.
    """

    key: str
    title: str
    motor: float | None
    joint: float | None
    unit: str
    reflection: str
    origin: str
    clients: Mapping[str, str]


_POWER = {"n": 1, "1/n": -1, "n^2": 2}
"""How a number goes from motor to joint, and the power of n that does it."""
_WARMED = ("torque_constant", "resistance")
"""Rows whose values are stated at one temperature and given at that around the actuator."""
_COLUMNS = 6
"""Before those of the clients."""


@functools.cache
def card_table() -> tuple[dict[str, str], ...]:
    """Rows of ``data/card.csv``, see `quantities`.

    Columns are key, title, unit, the side where the value stands, how it goes through the gear,
    where it comes from (dotted names, or "computed" and how), and what each client calls it, with
    the side in brackets where the client is not plain.
    """
    return tuple(read_rows("card.csv", __package__))


def quantities(parameters: ActuatorParameters, side: JointSide) -> tuple[Quantity, ...]:
    """Return every row of an actuator's card.

    An ideal encoder has none; what the catalogue does not give stays without value.
    """
    values: dict[str, float] = {**dataclasses.asdict(side), **_worked_out(parameters, side)}
    rows = []
    for row in card_table():
        key, title, unit, place, reflection, of = list(row.values())[:_COLUMNS]
        if key == "encoder_step" and parameters.drive.encoder_bits == 0:
            continue
        names = of.split()
        known = values[key] if key in values else value_of(parameters, names[0])
        value = known if math.isfinite(known) else None
        origin = of if of.startswith("computed") else origin_of(parameters, *names)
        if key in _WARMED and parameters.thermal.ambient != parameters.motor.reference_temperature:
            origin += f", taken to {parameters.thermal.ambient:g} degC"
        motor = value if place == "motor" else None
        joint = value if place == "joint" else None
        shown = ""
        if value is not None and reflection:
            factor = side.reduction ** _POWER[reflection]
            first = value if place == "motor" else value / factor
            motor, joint = first, first * factor if place == "motor" else value
            shown = f"{first:.4g} x {factor:.4g} = {joint:.4g} ({reflection})"
        called = {client: name for client, name in list(row.items())[_COLUMNS:] if name}
        rows.append(Quantity(key, title, motor, joint, unit, shown, origin, called))
    return tuple(rows)


def _worked_out(parameters: ActuatorParameters, side: JointSide) -> dict[str, float]:
    """Values of rows that are no attribute of anything."""
    return {
        "motor_coulomb": motor_coulomb(parameters),
        "motor_breakaway": motor_breakaway(parameters),
        "motor_viscous": motor_viscous(parameters),
        "motor_side_inertia": parameters.motor_side_inertia,
        "kinematic_error": parameters.gear.error_rms,
        "ripple": ripple_rms(ripple_harmonics(parameters)),
        "effort_limit": effort_limit(parameters),
        "delivered_peak_torque": delivered_peak_torque(parameters, side),
        "encoder_step": parameters.drive.encoder_step,
    }
