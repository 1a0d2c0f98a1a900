"""Torques that a gearbox does not carry, for what gives its actuator all that motor and drive have.

Simulations, their data and the files of simulators know motor, drive and friction, and let the
gearbox carry whatever they make of it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

from cqdd_design.errors import DesignError
from cqdd_design.machine.carrying import carried_up_to
from cqdd_design.machine.machine import Machine


@dataclass(frozen=True)
class Overload:
    """A torque that a gearbox does not carry, or of which that cannot be told.

    Attributes
    ----------
    torque : float
        At the output, N m.
    carried : float or None
        What it carries before the first part gives way, N m; None where that is not known.
    told : str
        What gives way and from where on, as a part of a sentence.
    """

    torque: float
    carried: float | None
    told: str

    def to_dict(self) -> dict[str, object]:
        """The JSON form, units in the names."""
        return {"torque_Nm": self.torque, "carried_Nm": self.carried, "told": self.told}


@lru_cache(maxsize=8)
def overload(machine: Machine, torque: float) -> Overload | None:
    """What a machine's gearbox does not carry of a torque (N m); None where it carries all."""
    try:
        found = carried_up_to(machine, torque)
    except DesignError as error:
        unknown = f"whether the gearbox carries it is not known: {error.message.rstrip('.')}"
        return Overload(torque, None, unknown)
    if not found.limits or found.limits[0].torque >= torque:
        return None
    return Overload(torque, found.limits[0].torque, found.told(torque))
