"""``cqdd-design check``."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated

import typer

from cqdd_design.cli.options import DesignFile, NamedMotor, OwnMotor, option
from cqdd_design.cli.session import Output, read_design, read_specimen

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
) -> int:
    """Run every check of a design (exit code 4: one fails)."""
    from cqdd_design.cli.tables import checks_table, remedies, verdict
    from cqdd_design.results import worst_status
    from cqdd_design.roads.check import check as judged

    loaded = read_design(out, design, motor, motor_file)
    found = judged(
        loaded,
        read_specimen(
            out,
            loaded,
        ),
        assembly_angles=angles if assembly else None,
        progress=out.counting("crank angles"),
    )
    checks, motion, worst = found.checks, found.motion, worst_status(found.checks)
    out.say(checks_table(checks), "")
    if motion is not None:
        out.say(*_clearances(motion), "")
    if worst != "pass":
        out.say(remedies(checks), "")
    out.say(f"{loaded.name}: {verdict(checks)}")
    out.warn(*found.warnings)
    seen = {} if motion is None else {"assembly": motion.to_dict()}
    out.document({"verdict": worst, **seen}, design=loaded, checks=checks)
    return 4 if worst == "fail" else 0


def _clearances(motion: AssemblyMotion) -> list[str]:
    from cqdd_design.cli.tables import number, table

    rows = [
        [one.first, one.second, number(one.gap * 1e6), number(math.degrees(one.crank_angle))]
        for one in motion.clearances
    ]
    head = ["comes near", "what", "least gap um", "at crank deg"]
    return [
        f"{motion.angles} crank angles over one revolution of the output, "
        f"{motion.pairs:,} pairs of solids: {len(motion.collisions)} collisions",
        "",
        table(rows, head=head, right=(2, 3)),
    ]
