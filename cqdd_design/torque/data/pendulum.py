"""Pendulum data: an inverted pendulum before a compliant wall, driven by the simulated actuator.

The experiment of the paper (arXiv:2410.16591, section V-A): sinusoids on a single inverted
pendulum with masses at several places of its bar. The joint stands upright at angle 0, where
gravity pushes it over. The target starts at the start angle and swings about it,
``start + amplitude sin(2 pi f t)``, which is both readings of the paper's "initial position".

The drive follows it by ``kp (target - position) - kd velocity``: the target's rate is not fed
forward, because no simulator feeds it forward either, and because a network that sees position
error and velocity could not know it.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from cqdd_design.actuator.joint_side import joint_side
from cqdd_design.actuator.packing import safe_step
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.actuator.recording import LONGEST_STEP
from cqdd_design.actuator.scenario import GRAVITY, Command, Load, Scenario, Sine, Start, Wall
from cqdd_design.actuator.simulate import Simulation, simulate
from cqdd_design.actuator.thermal import continuous_current
from cqdd_design.errors import UsageError
from cqdd_design.torque.data.episodes import Episode
from cqdd_design.torque.data.sensing import SensorChain, Truth, measured

FREQUENCIES, AMPLITUDES, STARTS = (0.3, 1.5), (0.5, 1.5), (0.0, 1.0)
"""Hz, rad, rad; paper."""
MASSES, ARMS = (1.14, 2.28), (0.25, 0.6)
"""kg, m; paper."""
BAR_LENGTH, BAR_WIDTH, BAR_THICKNESS, BAR_DENSITY = 0.65, 0.040, 0.008, 2700.0
"""A flat aluminium bar from the axis outwards, m and kg/m^3; assumed, the paper gives none."""
WALL_STIFFNESS, WALL_EXPONENT, WALL_DAMPING = 300.0, 1.5, 0.3
"""Of the wall, N m/rad^1.5 and s/rad: foam rubber, some 0.1 rad deep at 10 N m; assumed."""
WALL_SHARE = 0.5
"""Of the episodes that have a wall."""
WALL_PLACE = (0.2, 0.8)
"""Where the wall stands, over the amplitude, beyond the start angle."""
RECORDS = 10_000.0
"""Least records a second that the sensors look at, Hz."""
_BINDS = 0.995
"""Of a limit, from which it counts as binding."""
_MOST_VALUES = 24_000_000
"""Numbers in memory at once."""

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Configuration:
    """One experiment.

    Attributes
    ----------
    frequency, amplitude, start : float
        Of the target, Hz, rad, rad.
    mass, arm : float
        kg, m.
    wall_angle : float or None
        Where a wall stops positive motion, rad.
    gearbox : int
        Seed of its tolerances.
    """

    frequency: float
    amplitude: float
    start: float
    mass: float
    arm: float
    wall_angle: float | None
    gearbox: int

    def group(self) -> dict[str, float | str]:
        """As an episode's group."""
        found: dict[str, float | str] = dataclasses.asdict(self)
        del found["wall_angle"]
        found["wall"] = int(self.wall_angle is not None)
        if self.wall_angle is not None:
            found["wall_angle"] = self.wall_angle
        return found


def bar_mass() -> float:
    """Of the bar, kg."""
    return BAR_LENGTH * BAR_WIDTH * BAR_THICKNESS * BAR_DENSITY


def bar_inertia() -> float:
    """Of the bar about the joint, kg m^2."""
    return bar_mass() * (BAR_LENGTH**2 / 3.0 + BAR_WIDTH**2 / 12.0)


def pendulum_load(group: Mapping[str, float | str]) -> Load:
    """The load of an episode by its group: mass, arm, wall, wall_angle. Upright at angle 0."""
    mass, arm = float(group["mass"]), float(group["arm"])
    wall = None
    if "wall_angle" in group:
        wall = Wall(float(group["wall_angle"]), WALL_STIFFNESS, WALL_EXPONENT, WALL_DAMPING)
    moment = (mass * arm + 0.5 * bar_mass() * BAR_LENGTH) * GRAVITY
    return Load(inertia=mass * arm**2 + bar_inertia(), gravity_moment=-moment, wall=wall)


def pendulum_facts() -> dict[str, Any]:
    """What all pendulums share, for the manifest; SI."""
    return {
        "upright_angle": 0.0,
        "hanging_angle": math.pi,
        "gravity": GRAVITY,
        "viscous": 0.0,
        "bar": f"aluminium, {1e3 * BAR_LENGTH:g} x {1e3 * BAR_WIDTH:g} x "
        f"{1e3 * BAR_THICKNESS:g} mm, from the axis outwards",
        "bar_mass": bar_mass(),
        "bar_inertia": bar_inertia(),
        "bar_gravity_moment": 0.5 * bar_mass() * BAR_LENGTH * GRAVITY,
        "wall": {
            "law": "torque = stiffness depth^exponent (1 + damping speed), pushing only",
            "angle": "wall_angle of each episode's group, rad",
            "stiffness": WALL_STIFFNESS,
            "exponent": WALL_EXPONENT,
            "damping": WALL_DAMPING,
            "side": 1,
        },
        "target": "start + amplitude sin(2 pi frequency t), from rest at the start angle",
    }


def draw(
    count: int,
    seed: int,
    kind: int,
    *,
    masses: Sequence[float] = MASSES,
    gearbox: int,
) -> tuple[Configuration, ...]:
    """Draw experiments, each from its own number: more of them leave the first ones as they are.

    Kinds differ in what they draw for the same seed; masses (kg) are those to choose from.
    """
    found = []
    for i in range(count):
        g = np.random.default_rng([seed, kind, i])
        frequency, amplitude, start = (
            float(g.uniform(*span)) for span in (FREQUENCIES, AMPLITUDES, STARTS)
        )
        mass, arm = float(masses[int(g.integers(len(masses)))]), float(g.uniform(*ARMS))
        has_wall, place = g.uniform() < WALL_SHARE, float(g.uniform(*WALL_PLACE))
        wall_angle = start + place * amplitude if has_wall else None
        found.append(Configuration(frequency, amplitude, start, mass, arm, wall_angle, gearbox))
    return tuple(found)


def shortfalls(configuration: Configuration, parameters: ActuatorParameters) -> tuple[str, ...]:
    """Why the target cannot be followed exactly by this actuator; empty where it can."""
    pulse = 2.0 * math.pi * configuration.frequency
    load = pendulum_load(configuration.group())
    turn = np.linspace(0.0, 2.0 * math.pi, 181)
    swing = configuration.amplitude * np.sin(turn)
    inertia = load.inertia + parameters.reflected_inertia
    needed = -inertia * pulse**2 * swing
    needed += load.gravity_moment * np.sin(configuration.start + swing)
    most, limit = float(np.max(np.abs(needed))), parameters.torque_limit
    speed, top = configuration.amplitude * pulse, joint_side(parameters).no_load_speed
    found = []
    if speed > top:
        found.append(f"speed {speed:.3g} rad/s above the no-load speed of {top:.3g} rad/s")
    if most > limit:
        found.append(f"torque {most:.3g} N*m above the drive's limit of {limit:.3g} N*m")
    return tuple(found)


def record(
    configurations: Sequence[Configuration],
    names: Sequence[str],
    gearboxes: Mapping[int, ActuatorParameters],
    *,
    seconds: float,
    chain: SensorChain,
    seed: int,
    progress: Progress | None = None,
) -> tuple[tuple[Episode, ...], dict[str, float]]:
    """Run experiments and measure them.

    Parameters
    ----------
    configurations, names : sequences of one length
    gearboxes : mapping of seed to ActuatorParameters
        All with the same drive.
    seconds : float
        Of each episode.
    seed : int
        Of the sensor's noise.
    progress : callable, optional
        Told how many episodes are done, and of how many.

    Returns
    -------
    episodes : tuple of Episode
    facts : dict
        ``physics_step_s``, and the hottest winding of all, ``winding_degC``.

    Raises
    ------
    UsageError
        For a duration without samples, or one that memory does not hold.
    """
    if not (math.isfinite(seconds) and seconds >= 1.0 / chain.rate):
        raise UsageError(f"an episode of {seconds:g} s holds no sample at {chain.rate:g} Hz.")
    scenes = [_scenario(one) for one in configurations]
    sets = [gearboxes[one.gearbox] for one in configurations]
    step, every, rate = _steps(sets, scenes, chain)
    width = 14 * seconds * rate + 3 * seconds / step
    batch = int(_MOST_VALUES / width)
    if batch < 1:
        longest = math.floor(100.0 * _MOST_VALUES / width * seconds) / 100.0
        raise UsageError(
            f"an episode of {seconds:g} s takes {seconds / step:.3g} steps, more than memory "
            f"holds at once; use --seconds {longest:g} or less."
        )
    count = round(seconds * chain.rate) / chain.rate
    found: list[Episode] = []
    hottest = -math.inf
    for first in range(0, len(scenes), batch):
        some = range(first, min(first + batch, len(scenes)))
        run = simulate([sets[i] for i in some], [scenes[i] for i in some], count, step, every=every)
        hottest = max(hottest, float(run.winding_temperature.max()))
        for row, i in enumerate(some):
            columns = measured(
                _truth(run, row, sets[i], configurations[i], scenes[i], rate),
                chain,
                ratio=sets[i].gear.ratio,
                encoder_bits=sets[i].drive.encoder_bits,
                control_rate=sets[i].drive.control_rate,
                generator=np.random.default_rng([seed, 99, i]),
            )
            group = configurations[i].group()
            found.append(Episode(names[i], group, 1.0 / chain.rate, columns))
        if progress is not None:
            progress(len(found), len(scenes))
    return tuple(found), {"physics_step_s": step, "winding_degC": hottest}


def _scenario(configuration: Configuration) -> Scenario:
    target = Sine(configuration.amplitude, configuration.frequency, configuration.start)
    return Scenario(
        Command("position", target),
        pendulum_load(configuration.group()),
        Start(output_angle=configuration.start),
    )


def _steps(
    sets: Sequence[ActuatorParameters], scenes: Sequence[Scenario], chain: SensorChain
) -> tuple[float, int, float]:
    """Step (s), steps a record, records a second: whole numbers of them a sensor reading."""
    readings, _ = chain.acquisition(sets[0].drive.control_rate)
    step = min(safe_step(*pair, most=LONGEST_STEP) for pair in zip(sets, scenes, strict=True))
    fold = math.ceil(RECORDS / readings * (1.0 - 1e-9))
    rate = fold * readings
    every = math.ceil(1.0 / rate / step * (1.0 - 1e-9))
    return 1.0 / (rate * every), every, rate


def _truth(
    run: Simulation,
    row: int,
    parameters: ActuatorParameters,
    configuration: Configuration,
    scene: Scenario,
    rate: float,
) -> Truth:
    drive, thermal = parameters.drive, parameters.thermal
    held = min(continuous_current(parameters.motor, thermal), drive.current_limit)
    span = max(thermal.most - thermal.derating_begins, 1e-9)
    over = np.clip((run.winding_temperature[row] - thermal.derating_begins) / span, 0.0, 1.0)
    limit = drive.current_limit + over * (held - drive.current_limit)
    binds = np.abs(run.current[row]) >= _BINDS * limit
    binds |= np.abs(run.voltage[row]) >= _BINDS * drive.supply_voltage
    angle = run.output_angle[row]
    wall = configuration.wall_angle
    return Truth(
        rate=rate,
        motor_angle=run.motor_angle[row],
        target=scene.command.reference.values(run.time),
        torque=run.output_torque[row],
        current=run.current[row],
        wall=np.zeros(len(angle), bool) if wall is None else angle > wall,
        saturated=binds,
    )
