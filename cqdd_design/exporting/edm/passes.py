"""Passes of the wire: a rough cut and skim cuts, each with an offset of its own, and their time.

::

    pass        takes off the wall      leaves for the next
    rough       the kerf                all of the skim cuts'
    skim 1      50 um                   15 + 5 um
    skim 2      15 um                   5 um
    skim 3      5 um                    nothing: offset is wire/2 + gap

Source of what skim cuts take, which lies in the range of each: Tongren, "How does multi-pass
cutting affect final wire EDM accuracy" (semi-finish 0.05 to 0.13 mm, skim 13 to 25 um, finish skim
2.5 to 13 um a side; three passes and more for +-3 um).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.exporting.edm.wire_path import WirePath, segmented
from cqdd_design.geometry.contours import Contour

if TYPE_CHECKING:
    from cqdd_design.design.actuator import Edm
    from cqdd_design.exporting.edm.flat_parts import FlatPart

SKIMS = (50e-6, 15e-6, 5e-6)
"""Taken off a wall by the skim cuts, m: of fewer passes the first ones, of one none."""
ROUGH_RATE = 100e-6 / 60.0
"""Of a rough cut, wall a second, m^2/s: 100 mm^2 a minute. Assumed, for 0.25 mm brass wire in
hardened steel on an everyday machine."""
SKIM_SPEED = 6e-3 / 60.0
"""Along the contour of a skim cut, m/s: 6 mm a minute whatever the thickness. Assumed."""
THREADING_TIME = 60.0
"""To thread and to cut the wire at every start hole, s. Assumed."""
BORDER = 8e-3
"""Of the blank outside what is cut of it, on every side, to clamp, m."""
_SPARE = 0.9
"""Of the tightest arc's room that a rough cut takes at most."""


@dataclass(frozen=True)
class WirePass:
    """One pass along a contour.

    Attributes
    ----------
    number : int
        From 1; the rough cut first.
    offset : float
        From the nominal contour to the wire's centre, m.
    left : float
        On the wall for the passes after it, m.
    """

    number: int
    offset: float
    left: float

    @property
    def name(self) -> str:
        """Such as ``ROUGH`` or ``SKIM 2``."""
        return "ROUGH" if self.number == 1 else f"SKIM {self.number - 1}"


def wire_passes(contours: Iterable[Contour], edm: Edm, count: int) -> tuple[WirePass, ...]:
    """The passes of a part.

    Where a contour has an arc that the wire of the rough cut could not follow, skim cuts take
    less, all in proportion.

    Parameters
    ----------
    contours : iterable of Contour
        Of the part.
    count : int
        1 to one more than there are skim cuts.
    """
    every = list(contours)
    room = min(_room(contour, edm, outer=contour is every[0]) for contour in every)
    skims = SKIMS[: count - 1]
    scale = min(1.0, _SPARE * max(room, 0.0) / sum(skims)) if skims else 1.0
    left = [scale * sum(skims[k:]) for k in range(count)]
    return tuple(
        WirePass(number, edm.wire_offset + spare, spare) for number, spare in enumerate(left, 1)
    )


def _room(contour: Contour, edm: Edm, *, outer: bool) -> float:
    """Radius of the tightest arc that the wire runs inside of, over the finishing offset, m."""
    arcs = segmented(contour)
    inside = arcs.bulges < 0.0 if outer else arcs.bulges > 0.0
    if not inside.any():
        return float("inf")
    return float(arcs.arcs().radii[inside].min()) - edm.wire_offset


def cutting_time(length: float, thickness: float, passes: int) -> float:
    """Estimate of all passes along a contour of a length, s: threading and cutting of the wire too.

    Parameters
    ----------
    length, thickness : float
        m.

    Examples
    --------
    >>> round(cutting_time(0.2, 10e-3, 4) / 60.0)
    121
    """
    rough = length * thickness / ROUGH_RATE
    return THREADING_TIME + rough + (passes - 1) * length / SKIM_SPEED


def contour_times(flat: FlatPart, passes: int) -> tuple[float, ...]:
    """Estimate for every contour of a part, the outer one first, s."""
    return tuple(cutting_time(one.length(), flat.thickness, passes) for one in flat.contours)


def cut_radius(outer: WirePath) -> float:
    """How far from the part's axis the start hole and the cut round the part reach, m.

    The rough cut stands off by what skim cuts take, and is as wide again on its other side.
    """
    hole = abs(outer.start) + 0.5 * outer.start_diameter
    kerf = float(np.abs(outer.contour.points @ [1.0, 1.0j]).max()) + outer.offset + sum(SKIMS)
    return max(hole, kerf)


def blank_side(outer: WirePath) -> float:
    """Side of the square blank of a part, m: all that is cut is inside, and a border to clamp."""
    return 2.0 * (cut_radius(outer) + BORDER)


def minutes(seconds: float) -> str:
    """Such as ``2 H 01 MIN``."""
    whole = int(np.ceil(seconds / 60.0))
    hours, rest = divmod(whole, 60)
    return f"{hours} H {rest:02d} MIN" if hours else f"{rest} MIN"
