"""The motor against a locked output: dead zone, hysteresis and stiffness, by equilibria alone.

The output is held and the motor's torque asked up and down slowly. While the motor advances, the
gearbox drives and friction adds to what it must give; while it gives way, the output drives the
gearbox back and friction takes from it; in between it stands still. With T(x) the torque that the
gearbox passes at the motor's angle x (at the output, from the middle of the play)::

    up(x)   = T + losses that driving makes at T + drag        the motor moves on above it
    down(x) = T - losses of being driven at T - drag           and comes back below it

and in the play T is zero. x stays between where `up` and where `down` meet the torque, which is a
play operator. Angles and losses are means over crank angles and both senses; either is linearised
where its play is taken up, because loose parts have come far there (:mod:`..contact.taken_up`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.actuator.bench.readings import FrictionLine, LoopReading, read_friction, read_loop
from cqdd_design.actuator.parameters import FloatArray, MotorParameters
from cqdd_design.errors import ContactError, UsageError
from cqdd_design.gearbox.contact.rubbing import ContactFriction, PowerSense
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
from cqdd_design.gearbox.contact.taken_up import taken_up
from cqdd_design.gearbox.losses.machine import total
from cqdd_design.gearbox.precision.backlash import backlash
from cqdd_design.machine import Machine

ANGLES = 60
"""Crank angles over a period."""
SHARES = (0.01, 0.03, 0.06, 0.1, 0.15, 0.22, 0.32, 0.45, 0.6, 0.8, 1.0)
"""Torques of the equilibria, as shares of the largest."""
_FURTHER = 1.08
"""From one torque to the next beyond those."""
_SAMPLES = 2000
"""Of a predicted cycle."""
_STILL = 1e-9
"""Least rise of a branch from point to point, N m: it has one angle for every torque."""


@dataclass(frozen=True, eq=False)
class LockedOutput:
    """Branches of a machine's loop, angles at the output from the middle of the play.

    Attributes
    ----------
    ratio : int
        Motor turns over output turns, its size.
    play : float
        Of rigid parts without load, rad.
    drag : float
        Friction of motor and gearbox at rest that no load brings, N m at the output.
    torque : array (K,)
        That the gearbox passes while the motor advances, rising from zero, N m.
    driving, up : array (K,)
        Motor's angle (rad) and torque (N m at the output) there.
    driven, down : array (L,)
        The same while it gives way, as far as the greatest angle.
    """

    ratio: int
    play: float
    drag: float
    torque: FloatArray
    driving: FloatArray
    up: FloatArray
    driven: FloatArray
    down: FloatArray

    @property
    def most(self) -> float:
        """Greatest motor torque that the branches reach, N m at the output."""
        return float(self.up[-1])

    def follow(self, command: ArrayLike) -> FloatArray:
        """The motor's angle under torques asked for one after the other, rad at the output.

        Raises
        ------
        UsageError
            Beyond the torque that the branches reach.
        """
        asked = np.asarray(command, dtype=float)
        if np.abs(asked).max(initial=0.0) > self.most * (1.0 + 1e-9):
            raise UsageError(
                f"a locked output was asked for {np.abs(asked).max():.4g} N*m and its gearbox was "
                f"solved up to {self.most:.4g} N*m; solve it further."
            )
        # Both senses: what drives one way gives way the other.
        rising = _branch((-self.down[::-1], self.up), (-self.driven[::-1], self.driving))
        falling = _branch((-self.up[::-1], self.down), (-self.driving[::-1], self.driven))
        # Beyond its last point a branch is out of reach, and holds the motor nowhere.
        least = np.interp(asked, *rising, left=-np.inf)
        most = np.interp(asked, *falling, right=np.inf)
        found = np.empty(len(asked))
        place = 0.0
        for k, (low, high) in enumerate(zip(least, most, strict=True)):
            place = min(max(place, low), high)
            found[k] = place
        return found

    def cycle(self, peak: float) -> tuple[FloatArray, FloatArray]:
        """Torque (N m) and angle (rad) of a slow cycle up to a peak torque, once it repeats."""
        quarter = np.linspace(0.0, 1.0, _SAMPLES // 4, endpoint=False)
        wave = np.concatenate([quarter, 1.0 - quarter, -quarter, quarter - 1.0, [0.0]])
        twice = self.follow(peak * np.concatenate([wave, wave]))
        return peak * wave, twice[len(wave) :]

    def read(self, peak: float) -> LoopReading:
        """What the bench reads off a cycle, see :func:`.readings.read_loop`."""
        torque, angle = self.cycle(peak)
        return read_loop(torque, torque, angle)


def _branch(
    torques: tuple[FloatArray, FloatArray], angles: tuple[FloatArray, FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Torque that never falls, and angle, over one sense and then the other."""
    torque = np.maximum.accumulate(np.concatenate(torques))
    return torque + _STILL * np.arange(len(torque)), np.concatenate(angles)


def locked_output(machine: Machine, peak: float, motor: MotorParameters) -> LockedOutput:
    """Solve the gearbox of a machine against a locked output.

    Parameters
    ----------
    peak : float
        Of the motor's torque, N m at the output, above zero.
    motor : MotorParameters
        Whose own drag counts.

    Raises
    ------
    UsageError
        Where friction lets the output turn nothing: the motor would never come back.
    ContactError
        When the gearbox has no equilibrium at a torque.

    Notes
    -----
    Running friction; breaking away takes more. Carrier, housing and shaft beyond the pins' seats
    are rigid, and nothing creeps. Where the equilibrium ends before a motor that gives way stands
    at the greatest angle, its branch goes on straight.
    """
    model, friction = machine.contact, machine.friction
    n, senses = model.lobe_count, (1.0, -1.0)
    angles = perfect_angles(model, ANGLES)
    play = float(backlash(model, angles).free.mean())
    touching = [taken_up(model, angles, sense) for sense in senses]
    rest = float(total(friction.drag(0.0)))
    drag = n * (rest + motor.dry_drag)
    torque = np.concatenate([[0.0], peak * np.array(SHARES)])

    def solve(power: PowerSense, load: float) -> tuple[float, float]:
        """Angle, and the losses at the output, while the gearbox passes a torque."""
        rubbed = ContactFriction.of(model, power)
        both = [
            contact_sweep(model, sense * load, states=at.states, friction=rubbed)
            for sense, at in zip(senses, touching, strict=True)
        ]
        errors = [
            float(np.mean(at.carrier_turn + one.carrier_angle_error))
            for at, one in zip(touching, both, strict=True)
        ]
        works = [sum(friction.coulomb_work(one).values()) for one in both]
        return 0.5 * (errors[0] - errors[1]), 0.5 * n * sum(works)

    at_rest = (0.5 * play, 0.0)
    driving, more = np.array([at_rest, *(solve("drive", load) for load in torque[1:])]).T
    # Friction that helps to hold leaves less angle under the same torque: on to the same angle.
    passed = torque.tolist()
    given = [at_rest, *(solve("backdrive", load) for load in passed[1:])]
    while given[-1][0] < driving[-1]:
        passed.append(_FURTHER * passed[-1])
        try:
            given.append(solve("backdrive", passed[-1]))
        except ContactError:
            given.append(_straight_on(passed[-3:], given[-2:]))
    driven, less = np.array(given).T
    down = np.array(passed) - less - drag
    if np.any(np.diff(down[1:]) <= 0.0):
        raise UsageError(
            "friction under load takes all that the output gives back: the motor would not come "
            "back from a locked output; lower reducer.friction."
        )
    return LockedOutput(n, play, drag, torque, driving, torque + more + drag, driven, down)


def _straight_on(
    passed: Sequence[float], given: Sequence[tuple[float, float]]
) -> tuple[float, float]:
    """Angle and losses at the last of three torques, straight on from those at the first two."""
    share = (passed[2] - passed[0]) / (passed[1] - passed[0])
    angle, lost = (a + share * (b - a) for a, b in zip(*given, strict=True))
    return angle, lost


def friction_line(machine: Machine, fastest: float, motor: MotorParameters) -> FrictionLine:
    """Friction of a machine without load over speed, as a straight line.

    Parameters
    ----------
    fastest : float
        At the output, rad/s, above zero.
    motor : MotorParameters
        Whose own drag counts.
    """
    n = machine.contact.lobe_count
    speed = np.linspace(0.05, 1.0, 40) * fastest
    gearbox = total(machine.friction.drag(n * speed))
    torque = n * (gearbox + motor.dry_drag + motor.drag_slope * n * speed)
    both = np.concatenate([speed, -speed]), np.concatenate([torque, -torque])
    return read_friction(*both, least=0.0)
