"""Shapes of the encoder, of the dish that carries it, and of its seat in the shaft."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cqdd_design.geometry.contours import ArcContour, PlanarPart
from cqdd_design.solids.encoder_rules import FROM_EDGE, SENSOR_SIDE
from cqdd_design.solids.features.kinds import Feature
from cqdd_design.solids.features.motor import dish_bottom
from cqdd_design.solids.features.removal import drillings
from cqdd_design.solids.layers import Annulus, Layer, Stack, circle, prism, reshaped, turned
from cqdd_design.solids.motor_layout import MotorEnd


def encoder_magnet(motor: MotorEnd) -> Stack:
    """Diametric magnet in the end of the shaft or round it, standing on z = 0."""
    holes = (circle(motor.magnet_inner),) if motor.open else ()
    return prism(PlanarPart("magnet", circle(motor.magnet_radius), holes), 0.0, motor.magnet_height)


def encoder_board(motor: MotorEnd, features: Sequence[Feature]) -> Stack:
    """Round board; the sensor's package stands over its middle, or beside its hole."""
    half = 0.5 * SENSOR_SIDE
    corners = np.array([[half, -half], [half, half], [-half, half], [-half, -half]])
    if motor.open:
        # Between two of the screws.
        corners[:, 0] -= motor.board_inner + FROM_EDGE + half
    board = turned(
        [Annulus(motor.board_bottom, motor.board_top, motor.board_inner, motor.board_radius)],
        drillings(features),
    )
    package = PlanarPart("sensor", ArcContour(corners, np.zeros(4)))
    return Stack((*board.layers, Layer(package, motor.board_top, motor.sensor_top)))


def dish_plate(motor: MotorEnd, unit: float, outside: float) -> list[Annulus]:
    """The plate under the board, up to an outside radius (m), open where the shaft is."""
    bottom = dish_bottom(motor, unit)
    if not motor.open:
        return [Annulus(bottom, motor.board_bottom, 0.0, outside)]
    return [
        Annulus(bottom, motor.seat_bottom, motor.way, outside),
        Annulus(motor.seat_bottom, motor.board_bottom, motor.board_inner, outside),
    ]


def with_magnet_pocket(shaft: Stack, motor: MotorEnd) -> Stack:
    """The shaft with a pocket for the magnet in its lower end, where the magnet is inside."""
    if motor.open or motor.magnet_bottom < shaft.bottom - 1e-9:
        return shaft

    def pocketed(shape: PlanarPart) -> PlanarPart:
        return PlanarPart(shape.name, shape.outer, (circle(motor.magnet_radius),))

    return reshaped(shaft, shaft.bottom, shaft.bottom + motor.magnet_height, pocketed)
