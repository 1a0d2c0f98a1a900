"""``cqdd-design size``."""

from __future__ import annotations

import sys
import textwrap
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cqdd_design.cli.completion import export_kinds, sized_motors
from cqdd_design.cli.fitting import WIDTH, on_screen
from cqdd_design.cli.options import (
    Duty,
    DutyColumnNames,
    Force,
    OwnMotor,
    option,
    parse_option,
    parse_ratio,
    quantity_option,
)
from cqdd_design.cli.requirement_options import stated, with_requirements
from cqdd_design.cli.session import Output
from cqdd_design.cli.tables import (
    binding,
    checks_table,
    costs_told,
    folded,
    headline_table,
    number,
    table,
)

if TYPE_CHECKING:
    from cqdd_design.design import Design
    from cqdd_design.roads.size import Road
    from cqdd_design.sizing import SizingResult
    from cqdd_design.sizing.motors import MotorChoice
    from cqdd_design.verdict import Verdict


_ONLY_JUDGED = (
    "speed_at_peak", "shock_speed", "bore", "mass", "reflected_inertia", "backlash", "lost_motion",
    "stiffness", "efficiency", "surface_temperature", "external_moment", "external_axial",
    "external_radial",
)  # fmt: skip
"""Requirements of which the screen alone knows nothing."""


class Objective(StrEnum):
    """What a search makes small."""

    mass = "mass"
    inertia = "inertia"
    backlash = "backlash"
    efficiency = "efficiency"
    size = "size"


class Pick(StrEnum):
    """Letters of the alternatives."""

    b = "b"
    c = "c"
    d = "d"


@with_requirements
def size(
    out: Output,
    ratio: Annotated[str | None, option("N", "Reduction, a whole number from 4 to 119.")] = None,
    motor: Annotated[
        str | None,
        option(
            "NAME",
            "Default CubeMars RO100 KV55; any: the first that fits of all.",
            autocompletion=sized_motors,
        ),
    ] = None,
    motor_file: OwnMotor = None,
    discs: Annotated[int | None, option("N", "Discs on the crank, 1 to 3; default 2 or 3.")] = None,
    requirements: Annotated[
        Path | None, option("FILE", "TOML with [requirements]; options replace its values.")
    ] = None,
    target: Annotated[Path | None, option("FILE", "Default designs/sized-N.toml.", "--out")] = None,
    report: Annotated[
        bool, typer.Option("--report", help="Write reports/sized-N.html too.")
    ] = False,
    export: Annotated[
        str | None,
        option(
            "LIST",
            "Write exports/sized-N/ too: dxf, step, ... as `export`.",
            autocompletion=export_kinds,
        ),
    ] = None,
    ambient: Annotated[
        str | None, quantity_option('Of the air round the actuator; default "25 degC".')
    ] = None,
    duty: Duty = None,
    duty_columns: DutyColumnNames = None,
    objective: Annotated[
        Objective, typer.Option("--objective", help="What is made small; losses for efficiency.")
    ] = Objective.mass,
    quick: Annotated[
        bool,
        typer.Option(
            "--quick",
            help="The screen by closed forms alone: no verdict, and torques that are left out are "
            "9 N*m times the ratio, 90 N*m at most, and 0.38 of that.",
        ),
    ] = False,
    pick: Annotated[
        Pick | None,
        typer.Option(
            "--pick", help="Write this alternative; judged, and exit code 4 unless it is yes."
        ),
    ] = None,
    verbose: Annotated[
        bool, typer.Option("--verbose", help="Tell all checks, and what the search rejected.")
    ] = False,
    force: Force = False,
    **asked: Any,
) -> int:
    """Requirements to a design file whose verdict is yes."""
    from cqdd_design.exporting import read_kinds
    from cqdd_design.library.inputs import not_taken_over, read_wanted
    from cqdd_design.roads.size import size_and_write
    from cqdd_design.units import TEMPERATURE

    asked = stated(asked)
    asked |= {} if ratio is None else {"ratio": parse_ratio(ratio)}
    asked |= {} if discs is None else {"disc_count": discs}
    kinds = () if export is None else read_kinds(export)
    wanted = read_wanted(
        asked,
        requirements,
        motor=motor,
        motor_file=motor_file,
        duty=duty,
        duty_columns=duty_columns,
    )
    if requirements is not None and (left := not_taken_over(requirements)):
        out.warn(left)
    if not quick or report:
        stopped = wanted.requirements.shock_speed > 0.0
        out.compile_ahead(simulation=report or stopped, ensembles=True, sizing=True)
    road = size_and_write(
        wanted.requirements,
        target,
        motor=wanted.motor,
        any_motor=wanted.any_motor,
        pick="" if pick is None else pick.value,
        ambient=parse_option("--ambient", ambient, TEMPERATURE),
        kinds=kinds,
        report=report,
        quick=quick,
        goal=objective.value,
        force=force,
        progress=out.rounds(),
    )
    judged = road.verdict
    out.say(*_lines(road, verbose=verbose))
    if road.choice is not None:
        out.say(*_motors(road.choice))
    out.say(*(_screened(road) if judged is None else _judged(road, judged, verbose=verbose)))
    out.warn(*road.warnings)
    out.wrote(road.files)
    out.document(road.to_dict(), design=road.design, checks=road.lines, files=road.files)
    if judged is None or judged.meets == "yes":
        return 0
    out.note(f"{road.files[0].path} was written all the same: --pick {pick} asked for it.")
    return 4


def _lines(road: Road, *, verbose: bool) -> list[str]:
    from cqdd_design.design.requirements import DEFAULT_CONTINUOUS_SHARE

    design, sizing = road.design, road.sizing
    others = sum(not key.startswith("requirements.") for key in design.assumed)
    assumed = [key.split(".")[1] for key in design.assumed if key.startswith("requirements.")]
    own = {"motor"} if design.motor.data else set()
    assumed = [key for key in assumed if key not in {*road.chosen, *own}]
    asked = design.to_mapping()["requirements"]
    motor = "by what motor and gearbox can do"
    derived = road.derived
    if design.requirements.load_cases:
        # The duty says what lasts, and nothing is judged by this.
        derived = derived - {"continuous_torque"}
    if "peak_torque" not in derived:
        motor += f", {DEFAULT_CONTINUOUS_SHARE:g} of the peak at most"
    defaults = [[f"  {key}", str(asked[key]), motor] for key in asked if key in derived]
    defaults += [[f"  {key}", str(asked[key]), ""] for key in assumed]
    rejected = [[f"  {reason}", f"{count:,}"] for reason, count in sizing.rejected.items() if count]
    return [
        "assumed because you did not say (name them to change them):",
        table(defaults),
        f"  and {others} defaults of the design file",
        "",
        f"{sizing.candidates_screened:,} candidates, {sizing.survivors:,} pass the first screen"
        + ("; rejected first by:" if verbose else ""),
        *([table(rejected, right=(1,))] if verbose else []),
        "",
        table(_choices(sizing), head=_CHOICE_HEAD, right=tuple(range(1, len(_CHOICE_HEAD)))),
        textwrap.fill(
            f"sizes in mm; counted: {sizing.objective.scope}; `inertia` weighs the whole machine."
            + (
                " Alternatives are found by closed forms: --pick judges one."
                if sizing.alternatives
                else ""
            ),
            WIDTH,
        ),
        "",
    ]


def _motors(choice: MotorChoice) -> list[str]:
    """How the motor was found: those that were screened, and what was tried."""
    rows = []
    tried = {one.name: one.why or "taken" for one in choice.tried}
    for one in choice.ranked:
        name, value = one.motor.name, "-"
        if one.value is not None:
            value = f"{number(one.value)} {one.unit}"
        rows.append([f"  {name}", value, tried.get(name) or one.why or "only screened"])
    sentences = [line for one in choice.sentences for line in folded(one)]
    return [*sentences, table(rows), ""]


def _screened(road: Road) -> list[str]:
    """What the screen alone says, and that it is no verdict."""
    goal = road.sizing.objective
    return [
        checks_table(road.sizing.checks),
        "",
        *folded(
            f"{road.design.name}: no verdict, but the screen by closed forms; {goal.binding} "
            f"binds, {number(goal.torque_reserve)} times the torque is its limit. See `check`."
        ),
        *_not_screened(road.design),
    ]


def _not_screened(design: Design) -> list[str]:
    """What was asked for that only the verdict judges."""
    named = [key for key in _ONLY_JUDGED if getattr(design.requirements, key)]
    if not named:
        return []
    return folded(f"not judged by the screen: {', '.join(named)}; `check` judges them.")


def _judged(road: Road, judged: Verdict, *, verbose: bool) -> list[str]:
    """The verdict on the design that was written, and where to go from it."""
    return [
        *([checks_table(judged.lines), ""] if verbose else []),
        headline_table(judged),
        "",
        binding(judged),
        "",
        *costs_told([one.told for one in road.sizing.costs]),
        on_screen(judged.sentence, sys.stdout),
        *_next(road),
    ]


def _next(road: Road) -> list[str]:
    """Commands that go on from here, but for what was asked for already."""
    place, done = road.files[0].path.as_posix(), {one.kind for one in road.files}
    steps = [f"  cqdd-design check {place}"]
    if "report" not in done:
        steps.append(f"  cqdd-design report {place}")
    if done <= {"design", "report"}:
        steps.append(f"  cqdd-design export {place} --to edm,step")
    return ["next:", *steps]


_CHOICE_HEAD = (
    "design",
    "mass g",
    "kg*mm^2",
    "reserve",
    "R",
    "e",
    "tooth",
    "disc",
    "pins",
    "bearing",
)


def _choices(sizing: SizingResult) -> list[list[str]]:
    """The design and its alternatives on the trade of mass against stress."""
    rows = []
    chosen = (sizing.design, sizing.objective)
    others = ((one.design, one.objective) for one in sizing.alternatives)
    for design, objective in (chosen, *others):
        reducer = design.reducer
        pins = reducer.output_pins
        rows.append(
            [
                design.name,
                number(1e3 * objective.mass),
                "-"
                if objective.reflected_inertia is None
                else number(1e6 * objective.reflected_inertia),
                f"{objective.torque_reserve:.2f}",
                number(1e3 * reducer.ring_pitch_radius),
                number(1e3 * reducer.eccentricity),
                number(1e3 * reducer.ring_pin_diameter),
                number(1e3 * reducer.disc_thickness),
                f"{pins.count} x {number(1e3 * pins.diameter)}",
                reducer.cam_bearing.designation,
            ]
        )
    return rows
