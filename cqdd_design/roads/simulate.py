"""Run the actuator of a design in time, and write the record."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from cqdd_design.actuator.bench.steady import with_voltage
from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.recording import (
    Recording,
    plan,
    require_pyarrow,
    write_npz,
    write_parquet,
)
from cqdd_design.actuator.scenario import Scenario
from cqdd_design.actuator.simulate import simulate as run
from cqdd_design.actuator.specimen import AS_DRAWN, Specimen
from cqdd_design.design import Design
from cqdd_design.environment import output_folder
from cqdd_design.errors import DesignError, UsageError
from cqdd_design.files import WrittenFile, kind_by_ending, refuse_overwrite, write_with
from cqdd_design.machine.overload import overload
from cqdd_design.version import __version__


def simulate(
    design: Design,
    scenario: Scenario,
    specimen: Specimen = AS_DRAWN,
    *,
    duration: float = 5.0,
    rate: float = 1000.0,
    step: float | None = None,
    voltage: float | None = None,
    samples: int | None = None,
    options: Mapping[str, str] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Recording:
    """Run the actuator of a design in time; see `actuator.simulate`.

    Parameters
    ----------
    duration, step : float
        s; default step: the safe one of `actuator.recording.plan`.
    rate : float
        Of the record, Hz.
    voltage : float, optional
        Supply, V; default that of the design.
    samples : int, optional
        Gearboxes to draw, with the seeds that begin at the specimen's (default 0).
    options : mapping of str to str, optional
        What was asked for, to be written beside the columns.
    progress : callable
        Told how many gearboxes are solved, and of how many.

    Raises
    ------
    UsageError
        When duration, step and rate do not go together or ask for more than memory holds.
    DesignError
        When the design makes no actuator, naming the seed where a drawn gearbox does not.
    """
    seeds = _seeds(specimen.seed, samples)
    machine = specimen.machine(design)
    perfect = actuator_parameters(machine, replace(specimen, seed=None))
    if voltage is not None:
        perfect = with_voltage(perfect, voltage)
    # Before many gearboxes are solved for nothing.
    plan([perfect] * max(len(seeds), 1), scenario, duration, rate, step)
    sets = [] if seeds else [perfect]
    for seed in seeds:
        try:
            drawn = actuator_parameters(machine, replace(specimen, seed=seed))
        except DesignError as error:
            raise type(error)(f"the gearbox of seed {seed}: {error.message}") from error
        sets.append(replace(drawn, drive=perfect.drive))
        if progress is not None:
            progress(len(sets), len(seeds))
    steps = plan(sets, scenario, duration, rate, step)
    found = run(sets, scenario, duration, steps.step, every=steps.every)
    return Recording(
        parameters=tuple(sets),
        scenario=scenario,
        simulation=found,
        rate=steps.rate,
        seeds=seeds,
        numbered=samples is not None,
        design_sha256=design.sha256,
        version=__version__,
        options=options or {},
        beyond=overload(machine, float(np.max(np.abs(found.gear_torque)))),
    )


def _seeds(seed: int | None, samples: int | None) -> tuple[int, ...]:
    """Seeds of the gearboxes to draw; none for perfect parts."""
    if seed is None and samples is None:
        return ()
    first, count = seed or 0, samples or 1
    if first + count > 2**64:
        raise UsageError(f"seeds end at {2**64 - 1}; lower seed {first} or draw fewer gearboxes.")
    return tuple(range(first, first + count))


def write_simulation(
    recording: Recording, name: str, path: Path | None = None, *, force: bool = False
) -> WrittenFile:
    """Write a recording as ``.npz`` or ``.parquet``, by the name of its file.

    Parameters
    ----------
    name : str
        `Design.file_name` of the design.
    path : Path, optional
        Default ``exports/NAME-simulation.npz``, this function's own, which is replaced.
    force : bool
        Replace an existing file that was named.

    Raises
    ------
    UsageError
        When the file exists, has another ending, or cannot be written.
    DependencyError
        For Parquet without pyarrow.
    """
    kind = simulation_kind(path, force=force)
    target = path or output_folder("exports") / f"{name}-simulation.npz"
    writer = write_parquet if kind == "parquet" else write_npz
    return write_with(target, kind, lambda place: writer(place, recording))


def simulation_kind(path: Path | None, *, force: bool = False) -> str:
    """Kind of a recording's file by its ending, npz or parquet; refuses what cannot be written."""
    if path is None:
        return "npz"
    kind = kind_by_ending(path, ("npz", "parquet"), "simulation")
    refuse_overwrite(path, force=force)
    if kind == "parquet":
        require_pyarrow()
    return kind
