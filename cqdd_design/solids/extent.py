"""How large a machine is over everything."""

from __future__ import annotations

import math
from collections.abc import Sequence

from cqdd_design.solids.part import Part


def overall_size(parts: Sequence[Part]) -> tuple[float, float]:
    """Largest diameter and length over all pieces where they are placed, m."""
    pieces = [(part, piece) for part in parts for piece in part.instances]
    ends = [
        piece.placement[2, 3] + (end if piece.placement[2, 2] > 0.0 else -end)
        for part, piece in pieces
        for end in (part.shape.bottom, part.shape.top)
    ]
    reach = max(
        math.hypot(*piece.placement[:2, 3]) + part.shape.outside_radius for part, piece in pieces
    )
    return 2.0 * reach, max(ends) - min(ends)
