"""Conductances between a motor behind the gearbox, its cover and the housing, and the outside.

An inrunner's heat leaves through its seat into the cover, which stands in the air and joins the
housing at their flanges; an outrunner's goes up its neck. Faces that screws press together count as
one piece.
"""

from __future__ import annotations

import math

from cqdd_design.catalog.materials import Material
from cqdd_design.errors import DesignError
from cqdd_design.gearbox.heat import joints
from cqdd_design.gearbox.heat.surfaces import Surface, annulus_conductance
from cqdd_design.machine.heat_nodes import (
    AIR,
    LEAST_AIR_GAP,
    NODES,
    SLOTS_PER_PAIR,
    Node,
    known,
    series,
)
from cqdd_design.machine.machine import Machine
from cqdd_design.solids.layout import Layout
from cqdd_design.solids.motor_layout import InrunnerLayout, MotorEnd

_MOST_DEPTH = 0.9
"""Of slots in the width of the laminations."""


def inrunner_pairs(
    machine: Machine, layout: Layout, motor: InrunnerLayout, metal: float
) -> dict[tuple[Node, Node], float]:
    """Winding, stator, rotor, cover and housing, W/K.

    Parameters
    ----------
    metal : float
        Conductivity of the housing, W/(m K).

    Raises
    ------
    DesignError
        When the depth of the stator's slots is not known.
    """
    row, unit = machine.motor, layout.unit
    length = motor.stack_top - motor.stack_bottom
    if row.slot_depth is None:
        raise DesignError(
            f"no thermal network: the depth of the slots of {row.name} is not known (state "
            "slot_depth in [motor] or with --motor-file)."
        )
    slots = row.slots or round(SLOTS_PER_PAIR * (row.pole_pairs or 21))
    depth = min(row.slot_depth, _MOST_DEPTH * (motor.stack_outer - motor.stack_inner))
    iron = known("Electrical steel M400-50A", "conductivity")
    between = max(motor.stack_inner - motor.rotor_outer, LEAST_AIR_GAP)
    below = max(motor.lip_bottom - motor.cover_floor, LEAST_AIR_GAP)
    web = max(motor.web_top - motor.lip_bottom, 0.5 * unit)
    return {
        ("winding", "stator"): joints.winding_conductance(
            slots, depth, motor.stack_inner + 0.5 * depth, length
        ),
        ("stator", "cover"): series(
            annulus_conductance(iron, motor.stack_inner + depth, motor.stack_outer, length),
            joints.seat_conductance(motor.stack_outer, length),
        ),
        ("stator", "rotor"): 2.0 * math.pi * motor.rotor_outer * length * AIR / between,
        ("rotor", "shaft"): annulus_conductance(
            metal, min(motor.hub_radius, motor.rotor_inner - 0.5 * unit), motor.rotor_inner, web
        ),
        ("rotor", "cover"): AIR * math.pi * motor.lip_radius**2 / below,
        ("housing", "cover"): to_flanged_cover(layout, motor, metal),
    }


def to_flanged_cover(layout: Layout, motor: MotorEnd, metal: float) -> float:
    """From the middle of the housing's tube down to its flange, out, and half down the cover."""
    housing, pack = layout.housing, layout.pack
    tube = math.pi * (housing.register_radius**2 - pack.ring_radius**2)
    wall = math.pi * (motor.cover_outer**2 - motor.cover_inner**2)
    least = 0.5 * layout.unit
    path = [
        metal * tube / max(0.5 * (housing.flange_bottom - motor.joint), least),
        metal * wall / max(0.5 * (motor.joint - motor.cover_floor), least),
    ]
    inner, outer = sorted((housing.register_radius, motor.cover_outer))
    if outer - inner > least:
        path.append(annulus_conductance(metal, inner, outer, motor.flange + motor.ear_height))
    return series(*path)


def surfaces_behind(layout: Layout, motor: MotorEnd, metal: Material) -> tuple[Surface, ...]:
    """Outside of cover and housing, and the carrier's own face; the cover's upper face is hidden.

    Raises
    ------
    DesignError
        When the metal has no emissivity.
    """
    housing, carrier = layout.housing, layout.carrier
    shine = known(metal.name, "emissivity")
    can, tube, flange = motor.cover_outer, housing.register_radius, housing.flange_radius
    bottom = motor.cover_floor - motor.cover_wall
    face = math.pi * carrier.nut_radius**2
    house, own, cover = (NODES.index(node) for node in ("housing", "carrier", "cover"))
    wall = 2.0 * math.pi * tube * (housing.flange_bottom - motor.joint)
    rim = 2.0 * math.pi * flange * (housing.cover_flange_top - housing.flange_bottom)
    ends = math.pi * (2.0 * flange**2 - tube**2) - face
    return (
        Surface(cover, "cylinder", 2.0 * can, 2.0 * math.pi * can * (motor.joint - bottom), shine),
        Surface(cover, "plate", 2.0 * can, math.pi * can**2, shine),
        Surface(house, "cylinder", 2.0 * tube, max(wall, 0.0) + rim, shine),
        Surface(house, "plate", 2.0 * flange, max(ends, 0.0), shine),
        Surface(own, "plate", 2.0 * carrier.nut_radius, face, shine),
    )
