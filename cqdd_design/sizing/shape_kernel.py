"""Compiled: shape limits and area integrals of many ring stages, each by itself.

With n lobes, generation radius R, eccentricity e and tooth radius r the flank is
R e^{it} - e e^{i(n+1)t} - r N, see :mod:`cqdd_design.geometry.trochoid`. Plain numpy twins stand in
``tests/oracles/shape_plain.py``.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cqdd_design.files.kernel_cache import numba
from cqdd_design.files.kernel_part import part

PROFILE_POINTS = 24
ENVELOPE_POINTS = 41
AREA_POINTS = 24
FILLET_TRIALS = 6
_FIRST, _LAST = -0.3 * math.pi, 0.9 * math.pi
"""Places on a lobe, its valley at 0 and its tip at pi, between which a hole is nearest to it."""
_PLACE_STEP = (_LAST - _FIRST) / (PROFILE_POINTS - 1)


@part()
def _normal(n: int, K: float, t: float) -> tuple[float, float, float]:
    """Outward unit normal of the flank, and D = |1 - K1 e^{int}|."""
    real, imag = 1.0 - K * math.cos(n * t), -K * math.sin(n * t)
    length = math.sqrt(real * real + imag * imag)
    cosine, sine = math.cos(t) / length, math.sin(t) / length
    return cosine * real - sine * imag, cosine * imag + sine * real, length


@part()
def _flank(n: int, R: float, e: float, r: float, t: float) -> tuple[float, float]:
    """A point of the flank, m."""
    normal_x, normal_y, _ = _normal(n, e * (n + 1) / R, t)
    x = R * math.cos(t) - e * math.cos((n + 1) * t) - r * normal_x
    y = R * math.sin(t) - e * math.sin((n + 1) * t) - r * normal_y
    return x, y


@part()
def _at_place(n: int, R: float, e: float, r: float, place: float) -> tuple[float, float]:
    """The flank's point at a place on a lobe, m.

    Even steps of t leap through sharp valleys; even steps of place do not:
    tan(n t/2) = (1 - K1)/(1 + K1) tan(place/2).
    """
    K = e * (n + 1) / R
    sharpness = (1.0 - K) / (1.0 + K)
    t = 2.0 / n * math.atan2(sharpness * math.sin(0.5 * place), math.cos(0.5 * place))
    return _flank(n, R, e, r, t)


@part()
def _pin_circle_at(x: float, y: float, clear: float, cosine: float, sine: float) -> float:
    """Largest pin circle whose hole, in a direction, stays clear of a point; infinite if all do."""
    across = y * cosine - x * sine
    reach = clear * clear - across * across
    if reach <= 0.0:
        return np.inf
    return x * cosine + y * sine - math.sqrt(reach)


@part()
def _parabola(before: float, middle: float, after: float) -> tuple[float, float]:
    """Place (in steps from the middle) and value of the least of a parabola through three values.

    Where they hold no minimum between them: the middle, and the least of the three.
    """
    if not (before < np.inf and after < np.inf and middle <= before and middle <= after):
        return 0.0, min(min(before, after), middle)
    bend, slope = before + after - 2.0 * middle, 0.5 * (after - before)
    shift = -slope / bend if bend > 0.0 else 0.0
    return shift, middle + 0.5 * slope * shift


@numba.njit(cache=True, error_model="numpy")
def pin_circles(n: int, ring: Any, valley: Any, clear: Any, offset: Any, found: Any) -> None:
    """Largest pin circles whose holes stay clear of the lobed profile.

    Parameters
    ----------
    n : int
        Lobes.
    ring : array (G, 3)
        Of generation: R, e and r, m.
    valley : array (G,)
        Distance of the valleys from the centre, m: what decides where no point of the profile is
        in reach of a hole.
    clear, offset : array (G, K)
        How far profile and centres of holes stay apart, m, and the angle between a valley and the
        hole nearest to any, rad.
    found : array (G, K)
        Out, m.
    """
    x, y = np.empty(PROFILE_POINTS), np.empty(PROFILE_POINTS)
    sampled = np.empty(PROFILE_POINTS)
    for g in range(ring.shape[0]):
        R, e, r = ring[g, 0], ring[g, 1], ring[g, 2]
        for k in range(PROFILE_POINTS):
            x[k], y[k] = _at_place(n, R, e, r, _FIRST + k * _PLACE_STEP)
        for j in range(clear.shape[1]):
            cosine, sine = math.cos(offset[g, j]), math.sin(offset[g, j])
            least, at = np.inf, 0
            for k in range(PROFILE_POINTS):
                sampled[k] = _pin_circle_at(x[k], y[k], clear[g, j], cosine, sine)
                if sampled[k] < least:
                    least, at = sampled[k], k
            at = min(max(at, 1), PROFILE_POINTS - 2)
            shift, _ = _parabola(sampled[at - 1], sampled[at], sampled[at + 1])
            nearest = _FIRST + (at + shift) * _PLACE_STEP
            for k in range(3):
                a, b = _at_place(n, R, e, r, nearest + 0.25 * (k - 1) * _PLACE_STEP)
                sampled[k] = _pin_circle_at(a, b, clear[g, j], cosine, sine)
            least = min(_parabola(sampled[0], sampled[1], sampled[2])[1], least)
            found[g, j] = least if least < np.inf else valley[g] - clear[g, j]


@part()
def _envelope(n: int, R: float, e: float, r: float, t: float) -> tuple[float, float]:
    """A point of the second envelope, m; see :class:`~cqdd_design.geometry.conjugate`."""
    end = math.pi / n
    # The normal has the angle t + factor; the second meeting that of -exp(i (2 factor + (1-n) t)).
    K = e * (n + 1) / R
    factor = math.atan2(-K * math.sin(n * t), 1.0 - K * math.cos(n * t))
    second = 2.0 * factor + (1.0 - n) * t - end
    turned = math.atan2(-math.sin(second), -math.cos(second)) + end
    phi = turned * n / (n + 1.0)
    x, y = _flank(n, R, e, r, t)
    cosine, sine = math.cos(phi / n), -math.sin(phi / n)
    return e * math.cos(phi) + cosine * x - sine * y, e * math.sin(phi) + cosine * y + sine * x


@numba.njit(cache=True, error_model="numpy")
def reliefs_pass(n: int, ring: Any, limits: Any, clearance: float, passes: Any) -> None:
    """Whether rings have a relief whose fillets clear the disc and leave the teeth no neck.

    Parameters
    ----------
    n : int
        Lobes.
    ring : array (G, 4)
        R, e, r and the relief's root radius, m.
    limits : array (G, 2)
        Fillets to try, m, from the least to the largest; none where that is smaller.
    clearance : float
        Least distance of the fillets from what the disc sweeps, m.
    passes : array of bool (G,)
        Out.
    """
    x, y = np.empty(ENVELOPE_POINTS), np.empty(ENVELOPE_POINTS)
    for g in range(ring.shape[0]):
        R, e, r, root = ring[g, 0], ring[g, 1], ring[g, 2], ring[g, 3]
        least, most = limits[g, 0], limits[g, 1]
        passes[g] = False
        if not most >= least:
            continue
        start, end = math.acos(e * (n + 1) / R) / n, math.pi / n
        for k in range(ENVELOPE_POINTS):
            x[k], y[k] = _envelope(n, R, e, r, start + (end - start) * k / (ENVELOPE_POINTS - 1))
        for trial in range(FILLET_TRIALS):
            fillet = least * (most / least) ** (trial / (FILLET_TRIALS - 1))
            clear, slim = _fillet_fits(R, r, root, fillet, x, y)
            if clear < clearance:
                break
            if not slim:
                passes[g] = True
                break


@part(borrows=True)
def _fillet_fits(
    R: float, r: float, root: float, fillet: float, x: Any, y: Any
) -> tuple[float, bool]:
    """Clearance of a fillet from the swept disc, and whether it leaves the tooth a neck."""
    reach = root - fillet
    cosine = (reach * reach + R * R - (r + fillet) ** 2) / (2.0 * R * reach)
    to_root = math.acos(min(max(cosine, -1.0), 1.0))
    centre_x, centre_y = reach * math.cos(to_root), reach * math.sin(to_root)
    to_tooth = math.pi - math.atan2(centre_y, centre_x - R)
    tooth_x = centre_x + fillet * math.cos(to_tooth)
    tooth_y = centre_y - fillet * math.sin(to_tooth)
    root_x = centre_x + fillet * math.cos(to_root)
    root_y = centre_y + fillet * math.sin(to_root)
    clear = np.inf
    for k in range(x.size):
        away_x, away_y = x[k] - centre_x, y[k] - centre_y
        angle = math.atan2(away_y, away_x)
        if -to_tooth <= angle <= to_root:
            here = fillet - math.sqrt(away_x * away_x + away_y * away_y)
        else:
            here = min(
                math.sqrt((x[k] - tooth_x) ** 2 + (y[k] - tooth_y) ** 2),
                math.sqrt((x[k] - root_x) ** 2 + (y[k] - root_y) ** 2),
            )
        clear = min(clear, here)
    return clear, to_tooth > 0.5 * math.pi and centre_y <= fillet


@numba.njit(cache=True, error_model="numpy")
def lobed_areas(n: int, ring: Any, area: Any, polar: Any) -> None:
    """Areas, m^2, and polar moments about the centre, m^4, of lobed outlines without holes.

    Parameters
    ----------
    n : int
        Lobes.
    ring : array (G, 3)
        Of generation: R, e and r, m.
    area, polar : array (G,)
        Out.
    """
    step = 2.0 * math.pi / AREA_POINTS
    for g in range(ring.shape[0]):
        R, e, r = ring[g, 0], ring[g, 1], ring[g, 2]
        K = e * (n + 1) / R
        sharpness = math.sqrt((1.0 - K) / (1.0 + K))
        whole, squared = 0.0, 0.0
        for k in range(AREA_POINTS):
            place = step * (k + 0.5) - math.pi
            across, along = sharpness * math.sin(0.5 * place), math.cos(0.5 * place)
            t = 2.0 / n * math.atan2(across, along)
            rate = sharpness / (along * along + across * across) / n
            normal_x, normal_y, length = _normal(n, K, t)
            turn = (n + 2.0) * K * math.cos(n * t)
            bend = (1.0 + (n + 1.0) * K * K - turn) / (R * length**3)
            x, y = _flank(n, R, e, r, t)
            swept = (x * normal_x + y * normal_y) * R * length * (1.0 - r * bend) * rate
            whole += swept
            squared += (x * x + y * y) * swept
        area[g], polar[g] = 0.5 * n * step * whole, 0.25 * n * step * squared
