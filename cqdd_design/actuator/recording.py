"""Experiments recorded: the steps to take, and columns with units for files.

A recording is long: one row an instant and a set, sets one after the other. Every column but
``set`` has its unit in brackets in its name.
"""

from __future__ import annotations

import dataclasses
import hashlib
import importlib
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from cqdd_design.actuator.columns import TRACES
from cqdd_design.actuator.motor import beyond_peak
from cqdd_design.actuator.packing import largest_step, rounded_down, safe_step
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.actuator.scenario import Chirp, Command, Load, Sampled, Scenario, Signal, Sine
from cqdd_design.actuator.simulate import Simulation
from cqdd_design.errors import DependencyError, UsageError

if TYPE_CHECKING:
    from cqdd_design.machine.overload import Overload

MOST_VALUES = 50_000_000
"""Numbers in a file: 400 MB."""
MOST_STEPS = 20_000_000
"""Steps of one run: its signals over time take some 600 MB."""
LONGEST_STEP = 5e-5
"""Without a word on the step, s: what a current loop of 1 kHz and its delay ask for."""
STEPS_PER_PERIOD = 20
"""Least, of the fastest sine in a command."""
_COMMANDED = {"voltage": ("commanded_voltage", "V"), "current": ("commanded_current", "A")}


@dataclass(frozen=True)
class Plan:
    """Steps of a run: length in s, and how many make one record."""

    step: float
    every: int

    @property
    def rate(self) -> float:
        """Records a second, Hz."""
        return 1.0 / (self.step * self.every)


def plan(
    parameters: Sequence[ActuatorParameters],
    scenario: Scenario,
    duration: float,
    rate: float,
    step: float | None = None,
) -> Plan:
    """Choose the steps of a run.

    Parameters
    ----------
    scenario : Scenario
        Of all of them.
    duration : float
        s, above zero.
    rate : float
        Of the record, Hz, above zero.
    step : float, optional
        s; default half the largest that stiffness, winding and control stand, and no more than
        `LONGEST_STEP`, a whole number of them a record.

    Raises
    ------
    UsageError
        When there is no record in the duration or more of them than memory holds, or the step is
        too large for the stiffness or the fastest sine; each time with what works.
    """
    period = 1.0 / rate
    if duration < period * (1.0 - 1e-9):
        raise UsageError(
            f"a duration of {duration:g} s has no record at a rate of {rate:g} Hz; use a rate of "
            f"{1.0 / duration:.4g} Hz or more, or a longer duration."
        )
    limit, cause = min(largest_step(one, scenario) for one in parameters)
    fastest = _fastest(scenario.command.reference)
    if STEPS_PER_PERIOD * fastest * duration > MOST_STEPS:
        most = rounded_down(MOST_STEPS / (STEPS_PER_PERIOD * duration))
        raise UsageError(
            f"a sine of {fastest:g} Hz over {duration:g} s takes more than {MOST_STEPS / 1e6:g} "
            f"million steps; use {most:g} Hz or less, or a shorter duration."
        )
    resolved = 1.0 / (STEPS_PER_PERIOD * fastest) if fastest > 0.0 else math.inf
    safe = min(safe_step(one, scenario, most=LONGEST_STEP) for one in parameters)
    wanted = rounded_down(min(safe, resolved)) if step is None else step
    if wanted > limit * (1.0 + 1e-9):
        raise UsageError(
            f"a step of {wanted:g} s is too large for {cause}, which needs {limit:.3g} s or less; "
            f"use {rounded_down(min(limit, resolved)):g} s."
        )
    if wanted > resolved * (1.0 + 1e-9):
        raise UsageError(
            f"a step of {wanted:g} s is less than {STEPS_PER_PERIOD} steps in a period of "
            f"{fastest:g} Hz; use {rounded_down(resolved):g} s, or a lower frequency."
        )
    if duration > MOST_STEPS * wanted:
        raise UsageError(
            f"{duration:g} s are more than {MOST_STEPS / 1e6:g} million steps of {wanted:g} s; "
            f"use a duration of {rounded_down(MOST_STEPS * wanted):g} s or less, or a longer step "
            f"(up to {min(limit, resolved):.3g} s)."
        )
    _refuse_values(duration * rate, len(parameters), duration)
    if step is None:
        every = math.ceil(period / wanted * (1.0 - 1e-9))
        return Plan(period / every, every)
    if step > period * (1.0 + 1e-9):
        raise UsageError(
            f"a rate of {rate:g} Hz is more than one record a step of {step:g} s; use "
            f"{1.0 / step:.6g} Hz or less, or a step of {rounded_down(period):g} s."
        )
    return Plan(step, max(1, round(period / step)))


def _refuse_values(rows: float, sets: int, duration: float) -> None:
    width = len(TRACES) + 3
    if rows * sets * width > MOST_VALUES:
        fitting = rounded_down(MOST_VALUES / (sets * width * duration))
        raise UsageError(
            f"{rows:.6g} records of {width} columns for {sets} sets are {rows * sets * width:.3g} "
            f"numbers, more than {MOST_VALUES / 1e6:g} million; use a rate of {fitting:g} Hz or "
            "less, or a shorter duration."
        )


def _fastest(signal: Signal) -> float:
    if isinstance(signal, Sine):
        return abs(signal.frequency)
    return signal.last if isinstance(signal, Chirp) else 0.0


@dataclass(frozen=True, eq=False)
class Recording:
    """A simulation with all it takes to understand its file.

    Attributes
    ----------
    parameters : tuple of ActuatorParameters
        One a set.
    scenario : Scenario
        Of all sets.
    rate : float
        Of the record, Hz.
    seeds : tuple of int
        Of the drawn gearboxes; empty for perfect parts.
    numbered : bool
        Whether there is a column ``set``.
    options : mapping of str to str
        What was asked for, defaults included, as unit strings.
    beyond : Overload or None
        What the gearbox does not carry of the greatest torque in it.
    """

    parameters: tuple[ActuatorParameters, ...]
    scenario: Scenario
    simulation: Simulation
    rate: float
    seeds: tuple[int, ...] = ()
    numbered: bool = False
    design_sha256: str = ""
    version: str = ""
    options: Mapping[str, str] = field(default_factory=dict)
    beyond: Overload | None = None

    def columns(self) -> dict[str, NDArray[Any]]:
        """All columns by name with unit; a reference in its own unit beside what it commands."""
        sets, found = len(self.simulation.names), {}
        if self.numbered:
            found["set"] = np.repeat(np.arange(sets), len(self.simulation.time))
        each = [self.simulation.columns(i) for i in range(sets)]
        for name in each[0]:
            found[self._renamed(name)] = np.concatenate([one[name] for one in each])
        command = self.scenario.command
        if command.mode in ("impedance", "position"):
            values = command.reference.values(self.simulation.time)
            found["reference_angle [rad]"] = np.tile(values, sets)
        return found

    def _renamed(self, column: str) -> str:
        renamed = _COMMANDED.get(self.scenario.command.mode)
        if renamed is None or not column.startswith("commanded_torque"):
            return column
        return f"{renamed[0]} [{renamed[1]}]"

    def metadata(self) -> dict[str, Any]:
        """What is written beside the columns: plain JSON values, quantities in SI."""
        first = self.parameters[0]
        return {
            "schema_version": 1,
            "name": first.name,
            "design_sha256": self.design_sha256,
            "version": self.version,
            "parts": "drawn from the tolerances" if self.seeds else "perfect",
            "seeds": list(self.seeds),
            "step_s": self.simulation.step,
            "rate_Hz": self.rate,
            "supply_voltage_V": first.drive.supply_voltage,
            "friction": self.scenario.friction,
            "command": _described_command(self.scenario.command, first),
            "load": _described_load(self.scenario.load),
            "start_angle_rad": self.scenario.start.output_angle,
            "options": dict(self.options),
        }

    def summary(self) -> tuple[dict[str, float], ...]:
        """Peaks and r.m.s. of the records and the energies of the whole run, for every set."""
        run, ledger = self.simulation, self.simulation.ledger
        traced = {
            "output_torque_Nm": run.output_torque,
            "output_speed_rad_per_s": run.output_speed,
            "current_A": run.current,
        }
        energies = {
            "electrical_J": ledger.electrical,
            "external_J": ledger.external,
            "dissipated_J": ledger.lost,
            "stored_J": ledger.stored_after - ledger.stored_before,
            "residual_J": ledger.residual,
            "residual_share": ledger.residual_share,
        }
        found = []
        for i in range(len(run.names)):
            one: dict[str, float] = {}
            for name, values in traced.items():
                one[f"{name}_peak"] = float(np.max(np.abs(values[i])))
                one[f"{name}_rms"] = float(np.sqrt(np.mean(values[i] ** 2)))
            one["winding_temperature_degC_peak"] = float(np.max(run.winding_temperature[i]))
            one |= {name: float(values[i]) for name, values in energies.items()}
            found.append(one)
        return tuple(found)

    @property
    def too_coarse(self) -> bool:
        """Whether the command swings faster than records at this rate can show (Nyquist)."""
        return 2.0 * _fastest(self.scenario.command.reference) > self.rate * (1.0 - 1e-9)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences on limits that bind, and on a record that hides what happens."""
        run, first = self.simulation, self.parameters[0]
        told = list(run.warnings)
        if self.too_coarse:
            fastest = _fastest(self.scenario.command.reference)
            told.append(
                f"the signal swings at up to {fastest:g} Hz, and {self.rate:g} records a second "
                f"show no more than {0.5 * self.rate:g} Hz: columns, peaks and r.m.s. are of the "
                "records alone and miss what happens between them, energies do not; raise the rate "
                f"to {STEPS_PER_PERIOD * fastest:g} Hz."
            )
        drive = first.drive
        for name, unit, values, limit in (
            ("current limit", "A", run.current, drive.current_limit),
            ("supply", "V", run.voltage, drive.supply_voltage),
        ):
            share = float(np.mean(np.abs(values) >= 0.995 * limit))
            if share > 0.0:
                told.append(f"the {name} of {limit:g} {unit} binds in {share:.2%} of the records.")
        told += filter(None, [beyond_peak(first.motor, run.current)])
        if first.motor.dry_drag == first.motor.drag_slope == 0.0:
            told.append(
                "the motor turns without drag of its own (motor.coulomb, motor.viscous: none is "
                "known, or 0 is stated): it coasts further and draws less current than with any."
            )
        if self.beyond is not None:
            told.append(
                f"the torque in the gearbox reaches {self.beyond.torque:.3g} N*m, which the "
                f"simulation lets it carry; {self.beyond.told}."
            )
        orders = max(int(np.max(one.gear.error_orders, initial=0)) for one in self.parameters)
        swept = orders * float(np.max(np.abs(run.output_speed))) * run.step
        if swept > 1.0:
            told.append(
                f"steps go up to {swept:.3g} rad along the finest ripple (order {orders} of an "
                "output turn), which is not resolved beyond 1 rad; shorten the step to see it."
            )
        hottest = float(np.max(run.winding_temperature))
        if hottest > first.thermal.derating_begins:
            told.append(
                f"the winding reaches {hottest:.4g} degC; the drive lowers its current from "
                f"{first.thermal.derating_begins:g} degC on."
            )
        return tuple(told)

    def to_dict(self) -> dict[str, Any]:
        """The JSON form."""
        columns = list(self.columns())
        rows = len(self.simulation.time) * len(self.simulation.names)
        named = [{"name": name, "unit": unit_of(name)} for name in columns]
        sets = list(self.summary())
        return {**self.metadata(), "rows": rows, "columns": named, "sets": sets}


def _described_load(load: Load) -> dict[str, Any]:
    kind = "free"
    for name, there in (
        ("wall", load.wall is not None),
        ("pendulum", load.gravity_moment != 0.0),
        ("driven", load.speed is not None),
        ("locked", load.sensor_stiffness > 0.0),
        ("inertia", load.inertia > 0.0),
    ):
        if there:
            kind = name
            break
    found: dict[str, Any] = {
        "kind": kind,
        "inertia_kgm2": load.inertia,
        "viscous_Nms_per_rad": load.viscous,
        "sensor_stiffness_Nm_per_rad": load.sensor_stiffness,
        "sensor_damping_Nms_per_rad": load.sensor_damping,
        "gravity_moment_Nm": load.gravity_moment,
        "torque": _described_signal(load.torque, "N m"),
    }
    if load.speed is not None:
        found["speed"] = _described_signal(load.speed, "rad/s")
    if load.wall is not None:
        found["wall"] = {
            "angle_rad": load.wall.angle,
            "stiffness_Nm_per_rad_to_exponent": load.wall.stiffness,
            "exponent": load.wall.exponent,
            "damping_s_per_rad": load.wall.damping,
            "side": load.wall.side,
        }
    return found


def _described_command(command: Command, parameters: ActuatorParameters) -> dict[str, Any]:
    units = {"open": "", "voltage": "V", "current": "A", "torque": "N m"}
    found: dict[str, Any] = {"kind": command.mode}
    if command.mode == "open":
        return found
    found["reference"] = _described_signal(command.reference, units.get(command.mode, "rad"))
    if command.mode in ("impedance", "position"):
        stiff, damped = command.gains(parameters.drive)
        found["feedforward"] = _described_signal(command.feedforward, "N m")
        found["position_gain_Nm_per_rad"], found["velocity_gain_Nms_per_rad"] = stiff, damped
        found["integral_gain_Nm_per_rad_s"] = command.integral_gain
    return found


def _described_signal(signal: Signal, unit: str) -> dict[str, Any]:
    """Kind, unit of its values, and its numbers; samples by their number and digest."""
    found: dict[str, Any] = {"signal": type(signal).__name__.lower(), "unit": unit}
    if isinstance(signal, Sampled):
        data = np.ascontiguousarray([signal.times, signal.samples], dtype="<f8").tobytes()
        digest = hashlib.sha256(data).hexdigest()
        return found | {"samples": len(signal.times), "samples_sha256": digest}
    units = {"frequency": "_Hz", "first": "_Hz", "last": "_Hz", "duration": "_s", "phase": "_rad"}
    if dataclasses.is_dataclass(signal):
        for one in dataclasses.fields(signal):
            found[one.name + units.get(one.name, "")] = getattr(signal, one.name)
    return found


def unit_of(column: str) -> str:
    """The unit in a column's name, empty where there is none.

    Examples
    --------
    >>> unit_of("output_torque [N m]")
    'N m'
    """
    return column.rpartition(" [")[2].rstrip("]") if column.endswith("]") else ""


def write_npz(path: Path, recording: Recording) -> None:
    """Write the columns, and as ``metadata`` a JSON string; no pickles."""
    columns = recording.columns()
    names = {name: unit_of(name) for name in columns}
    text = json.dumps({**recording.metadata(), "columns": names}, allow_nan=False)
    with path.open("wb") as stream:
        np.savez(stream, allow_pickle=False, metadata=np.array(text), **columns)


def write_parquet(path: Path, recording: Recording) -> None:
    """Write the columns as a Parquet table, units in its fields, metadata as JSON in its schema.

    Raises
    ------
    DependencyError
        When pyarrow is missing.
    """
    arrow, parquet = require_pyarrow()
    columns = recording.columns()
    arrays = [arrow.array(values) for values in columns.values()]
    fields = [
        arrow.field(name, one.type, nullable=False, metadata={"unit": unit_of(name)})
        for name, one in zip(columns, arrays, strict=True)
    ]
    told = {key: json.dumps(value) for key, value in recording.metadata().items()}
    parquet.write_table(arrow.table(arrays, schema=arrow.schema(fields, metadata=told)), str(path))


def require_pyarrow() -> tuple[Any, Any]:
    """Import pyarrow and its Parquet module.

    Raises
    ------
    DependencyError
        When they are missing; the message says what to install.
    """
    try:
        return importlib.import_module("pyarrow"), importlib.import_module("pyarrow.parquet")
    except ImportError as error:
        raise DependencyError(
            "Parquet needs the Python package pyarrow, which is missing or broken "
            f'({error}); run `pip install "cqdd-design[parquet]"`.'
        ) from error
