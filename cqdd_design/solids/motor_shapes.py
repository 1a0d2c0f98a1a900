"""Shapes of motor, bell and cover, and of the dowels round the ring.

Drawn in the frame of the body each belongs to, with heights as in `layout`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from cqdd_design.geometry.contours import ArcContour, Circle, PlanarPart
from cqdd_design.geometry.grooves import grooved_circle
from cqdd_design.solids.encoder_shapes import dish_plate
from cqdd_design.solids.features.holes import FittedHole
from cqdd_design.solids.features.kinds import Feature
from cqdd_design.solids.features.removal import drillings
from cqdd_design.solids.layers import (
    Annulus,
    Layer,
    Stack,
    circle,
    cylinder,
    reshaped,
    scalloped_circle,
    turned,
)
from cqdd_design.solids.layout import DowelLayout, Layout
from cqdd_design.solids.motor_layout import MotorLayout


def stator(motor: MotorLayout) -> Stack:
    """Laminations with their slots full, and the ends of the coils: one envelope."""
    lower = motor.stack_bottom - motor.coil
    upper = motor.stack_top + motor.coil
    inside = motor.slot_radius + 0.05 * (motor.stack_outer - motor.slot_radius)
    outside = motor.stack_outer - 0.05 * (motor.stack_outer - motor.slot_radius)
    return turned(
        [
            Annulus(lower, motor.stack_bottom, inside, outside),
            Annulus(motor.stack_bottom, motor.stack_top, motor.stack_inner, motor.stack_outer),
            Annulus(motor.stack_top, upper, inside, outside),
        ]
    )


def rotor(motor: MotorLayout) -> Stack:
    """Ring of magnets in its back iron: one envelope."""
    return turned(
        [Annulus(motor.ring_bottom, motor.ring_top, motor.rotor_inner, motor.rotor_outer)]
    )


def bell(motor: MotorLayout, stub_radius: float, features: Sequence[Feature]) -> Stack:
    """The rotor's carrier: sleeve round the ring, web with lightening holes, hub on the stub."""
    inner = motor.rotor_inner
    rings = [
        Annulus(motor.web_bottom, motor.web_top, stub_radius, motor.bell_radius),
        Annulus(motor.web_top, motor.ring_bottom, inner, motor.bell_radius),
        Annulus(motor.ring_bottom, motor.ring_top, motor.rotor_outer, motor.bell_radius),
        Annulus(motor.web_top, motor.hub_top, stub_radius, motor.hub_radius),
        Annulus(motor.hub_bottom, motor.web_bottom, stub_radius, motor.hub_radius),
    ]
    return turned([ring for ring in rings if ring.top - ring.bottom > 1e-9], drillings(features))


def with_motor_flange(
    housing_stack: Stack, layout: Layout, motor: MotorLayout, features: Sequence[Feature]
) -> Stack:
    """The housing with lip and skirt for the stator, and its flange grown over the motor.

    A rim under the flange centres the motor's cover.

    The features' holes outside the flange are in its ears and between them.
    """
    housing = layout.housing
    lip = motor.lip
    layers = list(housing_stack.layers)
    skirt = housing.bottom - motor.stack_bottom
    if skirt > 1e-9:
        tube = PlanarPart(
            "skirt",
            circle(housing.register_radius),
            (circle(housing.register_radius - 2.5 * layout.unit),),
        )
        layers.append(Layer(tube, motor.stack_bottom, housing.bottom))
    if motor.spigot:
        rim = PlanarPart("spigot", circle(motor.cover_inner), (circle(motor.spigot_inner),))
        bottom = housing.flange_bottom - motor.spigot
        layers.append(Layer(rim, bottom, housing.flange_bottom))
    grown = reshaped(
        Stack(tuple(layers)),
        motor.stack_top,
        housing.flange_bottom,
        lambda shape: (
            _with_outer(shape, circle(lip)) if _is_round(shape, housing.register_radius) else shape
        ),
    )
    ears = scalloped_circle(motor.cover_outer, motor.ear_angles, motor.ear_circle, motor.ear_radius)
    holes = _holes(features, housing.flange_radius)
    return reshaped(
        grown,
        housing.flange_bottom,
        motor.flange_top,
        lambda shape: (
            PlanarPart(shape.name, ears, (*shape.holes, *holes))
            if _is_round(shape, housing.flange_radius)
            else shape
        ),
    )


def _is_round(shape: PlanarPart, radius: float) -> bool:
    """Whether a layer ends in the circle of this radius; the floor's boss is a layer beside."""
    return isinstance(shape.outer, Circle) and abs(shape.outer.radius - radius) < 1e-9


def _holes(features: Sequence[Feature], beyond: float) -> list[Circle]:
    """Holes whose axes are farther from the part's than a radius (m)."""
    return [
        circle(drilling.radius, centre)
        for drilling in drillings(features)
        for centre in drilling.centres
        if math.hypot(*centre) > beyond
    ]


def _with_outer(shape: PlanarPart, outer: Circle | ArcContour) -> PlanarPart:
    return PlanarPart(shape.name, outer, shape.holes)


def motor_cover(
    motor: MotorLayout, flange_bottom: float, unit: float, features: Sequence[Feature]
) -> Stack:
    """The can over the bell: wall with ears, floor, and a dish for the encoder's board."""
    floor, wall = motor.cover_floor, motor.cover_wall
    dish = max(motor.board_radius, motor.hub_radius) + 1.0 * unit
    floor_bottom = floor - wall
    # The dish's plate, its wall up to the floor, the floor, and the can.
    dish_wall_bottom = min(motor.board_bottom, floor_bottom)
    rings = [
        *dish_plate(motor, unit, dish + wall),
        Annulus(dish_wall_bottom, floor_bottom, dish, dish + wall)
        if motor.board_bottom < floor_bottom
        else Annulus(0.0, 0.0, 0.0, 0.0),
        Annulus(max(floor_bottom, motor.board_bottom), floor, dish, motor.cover_outer),
        Annulus(floor, flange_bottom - motor.ear_height, motor.cover_inner, motor.cover_outer),
        Annulus(flange_bottom - motor.ear_height, flange_bottom, motor.cover_inner,
                motor.cover_outer),
    ]  # fmt: skip
    body = turned([ring for ring in rings if ring.top - ring.bottom > 1e-9], drillings(features))
    ears = scalloped_circle(motor.cover_outer, motor.ear_angles, motor.ear_circle, motor.ear_radius)
    holes = _holes(features, motor.cover_outer)
    return reshaped(
        body,
        flange_bottom - motor.ear_height,
        flange_bottom,
        lambda shape: PlanarPart(shape.name, ears, (*shape.holes, *holes)),
    )


def with_dowel_notches(ring: Stack, radius: float, holes: FittedHole) -> Stack:
    """The ring of an outside radius (m) with the half grooves of its dowels, cut all through it."""
    notched = grooved_circle(radius, holes.circle.angles, 0.5 * holes.diameter)
    return reshaped(ring, holes.bottom, holes.top, lambda shape: _with_outer(shape, notched))


def with_dowel_grooves(housing: Stack, radius: float, holes: FittedHole) -> Stack:
    """The housing with its halves of the dowels' holes, in a seat of a radius (m)."""
    circle = holes.circle
    grooved = scalloped_circle(radius, circle.angles, circle.radius, 0.5 * holes.diameter)

    def change(shape: PlanarPart) -> PlanarPart:
        changed = tuple(
            grooved if isinstance(hole, Circle) and abs(hole.radius - radius) < 1e-9 else hole
            for hole in shape.holes
        )
        return PlanarPart(shape.name, shape.outer, changed)

    return reshaped(housing, holes.bottom, holes.top, change)


def dowel(dowels: DowelLayout) -> Stack:
    """A ground dowel, standing on z = 0."""
    return Stack((cylinder(dowels.radius, 0.0, dowels.length),))
