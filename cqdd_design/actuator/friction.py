"""Friction of the gearbox as the simulation takes it, from the losses of its equilibria."""

from __future__ import annotations

import math

import numpy as np

from cqdd_design.actuator.parameters import FrictionParameters
from cqdd_design.gearbox.losses import LossModel
from cqdd_design.gearbox.losses.model import SENSES

STRIBECK_SPEED = 2.0
"""Motor speed by which breakaway has fallen off where friction is stated as coefficients, rad/s."""
_KNEE = 1.5
"""Over the continuous torque."""
_SPEEDS = 64
"""Between rest and the input speed, over which a Stribeck curve follows that of the films."""


def friction_parameters(
    losses: LossModel,
    torque: float,
    input_speed: float,
    *,
    peak: float = 0.0,
    drag: float = 0.0,
    cogging: float = 0.0,
) -> FrictionParameters:
    """Friction of the gearbox with the efficiencies and the backdrive torques of a loss model.

    Parameters
    ----------
    torque : float
        At which efficiency is kept in both directions, N m.
    input_speed : float
        Up to which the viscous part stands for the drag, rad/s.
    peak : float
        Torque, N m, at which losses in motion are kept too, the motor driving; none that is not
        above the first.
    drag, cogging : float
        Of the motor that the output turns with the gearbox, N m at its shaft; no part of what is
        returned.

    Notes
    -----
    The loss torque at the output is ``c + mu T``: mu from the Coulomb work at the torque, of its
    own while the motor drives and while the output does. Beyond a knee above that torque it grows
    by mu (1 + chi) for each N m, so that it is that of the loss model at the peak torque too, and
    never slower than up to there.

    Of c the part o at the output is its drag, the rest m and the motor's drag D are behind the
    friction under load, so that the slow dynamic backdrive torque is ``o + (m + D)/(1 - mu)``; m is
    such that it is that of the loss model, which knows that the first loads are carried by fewer
    teeth, and not below zero, where mu alone says too much. The static one has all friction times
    r, 1 and Stribeck's share, and the cogging C beside D, which gives r. Where friction holds any
    torque, m is the drag itself.

    Where friction follows from films, mu and the dynamic torque are those of the films at the input
    speed, the static one is that of none, and the Stribeck speed is fitted to what lies between.
    """
    machine, n = losses.machine, losses.machine.lobe_count
    forward, load, preload = load_shares(losses, torque, input_speed)
    slow, fast = machine.drag(0.0), machine.drag(input_speed)
    output = float(slow["output_bearing"]) * n
    motor = sum(float(v) for k, v in slow.items() if k != "output_bearing") + preload
    motor_rise = sum(float(fast[k] - slow[k]) for k in slow if k != "output_bearing")
    output_rise = float(fast["output_bearing"] - slow["output_bearing"]) * n
    turned, climbed = n * drag, n * (drag + cogging)
    found = losses.backdrive(
        film_speed=input_speed, shaft_running=drag, shaft_resting=drag + cogging
    )
    # Driven back without anything that drives, it stays below the knee.
    driven = found.static_torque or found.dynamic_torque or 0.0
    knee, growth = _knee(losses, torque, peak, input_speed, forward, driven)
    extra = found.static_ratio - 1.0
    if found.dynamic_torque and load < 1.0:
        motor = max((found.dynamic_torque - output) * (1.0 - load) - turned, 0.0) / n
        if found.static_torque:
            linear = output + n * motor + found.static_torque * load
            left = found.static_torque - climbed
            root = math.sqrt(max(linear**2 - 4.0 * output * load * left, 0.0))
            extra = max(2.0 * left / (linear + root) - 1.0, 0.0)
    return FrictionParameters(
        motor_coulomb=motor,
        output_coulomb=output,
        motor_viscous=motor_rise / input_speed,
        output_viscous=output_rise / (input_speed / n),
        stribeck_extra=extra,
        stribeck_speed=_stribeck_speed(losses, torque, input_speed),
        load_forward=forward,
        load_backward=load,
        load_knee=knee,
        load_growth=growth,
    )


def load_shares(losses: LossModel, torque: float, input_speed: float) -> tuple[float, float, float]:
    """Friction over the torque carried, the motor driving and the output, and that without torque.

    The last is N m at the crank. Shares below zero are those of a gearbox that binds: what presses
    its parts on one another without any torque rubs more than the torque (N m) does.
    """
    found = [losses.coulomb_work([torque, 0.0], sense, input_speed).sum(-1) for sense in SENSES]
    forward, backward = (
        losses.machine.lobe_count * float(loaded - none) / torque for loaded, none in found
    )
    return forward, backward, float(found[-1][1])


def _knee(
    losses: LossModel,
    torque: float,
    peak: float,
    input_speed: float,
    share: float,
    driven: float,
) -> tuple[float, float]:
    """Torque up to which a share of it rubs, N m, and by how much more what is above it does.

    Half above the torque of the share, or a third of the way to the peak by ratio where that is
    nearer, and no less than what drives the output back (N m): up to there friction is about a
    tenth above it at most.
    """
    knee = max(torque * min(_KNEE, math.cbrt(max(peak / torque, 1.0))), driven)
    if peak <= knee or share <= 0.0:
        return knee, 0.0
    none, most = losses.coulomb_work([0.0, peak], "drive", input_speed).sum(-1)
    slope = (losses.machine.lobe_count * float(most - none) - share * knee) / (peak - knee)
    return knee, max(slope / share - 1.0, 0.0)


def _stribeck_speed(losses: LossModel, torque: float, input_speed: float) -> float:
    """Speed of the motor whose exp(-(w/w_s)^2) is nearest to how the films' friction falls, rad/s.

    By least squares over the speeds from rest to the input speed, at a torque (N m).
    """
    if losses.film is None:
        return STRIBECK_SPEED
    speed = np.linspace(0.0, input_speed, _SPEEDS)
    work = np.array([losses.coulomb_work(torque, "drive", float(w)).sum() for w in speed])
    fall = work[0] - work[-1]
    if fall <= 0.0:
        return STRIBECK_SPEED
    left = (work - work[-1]) / fall
    tried = input_speed * np.geomspace(1e-3, 1.0, 601)
    off = np.exp(-((speed / tried[:, None]) ** 2)) - left
    return float(tried[np.argmin(np.sum(off**2, axis=1))])
