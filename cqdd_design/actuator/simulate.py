"""Simulate actuators in time: many parameter sets at once, compiled, deterministic."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from cqdd_design.actuator.columns import LEDGER, TRACES, Ledger, Signals, Steps, Traces
from cqdd_design.actuator.packing import (
    gear_table,
    largest_step,
    pack,
    rounded_down,
    table_points,
)
from cqdd_design.actuator.parameters import ActuatorParameters, FloatArray
from cqdd_design.actuator.scenario import Constant, Scenario, Signal
from cqdd_design.errors import UsageError

Work = tuple[Any, ...]
"""Arguments of the kernel but for the range of sets."""

_SHARES = 16
"""Ranges of sets that each thread fetches one after the other."""

_LOSSES = ("copper", "iron", "motor_friction", "output_friction", "gear_damping", "load_damping")


class EnergyLedger(Ledger):  # type: ignore[misc]
    """Where the energy of every run went, J, arrays (S,); see `columns.LEDGER`."""

    __slots__ = ()

    @property
    def lost(self) -> FloatArray:
        """All losses, J."""
        return np.asarray(sum(getattr(self, name) for name in _LOSSES))

    @property
    def residual(self) -> FloatArray:
        """What the balance misses, J: input less losses less what is stored."""
        gained = self.electrical + self.external - self.lost
        return np.asarray(gained - (self.stored_after - self.stored_before))

    @property
    def residual_share(self) -> FloatArray:
        """The residual's size over the throughput; of the stored energy where nothing flows."""
        scale = np.maximum(self.throughput, np.abs(self.stored_before))
        return np.asarray(np.abs(self.residual) / np.where(scale > 0.0, scale, 1.0))


@dataclass(frozen=True, eq=False)
class Simulation:
    """Traces of S actuators (names) at N instants: the ends of the steps recorded, s.

    Every trace is an array (S, N); see `columns.TRACES` for what it is, and in which unit.
    """

    names: tuple[str, ...]
    time: FloatArray
    motor_angle: FloatArray
    motor_speed: FloatArray
    output_angle: FloatArray
    output_speed: FloatArray
    current: FloatArray
    voltage: FloatArray
    deflection: FloatArray
    gear_torque: FloatArray
    output_torque: FloatArray
    motor_friction: FloatArray
    output_friction: FloatArray
    commanded_torque: FloatArray
    winding_temperature: FloatArray
    housing_temperature: FloatArray
    step: float
    ledger: EnergyLedger
    warnings: tuple[str, ...] = ()

    def columns(self, index: int = 0) -> dict[str, FloatArray]:
        """Time and traces of one actuator by name with unit, such as ``motor_speed [rad/s]``."""
        found = {"time [s]": self.time}
        for name, unit in TRACES.items():
            found[f"{name} [{unit}]"] = getattr(self, name)[index]
        return found


def simulate(
    parameters: ActuatorParameters | Sequence[ActuatorParameters],
    scenario: Scenario | Sequence[Scenario],
    duration: float,
    step: float,
    *,
    every: int = 1,
    threads: int | None = None,
) -> Simulation:
    """Simulate one actuator or many.

    Parameters
    ----------
    parameters : ActuatorParameters or sequence of them
        S sets; one is used for all scenarios.
    scenario : Scenario or sequence of them
        One for all sets, or one each.
    duration : float
        s; rounded to whole steps.
    step : float
        s; see `packing.largest_step`.
    every : int
        Steps a record.
    threads : int, optional
        Default all; the numbers do not depend on it.

    Raises
    ------
    UsageError
        For a step too large for the stiffness, naming one that works; a duration, step, number of
        threads or number of scenarios that makes no sense; signals that are not finite.
    """
    if threads is not None and threads < 1:
        raise UsageError(f"threads {threads} must be 1 or more; leave it out to use all.")
    sets, scenes = _paired(parameters, scenario)
    steps = _steps(duration, step, every)
    _refuse_large(sets, scenes, step)
    rows = np.array([pack(one, scene, step) for one, scene in zip(sets, scenes, strict=True)])
    points = max(table_points(one.gear) for one in sets)
    unique = {id(one.gear): one.gear for one in sets}
    built = {key: gear_table(gear, points) for key, gear in unique.items()}
    tables = np.array([built[id(one.gear)] for one in sets])
    middle: FloatArray = step * (np.arange(steps, dtype=np.float64) + 0.5)
    ends: FloatArray = step * np.arange(steps + 1, dtype=np.float64)
    reference = [scene.command.reference for scene in scenes]
    rates = [s.command.reference if s.command.mode == "impedance" else Constant() for s in scenes]
    signals = Signals(
        _sampled(reference, middle),
        _sampled(rates, middle, rate=True),
        _sampled([scene.command.feedforward for scene in scenes], middle),
        _sampled([scene.load.torque for scene in scenes], middle),
        _sampled([scene.load.speed or Constant() for scene in scenes], ends),
    )
    traces = Traces(*np.zeros((len(TRACES), len(sets), steps // every)))
    ledger = Ledger(*np.zeros((len(LEDGER), len(sets))))
    work: Work = (rows, tables, signals, Steps(step, steps, every), traces, ledger)
    run_compiled(work, threads)
    if not np.all(np.isfinite(ledger)):
        raise UsageError(
            f"the simulation left the finite numbers at a step of {step:g} s; look for forces far "
            "beyond what the gearbox stands, or shorten the step."
        )
    unsettled = int(ledger.unsettled.sum())
    return Simulation(
        names=tuple(one.name for one in sets),
        time=ends[every::every],
        **traces._asdict(),
        step=step,
        ledger=EnergyLedger(*ledger),
        warnings=()
        if not unsettled
        else (f"the equations of {unsettled} of {steps * len(sets)} steps did not settle.",),
    )


def run_compiled(work: Work, threads: int | None = None) -> None:
    """Call the kernel for all sets, on threads that fetch a few sets whenever they are free.

    A core that is busy elsewhere, or has got the slow sets, so takes fewer.
    """
    from concurrent.futures import ThreadPoolExecutor

    import numba

    from cqdd_design.actuator.kernels import stepping as kernel

    run_sets: Any = kernel.run_sets
    count = len(work[0])
    used = min(threads or numba.get_num_threads(), count)
    if used <= 1:
        run_sets(*work, 0, count)
        return
    some = max(1, count // (_SHARES * used))

    def take(first: int) -> None:
        run_sets(*work, first, min(first + some, count))

    with ThreadPoolExecutor(used) as pool:
        list(pool.map(take, range(0, count, some)))


def _paired(
    parameters: ActuatorParameters | Sequence[ActuatorParameters],
    scenario: Scenario | Sequence[Scenario],
) -> tuple[list[ActuatorParameters], list[Scenario]]:
    sets = [parameters] if isinstance(parameters, ActuatorParameters) else list(parameters)
    scenes = [scenario] if isinstance(scenario, Scenario) else list(scenario)
    if not sets or not scenes:
        raise UsageError("a simulation needs an actuator and a scenario; there is none.")
    if len(sets) == 1:
        sets = sets * len(scenes)
    if len(scenes) == 1:
        scenes = scenes * len(sets)
    if len(sets) != len(scenes):
        raise UsageError(
            f"{len(sets)} actuators and {len(scenes)} scenarios do not pair; give one scenario "
            "for all, or one for each."
        )
    return sets, scenes


def _steps(duration: float, step: float, every: int) -> int:
    for name, value in (("duration", duration), ("step", step)):
        if not (math.isfinite(value) and value > 0.0):
            raise UsageError(f"{name} {value:g} s must be finite and above 0.")
    if every < 1:
        raise UsageError(f"every {every} must be 1 or more steps a record.")
    steps = round(duration / step)
    if steps < every:
        raise UsageError(
            f"a duration of {duration:g} s is less than a record of {every} steps of {step:g} s; "
            "lower every or the step."
        )
    return steps


def _refuse_large(
    sets: Sequence[ActuatorParameters], scenes: Sequence[Scenario], step: float
) -> None:
    limit, cause = min(largest_step(*pair) for pair in zip(sets, scenes, strict=True))
    if step > limit * (1.0 + 1e-9):
        raise UsageError(
            f"a step of {step:g} s is too large for {cause}, which needs {limit:.3g} s or less; "
            f"use {rounded_down(limit):g} s."
        )


def _sampled(signals: Sequence[Signal], times: FloatArray, *, rate: bool = False) -> FloatArray:
    """Signals at times, with one row where all are the same, one column where all stand still."""
    same = all(signal is signals[0] for signal in signals)
    used = signals[:1] if same or all(signal == signals[0] for signal in signals) else signals
    still = all(isinstance(signal, Constant) for signal in used)
    at = times[:1] if still else times
    rows = [signal.rates(at) if rate else signal.values(at) for signal in used]
    found = np.ascontiguousarray(np.array(rows, dtype=float))
    if not np.all(np.isfinite(found)):
        first = float(at[np.flatnonzero(~np.isfinite(found).all(axis=0))[0]])
        raise UsageError(
            f"a signal is not finite at {first:g} s; commands, torques and speeds need finite "
            "numbers at all times."
        )
    return found
