"""``cqdd-design check``."""

from __future__ import annotations

import math
import sys
from typing import TYPE_CHECKING, Annotated

import typer

from cqdd_design.cli.fitting import on_screen
from cqdd_design.cli.options import (
    DesignFile,
    Duty,
    DutyColumnNames,
    NamedMotor,
    OwnMotor,
    option,
)
from cqdd_design.cli.session import Output, read_design, read_specimen
from cqdd_design.library.inputs import under_duty

if TYPE_CHECKING:
    from cqdd_design.solids.clearances import AssemblyMotion


def check(
    out: Output,
    design: DesignFile,
    assembly: Annotated[
        bool,
        typer.Option("--assembly", help="Also turn the solids through a revolution of the output."),
    ] = False,
    angles: Annotated[int, option("N", "Crank angles of --assembly.", min=1, max=100_000)] = 72,
    motor: NamedMotor = None,
    motor_file: OwnMotor = None,
    duty: Duty = None,
    duty_columns: DutyColumnNames = None,
) -> int:
    """The verdict: every requirement and check of a design (exit code 4 unless it is yes)."""
    from cqdd_design.cli.tables import binding, checks_table, costs_told, headline_table
    from cqdd_design.roads.check import CHECK_STAGES
    from cqdd_design.roads.check import check as judged
    from cqdd_design.verdict.judge import sentence

    loaded = under_duty(read_design(out, design, motor, motor_file), duty, duty_columns)
    out.compile_ahead(loaded, simulation=loaded.requirements.shock_speed > 0.0, ensembles=True)
    found = judged(
        loaded,
        read_specimen(out, loaded),
        source=design,
        assembly_angles=angles if assembly else None,
        told=out.stages(CHECK_STAGES),
        progress=out.counting("crank angles"),
    )
    verdict, motion = found.verdict, found.motion
    out.say(checks_table(found.lines), "")
    if motion is not None:
        out.say(*_clearances(motion), "")
    out.say(headline_table(verdict), "", binding(verdict), "", *costs_told(found.costs))
    out.say(on_screen(sentence(loaded.name, found.lines), sys.stdout))
    out.warn(*verdict.warnings)
    out.document(found.to_dict(), design=loaded, checks=found.lines)
    return 0 if found.meets == "yes" else 4


def _clearances(motion: AssemblyMotion) -> list[str]:
    from cqdd_design.cli.tables import folded, number, table

    rows = [
        [one.first, one.second, number(one.gap * 1e6), number(math.degrees(one.crank_angle))]
        for one in motion.clearances
    ]
    head = ["comes near", "what", "least gap um", "at crank deg"]
    return [
        *folded(
            f"{motion.angles} crank angles over one revolution of the output, "
            f"{motion.pairs:,} pairs of solids: {len(motion.collisions)} collisions"
        ),
        "",
        table(rows, head=head, right=(2, 3)),
    ]
