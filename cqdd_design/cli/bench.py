"""``cqdd-design bench``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cqdd_design.cli.options import DesignFile, Force, parse_positive
from cqdd_design.cli.session import Output
from cqdd_design.cli.tables import number, table

if TYPE_CHECKING:
    from cqdd_design.actuator.bench import BenchResult


def bench(
    out: Output,
    design: DesignFile,
    only: Annotated[
        str | None, typer.Option(metavar="NAMES", help="Measurements, separated by commas.")
    ] = None,
    voltage: Annotated[
        str | None,
        typer.Option(metavar="Q", help='Supply of the dynamic rows; default "24 V".'),
    ] = None,
    folder: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Write every trace there, as npz.")
    ] = None,
    force: Force = False,
) -> None:
    """Virtual test bench: the data sheet of the actuator, measured on its simulation."""
    from cqdd_design import pipeline
    from cqdd_design.design import load_design
    from cqdd_design.units import VOLTAGE

    names = tuple(name.strip() for name in only.split(",") if name.strip()) if only else ()
    asked = parse_positive("--voltage", voltage, VOLTAGE)
    loaded = load_design(design)
    out.note_compilation()
    result = pipeline.bench(
        loaded, only=names, voltage=asked, progress=out.stages(len(names) or 16)
    )
    files = () if folder is None else pipeline.write_traces(result, folder, force=force)
    out.say(*_lines(result))
    out.wrote(files)
    for sentence in result.warnings:
        out.warn(sentence)
    out.document(result.to_dict(), design=loaded, files=files)


def _lines(result: BenchResult) -> list[str]:
    rows = []
    for metric in result.metrics:
        paper = result.paper(metric.name)
        rows.append(
            [
                metric.name,
                number(metric.value),
                "" if metric.spread is None else number(metric.spread),
                metric.unit,
                "" if paper is None else number(paper),
                metric.relation,
            ]
        )
    head = ["measurement", "value", "spread", "unit", "paper", "agreement is"]
    lines = [
        table(rows, head=head, right=(1, 2, 4)),
        "",
        f"{len(rows)} measurements in {number(result.seconds)} s; dynamic rows at "
        f"{result.voltage:g} V. Protocols are in the JSON.",
    ]
    return lines
