"""Requirements to a judged design; in one call to its file, its exports and its report too."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from pydantic import ValidationError

from cqdd_design.catalog.motors import Motor
from cqdd_design.design import Design, Requirements
from cqdd_design.design.actuator import Environment
from cqdd_design.design.contradictions import too_cold_a_surface
from cqdd_design.design.motor import MotorFile
from cqdd_design.design.motor_row import row_over
from cqdd_design.environment import output_folder
from cqdd_design.errors import UsageError
from cqdd_design.exporting import export
from cqdd_design.files import WrittenFile, kind_by_ending, refuse_overwrite
from cqdd_design.machine import resolve
from cqdd_design.results import Check
from cqdd_design.roads.sized_file import refuse_edited, refuse_judged, write_fresh
from cqdd_design.roads.telling import Progress, silent
from cqdd_design.sizing import SizingResult, size
from cqdd_design.sizing.frame import Goal

if TYPE_CHECKING:
    from cqdd_design.sizing.motors import MotorChoice
    from cqdd_design.verdict import Verdict


@dataclass(frozen=True)
class Road:
    """A sized gearbox with its files.

    Attributes
    ----------
    design : Design
        The sized design under the name of its file.
    files : tuple of WrittenFile
        The design file first, then exports, then the report; none where nothing was written.
    verdict : Verdict or None
        On the design: yes, unless an alternative was picked; None after the
        screen alone.
    derived : frozenset of str
        Requirements that were not stated and are what the motor can do.
    choice : MotorChoice or None
        How the motor was found where any would do.
    """

    sizing: SizingResult
    design: Design
    files: tuple[WrittenFile, ...]
    verdict: Verdict | None
    derived: frozenset[str]
    choice: MotorChoice | None = None

    @property
    def lines(self) -> tuple[Check, ...]:
        """Of the verdict; after the screen alone the closed forms'."""
        return self.sizing.checks if self.verdict is None else self.verdict.lines

    @property
    def warnings(self) -> tuple[str, ...]:
        """What could not be judged."""
        return self.sizing.warnings if self.verdict is None else self.verdict.warnings

    @property
    def chosen(self) -> frozenset[str]:
        """Requirements that the search chose, as far as they were not stated."""
        chosen = frozenset[str]() if self.verdict is None else CHOSEN
        return chosen if self.choice is None else chosen | {"motor"}

    def to_dict(self) -> dict[str, object]:
        """The JSON form (``results`` of ``size``)."""
        motors = {} if self.choice is None else {"motors": self.choice.to_dict()}
        judged = {} if self.verdict is None else {"verdict": self.verdict.to_dict()}
        return self.sizing.to_dict() | motors | judged


@dataclass(frozen=True)
class _Sized:
    """A design with what is known of it."""

    sizing: SizingResult
    verdict: Verdict | None
    derived: frozenset[str]
    choice: MotorChoice | None = None


def size_and_write(
    requirements: Requirements,
    path: Path | None = None,
    *,
    motor: MotorFile | None = None,
    any_motor: bool = False,
    pick: str = "",
    ambient: float | None = None,
    kinds: tuple[str, ...] = (),
    report: bool = False,
    quick: bool = False,
    goal: Goal = "mass",
    force: bool = False,
    progress: Progress = silent,
) -> Road:
    """Go the whole road: size, judge, write the design, export, report.

    Parameters
    ----------
    path : Path, optional
        The design file; default ``designs/sized-N.toml``, this function's own, which is replaced
        unless it has been edited since. Its stem names the design, and so the default places of
        exports and report.
    motor, any_motor, pick, ambient, quick, goal, progress
        As `size_design` takes them.
    kinds : tuple of str
        Kinds of file to export.
    report : bool
        Whether to write the report.
    force : bool
        Replace an existing design file that was named, or edited, or, by what the screen alone
        found, one that the verdict was made on.

    Raises
    ------
    InfeasibleError
        When no design meets the requirements; the message names the limits that bind.
    UsageError
        When a file would be replaced that is not to be, and as `size_design` says.
    """
    target = path or default_path(requirements)
    if path is not None:
        refuse_overwrite(target, force=force)
        kind_by_ending(target, ("toml",), "design")
    elif not force:
        refuse_edited(target)
        if quick:
            refuse_judged(target)
    road = size_design(
        requirements,
        target,
        motor=motor,
        any_motor=any_motor,
        pick=pick,
        ambient=ambient,
        quick=quick,
        goal=goal,
        progress=progress,
    )
    design = road.design
    written_design = write_fresh(
        target, design, _origins(road), road.sizing.costs, judged=road.verdict is not None
    )
    files: tuple[WrittenFile, ...] = (written_design,)
    if kinds:
        from cqdd_design.actuator.specimen import AS_DRAWN

        machine = AS_DRAWN.machine(design)
        files += export(machine, kinds, specimen=AS_DRAWN, progress=progress)
    if report:
        # It computes everything there is, and imports as much.
        from cqdd_design.roads.report import write_report

        written = write_report(
            design,
            source=target,
            sizing=road.sizing,
            files=files,
            progress=progress,
        )
        files = (*files, written.file)
    return replace(road, files=files)


def default_path(requirements: Requirements) -> Path:
    """Where `size` writes a design that nobody gave a place: ``designs/sized-N.toml``."""
    return output_folder("designs") / f"sized-{requirements.ratio}.toml"


def size_design(
    requirements: Requirements,
    place: Path,
    *,
    motor: MotorFile | None = None,
    any_motor: bool = False,
    pick: str = "",
    ambient: float | None = None,
    quick: bool = False,
    goal: Goal = "mass",
    progress: Progress = silent,
) -> Road:
    """Size and judge, and write nothing.

    Parameters
    ----------
    place : Path
        Where the design would be written: its stem names the design, and the file of a duty is
        named from its folder.
    motor : MotorFile, optional
        What a file says of the required motor instead of the catalogue; the design says it too.
    any_motor : bool
        Take the first motor of the catalogue that fits, see :mod:`cqdd_design.sizing.motors`.
    pick : str
        Letter of the alternative to take instead of the first design: b, c or d. It is judged and
        taken whatever the verdict is.
    ambient : float, optional
        Of the air round the actuator, deg C, a value of the design.
    quick : bool
        The screen by closed forms alone, which is no verdict.
    goal : Goal
        What the search makes small.
    progress : callable
        Told in a few words what begins.

    Raises
    ------
    InfeasibleError
        When no design meets the requirements; the message names the limits that bind.
    UsageError
        When any motor is asked for without a peak torque or beside a motor's data, or no
        alternative has the letter that is picked.
    """
    if any_motor and motor is not None:
        raise UsageError(
            f"any motor of the catalogue is asked for, and {motor.place} describes one; keep one "
            "of them."
        )
    air = _air(ambient)
    if cold := too_cold_a_surface(requirements, air):
        raise UsageError(f"{cold}.")
    named, row = "motor" in requirements.model_fields_set, None
    if motor is not None:
        # Whoever gives a motor's data asks for that motor.
        requirements = requirements.unchecked_copy({"motor": requirements.motor})
        row = row_over(requirements.motor, motor, named=named)
    found = _sized(
        requirements,
        row,
        any_motor=any_motor,
        pick=pick,
        quick=quick,
        ambient=ambient,
        goal=goal,
        progress=progress,
    )
    sizing = found.sizing.named(place.stem)
    if found.verdict is not None:
        from cqdd_design.sizing.costs import held_to_motor

        sizing = replace(sizing, costs=held_to_motor(sizing.costs, found.verdict.lines))
    # Both are written to the file even where they equal their defaults.
    own = {"schema_version": 1, "name": place.stem}
    design = _duty_from(sizing.design.replacing(own), place.parent)
    if motor is not None:
        design = design.with_motor(requirements.motor if named else None, motor)
        design = design if named else design.leaving("requirements.motor")
    verdict = found.verdict and replace(found.verdict, name=place.stem)
    return Road(sizing, design, (), verdict, found.derived, found.choice)


def _air(ambient: float | None) -> float:
    """Temperature of the air round the actuator, deg C, in the range that designs have."""
    if ambient is None:
        return Environment().ambient
    try:
        return Environment.model_validate({"ambient": ambient}, context={"si": True}).ambient
    except ValidationError as error:
        raise UsageError(f"--ambient: {error.errors()[0]['ctx']['error']}.") from None


def _sized(
    requirements: Requirements,
    row: Motor | None,
    *,
    any_motor: bool,
    pick: str,
    quick: bool,
    ambient: float | None,
    goal: Goal,
    progress: Progress,
) -> _Sized:
    """The design that is asked for, and the verdict on it unless the screen alone is."""

    def with_motor(asked: Requirements, row: Motor | None) -> _Sized:
        if quick:
            alone = size(asked, progress, motor=row, ambient=ambient, goal=goal)
            return _Sized(alone, None, frozenset())
        # The models of a verdict take as long to come as the screen alone to look.
        from cqdd_design.sizing.no_nearer import size_or_refuse
        from cqdd_design.sizing.verified import size_to_verdict

        # Of many motors each refusal would take minutes.
        way = size_to_verdict if any_motor else size_or_refuse
        done = way(asked, progress, motor=row, ambient=ambient, goal=goal)
        return _Sized(done.sizing, done.verdict, done.derived)

    if any_motor:
        from cqdd_design.sizing.motors import size_with_any

        first = size_with_any(
            requirements,
            with_motor,
            to_verdict=not quick,
            ambient=ambient,
            goal=goal,
            progress=progress,
        )
        found = replace(first.result, choice=first.choice)
    else:
        found = with_motor(requirements, row)
    if not pick:
        return found
    sizing = found.sizing.picking(pick)
    if found.verdict is None:
        return replace(found, sizing=sizing)
    from cqdd_design.verdict import judge

    progress("judging the alternative by the whole verdict")
    return replace(found, sizing=sizing, verdict=judge(resolve(sizing.design, row)))


def _duty_from(design: Design, folder: Path) -> Design:
    """The design with the file of its duty, found from the working folder, named from another."""
    named = design.requirements.duty_file
    if named is None:
        return design
    try:
        place = Path(os.path.relpath(named, folder))
    except ValueError:  # on another drive
        place = Path(named).absolute()
    log = design.requirements.duty_log
    return design.replacing({"requirements.duty_file": place.as_posix()}).with_duty_log(log)


#: Reducer keys that sizing takes over from the requirements.
_TAKEN_OVER = {
    "reducer.ratio": "ratio",
    "reducer.disc_count": "disc_count",
    "reducer.disc_material": "disc_material",
    "reducer.ring_material": "ring_material",
    "reducer.output_pins.material": "pin_material",
}


#: Of them, what sizing to the verdict chooses where nothing is asked for.
CHOSEN = frozenset({"disc_count", "disc_material", "ring_material"})


def _origins(road: Road) -> dict[str, str]:
    """A remark for every key of a sized design that is written: where its value comes from."""
    design, derived, chosen = road.design, road.derived, road.chosen
    remarks = {}
    for key in design.dotted_keys():
        if key in {"requirements.motor", "motor.name"} and "motor" in chosen:
            remarks[key] = "sized"
        elif key.startswith(("requirements.", "motor.")) or key == "environment.ambient":
            remarks[key] = "assumed" if key.partition(".")[2] in derived else "given"
        elif key in _TAKEN_OVER:
            wanted = _TAKEN_OVER[key]
            stated = wanted in design.requirements.model_fields_set
            usual = "sized" if wanted in chosen else "assumed"
            remarks[key] = "given" if stated else usual
        elif key.startswith("reducer."):
            remarks[key] = "sized"
    return remarks
