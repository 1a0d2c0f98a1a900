"""Torque that the output needs to turn the gearbox and its motor's shaft, with no motor torque.

With a loss torque L(T) at the output that grows with the torque T it passes, the output needs the
T at which T = L(T). Where L = c0 + c1 T that is c0/(1 - c1); c1 of one or more never turns.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

STATIC_RATIO = 1.5
"""Breakaway over running friction. Greased hard steel on hard steel: 1.3 (lard) to 1.9 (castor
oil) and 2.3 (mineral oil) in handbook tables (Marks; Kirk-Othmer), where what the ratio is of ends
at the boundary layer's coefficient; bearings are taken alike."""

NOT_INCLUDED = (
    "motor cogging and hysteresis, and friction of the motor's own bearings",
    "seals of the housing, and of bearings where reducer.friction.seals is none",
    "preload of the output bearing and loads on the output from outside",
    "weight and magnetic pull of the rotor",
)
"""What a measured backdrive torque has in it and the gearbox's own friction has not."""


@dataclass(frozen=True)
class Backdrive:
    """Backdrive torques at the output from the gearbox's own friction.

    Attributes
    ----------
    static_torque, dynamic_torque : float or None
        To break away from rest, and to keep turning, N m; None where friction holds any torque.
    load_independent : float
        c0 while turning: drag and friction by preload, N m at the output.
    load_share : float
        c1 while turning: loss torque per torque passed, near zero torque.
    static_ratio : float
        Breakaway over running friction that was used.
    output_speed : float
        Speed of the dynamic value, rad/s; 0 is the limit of slow motion.
    """

    static_torque: float | None
    dynamic_torque: float | None
    load_independent: float
    load_share: float
    static_ratio: float
    output_speed: float

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form, with what it leaves out."""
        return {
            "backdrive_static_Nm": self.static_torque,
            "backdrive_dynamic_Nm": self.dynamic_torque,
            "backdrive_load_independent_Nm": self.load_independent,
            "backdrive_load_share": self.load_share,
            "backdrive_static_ratio": self.static_ratio,
            "backdrive_speed_rad_per_s": self.output_speed,
            "backdrive_not_included": list(NOT_INCLUDED),
        }


def balance_torque(torque: ArrayLike, loss_torque: ArrayLike) -> float | None:
    """Least torque T that equals its own loss torque L(T).

    Parameters
    ----------
    torque : array_like (K,)
        Rising from zero, N m, two or more.
    loss_torque : array_like (K,)
        L at those torques, N m at the output; straight between them, and on beyond the last with
        the slope of the last stretch.

    Returns
    -------
    float or None
        N m; None where the loss stays above the torque however large that is.

    Examples
    --------
    c0 = 0.1 N m and c1 = 0.2: 0.1/(1 - 0.2).

    >>> balance_torque([0.0, 1.0, 100.0], [0.1, 0.3, 20.1])
    0.125
    >>> balance_torque([0.0, 1.0], [0.1, 1.2]) is None
    True
    """
    at, loss = np.asarray(torque, dtype=float), np.asarray(loss_torque, dtype=float)
    if loss[0] <= at[0]:
        return float(at[0])
    slope = np.diff(loss) / np.diff(at)
    for i, c1 in enumerate(slope):
        if c1 >= 1.0:
            continue
        found = float((loss[i] - c1 * at[i]) / (1.0 - c1))
        if i == len(slope) - 1 or found <= at[i + 1]:
            return found
    return None
