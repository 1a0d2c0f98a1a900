"""Shape limits and area integrals of many discs and rings at once, all as arrays.

The curve is that of :mod:`cqdd_design.geometry.trochoid`; the functions here broadcast over
designs where those of the geometry room take one design.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cqdd_design.gearbox.checks import allowables
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.trochoid import (
    locus_valley_radius,
    shortening_coefficient,
    undercut_radius_limit,
)
from cqdd_design.sizing.columns import Columns
from cqdd_design.sizing.frame import Frame

BoolArray = NDArray[np.bool_]

RADIUS_STEP = 5e-5
"""Step of ring pitch radius, pin circle and outside radius, m."""
SAMPLING_GUARD = 3e-6
"""Added to ligaments measured to sampled profiles, m: more than the sampling can miss."""


def valley_offset(frame: Frame, pin_count: int) -> float:
    """Angle between a valley of the lobes and the output hole nearest to any, rad."""
    n = frame.lobe_count
    firsts = kinematics.hole_clocking_in_disc(
        n, frame.clocking, kinematics.crank_phases(frame.disc_count)
    )
    holes = firsts[:, None] + 2.0 * np.pi * np.arange(pin_count) / pin_count
    pitch = 2.0 * np.pi / n
    inside = np.mod(holes, pitch)
    return float(np.minimum(inside, pitch - inside).min())


@dataclass(frozen=True)
class RingSizes(Columns):
    """R, e and r of ring stages, every field (G,), m."""

    pitch_radius: FloatArray
    eccentricity: FloatArray
    tooth_radius: FloatArray

    def root_radius(self, frame: Frame) -> FloatArray:
        """Of a solid ring's relief, R + 2 e - r + clearance, m."""
        reach = self.pitch_radius + 2.0 * self.eccentricity - self.tooth_radius
        return np.asarray(reach + frame.relief_clearance)


def _generation(frame: Frame, ring: RingSizes) -> FloatArray:
    """R, e and r that generate the flank, (G, 3), m."""
    sizes = ring.pitch_radius - frame.radial, ring.eccentricity, ring.tooth_radius
    return np.column_stack([*sizes[:2], sizes[2] + frame.equidistant])


def largest_pin_circle(
    frame: Frame, ring: RingSizes, hole_radius: FloatArray, offset: FloatArray
) -> FloatArray:
    """Largest pin circle whose holes keep the least ligament to the lobed profile.

    At most the frame's limit. A profile point at (rho, theta) stays q away from a hole centre at
    angle delta as long as

    R_w <= rho cos(theta - delta) - sqrt(q^2 - rho^2 sin^2(theta - delta)); the profile beside the
    valley nearest to any hole decides.

    Parameters
    ----------
    ring : RingSizes (G,)
    hole_radius, offset : array (G, ...)
        m, and angles from `valley_offset` in rad; they broadcast with each other.

    Returns
    -------
    array (G, ...)
        m; negative where no hole fits at all.
    """
    from cqdd_design.sizing.shape_kernel import pin_circles

    clear = hole_radius + allowables.LIGAMENT + SAMPLING_GUARD
    shape = np.broadcast_shapes(clear.shape, offset.shape)
    found = np.empty((shape[0], math.prod(shape[1:])))
    clear, offset = (
        np.array(np.broadcast_to(one, shape)).reshape(found.shape) for one in (clear, offset)
    )
    valley = valley_distance(frame, ring)
    pin_circles(frame.lobe_count, _generation(frame, ring), valley, clear, offset, found)
    return np.minimum(found.reshape(shape), frame.pin_circle_limit)


def largest_pitch_for_wall(
    frame: Frame, eccentricity: FloatArray, tooth_radius: FloatArray
) -> FloatArray:
    """Ring pitch radius that leaves exactly the least wall outside a solid ring's relief, m."""
    room = frame.outer_radius - allowables.RING_WALL - frame.relief_clearance
    return np.asarray(room - 2.0 * eccentricity + tooth_radius)


def outer_radius(frame: Frame, ring: RingSizes) -> FloatArray:
    """Of the smallest ring with the least wall outside a solid ring's relief, m.

    On the grid of `RADIUS_STEP`, large enough for the motor to be drawn round it, and within what
    the requirements allow.
    """
    if not frame.smaller_rings:
        return np.full(ring.pitch_radius.shape, frame.outer_radius)
    least = np.maximum(ring.root_radius(frame) + allowables.RING_WALL, frame.least_outer_radius)
    return np.minimum(np.ceil(least / RADIUS_STEP - 1e-6) * RADIUS_STEP, frame.outer_radius)


def valley_distance(frame: Frame, ring: RingSizes) -> FloatArray:
    """Distance of the finished disc's valleys from its centre, m."""
    tooth = ring.tooth_radius + frame.equidistant
    return np.asarray(ring.pitch_radius - frame.radial - ring.eccentricity - tooth)


def profile_checks(frame: Frame, ring: RingSizes) -> dict[str, BoolArray]:
    """Whether each ring stage (G,) meets the shape checks that depend on it alone, by check."""
    R, e, r = ring.pitch_radius, ring.eccentricity, ring.tooth_radius
    n = frame.lobe_count
    k1 = shortening_coefficient(n, R, e)
    slack = 1.0 + 1e-9
    concave = locus_valley_radius(n, R - frame.radial, e) + r + frame.equidistant
    return {
        "GEO-K1-LEAST": k1 * slack >= allowables.SHORTENING_LEAST,
        "GEO-K1-MOST": k1 <= allowables.SHORTENING_MOST * slack,
        "GEO-UNDERCUT": (r <= allowables.UNDERCUT_SHARE * undercut_radius_limit(n, R, e))
        & (r + frame.equidistant < undercut_radius_limit(n, R - frame.radial, e)),
        "GEO-TOOTH-OVERLAP": r
        <= allowables.TOOTH_OVERLAP_SHARE * R * math.sin(math.pi / (n + 1)) * slack,
        "GEO-RING-WALL": (frame.outer_radius - ring.root_radius(frame)) * slack
        >= allowables.RING_WALL,
        "EDM-DISC": concave >= frame.wire_radius,
    }


def relief_passes_wire(frame: Frame, ring: RingSizes) -> BoolArray:
    """Whether a solid ring (G,) has a relief whose fillets the wire can follow.

    A fillet between tooth and root circle must clear everything the disc sweeps and leave the
    tooth a neck. Fillets up from the wire's own radius are tried; finer ones would not help.
    """
    from cqdd_design.sizing.shape_kernel import reliefs_pass

    R, e, r = ring.pitch_radius, ring.eccentricity, ring.tooth_radius
    root = ring.root_radius(frame)
    across = R * math.cos(math.pi / (frame.lobe_count + 1))
    groove = (root * root + R * R - 2.0 * root * across - r * r) / (2.0 * (root + r - across))
    least = np.maximum(frame.wire_radius, 0.5 * (root - R - r))
    passes = np.empty(R.shape, dtype=bool)
    reliefs_pass(
        frame.lobe_count,
        np.column_stack([R, e, r, root]),
        np.column_stack([least, groove]),
        frame.relief_clearance,
        passes,
    )
    return passes


def profile_integrals(frame: Frame, ring: RingSizes) -> tuple[FloatArray, FloatArray]:
    """Areas (G,), m^2, and polar moments about the centre (G,), m^4, of lobed outlines.

    By Green's theorem, without holes; the trapezoidal rule is spectral here.
    """
    from cqdd_design.sizing.shape_kernel import lobed_areas

    area, polar = np.empty((2, ring.pitch_radius.size))
    lobed_areas(frame.lobe_count, _generation(frame, ring), area, polar)
    return area, polar


def ring_opening_area(frame: Frame, ring: RingSizes) -> FloatArray:
    """Area inside a solid ring: root circle less n+1 teeth, each a lens of two circles, m^2.

    The fillets beside the teeth are left out.
    """
    R, r, root = ring.pitch_radius, ring.tooth_radius, ring.root_radius(frame)
    toward_tooth = np.clip((R * R + r * r - root * root) / (2.0 * R * r), -1.0, 1.0)
    toward_centre = np.clip((R * R + root * root - r * r) / (2.0 * R * root), -1.0, 1.0)
    half_tooth, half_root = np.arccos(toward_tooth), np.arccos(toward_centre)
    lens = r * r * (half_tooth - 0.5 * np.sin(2.0 * half_tooth)) + root * root * (
        half_root - 0.5 * np.sin(2.0 * half_root)
    )
    return np.asarray(np.pi * root * root - (frame.lobe_count + 1) * lens)
