"""What torque a gearbox carries at its peak, by the best model there is for each of its limits.

Pressures, pin forces and cam loads come from the contact equilibrium of perfect parts without
friction, over the period and in both senses of torque; strengths are those of the checks. Where
the equilibrium has no answer, the rigid law with its factor for uneven sharing stands in, and the
limit says so. What a gearbox lasts is not asked here.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from cqdd_design.errors import ContactError
from cqdd_design.gearbox.checks.allowables import UNEVEN_SHARING
from cqdd_design.machine.capacity import LOAD_OF_CHECK, LoadedContacts
from cqdd_design.machine.machine import Machine
from cqdd_design.results import Check

EQUILIBRIUM = "contact equilibrium of perfect parts, without friction"
RIGID = f"rigid law times {UNEVEN_SHARING:g}"

PARTS: Mapping[str, str] = MappingProxyType(
    {
        "CONTACT-RING-PEAK": "pressure of the ring's teeth",
        "CONTACT-PIN-PEAK": "pressure of the pins in their holes",
        "PIN-SHEAR-PEAK": "shear of the output pins",
        "PIN-BENDING-PEAK": "bending of the output pins",
        "PIN-BEARING-PEAK": "mean pressure of the pins in their holes",
        "BEARING-STATIC": "static rating of the cam bearing",
    }
)
"""Checks at the peak torque that are limits of it, and what gives way."""

OUT_OF_REACH = "the parts would have to move farther than they reach"


@dataclass(frozen=True)
class TorqueLimit:
    """A torque at which a gearbox reaches a limit.

    Attributes
    ----------
    check : str
        The check whose limit it is, of `PARTS`; empty where the equilibrium ends before.
    torque : float
        At the output, N m.
    model : str
        `EQUILIBRIUM` or `RIGID`.
    """

    check: str
    torque: float
    model: str

    @property
    def part(self) -> str:
        """What gives way."""
        return PARTS[self.check] if self.check else OUT_OF_REACH


@dataclass(frozen=True)
class CarriedTorque:
    """What is asked of a gearbox at its peak, and what it carries.

    Attributes
    ----------
    required : float
        The peak torque of the requirements, N m.
    limits : tuple of TorqueLimit
        Least torque first.
    unknown : tuple of str
        Checks of `PARTS` for which the catalogue gives no strength.
    """

    required: float
    limits: tuple[TorqueLimit, ...]
    unknown: tuple[str, ...] = ()

    def told(self, torque: float) -> str:
        """A sentence on whether a torque (N m) is carried, and what gives way below it."""
        below = [one for one in self.limits if one.torque < torque]
        missing = "".join(f"; {PARTS[one]}: no strength is known" for one in self.unknown)
        if below:
            parts = "; ".join(f"{one.part} from {one.torque:.3g} N*m" for one in below)
            models = " and ".join(dict.fromkeys(one.model for one in below))
            return f"the gearbox does not carry it: {parts} ({models}){missing}"
        if not self.limits:
            return f"whether the gearbox carries it is not known{missing}"
        first = self.limits[0]
        return (
            f"the gearbox carries it; first to give way is {first.part}, at {first.torque:.3g} N*m "
            f"({first.model}){missing}"
        )


def carried_torque(machine: Machine) -> CarriedTorque:
    """Peak torques at which a machine's gearbox reaches its limits.

    Raises
    ------
    GeometryError
        When disc, ring or holes cannot exist.
    """
    checks = [check for check in machine.analysis.checks if check.id in PARTS]
    known = [check for check in checks if min(check.value, check.limit) > 0.0]
    contacts = LoadedContacts(machine)
    # Several parts may outlast the equilibrium, which ends once.
    limits = dict.fromkeys(_limit(machine, contacts, check) for check in known)
    return CarriedTorque(
        required=machine.design.requirements.peak_torque,
        limits=tuple(sorted(limits, key=lambda one: one.torque)),
        unknown=tuple(check.id for check in checks if check not in known),
    )


def _limit(machine: Machine, contacts: LoadedContacts, check: Check) -> TorqueLimit:
    """Torque at which the load of one check, from the equilibrium, is as much as is allowed."""
    required, key = machine.design.requirements.peak_torque, LOAD_OF_CHECK[check.id]
    allowed = _allowed_load(machine, check)
    try:
        torque = contacts.torque_at(key, allowed, required)
        reached = contacts.greatest(torque)[key] > 0.99 * allowed
    except ContactError:
        # Pressures of the rigid law grow with the root of the torque, all else with the torque.
        power = 2.0 if check.id.startswith("CONTACT-") else 1.0
        return TorqueLimit(check.id, required * check.margin**power, RIGID)
    return TorqueLimit(check.id if reached else "", torque, EQUILIBRIUM)


def _allowed_load(machine: Machine, check: Check) -> float:
    """What a check allows of the force (N) or pressure (MPa) that it comes from."""
    analysis = machine.analysis
    if check.id == "BEARING-STATIC":
        return check.value * analysis.cam_bearing.peak_load / check.limit
    if check.id.startswith("CONTACT-"):
        return check.limit
    # Stresses of a pin grow with its force, which the check counts with uneven sharing.
    return check.limit / check.value * UNEVEN_SHARING * analysis.rigid_peak.output_pin_force
