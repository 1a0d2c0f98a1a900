"""A stepped shaft on two knife edges, pushed by the discs: deflection and slope at every disc.

By unit loads (Timoshenko 1955). With the bending moment M and the shearing force V of a force at
disc e, and m and v of a unit force, or of a unit couple, at disc d::

    deflection_de = integral of  M m/(E I) + V v/(G A/k)  over the span    (m, v of the force)
    rotation_de   = the same                                               (m, v of the couple)

Between steps of the section and forces the integrand is a polynomial of second degree, for which
two points of Gauss are exact. Forces may be complex, x + i y: a round shaft bends alike both ways.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from cqdd_design.geometry.contours import FloatArray

_GAUSS = 0.5 / np.sqrt(3.0)


class ShaftSection(NamedTuple):
    """A length of shaft of one section."""

    bottom: float
    """Height of its lower end, m."""
    top: float
    """And of its upper end."""
    bending: float
    """E I, N m^2."""
    shear: float
    """G A/k, N; infinite for a beam without shear."""


@dataclass(frozen=True, eq=False)
class ShaftBeam:
    """A shaft between knife edges under forces at D discs.

    Attributes
    ----------
    span : float
        From edge to edge, m.
    on_upper : array (D,)
        Share of every disc's force that the upper edge bears.
    deflection : array (D, D)
        At disc d, along a unit force of disc e, m/N.
    rotation : array (D, D)
        Turn of the section there, positive where the deflection grows upward, rad/N.
    """

    span: float
    on_upper: FloatArray
    deflection: FloatArray
    rotation: FloatArray


def shaft_beam(
    sections: Sequence[ShaftSection], edges: tuple[float, float], at: FloatArray
) -> ShaftBeam:
    """A stepped shaft on two knife edges.

    Parameters
    ----------
    sections : sequence of ShaftSection
        They cover the span; what stands out beyond the edges is not loaded.
    edges : pair of float
        Heights of the lower and the upper edge, m.
    at : array (D,)
        Heights of the forces between them, m.

    Examples
    --------
    A steel shaft of 10 mm, 100 mm long, with 100 N in the middle sinks by F L^3/(48 E I):

    >>> bending = 205e9 * np.pi / 64.0 * 10e-3**4
    >>> shaft = [ShaftSection(0.0, 0.1, bending, np.inf)]
    >>> beam = shaft_beam(shaft, (0.0, 0.1), np.array([0.05]))
    >>> round(1e6 * 100.0 * float(beam.deflection[0, 0]), 2)
    20.7
    >>> round(1e6 * 100.0 * 0.1**3 / (48.0 * bending), 2)
    20.7
    """
    low, high = edges
    span, place = high - low, np.asarray(at, dtype=float) - low
    steps = [low, high, *at, *(end for one in sections for end in (one.bottom, one.top))]
    ends = np.unique(np.clip(steps, low, high)) - low
    middle, length = 0.5 * (ends[1:] + ends[:-1]), np.diff(ends)
    inside = [next(s for s in sections if s.bottom <= x + low <= s.top) for x in middle]
    x = np.concatenate([middle - _GAUSS * length, middle + _GAUSS * length])
    weight = 0.5 * np.tile(length, 2)
    bent = weight / np.tile([one.bending for one in inside], 2)
    sheared = weight / np.tile([one.shear for one in inside], 2)

    share, beyond = (place / span)[:, None], x > place[:, None]
    moment = np.where(beyond, share * (span - x), (1.0 - share) * x)
    force = np.where(beyond, -share, 1.0 - share)
    # A couple is two opposite forces side by side: what a force makes, differentiated by its place.
    couple_moment = np.where(beyond, 1.0, 0.0) - x / span
    couple_force = np.full_like(force, -1.0 / span)
    return ShaftBeam(
        span=span,
        on_upper=place / span,
        deflection=(bent * moment) @ moment.T + (sheared * force) @ force.T,
        rotation=(bent * couple_moment) @ moment.T + (sheared * couple_force) @ force.T,
    )


def edge_load_factor(closing: float, approach: float) -> float:
    """Greatest load of a line contact that is closed unevenly along its length, over its mean.

    Parameters
    ----------
    closing : float
        Difference in closing from end to end, m.
    approach : float
        Of the same contact with the same force, closed evenly, m.

    Notes
    -----
    An even elastic bed: 1 + s/(2 delta) while it touches all along, sqrt(2 s/delta) once one end
    is clear, from s = 2 delta on (the face load factor of ISO 6336-1).

    Examples
    --------
    >>> edge_load_factor(1e-6, 1e-6), edge_load_factor(8e-6, 1e-6)
    (1.5, 4.0)
    """
    ratio = closing / approach
    return 1.0 + 0.5 * ratio if ratio <= 2.0 else float(np.sqrt(2.0 * ratio))
