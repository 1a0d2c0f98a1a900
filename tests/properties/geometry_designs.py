"""Random discs and designs over the valid space, for the property tests of the geometry."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from hypothesis import strategies as st
from numpy.typing import ArrayLike, NDArray

from cqdd_design.design import Design
from cqdd_design.geometry.contours import ArcContour, FloatArray, as_complex, as_points
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.kinematics import disc_pose
from cqdd_design.geometry.meshing import project, tooth_centres
from cqdd_design.geometry.trochoid import undercut_radius_limit

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


@dataclass(frozen=True, eq=False)
class ToothGaps:
    """Clearance of every ring tooth at the nominal pose, A crank angles by n + 1 teeth.

    Attributes
    ----------
    gap : array (A, n+1)
        Along the common normal, m; negative is interference.
    parameter : array (A, n+1)
        Where on the profile the nearest point lies, rad.
    point, normal : array (A, n+1, 2)
        That point (m) and the unit normal from the disc to the tooth, in the ring's frame.
    """

    gap: FloatArray
    parameter: FloatArray
    point: FloatArray
    normal: FloatArray


def tooth_gaps(disc: CycloidDisc, crank_angle: ArrayLike) -> ToothGaps:
    """Clearance along the normal from the finished disc to every nominal ring tooth.

    Parameters
    ----------
    disc : CycloidDisc
        With its modification; the teeth stand on the nominal pitch circle with the nominal radius.
    crank_angle : array_like (A,) or scalar
        rad; for the disc at crank phase p, the crank angle plus p.

    Returns
    -------
    ToothGaps
        With A = 1 for a scalar angle.
    """
    turn, shift = disc_pose(disc, np.atleast_1d(np.asarray(crank_angle, dtype=float)))
    turn, shift = turn[:, None], shift[:, None]
    centres = as_complex(tooth_centres(disc))
    found = project(disc, as_points((centres - shift) / turn))
    return ToothGaps(
        found.distance - disc.tooth_radius,
        found.parameter,
        as_points(as_complex(found.point) * turn + shift),
        as_points(as_complex(found.normal) * turn),
    )
