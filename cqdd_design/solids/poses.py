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
from cqdd_design.geometry.contours import FloatArray

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


def crank_phase(design: Design, disc: int) -> float:
    """Crank phase 2 pi d/D of disc d, rad."""
    return 2.0 * math.pi * disc / design.reducer.disc_count


def body_pose(design: Design, body: Body, crank_angle: float) -> FloatArray:
    """Transform (4, 4) from a body's frame to the ring's at a crank angle (rad).

    Perfect parts without load: the carrier stands at -phi/n; disc d, of crank phase p, has its
    centre at e (cos(phi + p), sin(phi + p)) and its lobes turned by -(phi + p)/n.
    """
    ratio = design.reducer.ratio
    if body.kind == "shaft":
        return transform(crank_angle)
    if body.kind == "carrier":
        return transform(-crank_angle / ratio)
    if body.kind == "disc":
        turned = crank_angle + crank_phase(design, body.disc)
        e = design.reducer.eccentricity
        return transform(-turned / ratio, e * math.cos(turned), e * math.sin(turned))
    return transform()
