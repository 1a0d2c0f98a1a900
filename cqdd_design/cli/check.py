"""``cqdd-design check``."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated

import typer

from cqdd_design.cli.options import DesignFile
from cqdd_design.cli.session import Output

if TYPE_CHECKING:
    from cqdd_design.solids.clearances import AssemblyMotion


def check(
    out: Output,
    design: DesignFile,
    assembly: Annotated[
        bool,
        typer.Option("--assembly", help="Also turn the solids through a revolution of the output."),
    ] = False,
    angles: Annotated[
        int, typer.Option(metavar="N", min=1, max=100_000, help="Crank angles of --assembly.")
    ] = 72,
) -> int:
    """Run every check of a design (exit code 4: one fails)."""
    from cqdd_design.cli.tables import checks_table, remedies, verdict
    from cqdd_design.design import load_design
    from cqdd_design.gearbox import analyse_gearbox
    from cqdd_design.results import worst_status

    loaded = load_design(design)
    analysis = analyse_gearbox(loaded)
    checks = analysis.checks
    results: dict[str, object] = {}
    if assembly:
        from cqdd_design import pipeline

        motion = pipeline.assembly_motion(loaded, angles, out.counting("crank angles"))
        results["assembly"] = motion.to_dict()
        checks = (*checks, pipeline.assembly_check(motion))
    out.say(checks_table(checks), "")
    if assembly:
        out.say(*_clearances(motion), "")
    if worst_status(checks) != "pass":
        out.say(remedies(checks), "")
    out.say(f"{loaded.name}: {verdict(checks)}")
    for sentence in analysis.warnings:
        out.warn(sentence)
    out.document({"verdict": worst_status(checks), **results}, design=loaded, checks=checks)
    return 4 if worst_status(checks) == "fail" else 0


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
