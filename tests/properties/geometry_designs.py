"""Random discs and designs over the valid space, for the property tests of the geometry."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

from cqdd_design.design import Design
from cqdd_design.geometry import ArcContour, CycloidDisc, undercut_radius_limit

PAPER = CycloidDisc(10, 0.032, 0.0016, 0.0035)
CYCLOIDGEN = ((50e-3, 4e-3, 1.5e-3, 11), (45e-3, 4.5e-3, 2e-3, 10), (60e-3, 3.5e-3, 1.1e-3, 29))


@st.composite
def discs(
    draw: st.DrawFn, *, modified: bool = False, least_lobes: int = 3, most_lobes: int = 60
) -> CycloidDisc:
    """Valid discs: K1 from 0.2 to 0.9, teeth well inside both limits; design files have 4 lobes."""
    n = draw(st.integers(least_lobes, most_lobes))
    R = draw(st.floats(0.015, 0.12))
    e = draw(st.floats(0.2, 0.9)) * R / (n + 1)
    most = min(float(undercut_radius_limit(n, R, e)), R * math.sin(math.pi / (n + 1)))
    r = draw(st.floats(0.15, 0.9)) * most
    if not modified:
        return CycloidDisc(n, R, e, r)
    room = most - r
    equidistant = draw(st.floats(0.0, 0.3)) * min(room, 1e-4)
    radial = draw(st.floats(0.0, 0.3)) * min(room, 1e-4)
    rotation = draw(st.floats(0.02, 0.4)) * math.pi / (8 * n) * draw(st.sampled_from([0.0, 1.0]))
    return CycloidDisc(n, R, e, r, equidistant, radial, rotation)


def design_of(disc: CycloidDisc, **reducer: object) -> Design:
    """Return a design file with this disc; further keys of the reducer table by name."""
    tables: dict[str, object] = {
        "ratio": disc.lobe_count,
        "ring_pitch_radius": disc.ring_pitch_radius,
        "eccentricity": disc.eccentricity,
        "ring_pin_diameter": 2.0 * disc.tooth_radius,
        "modification": {
            "equidistant": disc.equidistant,
            "radial": disc.radial,
            "rotation": disc.rotation,
        },
        "output_pins": {},
        "ring": {},
    }
    tables.update(reducer)
    return Design.from_mapping({"reducer": tables}, si=True)


def joint_angles(contour: ArcContour) -> NDArray[np.float64]:
    """Change of direction at every joint, rad; zero where the contour is smooth."""
    points = contour.points @ [1.0, 1j]
    chord = np.roll(points, -1) - points
    leaving = np.exp(-0.5j * contour.sweeps) * chord
    arriving = np.roll(np.exp(0.5j * contour.sweeps) * chord, 1)
    return np.asarray(np.angle(leaving * np.conj(arriving)))
