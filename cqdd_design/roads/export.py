"""Files of a design for makers and simulators."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from cqdd_design.actuator.specimen import AS_DRAWN, Specimen
from cqdd_design.design import Design
from cqdd_design.exporting import ExportOptions
from cqdd_design.exporting import export as write
from cqdd_design.exporting.options import DEFAULTS
from cqdd_design.files import WrittenFile
from cqdd_design.roads.telling import Progress, silent


def export(
    design: Design,
    kinds: str | Iterable[str],
    folder: Path | None = None,
    *,
    specimen: Specimen = AS_DRAWN,
    force: bool = False,
    options: ExportOptions = DEFAULTS,
    progress: Progress = silent,
) -> tuple[WrittenFile, ...]:
    """Write the files of a design; see `exporting.export`."""
    machine = specimen.machine(design)
    return write(
        machine, kinds, folder, force=force, progress=progress, options=options, specimen=specimen
    )
