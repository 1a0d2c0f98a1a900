"""Rigid-law loads of both stages as tables of pure numbers, one set per ratio.

Nothing in the rigid law but the shortening coefficient K1, the relative tooth size and the number
of pins decides the *shape* of the loads; pitch radius, torque and thickness only scale them::

    p0       = sqrt(T E*/(b R^2)) * p^(K1, r/R)             ring stage, one disc
    along u  = T/R * f(phi; K1) + T/R_w * g(phi; N_w)       radial part of the cam load
    across u = T/(n e)                                      tangential part, at every angle

So the functions of :mod:`cqdd_design.gearbox.rigid` and :mod:`~cqdd_design.gearbox.hertz`, which
the checks use too, are evaluated once at R = T = b = E* = 1 and every candidate is read from the
tables.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cqdd_design.gearbox import hertz, rigid
from cqdd_design.gearbox.checks import allowables
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.contours import FloatArray

IntArray = NDArray[np.intp]

_SHORTENING_NODES = 45
_SHARE_NODES = 31
LEAST_TOOTH_SHARE = 0.25
"""Least tooth radius searched, as a share of R sin(pi/(n+1)), where neighbouring teeth touch."""
_LEAST_TEETH_SAMPLED = 480
_LEAST_ANGLES = 8


@dataclass(frozen=True)
class StageTables:
    """Pure numbers of the rigid law for one ratio.

    Attributes
    ----------
    lobe_count : int
        n.
    shortening : array (nK,)
        Nodes of K1, evenly spaced over the range the checks allow.
    tooth_share : array (nS,)
        Nodes of the tooth radius over R sin(pi/(n+1)), evenly spaced.
    pressure : array (nK, nS)
        p^: largest Hertz pressure over the period; infinite where the tooth undercuts.
    friction : array (nK, nS)
        Mean of sum F_i s_i/T over the period, s_i from tooth contact to pitch point: losses of the
        teeth over the work at the output, for a coefficient of friction of 1.
    radial : array (2, nK, A)
        f for both senses of torque over one ring period.
    """

    lobe_count: int
    shortening: FloatArray
    tooth_share: FloatArray
    pressure: FloatArray
    friction: FloatArray
    radial: FloatArray

    @property
    def tooth_spacing(self) -> float:
        """sin(pi/(n+1)): tooth radius over pitch radius where neighbours touch."""
        return math.sin(math.pi / (self.lobe_count + 1))

    @property
    def ring_angles(self) -> int:
        """Samples over one ring period."""
        return int(self.radial.shape[-1])

    def pressure_at(self, shortening: FloatArray, share: FloatArray) -> FloatArray:
        """p^ between the nodes; infinite outside them.

        1/p^2, the torque a contact carries, is interpolated: it goes to zero evenly at undercut.
        """
        row, down = _cell(self.shortening, shortening)
        column, across = _cell(self.tooth_share, share)
        carried = self.pressure**-2
        left = carried[row, column] * (1.0 - down) + carried[row + 1, column] * down
        right = carried[row, column + 1] * (1.0 - down) + carried[row + 1, column + 1] * down
        value = left * (1.0 - across) + right * across
        inside = (share >= self.tooth_share[0] - 1e-9) & (share <= self.tooth_share[-1] + 1e-9)
        sound = inside & (value > 0.0)
        return np.where(sound, np.where(sound, value, 1.0) ** -0.5, np.inf)

    def friction_at(self, shortening: FloatArray, share: FloatArray) -> FloatArray:
        """The friction number between the nodes."""
        row, down = _cell(self.shortening, shortening)
        column, across = _cell(self.tooth_share, share)
        table = self.friction
        left = table[row, column] * (1.0 - down) + table[row + 1, column] * down
        right = table[row, column + 1] * (1.0 - down) + table[row + 1, column + 1] * down
        return np.asarray(left * (1.0 - across) + right * across)

    def radial_at(self, shortening: FloatArray) -> FloatArray:
        """Radial parts f between the nodes, (2, ..., A) for K1 of shape (...)."""
        row, along = _cell(self.shortening, shortening)
        along = along[..., None]
        return np.asarray(self.radial[:, row] * (1.0 - along) + self.radial[:, row + 1] * along)

    def pin_sums(self, pin_count: int, disc_count: int, clocking: float) -> FloatArray:
        """Sums g of the pin forces over the common period, every disc and both senses.

        Parameters
        ----------
        pin_count, disc_count : int
        clocking : float
            Of the first hole of disc 0, rad.

        Returns
        -------
        array (2, D, cells, A)
            At R_w = T = 1; `cells` ring periods make the common period.
        """
        n = self.lobe_count
        cells = n // math.gcd(n, pin_count)
        angle = kinematics.ring_period(n) * np.arange(cells * self.ring_angles) / self.ring_angles
        clockings = kinematics.hole_clocking_in_disc(
            n, clocking, kinematics.crank_phases(disc_count)
        )
        senses = np.array([1.0, -1.0])[:, None]
        forces = rigid.output_pin_forces(n, pin_count, 1.0, senses, angle, clockings)
        return np.asarray(forces.sum(axis=-1).reshape(2, disc_count, cells, self.ring_angles))

    def cam_radial_peak(
        self, radial: FloatArray, pin_sum: FloatArray, radius_ratio: FloatArray
    ) -> FloatArray:
        """Largest radial part of the cam load over T/R.

        Parameters
        ----------
        radial : array (2, ..., A)
            f from `radial` or `radial_at`.
        pin_sum : array (2, D, cells, A)
            From `pin_sums`.
        radius_ratio : array (...)
            R/R_w.

        Returns
        -------
        array (...)
            Over all discs, both senses of torque and the common period.
        """
        shape = (2, *(1,) * (radial.ndim - 2), -1, self.ring_angles)
        pins = radius_ratio[..., None, None] * pin_sum.reshape(shape)
        along = pins - radial[..., None, :]
        return np.asarray(np.abs(along).max(axis=(0, -2, -1)))


def _cell(nodes: FloatArray, value: FloatArray) -> tuple[IntArray, FloatArray]:
    """Index of the cell of evenly spaced nodes that holds each value, and the place in it."""
    step = (nodes[-1] - nodes[0]) / (nodes.size - 1)
    place = np.clip((value - nodes[0]) / step, 0.0, nodes.size - 1.0)
    index = np.minimum(place.astype(np.intp), nodes.size - 2)
    return index, place - index


def stage_tables(lobe_count: int) -> StageTables:
    """Tabulate the rigid law for one ratio.

    Parameters
    ----------
    lobe_count : int
        n, 3 or more.
    """
    n = lobe_count
    shortening = np.linspace(
        allowables.SHORTENING_LEAST, allowables.SHORTENING_MOST, _SHORTENING_NODES
    )
    share = np.linspace(LEAST_TOOTH_SHARE, allowables.TOOTH_OVERLAP_SHARE, _SHARE_NODES)
    angles = max(_LEAST_ANGLES, math.ceil(_LEAST_TEETH_SAMPLED / (n + 1)))
    angle = kinematics.ring_period(n) * np.arange(angles) / angles
    throw = shortening / (n + 1)
    force = rigid.ring_forces(n, 1.0, throw, 1.0, angle)
    curvature = rigid.ring_contact_curvature(n, 1.0, throw, angle)
    tooth = share * math.sin(math.pi / (n + 1))
    pressure = np.empty((shortening.size, share.size))
    friction = np.empty_like(pressure)
    # From the teeth's centres to the pitch point; the contact is a tooth radius nearer.
    theta = angle[:, None] - rigid.ring_tooth_angles(n)
    k1 = shortening[:, None, None]
    away = np.sqrt(1.0 + k1 * k1 - 2.0 * k1 * np.cos(theta))
    for column, radius in enumerate(tooth):
        equivalent = hertz.ring_equivalent_radius(radius, curvature)
        # Past undercut the material between tooth and flank has no thickness left.
        room = np.where(equivalent > 0.0, equivalent, np.inf)
        found = hertz.line_contact_pressure(force, 1.0, room, 1.0).max(axis=(1, 2))
        friction[:, column] = (force * np.abs(away - radius)).sum(axis=2).mean(axis=1)
        pressure[:, column] = np.where((equivalent > 0.0).all(axis=(1, 2)), found, np.inf)
    radial = np.stack(
        [rigid.ring_radial_force(n, 1.0, throw, sense, angle) for sense in (1.0, -1.0)]
    )
    return StageTables(n, shortening, share, pressure, friction, radial)
