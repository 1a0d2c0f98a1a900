"""A reducer of the table of Wang, Luo and Su under the rigid law, its friction by films.

Kinematics of the films by differences over crank angle, apart from the tables of the equilibrium.
"""

from __future__ import annotations

import math

import numpy as np
from lone_disc import lone_disc

from cqdd_design.catalog.finishes import find_finish
from cqdd_design.catalog.lubricants import find_lubricant
from cqdd_design.gearbox import hertz, rigid
from cqdd_design.gearbox.film.law import FilmLaw
from cqdd_design.gearbox.film.mixed import BOUNDARY_FRICTION, composite_roughness
from cqdd_design.gearbox.losses import sliding
from cqdd_design.geometry import kinematics

STEEL = 115.4e9
"""E* of bearing steel on itself, Pa."""
DISCS = 2
BEARINGS = 0.99 * 0.995**2


class FilmReducer:
    """One reducer, lengths in m.

    Attributes
    ----------
    wall : float
        Of the sleeves on output pins, and of the rollers on ring pins where there are any.
    """

    def __init__(
        self, g: dict[str, float], *, rollers: bool, wall: float = 2e-3, temperature: float = 40.0
    ) -> None:
        self.n, self.pins, self.rollers, self.wall = int(g["zc"]), int(g["zw"]), rollers, wall
        self.R, self.r, self.width = 0.5e-3 * g["Dp"], 0.5e-3 * g["drp"], 1e-3 * g["B"]
        self.e = g["K1"] * self.R / (self.n + 1)
        self.pin_circle, self.pin = 0.5e-3 * g["Dw"], 0.5e-3 * g["dsw"]
        self.speed = 1440.0 * math.pi / 30.0
        self.torque = 750.0 / self.speed * self.n
        period = kinematics.mesh_period(self.n, self.pins)
        self.angle = period / 704 * np.arange(704)
        oil = find_lubricant("ISO VG 150 oil")
        ground = find_finish("ground")
        self.law = FilmLaw(
            viscosity=oil.viscosity_at(temperature) * oil.density,
            pressure_coefficient=oil.pressure_coefficient_at(temperature),
            modulus=STEEL,
            length=self.width,
            roughness=composite_roughness(ground, ground),
            boundary=BOUNDARY_FRICTION,
            film=oil.film_friction,
        )

    def teeth(self) -> tuple[float, float]:
        """Loss at the teeth over output power, and mean coefficient felt there."""
        step = 1e-5

        def at(angle: np.ndarray):
            return lone_disc(self.n, self.R, self.e, self.r, self.torque / DISCS, angle)

        stage, ahead, behind = at(self.angle), at(self.angle + step), at(self.angle - step)
        after, before = (
            one.ring_normal[..., 0] + 1j * one.ring_normal[..., 1] for one in (ahead, behind)
        )
        spin = np.angle(after / before) / (2.0 * step)
        pitch = kinematics.pitch_point(self.n, self.e, self.angle)[:, None]
        arm = stage.ring_point - pitch
        slip = -np.sum(arm * stage.ring_normal, axis=-1) / self.n
        on_disc = self.r * spin - slip
        bend = rigid.ring_contact_curvature(self.n, self.R, self.e, self.angle)
        radius = np.maximum(hertz.ring_equivalent_radius(self.r, bend), 1e-4)
        entrained, share = 0.5 * (self.r * spin + on_disc), 1.0
        if self.rollers:
            inside = self.r - self.wall
            bore = inside + 5e-6
            entrained = 0.5 * (inside * spin + on_disc * bore / self.r)
            radius = np.full(spin.shape, float(hertz.conformal_equivalent_radius(inside, bore)))
            share = inside / self.r
        film = self.law.at(stage.ring_force, np.abs(entrained) * self.speed, radius)
        path = np.abs(slip)
        rubbed = sliding.friction_work(1.0, stage.ring_force, path).mean()
        lost = sliding.friction_work(share, film.friction * stage.ring_force, path).mean()
        return self.n * DISCS * float(lost) / self.torque, float(lost / rubbed)

    def output(self) -> tuple[float, float]:
        """Loss at the output pins over output power, and mean coefficient felt there."""
        force = rigid.output_pin_forces(
            self.n, self.pins, self.pin_circle, self.torque / DISCS, self.angle
        )
        rim, bore = self.pin + self.wall, self.pin + 5e-6
        hole = rim + self.e
        turn = 1.0 + 1.0 / self.n
        entrained = 0.5 * (self.pin + hole * bore / rim) * turn * self.speed
        film = self.law.at(
            force, entrained, float(hertz.conformal_equivalent_radius(self.pin, bore))
        )
        path = sliding.pin_sliding(self.n, self.e)
        felt = film.friction * self.pin / rim
        lost = float(sliding.friction_work(1.0, felt * force, path).mean())
        rubbed = float(sliding.friction_work(1.0, force, path).mean())
        return self.n * DISCS * lost / self.torque, lost / rubbed

    def efficiency(self) -> float:
        """Of teeth, output pins and, as the source has them, bearings."""
        return BEARINGS / (1.0 + self.teeth()[0]) / (1.0 + self.output()[0])
