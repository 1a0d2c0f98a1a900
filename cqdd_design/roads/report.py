"""One file about a design, a page or its print, from everything that can be computed of it."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing, nullcontext
from pathlib import Path
from subprocess import Popen
from typing import Literal, NamedTuple, get_args

from cqdd_design.actuator.bench import BenchResult
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.actuator.shock import Shock, shocks
from cqdd_design.actuator.specimen import AS_DRAWN, Specimen
from cqdd_design.catalog.paper import is_papers_actuator
from cqdd_design.design import Design
from cqdd_design.environment import output_folder
from cqdd_design.errors import ContactError, UsageError, shown
from cqdd_design.files import WrittenFile, kind_by_ending, refuse_overwrite, write_atomically
from cqdd_design.gearbox.checks.allowables import YIELD_SAMPLES
from cqdd_design.gearbox.tolerance.clearance import ClearancePoint, clearance_study
from cqdd_design.machine import Machine
from cqdd_design.machine.contact_analysis import ContactAnalysis, analyse_contact
from cqdd_design.machine.weighing import weigh_if_possible
from cqdd_design.planetary.compare import PlanetaryComparison
from cqdd_design.planetary.cycloid import CycloidLimit
from cqdd_design.report import ReportInput, build_report, read_comments
from cqdd_design.report.machine_view.apart import start_drawing
from cqdd_design.report.printing import printed_page, printing_browser
from cqdd_design.roads.bench import measured_actuator
from cqdd_design.roads.drawer import begin_drawer
from cqdd_design.roads.sized_file import kept_costs
from cqdd_design.roads.telling import Progress, provenance, silent
from cqdd_design.sizing import SizingResult
from cqdd_design.sizing.comparison import compare_with_planetary, cycloid_limits
from cqdd_design.verdict import Verdict, judge
from cqdd_design.verdict.drawn import Drawn

ReportForm = Literal["html", "pdf"]

#: How often `write_report` tells its progress.
REPORT_STAGES = 7

#: Toleranced gearboxes at every clearance that is looked at.
_CLEARANCE_SAMPLES, _LEAST_CLEARANCE_SAMPLES = 12, 8
_REPORT_ANGLES = 1000


def report_form(text: str | None, path: Path | None) -> ReportForm:
    """The form asked for, by its name or by how a file is called; without either a page.

    Raises
    ------
    UsageError
        For another form, a file that ends otherwise, and two that contradict each other.
    """
    forms: tuple[ReportForm, ...] = get_args(ReportForm)
    asked = next((form for form in forms if form == text), None)
    if text is not None and asked is None:
        raise UsageError(f"--format {shown(text)}: a report is html or pdf.")
    if path is None:
        return asked or "html"
    kind = kind_by_ending(path, forms, "report", asked or "")
    named = next(form for form in forms if form == kind)
    if asked not in (None, named):
        raise UsageError(
            f"--format {asked} does not go into {path}, which ends in .{named}; name it "
            f"{path.with_suffix(f'.{asked}')}, or leave --format out."
        )
    return named


class WrittenReport(NamedTuple):
    """A report's file, and the verdict it prints."""

    file: WrittenFile
    verdict: Verdict

    def to_dict(self) -> dict[str, object]:
        """The JSON form (``results`` of ``report``)."""
        return {"verdict": self.verdict.to_dict()}


def write_report(
    design: Design,
    path: Path | None = None,
    *,
    specimen: Specimen = AS_DRAWN,
    source: Path | None = None,
    sizing: SizingResult | None = None,
    files: tuple[WrittenFile, ...] = (),
    verdict: Verdict | None = None,
    samples: int = YIELD_SAMPLES,
    form: ReportForm = "html",
    force: bool = False,
    drawer: Popen[bytes] | None = None,
    progress: Progress = silent,
) -> WrittenReport:
    """Write the report of a design.

    Parameters
    ----------
    path : Path, optional
        Default ``reports/NAME.html`` (or ``.pdf``), whose file is this function's own and is
        replaced.
    specimen : Specimen
        Which actuator is meant.
    source : Path, optional
        The design's file, whose comments tell where values come from and what more would cost.
    sizing : SizingResult, optional
        Where the design has been found in the same run.
    files : tuple of WrittenFile
        Written in the same run, to be listed.
    verdict : Verdict, optional
        On the same design and specimen, where there is one already.
    samples : int
        Toleranced gearboxes to draw; 0 leaves the section out, and the line ``YIELD`` unknown.
    form : {"html", "pdf"}
        The page itself, or printed by a browser.
    force : bool
        Replace an existing file that was named.
    drawer : subprocess.Popen, optional
        From :func:`.drawer.waiting_drawer`, where it was begun before this module was there.
    progress : callable
        Told in a few words what begins.

    Returns
    -------
    WrittenReport
        The file, and what it says.

    Raises
    ------
    DependencyError
        A print is asked for and no browser is found, or it prints nothing.
    """
    browser = printing_browser() if form == "pdf" else None
    target = path or output_folder("reports") / f"{design.file_name}.{form}"
    refuse_overwrite(target, force=force or path is None)
    progress("analysing loads and the planetary")
    machine = specimen.machine(design)
    own_motor = (machine.motor.remark,) if machine.motor.remark else ()
    analysis = machine.analysis
    bodies, notes = weigh_if_possible(machine)
    drawing_if = (
        closing(start_drawing(machine, lambda: drawer or begin_drawer()))
        if bodies
        else nullcontext()
    )
    with drawing_if as drawing:
        # Gearboxes are drawn in compiled code, beside which the rest has another core.
        with ThreadPoolExecutor(1) as pool:
            rest = pool.submit(_beside, machine, specimen)
            judged = verdict or judge(
                machine, specimen, samples=samples, sensitivity=True, progress=progress
            )
            progress("trying other clearances")
            clearances = _clearances(machine, judged.evidence.drawn)
            progress("measuring the actuator on the test bench")
            beside = rest.result()
        progress("drawing the machine")
        pictures = None if drawing is None else drawing.fetch()
    if isinstance(pictures, str):
        notes, pictures = (*notes, pictures), None
    results = ReportInput(
        machine=machine,
        gearbox=analysis,
        planetary=beside.planetary,
        limits=beside.limits,
        provenance=provenance(design),
        comments={} if source is None else read_comments(source),
        bodies=bodies,
        notes=(*own_motor, *specimen.remarks, *notes, *beside.unsolved, *judged.warnings),
        verdict=judged,
        sizing=sizing,
        costs=() if source is None else kept_costs(source, design),
        files=files,
        # A print leads nowhere.
        target=target if browser is None else None,
        contact=beside.contact,
        clearances=clearances,
        pictures=pictures,
        bench=beside.bench,
        bench_missing=beside.bench_missing,
        shocks=beside.shocks,
    )
    progress("writing the report")
    page = build_report(results)
    content = page if browser is None else printed_page(page, browser)
    file = write_atomically(target, content, "report")
    return WrittenReport(file, judged)


class _Beside(NamedTuple):
    """What a report tells that no verdict rests on; see `ReportInput`."""

    contact: ContactAnalysis | None
    unsolved: tuple[str, ...]
    bench: tuple[ActuatorParameters, BenchResult] | None
    bench_missing: str
    shocks: Mapping[str, Shock]
    planetary: PlanetaryComparison | None
    limits: tuple[CycloidLimit, ...]


def _beside(machine: Machine, specimen: Specimen) -> _Beside:
    contact, unsolved = _contact(machine)
    bench, missing = measured_actuator(machine, specimen)
    papers = is_papers_actuator(machine.given)
    return _Beside(
        contact=contact,
        unsolved=unsolved,
        bench=bench,
        bench_missing=missing,
        shocks={} if bench is None else shocks(machine, specimen)[0],
        planetary=compare_with_planetary(machine) if papers else None,
        limits=cycloid_limits(machine),
    )


def _clearances(machine: Machine, drawn: Drawn | None) -> tuple[ClearancePoint, ...]:
    """What other clearances would make of a machine whose gearboxes can be drawn."""
    if drawn is None:
        return ()
    known = drawn.continuous
    angles = known.ensemble.angles
    fitting = _CLEARANCE_SAMPLES * _REPORT_ANGLES // max(angles, _REPORT_ANGLES)
    samples = max(fitting, _LEAST_CLEARANCE_SAMPLES)
    return clearance_study(machine.design, samples, angles, known=known)


def _contact(machine: Machine) -> tuple[ContactAnalysis | None, tuple[str, ...]]:
    """Contact analysis of a machine, or a sentence on why there is none."""
    try:
        contact = analyse_contact(machine)
    except ContactError as error:
        return None, (f"no contact analysis: {error.message}",)
    return contact, contact.warnings
