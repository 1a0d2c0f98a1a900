"""What torque a gearbox carries, by the best model there is for each of its limits.

Pressures, pin forces and cam loads come from the contact equilibrium of perfect parts with the
motor driving against friction, over the period and in both senses of torque; strengths are those
of the checks. Where the equilibrium has no answer at the peak torque, the rigid law with its factor
for uneven sharing stands in, and the limit says so. Over the duty, values and limits are those of
the checks of what lasts its hours; without an answer there is none of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from types import MappingProxyType
from typing import Literal, NamedTuple

from cqdd_design.errors import ContactError
from cqdd_design.gearbox.bearing_life import load_for_life
from cqdd_design.gearbox.checks.allowables import STATIC_SAFETY, UNEVEN_SHARING
from cqdd_design.gearbox.checks.equilibrium import DUTY_MODEL, lasting_checks
from cqdd_design.gearbox.checks.equilibrium import MODEL as EQUILIBRIUM
from cqdd_design.machine.capacity import LoadedContacts
from cqdd_design.machine.cures import torques_that_hold
from cqdd_design.machine.machine import Machine
from cqdd_design.results import Check

RIGID = f"rigid law x {UNEVEN_SHARING:g}"
_NEAR = 0.99
"""Of a limit, from which it is looked for."""
OUT_OF_REACH = "the parts would have to move farther than they reach"

LoadName = Literal["peak", "continuous"]


class _Row(NamedTuple):
    """A strength check: what gives way, at which load, and what its value goes with.

    `key` is of the maxima of a contact sweep; by the rigid law the value grows as the torque to
    the power `power`.
    """

    part: str
    words: str
    load: LoadName
    key: str
    power: float


_RING, _HOLE = "ring_pressure_max_MPa", "output_pressure_max_MPa"
_PIN, _BENT = "output_pin_force_max_N", "output_pin_bending_max_MPa"
_CAM = "cam_bearing_load_max_N"
LIMITS: Mapping[str, _Row] = MappingProxyType(
    {
        "CONTACT-RING-PEAK": _Row("ring teeth", "pressure of the ring's teeth", "peak", _RING, 0.5),
        "CONTACT-RING-CONTINUOUS": _Row(
            "ring teeth", "pressure of the ring's teeth", "continuous", _RING, 0.5
        ),
        "CONTACT-PIN-PEAK": _Row(
            "output pins", "pressure of the pins in their holes", "peak", _HOLE, 0.5
        ),
        "CONTACT-PIN-CONTINUOUS": _Row(
            "output pins", "pressure of the pins in their holes", "continuous", _HOLE, 0.5
        ),
        "PIN-SHEAR-PEAK": _Row("output pins", "shear of the output pins", "peak", _PIN, 1.0),
        "PIN-BENDING-PEAK": _Row("output pins", "bending of the output pins", "peak", _BENT, 1.0),
        "PIN-BENDING-CONTINUOUS": _Row(
            "output pins", "bending of the output pins", "continuous", _BENT, 1.0
        ),
        "PIN-BEARING-PEAK": _Row(
            "output pins", "mean pressure of the pins in their holes", "peak", _PIN, 1.0
        ),
        "BEARING-STATIC": _Row(
            "cam bearing", "static rating of the cam bearing", "peak", _CAM, 1.0
        ),
        "BEARING-LIFE": _Row("cam bearing", "life of the cam bearing", "continuous", _CAM, 1.0),
    }
)
"""Checks that limit the torque of a gearbox."""


@dataclass(frozen=True)
class TorqueLimit:
    """A torque at which a gearbox reaches a limit.

    Attributes
    ----------
    check : str
        The check whose limit it is, of `LIMITS`.
    title : str
        What is compared.
    asked : float
        The torque that is required at this load, N m; of a duty its greatest.
    value, limit : float
        What the check compares, at `asked`, and what it allows, in `unit`.
    torque : float
        At the output, where `limit` is reached, N m; a duty's others go with its greatest.
    model : str
        What `value` and `torque` rest on.
    reached : bool
        False where the equilibrium ends at `torque` and nothing has given way.
    """

    check: str
    title: str
    asked: float
    value: float
    limit: float
    unit: str
    torque: float
    model: str
    reached: bool = True

    @property
    def row(self) -> _Row:
        """What gives way, and at which load."""
        return LIMITS[self.check]

    @property
    def words(self) -> str:
        """What gives way."""
        return self.row.words if self.reached else OUT_OF_REACH


@dataclass(frozen=True)
class CarriedTorque:
    """What is asked of a gearbox at its peak, and what it carries.

    Attributes
    ----------
    required : float
        The peak torque of the requirements, N m.
    limits : tuple of TorqueLimit
        At the peak torque, least torque first; the end of the equilibrium once.
    unknown : tuple of str
        Checks of `LIMITS` for which the catalogue gives no strength.
    """

    required: float
    limits: tuple[TorqueLimit, ...]
    unknown: tuple[str, ...] = ()

    def told(self, torque: float) -> str:
        """A sentence on whether a torque (N m) is carried, and what gives way below it."""
        below = [one for one in self.limits if one.torque < torque]
        missing = "".join(f"; {LIMITS[one].words}: no strength is known" for one in self.unknown)
        if below:
            parts = "; ".join(f"{one.words} from {one.torque:.3g} N*m" for one in below)
            models = " and ".join(dict.fromkeys(one.model for one in below))
            return f"the gearbox does not carry it: {parts} ({models}){missing}"
        if not self.limits:
            return f"whether the gearbox carries it is not known{missing}"
        first = self.limits[0]
        return (
            f"the gearbox carries it; first to give way is {first.words}, at {first.torque:.3g} "
            f"N*m ({first.model}){missing}"
        )


class Compared(NamedTuple):
    """A check's comparison by the rigid law, and its value for one unit of its key."""

    check: str
    title: str
    value: float
    limit: float
    unit: str
    per_key: float

    @property
    def row(self) -> _Row:
        """What gives way, and at which load."""
        return LIMITS[self.check]


def torque_limits(machine: Machine, load: LoadName | None = None) -> tuple[TorqueLimit, ...]:
    """Torques at which a machine's gearbox reaches its limits, in the order of the checks.

    Of one load, or of both. Limits whose strength the catalogue does not give are left out, and
    those of the duty where a case of it has no equilibrium.

    Raises
    ------
    GeometryError
        When disc, ring or holes cannot exist.
    """
    found = {
        name: limit
        for one in ("peak", "continuous")
        if load in {None, one}
        for name, limit in _limits(machine, one).items()
    }
    return tuple(found[name] for name in LIMITS if name in found)


@lru_cache(maxsize=8)
def _limits(machine: Machine, load: LoadName) -> dict[str, TorqueLimit]:
    """Limits of one load by their checks; a report asks for one load, then for both."""
    if load == "continuous":
        return _lasting_limits(machine)
    contacts = machine.loaded_contacts
    return {one.check: _limit(machine, contacts, one) for one in _compared_at_peak(machine)}


def _lasting_limits(machine: Machine) -> dict[str, TorqueLimit]:
    """Limits over the duty, whose torques rise and fall together; none without an equilibrium."""

    @cache
    def at(share: float) -> dict[str, Check]:
        lived = machine.under(duty_share=share).life
        return {one.id: one for one in lasting_checks(machine.analysis, lived) if one.known}

    try:
        now = {name: one for name, one in at(1.0).items() if name in LIMITS and one.value}
    except ContactError:
        return {}
    asked = max(abs(case.torque) for case in machine.life.duty)
    shares = torques_that_hold(lambda share: at(share).values(), 1.0, now.values(), every=True)
    return {
        name: _lasting_limit(machine, check, asked, shares[name], at) for name, check in now.items()
    }


def _lasting_limit(
    machine: Machine,
    check: Check,
    asked: float,
    share: float,
    at: Callable[[float], dict[str, Check]],
) -> TorqueLimit:
    """The limit of a check over the duty, that holds up to a share of its torques."""
    value, limit = check.compared
    title, unit = check.title, check.unit
    if not machine.life.assumed:
        title = title.replace("continuous torque", "over the duty")
    if check.id == "BEARING-LIFE":
        # As a load: hours go with its power.
        cam, hours = machine.analysis.cam_bearing, machine.life.required_hours
        title, unit = f"equivalent load for L10h = {hours:g} h of all cam bearings", "N"
        dynamic = cam.bearing.dynamic_rating or 0.0
        limit = float(load_for_life(dynamic, hours, machine.life.cam.speed, cam.exponent))
        value = limit * check.margin ** (-1.0 / cam.exponent)
    reached = share > 0.0 and at(share)[check.id].margin < 1.0 / _NEAR
    return TorqueLimit(
        check.id, title, asked, value, limit, unit, share * asked, DUTY_MODEL, reached
    )


def carried_torque(machine: Machine) -> CarriedTorque:
    """What a machine's gearbox carries at its peak torque; errors as `torque_limits`."""
    return _carried(machine, torque_limits(machine, "peak"))


def carried_up_to(machine: Machine, torque: float) -> CarriedTorque:
    """The same of those limits alone that a torque (N m) reaches, all but for a per cent.

    To know that nothing gives way up to a torque takes one look, to know what would beyond it a
    search of each limit.
    """
    contacts, every = machine.loaded_contacts, list(_compared_at_peak(machine))
    near = every
    try:
        found = contacts.greatest(torque)
        near = [one for one in every if one.per_key * found[one.row.key] > _NEAR * one.limit]
    except ContactError:
        # Beyond the end of the equilibrium every limit is looked for.
        pass
    return _carried(machine, [_limit(machine, contacts, one) for one in near])


def _carried(machine: Machine, peak: Sequence[TorqueLimit]) -> CarriedTorque:
    known = {one.check for one in _compared_at_peak(machine)}
    ends = sorted((one for one in peak if not one.reached), key=lambda one: one.torque)
    limits = [one for one in peak if one.reached] + ends[:1]
    return CarriedTorque(
        required=machine.design.requirements.peak_torque,
        limits=tuple(sorted(limits, key=lambda one: one.torque)),
        unknown=tuple(
            check.id
            for check in machine.analysis.checks
            if check.id in LIMITS and LIMITS[check.id].load == "peak" and check.id not in known
        ),
    )


def _compared_at_peak(machine: Machine) -> Iterator[Compared]:
    return (one for one in compared_limits(machine) if one.row.load == "peak")


def compared_limits(machine: Machine) -> Iterator[Compared]:
    """Checks of `LIMITS` whose strengths are known; bearings by load, not by safety and hours."""
    analysis = machine.analysis
    cam = analysis.cam_bearing
    static = (cam.bearing.static_rating or 0.0) / STATIC_SAFETY
    dynamic = cam.bearing.dynamic_rating or 0.0
    hours = machine.design.requirements.life_hours
    lasting = float(load_for_life(dynamic, hours, cam.speed, cam.exponent))
    bearings = {
        "BEARING-STATIC": (f"load for C0/P = {STATIC_SAFETY:g}", cam.peak_load, static),
        "BEARING-LIFE": (f"load for L10h = {hours:g} h", cam.continuous_load, lasting),
    }
    for check in analysis.checks:
        if check.id in bearings:
            title, value, limit = bearings[check.id]
            found = Compared(check.id, title, value, limit, "N", 1.0)
        elif check.id in LIMITS:
            row, per_key = LIMITS[check.id], 1.0
            value, limit = check.compared
            if row.key == _PIN:
                # Stresses of a pin grow with its force, which the check counts for uneven sharing.
                peak = row.load == "peak"
                load = analysis.rigid_peak if peak else analysis.rigid_continuous
                per_key = value / (UNEVEN_SHARING * load.output_pin_force)
            found = Compared(check.id, check.title, value, limit, check.unit, per_key)
        else:
            continue
        if min(found.value, found.limit) > 0.0:
            yield found


def _limit(machine: Machine, contacts: LoadedContacts, one: Compared) -> TorqueLimit:
    row, asked = LIMITS[one.check], machine.design.requirements.peak_torque
    value, model, reached = one.value, RIGID, True
    torque = asked * (one.limit / one.value) ** (1.0 / row.power)
    allowed = one.limit / one.per_key
    try:
        torque = contacts.torque_at(row.key, allowed, asked)
        model = f"{RIGID}; torque by the {EQUILIBRIUM}"
        reached = contacts.greatest(torque)[row.key] > 0.99 * allowed
        value, model = one.per_key * contacts.greatest(asked)[row.key], EQUILIBRIUM
    except ContactError:
        # What was found before the equilibrium ended stands.
        pass
    return TorqueLimit(
        one.check, one.title, asked, value, one.limit, one.unit, torque, model, reached
    )
