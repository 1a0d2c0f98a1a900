"""Shapes of an outrunner behind the gearbox that differ from those of one round its tube."""

from __future__ import annotations

from collections.abc import Sequence

from cqdd_design.geometry.contours import PlanarPart
from cqdd_design.solids.features.kinds import Feature
from cqdd_design.solids.flanged_can import with_flange
from cqdd_design.solids.layers import Layer, Stack, circle
from cqdd_design.solids.motor_layout import MotorLayout


def with_neck(
    housing: Stack, register: float, motor: MotorLayout, features: Sequence[Feature]
) -> Stack:
    """The housing with a flange round the end of its tube (outside radius, m), and a neck below.

    The stator sits on the neck, against its step.
    """
    bore = (circle(motor.neck_inner),)
    step, seat = (
        PlanarPart(name, circle(radius), bore)
        for name, radius in (("neck", motor.lip), ("register", motor.stack_inner))
    )
    flanged = with_flange(housing, register, motor, features)
    neck = (
        Layer(step, motor.stack_top, motor.joint),
        Layer(seat, motor.stack_bottom, motor.stack_top),
    )
    return Stack((*flanged.layers, *neck))
