"""One self-contained HTML file about a design, from everything that can be computed of it."""

from __future__ import annotations

from contextlib import closing, nullcontext
from pathlib import Path
from typing import NamedTuple

from cqdd_design.actuator.shock import shocks
from cqdd_design.actuator.specimen import AS_DRAWN, Specimen
from cqdd_design.design import Design
from cqdd_design.errors import ContactError, UsageError
from cqdd_design.files import WrittenFile, refuse_overwrite, write_atomically
from cqdd_design.gearbox import GearboxAnalysis
from cqdd_design.gearbox.tolerance.clearance import ClearancePoint, clearance_study
from cqdd_design.gearbox.tolerance.ensemble import ToleranceResult, make_ensemble, run_ensemble
from cqdd_design.machine import Machine
from cqdd_design.machine.body_analysis import judged_or_told
from cqdd_design.machine.contact_analysis import ContactAnalysis, analyse_contact
from cqdd_design.machine.temperatures import judged_temperatures
from cqdd_design.machine.weighing import weigh_if_possible
from cqdd_design.report import ReportInput, build_report, read_comments
from cqdd_design.report.judgement.shortfalls import shortfalls
from cqdd_design.report.machine_view.apart import start_drawing
from cqdd_design.results import Check
from cqdd_design.roads.bench import measured_actuator
from cqdd_design.roads.telling import Progress, provenance, silent
from cqdd_design.sizing import SizingResult
from cqdd_design.sizing.comparison import compare_with_planetary

#: How often `write_report` tells its progress.
REPORT_STAGES = 6

#: Toleranced gearboxes of a report, fewer of those with many teeth: percentiles to a few per
#: cent in some seconds, and never too few for a ranking.
REPORT_SAMPLES, LEAST_REPORT_SAMPLES = 256, 128
_CLEARANCE_SAMPLES = 12
_REPORT_ANGLES = 1000


class WrittenReport(NamedTuple):
    """A report's file, analysis and checks, and where closer models say less than is asked."""

    file: WrittenFile
    analysis: GearboxAnalysis
    checks: tuple[Check, ...]
    short: tuple[str, ...]


def write_report(
    design: Design,
    path: Path | None = None,
    *,
    specimen: Specimen = AS_DRAWN,
    source: Path | None = None,
    sizing: SizingResult | None = None,
    files: tuple[WrittenFile, ...] = (),
    samples: int = REPORT_SAMPLES,
    force: bool = False,
    progress: Progress = silent,
) -> WrittenReport:
    """Write the report of a design.

    Parameters
    ----------
    path : Path, optional
        Default ``reports/NAME.html``, whose file is this function's own and is replaced.
    specimen : Specimen
        Which actuator is meant.
    source : Path, optional
        The design's file, whose comments tell where values come from.
    sizing : SizingResult, optional
        Where the design has been found in the same run.
    files : tuple of WrittenFile
        Written in the same run, to be listed.
    samples : int
        Toleranced gearboxes to draw; 0 leaves the section out.
    force : bool
        Replace an existing file that was named.
    progress : callable
        Told in a few words what begins.

    Returns
    -------
    WrittenReport
        The file, and what it says.
    """
    target = path or Path("reports") / f"{design.name}.html"
    refuse_overwrite(target, force=force or path is None)
    progress("analysing loads and the planetary")
    machine = specimen.machine(design)
    own_motor = (machine.motor.remark,) if machine.motor.remark else ()
    analysis = machine.analysis
    bodies, notes = weigh_if_possible(machine)
    with closing(start_drawing(machine)) if bodies else nullcontext() as drawing:
        contact, ensemble, unsolved = _contact_and_tolerances(machine, samples, progress)
        stress, stress_checks, unstressed = (
            (None, (), ()) if contact is None else judged_or_told(machine)
        )
        warm, heat_checks, unknown = judged_temperatures(machine)
        clearances: tuple[ClearancePoint, ...] = ()
        if ensemble is not None:
            angles = ensemble.ensemble.angles
            fitting = max(_CLEARANCE_SAMPLES * _REPORT_ANGLES // max(angles, _REPORT_ANGLES), 8)
            clearances = clearance_study(machine.design, fitting, angles)
        progress("measuring the actuator on the test bench")
        measured, unmeasured = measured_actuator(machine, specimen)
        stops = {} if measured is None else shocks(machine, specimen)[0]
        progress("drawing the machine")
        pictures = None if drawing is None else drawing.fetch()
    if isinstance(pictures, str):
        notes, pictures = (*notes, pictures), None
    results = ReportInput(
        machine=machine,
        gearbox=analysis,
        planetary=compare_with_planetary(machine),
        provenance=provenance(design),
        comments={} if source is None else read_comments(source),
        bodies=bodies,
        notes=(*own_motor, *specimen.remarks, *notes, *unsolved, *unstressed, *unknown),
        sizing=sizing,
        files=files,
        contact=contact,
        stress=stress,
        stress_checks=stress_checks,
        temperatures=warm,
        heat_checks=heat_checks,
        tolerance=ensemble,
        clearances=clearances,
        pictures=pictures,
        bench=measured,
        bench_missing=unmeasured,
        shocks=stops,
    )
    progress("writing the report")
    file = write_atomically(target, build_report(results), "report")
    short = tuple(one.sentence for one in shortfalls(results))
    return WrittenReport(file, analysis, results.checks, short)


def _contact_and_tolerances(
    machine: Machine, samples: int, progress: Progress
) -> tuple[ContactAnalysis | None, ToleranceResult | None, tuple[str, ...]]:
    """Contact analysis and ensemble of a machine, or sentences on why there are none."""
    progress("solving the contact equilibrium")
    try:
        contact = analyse_contact(machine)
    except ContactError as error:
        return None, None, (f"no contact analysis: {error.message}",)
    progress("solving toleranced gearboxes")
    if not samples:
        return contact, None, contact.warnings
    ratio = machine.design.reducer.ratio
    # Eight angles a tooth as in `tolerance`, down to two where there are many teeth.
    per_tooth = min(max(_REPORT_ANGLES // (ratio * (ratio + 1)), 2), 8)
    angles = per_tooth * ratio * (ratio + 1)
    fitting = samples * _REPORT_ANGLES // max(angles, _REPORT_ANGLES)
    try:
        ensemble = run_ensemble(
            make_ensemble(machine.design, angles=angles),
            max(fitting, min(samples, LEAST_REPORT_SAMPLES)),
        )
    except (ContactError, UsageError) as error:
        return contact, None, (*contact.warnings, f"no tolerances: {error.message}")
    if ensemble.interrupted:
        raise KeyboardInterrupt
    return contact, ensemble, contact.warnings
