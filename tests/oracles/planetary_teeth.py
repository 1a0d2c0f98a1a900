"""Spur teeth generated point by point from their tools, module 1: an oracle for roots and tips."""

from __future__ import annotations

import math

import numpy as np

from cqdd_design.planetary.cutting_tools import BasicRack

RACK = BasicRack()


def inv(angle: float) -> float:
    """tan - angle."""
    return math.tan(angle) - angle


def envelope(
    centres: np.ndarray, pitch: float, rho: float, turns: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Points and unit normals (k, 2), in the gear's frame, that a rolling tool's rounding cuts.

    `centres` (k, 2) are the rounding's centre in the fixed frame, the gear's centre at the origin
    and the pitch point on +x; the gear has then turned by `turns` (k,). The common normal passes
    through the pitch point, so the fillet is the centre's path offset along it, away from there.
    """
    toward = centres - np.array([pitch, 0.0])
    units = toward / np.linalg.norm(toward, axis=1, keepdims=True)
    cosines, sines = np.cos(-turns), np.sin(-turns)
    rotations = np.moveaxis(np.array([[cosines, -sines], [sines, cosines]]), -1, 0)
    points = np.einsum("kij,kj->ki", rotations, centres + rho * units)
    return points, np.einsum("kij,kj->ki", rotations, units)


def rack_fillet(teeth: int, shift: float) -> tuple[np.ndarray, np.ndarray]:
    """Fillet that a rack's rounded tip cuts into an external gear, module 1, a SPACE on +x.

    A rack tooth is pi/2 wide on its reference line; its rounding is tangent to flank and tip line.
    The rack moves along y by half the teeth times the gear's turn, from where its tip is deepest to
    where flank and rounding meet on the line of action: radii rise, the last is the involute's
    first.
    """
    alpha, rho = RACK.pressure_angle, RACK.fillet_radius
    depth = RACK.dedendum - rho
    centre_y = math.pi / 4 - depth * math.tan(alpha) - rho / math.cos(alpha)
    rolls = np.linspace(0.0, (depth - shift) / math.tan(alpha), 20001) - centre_y
    centres = np.stack([np.full_like(rolls, teeth / 2.0 + shift - depth), centre_y + rolls], axis=1)
    return envelope(centres, teeth / 2.0, rho, rolls / (teeth / 2.0))


def ring_fillet(ring: int, cutter: int, rack: BasicRack) -> tuple[np.ndarray, np.ndarray]:
    """Fillet that a pinion cutter's rounded tip cuts into an unshifted ring, a SPACE on +x.

    The rounding is tangent to the cutter's involute and tip circle, so its centre lies on a tangent
    of the base circle, one rounding radius nearer the base than the involute.
    """
    alpha, rho = rack.pressure_angle, rack.fillet_radius
    distance = (ring - cutter) / 2.0
    base = cutter / 2.0 * math.cos(alpha)
    centre_radius = ring / 2.0 + rack.dedendum - distance - rho
    along = math.sqrt(centre_radius**2 - base**2)
    half_base = math.pi / 2.0 / cutter + math.tan(alpha) - alpha
    # The tangent's foot stands as far round as the string is long: (along + rho)/base.
    foot = half_base - (along + rho) / base
    turns = np.linspace(-1.0, 0.6, 40001)
    angles = turns + foot + math.atan2(along, base)
    centres = np.stack(
        [distance + centre_radius * np.cos(angles), centre_radius * np.sin(angles)], axis=1
    )
    return envelope(centres, ring / 2.0, rho, turns * cutter / ring)
