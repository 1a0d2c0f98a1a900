"""Parts of an inrunner behind the gearbox: stator, rotor, its hub, the cover, and the encoder."""

from __future__ import annotations

from cqdd_design.catalog.adhesives import ROTOR_COMPOUND
from cqdd_design.catalog.motors import Motor
from cqdd_design.design import Design
from cqdd_design.solids import inrunner_shapes
from cqdd_design.solids.features.inrunner import can_features, hub_features
from cqdd_design.solids.inertia import HUB
from cqdd_design.solids.layout import Layout
from cqdd_design.solids.motor_layout import InrunnerLayout
from cqdd_design.solids.motor_parts import (
    LEAST_STATOR,
    encoder_parts,
    magnetic_circuit,
    motor_cover_part,
    piece,
    screws_below,
)
from cqdd_design.solids.motor_rules import bell_material
from cqdd_design.solids.part import Colour, Part
from cqdd_design.solids.poses import SHAFT

_ROTOR_SHARE = 0.3
"""Of a motor's mass: a rotor of unknown inertia."""
_HUB: Colour = (0.62, 0.65, 0.70)


def inrunner_parts(design: Design, layout: Layout, fastener: str) -> list[Part]:
    """Every part of an inrunner's end; none when there is none.

    Parameters
    ----------
    fastener : str
        Material of screws.
    """
    motor = layout.inrunner
    if motor is None:
        return []
    row, metal, unit = layout.motor_row, design.housing.material, layout.unit
    stub = 0.5 * layout.shaft.support.bearing.bore_diameter
    on_hub, on_cover = hub_features(motor, stub), can_features(motor, unit)
    cover = inrunner_shapes.cover(motor, unit, on_cover)
    rotor = _rotor_mass(row, motor)
    return [
        *magnetic_circuit(row, inrunner_shapes.stator(motor), inrunner_shapes.rotor(motor),
                          (row.mass or 0.0) - rotor, rotor),
        piece(
            HUB, inrunner_shapes.hub(motor, stub), bell_material(design), _HUB,
            f"hub of the motor's rotor, turned, bonded on the shaft and in the rotor with "
            f"{ROTOR_COMPOUND.name}",
            body=SHAFT, make=True, features=on_hub,
        ),
        motor_cover_part(cover, metal, on_cover),
        *encoder_parts(design, motor, fastener),
        screws_below(motor, fastener),
    ]  # fmt: skip


def _rotor_mass(row: Motor, motor: InrunnerLayout) -> float:
    """Of magnets and back iron, kg: what gives them the catalogue's inertia."""
    whole = row.mass or 0.0
    if row.rotor_inertia is None:
        return row.rotor_mass or _ROTOR_SHARE * whole
    square = 0.5 * (motor.rotor_inner**2 + motor.rotor_outer**2)
    return min(row.rotor_inertia / square, (1.0 - LEAST_STATOR) * whole)
