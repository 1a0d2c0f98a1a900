"""Balance of the orbiting discs: unbalance, couple, shaking force and moment.

Masses come in as :class:`~cqdd_design.results.MassProperties`, wherever they were computed. The
frame turns with the crank: x along the crank of disc 0, z along the axis from the middle of the
disc pack. Disc d of D orbits at e (cos p_d, sin p_d), p_d = 2 pi d/D::

         disc 0   disc 1   disc 2
    z =  -(b+s)     0      +(b+s)

A disc orbits with the crank but spins against it at 1/n, so only its mass at its centre takes part
in the unbalance: a plate symmetric about its own mid-plane has no couple of its own. Its cam
bearing and the eccentric under it stand at the same centre and in the same plane. Other bodies
fixed to the crank, such as counterweights, take part with all of their mass.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from cqdd_design.errors import UsageError
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.kinematics import crank_phases
from cqdd_design.results import MassProperties

BALANCING_PLANES = 2
"""Planes with a weight each that together cancel any force and any couple."""


@dataclass(frozen=True)
class StackBalance:
    """Balance of one stack of discs about the crank axis.

    Attributes
    ----------
    disc_count : int
        D.
    throw_mass : float
        Mass at the eccentricity for each disc: disc, cam bearing and eccentric, kg.
    static_unbalance : float
        |sum m r|, kg m.
    couple_unbalance : float
        |sum m r z| about the middle of the pack (products of inertia included), kg m^2.
    shaking_force, shaking_moment : float
        Both times the square of the input speed, N and N m.
    weights_missing : str
        Why balance weights that the design asks for are not among what turns; empty where they
        are, or where none are asked for.
    """

    disc_count: int
    throw_mass: float
    static_unbalance: float
    couple_unbalance: float
    shaking_force: float
    shaking_moment: float
    weights_missing: str = ""

    def to_dict(self) -> dict[str, float]:
        """Return the JSON form (``balance.by_disc_count``)."""
        return {
            "static_unbalance_kgm": self.static_unbalance,
            "couple_unbalance_kgm2": self.couple_unbalance,
            "shaking_force_N": self.shaking_force,
            "shaking_moment_Nm": self.shaking_moment,
        }


def disc_mid_planes(disc_count: int, disc_thickness: float, disc_spacing: float) -> FloatArray:
    """Heights z of the disc mid-planes from the middle of the pack, shape (D,), m."""
    pitch = disc_thickness + disc_spacing
    return np.asarray(pitch * (np.arange(disc_count) - 0.5 * (disc_count - 1)), dtype=float)


def stack_balance(
    throw_mass: float,
    eccentricity: float,
    disc_thickness: float,
    disc_spacing: float,
    disc_count: int,
    speed: float,
    crank_parts: Iterable[MassProperties] = (),
    *,
    weights_missing: str = "",
) -> StackBalance:
    """Unbalance of D equal discs and of the parts that turn with the crank.

    Parameters
    ----------
    throw_mass : float
        Mass of one disc with what goes round with it: cam bearing and eccentric, kg.
    eccentricity, disc_thickness, disc_spacing : float
        e, b and s in m.
    disc_count : int
        D, at least 1.
    speed : float
        Input speed, rad/s.
    crank_parts : iterable of MassProperties
        Other bodies fixed to the crank in the frame above, such as counterweights.
    weights_missing : str
        See `StackBalance`.

    Examples
    --------
    Two discs cancel statically and leave the couple m e (b + s):

    >>> two = stack_balance(0.1, 1.6e-3, 8e-3, 0.5e-3, 2, 134.7)
    >>> print(two.static_unbalance, round(two.couple_unbalance * 1e9, 6))
    0.0 1360.0
    """
    phases = crank_phases(disc_count)
    heights = disc_mid_planes(disc_count, disc_thickness, disc_spacing)
    throw = throw_mass * eccentricity * np.stack([np.cos(phases), np.sin(phases)])
    static = throw.sum(axis=1)
    couple = (throw * heights).sum(axis=1)
    size, moment = float(np.abs(throw).sum()), float(np.abs(throw * heights).sum())
    moment += size * disc_thickness
    for part in crank_parts:
        first = float(part.mass * np.hypot(*part.centre[:2]))
        size += first
        moment += first * abs(float(part.centre[2])) + float(np.abs(part.inertia[:2, 2]).sum())
        static = static + part.mass * part.centre[:2]
        couple = couple + part.mass * part.centre[2] * part.centre[:2]
        # The tensor holds -integral(x z dm), about the part's own centre of mass.
        couple = couple - part.inertia[:2, 2]
    static_size = _without_noise(float(np.hypot(*static)), size)
    couple_size = _without_noise(float(np.hypot(*couple)), moment)
    return StackBalance(
        disc_count=disc_count,
        throw_mass=throw_mass,
        static_unbalance=static_size,
        couple_unbalance=couple_size,
        shaking_force=static_size * speed**2,
        shaking_moment=couple_size * speed**2,
        weights_missing=weights_missing,
    )


def _without_noise(value: float, scale: float) -> float:
    """Zero where the value is rounding of terms of size `scale`."""
    return 0.0 if value < 1e-12 * scale else value


def paper_disc_count(ratio: int) -> int:
    """Discs by the paper's rule: two for an even ratio, three for an odd one, from ratio 4 up.

    The paper (section III-B) ties the number of discs to the parity of the ratio. Neither static
    nor dynamic balance depends on that parity: two discs balance statically and three leave a
    couple too. The rule is reported for comparison only.

    Raises
    ------
    UsageError
        For a ratio below 4, for which the paper states no rule.

    Examples
    --------
    >>> paper_disc_count(10), paper_disc_count(11)
    (2, 3)
    """
    if ratio < 4:
        raise UsageError(
            f"the paper's disc-count rule starts at ratio 4, not {ratio}; use a ratio of 4 or more."
        )
    return 2 if ratio % 2 == 0 else 3
