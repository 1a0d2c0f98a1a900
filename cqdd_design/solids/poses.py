"""Where bodies stand at a crank angle: rigid transforms of housing, shaft, carrier and discs.

A part is drawn in its own frame, *placed* once in the frame of the body it moves with, and the
body is *posed* by the crank angle. Transforms are 4 x 4 arrays, lengths in metres.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from cqdd_design.design import Design
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.disc import crank_phase

BodyKind = Literal["housing", "shaft", "carrier", "disc"]


@dataclass(frozen=True)
class Body:
    """A rigid body of the mechanism: the housing, the shaft, the carrier, or disc number `disc`."""

    kind: BodyKind
    disc: int = 0


HOUSING, SHAFT, CARRIER = Body("housing"), Body("shaft"), Body("carrier")


def transform(
    angle: float = 0.0,
    x: float = 0.0,
    y: float = 0.0,
    z: float = 0.0,
    *,
    turned_over: bool = False,
) -> FloatArray:
    """A transform (4, 4): turned over about the x axis if asked, turned about z, then moved.

    Parameters
    ----------
    angle : float
        About z, rad.
    x, y, z : float
        m.
    turned_over : bool
        Half a turn about the x axis comes first.
    """
    cosine, sine = math.cos(angle), math.sin(angle)
    side = -1.0 if turned_over else 1.0
    return np.array(
        [
            [cosine, -side * sine, 0.0, x],
            [sine, side * cosine, 0.0, y],
            [0.0, 0.0, side, z],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def body_pose(design: Design, body: Body, crank_angle: float) -> FloatArray:
    """Transform (4, 4) from a body's frame to the ring's at a crank angle (rad).

    Perfect parts without load, by :mod:`cqdd_design.geometry.kinematics`.
    """
    ratio = design.reducer.ratio
    if body.kind == "shaft":
        return transform(crank_angle)
    if body.kind == "carrier":
        return transform(float(kinematics.carrier_angle(ratio, crank_angle)))
    if body.kind == "disc":
        phase = crank_phase(design, body.disc)
        x, y = kinematics.disc_centre(design.reducer.eccentricity, crank_angle, phase)
        turned = kinematics.lobe_pattern_rotation(ratio, crank_angle, phase)
        return transform(float(turned), float(x), float(y))
    return transform()
