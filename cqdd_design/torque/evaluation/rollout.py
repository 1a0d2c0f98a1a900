"""An estimator in the place of the actuator: closed loop, and long streaming.

A low error on recorded motion says little about a simulation in which the estimate moves the
joint: errors return through the state. So the estimator drives the pendulum of each episode, and
the motion is compared with the plant's.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from cqdd_design.actuator.scenario import Wall
from cqdd_design.errors import UsageError
from cqdd_design.torque.data.episodes import DataSet, Episode, FloatArray

PHYSICS_STEP = 1e-4
"""Of the pendulum, s."""
TRAIL = 64
"""Samples of the past from which one sample's features are formed."""
HOLD = 3.0
"""How long the last target is held after an episode, s."""
_RUNAWAY = 100.0
"""rad; a joint that gets there has run away."""


Stepper = Callable[[Episode], float]
"""From a record of the past to the torque (N m) at its last sample; keeps its own state."""


@dataclass(frozen=True)
class Pendulum:
    """What the joint carries.

    Attributes
    ----------
    inertia : float
        About the axis, kg m^2.
    gravity_moment : float
        m g r, N m.
    hanging_angle : float
        Joint angle at which it hangs, rad.
    viscous : float
        N m s/rad.
    """

    inertia: float
    gravity_moment: float
    hanging_angle: float = 0.0
    viscous: float = 0.0
    wall: Wall | None = None

    def load(self, angle: float, speed: float) -> float:
        """Torque against motion in the positive sense, N m."""
        found = self.gravity_moment * math.sin(angle - self.hanging_angle) + self.viscous * speed
        if self.wall is not None:
            depth = self.wall.side * (angle - self.wall.angle)
            if depth > 0.0:
                rub = max(1.0 + self.wall.damping * self.wall.side * speed, 0.0)
                found += self.wall.side * self.wall.stiffness * depth**self.wall.exponent * rub
        return found

    def advance(self, angle: float, speed: float, torque: float, duration: float) -> Any:
        """Angle, speed and work of a torque held for a duration; semi-implicit Euler."""
        steps = max(round(duration / PHYSICS_STEP), 1)
        h = duration / steps
        work = 0.0
        for _ in range(steps):
            before = speed
            speed += h * (torque - self.load(angle, speed)) / self.inertia
            angle += h * speed
            work += 0.5 * torque * h * (before + speed)
        return angle, speed, work


@dataclass(frozen=True, eq=False)
class Rollout:
    """One episode with the estimator as the actuator.

    Attributes
    ----------
    position_rms : float or None
        Difference from the plant's position, rad; None when the joint ran away.
    work, plant_work : float
        By the estimator, and by the recorded torque, over the same time, J.
    injects : bool
        Whether, with the target held, the joint's kinetic energy grew instead of dying out.
    position : array (N,)
        rad; the plant's own up to where the loop closes.
    """

    episode: str
    position_rms: float | None
    work: float
    plant_work: float
    injects: bool
    diverged: bool
    position: FloatArray


@dataclass(frozen=True)
class Drift:
    """Long streaming under periodic inputs.

    Attributes
    ----------
    growth : float
        r.m.s. of the last period over that of the first after the burn-in, less 1.
    wander : float
        Largest difference of the two periods, N m.
    """

    steps: int
    growth: float
    wander: float
    finite: bool


def pendulum_of(episode: Episode, data: DataSet) -> Pendulum | None:
    """The pendulum of an episode, None where the data set does not say what the joint carried.

    ``mass``, ``arm`` and ``wall_angle`` come from the episode's group; hanging angle, bar,
    damping and wall from the data set's facts under ``pendulum``.
    """
    mass, arm = episode.group.get("mass"), episode.group.get("arm")
    facts = data.facts.get("pendulum")
    if not isinstance(facts, Mapping):
        return None
    if not (isinstance(mass, int | float) and isinstance(arm, int | float)):
        return None
    wall = None
    if float(episode.group.get("wall", 0.0)) > 0.5:
        told, angle = facts.get("wall"), episode.group.get("wall_angle")
        if not isinstance(told, Mapping) or angle is None:
            return None
        wall = Wall(
            angle=float(angle),
            stiffness=float(told["stiffness"]),
            exponent=float(told["exponent"]),
            damping=float(told["damping"]),
            side=int(told["side"]),
        )
    moment = mass * float(facts["gravity"]) * arm + float(facts["bar_gravity_moment"])
    return Pendulum(
        inertia=mass * arm**2 + float(facts["bar_inertia"]),
        gravity_moment=moment,
        hanging_angle=float(facts["hanging_angle"]),
        viscous=float(facts["viscous"]),
        wall=wall,
    )


def rollout(
    pendulum: Pendulum, episode: Episode, stepper: Stepper, *, begin: int, hold: float = HOLD
) -> Rollout:
    """Run one episode in closed loop.

    Parameters
    ----------
    episode : Episode
        Its target is followed; its first `begin` samples warm the estimator up.
    stepper : Stepper
        Fresh.
    begin : int
        Sample at which the loop closes, from the recorded state.
    hold : float
        How long the last target is held afterwards, s.
    """
    count = len(episode)
    if not 0 < begin < count:
        raise UsageError(
            f"episode {episode.name} has {count} samples, and the estimator needs {begin} to "
            "start; record longer ones."
        )
    dt = episode.dt
    held = round(hold / dt)
    target = np.asarray(episode.columns["target"], np.float64)
    target = np.r_[target, np.full(held, target[-1])]
    position, velocity, torque = (np.zeros(count + held) for _ in range(3))
    position[: begin + 1] = episode.columns["position"][: begin + 1]
    velocity[: begin + 1] = episode.columns["velocity"][: begin + 1]
    columns = {"position": position, "target": target, "velocity": velocity, "torque": torque}
    work, diverged = 0.0, False
    for k in range(count + held):
        first = max(k + 1 - TRAIL, 0)
        past = Episode(
            episode.name, episode.group, dt, {n: v[first : k + 1] for n, v in columns.items()}
        )
        torque[k] = stepper(past)
        if k < begin or k + 1 == len(target):
            # A window that is not full yet gives no number, and none is needed.
            torque[k] = torque[k] if math.isfinite(torque[k]) else 0.0
            continue
        if not math.isfinite(torque[k]):
            diverged = True
            torque[k] = 0.0
            break
        position[k + 1], velocity[k + 1], done = pendulum.advance(
            float(position[k]), float(velocity[k]), float(torque[k]), dt
        )
        work += done if k + 1 < count else 0.0
        if not abs(position[k + 1]) < _RUNAWAY:
            diverged = True
            position[k + 1] = velocity[k + 1] = 0.0
            break
    own = slice(begin, count)
    force = np.asarray(episode.columns["torque"])[own]
    turned = np.diff(np.asarray(episode.columns["position"])[own])
    second = min(round(1.0 / dt), max(held // 2, 1))
    early, late = velocity[count : count + second], velocity[len(target) - second :]
    early_square, late_square = float(np.mean(early**2)), float(np.mean(late**2))
    difference = position[own] - episode.columns["position"][own]
    return Rollout(
        episode=episode.name,
        position_rms=None if diverged else float(np.sqrt(np.mean(difference**2))),
        work=work,
        plant_work=float(np.sum(0.5 * (force[1:] + force[:-1]) * turned)),
        injects=diverged or late_square > 1.05 * early_square + 1e-6,
        diverged=diverged,
        position=position[:count],
    )


def drift(step: Callable[[FloatArray], float], rows: FloatArray, *, steps: int = 100_000) -> Drift:
    """Stream one period of features (P, F) over and over, six times at least.

    `step` goes from the features of one sample (F,) to torque, its state kept.
    """
    period = len(rows)
    if steps < 6 * period:
        raise UsageError(f"{steps} steps are fewer than six periods of {period} samples.")
    periods = steps // period
    found = np.zeros((2, period))
    finite = True
    for turn in range(periods):
        values = [step(row) for row in rows]
        # A window that is not full yet gives no number.
        finite = finite and (turn == 0 or bool(np.all(np.isfinite(values))))
        # The state has forgotten its start after a few periods.
        if turn in (3, periods - 1):
            found[0 if turn == 3 else 1] = values
    first, last = np.sqrt(np.mean(found**2, axis=1))
    return Drift(
        steps=periods * period,
        growth=float(last / first - 1.0) if first > 0.0 else float(last > 0.0),
        wander=float(np.abs(found[1] - found[0]).max()),
        finite=finite,
    )
