"""The whole data set in one call: a gearbox to train on, others to test on, a mass held back."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.motor import beyond_peak
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.actuator.specimen import AS_DRAWN, Specimen
from cqdd_design.errors import DesignError, UsageError
from cqdd_design.machine import Machine
from cqdd_design.machine.overload import overload
from cqdd_design.torque.data import pendulum
from cqdd_design.torque.data.episodes import DataSet, FloatArray
from cqdd_design.torque.data.sensing import SensorChain
from cqdd_design.version import __version__

EPISODES = 320
"""On the gearbox of training: a fifth of them tests, 64."""
SECONDS = 10.0
HELD_MASS = 1.71
"""kg, between the two masses of training."""
UNIT_GEARBOXES = 4
HELD_SHARE, UNIT_SHARE, LEAST_EXTRA = 1.0 / 8.0, 1.0 / 32.0, 4
"""Further episodes, over those of training: with the held mass, on each other gearbox; least."""
MOST_EPISODES = 100_000
RIPPLE_BAND = (10.0, 25.0)
"""Hz; the paper's ripple is at 17 to 20 Hz."""
RIPPLE_EPISODES = 12
"""Experiments run again with a perfect profile, to tell the ripple from all else in its band."""
_POOL, _HELD, _UNITS = 0, 1, 2

Tell = Callable[[str], None]


@dataclass(frozen=True)
class Request:
    """What to generate.

    Attributes
    ----------
    episodes : int
        On the gearbox of training.
    seconds : float
        Of each episode.
    gearbox : int
        Seed of the gearbox of training.
    unit_gearboxes : int
        Further gearboxes, of the seeds that follow, for the unit-to-unit test alone. All of them
        run the same experiments, so that only the gearbox tells them apart.
    held_mass : float or None
        kg; a mass that the test set "mass" alone contains.
    seed : int
        Of experiments and sensor noise.
    voltage, position_gain, velocity_gain : float, optional
        Default those of the design; V, N m/rad, N m s/rad.
    """

    episodes: int = EPISODES
    seconds: float = SECONDS
    gearbox: int = 1
    unit_gearboxes: int = UNIT_GEARBOXES
    held_mass: float | None = HELD_MASS
    seed: int = 0
    voltage: float | None = None
    position_gain: float | None = None
    velocity_gain: float | None = None

    def __post_init__(self) -> None:
        """Refuse what cannot be generated."""
        if not 1 <= self.episodes <= MOST_EPISODES:
            raise UsageError(f"{self.episodes} episodes are not within 1 to {MOST_EPISODES}.")
        if not 0 <= self.unit_gearboxes <= 1000:
            raise UsageError(f"{self.unit_gearboxes} unit gearboxes are not within 0 to 1000.")
        for name in ("seed", "gearbox"):
            if not 0 <= getattr(self, name) < 2**63:
                raise UsageError(f"{name} {getattr(self, name)} is not within 0 to 2^63.")
        for name in ("position_gain", "velocity_gain"):
            value = getattr(self, name)
            if value is not None and not (math.isfinite(value) and value >= 0.0):
                raise UsageError(f"a {name.replace('_', ' ')} of {value:g} must be 0 or more.")
        if self.position_gain == 0.0:
            raise UsageError("a position gain of 0 follows no target; leave it out for the design.")
        if self.held_mass is not None:
            if not (math.isfinite(self.held_mass) and self.held_mass > 0.0):
                raise UsageError(f"a held mass of {self.held_mass:g} kg must be above 0.")
            if self.held_mass in pendulum.MASSES:
                raise UsageError(
                    f"the held mass {self.held_mass:g} kg is one of training's "
                    f"({pendulum.MASSES[0]:g} and {pendulum.MASSES[1]:g} kg), and would hold "
                    f"nothing back; {HELD_MASS:g} kg lies between."
                )


def generate(
    machine: Machine,
    request: Request | None = None,
    *,
    specimen: Specimen = AS_DRAWN,
    tell: Tell | None = None,
    progress: pendulum.Progress | None = None,
) -> tuple[DataSet, tuple[str, ...]]:
    """Generate pendulum data of a machine.

    Parameters
    ----------
    machine : Machine
        Of the specimen's motor.
    specimen : Specimen
        Its motor and its factors; gearboxes are those of the request. The factor of the
        tolerances is left out: the ripple is what the contact equilibrium of the drawn gearbox
        gives.
    tell : callable, optional
        Told what begins.
    progress : callable, optional
        Told how many episodes are done, and of how many.

    Returns
    -------
    data : DataSet
        By facts ``training_gearbox`` and ``held_mass_kg`` the splits know what to hold back.
    warnings : tuple of str

    Raises
    ------
    UsageError
        For a duration that does not fit, or factors that do not exist.
    DesignError
        When the design makes no actuator, naming the seed where a drawn gearbox does not.
    """
    asked = request or Request()
    sensors = SensorChain()
    say = tell or (lambda text: None)
    warnings = []
    design, factors = machine.given, dict(specimen.factors)
    if factors.pop("tolerance_scale", None) is not None:
        warnings.append(
            "the calibration's tolerance_scale is left out: the ripple is that of the drawn "
            "gearbox, and is not adjusted."
        )
    seeds = [asked.gearbox + i for i in range(asked.unit_gearboxes + 1)]
    gearboxes = {}
    for seed in seeds:
        say(f"contact equilibrium of gearbox {seed}")
        drawn = dataclasses.replace(specimen, seed=seed, factors=factors)
        gearboxes[seed] = _gearbox(machine, drawn, asked)
    plans = _experiments(asked)
    names = [f"{kind}-{number:04d}" for kind, number, _ in plans]
    experiments = [one for _, _, one in plans]
    say(f"simulating {len(plans)} episodes of {asked.seconds:g} s")
    episodes, found = pendulum.record(
        experiments,
        names,
        gearboxes,
        seconds=asked.seconds,
        chain=sensors,
        seed=asked.seed,
        progress=progress,
    )
    own = gearboxes[asked.gearbox]
    ripple = _gearbox_ripple(experiments, own, asked.seconds, sensors)
    infeasible = {
        name: list(pendulum.shortfalls(one, gearboxes[one.gearbox]))
        for name, one in zip(names, experiments, strict=True)
    }
    infeasible = {name: causes for name, causes in infeasible.items() if causes}
    if found["winding_degC"] > own.thermal.derating_begins:
        warnings.append(
            f"the winding reaches {found['winding_degC']:.4g} degC; the drive lowers its current "
            f"from {own.thermal.derating_begins:g} degC on."
        )
    currents = np.concatenate([one.columns["current"] for one in episodes])
    warnings += filter(None, [beyond_peak(own.motor, currents)])
    labels = np.concatenate([one.columns["torque"] for one in episodes])
    beyond = overload(machine, float(np.max(np.abs(labels))))
    if beyond is not None:
        warnings.append(
            f"the torque on the load reaches {beyond.torque:.3g} N*m in these data, which the "
            f"simulation lets the gearbox carry; {beyond.told}. A network learns such torques "
            "as any other."
        )
    drive, limit = own.drive, own.torque_limit
    facts: dict[str, Any] = {
        "source": "simulated",
        "design": design.name,
        "design_sha256": design.sha256,
        "version": __version__,
        "seed": asked.seed,
        "seconds": asked.seconds,
        "training_gearbox": asked.gearbox,
        "unit_gearboxes": seeds[1:],
        "masses_kg": list(pendulum.MASSES),
        "held_mass_kg": asked.held_mass,
        "ranges": {
            "frequency_Hz": list(pendulum.FREQUENCIES),
            "amplitude_rad": list(pendulum.AMPLITUDES),
            "start_rad": list(pendulum.STARTS),
            "arm_m": list(pendulum.ARMS),
        },
        "pendulum": pendulum.pendulum_facts(),
        "control": {
            "law": "torque = position_gain (target - position) - velocity_gain velocity, by the "
            "encoder, at the control rate",
            "rate_Hz": drive.control_rate,
            "current_bandwidth_Hz": drive.current_bandwidth,
            "current_limit_A": drive.current_limit,
        },
        "supply_voltage_V": drive.supply_voltage,
        "ratio": own.gear.ratio,
        "torque_constant_Nm_per_A": own.motor.torque_constant,
        "gearbox_orders": [int(order) for order in own.gear.error_orders],
        "gearbox_ripple_Nm": ripple,
        "gearbox_ripple_band_Hz": list(RIPPLE_BAND),
        "calibration": factors,
        "physics_step_s": found["physics_step_s"],
        "friction": "clip",
        "sensors": sensors.to_dict(drive.control_rate, drive.encoder_bits, own.gear.ratio),
        "beyond_gearbox": beyond and beyond.to_dict(),
        "infeasible": infeasible,
        "saturated_share": {
            one.name: round(float(np.mean(one.flag("saturated"))), 6) for one in episodes
        },
    }
    if machine.motor.stated:
        facts["motor"] = machine.motor.name
    data = DataSet(
        episodes=episodes,
        position_gain=drive.position_gain,
        velocity_gain=drive.velocity_gain,
        torque_range=(-limit, limit),
        facts=facts,
    )
    return data, tuple(warnings)


def _gearbox(machine: Machine, specimen: Specimen, asked: Request) -> ActuatorParameters:
    try:
        drawn = actuator_parameters(machine, specimen, supply_voltage=asked.voltage)
    except DesignError as error:
        raise type(error)(f"the gearbox of seed {specimen.seed}: {error.message}") from error
    drive = drawn.drive
    stiff = drive.position_gain if asked.position_gain is None else asked.position_gain
    damped = drive.velocity_gain if asked.velocity_gain is None else asked.velocity_gain
    if not stiff > 0.0:
        raise DesignError(
            "drive.position_gain is 0, which follows no target; give the design one above 0, or "
            'use --position-gain "60 N*m/rad".'
        )
    drive = dataclasses.replace(drive, position_gain=stiff, velocity_gain=damped)
    return dataclasses.replace(drawn, drive=drive)


def _experiments(asked: Request) -> list[tuple[str, int, pendulum.Configuration]]:
    """Kind of name, number and configuration of every episode."""
    pool = pendulum.draw(asked.episodes, asked.seed, _POOL, gearbox=asked.gearbox)
    found = [("swing", i, one) for i, one in enumerate(pool)]
    if asked.held_mass is not None:
        count = max(round(HELD_SHARE * asked.episodes), LEAST_EXTRA)
        held = pendulum.draw(
            count, asked.seed, _HELD, masses=(asked.held_mass,), gearbox=asked.gearbox
        )
        found += [("mass", i, one) for i, one in enumerate(held)]
    count = max(round(UNIT_SHARE * asked.episodes), LEAST_EXTRA)
    for unit in range(1, asked.unit_gearboxes + 1):
        seed = asked.gearbox + unit
        units = pendulum.draw(count, asked.seed, _UNITS, gearbox=seed)
        found += [(f"gearbox{seed}", i, one) for i, one in enumerate(units)]
    return found


def _gearbox_ripple(
    experiments: list[pendulum.Configuration],
    drawn: ActuatorParameters,
    seconds: float,
    sensors: SensorChain,
) -> float | None:
    """Amplitude within the band of what the gearbox's errors add to the torque, N m.

    The same experiments with and without them: most of the torque in the band is dry friction
    that changes its sign. None where every experiment has a wall, or saturates, or is too short.
    """
    errors = ("error_cosine", "error_sine", "stiffness_cosine", "stiffness_sine")
    none: dict[str, Any] = dict.fromkeys(errors, np.zeros(len(drawn.gear.error_orders)))
    perfect = dataclasses.replace(drawn, gear=dataclasses.replace(drawn.gear, **none))
    free = [dataclasses.replace(one, gearbox=0) for one in experiments if one.wall_angle is None]
    free = free[:RIPPLE_EPISODES]
    if not free or seconds * RIPPLE_BAND[0] <= 4.0:
        return None
    quiet = dataclasses.replace(sensors, torque_noise=0.0)
    names = [str(i) for i in range(len(free))]
    runs = [
        pendulum.record(free, names, {0: one}, seconds=seconds, chain=quiet, seed=0)[0]
        for one in (drawn, perfect)
    ]
    powers = []
    for first, second in zip(*runs, strict=True):
        if not (first.flag("saturated").any() or second.flag("saturated").any()):
            difference = first.columns["torque"] - second.columns["torque"]
            powers.append(_band_power(difference, first.dt))
    return _amplitude(powers)


def describe(data: DataSet) -> dict[str, Any]:
    """Size of a data set, its torque, and how often limits bind.

    Returns
    -------
    dict
        JSON; ``torque_in_band_Nm`` is the amplitude of a sine with the torque's power within
        `RIPPLE_BAND`, over episodes without wall and without saturation; ``gearbox_ripple_Nm``
        what of it the gearbox's errors make, where it is known.
    """
    torque = np.concatenate([one.columns["torque"] for one in data.episodes])
    saturated = np.array([float(np.mean(one.flag("saturated"))) for one in data.episodes])
    walls = np.concatenate([one.flag("wall") for one in data.episodes])
    lengths = np.array([len(one) for one in data.episodes])
    return {
        "episodes": len(data.episodes),
        "samples": int(lengths.sum()),
        "seconds": float(lengths.sum() * data.dt),
        "dt_s": data.dt,
        "torque_Nm_rms": float(np.sqrt(np.mean(torque**2))),
        "torque_Nm_least": float(torque.min()),
        "torque_Nm_most": float(torque.max()),
        "band_Hz": list(RIPPLE_BAND),
        "torque_in_band_Nm": _ripple(data),
        "gearbox_ripple_Nm": data.facts.get("gearbox_ripple_Nm"),
        "wall_share": float(np.mean(walls)),
        "saturated_share": float(np.sum(saturated * lengths) / lengths.sum()),
        "episodes_saturated": int(np.sum(saturated > 0.0)),
        "episodes_infeasible": len(data.facts.get("infeasible", {})),
        "position_gain_Nm_per_rad": data.position_gain,
        "velocity_gain_Nms_per_rad": data.velocity_gain,
        "sha256": data.sha256,
    }


def _ripple(data: DataSet) -> float | None:
    """None where no episode is long enough, or every one has a wall or saturates."""
    long = [one for one in data.episodes if len(one) * data.dt * RIPPLE_BAND[0] > 4.0]
    return _amplitude(
        [
            _band_power(one.columns["torque"], one.dt)
            for one in long
            if not (one.flag("wall").any() or one.flag("saturated").any() or one.group.get("wall"))
        ]
    )


def _amplitude(powers: list[float]) -> float | None:
    """Of the sine that carries the mean of some powers; None without any."""
    return math.sqrt(2.0 * float(np.mean(powers))) if powers else None


def _band_power(torque: FloatArray, dt: float) -> float:
    """Mean square of a torque within the ripple's band, by a Hann-windowed periodogram."""
    window = np.hanning(len(torque))
    spectrum = np.fft.rfft((torque - torque.mean()) * window)
    frequency = np.fft.rfftfreq(len(torque), dt)
    inside = (frequency >= RIPPLE_BAND[0]) & (frequency <= RIPPLE_BAND[1])
    return float(2.0 * np.sum(np.abs(spectrum[inside]) ** 2) / (len(torque) * np.sum(window**2)))
