"""Where a section through the machine runs, and which parts are hatched in it.

The section is an aligned one: two half planes meet on the axis. The right one runs along the crank
and through the first pin of the carrier, at the crank angle at which the two are in line; the left
one through the fastener of the housing nearest to the opposite side.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from cqdd_design.design import Design
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.kinematics import crank_meets_carrier
from cqdd_design.solids.stations import Station


def cut_angles(design: Design, found: Sequence[Station]) -> tuple[float, float]:
    """Directions of the right and the left half plane, rad; the first is the crank angle too."""
    pins = [s for s in found if s.body.kind == "carrier" and s.off_axis]
    first = _direction(pins[0].pieces[0].placement) if pins else 0.0
    right = crank_meets_carrier(design.reducer.ratio, first)
    fixed_rows = [s for s in found if s.body.kind == "housing" and s.off_axis and s.spans]
    opposite = right + math.pi
    if not fixed_rows:
        return right, opposite
    row = max(fixed_rows, key=lambda s: (s.outer, s.number))
    angles = [_direction(piece.placement) for piece in row.pieces]
    turns = [math.remainder(angle - opposite, 2.0 * math.pi) for angle in angles]
    nearest = min(turns, key=lambda turn: (round(abs(turn), 9), turn))
    return right, opposite + (nearest if abs(nearest) < 0.25 * math.pi else 0.0)


def _direction(placement: FloatArray) -> float:
    return math.atan2(float(placement[1, 3]), float(placement[0, 3]))


def is_hatched(station: Station) -> bool:
    """Whether drawing practice hatches a cut part: not bearings, shafts, pins and fasteners."""
    part = station.part
    if part.inner_body is not None or station.off_axis:
        return False
    slender = station.top - station.bottom > 2.0 * station.outer
    return not (station.body.kind == "shaft" and slender)
