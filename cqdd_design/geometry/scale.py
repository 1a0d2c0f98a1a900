"""How walls and gaps grow with the machine, and the rings that go into a stator's bore."""

from __future__ import annotations

_REFERENCE_RING = 72e-3
_SCALE_RANGE = (0.4, 4.0)
_DIGITS, _DRAWN_DIGITS = 9, 5
MOST_TUBE_WALL = 12.0
"""Thickest tube, in units, that is filled up to the bore of a stator."""


class Unit(float):
    """A millimetre at the scale of a machine, m.

    So many of it are a length as sheets tell it, in whole hundredths of a millimetre.

    Examples
    --------
    >>> unit = Unit(0.77e-3)
    >>> print(3.2 * unit, 1.0 * unit)
    0.00246 0.00077
    """

    def __mul__(self, count: float, /) -> float:
        """So many of it, as drawn."""
        return round(float(self) * count, _DRAWN_DIGITS)

    __rmul__ = __mul__


def millimetre_unit(ring_outer_diameter: float) -> float:
    """A millimetre at the scale of this ring, m: walls and gaps grow with the machine."""
    least, most = _SCALE_RANGE
    return 1e-3 * min(max(ring_outer_diameter / _REFERENCE_RING, least), most)


def largest_ring(bore: float) -> float:
    """Outside diameter of the largest ring that leaves its housing a wall of a unit in a bore, m.

    Examples
    --------
    >>> largest_ring(74e-3)
    0.072
    """
    return _ring_with_wall(bore, 1.0)


def smallest_ring(bore: float) -> float:
    """Outside diameter of the smallest ring round which a tube fills the bore, m."""
    return _ring_with_wall(bore, MOST_TUBE_WALL)


def ring_within_rotor(bore: float) -> float:
    """Outside diameter of the largest ring whose housing goes into an inrunner's rotor, m.

    Beside the housing's wall of a unit stand a gap as wide and a sleeve of two under the rotor.

    Examples
    --------
    >>> round(1e3 * ring_within_rotor(45e-3), 1)
    40.5
    """
    return _ring_with_wall(bore, 4.0)


def _ring_with_wall(bore: float, units: float) -> float:
    within = bore / (1.0 + 2e-3 * units / _REFERENCE_RING)
    return round(bore - 2.0 * units * millimetre_unit(within), _DIGITS)
