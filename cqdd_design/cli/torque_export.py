"""``cqdd-design torque export``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from cqdd_design.cli.options import Force, parse_names
from cqdd_design.cli.session import Output
from cqdd_design.errors import UsageError, did_you_mean


def export_network(
    out: Output,
    model: Annotated[
        Path, typer.Argument(metavar="MODEL", help="Network (.npz) that was trained.")
    ],
    to: Annotated[
        str,
        typer.Option(
            "--to",
            metavar="LIST",
            help="Of onnx, torchscript-isaaclab, newton, mjlab, c; with commas.",
        ),
    ] = "onnx,c",
    folder: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Default exports/NAME.")
    ] = None,
    force: Force = False,
) -> None:
    """Write a trained network for simulators, onnxruntime, or as a C header."""
    from cqdd_design.exporting.estimators.export import export_artefact
    from cqdd_design.exporting.estimators.options import KINDS, metadata
    from cqdd_design.torque.networks.artefact import read_artefact

    kinds = tuple(dict.fromkeys(parse_names(to)))
    for kind in kinds:
        if kind not in KINDS:
            hint = did_you_mean(kind, KINDS)
            raise UsageError(f"--to {kind} is none of {', '.join(KINDS)}{hint}.")
    if not kinds:
        raise UsageError(f"--to names nothing; choose of {', '.join(KINDS)}.")
    artefact = read_artefact(model)
    written = export_artefact(
        artefact,
        kinds,
        folder or Path("exports") / model.stem,
        model.stem,
        force=force or folder is None,
    )
    for sentence in written.warnings:
        out.warn(sentence)
    out.wrote(written.files)
    out.document(metadata(artefact, artefact.mode), files=written.files)
