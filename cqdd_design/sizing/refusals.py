"""Why no design was found whose verdict is yes, and what would fit."""

from __future__ import annotations

from cqdd_design.geometry.limits import rounded_down
from cqdd_design.sizing.agreement import RING
from cqdd_design.sizing.bearable import both_bearable, times
from cqdd_design.sizing.hunt import FITS, Found, Hunt, spaces
from cqdd_design.sizing.infeasible import SizingInfeasibleError, no_design
from cqdd_design.sizing.kinds import ranked
from cqdd_design.sizing.search import Search
from cqdd_design.verdict import Verdict

TRIALS = 20
"""Of sizing to the verdict."""
_OVER, _LESS, _WEAKER = 1.06, 0.96, 14
"""Share of what the strongest design is thought to bear that is tried first for a refusal, the next
over the one before where that is not carried, and how often."""
_HALF = 0.98
"""Half of such a step."""


def nothing(hunt: Hunt) -> SizingInfeasibleError:
    """Why no design bears the loads, and about what is borne by the equilibrium in this space.

    With the clearance and the reserve that heat and part errors were found to ask for.
    """
    asked, space = hunt.requirements, next(spaces(hunt.requirements, hunt.fit))
    search = Search.of(hunt.frame(space, {}), hunt.tables)
    most = search.most_reserve()
    closed = no_design(search) if most is None or float(most.reserve[0]) < 1.0 else None
    if closed is not None and closed.most_torque is None:
        return closed
    share = _carried(hunt)
    errors = "and with what part errors take, " if hunt.has_extra else ""
    text = (
        f"{asked.peak_torque:g} N*m at ratio {asked.ratio}, {asked.continuous_torque:g} N*m of it "
        f"for ever, do not fit: by the contact equilibrium, {errors}"
    )
    ways = ["state closer [tolerances] in a design"] if hunt.has_extra else []
    carried = None
    if share is None:
        text += "far less is carried in this space"
        ways.insert(0, "lower both torques")
    else:
        carried = rounded_down(share * asked.peak_torque, 2)
        lasting = rounded_down(share * asked.continuous_torque, 2)
        text += f"about {carried:g} and {lasting:g} N*m are carried in this space"
        ways.insert(0, f"lower peak_torque to {carried:g} and continuous_torque to {lasting:g} N*m")
    ring = None if closed is None else closed.outer_diameter_needed
    length = None if closed is None else closed.length_needed
    for key, need in (("outer_diameter", ring), ("length", length)):
        if need is not None:
            ways.append(f"raise {key}, to more than the {1e3 * need:g} mm of closed forms")
    remedy = ", or ".join(ways)
    return SizingInfeasibleError(
        f"{text}. {remedy[0].upper()}{remedy[1:]}.",
        binding=(
            *(("YIELD",) if hunt.has_extra else ()),
            *((RING,) if not closed else closed.binding),
        ),
        most_torque=carried,
        outer_diameter_needed=ring,
        length_needed=length,
    )


def _carried(hunt: Hunt) -> float | None:
    """The share of both torques, up to about one, at which a design is borne out; None far below.

    Two per cent more are not.
    """
    asked = hunt.requirements

    def borne(share: float) -> bool:
        hunt.requirements = times(asked, share)
        return any(not one.worth[0] for one in ranked(hunt))

    share = min(_OVER * both_bearable(hunt), 1.0)
    for _ in range(_WEAKER):
        if borne(share):
            return share / _HALF if borne(share / _HALF) else share
        share *= _LESS
    return None


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
        why = (
            f"in {TRIALS} trials what is asked, heat and part errors went on moving the design, "
            f"last for {asked.peak_torque:g} N*m and {asked.continuous_torque:g} N*m for ever; "
            "state peak_torque and continuous_torque, somewhat less"
        )
    return SizingInfeasibleError(
        f"no design was found that meets everything: {why}.",
        binding=("THERMAL-CLEARANCE", "YIELD"),
        most_torque=None,
    )


def refused(judged: Verdict) -> SizingInfeasibleError:
    """What stands in the way of the design that came nearest."""
    short = [line for line in judged.limits if line.status in {"fail", "unknown"}]
    told = "; ".join(
        f"{line.title.lower()}: {line.substituted} ({line.remedy})" for line in short[:4]
    )
    motor = [one for one in short if one.id == "MOTOR-PEAK" and one.value]
    return SizingInfeasibleError(
        f"no design was found that meets everything; the nearest falls short of {told}.",
        binding=tuple(line.id for line in short),
        most_torque=rounded_down(motor[0].value) if motor and motor[0].value else None,
    )
