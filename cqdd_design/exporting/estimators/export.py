"""Write a trained estimator in several forms at once, all of them or none."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from cqdd_design.exporting.estimators.c_header import write_c_header
from cqdd_design.exporting.estimators.isaaclab import export_isaaclab
from cqdd_design.exporting.estimators.mjlab import export_mjlab
from cqdd_design.exporting.estimators.newton import export_newton
from cqdd_design.exporting.estimators.onnx import export_onnx
from cqdd_design.exporting.estimators.options import Export
from cqdd_design.files import WrittenFile, refuse_overwrite, write_with

if TYPE_CHECKING:
    from cqdd_design.torque.networks.artefact import Artefact


def export_artefact(
    artefact: Artefact, kinds: Sequence[str], folder: Path, name: str, *, force: bool = False
) -> Export:
    """Write `kinds` into `folder`, their names beginning with `name`.

    Raises
    ------
    UsageError
        When a client cannot feed the network, or a file exists and `force` is not set.
    ReadBackError
        When a file does not give the estimator's torque.
    """
    writers: dict[str, Callable[[Artefact, Path], Export]] = {
        "onnx": export_onnx,
        "torchscript-isaaclab": export_isaaclab,
        "newton": export_newton,
        "mjlab": export_mjlab,
        "c": _export_c,
    }
    warnings: list[str] = []
    made: list[WrittenFile] = []
    with tempfile.TemporaryDirectory() as scratch:
        for kind in kinds:
            written = writers[kind](artefact, Path(scratch) / name)
            made += written.files
            warnings += written.warnings
        places = [folder / file.path.name for file in made]
        for place in places:
            refuse_overwrite(place, force=force)
        files = []
        for file, place in zip(made, places, strict=True):
            found = write_with(place, file.kind, partial(shutil.copyfile, file.path))
            files.append(replace(found, path=place))
    return Export(tuple(files), tuple(dict.fromkeys(warnings)))


def _export_c(artefact: Artefact, path: Path) -> Export:
    return Export((write_c_header(artefact, path.with_name(f"{path.name}.h")),))
