"""A motor's can whose flange is screwed under one at the end of the housing's tube.

Both flanges have the same ears. Heads lie under the can's, threads are in the housing's, whose rim
centres the can.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from cqdd_design.geometry.contours import ArcContour, Circle, PlanarPart
from cqdd_design.solids.encoder_shapes import dish_plate
from cqdd_design.solids.features.kinds import Feature
from cqdd_design.solids.features.removal import drillings
from cqdd_design.solids.layers import (
    Annulus,
    Layer,
    Stack,
    circle,
    reshaped,
    scalloped_circle,
    turned,
)
from cqdd_design.solids.motor_layout import MotorEnd


def flanged_can(
    motor: MotorEnd, unit: float, features: Sequence[Feature], steps: Sequence[Annulus] = ()
) -> Stack:
    """Flange with ears, wall, floor, and a dish for the encoder's board.

    Parameters
    ----------
    unit : float
        A millimetre at the scale of this machine, m.
    steps : sequence of Annulus
        From the floor up, where the wall is thicker than above.
    """
    floor, wall, outside = motor.cover_floor, motor.cover_wall, motor.cover_outer
    dish = max(motor.board_radius, motor.hub_radius) + 1.0 * unit
    under = floor - wall
    ears = motor.joint - motor.ear_height
    thin = max((step.top for step in steps), default=floor)
    rings = [
        *dish_plate(motor, unit, dish + wall),
        Annulus(min(motor.board_bottom, under), under, dish, dish + wall),
        Annulus(max(under, motor.board_bottom), floor, dish, outside),
        *steps,
        Annulus(thin, ears, motor.cover_inner, outside),
        Annulus(ears, motor.joint, motor.cover_inner, outside),
    ]
    body = turned([ring for ring in rings if ring.top - ring.bottom > 1e-9], drillings(features))
    outline = _ears(motor)
    holes = _holes(features, ears, motor.joint, beyond=outside)
    return reshaped(
        body,
        ears,
        motor.joint,
        lambda shape: PlanarPart(shape.name, outline, (*shape.holes, *holes)),
    )


def with_flange(
    housing: Stack, register: float, motor: MotorEnd, features: Sequence[Feature]
) -> Stack:
    """The housing with a flange round the end of its tube (outside radius, m), and a rim below."""
    rim = PlanarPart("spigot", circle(motor.cover_inner), (circle(motor.spigot_inner),))
    whole = Stack((*housing.layers, Layer(rim, motor.joint - motor.spigot, motor.joint)))
    outline, top = _ears(motor), motor.joint + motor.flange
    holes = _holes(features, motor.joint, top, beyond=register)

    def grown(shape: PlanarPart) -> PlanarPart:
        if not (isinstance(shape.outer, Circle) and abs(shape.outer.radius - register) < 1e-9):
            return shape
        return PlanarPart(shape.name, outline, (*shape.holes, *holes))

    return reshaped(whole, motor.joint, top, grown)


def _ears(motor: MotorEnd) -> ArcContour:
    return scalloped_circle(motor.body, motor.ear_angles, motor.ear_circle, motor.ear_radius)


def _holes(
    features: Sequence[Feature], bottom: float, top: float, *, beyond: float
) -> list[Circle]:
    """Holes at a height whose axes are farther from the part's than a radius; m."""
    middle = 0.5 * (bottom + top)
    return [
        circle(drilling.radius, centre)
        for drilling in drillings(features)
        if drilling.bottom < middle < drilling.top
        for centre in drilling.centres
        if math.hypot(*centre) > beyond
    ]
