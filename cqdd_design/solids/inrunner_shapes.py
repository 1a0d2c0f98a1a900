"""Shapes of an inrunner behind the gearbox: stator, rotor and its hub, cover, housing's flange.

Drawn in the frame of the body each belongs to, with heights as in `motor_layout`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from cqdd_design.geometry.contours import ArcContour, Circle, PlanarPart
from cqdd_design.solids.features.kinds import Feature
from cqdd_design.solids.features.motor import dish_bottom
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
from cqdd_design.solids.motor_layout import InrunnerLayout


def stator(motor: InrunnerLayout) -> Stack:
    """Laminations with their slots full, and the ends of the coils: one envelope."""
    lower, upper = motor.stack_bottom - motor.coil, motor.stack_top + motor.coil
    rings = [
        Annulus(lower, motor.stack_bottom, motor.coil_inner, motor.coil_outer),
        Annulus(motor.stack_bottom, motor.stack_top, motor.stack_inner, motor.stack_outer),
        Annulus(motor.stack_top, upper, motor.coil_inner, motor.coil_outer),
    ]
    return turned([ring for ring in rings if ring.top - ring.bottom > 1e-9])


def rotor(motor: InrunnerLayout) -> Stack:
    """Ring of magnets on its back iron: one envelope."""
    return turned(
        [Annulus(motor.ring_bottom, motor.ring_top, motor.rotor_inner, motor.rotor_outer)]
    )


def hub(motor: InrunnerLayout, stub_radius: float) -> Stack:
    """The rotor's carrier: hub on the stub, web, sleeve under the rotor with a lip at its end."""
    rings = [
        Annulus(motor.hub_bottom, motor.hub_top, stub_radius, motor.hub_radius),
        Annulus(motor.lip_bottom, motor.web_top, motor.hub_radius, motor.sleeve_inner),
        Annulus(motor.lip_bottom, motor.ring_bottom, motor.sleeve_inner, motor.lip_radius),
        Annulus(motor.ring_bottom, motor.ring_top, motor.sleeve_inner, motor.rotor_inner),
    ]
    return turned([one for one in rings if min(one.top - one.bottom, one.outer - one.inner) > 1e-9])


def cover(motor: InrunnerLayout, unit: float, features: Sequence[Feature]) -> Stack:
    """The can: flange with ears, the stator's seat and its step, floor, and a dish for the board.

    Parameters
    ----------
    unit : float
        A millimetre at the scale of this machine, m.
    """
    floor, wall, outside = motor.cover_floor, motor.cover_wall, motor.cover_outer
    dish = max(motor.board_radius, motor.hub_radius) + 1.0 * unit
    under = floor - wall
    ears = motor.joint - motor.ear_height
    rings = [
        Annulus(dish_bottom(motor, unit), motor.board_bottom, 0.0, dish + wall),
        Annulus(min(motor.board_bottom, under), under, dish, dish + wall),
        Annulus(max(under, motor.board_bottom), floor, dish, outside),
        Annulus(floor, motor.stack_bottom, motor.ledge, outside),
        Annulus(motor.stack_bottom, ears, motor.cover_inner, outside),
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
    housing: Stack, register: float, motor: InrunnerLayout, features: Sequence[Feature]
) -> Stack:
    """The housing with a flange round the end of its tube (outside radius, m), and a rim below."""
    rim = PlanarPart("spigot", circle(motor.stack_outer), (circle(motor.spigot_inner),))
    whole = Stack((*housing.layers, Layer(rim, motor.joint - motor.spigot, motor.joint)))
    outline, top = _ears(motor), motor.joint + motor.flange
    holes = _holes(features, motor.joint, top, beyond=register)

    def grown(shape: PlanarPart) -> PlanarPart:
        if not (isinstance(shape.outer, Circle) and abs(shape.outer.radius - register) < 1e-9):
            return shape
        return PlanarPart(shape.name, outline, (*shape.holes, *holes))

    return reshaped(whole, motor.joint, top, grown)


def _ears(motor: InrunnerLayout) -> ArcContour:
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
