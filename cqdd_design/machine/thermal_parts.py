"""Thermal network of a machine: one node a part, joined as the layout draws them.

Radially, output upward::

    air - housing - ring -(grease)- discs -(cam bearings)- shaft
             |         carrier -(pins, grease)-'            |
             |---(output bearing)-'  '---(support bearing)--|
             '- stator - winding ; rotor on the shaft, across air gaps from stator and cover

Housing counts with its clamp and output cover, the carrier with cap, pins and nut, the rotor with
bell and magnets; the cover is the motor's, on the housing's flange. The actuator hangs in still air
with its axis level: nothing carries heat into a robot's limb.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from cqdd_design.catalog.materials import Material, find_material
from cqdd_design.errors import DesignError
from cqdd_design.gearbox.contact.states import nominal_states
from cqdd_design.gearbox.contact.sweep import perfect_angles
from cqdd_design.gearbox.heat import joints
from cqdd_design.gearbox.heat.network import ThermalNetwork
from cqdd_design.gearbox.heat.surfaces import Surface, annulus_conductance
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.machine.heat_nodes import (
    AIR,
    LEAST_AIR_GAP,
    NODES,
    SLOTS_PER_PAIR,
    Node,
    known,
    series,
)
from cqdd_design.machine.inrunner_heat import inrunner_pairs, surfaces_behind, to_flanged_cover
from cqdd_design.machine.machine import Machine
from cqdd_design.solids.inertia import GROUPS
from cqdd_design.solids.layout import Layout
from cqdd_design.solids.motor_layout import MotorLayout
from cqdd_design.solids.selection import ChosenBearing

WINDING_SHARE, COPPER_HEAT = 0.15, 385.0
"""Copper's share of a motor's mass; its specific heat, J/(kg K)."""

_OWNERS: dict[str, Node] = {
    "motor stator": "stator",
    "motor rotor": "rotor",
    "motor cover": "cover",
    "rotor bell": "rotor",
    "rotor hub": "rotor",
    "ring": "ring",
    "ring pin": "ring",
    "ring roller": "ring",
    "ring needle cage": "ring",
    "eccentric shaft": "shaft",
    "eccentric cam": "shaft",
    "encoder magnet": "shaft",
    **dict.fromkeys(GROUPS["carrier"], "carrier"),
}
"""Nodes of parts by name; discs have theirs, bearings half to each side, the rest is housing."""
_SIDES: dict[str, tuple[Node, Node]] = {
    "cam bearing": ("disc", "shaft"),
    "output bearing": ("housing", "carrier"),
    "shaft bearing": ("housing", "shaft"),
}
_ANGLES = 24


@dataclass(frozen=True, eq=False)
class Conductances:
    """Of one machine, by pairs of nodes, W/K."""

    pairs: dict[tuple[Node, Node], float]
    surfaces: tuple[Surface, ...]

    def matrix(self) -> FloatArray:
        """Symmetric, (N, N), W/K."""
        found = np.zeros((len(NODES), len(NODES)))
        for (one, other), value in self.pairs.items():
            i, j = NODES.index(one), NODES.index(other)
            found[i, j] += value
            found[j, i] += value
        return found


def machine_network(machine: Machine) -> ThermalNetwork:
    """The network of a machine in the air of its surroundings, cooled by that air alone.

    Raises
    ------
    GeometryError
        When its parts cannot be laid out.
    DesignError
        When its motor cannot be drawn, or a material's thermal figures are not known.
    """
    layout = machine.layout
    if layout.motor_end is None:
        raise DesignError(f"no thermal network: {layout.motor_missing}")
    found = conductances(machine, layout)
    return ThermalNetwork(
        names=NODES,
        capacity=capacities(machine),
        conductance=found.matrix(),
        to_ambient=np.zeros(len(NODES)),
        ambient=machine.design.environment.ambient,
        surfaces=found.surfaces,
    )


def scaled(network: ThermalNetwork, factor: float) -> ThermalNetwork:
    """The network with insulation of the winding and surroundings better by a factor.

    Those two are what no drawing knows; a given resistance from winding to ambient sets them.
    """
    matrix = network.conductance.copy()
    w, s = NODES.index("winding"), NODES.index("stator")
    matrix[w, s] *= factor
    matrix[s, w] *= factor
    return replace(network, conductance=matrix, cooling=factor)


def capacities(machine: Machine) -> FloatArray:
    """Heat capacities of the nodes, (N,), J/K."""
    heat = dict.fromkeys(NODES, 0.0)
    for part in machine.parts:
        mass = part.mass * part.count
        if part.name == "motor stator":
            copper = WINDING_SHARE * (machine.motor.mass or mass)
            heat["winding"] += copper * COPPER_HEAT
            mass = max(mass - copper, 0.0)
        own = mass * known(part.material, "specific_heat")
        if part.name in _SIDES:
            for node in _SIDES[part.name]:
                heat[node] += 0.5 * own
        elif part.name.startswith("disc"):
            heat["disc"] += own
        else:
            heat[_OWNERS.get(part.name, "housing")] += own
    return np.array([heat[node] for node in NODES])


def conductances(machine: Machine, layout: Layout) -> Conductances:
    """Between the nodes, and surfaces in the air; a layout without a motor has none of these."""
    design, pack = machine.design, layout.pack
    metal = known(design.housing.material, "conductivity")
    housing = find_material(design.housing.material)
    about: dict[tuple[Node, Node], float] = {}
    surfaces: tuple[Surface, ...] = ()
    if layout.motor is not None:
        motor, behind = layout.motor, layout.motor.behind
        about = _motor_pairs(machine, motor, layout.unit, metal)
        about["housing", "cover"] = (to_flanged_cover if behind else _to_cover)(
            layout, motor, metal
        )
        surfaces = (surfaces_behind if behind else _surfaces)(layout, motor, housing)
    elif layout.inrunner is not None:
        about = inrunner_pairs(machine, layout, layout.inrunner, metal)
        surfaces = surfaces_behind(layout, layout.inrunner, housing)
    shaft = layout.shaft
    turn = 1.0 + 1.0 / design.reducer.ratio
    speed = design.requirements.held_speed
    ring, disc, pins = _grease(machine, layout)
    pairs: dict[tuple[Node, Node], float] = {
        **about,
        ("housing", "ring"): series(
            joints.seat_conductance(pack.ring_radius, pack.top),
            annulus_conductance(
                known(design.reducer.ring_material, "conductivity"),
                # Thick teeth have their centres outside the roots, or even outside the ring.
                min(design.reducer.ring_pitch_radius, pack.ledge_radius),
                pack.ring_radius,
                pack.top,
            ),
        ),
        ("ring", "disc"): ring,
        ("disc", "carrier"): disc + pins,
        ("disc", "shaft"): pack.disc_count * _bearing(pack.cam, speed * turn),
        ("housing", "shaft"): _bearing(shaft.support, speed),
        ("shaft", "carrier"): _bearing(shaft.support, speed * turn),
        ("housing", "carrier"): _bearing(layout.carrier.output, speed / design.reducer.ratio),
    }
    return Conductances(pairs, surfaces)


def _motor_pairs(
    machine: Machine, motor: MotorLayout, unit: float, metal: float
) -> dict[tuple[Node, Node], float]:
    """Winding, stator, rotor and what holds them."""
    length = motor.stack_top - motor.stack_bottom
    row = machine.motor
    slots = row.slots or round(SLOTS_PER_PAIR * (row.pole_pairs or 21))
    depth, middle = (
        motor.stack_outer - motor.slot_radius,
        0.5 * (motor.stack_outer + motor.slot_radius),
    )
    iron = known("Electrical steel M400-50A", "conductivity")
    gap = 2.0 * math.pi * motor.rotor_inner * length * AIR
    gap /= max(motor.rotor_inner - motor.stack_outer, LEAST_AIR_GAP)
    web = motor.web_top - motor.web_bottom
    side = motor.ring_top - motor.web_bottom
    around = 2.0 * math.pi * motor.bell_radius * side / (motor.cover_inner - motor.bell_radius)
    below = (
        math.pi * motor.bell_radius**2 / max(motor.web_bottom - motor.cover_floor, LEAST_AIR_GAP)
    )
    to_tube = [
        annulus_conductance(iron, motor.stack_inner, motor.slot_radius, length),
        joints.seat_conductance(motor.stack_inner, length),
    ]
    if motor.behind:
        # Up the neck, from the middle of the laminations.
        neck = math.pi * (motor.stack_inner**2 - motor.neck_inner**2)
        to_tube.append(metal * neck / (motor.joint - motor.stack_top + 0.5 * length))
    return {
        ("winding", "stator"): joints.winding_conductance(slots, depth, middle, length),
        ("stator", "housing"): series(*to_tube),
        ("stator", "rotor"): gap,
        ("rotor", "shaft"): annulus_conductance(
            metal, motor.hub_radius, motor.rotor_inner, max(web, 0.5 * unit)
        ),
        ("rotor", "cover"): AIR * (around + below),
    }


def _to_cover(layout: Layout, motor: MotorLayout, metal: float) -> float:
    """From the middle of the housing's tube out through its flange and half down the cover."""
    housing, pack = layout.housing, layout.pack
    tube = math.pi * (housing.register_radius**2 - pack.ring_radius**2)
    wall = math.pi * (motor.cover_outer**2 - motor.cover_inner**2)
    flange = max(motor.flange_top - housing.flange_bottom, layout.unit)
    return series(
        metal * tube / max(0.5 * housing.flange_bottom, 0.5 * layout.unit),
        annulus_conductance(metal, housing.register_radius, motor.cover_outer, flange),
        metal * wall / (0.5 * (housing.flange_bottom - motor.cover_floor)),
    )


def _grease(machine: Machine, layout: Layout) -> tuple[float, float, float]:
    """Ring to discs at the teeth; discs to carrier at faces, and at pins with the pins behind."""
    model, pack = machine.contact, layout.pack
    states = nominal_states(model, perfect_angles(model, _ANGLES))
    teeth, length = model.tooth_count, model.contact_length
    at_teeth = joints.film_conductance(
        states.gaps[:, :, :teeth], states.ring.equivalent_radius, model.tooth_radius, length
    )
    at_pins = joints.film_conductance(
        states.gaps[:, :, teeth:], model.pin_equivalent_radius, model.pin_contact_radius, length
    )
    pin = known(machine.design.reducer.output_pins.material, "conductivity")
    section = math.pi * model.pin_contact_radius**2
    ends = 2 if layout.carrier.cap else 1
    along = ends * model.pin_count * pin * section / (0.5 * pack.top)
    face = machine.friction.face_area * joints.GREASE_CONDUCTIVITY / machine.friction.face_gap
    return (
        float(at_teeth.sum(axis=(1, 2)).mean()),
        ends * face,
        series(float(at_pins.sum(axis=(1, 2)).mean()), along),
    )


def _surfaces(layout: Layout, motor: MotorLayout, metal: Material) -> tuple[Surface, ...]:
    """Outside of the housing from motor cover to output cover, and the carrier's own face."""
    housing, carrier = layout.housing, layout.carrier
    shine = known(metal.name, "emissivity")
    radius = max(motor.cover_outer, housing.flange_radius)
    bottom = motor.cover_floor - motor.cover_wall
    length = max(housing.cover_flange_top, layout.pack.top) - bottom
    face = math.pi * carrier.nut_radius**2
    whole = math.pi * radius**2
    house, own, motor_s = (NODES.index(node) for node in ("housing", "carrier", "cover"))
    return (
        Surface(motor_s, "cylinder", 2.0 * radius, 2.0 * math.pi * radius * length, shine),
        Surface(motor_s, "plate", 2.0 * radius, whole, shine),
        Surface(house, "plate", 2.0 * radius, max(whole - face, 0.0), shine),
        Surface(own, "plate", 2.0 * carrier.nut_radius, face, shine),
    )


def _bearing(seat: ChosenBearing, speed: float) -> float:
    row = seat.bearing
    if seat.source == "bush":
        return joints.bush_conductance(0.5 * row.bore_diameter, row.width)
    return joints.bearing_conductance(0.5 * (row.bore_diameter + row.outer_diameter), speed)
