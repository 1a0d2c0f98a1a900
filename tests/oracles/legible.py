"""Whether a sheet can be read: text stands apart from text, from thick lines, and on the page."""

from __future__ import annotations

import re
from itertools import pairwise

import numpy as np

from cqdd_design.exporting.sheets.formats import BOTTOM, LEFT

THICK = 0.35
_CLEAR = 0.05


def apart(one, two):
    """Whether two rectangles of text have a gap between them."""
    for corners in (one, two):
        for begin, end in ((0, 1), (1, 2)):
            across = corners[end] - corners[begin]
            sides = [[(z * across.conjugate()).real / abs(across) for z in c] for c in (one, two)]
            if max(sides[0]) < min(sides[1]) + 0.1 or max(sides[1]) < min(sides[0]) + 0.1:
                return True
    return False


def segments(canvas, least=THICK):
    """Ends (n, 2) of the straight pieces of all strokes of a pen, curves by chords."""
    found = []
    for pen, strokes in canvas.strokes.items():
        if pen >= least:
            for stroke in strokes:
                found += _pieces(stroke)
    return np.array(found, dtype=complex).reshape(-1, 2)


def _pieces(stroke):
    numbers, points, pieces, start = [], [], [], 0j
    for word in stroke.split():
        if word not in "mlch":
            numbers.append(float(word))
            continue
        at = [complex(*numbers[i : i + 2]) for i in range(0, len(numbers), 2)]
        numbers = []
        if word == "m":
            start, points = at[0], [at[0]]
        elif word == "l":
            pieces.append((points[-1], at[0]))
            points = [at[0]]
        elif word == "h":
            pieces.append((points[-1], start))
        else:
            a, (b, c, d) = points[-1], at
            t = np.linspace(0.0, 1.0, 17)
            curve = (1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t**2 * (1 - t) * c + t**3 * d
            pieces += list(pairwise(curve.tolist()))
            points = [d]
    return pieces


def crossed(label, ends):
    """Which straight pieces run through a label."""
    corners = label.corners
    along = (corners[1] - corners[0]) / abs(corners[1] - corners[0])
    local = (ends - corners[0]) / along
    width, height = label.width, label.height
    low, high = complex(_CLEAR, _CLEAR), complex(width - _CLEAR, height - _CLEAR)
    start, step = local[:, 0], local[:, 1] - local[:, 0]
    first, last = np.zeros(len(ends)), np.ones(len(ends))
    with np.errstate(divide="ignore", invalid="ignore"):
        for p, d, a, b in (
            (start.real, step.real, low.real, high.real),
            (start.imag, step.imag, low.imag, high.imag),
        ):
            flat = np.abs(d) < 1e-12
            one, two = (a - p) / d, (b - p) / d
            enters = np.where(flat, np.where((p > a) & (p < b), -np.inf, np.inf), np.fmin(one, two))
            leaves = np.where(flat, np.inf, np.fmax(one, two))
            first, last = np.fmax(first, enters), np.fmin(last, leaves)
    return np.nonzero(first < last - 1e-9)[0]


def faults(canvas):
    """Sentences on what cannot be read."""
    said = []
    thick = segments(canvas)
    right, top = canvas.width - 10.0, canvas.height - 10.0
    for number, label in enumerate(canvas.labels):
        if label.height < 1.0:
            said.append(f"small: {label}")
        for corner in label.corners:
            inside = LEFT < corner.real < right and BOTTOM < corner.imag < top
            if not inside:
                said.append(f"off the page: {label}")
                break
        for other in canvas.labels[:number]:
            if not apart(label.corners, other.corners):
                said.append(f"on each other: {label} {other}")
        if len(crossed(label, thick)):
            said.append(f"crossed: {label}")
    return said


def assert_legible(canvas):
    """Every label can be read, and no stroke leaves the paper."""
    assert not faults(canvas), faults(canvas)
    numbers = re.findall(
        r"-?[\d.]+", " ".join(step for steps in canvas.strokes.values() for step in steps)
    )
    assert all(0.0 <= float(number) <= canvas.width for number in numbers)
