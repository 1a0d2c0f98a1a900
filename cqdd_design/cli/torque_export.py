"""``cqdd-design torque export``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from cqdd_design.cli import completion
from cqdd_design.cli.options import Force, NamedMotor, OwnMotor, option
from cqdd_design.cli.session import Output, read_design
from cqdd_design.cli.tables import folded
from cqdd_design.cli.torque_actuator import refuse_without_design
from cqdd_design.environment import output_folder
from cqdd_design.exporting.estimators.kinds import KINDS
from cqdd_design.exporting.kinds import read_kinds


def export_network(
    out: Output,
    model: Annotated[
        Path, typer.Argument(metavar="MODEL", help="Network (.npz) that was trained.")
    ],
    to: Annotated[
        str,
        option(
            "LIST",
            f"Of {', '.join(KINDS)}; with commas.",
            autocompletion=completion.estimator_kinds,
        ),
    ] = "onnx,c",
    folder: Annotated[Path | None, option("DIR", "Default exports/NAME.", "--out")] = None,
    design: Annotated[
        Path | None,
        option("DESIGN", "Of today, to be told whether it is what the network was trained on."),
    ] = None,
    motor: NamedMotor = None,
    motor_file: OwnMotor = None,
    force: Force = False,
) -> int:
    """Write a trained network for simulators, onnxruntime, or as a C header."""
    from cqdd_design.exporting.estimators.export import export_artefact
    from cqdd_design.exporting.estimators.options import metadata
    from cqdd_design.torque.evaluation.carried import DesignVersion, carried, moved_on
    from cqdd_design.torque.networks.artefact import read_artefact
    from cqdd_design.torque.networks.meaning import meaning

    kinds = read_kinds(to, KINDS)
    refuse_without_design(design, {"--motor": motor, "--motor-file": motor_file})
    loaded = None if design is None else read_design(out, design, motor, motor_file)
    artefact = read_artefact(model)
    written = export_artefact(
        artefact,
        kinds,
        folder or output_folder("exports") / model.stem,
        model.stem,
        force=force or folder is None,
    )
    out.warn(*written.warnings)
    told = meaning(artefact)
    out.say(*folded(told.joint_told), "", *folded(told.filter_told), "")
    if loaded is not None:
        now = DesignVersion(loaded.name, loaded.sha256)
        out.warn(*moved_on({artefact.name: artefact}, now))
    if kept := carried(artefact):
        out.say(*folded(kept), "")
    out.warn(*(f"{one.kind} was not written: {one.error.message}" for one in written.refused))
    out.wrote(written.files)
    out.document(metadata(artefact, artefact.mode), files=written.files)
    return written.refused[0].error.exit_code if written.refused else 0
