"""``cqdd-design export``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from cqdd_design.cli.options import DesignFile, Force
from cqdd_design.cli.session import Output


def export(
    out: Output,
    design: DesignFile,
    to: Annotated[
        str,
        typer.Option("--to", metavar="LIST", help="Kinds: dxf, step, stl, 3mf, glb, svg, bom."),
    ] = "dxf,step",
    folder: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Where to; default exports/NAME."),
    ] = None,
    force: Force = False,
) -> None:
    """Files for makers: DXF for wire EDM, STEP, meshes, bill of materials."""
    from cqdd_design.design import load_design
    from cqdd_design.exporting import export as write
    from cqdd_design.exporting import read_kinds

    kinds = read_kinds(to)
    loaded = load_design(design)
    solids = bool(set(kinds) - {"dxf", "svg"})
    stages = out.stages(len(kinds) + solids)
    files = write(loaded, kinds, folder, force=force, progress=stages)
    out.wrote(files)
    out.document({"kinds": list(kinds)}, design=loaded, files=files)
