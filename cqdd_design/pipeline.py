"""The whole road in one call, and its longer stretches: size, weigh, export, report.

Every room is imported by the function that needs it: the command line must answer ``--help``
without numpy, and size a gearbox without a CAD kernel.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

from cqdd_design import __version__

if TYPE_CHECKING:
    from cqdd_design.design import Design, Requirements
    from cqdd_design.files import WrittenFile
    from cqdd_design.gearbox import GearboxAnalysis
    from cqdd_design.gearbox.contact_analysis import ContactAnalysis
    from cqdd_design.gearbox.tolerance.ensemble import ToleranceResult
    from cqdd_design.machine.weighing import Bodies
    from cqdd_design.results import Check, Provenance
    from cqdd_design.sizing import SizingResult
    from cqdd_design.solids.clearances import AssemblyMotion

Progress = Callable[[str], None]

#: How often sizing and `write_report` tell their progress.
SIZING_STAGES, REPORT_STAGES = 2, 6

#: Toleranced gearboxes of a report, fewer of those with many teeth: percentiles to a few per
#: cent in some seconds, and never too few for a ranking.
REPORT_SAMPLES, LEAST_REPORT_SAMPLES = 400, 128
_REPORT_ANGLES = 1000


def _silent(stage: str) -> None:
    """Progress that nobody asked for."""


def provenance(design: Design | None) -> Provenance:
    """Version, time and design hash of a result made now.

    The time is that of the environment variable ``SOURCE_DATE_EPOCH`` where it is set, so that
    the same input gives the same bytes. No design, no hash.
    """
    from cqdd_design.environment import source_date
    from cqdd_design.results import Provenance

    moment = source_date() or datetime.now(UTC)
    return Provenance(
        version=__version__,
        time=moment.strftime("%Y-%m-%dT%H:%M:%SZ"),
        design_sha256="" if design is None else design.sha256,
    )


@dataclass(frozen=True)
class Road:
    """A sized gearbox with its files.

    Attributes
    ----------
    sizing : SizingResult
    design : Design
        The sized design under the name of its file.
    files : tuple of WrittenFile
        The design file first, then exports, then the report.
    """

    sizing: SizingResult
    design: Design
    files: tuple[WrittenFile, ...]


def size_and_write(
    requirements: Requirements,
    path: Path | None = None,
    *,
    kinds: tuple[str, ...] = (),
    report: bool = False,
    force: bool = False,
    progress: Progress = _silent,
) -> Road:
    """Go the whole road: size, check, write the design, export, report.

    Parameters
    ----------
    requirements : Requirements
    path : Path, optional
        The design file; default ``designs/sized-N.toml``, this function's own, which is replaced.
        Its stem names the design, and so the default places of exports and report.
    kinds : tuple of str
        Kinds of file to export.
    report : bool
        Whether to write the report.
    force : bool
        Replace an existing design file that was named.
    progress : callable
        Told in a few words what begins, `road_stages` times.

    Raises
    ------
    InfeasibleError
        When no design meets the requirements; the message names the limits that bind.
    """
    from cqdd_design.exporting import export
    from cqdd_design.files import refuse_overwrite
    from cqdd_design.sizing import size

    target = path or Path("designs") / f"sized-{requirements.ratio}.toml"
    refuse_overwrite(target, force=force or path is None)
    sizing = size(requirements, progress)
    # Both are written to the file even where they equal their defaults.
    design = sizing.design.replacing({"schema_version": 1, "name": target.stem})
    files: tuple[WrittenFile, ...] = (_write_fresh(target, design),)
    if kinds:
        files += export(design, kinds, progress=progress)
    if report:
        written, _ = write_report(
            design, source=target, sizing=sizing, files=files, progress=progress
        )
        files += (written,)
    return Road(sizing, design, files)


def road_stages(kinds: tuple[str, ...], *, report: bool) -> int:
    """How often `size_and_write` tells its progress."""
    from cqdd_design.exporting import stages

    return SIZING_STAGES + stages(kinds) + (REPORT_STAGES if report else 0)


def _write_fresh(path: Path, design: Design) -> WrittenFile:
    """Write a design file anew: a former file of this name leaves no comments behind."""
    from cqdd_design.design import save_design
    from cqdd_design.files import atomic_path, describe_file

    with atomic_path(path) as temporary:
        temporary.unlink()
        save_design(temporary, design, comments=_origins(design))
    return describe_file(path, "design")


#: Reducer keys that sizing takes over from the requirements.
_TAKEN_OVER = {
    "reducer.ratio": "ratio",
    "reducer.disc_count": "disc_count",
    "reducer.disc_material": "disc_material",
    "reducer.ring_material": "ring_material",
    "reducer.output_pins.material": "pin_material",
    "reducer.ring.outer_diameter": "outer_diameter",
    "motor.name": "motor",
}


def _origins(design: Design) -> dict[str, str]:
    """A remark for every key of a sized design that is written: where its value comes from."""
    remarks = {}
    for key in design.dotted_keys():
        if key.startswith("requirements."):
            remarks[key] = "given"
        elif key in _TAKEN_OVER:
            wanted = f"requirements.{_TAKEN_OVER[key]}"
            remarks[key] = "assumed" if wanted in design.assumed else "given"
        elif key.startswith("reducer."):
            remarks[key] = "sized"
    return remarks


@dataclass(frozen=True)
class InertiaAndBalance:
    """Mass properties of a gearbox from meshes, and its balance for one, two and three discs.

    Attributes
    ----------
    design : Design
        With its cam bearing named.
    bodies : Bodies
        Parts, their mass properties, and the balance by number of discs.
    paper_disc_count : int
        What the paper's rule asks for.
    """

    design: Design
    bodies: Bodies
    paper_disc_count: int

    @property
    def torque_density(self) -> float:
        """Peak torque over the mass of all that is drawn, N m/kg."""
        return self.design.requirements.peak_torque / self.bodies.inertia.total.mass

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the figures leave out."""
        missing = tuple(
            f"there is no balance with {count} discs: the parts cannot be put together so."
            for count in (1, 2, 3)
            if count not in self.bodies.balance
        )
        return self.bodies.inertia.warnings + missing

    def to_dict(self) -> dict[str, object]:
        """The JSON form (``results`` of ``inertia``)."""
        by_count = {str(count): self._balance(count) for count in (1, 2, 3)}
        return {
            **self.bodies.inertia.to_dict(),
            "torque_density_Nm_per_kg": self.torque_density,
            "balance": {"by_disc_count": by_count, "paper_disc_count": self.paper_disc_count},
        }

    def _balance(self, count: int) -> dict[str, float] | None:
        found = self.bodies.balance.get(count)
        if found is None:
            return None
        reducer = self.design.reducer
        pack = count * reducer.disc_thickness + (count - 1) * reducer.disc_spacing
        # One weight at each end of the pack: half of the static part, or a pair for the couple.
        weight = 0.5 * found.static_unbalance + found.couple_unbalance / pack
        return {**found.to_dict(), "counterweight_each_end_kgm": weight}


def assembly_motion(
    design: Design, angles: int, progress: Callable[[int, int], None] | None = None
) -> AssemblyMotion:
    """Turn all solids through a revolution of the output; see `solids.clearances`.

    Raises
    ------
    GeometryError
        When the parts cannot exist or cannot be put together.
    """
    from cqdd_design.catalog import find_bearing
    from cqdd_design.gearbox.cam_bearing import with_chosen_bearing
    from cqdd_design.solids.clearances import assembly_motion as turn
    from cqdd_design.solids.clearances import output_revolution
    from cqdd_design.solids.parts import build_parts

    named = with_chosen_bearing(design)
    parts = build_parts(named, find_bearing(named.reducer.cam_bearing.designation))
    return turn(named, parts, output_revolution(named, angles), progress=progress)


def assembly_check(motion: AssemblyMotion) -> Check:
    """The check ``ASSEMBLY-CLEAR`` of what a revolution showed."""
    from cqdd_design.gearbox.checks.guide import check_guide
    from cqdd_design.results import Check

    guide = check_guide("ASSEMBLY-CLEAR")
    remedy, found = "", f"{motion.pairs} pairs of solids at {motion.angles} crank angles"
    if motion.collisions:
        worst = motion.collisions[0]
        found = (
            f"{worst.first} and {worst.second} share {worst.volume * 1e9:.3g} mm3 at "
            f"{math.degrees(worst.crank_angle):.4g} deg"
        )
        remedy = f"Give {worst.first} and {worst.second} {worst.thickness * 1e6:.3g} um more room."
    return Check(
        id=guide.id,
        title=guide.title,
        value=float(len({(one.first, one.second) for one in motion.collisions})),
        limit=0.0,
        unit=guide.unit,
        sense=guide.sense,
        formula=guide.formula,
        substituted=found,
        why=guide.why,
        remedy=remedy,
        source=guide.source,
    )


def inertia(
    design: Design, *, speed: float | None = None, progress: Progress = _silent
) -> InertiaAndBalance:
    """Mass properties of every part from its mesh, and the balance of the crank.

    Parameters
    ----------
    design : Design
    speed : float, optional
        Input speed of the shaking forces, rad/s; default that of the requirements.
    progress : callable
        Told in a few words what begins.

    Raises
    ------
    DependencyError
        When CadQuery or one of its system libraries is missing.
    """
    from cqdd_design.catalog import find_bearing
    from cqdd_design.gearbox import with_chosen_bearing
    from cqdd_design.gearbox.balance import paper_disc_count
    from cqdd_design.machine.weighing import weigh
    from cqdd_design.solids.mesh import mass_properties

    chosen = with_chosen_bearing(design)
    if speed is not None:
        chosen = chosen.replacing({"requirements.input_speed": speed})
    progress("building solids and meshes")
    bearing = find_bearing(chosen.reducer.cam_bearing.designation)
    bodies = weigh(chosen, bearing, mass_properties)
    return InertiaAndBalance(chosen, bodies, paper_disc_count(chosen.reducer.ratio))


#: How often `inertia` tells its progress.
INERTIA_STAGES = 1


def write_report(
    design: Design,
    path: Path | None = None,
    *,
    source: Path | None = None,
    sizing: SizingResult | None = None,
    files: tuple[WrittenFile, ...] = (),
    samples: int = REPORT_SAMPLES,
    force: bool = False,
    progress: Progress = _silent,
) -> tuple[WrittenFile, GearboxAnalysis]:
    """Write the report of a design.

    Parameters
    ----------
    design : Design
    path : Path, optional
        Default ``reports/NAME.html``, whose file is this function's own and is replaced.
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
    WrittenFile, GearboxAnalysis
        The report, and the analysis it shows.
    """
    from cqdd_design.actuator_pipeline import measured_actuator
    from cqdd_design.files import refuse_overwrite, write_atomically
    from cqdd_design.gearbox import analyse_gearbox
    from cqdd_design.machine.weighing import weigh_if_possible
    from cqdd_design.report import ReportInput, build_report, read_comments
    from cqdd_design.report.machine_view.apart import start_drawing
    from cqdd_design.sizing.comparison import compare_with_planetary

    target = path or Path("reports") / f"{design.name}.html"
    refuse_overwrite(target, force=force or path is None)
    progress("analysing loads and the planetary")
    analysis = analyse_gearbox(design)
    bodies, notes = weigh_if_possible(analysis.design, analysis.cam_bearing.bearing)
    drawing = start_drawing(analysis.design, analysis.cam_bearing.bearing) if bodies else None
    contact, ensemble, unsolved = _contact_and_tolerances(analysis.design, samples, progress)
    progress("measuring the actuator on the test bench")
    measured, unmeasured = measured_actuator(design)
    progress("drawing the machine")
    machine = None if drawing is None else drawing.fetch()
    if isinstance(machine, str):
        notes, machine = (*notes, machine), None
    results = ReportInput(
        design=design,
        gearbox=analysis,
        planetary=compare_with_planetary(design, analysis=analysis),
        provenance=provenance(design),
        comments={} if source is None else read_comments(source),
        bodies=bodies,
        notes=(*notes, *unsolved),
        sizing=sizing,
        files=files,
        contact=contact,
        tolerance=ensemble,
        machine=machine,
        bench=measured,
        bench_missing=unmeasured,
    )
    progress("writing the report")
    return write_atomically(target, build_report(results), "report"), analysis


def _contact_and_tolerances(
    design: Design, samples: int, progress: Progress
) -> tuple[ContactAnalysis | None, ToleranceResult | None, tuple[str, ...]]:
    """Contact analysis and ensemble of a design, or sentences on why there are none."""
    from cqdd_design.errors import ContactError, UsageError
    from cqdd_design.gearbox.contact_analysis import analyse_contact
    from cqdd_design.gearbox.tolerance.ensemble import make_ensemble, run_ensemble

    progress("solving the contact equilibrium")
    try:
        contact = analyse_contact(design)
    except ContactError as error:
        return None, None, (f"no contact analysis: {error.message}",)
    progress("solving toleranced gearboxes")
    if not samples:
        return contact, None, contact.warnings
    ratio = design.reducer.ratio
    # Eight angles a tooth as in `tolerance`, down to two where there are many teeth.
    per_tooth = min(max(_REPORT_ANGLES // (ratio * (ratio + 1)), 2), 8)
    angles = per_tooth * ratio * (ratio + 1)
    fitting = samples * _REPORT_ANGLES // max(angles, _REPORT_ANGLES)
    try:
        ensemble = run_ensemble(
            make_ensemble(design, angles=angles),
            max(fitting, min(samples, LEAST_REPORT_SAMPLES)),
        )
    except (ContactError, UsageError) as error:
        return contact, None, (*contact.warnings, f"no tolerances: {error.message}")
    if ensemble.interrupted:
        raise KeyboardInterrupt
    return contact, ensemble, contact.warnings
