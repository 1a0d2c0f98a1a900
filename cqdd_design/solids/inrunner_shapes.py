"""Shapes of an inrunner behind the gearbox: stator, rotor and its hub, cover.

Drawn in the frame of the body each belongs to, with heights as in `motor_layout`.
"""

from __future__ import annotations

from collections.abc import Sequence

from cqdd_design.solids.features.kinds import Feature
from cqdd_design.solids.flanged_can import flanged_can
from cqdd_design.solids.layers import Annulus, Stack, turned
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
    step = Annulus(motor.cover_floor, motor.stack_bottom, motor.ledge, motor.cover_outer)
    return flanged_can(motor, unit, features, [step])
