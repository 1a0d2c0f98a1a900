"""Why no design was found whose verdict is yes, and what would fit."""

from __future__ import annotations

from cqdd_design.geometry.limits import rounded_down
from cqdd_design.sizing.able import CONTINUOUS, PEAK
from cqdd_design.sizing.agreement import FITS, RING, Found, Hunt, lightest, spaces
from cqdd_design.sizing.infeasible import SizingInfeasibleError, no_design
from cqdd_design.sizing.search import Search
from cqdd_design.verdict import Verdict

TRIALS = 14
"""Of sizing to the verdict."""
_LESS, _WEAKER = 0.9, 16
"""Share of both torques that is tried next where none of a refusal's is carried, and how often."""


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
    torque = asked.peak_torque if closed is None else closed.most_torque or 0.0
    carried = _carried(hunt, torque)
    errors = "and with what part errors take, " if hunt.extra else ""
    text = (
        f"{asked.peak_torque:g} N*m at ratio {asked.ratio}, {asked.continuous_torque:g} N*m of it "
        f"for ever, do not fit: by the contact equilibrium, {errors}"
    )
    ways = ["state closer [tolerances] in a design"] if hunt.extra else []
    if carried is None:
        text += "far less is carried in this space"
        ways.insert(0, "lower both torques")
    else:
        lasting = rounded_down(carried * asked.continuous_torque / asked.peak_torque, 2)
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
        binding=(*(("YIELD",) if hunt.extra else ()), *((RING,) if not closed else closed.binding)),
        most_torque=carried,
        outer_diameter_needed=ring,
        length_needed=length,
    )


def _carried(hunt: Hunt, torque: float) -> float | None:
    """The peak torque, N m, from some torque down, at which a design is borne out; None far below.

    The continuous torque falls with it.
    """
    asked = hunt.requirements
    share = asked.continuous_torque / asked.peak_torque
    for _ in range(_WEAKER):
        torque *= _LESS
        hunt.requirements = asked.model_copy(
            update={PEAK: torque, CONTINUOUS: min(asked.continuous_torque, share * torque)}
        )
        if lightest(hunt) is not None:
            return rounded_down(torque, 2)
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
