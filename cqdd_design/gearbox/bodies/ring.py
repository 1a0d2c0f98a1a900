"""The ring as an elastic body: toothed inside, held all round by its seat."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.gearbox.bodies.loops import Loop, arcs, circle
from cqdd_design.gearbox.bodies.point_load import Places, Plate
from cqdd_design.geometry.contours import ArcContour, FloatArray
from cqdd_design.geometry.ring import ring_contour

PER_TOOTH = 9
"""Places on a tooth."""
_HELD = 500.0
"""Stiffness of the seat over E/R of the ring: it gives way by less than a hundredth of the ring."""
_KINK = 1e-3
"""Turn of the contour at a joint from which it is a corner, rad."""
_CLOSE = 0.05
"""Distance between vertices asked for, over the tooth's radius, at which one stands for both."""
_ROOTS = 24
"""Places of a tooth's pitch where stress is found."""


@dataclass(frozen=True, eq=False)
class RingShape:
    """Numbers that a ring's influence matrix depends on, SI.

    Attributes
    ----------
    contour : ArcContour
        Inner contour.
    outer, pitch_radius, tooth_radius, lean : float
        Outer radius, R and r, m; and the greatest angle between a tooth force and the radial, rad.
    tooth_count : int
    pockets : bool
        Whether the teeth are pins of their own, whose forces the pockets behind them take.
    seat : float
        Stiffness of the seat by area of the outside, times the thickness, N/m^2.
    plate : Plate
    side : float
        Longest side of a triangle, m.
    """

    contour: ArcContour
    outer: float
    pitch_radius: float
    tooth_radius: float
    lean: float
    tooth_count: int
    pockets: bool
    seat: float
    plate: Plate
    side: float

    @classmethod
    def from_design(cls, design: Design) -> RingShape:
        """The part of a ring that one disc works on, as thick as the disc, in a rigid housing."""
        reducer = design.reducer
        steel = find_material(reducer.ring_material)
        part = ring_contour(design)
        outer = 0.5 * reducer.ring.outer_diameter
        contour = part.holes[0]
        assert isinstance(contour, ArcContour)
        seat = _HELD * steel.youngs_modulus / outer
        K1 = reducer.eccentricity * (reducer.ratio + 1) / reducer.ring_pitch_radius
        return cls(
            contour,
            outer,
            reducer.ring_pitch_radius,
            0.5 * reducer.ring_pin_diameter,
            math.asin(K1),
            reducer.ratio + 1,
            reducer.ring_type == "pinwheel",
            seat * reducer.disc_thickness,
            Plate(steel.youngs_modulus, steel.poisson_ratio, reducer.disc_thickness),
            outer / 20.0,
        )

    def loops(self) -> tuple[Loop, ...]:
        """Outside, and toothed contour."""
        curve, corners = arcs(self.contour)
        around = Loop(curve, -1)
        before, after = (curve(corners + s * 1e-9)[1] for s in (-1.0, 1.0))
        kinks = corners[np.abs(np.angle(after / before)) > _KINK]
        # On every kink, on every place, and where only the curvature jumps, and with it tractions.
        vertices = kinks
        for more in (np.mod(around.parameter(self.places().point), 1.0), corners):
            apart = np.abs(np.mod(more[:, None] - vertices + 0.5, 1.0) - 0.5)
            far = (
                apart.min(axis=1, initial=1.0) * self.contour.length() > _CLOSE * self.tooth_radius
            )
            vertices = np.concatenate([vertices, more[far]])
        return Loop(circle(0j, self.outer), 1, loaded=False), replace(
            around, joints=np.sort(vertices)
        )

    @property
    def angles(self) -> FloatArray:
        """Angles of the places on a tooth: of the force on it, from the outward radial, rad."""
        return self.lean * np.linspace(-1.0, 1.0, PER_TOOTH)

    def places(self) -> Places:
        """Teeth from the one on +x; of each its places by rising angle of the force."""
        turn = np.exp(2j * np.pi * np.arange(self.tooth_count) / self.tooth_count)[:, None]
        force = turn * np.exp(1j * self.angles)
        reach = self.tooth_radius if self.pockets else -self.tooth_radius
        point = (self.pitch_radius * turn + reach * force).ravel()
        return Places(point, force.ravel(), np.zeros(len(point), dtype=complex))

    def roots(self) -> Places:
        """Places evenly along the toothed contour, the same on every pitch."""
        u = np.arange(_ROOTS * self.tooth_count) / (_ROOTS * self.tooth_count)
        loop = self.loops()[1]
        point = loop.curve(u)[0]
        return Places(point, -loop.normal(u), np.zeros(len(u), dtype=complex))
