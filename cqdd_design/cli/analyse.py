"""``cqdd-design analyse``."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING, Annotated

import typer

from cqdd_design.cli.options import (
    DesignFile,
    Duty,
    DutyColumnNames,
    NamedMotor,
    OwnMotor,
    option,
    parse_option,
    parse_positive,
    quantity_option,
)
from cqdd_design.cli.session import Output, read_design
from cqdd_design.cli.tables import number, table
from cqdd_design.library.inputs import under_duty

if TYPE_CHECKING:
    from collections.abc import Mapping

    from cqdd_design.actuator.shock import Shock
    from cqdd_design.gearbox import GearboxAnalysis
    from cqdd_design.roads.analyse import Analysis


class ContactLaw(StrEnum):
    """Approach of teeth and pins over force."""

    palmgren = "palmgren"
    johnson = "johnson"
    linear = "linear"


class Friction(StrEnum):
    """Which way power goes through contacts that rub, if they do."""

    drive = "drive"
    backdrive = "backdrive"
    off = "off"


def analyse(
    out: Output,
    design: DesignFile,
    torque: Annotated[
        str | None,
        quantity_option('Output torque of all but the verdict, for ever, as in "40 N*m".'),
    ] = None,
    angles: Annotated[int, option("N", "Crank angles of the curves.", min=8, max=100_000)] = 360,
    speed: Annotated[str | None, quantity_option('Input speed, as in "1286 rpm".')] = None,
    law: Annotated[
        ContactLaw, typer.Option("--contact-law", help="How line contacts yield to force.")
    ] = ContactLaw.palmgren,
    friction: Annotated[
        Friction,
        typer.Option(
            "--friction", help="Contact forces with friction while the crank or the output drives."
        ),
    ] = Friction.drive,
    temperature: Annotated[
        str | None,
        quantity_option('Of all parts of the gearbox, as in "60 degC"; default 20 degC, as drawn.'),
    ] = None,
    motor: NamedMotor = None,
    motor_file: OwnMotor = None,
    duty: Duty = None,
    duty_columns: DutyColumnNames = None,
) -> None:
    """Loads, contact equilibrium, precision, losses, life, stress of discs and ring, and shock."""
    from cqdd_design.roads.analyse import analyse as analysed
    from cqdd_design.units import SPEED, TEMPERATURE, TORQUE
    from cqdd_design.verdict.judge import sentence

    asked_torque = parse_positive("--torque", torque, TORQUE)
    parts_at = parse_option("--temperature", temperature, TEMPERATURE)
    asked_speed = parse_positive("--speed", speed, SPEED)
    loaded = under_duty(read_design(out, design, motor, motor_file), duty, duty_columns)
    out.compile_ahead(simulation=True)
    found = analysed(
        loaded,
        torque=asked_torque,
        speed=asked_speed,
        angles=angles,
        line_model=law.value,
        friction=friction.value,
        temperature=parts_at,
    )
    results, checks = found.to_dict(), found.checks
    lines = [*_at_lines(found), *_lines(found.gearbox, results), *_shock_lines(found.shocks)]
    out.say(*lines, "", f"{sentence(loaded.name, checks)} (`check` draws toleranced ones too)")
    out.warn(*found.warnings)
    out.document(results, design=found.machine.given, checks=checks)


def _lines(analysis: GearboxAnalysis, results: dict[str, object]) -> list[str]:
    lines = []
    titles = {
        "geometry": "geometry",
        "rigid": f"rigid loads at {number(analysis.rigid.torque)} N*m",
        "output_pins": "output pins",
        "bearings": "cam bearing",
        "balance": "balance",
        "duty": "duty over time, at the output and at the motor",
        "contact": "contact equilibrium",
        "precision": "precision",
        "losses": "losses",
        "film": "films at the ring teeth and output pins",
        "wear": "wear over the required life",
        "life": "life",
        "bending": "shaft and tilt, bounded",
        "bodies": "discs and ring under these forces",
        "temperatures_degC": "temperatures at which parts settle",
        "heat": "heat, and clearances at these temperatures",
    }
    for key, title in titles.items():
        values = results[key]
        if values is None:
            continue
        assert isinstance(values, dict)
        flat = values["cam"] if key == "bearings" else values
        rows = [[f"  {name}", _shown(value)] for name, value in _single(flat).items()]
        lines += [title, table(rows), ""]
    return lines[:-1]


def _at_lines(found: Analysis) -> list[str]:
    """Which sections stand for which torque."""
    from cqdd_design.cli.tables import told
    from cqdd_design.roads.analyse import ASKED

    groups: dict[str, list[str]] = {}
    for section, load in found.at.items():
        groups.setdefault(load, []).append(section)
    asked = "" if found.asked_torque is None else f" (--torque {number(found.asked_torque)} N*m)"
    return [
        "which torque",
        told(
            [
                (f"{load}{asked if load == ASKED else ''}", ", ".join(names))
                for load, names in groups.items()
            ]
        ),
        "",
    ]


def _shock_lines(shocks: Mapping[str, Shock]) -> list[str]:
    from cqdd_design.actuator.shock import METHODS
    from cqdd_design.cli.tables import told

    lines = []
    for name, one in shocks.items():
        head = (
            f"into a rigid stop from {number(one.speed)} rad/s ({name} speed), "
            f"{number(one.energy)} J"
        )
        lines += ["", head, told([(METHODS[key], stop.told) for key, stop in one.stops.items()])]
    return lines


def _single(values: dict[str, object]) -> dict[str, object]:
    """What fits on one line each: curves and tables are in the JSON and in the report."""
    found: dict[str, object] = {}
    for name, value in values.items():
        if isinstance(value, dict):
            found |= {f"{name}.{inner}": v for inner, v in _single(value).items()}
        elif not isinstance(value, list):
            found[name] = value
        elif value and len(value) <= 3 and all(isinstance(item, float) for item in value):
            found[name] = ", ".join(number(item) for item in value)
    return found


def _shown(value: object) -> str:
    if isinstance(value, float):
        return number(value)
    return "-" if value is None else str(value)
