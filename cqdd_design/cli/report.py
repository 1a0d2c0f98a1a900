"""``cqdd-design report``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from cqdd_design.cli.options import DesignFile, Force
from cqdd_design.cli.session import Output


def report(
    out: Output,
    design: DesignFile,
    target: Annotated[
        Path | None,
        typer.Option("--out", metavar="FILE", help="Where to; default reports/NAME.html."),
    ] = None,
    force: Force = False,
) -> None:
    """One self-contained HTML file for the design review."""
    from cqdd_design import pipeline
    from cqdd_design.cli.tables import verdict
    from cqdd_design.design import load_design

    loaded = load_design(design)
    out.note_compilation(simulation=True)
    file, analysis = pipeline.write_report(
        loaded, target, source=design, force=force, progress=out.stages(pipeline.REPORT_STAGES)
    )
    out.wrote([file])
    out.say(f"{loaded.name}: {verdict(analysis.checks)}")
    for sentence in analysis.warnings:
        out.warn(sentence)
    out.document({}, design=loaded, checks=analysis.checks, files=[file])
