"""Compiled force laws of one contact: force and stiffness over approach.

The plain twins are in :mod:`.laws`.
"""

from __future__ import annotations

import math

from cqdd_design.files.kernel_cache import numba
from cqdd_design.files.kernel_part import part


@part(borrows=True, forceinline=True)
def palmgren_force(c: float, s: float, delta: float) -> tuple[float, float]:
    """Force and stiffness of delta = c F^0.9 + s F."""
    u = math.exp(math.log(delta / c) / 9.0)
    if s > 0.0:
        upper = math.exp(0.1 * math.log(delta / s))
        u = min(u, upper)
        for _ in range(60):
            u2 = u * u
            u8 = u2 * u2 * u2 * u2
            step = (u8 * u * (c + s * u) - delta) / (u8 * (9.0 * c + 10.0 * s * u))
            u -= step
            if abs(step) <= 1e-9 * u:
                break
    u2 = u * u
    u4 = u2 * u2
    load = u4 * u4 * u2
    return load, 1.0 / (0.9 * c / u + s)


@numba.njit(cache=True, error_model="numpy")
def johnson_force(a: float, b: float, s: float, delta: float) -> tuple[float, float]:
    """Force and stiffness of delta = F (a + s - b ln F), straight beyond the law's limit."""
    c = a + s
    limit = math.exp(0.95 * a / b - 1.0)
    steepest = c - b * (math.log(limit) + 1.0)
    edge = limit * (c - b * math.log(limit))
    if delta >= edge:
        return limit + (delta - edge) / steepest, 1.0 / steepest
    load = min(delta / c, limit)
    for _ in range(100):
        logarithm = math.log(load)
        step = (load * (c - b * logarithm) - delta) / (c - b * (logarithm + 1.0))
        new = min(max(load - step, 0.1 * load), limit)
        change = abs(new - load)
        load = new
        if change <= 1e-15 * load:
            break
    return load, 1.0 / (c - b * (math.log(load) + 1.0))


@part(borrows=True, forceinline=True)
def line_force(code: int, c: float, b: float, s: float, delta: float) -> tuple[float, float]:
    """Force and stiffness of a line contact pressed together by delta > 0."""
    if code == 0:
        return palmgren_force(c, s, delta)
    if code == 1:
        return johnson_force(c, b, s, delta)
    k = 1.0 / (c + s)
    return k * delta, k


@part(borrows=True, forceinline=True)
def radial_force(stiffness: float, exponent: float, delta: float) -> tuple[float, float]:
    """Force and stiffness of F = K delta^exponent."""
    if exponent == 1.5:
        root = math.sqrt(delta)
        return stiffness * delta * root, 1.5 * stiffness * root
    if exponent == 1.0:
        return stiffness * delta, stiffness
    load = stiffness * math.exp(exponent * math.log(delta))
    return load, exponent * load / delta
