"""Rounding of the lobe tips after the flanks have been turned toward the lobe axis."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cqdd_design.errors import GeometryError
from cqdd_design.geometry.trochoid import GeneratedFlank

# The arc starts this many rotations (in disc angle) before the tip. Near the tip, a distance a from
# the disc's centre, the flank is a circle of radius rho, and an arc started m rotations before the
# tip gets the radius (m - 1) / (m/rho - 1/a): 4 keeps more than three quarters of rho. Fewer are
# tried where the flank is sharper at its shoulder than at its tip, which would put a wide arc
# outside the turned flank.
_STARTS = (4.0, 3.0, 2.0, 1.5, 1.25)
# The turned flank must still be most of the lobe.
_LARGEST_SHARE = 1.0 / 8.0
_SLACK = 1e-13


@dataclass(frozen=True)
class TipArc:
    """The arc that rounds a lobe tip, in the half lobe from the valley on +x to the axis at pi/n.

    Attributes
    ----------
    parameter : float
        Generating parameter at which the flank hands over to the arc, rad.
    centre : complex
        On the lobe axis, m.
    radius : float
        m.
    start_angle, sweep : float
        Direction from the centre where the flank ends, and the turn from there to the axis, rad.
    """

    parameter: float
    centre: complex
    radius: float
    start_angle: float
    sweep: float


def largest_rotation(lobe_count: int) -> float:
    """Largest rotation (rad) the blending accepts: an eighth of half a lobe pitch."""
    return _LARGEST_SHARE * math.pi / lobe_count


def fit_tip_arc(flank: GeneratedFlank, rotation: float) -> TipArc:
    """Widest of a few arcs, centred on the lobe axis, that touch both turned flanks from inside.

    Parameters
    ----------
    flank : GeneratedFlank
        The flank before turning.
    rotation : float
        Turn of each flank toward the lobe axis, rad, from 0 to `largest_rotation`.

    Raises
    ------
    GeometryError
        When no such arc stays inside both flanks.
    """
    for start in _STARTS:
        arc = _arc_starting(flank, rotation, start)
        if arc is not None:
            return arc
    raise GeometryError(
        f"modification.rotation {math.degrees(rotation) * 60.0:.4g} arcmin leaves no room for a "
        f"round lobe tip on {flank.lobe_count} lobes; lower it, or use equidistant instead."
    )


def _arc_starting(flank: GeneratedFlank, rotation: float, start: float) -> TipArc | None:
    half = math.pi / flank.lobe_count
    parameter = _parameter_at(flank, half - start * rotation)
    # In the frame of the lobe axis the mirror line is the real axis.
    turn = np.exp(1j * (rotation - half))
    point = complex(flank.point(np.asarray(parameter)) * turn)
    normal = complex(flank.normal(np.asarray(parameter)) * turn)
    if normal.imag >= 0.0:
        return None
    radius = point.imag / normal.imag
    centre = point.real - radius * normal.real
    last = _parameter_at(flank, half - rotation)
    replaced = flank.point(np.linspace(parameter, last, 65)) * turn
    if radius <= 0.0 or np.abs(replaced - centre).min() < radius * (1.0 - 1e-9) - _SLACK:
        return None
    sweep = -math.atan2(normal.imag, normal.real)
    return TipArc(parameter, complex(centre * np.exp(1j * half)), radius, half - sweep, sweep)


def _parameter_at(flank: GeneratedFlank, angle: float) -> float:
    """Parameter at which the flank of the first half lobe stands at this angle of the disc."""
    low, high = 0.0, math.pi / flank.lobe_count
    while high - low > 1e-15 * high:
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        if float(np.angle(flank.point(np.asarray(middle)))) < angle:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)
