"""Why no design was found whose verdict is yes, and what would fit."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

from cqdd_design.design import Requirements
from cqdd_design.errors import InfeasibleError
from cqdd_design.gearbox.checks.guide import CHECK_GUIDE
from cqdd_design.geometry.limits import rounded_down
from cqdd_design.machine import Machine
from cqdd_design.results import Check
from cqdd_design.sizing.able import PEAK
from cqdd_design.sizing.agreement import RING, strongest
from cqdd_design.sizing.bearable import both_bearable, times
from cqdd_design.sizing.finish import torque_reserve
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.infeasible import (
    CLOSE,
    WORDS,
    SizingInfeasibleError,
    a_length,
    listed,
    no_design,
)
from cqdd_design.sizing.looks import BY_HEAT
from cqdd_design.sizing.ratios import cool_ratio
from cqdd_design.sizing.search import Search
from cqdd_design.sizing.shafts import ANY_TORQUE, ROTOR
from cqdd_design.sizing.spaces import FITS, Found, Space, spaces
from cqdd_design.verdict import Verdict
from cqdd_design.verdict.motor import held_up_to

TRIALS = 20
"""Of sizing to the verdict."""
_MOTOR = frozenset({"MOTOR-PEAK", "MOTOR-CONTINUOUS"})
"""Lines whose value is a torque that fits."""
FIGURES: Mapping[str, str] = MappingProxyType(
    {
        "MASS": "mass",
        "REFLECTED-INERTIA": "reflected_inertia",
        "BACKLASH": "backlash",
        "LOST-MOTION": "lost_motion",
        "STIFFNESS": "stiffness",
        "EFFICIENCY": "efficiency",
        "SURFACE-TEMPERATURE": "surface_temperature",
        "BORE": "bore",
    }
)
"""Requirements by the lines that hold a figure of a design against them."""
_BY_LOSSES = ("MOTOR-", "THERMAL-RISE", "EFFICIENCY", "PEAK-AT-SPEED")
NO_SPACE = (*_BY_LOSSES, "REFLECTED-INERTIA", "MASS")
"""Beginnings of lines that neither more space nor a stronger gearbox helps."""
_FAR = 0.85
"""Margin of a line by losses, at the nearest of the judged designs, below which none meets it."""


def nothing(hunt: Hunt) -> SizingInfeasibleError:
    """Why no design bears the loads, and about what is borne by the equilibrium in this space.

    With the clearance and the reserve that heat and part errors were found to ask for.
    """
    # Of perfect parts where no gearbox has been looked at.
    hunt = replace(hunt, trusting=not hunt.has_extra)
    asked, space = hunt.requirements, next(spaces(hunt.requirements, hunt.fit))
    if hunt.short_of:
        return _no_shaft(hunt)
    learnt = _learnt(hunt)
    try:
        search = Search.of(hunt.frame(space, {}), hunt.tables)
    except InfeasibleError:
        if not learnt:
            raise
        return _nothing_so(hunt, learnt, ("SHAFT-STRENGTH",))
    if search.most_reserve() is None:
        closed = no_design(search, nearest=False)
        if closed.most_torque is None:
            return _nothing_so(hunt, learnt, closed.binding) if learnt else closed
    share = min(both_bearable(hunt), 1.0)
    binding = _binding(hunt, space, share)
    words = list(dict.fromkeys(WORDS.get(one, CHECK_GUIDE[one].title) for one in binding))
    text = (
        f"{_asked(asked)} do not fit in {_space(asked)}: {listed(words)} "
        f"{'binds' if len(words) == 1 else 'bind'}"
    )
    estimate = ""
    if share < 1.0:
        parts = "with what part errors take" if hunt.has_extra else "of perfect parts"
        so = f", with {learnt}," if learnt else ""
        estimate = f"; by the contact equilibrium {parts}{so} {_carried(asked, share)}"
    closer = ", or state closer [tolerances] in a design" if hunt.has_extra else ""
    bore = "" if asked.bore is None else ", ask for a smaller bore"
    return SizingInfeasibleError(
        f"{text}{estimate}. Ask for less torque, give more space{bore}{closer}.",
        binding=(*(("YIELD",) if hunt.has_extra else ()), *binding),
        most_torque=rounded_down(share * asked.peak_torque, 2) if share < 1.0 else None,
        estimate=estimate,
    )


def _learnt(hunt: Hunt) -> str:
    """What the search has found to be needed for these torques, in words; or nothing.

    With less torque less of it is: what does not fit so may fit then.
    """
    needed = []
    if hunt.fit != FITS[0]:
        needed.append("clearance")
    if hunt.least_bore > 0.0:
        needed.append("cam bearing")
    if hunt.least_ring > 0.0:
        needed.append("ring")
    if hunt.most_pin_circle < math.inf:
        needed.append("pin circle")
    return f"the {listed(needed)} that they were found to ask for" if needed else ""


def _nothing_so(hunt: Hunt, learnt: str, binding: tuple[str, ...]) -> SizingInfeasibleError:
    """No gearbox of any torque is left with what was learnt for those that are asked for."""
    asked, guide = hunt.requirements, CHECK_GUIDE[binding[0]]
    return SizingInfeasibleError(
        f"{_asked(asked)} do not fit in {_space(asked)}: with {learnt}, '{guide.title}' "
        f"({guide.formula}) leaves no gearbox. Ask for less torque or give more space.",
        binding=binding,
        most_torque=None,
    )


def _no_shaft(hunt: Hunt) -> SizingInfeasibleError:
    """Teeth and cam bearing bear the loads, but no shaft, or no bearing at its ends."""
    asked, lines = hunt.requirements, hunt.short_of
    way = "Ask for less torque or give more space"
    if PEAK in asked.derived:
        # Less of it was tried, and is not what is wrong.
        lines = tuple(line for line in lines if line.id in ANY_TORQUE or not line.known)
        rotor = any(line.id in ROTOR for line in lines)
        other = ", or take a motor with a smaller rotor" if rotor else ""
        way = f"Less torque does not help: give more space{other}"
    if any(line.id == "BORE" for line in lines):
        way += ", or ask for a smaller bore"
    told = "; ".join(f"{line.title.lower()}: {line.substituted}" for line in lines)
    return SizingInfeasibleError(
        f"{_asked(asked)} do not fit in {_space(asked)}: of all designs that bear them at teeth "
        f"and cam bearing, the one with the strongest shaft is still far short of {told}. {way}.",
        binding=tuple(line.id for line in lines),
        most_torque=None,
    )


def _carried(asked: Requirements, share: float) -> str:
    if asked.load_cases:
        part = 100.0 * rounded_down(share, 2)
        return f"no more than about {part:.0f} % of these torques are carried"
    peak, lasting = (
        rounded_down(share * one, 2) for one in (asked.peak_torque, asked.continuous_torque)
    )
    return f"no more than about {peak:g} and {lasting:g} N*m are carried in this proportion"


def _asked(asked: Requirements) -> str:
    if asked.load_cases:
        return f"{asked.peak_torque:g} N*m at ratio {asked.ratio}, and the duty,"
    return (
        f"{asked.peak_torque:g} N*m at ratio {asked.ratio}, {asked.continuous_torque:g} N*m of it "
        "for ever,"
    )


def _space(asked: Requirements) -> str:
    return f"{a_length(asked.outer_diameter)} ring and {1e3 * asked.length:g} mm of length"


def _binding(hunt: Hunt, space: Space, share: float) -> tuple[str, ...]:
    """Lines that bind in a space, by the equilibrium of the strongest design at a share of it."""
    if share == 1.0 and hunt.too_weak:
        return ("SHAFT-STRENGTH",)
    found = strongest(replace(hunt, requirements=times(hunt.requirements, share)), space, {})
    if found is None:
        return (RING,)
    extra = hunt.extra_for(found.machine.cam.designation)
    reserves = {
        one.id: torque_reserve(one, found.machine.design) / extra.get(one.id, 1.0)
        for one in found.checks
        if one.known
    }
    least = min(reserves.values())
    close = [name for name, reserve in reserves.items() if reserve <= CLOSE * least]
    return tuple(sorted(close, key=reserves.__getitem__))


def unsettled(found: Found) -> SizingInfeasibleError:
    """Loads are borne, but the trials ended before a design was worth the whole verdict."""
    widest = 1e6 * FITS[-1].hole_clearance
    if found.space.fit == FITS[-1]:
        why = (
            f"heat or part errors ask for more clearance than the {widest:g} um at the output pins "
            "that are tried; lower input_speed or continuous_torque, or state closer [tolerances] "
            "in a design"
        )
    else:
        asked = found.sized.design.requirements
        torques, keys = f"{asked.peak_torque:g} N*m", "peak_torque"
        if not asked.load_cases:
            torques += f" and {asked.continuous_torque:g} N*m for ever"
            keys += " and continuous_torque"
        why = (
            f"in {TRIALS} trials what is asked, heat and part errors went on moving the design, "
            f"last for {torques}; state {keys}, somewhat less"
        )
    return SizingInfeasibleError(
        f"no design was found that meets everything: {why}.",
        binding=("THERMAL-CLEARANCE", "YIELD"),
        most_torque=None,
    )


def refused(judged: Verdict) -> SizingInfeasibleError:
    """What stands in the way of the design that came nearest."""
    short, machine, actuator = _short(judged), judged.evidence.machine, judged.evidence.actuator
    up_to = 0.0
    if actuator is not None and any(line.id == "MOTOR-CONTINUOUS" for line in short):
        up_to = held_up_to(actuator, machine.design.requirements)
    return short_of(short, machine, up_to)


def least_margin(judged: Verdict) -> float:
    """How near a verdict is to a yes: the least margin of its lines, 0 of what is not known."""
    return min((line.margin if line.known else 0.0 for line in _short(judged)), default=math.inf)


def far_short(refusal: SizingInfeasibleError) -> tuple[Check, ...]:
    """What losses leave the design that came nearest far short of, which no other design helps.

    Not of heat while warm parts press on each other: clearance helps that.
    """
    pressed = "THERMAL-CLEARANCE" in refusal.binding
    return tuple(
        line
        for line in refusal.short
        if line.id.startswith(_BY_LOSSES) and line.known and line.margin < _FAR and not pressed
    )


def _short(judged: Verdict) -> list[Check]:
    return [line for line in judged.limits if line.status in {"fail", "unknown"}]


def short_of(short: Sequence[Check], machine: Machine, up_to: float = 0.0) -> SizingInfeasibleError:
    """What the design that came nearest falls short of, the tightest first.

    Parameters
    ----------
    machine : Machine
        Of that design.
    up_to : float
        Input speed up to which its motor holds the continuous torque, rpm; 0 where it does not, or
        where that is not known.
    """
    told = [f"{line.title.lower()}: {line.substituted} ({line.remedy})" for line in short[:4]]
    listing = f" {told[0]}" if len(told) == 1 else "".join(f"\n- {one}" for one in told)
    most = {one.id: rounded_down(one.value) for one in short if one.value and one.id in _MOTOR}
    return SizingInfeasibleError(
        f"no design was found that meets everything; the nearest falls short of{listing}.",
        binding=tuple(line.id for line in short),
        most_torque=most.get("MOTOR-PEAK"),
        most_lasting_torque=most.get("MOTOR-CONTINUOUS"),
        most_speed=up_to or None,
        cool_ratio=cool_ratio(machine) if any(line.id in BY_HEAT for line in short) else 0,
        short=tuple(short),
    )
