"""Numbers as raised bars of seven segments, which a printer can print and a person can read."""

from __future__ import annotations

import numpy as np

from cqdd_design.geometry.contours import ArcContour, PlanarPart
from cqdd_design.solids.layers import Layer

_BAR, _WIDE, _HIGH, _APART = 0.8e-3, 2.4e-3, 4.8e-3, 1.0e-3
"""Width of a bar, width and height of a digit, and from digit to digit, m."""
_GAP = 0.05e-3
"""Between bars, which do not touch, m."""
_SEGMENTS = {
    "0": "abcdef", "1": "bc", "2": "abged", "3": "abgcd", "4": "fgbc", "5": "afgcd",
    "6": "afgedc", "7": "abc", "8": "abcdefg", "9": "abcdfg",
}  # fmt: skip
_PITCH = _WIDE + _APART


def mark_width(text: str) -> float:
    """Width of a number in marks, m."""
    return len(text) * _PITCH - _APART


def marks(text: str, x: float, y: float, bottom: float, top: float) -> list[Layer]:
    """Raised bars of a number whose lower left corner is at x, y, between two heights, m."""
    found = []
    for place, sign in enumerate(text):
        corner = x + place * _PITCH
        for left, low, wide, high in _bars(sign):
            found.append(_box(corner + left, y + low, wide, high, bottom, top))
    return found


def _bars(sign: str) -> list[tuple[float, float, float, float]]:
    """Left, lower, width and height of the bars of a sign, m."""
    b, w, h, g = _BAR, _WIDE, _HIGH, _GAP
    half = 0.5 * (h - b)
    across = w - 2.0 * b - 2.0 * g
    bars = {
        "a": (b + g, h - b, across, b),
        "g": (b + g, half, across, b),
        "d": (b + g, 0.0, across, b),
        "f": (0.0, half + 0.5 * b + g, b, half + 0.5 * b - g),
        "b": (w - b, half + 0.5 * b + g, b, half + 0.5 * b - g),
        "e": (0.0, 0.0, b, half + 0.5 * b - g),
        "c": (w - b, 0.0, b, half + 0.5 * b - g),
    }
    if sign == ".":
        return [(0.5 * (w - b), 0.0, b, b)]
    if sign == "+":
        middle = 0.5 * (w - b)
        return [
            (0.0, half, middle - g, b),
            (middle, half - b, b, 3.0 * b),
            (middle + b + g, half, middle - g, b),
        ]
    if sign == "-":
        return [(0.0, half, w, b)]
    return [bars[segment] for segment in _SEGMENTS[sign]]


def _box(x: float, y: float, wide: float, high: float, bottom: float, top: float) -> Layer:
    corners = np.array([[x, y], [x + wide, y], [x + wide, y + high], [x, y + high]])
    return Layer(PlanarPart("mark", ArcContour(corners, np.zeros(4))), bottom, top)
