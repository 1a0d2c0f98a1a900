"""The figures, as mass or stiffness, that fit where those that are asked for do not."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import NamedTuple

from cqdd_design.design import Requirements
from cqdd_design.design.tables import field_dimension
from cqdd_design.errors import InfeasibleError
from cqdd_design.gearbox.checks.guide import CHECK_GUIDE
from cqdd_design.geometry.limits import rounded_down, rounded_up
from cqdd_design.results import Check
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.infeasible import SizingInfeasibleError
from cqdd_design.sizing.refusals import FIGURES
from cqdd_design.sizing.verified import VerifiedDesign
from cqdd_design.units import parse_quantity

TRIES = 4
"""Searches for figures nearer to what is asked than those that fit."""
_GUIDES = {key: CHECK_GUIDE[line] for line, key in FIGURES.items()}
_AT_LEAST = {key for key, guide in _GUIDES.items() if guide.sense == "min"}
_LOOSE = 100.0
"""Factor of a requirement that hardly binds."""
_NEAR = 1.02
"""Factor within which nothing nearer is looked for."""

Figures = dict[str, float]
"""Requirements, in the units of their fields, by key."""
_Search = Callable[[Requirements], tuple[VerifiedDesign | None, InfeasibleError | None]]


class Looser(NamedTuple):
    """Figures with which a design is found, all else as asked.

    Attributes
    ----------
    figures : dict of str to float
        Empty where none is found.
    keys : tuple of str
        Requirements that were looked at.
    short : tuple of str
        Lines that are short however little is asked of them, where that was looked at.
    """

    figures: Figures
    keys: tuple[str, ...] = ()
    short: tuple[str, ...] = ()


def looser_figures(hunt: Hunt, refusal: SizingInfeasibleError, search: _Search) -> Looser:
    """Figures that fit where they alone are short, as near to what is asked as a few searches come.

    Tried first are those of the design that came nearest, then those of a search that asks for
    hardly any.

    Parameters
    ----------
    hunt : Hunt
        That was refused.
    search : callable
        For a design of other requirements, or why there is none.
    """
    asked = hunt.requirements
    keys = tuple(FIGURES[line] for line in refusal.binding if line in FIGURES)
    if not keys or any(line not in FIGURES and line != "YIELD" for line in refusal.binding):
        return Looser({})
    hunt.say("looking for the figures that fit")
    too_much = {key: getattr(asked, key) for key in keys}
    shares = _shares(refusal.short)
    if too_much.keys() <= shares.keys():
        nearest = {key: _told(key, shares[key] * most) for key, most in too_much.items()}
        found, _ = search(asked.unchecked_copy(nearest))
        if found is not None:
            figures = _nearer(asked, nearest, found, too_much, search)
            return Looser(figures, tuple(figures))
    loose = {key: _eased(key, most, _LOOSE) for key, most in too_much.items()}
    found, error = search(asked.unchecked_copy(loose))
    if found is None:
        lines = error.binding if isinstance(error, SizingInfeasibleError) else ()
        return Looser({}, keys, lines)
    fits = _of(found, loose)
    found, _ = search(asked.unchecked_copy(fits))
    if found is None:
        return Looser({}, keys)
    figures = _nearer(asked, fits, found, too_much, search)
    return Looser(figures, tuple(figures))


def _nearer(
    asked: Requirements,
    fits: Figures,
    found: VerifiedDesign,
    too_much: Figures,
    search: _Search,
) -> Figures:
    """Figures with which a design is found, and with little more none, in a few searches."""
    has = _of(found, fits)
    held: set[str] = set()
    for _ in range(TRIES):
        steps = {key: _between(key, fits[key], has[key], most) for key, most in too_much.items()}
        changed = {key for key, step in steps.items() if step != fits[key]}
        if not changed:
            break
        # What nothing changes does not keep the other figures away.
        changed -= held if changed - held else set()
        figures = fits | {key: steps[key] for key in changed}
        more, error = search(asked.unchecked_copy(figures))
        if more is not None:
            fits, has = figures, _of(more, figures)
            continue
        lines = error.binding if isinstance(error, SizingInfeasibleError) else ()
        short = {FIGURES[line] for line in lines if line in FIGURES} & changed
        held |= short if changed - short else set()
        too_much = too_much | {key: steps[key] for key in short or changed}
        has = fits
    return fits


def _of(found: VerifiedDesign, stated: Figures) -> Figures:
    """What a design has of the figures that were asked of it, or as they were asked."""
    lines = [line for line in found.verdict.lines if FIGURES.get(line.id) in stated]
    return stated | {key: _told(key, share * stated[key]) for key, share in _shares(lines).items()}


def _shares(lines: Iterable[Check]) -> Figures:
    """Of every figure of some lines: its value over what is asked, by the requirement's key."""
    return {
        FIGURES[line.id]: line.value / line.limit
        for line in lines
        if line.id in FIGURES and line.value and line.limit
    }


def _between(key: str, fits: float, has: float, too_much: float) -> float:
    """A figure between one that fits and one that is too much; the former where they are close.

    What the design that fits has of it, where that is more than was asked of it.
    """
    if _ratio(key, fits, too_much) <= _NEAR:
        return fits
    if _ratio(key, fits, has) > _NEAR and _ratio(key, has, too_much) > 1.0:
        return has
    middle = _told(key, math.sqrt(fits * too_much))
    return middle if _ratio(key, fits, middle) > 1.0 else fits


def _ratio(key: str, one: float, other: float) -> float:
    """How much nearer the other is to what is asked, as a factor."""
    return other / one if key in _AT_LEAST else one / other


def _eased(key: str, value: float, factor: float) -> float:
    return value / factor if key in _AT_LEAST else value * factor


def _told(key: str, value: float) -> float:
    """A figure rounded away from what is asked, in the unit that it is told in."""
    rounded = rounded_down if key in _AT_LEAST else rounded_up
    return rounded(value / unit_of(key)) * unit_of(key)


def unit_of(key: str) -> float:
    """The unit that a figure is told in, over that of its field."""
    dimension = field_dimension(Requirements.model_fields[key])
    return 1.0 if dimension is None else parse_quantity(f"1 {_GUIDES[key].unit}", dimension)


def in_words(figures: Figures) -> dict[str, str]:
    """Figures as a file has them."""
    return {
        key: f"{value / unit_of(key):.6g} {_GUIDES[key].unit}".rstrip()
        for key, value in figures.items()
    }
