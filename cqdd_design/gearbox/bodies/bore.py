"""How the bore is held: the cam bearing's outer ring in it, carried by rolling elements.

The ring is pressed in and moves with the bore. Rolling elements stand under it on the side of the
load; they are radial springs, stiffest where they carry most. Their own yielding is the cam spring
of the equilibrium already, so what counts here is the elastic disc on them less the rigid disc on
the same springs: never less than nothing, and nothing for a rigid disc.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.catalog.bearings import Bearing
from cqdd_design.gearbox.contact.laws import CamSpring, ball_complement
from cqdd_design.geometry.contours import FloatArray

_STEEL = 206e9
"""Young's modulus of bearing steel, Pa."""


@dataclass(frozen=True)
class OuterRing:
    """A cam bearing's outer ring as a flat annulus.

    Attributes
    ----------
    outer, raceway : float
        Radii, m; equal where the rollers run in the bore itself.
    width, modulus : float
        m, Pa.
    """

    outer: float
    raceway: float
    width: float
    modulus: float = _STEEL

    @classmethod
    def of(cls, bearing: Bearing) -> OuterRing:
        """Ring of a catalogue bearing, as thick as at the bottom of its raceway."""
        outer = 0.5 * bearing.outer_diameter
        if bearing.kind == "needle cage":
            return cls(outer, outer, bearing.width)
        if bearing.kind == "needle":
            needles = bearing.needles
            return cls(outer, 0.5 * (needles.pitch_diameter + needles.diameter), bearing.width)
        ball = ball_complement(bearing)[1]
        pitch = 0.5 * (bearing.outer_diameter + bearing.bore_diameter)
        return cls(outer, 0.5 * (pitch + ball), bearing.width)


_PEAK_SHARE = {1.5: 4.37, 10.0 / 9.0: 4.08}
"""Load of the busiest of Z elements over F/Z, by exponent (Harris and Kotzalas 2006, ch. 7)."""


def element_stiffness(
    cam: CamSpring, force: ArrayLike, angle: FloatArray, direction: ArrayLike
) -> FloatArray:
    """Secant stiffness of the rolling elements round the raceway at a load.

    Parameters
    ----------
    cam : CamSpring
        Their law as a whole.
    force : array_like (...)
        Cam load, N.
    angle : array (B,)
        Stations round the raceway, evenly, rad.
    direction : array_like (...)
        Of the force on the disc, rad.

    Returns
    -------
    array (..., B)
        Radial stiffness of every station, N/m; zero on the side without load.
    """
    share = _PEAK_SHARE[cam.exponent]
    load = np.asarray(force, dtype=float)[..., None]
    sink = (load / cam.stiffness) ** (1.0 / cam.exponent)
    cosine = np.clip(np.cos(angle - np.asarray(direction)[..., None]), 0.0, None)
    density = np.where(cosine > 0.0, cosine ** (cam.exponent - 1.0), 0.0)
    return np.asarray(share * load / (len(angle) * sink) * density)


@dataclass(frozen=True, eq=False)
class Reactions:
    """What unit loads of a disc on rolling elements call up.

    Attributes
    ----------
    stations : array (..., B, C)
        Radial forces on the disc at the stations, outward.
    drift : array (..., 2, C)
        Displacement of the disc as a whole, m/N.
    """

    stations: FloatArray
    drift: FloatArray


def reactions(
    to_stations: FloatArray,
    stations: FloatArray,
    direction: FloatArray,
    radial: FloatArray,
    stiffness: FloatArray,
) -> Reactions:
    """Solve a disc on its rolling elements for unit loads.

    Parameters
    ----------
    to_stations : array (..., C, B)
        Compliance between loads and radial loads at the stations, reactions spread evenly round the
        raceway, m/N.
    stations : array (B, B)
        The same between stations.
    direction : array (..., C, 2)
        Of every load.
    radial : array (B, 2)
        Outward, of every station.
    stiffness : array (..., B)
        Of the elements, N/m.
    """
    root = np.sqrt(stiffness)
    moved = root[..., None] * radial
    flexible = np.eye(len(stations)) + root[..., None] * stations * root[..., None, :]
    given = root[..., None] * np.swapaxes(to_stations, -1, -2)
    # Forces f = -r y: (1 + r G r) y = r (G_b F + H t), and equilibrium r H' y = h' F.
    solved = np.linalg.solve(flexible, np.concatenate([given, moved], axis=-1))
    count = direction.shape[-2]
    by_load, by_motion = solved[..., :count], solved[..., count:]
    across = np.swapaxes(moved, -1, -2)
    unbalanced = np.swapaxes(direction, -1, -2) - across @ by_load
    drift = np.linalg.solve(across @ by_motion, unbalanced)
    forces = -root[..., None] * (by_load + by_motion @ drift)
    return Reactions(np.asarray(forces, dtype=float), np.asarray(drift, dtype=float))
