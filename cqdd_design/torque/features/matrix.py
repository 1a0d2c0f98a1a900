"""What a network sees of an episode: features of one sample, causal acceleration, windows."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cqdd_design.actuator.parameters import ActuatorParameters, GearParameters
from cqdd_design.errors import UsageError, did_you_mean
from cqdd_design.torque.data.episodes import Episode
from cqdd_design.torque.networks.artefact import Differentiator

FloatArray = NDArray[np.float64]

PHYSICAL = ("balance", "friction_sign", "ripple")
"""Features that are made with an actuator's parameters; see :mod:`.physics`."""
PLAIN = ("position_error", "velocity", "acceleration", *PHYSICAL)
"""Features that are no phase of the gearbox."""


def savitzky_golay(dt: float, points: int = 5, order: int = 2) -> Differentiator:
    """Slope, at its newest point, of the polynomial through the last samples in least squares.

    Savitzky and Golay 1964, one-sided: no sample after the newest one takes part.

    Parameters
    ----------
    dt : float
        Sample time, s.
    points : int
        Samples that take part, 2 to 64.
    order : int
        Of the polynomial, 1 to ``points - 1``. From 2 on, the group delay at zero frequency is 0,
        and the noise is greater than that of order 1.

    Raises
    ------
    UsageError
        For numbers that make no such filter.
    """
    if not (math.isfinite(dt) and dt > 0.0):
        raise UsageError(f"a differentiator's sample time {dt:g} s must be above 0.")
    if not (2 <= points <= 64 and 1 <= order < points):
        raise UsageError(
            f"a differentiator of order {order} over {points} points does not exist; take 2 to 64 "
            "points and an order from 1 to one less than them, such as 5 and 2."
        )
    past = -np.arange(points, dtype=np.float64)
    taps = np.linalg.pinv(np.vander(past, order + 1, increasing=True))[1] / dt
    delay = -0.5 * float(np.sum(taps * (past * dt) ** 2))
    # What is left of a sum that is zero by construction.
    delay = 0.0 if abs(delay) < 1e-9 * dt else delay
    return Differentiator(tuple(float(tap) for tap in taps), delay)


def acceleration(velocity: FloatArray, differentiator: Differentiator) -> FloatArray:
    """Acceleration (N,), rad/s^2, of a velocity (N,), rad/s; before its start it stood still at it.

    Sample k depends on samples up to k only.
    """
    taps = np.asarray(differentiator.taps)
    velocity = np.asarray(velocity, np.float64)
    past = np.concatenate([np.full(len(taps) - 1, velocity[0]), velocity])
    return np.convolve(past, taps, mode="valid")


@dataclass(frozen=True)
class DifferentiatorError:
    """What a differentiator does to one frequency.

    Attributes
    ----------
    frequency : float
        Hz.
    gain : float
        Over that of a true derivative.
    phase : float
        Ahead of a true derivative, rad.
    delay : float
        The lag that this phase is, s; negative where the filter leads.
    noise : float
        Standard deviation of the acceleration, over that of white noise of the velocity, 1/s.
    """

    frequency: float
    gain: float
    phase: float
    delay: float
    noise: float


def differentiator_error(
    differentiator: Differentiator, dt: float, frequency: float
) -> DifferentiatorError:
    """Gain and phase of a differentiator against a true derivative at a frequency (Hz)."""
    if not 0.0 < frequency < 0.5 / dt:
        raise UsageError(
            f"{frequency:g} Hz is not between 0 and {0.5 / dt:g} Hz, half of the sample rate."
        )
    pulse = 2.0 * math.pi * frequency
    response = sum(
        tap * cmath.exp(-1j * pulse * dt * k) for k, tap in enumerate(differentiator.taps)
    )
    ratio = response / (1j * pulse)
    phase = cmath.phase(ratio)
    return DifferentiatorError(
        frequency=frequency,
        gain=abs(ratio),
        phase=phase,
        delay=-phase / pulse,
        noise=math.sqrt(sum(tap**2 for tap in differentiator.taps)),
    )


def strongest_orders(gear: GearParameters, count: int = 4) -> tuple[int, ...]:
    """Orders of the output angle at which the gearbox's torque ripples most, ascending.

    With one energy behind kinematic error and stiffness (`transmission`), a harmonic of order K
    changes the torque under a held motor by ``K |eps_K|`` of itself by the error, and by
    ``K |s_K| d/(p + 1)`` of itself by the stiffness, d being the windup under the torque the
    error was solved for and p the stiffening.

    Raises
    ------
    UsageError
        For a gearbox without harmonics, or no order asked for.
    """
    if count < 1:
        raise UsageError(f"{count} orders of the gearbox are none; ask for 1 or more.")
    orders = np.asarray(gear.error_orders)
    windup = gear.error_torque / gear.stiffness
    error = np.hypot(gear.error_cosine, gear.error_sine)
    share = np.hypot(gear.stiffness_cosine, gear.stiffness_sine)
    weight = orders * (error + share * windup / (gear.stiffening + 1.0))
    if not np.any(weight > 0.0):
        raise UsageError(
            "this gearbox has no kinematic error and no stiffness over angle, so no phase is worth "
            "knowing; take pva-gru, or an actuator whose gearbox ripples."
        )
    best = np.argsort(-weight, kind="stable")[:count]
    return tuple(sorted(int(orders[k]) for k in best if weight[k] > 0.0))


def phase_inputs(orders: tuple[int, ...]) -> tuple[str, ...]:
    """Names ``sin_K`` and ``cos_K`` of the orders' phases."""
    return tuple(f"{wave}_{order}" for order in orders for wave in ("sin", "cos"))


def feature_matrix(
    episode: Episode,
    inputs: tuple[str, ...],
    *,
    differentiator: Differentiator | None = None,
    physics: ActuatorParameters | None = None,
) -> FloatArray:
    """Features (N, F) of every sample, raw; a sample's features depend on no later sample.

    Parameters
    ----------
    episode : Episode
    inputs : tuple of str
        Names as in `Artefact.inputs`.
    differentiator : Differentiator, optional
        Needed for ``acceleration``, ``balance`` and ``ripple``.
    physics : ActuatorParameters, optional
        Needed for those in `PHYSICAL`: the actuator whose torque is estimated.

    Raises
    ------
    UsageError
        For an unknown feature, or one without what it is made from.
    """
    made = _physical(episode, inputs, differentiator, physics)
    columns = [
        made[name] if name in made else _feature(episode, name, differentiator) for name in inputs
    ]
    return np.stack(columns, axis=1)


def _feature(episode: Episode, name: str, differentiator: Differentiator | None) -> FloatArray:
    columns = episode.columns
    if name == "position_error":
        return np.asarray(columns["target"], np.float64) - columns["position"]
    if name == "velocity":
        return np.asarray(columns["velocity"], np.float64)
    if name == "acceleration":
        return acceleration(columns["velocity"], _needed(differentiator, name))
    wave, _, order = name.partition("_")
    if wave in ("sin", "cos") and order.isdecimal() and int(order) > 0:
        turn = int(order) * np.asarray(columns["position"], np.float64)
        return np.asarray(np.sin(turn) if wave == "sin" else np.cos(turn))
    known = (*PLAIN, "sin_K", "cos_K")
    raise UsageError(
        f"there is no feature '{name}'{did_you_mean(name, known)}; there are {', '.join(known)}."
    )


def _physical(
    episode: Episode,
    inputs: tuple[str, ...],
    differentiator: Differentiator | None,
    physics: ActuatorParameters | None,
) -> dict[str, FloatArray]:
    """Those of the inputs that are made with an actuator's parameters, each made once."""
    wanted = [name for name in inputs if name in PHYSICAL]
    if not wanted:
        return {}
    from cqdd_design.torque.features.physics import (
        dry_friction,
        friction_sign,
        gear_ripple,
        motion_balance,
    )

    slopes = [_needed(differentiator, name) for name in wanted if name != "friction_sign"]
    if physics is None:
        raise UsageError(
            f"the feature '{wanted[0]}' is made with an actuator's parameters, and none are given; "
            "name its design."
        )
    made = {"friction_sign": friction_sign(physics, episode.columns["velocity"])}
    if slopes:
        made["balance"] = motion_balance(physics, episode, slopes[0])
    if "ripple" in wanted:
        left = made["balance"] - dry_friction(physics) * made["friction_sign"]
        made["ripple"] = gear_ripple(physics, episode.columns["position"], left)
    return made


def _needed(differentiator: Differentiator | None, name: str) -> Differentiator:
    if differentiator is None:
        raise UsageError(f"the feature '{name}' needs a differentiator.")
    return differentiator


def windows(matrix: FloatArray, history: int) -> FloatArray:
    """Windows (N - history + 1, history, F) of a matrix (N, F), oldest sample first; a view.

    Raises
    ------
    UsageError
        For an episode shorter than one window.
    """
    if not 1 <= history <= len(matrix):
        raise UsageError(
            f"a window of {history} samples does not fit into an episode of {len(matrix)}."
        )
    view = np.lib.stride_tricks.sliding_window_view(matrix, history, axis=0)
    return np.moveaxis(view, -1, 1)
