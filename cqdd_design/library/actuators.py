"""Calls about the whole actuator's data sheet: `bench` and `calibrate`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias

from cqdd_design.library.calls import names, road, si_value, whole
from cqdd_design.library.inputs import DesignLike, PathLike, design_of, path_of, specimen_of
from cqdd_design.library.results import Result, Row

if TYPE_CHECKING:
    from cqdd_design.actuator.bench.calibrate import Calibration
    from cqdd_design.actuator.specimen import Specimen
    from cqdd_design.design import Design
    from cqdd_design.report.notebook import Section
    from cqdd_design.results import Check
    from cqdd_design.roads.bench import DataSheet
    from cqdd_design.units import Quantity
    from cqdd_design.verdict import Verdict


@dataclass(frozen=True, eq=False, repr=False)
class Measured(Result):
    """What `bench` returns; `to_pandas` has a row a measurement.

    Attributes
    ----------
    found : DataSheet
        Measurements with their traces (`result.metrics`), other actuators beside, the verdict.
    """

    command: ClassVar[str] = "bench"

    found: DataSheet

    @property
    def verdict(self) -> Verdict | None:
        """On the design; None where single rows were asked for."""
        return self.found.verdict

    @property
    def checks(self) -> tuple[Check, ...]:
        """Lines of the verdict."""
        return self.found.lines

    def _told(self) -> str:
        rows = f"measured rows: {len(self.found.result.metrics)}"
        return f"{rows}; {self._answer(self.checks)}" if self.checks else rows

    def _figures(self) -> tuple[str, ...]:
        if self.verdict is not None:
            return super()._figures()
        return tuple(
            f"{one.name}: "
            + (f"{one.value:.4g} {one.unit}" if one.known is not None else "not known")
            for one in self.found.result.metrics
        )

    def _results(self) -> Mapping[str, Any]:
        return self.found.to_dict()

    def _rows(self) -> Sequence[Row]:
        metrics = self.to_dict()["results"]["metrics"]
        keys = ("value", "unit", "paper", "relation", "protocol")
        return [
            {"name": name} | {key: one.get(key) for key in keys} for name, one in metrics.items()
        ]

    def _sections(self) -> Sequence[Section]:
        from cqdd_design.report.actuator.bench_table import bench_view
        from cqdd_design.report.notebook import Section

        pins = self.design.reducer.output_pins.count
        view = bench_view(self.found.parameters, self.found.result, pin_count=pins)
        return (Section("bench.html", {"bench": view}),)


@dataclass(frozen=True, eq=False, repr=False)
class Calibrated(Result):
    """What `calibrate` returns; `to_pandas` has a row a measurement.

    Attributes
    ----------
    found : Calibration
        Factors of the unknowns, rows before and after, and the data sheet after.
    """

    command: ClassVar[str] = "calibrate"

    found: Calibration

    def _told(self) -> str:
        good, told = len(self.found.within), len(self.found.predicted)
        return f"{good} of {told} predicted rows are near what was measured"

    def _figures(self) -> tuple[str, ...]:
        from cqdd_design.actuator.bench.unknowns import UNKNOWNS

        return tuple(
            f"{name}: {UNKNOWNS[name].told(value)}" for name, value in self.found.factors.items()
        )

    def _results(self) -> Mapping[str, Any]:
        return self.found.to_dict()

    def _rows(self) -> Sequence[Row]:
        return [{"name": row.name} | row.to_dict() for row in self.found.rows]

    def _sections(self) -> Sequence[Section]:
        from cqdd_design.report.ink.numbers import pretty_unit, significant
        from cqdd_design.report.notebook import table
        from cqdd_design.terms import measurement

        def shown(value: float | None) -> str:
            return "" if value is None else significant(value)

        rows = [
            (
                measurement(row.name),
                pretty_unit(row.unit),
                *map(shown, (row.measured, row.before, row.after)),
                row.relation,
            )
            for row in self.found.rows
        ]
        head = ("Measurement", "Unit", "#Measured", "#Computed", "#Calibrated", "Agreement is")
        return (table("Before and after calibration", head, rows),)


CalibrationLike: TypeAlias = PathLike | Calibrated
"""A file that `calibrate` wrote, or what it returned."""


@road
def bench(
    design: DesignLike,
    *,
    only: str | Sequence[str] | None = None,
    voltage: Quantity | None = None,
    rig_stiffness: Quantity | None = None,
    seed: int | None = None,
    calibration: CalibrationLike | None = None,
    beside: str | Sequence[str] = (),
    out: PathLike | None = None,
    force: bool = False,
    progress: Callable[[str], None] | None = None,
) -> Measured:
    """The actuator's data sheet, measured on a virtual test bench, with the verdict.

    Parameters
    ----------
    design : Design or path
        A path is that of a design file; a bare name may be an example's.
    only : sequence of str
        Names of measurements, such as ``("mass", "backlash")``; default all, with the verdict.
    voltage : quantity, optional
        Supply of the dynamic rows; default 24 V.
    rig_stiffness : quantity, optional
        Of what holds the output for the torque bandwidth; default a torque sensor's.
    seed : int, optional
        Of one drawn gearbox; default perfect parts.
    calibration : path or Calibrated, optional
        Fitted factors to apply.
    beside : sequence of str
        Geared actuators of the catalogue to compare with.
    out : path, optional
        Folder for every trace, as npz.
    force : bool
        Replace traces there.
    progress : callable, optional
        Told in a few words what begins.

    Returns
    -------
    Measured
        `found.result.metrics`: each a value in its unit, its protocol, and a trace of arrays (T,).

    Raises
    ------
    UsageError
        No such measurement, or none selected; a quantity that cannot be read; a file that exists.
    CatalogError
        No such actuator.
    DesignError
        No valid design, or one that makes no actuator.

    Notes
    -----
    Protocols and equations are those of docs/actuator-model.md.

    Examples
    --------
    >>> import cqdd_design as cq
    >>> sheet = cq.bench("cqdd-10", only=("output_resolution",))
    >>> round(sheet.found.result.value("output_resolution"), 4)  # deg
    0.0022
    """
    from cqdd_design.roads.bench import data_sheet, write_traces
    from cqdd_design.roads.telling import silent
    from cqdd_design.units import STIFFNESS_GAIN, VOLTAGE

    loaded = design_of(design)
    specimen, told = specimen_given(loaded, seed, calibration)
    found = data_sheet(
        loaded,
        specimen,
        only=None if only is None else names("only", only, "mass"),
        voltage=si_value("voltage", voltage, VOLTAGE, positive=True),
        rig_stiffness=si_value("rig_stiffness", rig_stiffness, STIFFNESS_GAIN, positive=True),
        beside=names("beside", beside, "CubeMars AK10-9 V2 KV60"),
        progress=progress or silent,
    )
    files = () if out is None else write_traces(found.result, path_of("out", out), force=force)
    return Measured(loaded, (*told, *found.result.warnings), found, files=files)


@road
def calibrate(
    design: DesignLike,
    measured: Mapping[str, float | Quantity] | PathLike | None = None,
    *,
    to: str | Sequence[str] = (),
    unknowns: str | Sequence[str] = (),
    voltage: Quantity | None = None,
    rig_stiffness: Quantity | None = None,
    seed: int | None = None,
    out: PathLike | None = None,
    force: bool = False,
    progress: Callable[[str], None] | None = None,
) -> Calibrated:
    """Fit what no drawing tells to measured rows, and predict the others.

    Parameters
    ----------
    design : Design or path
        A path is that of a design file; a bare name may be an example's.
    measured : mapping or path, optional
        Values by measurement, quantities or numbers in the bench's units, or a CSV with the
        columns ``name,value,unit``; default the paper's table, for its own actuator.
    to : sequence of str
        Measured rows to fit to; the others are predicted. Default those that decide the unknowns.
    unknowns : sequence of str
        What to fit; default what the rows decide.
    voltage, rig_stiffness, seed
        As `bench` takes them.
    out : path, optional
        JSON file to write, for `calibration` of other calls.
    force : bool
        Replace that file.
    progress : callable, optional
        Told in a few words what begins.

    Returns
    -------
    Calibrated
        `found.factors` by unknown, and `found.rows` with what was measured, computed, calibrated.

    Raises
    ------
    UsageError
        No such row or unknown; rows that do not decide the unknowns; a file that exists.
    DesignError
        No valid design, or one that makes no actuator.

    Notes
    -----
    docs/actuator-model.md says what is fitted to what; docs/measured.md how well it then predicts.

    Examples
    --------
    >>> import cqdd_design as cq
    >>> fitted = cq.calibrate("cqdd-10", to=("continuous_torque",))
    >>> list(fitted.found.factors)
    ['thermal_resistance']
    """
    from cqdd_design.actuator.bench.calibration_file import write_calibration
    from cqdd_design.actuator.bench.measured import in_bench_units, read_measured
    from cqdd_design.files import kind_by_ending, refuse_overwrite
    from cqdd_design.roads.calibrate import calibrate as fit
    from cqdd_design.roads.telling import silent
    from cqdd_design.units import STIFFNESS_GAIN, VOLTAGE

    rows: Mapping[str, float] | None = None
    if isinstance(measured, Mapping):
        rows = {str(name): in_bench_units(str(name), one) for name, one in measured.items()}
    elif measured is not None:
        rows = read_measured(path_of("measured", measured))
    target = None if out is None else path_of("out", out)
    if target is not None:
        kind_by_ending(target, ("json",), "calibration")
        refuse_overwrite(target, force=force)
    loaded = design_of(design)
    specimen, _ = specimen_given(loaded, seed, None)
    found = fit(
        loaded,
        rows,
        specimen,
        to=names("to", to, "continuous_torque"),
        unknowns=names("unknowns", unknowns, "thermal_resistance"),
        voltage=si_value("voltage", voltage, VOLTAGE, positive=True),
        rig_stiffness=si_value("rig_stiffness", rig_stiffness, STIFFNESS_GAIN, positive=True),
        progress=progress or silent,
    )
    files = () if target is None else (write_calibration(found, loaded.sha256, target),)
    return Calibrated(loaded, found.after.warnings, found, files=files)


def specimen_given(
    design: Design, seed: int | None, calibration: CalibrationLike | None
) -> tuple[Specimen, tuple[str, ...]]:
    """The actuator that is meant, and a warning where a calibration is of another design."""
    if seed is not None:
        seed = whole("seed", seed, 0, 2**64 - 1)
    if isinstance(calibration, Calibrated):
        found, _ = specimen_of(design, seed=seed)
        fitted = replace(found, factors=calibration.found.factors)
        if calibration.design.sha256 == design.sha256:
            return fitted, ()
        other = f"another design ({calibration.design.name})"
        elsewhere = calibration.found.factors.fitted_to(other)
        return replace(fitted, factors=elsewhere), (
            f"the calibration is of another design ({calibration.design.name}) or another state "
            "of this one; its factors are applied all the same.",
        )
    path = None if calibration is None else path_of("calibration", calibration)
    return specimen_of(design, seed=seed, calibration=path)
