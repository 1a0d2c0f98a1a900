"""Curves of disc and ring from published equations, to hold the contours of DXF files against.

Nothing here comes from the package. The disc is the parametric cycloid of Shin and Kwon 2006
(Mechanism and Machine Theory 41, eqs. 9 and 10). What a conjugate ring has to be follows from the
theorem of gearing (Litvin and Fuentes 2004, section 6.1): where disc and ring touch, their common
normal passes through the pitch point, (n+1) e from the ring's axis along the crank. A normal of the
disc meets the disc's pitch circle, of radius n e, twice: once for a tooth, once between teeth.

Points are complex, in mm, ring tooth 0 and a valley of the disc on +x.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

Points = NDArray[np.complex128]
_DENSE = 40_001


class Stage(NamedTuple):
    """Lobes of the disc; pitch radius, eccentricity and tooth radius, mm."""

    n: int
    R: float
    e: float
    r: float

    @property
    def teeth(self) -> int:
        """Of the ring."""
        return self.n + 1

    @property
    def lean(self) -> float:
        """Most that a force on a tooth leans from the radius through it, rad: sin is K1."""
        return math.asin(self.e * self.teeth / self.R)


def flank(stage: Stage, t: NDArray[np.float64]) -> Points:
    """Shin and Kwon's disc at ring angles t, as written there."""
    _, R, e, r = stage
    N, psi = stage.teeth, _psi(stage, t)
    x = R * np.cos(t) - r * np.cos(t + psi) - e * np.cos(N * t)
    y = -R * np.sin(t) + r * np.sin(t + psi) + e * np.sin(N * t)
    return np.asarray(x + 1j * y)


def _psi(stage: Stage, t: NDArray[np.float64]) -> NDArray[np.float64]:
    N = stage.teeth
    away = stage.R / (stage.e * N) - np.cos((1 - N) * t)
    return np.asarray(np.arctan2(np.sin((1 - N) * t), away))


def touched(stage: Stage) -> tuple[Points, Points]:
    """Where a disc touches its ring: on the teeth, and between them; over one turn of the disc."""
    t = np.linspace(0.0, 2.0 * math.pi, _DENSE * stage.n // 4)
    at = flank(stage, t)
    normal = np.exp(-1j * (t + _psi(stage, t)))
    # |at + s normal| = n e: a root for either side of the foot of the axis on the normal.
    foot = (at * np.conj(normal)).real
    half = np.sqrt(np.maximum((stage.n * stage.e) ** 2 - np.abs(at) ** 2 + foot**2, 0.0))
    sides = []
    for s in (-foot - half, -foot + half):
        crank = np.angle(at + s * normal) * stage.n / stage.teeth
        sides.append(stage.e * np.exp(1j * crank) + at * np.exp(-1j * crank / stage.n))
    first, second = sides
    away_from = [abs(np.abs(one - _nearest_tooth(stage, one)) - stage.r) for one in sides]
    swap = away_from[1] < away_from[0]
    return np.where(swap, second, first), np.where(swap, first, second)


def _nearest_tooth(stage: Stage, points: Points) -> Points:
    pitch = 2.0 * math.pi / stage.teeth
    return np.asarray(stage.R * np.exp(1j * pitch * np.round(np.angle(points) / pitch)))


def from_tooth(stage: Stage, points: Points) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Distance from the centre of the nearest tooth, and angle there from its inward radius."""
    centre = _nearest_tooth(stage, points)
    return np.abs(points - centre), np.abs(np.angle((points - centre) / -centre))


def clearing_fillet(stage: Stage, clearance: float) -> tuple[float, complex, float]:
    """Largest fillet between tooth and root circle that is clear of the disc: radius, centre, root.

    It touches the tooth from outside and the circle R + 2 e - r + clearance from inside.
    """
    root = stage.R + 2.0 * stage.e - stage.r + clearance
    teeth, between = touched(stage)
    _, leaning = from_tooth(stage, teeth)
    swept = np.concatenate([teeth[leaning <= stage.lean], between])
    near = cKDTree(_plane(swept[np.abs(np.angle(swept)) < 2.0 * math.pi / stage.teeth]))
    half = math.pi / stage.teeth

    def placed(f: float) -> complex:
        reach, R = root - f, stage.R
        cosine = (reach**2 + R**2 - (stage.r + f) ** 2) / (2.0 * reach * R)
        return complex(reach * np.exp(1j * math.acos(min(1.0, max(-1.0, cosine)))))

    def clear(f: float) -> bool:
        centre = placed(f)
        if np.angle(centre) > half:
            return False
        first, last = np.angle(stage.R - centre), np.angle(centre)
        # Counter-clockwise, from the tooth to the root: over 0 where the tooth is below.
        arc = centre + f * np.exp(1j * np.linspace(first, last, 2001))
        return float(near.query(_plane(arc))[0].min()) >= clearance

    small, large = 0.5 * (root - stage.R - stage.r) + 1e-6, 2.0 * stage.r
    small = max(small, 0.02 * stage.r)
    sizes = np.linspace(small, large, 400)
    fits = [f for f in sizes if clear(f)]
    low = max(fits)
    high = low + sizes[1] - sizes[0]
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if clear(middle) else (low, middle)
    return low, placed(low), root


def read_contour(entity: Any, spacing: float = 0.01) -> tuple[Points, Points]:
    """Points along a closed LWPOLYLINE, and normals to the right of its way, by its bulges.

    A bulge is the tangent of a quarter of the arc's angle, positive counter-clockwise (AutoCAD
    DXF reference, group code 42).
    """
    rows = np.array(entity.get_points("xyb"))
    start = rows[:, 0] + 1j * rows[:, 1]
    points, normals = [], []
    for a, b, bulge in zip(start, np.roll(start, -1), rows[:, 2], strict=True):
        chord = b - a
        count = max(2, int(abs(chord) / spacing) + 2)
        share = np.linspace(0.0, 1.0, count, endpoint=False)
        if bulge == 0.0:
            points.append(a + share * chord)
            normals.append(np.full(count, -1j * chord / abs(chord)))
            continue
        sweep = 4.0 * math.atan(bulge)
        centre = a + 0.5 * chord + 0.5j * chord / math.tan(0.5 * sweep)
        arc = centre + (a - centre) * np.exp(1j * sweep * share)
        points.append(arc)
        normals.append((arc - centre) / abs(a - centre) * math.copysign(1.0, sweep))
    return np.concatenate(points), np.concatenate(normals)


def away(points: Points, curve: Points) -> NDArray[np.float64]:
    """Distance of points from a closed dense polyline, mm."""
    _, nearest = cKDTree(_plane(curve)).query(_plane(points))
    least = np.full(points.shape, np.inf)
    for step in (-1, 0):
        a = curve[(nearest + step) % len(curve)]
        b = curve[(nearest + step + 1) % len(curve)]
        chord = b - a
        length = np.maximum(np.abs(chord) ** 2, 1e-30)
        share = np.clip(((points - a) * np.conj(chord)).real / length, 0.0, 1.0)
        least = np.minimum(least, np.abs(points - a - share * chord))
    return least


def beyond(points: Points, contour: Points, outward: Points) -> NDArray[np.float64]:
    """How far points lie outside a contour that is sampled with its outward normals, mm."""
    _, nearest = cKDTree(_plane(contour)).query(_plane(points))
    return np.asarray(((points - contour[nearest]) * np.conj(outward[nearest])).real)


def _plane(points: Points) -> NDArray[np.float64]:
    return np.column_stack([points.real, points.imag])
