"""Write a trained estimator in several forms at once: every form that it has."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from cqdd_design.errors import CqddError
from cqdd_design.exporting.estimators.kinds import KINDS
from cqdd_design.exporting.estimators.options import Export, Refusal
from cqdd_design.files import WrittenFile, refuse_overwrite, write_with

if TYPE_CHECKING:
    from cqdd_design.torque.networks.artefact import Artefact


def export_artefact(
    artefact: Artefact, kinds: Sequence[str], folder: Path, name: str, *, force: bool = False
) -> Export:
    """Write those of `kinds` that can be into `folder`, their names beginning with `name`.

    Returns
    -------
    Export
        With the kinds that could not be written, in `refused`: a client that cannot feed the
        network, a missing package, a file that does not give the estimator's torque.

    Raises
    ------
    UsageError
        When a file exists and `force` is not set; then none is written.
    CqddError
        Of the first kind that could not be written, when none could be.
    """
    warnings: list[str] = []
    made: list[WrittenFile] = []
    refused: list[Refusal] = []
    with tempfile.TemporaryDirectory() as scratch:
        for kind in kinds:
            try:
                written = KINDS[kind].load()(artefact, Path(scratch) / name)
            except CqddError as error:
                refused.append(Refusal(kind, error))
                continue
            made += written.files
            warnings += written.warnings
        if refused and not made:
            raise refused[0].error
        places = [folder / file.path.name for file in made]
        for place in places:
            refuse_overwrite(place, force=force)
        files = []
        for file, place in zip(made, places, strict=True):
            found = write_with(place, file.kind, partial(shutil.copyfile, file.path))
            files.append(replace(found, path=place))
    return Export(tuple(files), tuple(dict.fromkeys(warnings)), tuple(refused))
