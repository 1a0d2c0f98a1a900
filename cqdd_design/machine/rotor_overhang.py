"""What the motor's rotor does to the end of the shaft that carries it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from cqdd_design.catalog.bearings import shaft_material
from cqdd_design.catalog.materials import Material, find_material
from cqdd_design.errors import CatalogError, DesignError
from cqdd_design.gearbox.contact import laws
from cqdd_design.gearbox.pack_loads import PackLoads
from cqdd_design.gearbox.rotor_overhang import Settled, bearings_give, overhang_give, settled
from cqdd_design.gearbox.shaft_strength import step_stress
from cqdd_design.machine.machine import Machine
from cqdd_design.machine.shaft import disc_heights, drawn_sections, knife_edges
from cqdd_design.machine.shaft_strength import section_loads, shaft_steps
from cqdd_design.solids.inertia import BELL, HUB, ROTOR
from cqdd_design.solids.motor_layout import InrunnerLayout, MotorEnd, MotorLayout
from cqdd_design.solids.motor_rules import bell_material
from cqdd_design.solids.rotor_pull import NO_HOLES, pull_rate, web_tilting_rate

_GRAVITY = 9.81
BUILT_OFF = 0.1
"""Share of the air gap by which a rotor is taken to be built off its stator's axis."""


@dataclass(frozen=True)
class RotorOverhang:
    """A rotor that hangs on the shaft's stub.

    Attributes
    ----------
    gap : float
        Radial air gap, m.
    off_centre : float
        By which the rotor is built off its stator's axis, m.
    mass : float
        Of magnets and what carries them, kg.
    arm : float
        From the middle of the magnets up to the middle of the shaft's lower bearing, m; negative
        where they stand above it.
    span : float
        From there up to the middle of the upper bearing, m.
    moment_arm : float
        The greatest arm of the force at the stub between hub and bearing, m.
    settled : Settled
        Deflection at the magnets, and force, under pull, weight and unbalance at the input speed.
    """

    gap: float
    off_centre: float
    mass: float
    arm: float
    span: float
    moment_arm: float
    settled: Settled

    @property
    def on_bearings(self) -> tuple[float, float]:
        """Sizes of what the force on the rotor puts on the lower and the upper bearing, N.

        Beyond the lower one it is a lever: the upper one holds its end down.
        """
        share = self.arm / self.span
        return abs(1.0 + share) * self.settled.force, abs(share) * self.settled.force


@dataclass(frozen=True)
class StubStress:
    """Reversed stress at the shoulder of the shaft's lower bearing, notches in it, Pa.

    Attributes
    ----------
    material : Material
        Of the shaft.
    diameter : float
        m.
    lasting : float
        Of the duty, without the rotor.
    rotor : float
        Of the force on the rotor, which stands still while the shaft turns under it.
    """

    material: Material
    diameter: float
    lasting: float
    rotor: float


def rotor_overhang(machine: Machine) -> RotorOverhang:
    """Load the shaft of a machine with its rotor.

    Raises
    ------
    GeometryError
        When the machine cannot be laid out.
    DesignError
        When no motor is drawn, or the shaft runs in bushes, whose stiffness is not known.
    """
    layout, design = machine.layout, machine.design
    motor, shaft = layout.motor_end, layout.shaft
    if motor is None:
        raise DesignError(f"no rotor is drawn: {layout.motor_missing}")
    if shaft.support.source == "bush":
        raise DesignError("the shaft runs in bushes, whose play and stiffness are not known")
    gap, radius = _air_gap(motor)
    at, edges = 0.5 * (motor.ring_bottom + motor.ring_top), knife_edges(shaft)
    arm, span = round(edges[0] - at, 9), edges[1] - edges[0]
    steel = find_material(shaft_material(layout.pack.cam.bearing))
    bends = overhang_give(
        drawn_sections(layout.pack, shaft, steel), edges, min(motor.hub_top, edges[0]), at
    )
    bends += _web_give(machine, motor, at)
    spring = laws.cam_spring(shaft.support.bearing, 0.0)

    def give(force: float) -> float:
        balls = bearings_give(force, spring.stiffness, spring.exponent, arm, span)
        return bends * force + balls

    mass = sum(part.mass for part in machine.parts if part.name in (ROTOR, BELL, HUB))
    off = BUILT_OFF * gap
    unbalance = mass * design.requirements.fastest_speed**2 * off
    rate = pull_rate(2.0 * radius, motor.stack_top - motor.stack_bottom, gap)
    return RotorOverhang(
        gap=gap,
        off_centre=off,
        mass=mass,
        arm=arm,
        span=span,
        moment_arm=max(abs(arm), abs(min(motor.hub_top, edges[0]) - at)),
        settled=settled(rate, off, mass * _GRAVITY + unbalance, give, gap),
    )


def stub_stress(machine: Machine, duty: PackLoads, found: RotorOverhang) -> StubStress:
    """What the rotor adds to the duty's stress where the stub begins.

    Its greatest moment at the stub counts, wherever that is: the shaft is of one diameter there.

    Raises
    ------
    GeometryError, CatalogError
        As `shaft_strength`.
    """
    pack, shaft = machine.layout.pack, machine.layout.shaft
    material = find_material(shaft_material(pack.cam.bearing))
    if material.ultimate_strength is None:
        raise CatalogError(f"the catalogue has no ultimate strength of '{material.name}'.")
    step = shaft_steps(pack, shaft)[0]
    loads = section_loads(duty, step.height, disc_heights(pack), knife_edges(shaft))
    lasting = step_stress(step, *loads, material.ultimate_strength)
    second = 0.25 * math.pi * (step.radius**4 - step.bore**4)
    bent = found.settled.force * found.moment_arm * step.radius / second
    return StubStress(
        material,
        2.0 * step.radius,
        lasting.reversed_amplitude,
        lasting.bending_factor * bent,
    )


def _air_gap(motor: MotorEnd) -> tuple[float, float]:
    """Its radial width, and its mean radius, m."""
    pairs = (motor.rotor_outer, motor.stack_inner), (motor.stack_outer, motor.rotor_inner)
    inner, outer = pairs[0] if isinstance(motor, InrunnerLayout) else pairs[1]
    return outer - inner, 0.5 * (inner + outer)


def _web_give(machine: Machine, motor: MotorEnd, at: float) -> float:
    """Deflection at the magnets along a unit force on them as the web of bell or hub tilts, m/N."""
    metal = find_material(bell_material(machine.design))
    if isinstance(motor, MotorLayout):
        bottom, top, outer = motor.web_bottom, motor.web_top, motor.rotor_inner
        holes = motor.lightening
    else:
        assert isinstance(motor, InrunnerLayout)
        bottom, top, outer, holes = motor.lip_bottom, motor.web_top, motor.sleeve_inner, NO_HOLES
    if outer <= motor.hub_radius:
        return 0.0
    arm = at - 0.5 * (bottom + top)
    rate = web_tilting_rate(
        motor.hub_radius, outer, top - bottom, metal.youngs_modulus, metal.poisson_ratio, holes
    )
    return arm**2 / rate
