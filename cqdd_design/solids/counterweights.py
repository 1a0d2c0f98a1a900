"""Balance weights on the motor's bell: two steel sectors that cancel what discs and shaft leave.

Two planes balance everything: with the unbalance S = sum m r and the couple C = sum m r z of all
that turns or orbits with the crank, the weights U1 at z1 and U2 at z2 satisfy U1 + U2 = -S and
U1 z1 + U2 z2 = -C. A sector of half angle a between two radii has U = rho h 2/3 (R^3 - r^3) sin a.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

import numpy as np

from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.errors import GeometryError
from cqdd_design.geometry.contours import ArcContour, FloatArray, PlanarPart, as_points
from cqdd_design.results import MassProperties
from cqdd_design.solids.features.kinds import Joint
from cqdd_design.solids.layers import prism
from cqdd_design.solids.layout import Layout
from cqdd_design.solids.motor_layout import MotorLayout
from cqdd_design.solids.part import Colour, Part, on_axis
from cqdd_design.solids.poses import SHAFT, body_pose

NAMES = ("balance weight, shaft end", "balance weight, output end")
MATERIAL = "AISI 4140 annealed"
_HEIGHT = 2.0
"""Of a weight, units."""
_MOST_HALF_ANGLE = math.radians(85.0)
_LEAST = 1e-9
"""Unbalance, kg m, below which no weight is made: a milligram at a millimetre."""


def crank_moments(design: Design, parts: Sequence[Part]) -> tuple[complex, complex]:
    """First moments of what goes round with the crank at angle 0: sum m r (kg m), sum m r z.

    Discs and cam bearings count with their mass at their centre, because they spin against the
    crank; parts of the shaft with all of their mass where it is.
    """
    static, couple = 0j, 0j
    for part in parts:
        own = part.exact_properties
        for piece in part.instances:
            pose = body_pose(design, piece.body, 0.0) @ piece.placement
            if piece.body.kind == "disc":
                at = body_pose(design, piece.body, 0.0)[:2, 3]
                height = float((pose[:3, :3] @ own.centre + pose[:3, 3])[2])
                moment = own.mass * complex(*at)
                static += moment
                couple += moment * height
            elif piece.body.kind == "shaft":
                placed = own.moved(pose[:3, 3], pose[:3, :3])
                about = placed.inertia_about(np.zeros(3))
                static += placed.mass * complex(placed.centre[0], placed.centre[1])
                couple -= complex(about[0, 2], about[1, 2])
    return static, couple


def balance_weights(
    design: Design, layout: Layout, parts: Sequence[Part], colour: Colour
) -> list[Part]:
    """The two weights of a machine.

    Raises
    ------
    GeometryError
        When there is no motor to carry them, or no weight of this size fits on its bell.
    """
    motor = layout.motor
    if motor is None:
        why = layout.motor_missing or f"{layout.motor_row.name} is an inrunner, which has none"
        raise GeometryError(
            f"balance.counterweights sit on the motor's bell, and {why}; choose "
            "another motor.name, or set balance.counterweights = false."
        )
    height = _HEIGHT * layout.unit
    places = (
        ("underside of its web", motor.web_bottom - height, motor.rotor_inner),
        ("edge of its rim", motor.ring_top, motor.rotor_inner + 0.5 * layout.unit),
    )
    levels = [bottom + 0.5 * height for _, bottom, _ in places]
    static, couple = crank_moments(design, parts)
    upper = (static * levels[0] - couple) / (levels[1] - levels[0])
    needed = (-static - upper, upper)
    return [
        _weight(name, motor, face, bottom, inner, height, moment, colour)
        for name, (face, bottom, inner), moment in zip(NAMES, places, needed, strict=True)
        if abs(moment) > _LEAST
    ]


def drawn_weights(design: Design, parts: Sequence[Part]) -> tuple[MassProperties, ...]:
    """The weights among the parts of a machine, as bodies for the balance of its crank.

    Returns
    -------
    tuple of MassProperties
        In the frame of `gearbox.balance`: x along the crank of disc 0, z from the middle of the
        pack of discs.
    """
    down = np.array([0.0, 0.0, -0.5 * design.reducer.pack_length])
    return tuple(part.exact_properties.moved(down) for part in parts if part.name in NAMES)


def _weight(
    name: str,
    motor: MotorLayout,
    face: str,
    bottom: float,
    inner: float,
    height: float,
    moment: complex,
    colour: Colour,
) -> Part:
    outer = motor.bell_radius
    density = find_material(MATERIAL).density
    most = density * height * 2.0 / 3.0 * (outer**3 - inner**3)
    if abs(moment) > most * math.sin(_MOST_HALF_ANGLE):
        raise GeometryError(
            f"the {name} would need {abs(moment) * 1e6:.4g} g mm, and the motor's bell has room "
            f"for {most * math.sin(_MOST_HALF_ANGLE) * 1e6:.4g} g mm; use two discs, or lower "
            "eccentricity."
        )
    half, direction = math.asin(abs(moment) / most), cmath.phase(moment)
    shape = PlanarPart("weight", _sector(inner, outer, half, direction))
    return Part(
        name=name,
        shape=prism(shape, bottom, bottom + height),
        material=MATERIAL,
        colour=colour,
        source="make",
        designation=f"cut from {height * 1e3:.3g} mm sheet, bonded on the bell",
        instances=on_axis(name, SHAFT),
        stated=(Joint("rotor bell", "bonded", face, "rotor bell", _where(direction)),),
    )


def _where(direction: float) -> str:
    """How a weight is put on, from the polar angle of its middle, rad."""
    angle = round(math.degrees(direction), 2) % 360.0
    return f"flush with its outside, the middle at {angle:g}\u00b0 from the shaft's lobe 1"


def _sector(inner: float, outer: float, half: float, direction: float) -> ArcContour:
    ends = np.exp(1j * np.array([direction - half, direction + half]))
    points: FloatArray = as_points(
        np.array([outer * ends[0], outer * ends[1], inner * ends[1], inner * ends[0]])
    )
    bulge = math.tan(0.5 * half)
    return ArcContour(points, np.array([bulge, 0.0, -bulge, 0.0]))
