"""What friction needs of a design, and the two kinds of it: Coulomb work and drag.

Both are torques at the crank: work per radian of crank. Coulomb work follows from the contact
forces and does not depend on speed; drag depends on speed and not on the forces.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.catalog.bearings import find_bearing
from cqdd_design.catalog.lubricants import RUNNING_TEMPERATURE, Lubricant, find_lubricant
from cqdd_design.design import Design
from cqdd_design.gearbox.losses.rolling import BearingFriction
from cqdd_design.gearbox.losses.shaft import equivalent_load, support_reactions
from cqdd_design.gearbox.losses.sliding import (
    friction_work,
    pin_sliding,
    ring_sliding,
)
from cqdd_design.gearbox.output_pins import disc_positions, pin_span
from cqdd_design.gearbox.rolling_contacts import (
    greatest_roller_turn,
    hole_friction,
    most_breakaway,
    sleeve_turn,
    tooth_friction,
)
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.disc import disc_moments
from cqdd_design.geometry.runners import pin_runner, ring_runner

if TYPE_CHECKING:
    from cqdd_design.gearbox.contact.solved import ContactSweep

SOURCES = (
    "ring_teeth",
    "output_pins",
    "cam_bearings",
    "support_bearings",
    "output_bearing",
    "grease",
)
"""Where power is lost, in the order of every table of losses."""
RUBBING = ("ring_teeth", "output_pins")
"""Those of them that mesh, in the order of the coefficients of a design."""

_LEAST_FILM = 50e-6
"""Thinnest grease film between faces that a design sets without any gap, m."""
_OUTPUT_HEIGHT = 0.75
"""Mid-plane of the output bearing beyond the second plate's face, in bearing widths."""


@dataclass(frozen=True)
class NeedleDrag:
    """Needle cages of one kind: one of them, how many, and its turn per radian of crank.

    All of them are taken to turn all the time, those of rollers at the fastest.
    """

    cage: BearingFriction
    count: int
    turn: float


@dataclass(frozen=True)
class FrictionMachine:
    """Friction of one gearbox, SI.

    Attributes
    ----------
    lobe_count, disc_count : int
        n and D.
    eccentricity : float
        e.
    tooth_coefficient, pin_coefficient : float
        mu felt at ring teeth and at output pins, sliding or rolling (:mod:`..rolling_contacts`), as
        the design states it or without a film.
    most_breakaway : tuple of float
        Most by which breakaway exceeds running friction at teeth and at pins.
    disc_heights : tuple of float
        Mid-planes of the discs from the first carrier plate.
    span : float
        Between the carrier plates.
    cam, support, output : BearingFriction
        Of every disc; at both ends of the shaft; of the carrier.
    face_area, face_gap : float
        One face of a disc, and the gap filled with grease in front of it.
    needles : mapping
        Cages under rollers and sleeves, by where they lose power; empty without.
    temperature : float
        Of the lubricant, deg C.
    """

    lobe_count: int
    disc_count: int
    eccentricity: float
    tooth_coefficient: float
    pin_coefficient: float
    most_breakaway: tuple[float, float]
    disc_heights: tuple[float, ...]
    span: float
    cam: BearingFriction
    support: BearingFriction
    output: BearingFriction
    lubricant: Lubricant
    face_area: float
    face_gap: float
    needles: Mapping[str, NeedleDrag]
    temperature: float = RUNNING_TEMPERATURE

    @classmethod
    def from_design(
        cls,
        design: Design,
        *,
        support: BearingFriction,
        output: BearingFriction,
        temperature: float = RUNNING_TEMPERATURE,
    ) -> FrictionMachine:
        """Read a design.

        Parameters
        ----------
        design : Design
            With a named cam bearing.
        support, output : BearingFriction
            At either end of the shaft, and of the carrier.
        temperature : float
            Of the lubricant, deg C.
        """
        reducer = design.reducer
        cam = find_bearing(reducer.cam_bearing.designation)
        stack = (reducer.disc_count, reducer.disc_thickness, reducer.disc_spacing)
        return cls(
            lobe_count=reducer.ratio,
            disc_count=reducer.disc_count,
            eccentricity=reducer.eccentricity,
            tooth_coefficient=tooth_friction(design),
            pin_coefficient=hole_friction(design),
            most_breakaway=most_breakaway(design),
            disc_heights=tuple(float(z) for z in disc_positions(*stack)),
            span=float(pin_span(*stack)),
            cam=BearingFriction.of(cam),
            support=support,
            output=output,
            lubricant=find_lubricant(reducer.friction.lubricant),
            face_area=disc_moments(design, 0, bore_diameter=cam.outer_diameter).area,
            face_gap=max(reducer.disc_spacing, _LEAST_FILM),
            needles=_needles(design),
            temperature=temperature,
        )

    @property
    def viscosity(self) -> float:
        """Kinematic viscosity of the (base) oil, m^2/s; UsageError where it has none."""
        return self.lubricant.viscosity_at(self.temperature)

    @property
    def relative_turn(self) -> float:
        """Turn of the crank against disc and carrier per radian of crank, 1 + 1/n."""
        return 1.0 + 1.0 / self.lobe_count

    def coulomb_work(self, forces: ContactSweep) -> dict[str, float]:
        """Mean Coulomb friction work per radian of crank over a sweep, by source, N m.

        Parameters
        ----------
        forces : ContactSweep
            At evenly spaced crank angles over a whole period, with or without friction; films that
            it has found give the coefficients.
        """
        n = self.lobe_count
        sliding = ring_sliding(
            n,
            forces.ring_point,
            forces.ring_normal,
            (n + 1) * np.asarray(forces.disc_centre)[:, :, None, :],
        )
        path = pin_sliding(n, self.eccentricity)
        if forces.friction is not None and forces.friction.felt is not None:
            ring = friction_work(1.0, np.abs(forces.ring_tangential), sliding)
            pins = friction_work(1.0, np.abs(forces.pin_tangential), path)
        else:
            ring = friction_work(self.tooth_coefficient, forces.ring_force, sliding)
            pins = friction_work(self.pin_coefficient, forces.pin_force, path)
        cam = self.cam.load_torque(np.linalg.norm(forces.cam_force, axis=-1))
        first, second, carrier = self._seat_loads(forces)
        supports = self.support.load_torque(first)
        supports = supports + self.relative_turn * self.support.load_torque(second)
        return {
            "ring_teeth": float(ring.sum(axis=1).mean()),
            "output_pins": float(pins.sum(axis=1).mean()),
            "cam_bearings": self.relative_turn * float(cam.sum(axis=1).mean()),
            "support_bearings": float(supports.mean()),
            "output_bearing": float(self.output.load_torque(carrier).mean()) / n,
            "grease": 0.0,
        }

    def rubbed(self, forces: ContactSweep) -> tuple[float, float]:
        """Normal force times sliding path per radian of crank, mean of a sweep, N m.

        At ring teeth and at output pins, of all discs: what friction and wear are in proportion to.
        """
        n = self.lobe_count
        pitch_point = (n + 1) * np.asarray(forces.disc_centre)[:, :, None, :]
        sliding = ring_sliding(n, forces.ring_point, forces.ring_normal, pitch_point)
        teeth = friction_work(1.0, forces.ring_force, sliding)
        pins = friction_work(1.0, forces.pin_force, pin_sliding(n, self.eccentricity))
        return float(teeth.sum(axis=1).mean()), float(pins.sum(axis=1).mean())

    def _seat_loads(self, forces: ContactSweep) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Loads (A,) of the first and second support and of the output bearing, N.

        The shaft carries the reactions of the cam forces and no other load: no rotor weight, no
        magnetic pull, no belt. Its first bearing sits in the housing, its second in the carrier,
        each just outside a plate's face; the carrier takes the pins' reactions and the second
        support, and no load from outside.
        """
        first, second = -0.5 * self.support.width, self.span + 0.5 * self.support.width
        reactions = support_reactions(-forces.cam_force, self.disc_heights, first, second)
        on_pins = -np.sum(forces.pin_load, axis=2)
        # The shaft pushes back on the carrier through the second support.
        on_carrier = np.concatenate([on_pins, -reactions[:, 1:]], axis=1)
        carrier = equivalent_load(
            on_carrier,
            [*self.disc_heights, second],
            self.span + _OUTPUT_HEIGHT * self.output.width,
            self.output.mean_diameter,
        )
        size = np.linalg.norm(reactions, axis=-1)
        return size[:, 0], size[:, 1], carrier

    def drag(self, input_speed: ArrayLike) -> dict[str, FloatArray]:
        """Load-independent drag by source, as a torque at the crank, N m.

        Parameters
        ----------
        input_speed : array_like (...)
            Of the crank, rad/s, either sense; 0 is the limit of slow motion.

        Returns
        -------
        mapping of arrays (...)
            Bearings by Palmgren at their relative speeds, and the grease between the faces.
        """
        speed = np.abs(np.asarray(input_speed, dtype=float))
        viscosity, turn, n = self.viscosity, self.relative_turn, self.lobe_count
        cam = self.cam.drag_torque(viscosity, speed * turn)
        first = self.support.drag_torque(viscosity, speed)
        second = self.support.drag_torque(viscosity, speed * turn)
        rolling = {
            source: cages.count * cages.turn * cages.cage.drag_torque(viscosity, speed * cages.turn)
            for source, cages in self.needles.items()
        }
        none = np.zeros(speed.shape)
        return {
            "ring_teeth": rolling.get("ring_teeth", none),
            "output_pins": rolling.get("output_pins", none),
            "cam_bearings": self.disc_count * turn * cam,
            "support_bearings": first + turn * second,
            "output_bearing": self.output.drag_torque(viscosity, speed / n) / n,
            "grease": self.grease_torque(speed),
        }

    def grease_torque(self, input_speed: ArrayLike) -> FloatArray:
        """Torque at the crank that shears the grease in front of the discs' faces, N m.

        A Bingham film (yield stress, and the base oil's viscosity) of uniform shear fills every
        axial gap: an upper bound, since most greases are pushed aside and channel. Neighbouring
        discs pass each other at e w |u_d - u_d+1| = 2 e w sin(pi/D), a disc and a carrier plate at
        e w (1 + 1/n). Grease in the teeth is not counted.
        """
        speed = np.abs(np.asarray(input_speed, dtype=float))
        between = 2.0 * self.eccentricity * np.sin(np.pi / self.disc_count)
        plate = self.eccentricity * self.relative_turn
        paths = np.array([*[between] * (self.disc_count - 1), plate, plate])
        shear_rate = speed[..., None] * paths / self.face_gap
        viscosity = self.viscosity * self.lubricant.density
        stress = self.lubricant.yield_stress + viscosity * shear_rate
        return np.asarray(np.sum(stress * self.face_area * paths, axis=-1))


def _needles(design: Design) -> dict[str, NeedleDrag]:
    """Cages of rollers and sleeves, where there are any."""
    reducer, found = design.reducer, {}
    n, e = reducer.ratio, reducer.eccentricity
    rollers, sleeves = ring_runner(design), pin_runner(design)
    if rollers is not None and rollers.cage is not None:
        turn = greatest_roller_turn(n, reducer.ring_pitch_radius, e, rollers.diameter)
        count = reducer.disc_count * reducer.ring_tooth_count * rollers.rows
        found["ring_teeth"] = NeedleDrag(BearingFriction.of(rollers.cage), count, turn)
    if sleeves is not None and sleeves.cage is not None:
        turn = float(sleeve_turn(n, e, sleeves.diameter))
        count = reducer.disc_count * reducer.output_pins.count * sleeves.rows
        found["output_pins"] = NeedleDrag(BearingFriction.of(sleeves.cage), count, turn)
    return found


def total(parts: Mapping[str, ArrayLike]) -> FloatArray:
    """Sum over the sources."""
    return np.asarray(np.sum([np.asarray(part, dtype=float) for part in parts.values()], axis=0))
