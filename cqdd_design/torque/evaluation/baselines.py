"""Estimates that no network makes: from the current, from the controller, from fitted friction."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.errors import UsageError
from cqdd_design.torque.data.episodes import DataSet, Episode, FloatArray, asked_torque
from cqdd_design.torque.features.acceleration import Differentiator, acceleration

STRIBECK_SPEEDS = (0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0)
"""Of the output, rad/s: tried by `fit_friction`."""
SIGN_SPEEDS = (0.01, 0.03, 0.1, 0.3)
"""Output speed at which the smooth sign of friction has reached tanh(1), rad/s: tried too."""
TERMS = (
    "inertia",
    "viscous",
    "base",
    "stribeck",
    "load_forward",
    "load_backward",
    "load_forward_stribeck",
    "load_backward_stribeck",
)
"""Coefficients of the friction model, in order; kg m^2, N m s/rad, N m, N m, then 1."""


def current_estimate(parameters: ActuatorParameters, episode: Episode) -> FloatArray:
    """Current times torque constant times ratio times efficiency (N,), N m.

    The efficiency is that of the gearbox driving: 1/(1 + load_forward).

    Raises
    ------
    UsageError
        When the episode has no current.
    """
    current = episode.columns.get("current")
    if current is None:
        raise UsageError(
            f"episode {episode.name} has no current; name its column in the map, or leave the "
            "estimate from the current out."
        )
    efficiency = 1.0 / (1.0 + parameters.friction.load_forward)
    ratio = abs(parameters.gear.ratio)
    return np.asarray(current * (parameters.motor.torque_constant * ratio * efficiency))


def pd_law(data: DataSet, episode: Episode) -> FloatArray:
    """What the controller of a data set asks for (N,), N m, within the torque that it can."""
    asked = asked_torque(episode.columns, data.position_gain, data.velocity_gain)
    return np.clip(asked, *data.torque_range)


@dataclass(frozen=True)
class FrictionFit:
    """The controller's torque less fitted friction and inertia.

    The friction is that of Duclusaud et al. (BAM, 2025), model M6, as far as it is linear: base
    and Stribeck friction, both also in proportion to the load by the direction of power, and
    viscous friction. Speeds of Stribeck and of the smooth sign are searched on a grid.

    Attributes
    ----------
    law : callable
        From an `Episode` to what the controller asks for (N,), N m.
    coefficients : tuple of float
        Of `TERMS`.
    stribeck_speed, sign_speed : float
        rad/s.
    training_rmse : float
        N m.
    """

    law: Callable[[Episode], FloatArray]
    coefficients: tuple[float, ...]
    stribeck_speed: float
    sign_speed: float
    differentiator: Differentiator
    training_rmse: float

    @property
    def parameters(self) -> int:
        """Fitted numbers."""
        return len(self.coefficients) + 2

    def estimate(self, episode: Episode) -> FloatArray:
        """Output torque (N,), N m."""
        asked = self.law(episode)
        terms = _terms(episode, asked, self.stribeck_speed, self.sign_speed, self.differentiator)
        return np.asarray(asked - terms @ np.asarray(self.coefficients))


def _terms(
    episode: Episode,
    asked: FloatArray,
    stribeck_speed: float,
    sign_speed: float,
    differentiator: Differentiator,
) -> FloatArray:
    velocity = np.asarray(episode.columns["velocity"], np.float64)
    sign = np.tanh(velocity / sign_speed)
    with np.errstate(under="ignore"):
        slow = np.exp(-((velocity / stribeck_speed) ** 2))
    forward = np.abs(asked) * (asked * velocity > 0.0) * sign
    backward = np.abs(asked) * (asked * velocity <= 0.0) * sign
    return np.stack(
        [
            acceleration(velocity, differentiator),
            velocity,
            sign,
            sign * slow,
            forward,
            backward,
            forward * slow,
            backward * slow,
        ],
        axis=1,
    )


def fit_friction(
    data: DataSet, names: tuple[str, ...], differentiator: Differentiator
) -> FrictionFit:
    """Fit friction and inertia on the named episodes by least squares; no other is looked at.

    Raises
    ------
    UsageError
        Without episodes.
    """
    if not names:
        raise UsageError("friction is fitted on training episodes, and there are none.")
    law = partial(pd_law, data)
    episodes = data.named(names)
    asked = [law(episode) for episode in episodes]
    missing = np.concatenate(
        [law - one.columns["torque"] for law, one in zip(asked, episodes, strict=True)]
    )
    best: FrictionFit | None = None
    for stribeck in STRIBECK_SPEEDS:
        for sign in SIGN_SPEEDS:
            terms = np.concatenate(
                [
                    _terms(one, law, stribeck, sign, differentiator)
                    for law, one in zip(asked, episodes, strict=True)
                ]
            )
            # By normal equations: the terms are few and the samples many.
            scale = np.sqrt(np.mean(terms**2, axis=0))
            scale[scale == 0.0] = 1.0
            scaled = terms / scale
            found = np.linalg.lstsq(scaled.T @ scaled, scaled.T @ missing, rcond=1e-10)[0] / scale
            rmse = float(np.sqrt(np.mean((missing - terms @ found) ** 2)))
            if best is None or rmse < best.training_rmse:
                best = FrictionFit(
                    law,
                    coefficients=tuple(float(value) for value in found),
                    stribeck_speed=stribeck,
                    sign_speed=sign,
                    differentiator=differentiator,
                    training_rmse=rmse,
                )
    if best is None:
        raise UsageError("friction could not be fitted; the episodes are empty.")
    return best
