"""What a network sees of an episode: features of one sample, and windows of them."""

from __future__ import annotations

import numpy as np

from cqdd_design.actuator.parameters import ActuatorParameters, GearParameters
from cqdd_design.errors import UsageError, did_you_mean
from cqdd_design.torque.data.episodes import Episode, FloatArray
from cqdd_design.torque.features.acceleration import Differentiator, acceleration
from cqdd_design.torque.features.physics import (
    dry_friction,
    friction_sign,
    gear_ripple,
    motion_balance,
)

PHYSICAL = ("balance", "friction_sign", "ripple")
"""Features that are made with an actuator's parameters; see :mod:`.physics`."""
PLAIN = ("position_error", "velocity", "acceleration", *PHYSICAL)
"""Features that are no phase of the gearbox."""


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
