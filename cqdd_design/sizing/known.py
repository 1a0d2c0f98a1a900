"""What a hunt knows of kinds of design from before: their best, or that there is none."""

from __future__ import annotations

from cqdd_design.sizing.hunt import Answer, Hunt
from cqdd_design.sizing.spaces import FITS, Found, Space


def answered(hunt: Hunt, space: Space) -> tuple[bool, Found | None]:
    """Whether a kind's best is known from before, and that: what is asked of it has not changed.

    Where nothing was found, nothing will be for more, nor with more clearance.
    """
    now = hunt.extra_for(space.cam)
    for fit in FITS[: FITS.index(space.fit) + 1]:
        known = hunt.answered.get(space._replace(fit=fit))
        # What lost to another may be the best where that one turns out to be none.
        if known is None or known.fixed != hunt.fixed or known.gave_up:
            continue
        if known.found is None:
            if all(now.get(one, 1.0) >= less for one, less in known.extra.items()):
                return True, None
        elif fit == space.fit:
            return known.extra == now, known.found
    return False, None


def least_of(hunt: Hunt, space: Space) -> float:
    """Objective below which nothing of a kind was found, for no more than is asked now."""
    now = hunt.extra_for(space.cam)
    known = (
        hunt.answered.get(space._replace(fit=fit)) for fit in FITS[: FITS.index(space.fit) + 1]
    )
    return max(
        (
            one.least
            for one in known
            if one is not None
            and one.fixed == hunt.fixed
            and all(now.get(each, 1.0) >= less for each, less in one.extra.items())
        ),
        default=0.0,
    )


def note(
    hunt: Hunt, space: Space, found: Found | None, least: float, *, fine: bool = False
) -> None:
    """Remember what was found in a space, if anything, and below which objective nothing was."""
    hunt.answered[space] = Answer(hunt.fixed, hunt.extra_for(space.cam), found, fine, least)


def key_of(space: Space) -> Space:
    """A space whatever its rings and its fit."""
    return space.kind._replace(fit=FITS[0])


def own_of(hunt: Hunt, space: Space) -> list[Found]:
    """What was found before in a space, the best with each cam bearing."""
    return [one for key, one in hunt.known.items() if key.anywhere == key_of(space.anywhere)]


def near_by(hunt: Hunt, space: Space) -> Found | None:
    """The best that was found before with any cam bearing: of the space, else of any."""
    every = own_of(hunt, space) or hunt.known.values()
    return min(every, key=lambda one: one.worth, default=None)
