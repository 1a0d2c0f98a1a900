"""``cqdd-design size``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cqdd_design.cli.options import (
    Force,
    OwnMotor,
    option,
    parse_option,
    parse_ratio,
    quantity_option,
)
from cqdd_design.cli.session import Output
from cqdd_design.cli.tables import checks_table, number, table, verdict
from cqdd_design.errors import DesignError, UsageError

if TYPE_CHECKING:
    from cqdd_design.design import Design, Requirements
    from cqdd_design.sizing import SizingResult


def size(
    out: Output,
    ratio: Annotated[str | None, option("N", "Reduction, a whole number from 4 to 119.")] = None,
    peak_torque: Annotated[
        str | None, quantity_option("At the output; default min(9*N, 90) N*m.")
    ] = None,
    continuous_torque: Annotated[
        str | None, quantity_option("At the output; default 0.38 of the peak.")
    ] = None,
    input_speed: Annotated[str | None, quantity_option('Default "1286 rpm".')] = None,
    outer_diameter: Annotated[str | None, quantity_option('Of the ring; default "72 mm".')] = None,
    length: Annotated[str | None, quantity_option('Of the disc pack; default "20 mm".')] = None,
    motor: Annotated[str | None, option("NAME", "Default CubeMars RO100 KV55.")] = None,
    motor_file: OwnMotor = None,
    discs: Annotated[int | None, option("N", "Discs on the crank, 1 to 3; default 2.")] = None,
    requirements: Annotated[
        Path | None, option("FILE", "TOML with [requirements]; options replace its values.")
    ] = None,
    target: Annotated[Path | None, option("FILE", "Default designs/sized-N.toml.", "--out")] = None,
    report: Annotated[
        bool, typer.Option("--report", help="Write reports/sized-N.html too.")
    ] = False,
    export: Annotated[
        str | None, option("LIST", "Write exports/sized-N/ too: dxf, step, ... as `export`.")
    ] = None,
    force: Force = False,
) -> None:
    """Requirements to a checked design file."""
    from cqdd_design.catalog import find_bare_motor
    from cqdd_design.design import load_required_motor
    from cqdd_design.design.motor import read_motor
    from cqdd_design.exporting import read_kinds
    from cqdd_design.roads.size import road_stages, size_and_write
    from cqdd_design.units import LENGTH, SPEED, TORQUE

    quantities = (
        ("peak_torque", peak_torque, TORQUE),
        ("continuous_torque", continuous_torque, TORQUE),
        ("input_speed", input_speed, SPEED),
        ("outer_diameter", outer_diameter, LENGTH),
        ("length", length, LENGTH),
    )
    asked: dict[str, Any] = {} if ratio is None else {"ratio": parse_ratio(ratio)}
    for key, text, dimension in quantities:
        if parse_option(f"--{key.replace('_', '-')}", text, dimension) is not None:
            asked[key] = text
    asked |= {} if motor is None else {"motor": motor}
    asked |= {} if discs is None else {"disc_count": discs}
    if motor is not None:
        find_bare_motor(motor)
    own = None
    if motor_file is not None:
        own = read_motor(motor_file)
    elif motor is None and requirements is not None:
        own = load_required_motor(requirements)
    kinds = () if export is None else read_kinds(export)
    wanted = _requirements(asked, requirements)
    if report:
        out.note_compilation()
    road = size_and_write(
        wanted,
        target,
        motor=own,
        kinds=kinds,
        report=report,
        force=force,
        progress=out.stages(road_stages(kinds, report=report)),
    )
    out.say(*_lines(road.design, road.sizing))
    out.warn(*(f"{c.id}: {c.remedy}." for c in road.sizing.checks if c.status == "warn"))
    out.warn(*road.sizing.warnings, *road.short)
    out.wrote(road.files)
    results, checks = road.sizing.to_dict(), road.sizing.checks
    out.document(results, design=road.design, checks=checks, files=road.files)


def _requirements(asked: dict[str, Any], file: Path | None) -> Requirements:
    """Options over a requirements file; what only the options say is a matter of usage."""
    from cqdd_design.design import load_requirements, requirements_from_mapping

    if file is not None:
        return load_requirements(file, asked)
    if "ratio" not in asked:
        raise UsageError("size needs --ratio N or --requirements FILE.")
    try:
        return requirements_from_mapping(asked, source="size")
    except DesignError as error:
        raise UsageError(error.message) from None


def _lines(design: Design, sizing: SizingResult) -> list[str]:
    assumed = [key for key in design.assumed if key.startswith("requirements.")]
    asked = design.to_mapping()["requirements"]
    defaults = [[f"  {key.split('.')[1]}", str(asked[key.split(".")[1]])] for key in assumed]
    rejected = [[f"  {reason}", f"{count:,}"] for reason, count in sizing.rejected.items() if count]
    return [
        "assumed because you did not say (name them to change them):",
        table(defaults),
        f"  and {len(design.assumed) - len(assumed)} defaults of the design file",
        "",
        f"{sizing.candidates_screened:,} candidates, {sizing.survivors:,} meet every check; "
        "rejected first by:",
        table(rejected, right=(1,)),
        "",
        checks_table(sizing.checks),
        "",
        table(_choices(sizing), head=_CHOICE_HEAD, right=tuple(range(1, len(_CHOICE_HEAD)))),
        f"counted: {sizing.objective.scope};",
        "`inertia` weighs the whole machine.",
        "",
        f"{design.name}: {verdict(sizing.checks)} by closed forms; {sizing.objective.binding} "
        "binds, "
        f"{number(sizing.objective.torque_reserve)} times the torque is its limit",
        "not judged here: heat, stress, contact equilibrium, life, tolerances; see `check` and "
        "`report`",
    ]


_CHOICE_HEAD = (
    "design",
    "mass g",
    "inertia kg*mm2",
    "reserve",
    "R mm",
    "e mm",
    "tooth mm",
    "disc mm",
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
