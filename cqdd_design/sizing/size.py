"""Requirements to a checked design: the one call of this room."""

from __future__ import annotations

import time
from collections.abc import Callable

from cqdd_design.catalog.motors import Motor
from cqdd_design.design import Requirements
from cqdd_design.sizing.frame import Goal, search_frame
from cqdd_design.sizing.infeasible import no_design, refuse_motor
from cqdd_design.sizing.result import SizingResult
from cqdd_design.sizing.search import Search


def size(
    requirements: Requirements,
    progress: Callable[[str], None] | None = None,
    *,
    motor: Motor | None = None,
    ambient: float | None = None,
    goal: Goal = "mass",
) -> SizingResult:
    """Size a gearbox.

    A full product of several million candidates is screened against every closed-form check; the
    best survivors are refined on the grid of sizes a shop can make, by their mass or another goal;
    what comes out has passed the same analysis as any design file. Deterministic.

    Parameters
    ----------
    requirements : Requirements
        Torques, speed and space, with their defaults.
    progress : callable, optional
        Called with a sentence at every stage.
    motor : Motor, optional
        Default the catalogue's row of the motor that the requirements name.
    ambient : float, optional
        Of the air round the actuator, deg C; default that of a design.
    goal : Goal
        What to make small: see :mod:`cqdd_design.sizing.goals`.

    Raises
    ------
    SizingInfeasibleError
        When no design meets the requirements; it names the limits that bind and the nearest
        requirement that would fit.

    Examples
    --------
    >>> found = size(Requirements(ratio=20))
    >>> all(check.status != "fail" for check in found.checks)
    True
    """
    say = progress or (lambda _: None)
    started = time.perf_counter()
    frame = search_frame(requirements, motor, ambient, goal=goal)
    say("screening candidates against every limit")
    search = Search.of(frame)
    found = search.found
    say(f"{found.survivors} of {found.screened} candidates meet every limit; refining the best")
    most = search.most_reserve()
    offers = search.offers(most) if most is not None and most.reserve[0] > 0.99 else ()
    if not offers:
        say("no candidate meets every limit; looking for the nearest requirements that fit")
        raise no_design(search)
    design, *alternatives = offers
    refuse_motor(design, frame.motor)
    return SizingResult(
        **vars(design),
        alternatives=tuple(alternatives),
        candidates_screened=found.screened,
        survivors=found.survivors,
        rejected=found.rejected,
        seconds=time.perf_counter() - started,
    )
