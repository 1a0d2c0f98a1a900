"""Files for makers: one module a format, reached by kind and imported only when asked for.

`export` writes every file of every kind asked for into a folder beside the last place, and moves
them there only when all are written: a full disk or a file that fails its own reading back leaves
the folder as it was.
"""

from __future__ import annotations

import contextlib
import dataclasses
import os
import shutil
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from cqdd_design.environment import output_folder
from cqdd_design.errors import UsageError
from cqdd_design.exporting.kinds import KINDS, read_kinds, stages
from cqdd_design.exporting.options import DEFAULTS, ExportOptions

if TYPE_CHECKING:
    from cqdd_design.actuator.specimen import Specimen
    from cqdd_design.design import Design
    from cqdd_design.exporting.job import Progress
    from cqdd_design.exporting.kinds import ExportKind
    from cqdd_design.files import WrittenFile
    from cqdd_design.machine import Machine

__all__ = [
    "KINDS",
    "ExportOptions",
    "default_folder",
    "export",
    "read_kinds",
    "stages",
]


def default_folder(design: Design) -> Path:
    """Where `export` writes when no folder is named: ``exports``, by the design's file."""
    return output_folder("exports") / design.file_name


def export(
    machine: Machine,
    kinds: str | Iterable[str],
    folder: Path | None = None,
    *,
    force: bool = False,
    progress: Progress | None = None,
    before: Callable[[ExportKind], None] | None = None,
    options: ExportOptions = DEFAULTS,
    specimen: Specimen | None = None,
) -> tuple[WrittenFile, ...]:
    """Write the files of a machine.

    Parameters
    ----------
    machine : Machine
        Of the specimen's motor.
    kinds : str or iterable of str
        Keys of `KINDS`, such as ``"dxf,step"``.
    folder : Path, optional
        Where to; made if missing. Left out, it is `default_folder`, whose files are this
        function's own and are replaced.
    force : bool
        Replace existing files in a named folder.
    progress : callable, optional
        Called with a few words before each kind of file.
    before : callable, optional
        Called with each kind before its files are written; may wait for what the kind needs.
    options : ExportOptions, optional
        How files are written.
    specimen : Specimen, optional
        Which actuator simulators get; default the one that is drawn.

    Returns
    -------
    tuple of WrittenFile
        In the order of `kinds`.

    Raises
    ------
    UsageError
        Unknown kind; a file exists and `force` is not set; the folder cannot be written.
    DesignError
        The design has no such part.
    ReadBackError
        A written file is not the part it should be.
    DependencyError
        A library that a kind needs is missing.
    """
    # The table of kinds is read for help, which must not pay for a job's imports.
    from cqdd_design.actuator.specimen import AS_DRAWN
    from cqdd_design.exporting.job import ExportJob
    from cqdd_design.exporting.staging import staging_folder
    from cqdd_design.files import ensure_folder, refuse_overwrite

    wanted, design = read_kinds(kinds), machine.given
    target = default_folder(design) if folder is None else folder
    tell = progress if progress is not None else _silent
    for kind in wanted:
        KINDS[kind].refuse(machine)
    made = _missing(target)
    placed: list[WrittenFile] = []
    try:
        with staging_folder(target, design.file_name) as staging:
            job = ExportJob(machine, staging, tell, options, specimen or AS_DRAWN)
            for kind in wanted:
                tell(f"writing {kind}")
                if before is not None:
                    before(KINDS[kind])
                placed += [
                    dataclasses.replace(one, path=target / one.path.relative_to(staging))
                    for one in KINDS[kind].load()(job)
                ]
            for one in placed:
                refuse_overwrite(one.path, force=force or folder is None)
            below = {one.path.parent for one in placed} - {target}
            made = [
                *dict.fromkeys(lost for path in sorted(below) for lost in _missing(path)),
                *made,
            ]
            for path in sorted(below):
                ensure_folder(path)
            placed = [dataclasses.replace(one, replaced=one.path.exists()) for one in placed]
            for one in placed:
                _move(staging / one.path.relative_to(target), one.path)
            made = []
    finally:
        for empty in made:
            with contextlib.suppress(OSError):
                empty.rmdir()
    return tuple(placed)


def _silent(message: str) -> None:
    """Progress that nobody asked for."""


def _missing(folder: Path) -> list[Path]:
    """Those of a folder and its parents that do not exist or cannot be seen, deepest first."""
    return [path for path in (folder, *folder.parents) if not os.path.exists(path)]


def _move(source: Path, target: Path) -> None:
    from cqdd_design.files import atomic_path

    try:
        if target.is_symlink():
            with atomic_path(target) as place:
                shutil.copyfile(source, place)
        else:
            os.replace(source, target)
    except OSError as error:
        raise UsageError(
            f"cannot write {target}: {error.strerror or error}; choose another place with --out."
        ) from error
