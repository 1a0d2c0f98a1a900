"""Needles inside a bearing, from its size."""

from __future__ import annotations

import math
from dataclasses import dataclass

#: Pitch of needles in their cage, in needle diameters: a full cage holds a needle every 1.6 to
#: 1.9 diameters; the wide end of that is taken, so that no maker's bearing carries less.
NEEDLE_PITCH = 1.9

#: What lips and cage take of the width, m: the needle is that much shorter than the bearing.
DRAWN_CUP_LOSS = 3.2e-3
CAGE_LOSS = 2.2e-3


@dataclass(frozen=True)
class NeedleSet:
    """Needles inside a bearing: diameter, effective length and pitch diameter (m), count."""

    diameter: float
    length: float
    count: int
    pitch_diameter: float
    drawn_cup: bool


def needle_set(
    bore_diameter: float, outer_diameter: float, width: float, *, drawn_cup: bool
) -> NeedleSet:
    """The needles that fit a bearing of the given size (all in m).

    A drawn cup has walls of 1 mm; a bare cage is as thick as its needles.
    """
    wall = 1e-3 if drawn_cup else 0.0
    diameter = 0.5 * (outer_diameter - bore_diameter) - wall
    pitch = bore_diameter + diameter
    count = int(math.pi * pitch / (NEEDLE_PITCH * diameter))
    loss = DRAWN_CUP_LOSS if drawn_cup else CAGE_LOSS
    return NeedleSet(diameter, width - loss, count, pitch, drawn_cup)
