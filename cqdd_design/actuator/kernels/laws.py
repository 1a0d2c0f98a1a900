"""Compiled laws of one element each: spring with dead zone, table over angle, wall, signal."""

from __future__ import annotations

import math
from typing import Any

from cqdd_design.files import kernel_part

FAST = {"contract", "arcp", "nsz"}
"""Fused products, reciprocals, unsigned zeros: quicker, and still the same numbers every time."""

part = kernel_part.part(fastmath=FAST, forceinline=True)
"""Decorator of what is compiled into the kernel itself: calls in the innermost loop would
cost a quarter of the speed."""


@part
def at(signal: Any, k: int) -> Any:
    """Entry k of a signal, or the only one."""
    return signal[k if signal.shape[0] > 1 else 0]


@part
def spring(
    closing: float, half_gap: float, reference: float, stiffness: float, power: float
) -> Any:
    """Deflection beyond the dead zone, torque, energy and tangent stiffness."""
    if closing > half_gap:
        deflection = closing - half_gap
    elif closing < -half_gap:
        deflection = closing + half_gap
    else:
        return 0.0, 0.0, 0.0, 0.0
    if power == 1.0:
        torque = stiffness * deflection
        return deflection, torque, 0.5 * torque * deflection, stiffness
    size = abs(deflection)
    secant = stiffness * (stiffness * size / reference) ** (power - 1.0)
    torque = secant * deflection
    return deflection, torque, torque * deflection / (power + 1.0), power * secant


@part
def look_up(table: Any, turns: float) -> Any:
    """Kinematic error, its slope, stiffness share and its slope, from a periodic cubic table.

    `table` (M, 4) holds values and slopes per interval; `turns` counts output turns of the crank.
    """
    count = table.shape[0]
    place = (turns - math.floor(turns)) * count
    low = int(place)
    x = place - low
    if low >= count:
        low -= count
    high = low + 1
    if high == count:
        high = 0
    y = x - 1.0
    a = (1.0 + 2.0 * x) * y * y
    b = x * y * y
    c = x * x * (1.0 - 2.0 * y)
    d = x * x * y
    da = 6.0 * x * y
    db = y * (3.0 * x - 1.0)
    dd = x * (3.0 * x - 2.0)
    error = a * table[low, 0] + b * table[low, 1] + c * table[high, 0] + d * table[high, 1]
    slope = da * (table[low, 0] - table[high, 0]) + db * table[low, 1] + dd * table[high, 1]
    share = a * table[low, 2] + b * table[low, 3] + c * table[high, 2] + d * table[high, 3]
    bend = da * (table[low, 2] - table[high, 2]) + db * table[low, 3] + dd * table[high, 3]
    return error, slope, share, bend


@part
def wall_spring(depth: float, stiffness: float, exponent: float) -> Any:
    """Torque and energy of the wall's spring."""
    if depth <= 0.0:
        return 0.0, 0.0
    torque = stiffness * depth**exponent
    return torque, torque * depth / (exponent + 1.0)
