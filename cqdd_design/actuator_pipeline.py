"""The actuator of a design in one call: measure it, fit it, run it in time, write what comes out.

Every function takes a design; the rooms below take parameters.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from cqdd_design import __version__
from cqdd_design.catalog.paper import METRICS, is_papers_actuator

if TYPE_CHECKING:
    from cqdd_design.actuator.bench import BenchResult
    from cqdd_design.actuator.bench.calibrate import Calibration
    from cqdd_design.actuator.comparison import ComparedActuator
    from cqdd_design.actuator.motor_file import MotorFile
    from cqdd_design.actuator.parameters import ActuatorParameters, FloatArray
    from cqdd_design.actuator.recording import Recording
    from cqdd_design.actuator.scenario import Scenario
    from cqdd_design.design import Design
    from cqdd_design.files import WrittenFile

Progress = Callable[[str], None]

#: Rows that the unknowns of the paper's own actuator are fitted to.
PAPER_ROWS = ("continuous_torque", "backdrive_static", "efficiency_peak")

#: Toleranced gearboxes whose mean ripple is the bench's.
RIPPLE_DRAWS = 6

#: Tooth meshes of an output turn up to which gearboxes are drawn for the ripple: their equilibrium
#: takes half a second each here, and tens of seconds with 24 lobes.
MOST_DRAWN_MESHES = 200


def _silent(stage: str) -> None:
    """Progress that nobody asked for."""


def bench(
    design: Design,
    *,
    only: tuple[str, ...] = (),
    voltage: float | None = None,
    seed: int | None = None,
    calibration: Mapping[str, float] | None = None,
    motor: MotorFile | None = None,
    progress: Progress = _silent,
) -> BenchResult:
    """Measure the actuator of a design on the virtual test bench.

    Parameters
    ----------
    design : Design
    only : tuple of str
        Names of measurements; default all.
    voltage : float, optional
        Supply of the dynamic rows, V; default the paper's 24 V.
    seed : int, optional
        Measure one gearbox drawn from the tolerances; default perfect parts, whose ripple is that
        of drawn ones.
    calibration : mapping of str to float, optional
        Factors of unknowns, as `read_calibration` gives them.
    motor : MotorFile, optional
        What a file says of the motor instead of the catalogue.
    progress : callable
        Told what is measured next.
    """
    from cqdd_design.actuator.bench import run_bench
    from cqdd_design.actuator.bench.run import VOLTAGE
    from cqdd_design.actuator.bench.unknowns import apply_factors
    from cqdd_design.actuator.build import actuator_parameters

    factors = calibration or {}
    rippling = seed is None and (not only or "torque_ripple" in only)
    return run_bench(
        apply_factors(actuator_parameters(design, seed=seed, own_motor=motor), factors),
        rated_current=_rated_current(design, motor),
        voltage=VOLTAGE if voltage is None else voltage,
        only=only,
        beside_paper=is_papers_actuator(design),
        drawn=[apply_factors(one, factors) for one in _drawn(design, motor)] if rippling else (),
        progress=progress,
    )


def calibrate(
    design: Design,
    measured: Mapping[str, float] | None = None,
    *,
    to: tuple[str, ...] = (),
    unknowns: tuple[str, ...] = (),
    voltage: float | None = None,
    seed: int | None = None,
    motor: MotorFile | None = None,
    progress: Progress = _silent,
) -> Calibration:
    """Fit what no drawing tells of a design's actuator to measured rows, and predict the others.

    Parameters
    ----------
    design : Design
    measured : mapping of str to float, optional
        Measurements in the bench's units; default the paper's, of its own actuator only, fitted
        to continuous torque, static backdrive torque and efficiency.
    to, unknowns : tuple of str
        Rows to fit to, and what to fit; see `actuator.bench.calibrate.calibrate`.
    voltage : float, optional
        Supply of the dynamic rows, V; default the paper's 24 V.
    seed : int, optional
        Of one drawn gearbox; default perfect parts.
    motor : MotorFile, optional
        What a file says of the motor instead of the catalogue.
    progress : callable
        Told what begins.

    Raises
    ------
    UsageError
        Without measured rows for a design that is not the paper's, and as `calibrate` says.
    """
    from cqdd_design.actuator.bench.calibrate import calibrate as fit
    from cqdd_design.actuator.bench.run import VOLTAGE
    from cqdd_design.actuator.build import actuator_parameters
    from cqdd_design.errors import UsageError

    if measured is None:
        if not is_papers_actuator(design):
            raise UsageError(
                f"there are no measured values of {design.name}; give them with --measured FILE "
                "(columns name,value,unit)."
            )
        measured = {name: figure.value for name, figure in METRICS.items()}
        to = to or PAPER_ROWS
    return fit(
        actuator_parameters(design, seed=seed, own_motor=motor),
        measured,
        to=to,
        unknowns=unknowns,
        voltage=VOLTAGE if voltage is None else voltage,
        rated_current=_rated_current(design, motor),
        drawn=() if seed is not None else _drawn(design, motor),
        progress=progress,
    )


def _drawn(design: Design, motor: MotorFile | None = None) -> list[ActuatorParameters]:
    """Actuators with gearboxes drawn from the tolerances, for the ripple of a usual one."""
    from cqdd_design.actuator.build import actuator_parameters

    lobes = design.reducer.ratio
    if lobes * (lobes + 1) > MOST_DRAWN_MESHES:
        return []
    return [actuator_parameters(design, seed=one, own_motor=motor) for one in range(RIPPLE_DRAWS)]


def _rated_current(design: Design, motor: MotorFile | None = None) -> float | None:
    from cqdd_design.catalog import find_motor

    row = find_motor(design.motor.name)
    return (row if motor is None else motor.row(row)).rated_current


def compared_actuators(
    design: Design, result: BenchResult, more: Sequence[str] = ()
) -> tuple[ComparedActuator, ...]:
    """The paper's table of actuators with a measured design as a column, and catalogue rows.

    Raises
    ------
    CatalogError
        For a name that is no geared actuator of the catalogue.
    """
    from cqdd_design.actuator.comparison import compare_actuators, present_actuator

    peak, mass = result.value("peak_torque"), result.value("mass")
    own = None
    if peak is not None and mass is not None:
        efficiency = result.value("efficiency_peak")
        own = present_actuator(design.name, design.reducer.ratio, peak, mass, efficiency)
    return compare_actuators(own, more)


def write_traces(
    result: BenchResult, folder: Path, *, force: bool = False
) -> tuple[WrittenFile, ...]:
    """Write the trace of every measurement as ``<name>-<measurement>.npz``, columns with units."""
    import numpy as np

    from cqdd_design.files import ensure_folder, refuse_overwrite, write_with

    ensure_folder(folder)
    files = []
    for metric in result.metrics:
        if not metric.trace:
            continue
        path = folder / f"{result.name}-{metric.name.replace('_', '-')}.npz"
        refuse_overwrite(path, force=force)
        columns = dict(metric.trace)

        def write(place: Path, columns: dict[str, FloatArray] = columns) -> None:
            with place.open("wb") as stream:
                np.savez(stream, allow_pickle=False, **columns)

        files.append(write_with(path, "npz", write))
    return tuple(files)


def measured_actuator(design: Design) -> tuple[tuple[ActuatorParameters, BenchResult] | None, str]:
    """Parameters and measurements of a design's actuator, or a sentence on why there are none."""
    from cqdd_design.actuator.bench import run_bench
    from cqdd_design.actuator.build import actuator_parameters
    from cqdd_design.errors import CqddError

    try:
        parameters = actuator_parameters(design)
        result = run_bench(
            parameters,
            rated_current=_rated_current(design),
            beside_paper=is_papers_actuator(design),
            drawn=_drawn(design),
        )
    except CqddError as error:
        return None, f"The actuator of this design cannot be simulated: {error.message}"
    return (parameters, result), ""


def simulate(
    design: Design,
    scenario: Scenario,
    *,
    duration: float = 5.0,
    rate: float = 1000.0,
    step: float | None = None,
    voltage: float | None = None,
    seed: int | None = None,
    samples: int | None = None,
    calibration: Mapping[str, float] | None = None,
    motor: MotorFile | None = None,
    options: Mapping[str, str] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Recording:
    """Run the actuator of a design in time; see `actuator.simulate`.

    Parameters
    ----------
    design : Design
    scenario : Scenario
    duration, step : float
        s; default step: the safe one of `actuator.recording.plan`.
    rate : float
        Of the record, Hz.
    voltage : float, optional
        Supply, V; default that of the design.
    seed : int, optional
        Draw the gearbox from the tolerances; default perfect parts.
    samples : int, optional
        Gearboxes to draw, with the seeds `seed` (default 0) and those that follow it.
    calibration : mapping of str to float, optional
        Factors of unknowns, as `read_calibration` gives them.
    motor : MotorFile, optional
        What a file says of the motor instead of the catalogue.
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
    from cqdd_design.actuator.bench.steady import with_voltage
    from cqdd_design.actuator.bench.unknowns import apply_factors
    from cqdd_design.actuator.build import actuator_parameters
    from cqdd_design.actuator.recording import Recording, plan
    from cqdd_design.actuator.simulate import simulate as run
    from cqdd_design.errors import DesignError, UsageError

    first = 0 if seed is None else seed
    if first + (samples or 1) > 2**64:
        raise UsageError(f"seeds end at {2**64 - 1}; lower seed {first} or draw fewer gearboxes.")
    seeds = () if seed is None and samples is None else tuple(range(first, first + (samples or 1)))
    factors = calibration or {}
    perfect = apply_factors(actuator_parameters(design, own_motor=motor), factors)
    if voltage is not None:
        perfect = with_voltage(perfect, voltage)
    # Before many gearboxes are solved for nothing.
    plan([perfect] * max(len(seeds), 1), scenario, duration, rate, step)
    sets = [] if seeds else [perfect]
    for one in seeds:
        try:
            drawn = apply_factors(actuator_parameters(design, seed=one, own_motor=motor), factors)
        except DesignError as error:
            raise type(error)(f"the gearbox of seed {one}: {error.message}") from error
        sets.append(replace(drawn, drive=perfect.drive))
        if progress is not None:
            progress(len(sets), len(seeds))
    steps = plan(sets, scenario, duration, rate, step)
    return Recording(
        parameters=tuple(sets),
        scenario=scenario,
        simulation=run(sets, scenario, duration, steps.step, every=steps.every),
        rate=steps.rate,
        seeds=seeds,
        numbered=samples is not None,
        design_sha256=design.sha256,
        version=__version__,
        options=options or {},
    )


def write_simulation(
    recording: Recording, path: Path | None = None, *, force: bool = False
) -> WrittenFile:
    """Write a recording as ``.npz`` or ``.parquet``, by the name of its file.

    Parameters
    ----------
    recording : Recording
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
    from cqdd_design.actuator.recording import write_npz, write_parquet
    from cqdd_design.files import write_with

    kind = simulation_kind(path, force=force)
    target = path or Path("exports") / f"{recording.parameters[0].name}-simulation.npz"
    writer = write_parquet if kind == "parquet" else write_npz
    return write_with(target, kind, lambda place: writer(place, recording))


def simulation_kind(path: Path | None, *, force: bool = False) -> str:
    """Kind of a recording's file by its ending, npz or parquet; refuses what cannot be written."""
    from cqdd_design.actuator.recording import require_pyarrow
    from cqdd_design.errors import UsageError
    from cqdd_design.files import refuse_overwrite

    if path is None:
        return "npz"
    kind = path.suffix.lower().lstrip(".")
    if kind not in ("npz", "parquet"):
        nearest = path.parent / f"{path.stem or 'simulation'}.npz"
        raise UsageError(f"{path} ends neither in .npz nor in .parquet; name it {nearest}.")
    refuse_overwrite(path, force=force)
    if kind == "parquet":
        require_pyarrow()
    return kind
