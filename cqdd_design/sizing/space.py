"""The axes of the search."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cqdd_design.gearbox.checks import allowables
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.sizing.frame import THICKNESS_STEP, Frame
from cqdd_design.sizing.stage_tables import StageTables

IntArray = NDArray[np.intp]

PIN_COUNTS = (4, 5, 6, 8, 10, 12, 14, 16, 18, 20, 24)
"""Pin counts tried at every ratio, beside those that divide it."""
_MOST_PINS = 20
_NEAR = (0.85, 0.93, 0.975, 1.0)
_SCALE_STEP = 0.88
"""Sizes of rings over the largest: close to it, and each over the next where they are smaller."""
_THICKNESSES = 5
"""Thicknesses between the narrowest bearing and the most there is, beside the bearings' widths."""
_COARSE_SHORTENING, _COARSE_SHARE = 4, 3
"""Table nodes per step of the axes."""


@dataclass(frozen=True)
class SearchSpace:
    """Axes whose full product is screened; SI.

    Attributes
    ----------
    shortening, tooth_share : array
        Nodes of the stage tables: K1, and tooth radius over R sin(pi/(n+1)).
    pitch_scale : array
        Ring pitch radius over the largest that leaves the least ring wall, at most 1.
    pin_sizes : array of int
        Rows of ``frame.pin_sizes``.
    inset : array
        How far the pin circle stays inside the largest one, as a share of the pitch radius.
    bearings : array of int
        Rows of ``frame.bearings``.
    thickness : array
        Of one disc, ascending.
    """

    shortening: FloatArray
    tooth_share: FloatArray
    pitch_scale: FloatArray
    pin_counts: tuple[int, ...]
    pin_sizes: IntArray
    inset: FloatArray
    bearings: IntArray
    thickness: FloatArray

    @property
    def size(self) -> int:
        """Number of candidates."""
        ring = self.shortening.size * self.tooth_share.size * self.pitch_scale.size
        pins = len(self.pin_counts) * self.pin_sizes.size * self.inset.size
        return ring * pins * self.bearings.size * self.thickness.size


def largest_pitch_radius(
    frame: Frame, shortening: FloatArray, tooth_over_pitch: FloatArray
) -> FloatArray:
    """Ring pitch radius that leaves exactly the least wall outside a solid ring's relief, m.

    R + 2 e - r + clearance + wall = D/2 with e = K1 R/(n+1) and r in proportion to R.
    """
    room = frame.outer_radius - allowables.RING_WALL - frame.relief_clearance
    return np.asarray(room / (1.0 + 2.0 * shortening / (frame.lobe_count + 1) - tooth_over_pitch))


def search_space(frame: Frame, tables: StageTables) -> SearchSpace:
    """Every axis over its whole range."""
    bearings = _promising_bearings(frame)
    widths = frame.bearing_table().width[bearings]
    between = np.geomspace(float(widths.min()), frame.most_thickness, _THICKNESSES)
    return SearchSpace(
        shortening=tables.shortening[::_COARSE_SHORTENING],
        tooth_share=tables.tooth_share[::_COARSE_SHARE],
        pitch_scale=_scales(frame),
        pin_counts=_pin_counts(frame.lobe_count),
        pin_sizes=np.arange(len(frame.pin_sizes)),
        inset=np.array([0.0, 0.04]),
        bearings=bearings,
        thickness=_tenths(np.concatenate([widths, between]), frame.most_thickness),
    )


def _scales(frame: Frame) -> FloatArray:
    """From the largest ring down to where the smallest bearing and the thinnest pins just fit."""
    if not frame.smaller_rings:
        return np.array(_NEAR)
    bearing = min(one.outer_diameter for one in frame.bearings)
    around = allowables.RING_WALL + 2.0 * allowables.LIGAMENT + frame.pin_sizes[0].running_diameter
    least = min((0.5 * bearing + around) / frame.outer_radius, 1.0)
    steps = math.ceil(math.log(_NEAR[0] / least) / -math.log(_SCALE_STEP))
    smaller = _NEAR[0] * _SCALE_STEP ** np.arange(max(steps, 0), 0, -1)
    return np.concatenate([smaller, _NEAR])


def _pin_counts(lobe_count: int) -> tuple[int, ...]:
    """The usual counts and the divisors of the ratio.

    With a divisor every hole stands the same against the lobes, and holes clocked a quarter lobe
    pitch then all keep clear of the valleys.
    """
    divisors = (c for c in range(PIN_COUNTS[0], _MOST_PINS + 1) if lobe_count % c == 0)
    return tuple(sorted({*PIN_COUNTS, *divisors}))


def _tenths(thickness: FloatArray, most: float) -> FloatArray:
    """Thicknesses rounded to what can be ordered, without repeats."""
    steps = np.ceil(thickness / THICKNESS_STEP - 1e-6)
    return np.unique(np.minimum(steps, round(most / THICKNESS_STEP))) * THICKNESS_STEP


def _promising_bearings(frame: Frame) -> IntArray:
    """Bearings that could carry the least load any candidate puts on one.

    The tangential cam load T/(D n e) is least at the largest eccentricity the ring allows. When no
    bearing carries it, all are kept: the search then finds the most torque there is.
    """
    n = frame.lobe_count
    most_throw = allowables.SHORTENING_MOST * frame.outer_radius / (n + 1)
    least_load = frame.disc_torque / (n * most_throw)
    rows = np.flatnonzero(frame.bearing_table().allowed_load >= least_load)
    if rows.size == 0:
        rows = np.arange(len(frame.bearings))
    return rows
