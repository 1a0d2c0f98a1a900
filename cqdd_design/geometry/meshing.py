"""Where the ring teeth stand, and the nearest points of the finished disc."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.geometry.contours import ComplexArray, FloatArray, as_complex, as_points
from cqdd_design.geometry.cycloid import CycloidDisc

# Coarse search before the Newton iteration: the distance to a half lobe has at most a few valleys.
_GRID = 48
_NEWTON_STEPS = 60
# Newton squares its error, so the step after one this small (of a half lobe) is lost in rounding.
_CONVERGED = 1e-11
_BLOCK = 4096


@dataclass(frozen=True, eq=False)
class Projection:
    """Nearest points of a disc's finished profile.

    Attributes
    ----------
    parameter : array (...)
        Parameter of the nearest point on the profile, rad, in [0, 2 pi).
    distance : array (...)
        Signed distance to it, m; positive outside the material.
    point, normal : array (..., 2)
        The nearest point (m) and the unit normal out of the material there, in the disc's frame.
    """

    parameter: FloatArray
    distance: FloatArray
    point: FloatArray
    normal: FloatArray


def project(disc: CycloidDisc, points: ArrayLike) -> Projection:
    """Nearest points of the finished profile to points in the disc's frame.

    Parameters
    ----------
    points : array (..., 2)
        m, anywhere but the disc's centre.

    Returns
    -------
    Projection
        Exact to rounding: a bracketed Newton iteration on the closed-form profile.
    """
    wanted = as_complex(points)
    flat = np.atleast_1d(wanted).ravel()
    half = disc.half_pitch
    # The profile has the symmetry of a regular n-gon, so the nearest point lies in the same half
    # lobe as the point: fold everything into the half lobe from 0 to pi/n.
    angle = np.mod(np.angle(flat), 2.0 * np.pi)
    lobe = np.floor(angle / (2.0 * half))
    folded = flat * np.exp(-2j * half * lobe)
    mirrored = angle - 2.0 * half * lobe > half
    folded = np.where(mirrored, np.exp(2j * half) * np.conj(folded), folded)
    inner = np.concatenate(
        [
            _nearest_in_half_lobe(disc, folded[begin : begin + _BLOCK])
            for begin in range(0, max(len(folded), 1), _BLOCK)
        ]
    )
    foot, normal = disc.profile(inner)
    distance = ((folded - foot) * np.conj(normal)).real
    axis, turn = np.exp(2j * half), np.exp(2j * half * lobe)
    foot = turn * np.where(mirrored, axis * np.conj(foot), foot)
    normal = turn * np.where(mirrored, axis * np.conj(normal), normal)
    parameter = 2.0 * half * lobe + np.where(mirrored, 2.0 * half - inner, inner)
    shape = np.shape(wanted)
    return Projection(
        parameter.reshape(shape),
        distance.reshape(shape),
        as_points(foot.reshape(shape)),
        as_points(normal.reshape(shape)),
    )


def _nearest_in_half_lobe(disc: CycloidDisc, wanted: ComplexArray) -> FloatArray:
    grid = np.unique(np.concatenate([np.linspace(0.0, disc.half_pitch, _GRID), disc.breaks]))
    away = wanted[:, None] - disc.profile(grid)[0]
    nearest = (away.real**2 + away.imag**2).argmin(axis=1)
    low = grid[np.maximum(nearest - 1, 0)]
    high = grid[np.minimum(nearest + 1, len(grid) - 1)]
    found = grid[nearest]
    left = np.arange(len(wanted))
    for _ in range(_NEWTON_STEPS):
        s = found[left]
        point, normal = disc.profile(s)
        speed, bend = disc.rates(s)
        apart = (wanted[left] - point) * np.conj(normal)
        # Along the profile, and out of it: the foot is where nothing is left along.
        ahead, out = apart.imag, apart.real
        low[left] = np.where(ahead > 0.0, s, low[left])
        high[left] = np.where(ahead > 0.0, high[left], s)
        stiffness = 1.0 + bend * out
        with np.errstate(divide="ignore", invalid="ignore"):
            step = s + ahead / (speed * stiffness)
        usable = (stiffness > 0.0) & (step >= low[left]) & (step <= high[left])
        new = np.where(usable, step, 0.5 * (low[left] + high[left]))
        found[left] = new
        left = left[np.abs(new - s) > _CONVERGED * disc.half_pitch]
        if not len(left):
            break
    return np.asarray(found)


def tooth_centres(disc: CycloidDisc) -> FloatArray:
    """Nominal tooth centres (n+1, 2) in the ring's frame, the first on +x, m."""
    count = disc.ring_tooth_count
    return as_points(disc.ring_pitch_radius * np.exp(2j * np.pi * np.arange(count) / count))
