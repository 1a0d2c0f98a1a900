"""Measure the actuator of a design on the virtual test bench."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from cqdd_design.actuator.bench import BenchResult, run_bench
from cqdd_design.actuator.bench.metric import refuse_unselected
from cqdd_design.actuator.bench.run import VOLTAGE
from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.comparison import (
    ComparedActuator,
    catalogue_actuator,
    compare_actuators,
    present_actuator,
)
from cqdd_design.actuator.parameters import ActuatorParameters, FloatArray
from cqdd_design.actuator.specimen import AS_DRAWN, Specimen
from cqdd_design.catalog.paper import is_papers_actuator
from cqdd_design.design import Design
from cqdd_design.errors import ContactError, CqddError, DesignError
from cqdd_design.files import WrittenFile, ensure_folder, refuse_overwrite, write_with
from cqdd_design.machine import Machine
from cqdd_design.machine.carrying import carried_torque
from cqdd_design.results import Check
from cqdd_design.roads.telling import Progress, silent
from cqdd_design.verdict import Verdict, judge

#: Toleranced gearboxes whose mean backlash and ripple are the bench's, of seeds 0 and up.
RIPPLE_DRAWS = 6

#: Tooth meshes of an output turn up to which gearboxes are drawn for both: their equilibrium
#: takes half a second each here, and tens of seconds with 24 lobes.
MOST_DRAWN_MESHES = 200


_DRAWN_ROWS = {"backlash", "torque_ripple"}


@dataclass(frozen=True, eq=False)
class DataSheet:
    """What the bench says of an actuator, beside others, and whether its design will do.

    Attributes
    ----------
    parameters : ActuatorParameters
        That were measured.
    result : BenchResult
    actuators : tuple of ComparedActuator
        The paper's table with this one as a column, and what else was asked for.
    verdict : Verdict or None
        None where single rows were asked for, which ask nothing of the design.
    """

    parameters: ActuatorParameters
    result: BenchResult
    actuators: tuple[ComparedActuator, ...]
    verdict: Verdict | None

    @property
    def lines(self) -> tuple[Check, ...]:
        """Of the verdict."""
        return () if self.verdict is None else self.verdict.lines

    def to_dict(self) -> dict[str, object]:
        """The JSON form (``results`` of ``bench``)."""
        comparison = [one.to_dict() for one in self.actuators]
        judged = {} if self.verdict is None else {"verdict": self.verdict.to_dict()}
        return self.result.to_dict() | {"comparison": comparison} | judged


def data_sheet(
    design: Design,
    specimen: Specimen = AS_DRAWN,
    *,
    only: tuple[str, ...] | None = None,
    voltage: float | None = None,
    rig_stiffness: float | None = None,
    beside: Sequence[str] = (),
    progress: Progress = silent,
) -> DataSheet:
    """Measure an actuator as `bench` does, judge its design, and put it beside others.

    Parameters
    ----------
    beside : sequence of str
        Names of geared actuators of the catalogue.

    Raises
    ------
    CatalogError
        For a name that is none of them, before anything is measured.
    UsageError
        For rows that do not exist, or an empty selection of them.
    """
    refuse_unselected(only)
    for name in beside:
        catalogue_actuator(name)
    machine = specimen.machine(design)
    parameters, result = measure(machine, specimen, only, voltage, progress, rig_stiffness)
    verdict = judge(machine, specimen) if only is None else None
    return DataSheet(parameters, result, compared_actuators(design, result, beside), verdict)


def bench(
    design: Design,
    specimen: Specimen = AS_DRAWN,
    *,
    only: tuple[str, ...] | None = None,
    voltage: float | None = None,
    rig_stiffness: float | None = None,
    progress: Progress = silent,
) -> BenchResult:
    """Measure the actuator of a design on the virtual test bench.

    Parameters
    ----------
    specimen : Specimen
        Without a seed perfect parts are measured, and backlash and ripple are those of drawn ones.
    only : tuple of str
        Names of measurements, one at least; default all.
    voltage : float, optional
        Supply of the dynamic rows, V; default the paper's 24 V.
    rig_stiffness : float, optional
        Of what holds the output, N m/rad; see `run_bench`.
    progress : callable
        Told what is measured next.
    """
    machine = specimen.machine(design)
    return measure(machine, specimen, only, voltage, progress, rig_stiffness)[1]


def measure(
    machine: Machine,
    specimen: Specimen,
    only: tuple[str, ...] | None = None,
    voltage: float | None = None,
    progress: Progress = silent,
    rig_stiffness: float | None = None,
) -> tuple[ActuatorParameters, BenchResult]:
    """Parameters of a machine's actuator, and what the bench measures on it; see `bench`."""
    refuse_unselected(only)
    parameters = actuator_parameters(machine, specimen)
    rippling = specimen.seed is None and (only is None or not _DRAWN_ROWS.isdisjoint(only))
    drawn, told = drawn_actuators(machine, specimen) if rippling else ([], ())
    result = run_bench(
        parameters,
        rated_current=machine.motor.rated_current,
        voltage=VOLTAGE if voltage is None else voltage,
        only=only,
        beside_paper=is_papers_actuator(machine.given),
        drawn=drawn,
        gearbox=carried_torque(machine),
        rig_stiffness=rig_stiffness,
        progress=progress,
    )
    return parameters, replace(result, warnings=(*result.warnings, *told))


def drawn_actuators(
    machine: Machine, specimen: Specimen
) -> tuple[list[ActuatorParameters], tuple[str, ...]]:
    """Actuators with gearboxes drawn from the tolerances, for backlash and ripple of usual ones.

    With a sentence where some of them cannot be simulated: they jam, or their stiffness falls to
    nothing at some angle.
    """
    lobes = machine.design.reducer.ratio
    if lobes * (lobes + 1) > MOST_DRAWN_MESHES:
        return [], ()
    drawn, refused = [], []
    for seed in range(RIPPLE_DRAWS):
        try:
            drawn.append(actuator_parameters(machine, replace(specimen, seed=seed)))
        except (ContactError, DesignError) as error:
            refused.append(error.message)
    if not refused:
        return drawn, ()
    others = "of the others" if drawn else "of perfect parts"
    return drawn, (
        f"{len(refused)} of {RIPPLE_DRAWS} gearboxes drawn from the tolerances cannot be "
        f"simulated, and backlash and torque ripple are those {others}: {refused[0]}",
    )


def measured_actuator(
    machine: Machine, specimen: Specimen = AS_DRAWN
) -> tuple[tuple[ActuatorParameters, BenchResult] | None, str]:
    """Parameters and measurements of a machine's actuator, or a sentence on why there are none."""
    try:
        return measure(machine, specimen), ""
    except CqddError as error:
        return None, f"The actuator of this design cannot be simulated: {error.message}"


def compared_actuators(
    design: Design, result: BenchResult, more: Sequence[str] = ()
) -> tuple[ComparedActuator, ...]:
    """The paper's table of actuators with a measured design as a column, and catalogue rows.

    Raises
    ------
    CatalogError
        For a name that is no geared actuator of the catalogue.
    """
    peak, mass = result.counted_peak, result.value("mass")
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
