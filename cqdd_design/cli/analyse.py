"""``cqdd-design analyse``."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

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
from cqdd_design.library.inputs import under_duty


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
    speed: Annotated[
        str | None, quantity_option('Input speed of all but the verdict, as in "1286 rpm".')
    ] = None,
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
    from cqdd_design.cli.analysis_text import analysis_lines
    from cqdd_design.roads.analyse import analyse as analysed
    from cqdd_design.roads.analyse import asks_of_gearboxes
    from cqdd_design.units import SPEED, TEMPERATURE, TORQUE
    from cqdd_design.verdict.judge import meets, sentence

    asked_torque = parse_option("--torque", torque, TORQUE)
    parts_at = parse_option("--temperature", temperature, TEMPERATURE)
    asked_speed = parse_positive("--speed", speed, SPEED)
    loaded = under_duty(read_design(out, design, motor, motor_file), duty, duty_columns)
    out.compile_ahead(loaded, simulation=True, ensembles=asks_of_gearboxes(loaded))
    found = analysed(
        loaded,
        torque=asked_torque,
        speed=asked_speed,
        angles=angles,
        line_model=law.value,
        friction=friction.value,
        temperature=parts_at,
    )
    out.say(*analysis_lines(found), "")
    out.say(sentence(loaded.name, found.checks))
    if not found.toleranced and meets(found.checks) != "yes":
        out.say("(`check` draws toleranced gearboxes too)")
    out.warn(*found.warnings)
    out.document(found.to_dict(), design=found.machine.given, checks=found.checks)
