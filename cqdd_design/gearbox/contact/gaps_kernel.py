"""Compiled kernel that turns the part errors of one gearbox into gap changes over crank angle.

The plain twin is :func:`.states.error_states`. Profile errors are tabulated once round the disc
and read by cubic Hermite interpolation, which is exact where the angles fall on the table.
"""

from __future__ import annotations

import math

import numpy as np

from cqdd_design.files.kernel_cache import numba
from cqdd_design.gearbox.contact.kernel_values import Nominal, Toleranced
from cqdd_design.gearbox.contact.part_errors import SHAFT_SHARE, GearboxErrors
from cqdd_design.geometry.contours import FloatArray

_POINTS_PER_HARMONIC = 16


def table_size(angles: int, harmonics: int) -> int:
    """Points of the profile table: a multiple of the angles, fine enough for the harmonics."""
    least = max(_POINTS_PER_HARMONIC * harmonics, 1)
    return angles * -(-least // angles)


def harmonic_basis(size: int, harmonics: int) -> FloatArray:
    """Cosines and sines of orders 1 to M on the table, (size, 2, M)."""
    angle = 2.0 * np.pi * np.arange(size)[:, None] * np.arange(1, harmonics + 1) / size
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


@numba.njit(cache=True, error_model="numpy")
def fill_errors(nominal: Nominal, errors: GearboxErrors, found: Toleranced) -> None:
    """Gaps, gap rates by errors, cam offsets and play of one gearbox."""
    rows, rates, lobe_count = nominal.rows, nominal.rates, nominal.lobe_count
    basis, disc_profile = nominal.basis, errors.disc_profile
    gaps, gap_rates = found.gaps, found.gap_rates
    offset, offset_rates = found.offset, found.offset_rates
    count, discs, contacts = nominal.gaps.shape
    teeth = errors.tooth_radius.shape[0]
    size, harmonics = basis.shape[0], basis.shape[2]
    spacing = 2.0 * math.pi / size
    ox, oy = errors.output_axis[0], errors.output_axis[1]
    material = np.zeros((discs, size))
    slope = np.zeros((discs, size))
    for d in range(discs):
        for g in range(size):
            w = s = 0.0
            for m in range(harmonics):
                a, b = disc_profile[d, 0, m], disc_profile[d, 1, m]
                c, v = basis[g, 0, m], basis[g, 1, m]
                w += a * c + b * v
                s += (m + 1) * (b * c - a * v)
            material[d, g] = w
            slope[d, g] = s * spacing
        found.half_play[d] = max(0.5 * (nominal.play + errors.cam_play[d]), 0.0)
    for i in range(count):
        phi = nominal.crank_angle[i]
        # `kinematics.carrier_angle`, with which holes and pins turn.
        back = -phi / lobe_count
        cosine, sine = math.cos(back), math.sin(back)
        for d in range(discs):
            for k in range(teeth):
                nx, ny = rows[i, d, k, 0], rows[i, d, k, 1]
                spin = rates[i, d, k, 0]
                tx, ty = errors.tooth_position[k, 0], errors.tooth_position[k, 1]
                place = nominal.parameter[i, d, k] / spacing
                whole = math.floor(place + 0.5)
                if abs(place - whole) < 1e-6:
                    place = whole
                low = math.floor(place)
                u = place - low
                g0 = int(low) % size
                g1 = (g0 + 1) % size
                w0, w1 = material[d, g0], material[d, g1]
                s0, s1 = slope[d, g0], slope[d, g1]
                rise = w1 - w0
                # Cubic Hermite: w0 + u s0 + c2 u^2 + c3 u^3 meets values and slopes at both ends.
                c2 = 3.0 * rise - 2.0 * s0 - s1
                c3 = s0 + s1 - 2.0 * rise
                w = w0 + u * (s0 + u * (c2 + u * c3))
                s = (s0 + u * (2.0 * c2 + 3.0 * u * c3)) / spacing
                grown = errors.tooth_radius[k]
                gaps[i, d, k] = nominal.gaps[i, d, k] - (nx * tx + ny * ty) - grown - w
                slid = nominal.parameter_rate[i, d, k]
                gap_rates[i, d, k] = -spin * (nx * ty - ny * tx) - s * slid
            for k in range(teeth, contacts):
                j = k - teeth
                nx, ny = rows[i, d, k, 0], rows[i, d, k, 1]
                spin = rates[i, d, k, 0]
                ax = errors.hole_position[d, j, 0] - errors.pin_position[j, 0]
                ay = errors.hole_position[d, j, 1] - errors.pin_position[j, 1]
                wx, wy = cosine * ax - sine * ay, sine * ax + cosine * ay
                wider, thicker = errors.hole_radius[d, j], errors.pin_radius[j]
                # All pins stand off with the carrier's axis, which does not turn.
                open_by = nx * (wx - ox) + ny * (wy - oy)
                gaps[i, d, k] = nominal.gaps[i, d, k] + open_by + wider - thicker
                gap_rates[i, d, k] = (spin + 1.0 / lobe_count) * (nx * wy - ny * wx)
                gap_rates[i, d, k] -= spin * (nx * oy - ny * ox)
            own = phi + nominal.phases[d]
            ux, uy = math.cos(own), math.sin(own)
            along, across = errors.cam_centre[d, 0], errors.cam_centre[d, 1]
            offset[i, d, 0] = along * ux - across * uy + SHAFT_SHARE * ox
            offset[i, d, 1] = along * uy + across * ux + SHAFT_SHARE * oy
            offset_rates[i, d, 0] = -along * uy - across * ux
            offset_rates[i, d, 1] = along * ux - across * uy
