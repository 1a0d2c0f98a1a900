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
from cqdd_design.gearbox.analysis import GearboxAnalysis
from cqdd_design.gearbox.checks.allowables import UNEVEN_SHARING
from cqdd_design.gearbox.contact.states import NominalStates, nominal_states
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
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

_ANGLES = 180
_NEAR, _MOST_STEPS = 1e-4, 40


@dataclass(frozen=True)
class TorqueLimit:
    """A torque at which a gearbox reaches a limit.

    Attributes
    ----------
    check : str
        The check whose limit it is, of `PARTS`.
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
        return PARTS[self.check]


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
    analysis = machine.analysis
    checks = [check for check in analysis.checks if check.id in PARTS]
    known = [check for check in checks if min(check.value, check.limit) > 0.0]
    model = machine.contact
    states = nominal_states(model, perfect_angles(model, _ANGLES))
    limits = [_limit(machine, analysis, check, states) for check in known]
    return CarriedTorque(
        required=machine.design.requirements.peak_torque,
        limits=tuple(sorted(limits, key=lambda one: one.torque)),
        unknown=tuple(check.id for check in checks if check not in known),
    )


def _limit(
    machine: Machine, analysis: GearboxAnalysis, check: Check, states: NominalStates
) -> TorqueLimit:
    """Torque at which the value of one check, from the equilibrium, is on its limit."""
    # Pressures grow about with the root of the torque, all else with the torque.
    power = 2.0 if check.id.startswith("CONTACT-") else 1.0
    rigid = machine.design.requirements.peak_torque * check.margin**power
    torque = rigid
    try:
        for _ in range(_MOST_STEPS):
            share = _share_of_limit(machine, analysis, check, torque, states)
            if abs(share - 1.0) < _NEAR:
                return TorqueLimit(check.id, torque, EQUILIBRIUM)
            torque *= share**-power
    except ContactError:
        pass
    return TorqueLimit(check.id, rigid, RIGID)


def _share_of_limit(
    machine: Machine,
    analysis: GearboxAnalysis,
    check: Check,
    torque: float,
    states: NominalStates,
) -> float:
    """Value over limit of a check at a torque (N m), its load from the equilibrium."""
    sweeps = [contact_sweep(machine.contact, s * torque, states=states).maxima for s in (1.0, -1.0)]
    most = {key: max(one[key] for one in sweeps) for key in sweeps[0]}
    if check.id == "CONTACT-RING-PEAK":
        return most["ring_pressure_max_MPa"] / check.limit
    if check.id == "CONTACT-PIN-PEAK":
        return most["output_pressure_max_MPa"] / check.limit
    if check.id == "BEARING-STATIC":
        rating = check.value * analysis.cam_bearing.peak_load
        return most["cam_bearing_load_max_N"] * check.limit / rating
    # Stresses of a pin grow with its force, which the check counts with uneven sharing.
    counted = UNEVEN_SHARING * analysis.rigid_peak.output_pin_force
    return check.value / check.limit * most["output_pin_force_max_N"] / counted
