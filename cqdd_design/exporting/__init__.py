"""Files for makers: one module a format, reached by kind and imported only when asked for.

`export` writes every file of every kind asked for into a folder beside the last place, and moves
them there only when all are written: a full disk or a file that fails its own reading back leaves
the folder as it was.
"""

from __future__ import annotations

import contextlib
import dataclasses
import importlib
import os
import shutil
import uuid
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from cqdd_design.actuator.specimen import AS_DRAWN, Specimen
from cqdd_design.errors import UsageError, did_you_mean
from cqdd_design.exporting.options import DEFAULTS, ExportOptions
from cqdd_design.files import WrittenFile, ensure_folder, refuse_overwrite

if TYPE_CHECKING:
    from cqdd_design.actuator.parameters import ActuatorParameters
    from cqdd_design.design import Design
    from cqdd_design.machine import Machine
    from cqdd_design.solids.part import Part

__all__ = [
    "EXPORTERS",
    "ExportJob",
    "ExportOptions",
    "default_folder",
    "export",
    "read_kinds",
    "stages",
]

EXPORTERS: Mapping[str, str] = MappingProxyType(
    {
        "dxf": "cqdd_design.exporting.edm.dxf:export_dxf",
        "step": "cqdd_design.exporting.solids.step:export_step",
        "stl": "cqdd_design.exporting.solids.meshes:export_stl",
        "3mf": "cqdd_design.exporting.solids.meshes:export_3mf",
        "glb": "cqdd_design.exporting.solids.meshes:export_glb",
        "svg": "cqdd_design.exporting.sheets.svg:export_svg",
        "bom": "cqdd_design.exporting.solids.bom:export_bom",
        "mjcf": "cqdd_design.exporting.simulators.mjcf:export_mjcf",
        "urdf": "cqdd_design.exporting.simulators.urdf:export_urdf",
        "card": "cqdd_design.exporting.simulators.actuator_card:export_card",
        "bam": "cqdd_design.exporting.simulators.bam:export_bam",
        "edm": "cqdd_design.exporting.sheets.edm_package:export_edm",
        "gcode": "cqdd_design.exporting.edm.gcode:export_gcode",
    }
)
"""Kind of file, and the function that writes all files of that kind from an `ExportJob`."""

Progress = Callable[[str], None]


@dataclass(frozen=True)
class ExportJob:
    """What a writer needs: the design, where its files go, and the parts, built once for all.

    Attributes
    ----------
    machine : Machine
        Of the specimen's motor.
    folder : Path
        Exists; files go here under names that begin with the design's.
    progress : callable
        Told in a few words what is being done.
    options : ExportOptions
        How files are written.
    specimen : Specimen
        Which actuator simulators get.
    """

    machine: Machine
    folder: Path
    progress: Progress
    options: ExportOptions = DEFAULTS
    specimen: Specimen = AS_DRAWN

    @property
    def design(self) -> Design:
        """The design as it was given."""
        return self.machine.given

    def path(self, ending: str, within: str = "") -> Path:
        """File of this design: ``path("-disc.dxf")`` is ``<folder>/<name>-disc.dxf``.

        `within` names a folder below it, which need not exist yet.
        """
        return self.folder / within / f"{self.design.name}{ending}"

    @cached_property
    def actuator(self) -> ActuatorParameters:
        """The actuator in time, for the first writer that asks; later ones get the same."""
        from cqdd_design.actuator.build import actuator_parameters

        return actuator_parameters(self.machine, self.specimen)

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """The solids, for the first writer that asks; later ones get the same."""
        self.progress("laying out parts")
        return self.machine.parts


def read_kinds(text: str | Iterable[str]) -> tuple[str, ...]:
    """Kinds of a list such as ``"dxf,step"``, each once, in the order given.

    Raises
    ------
    UsageError
        For an empty list, or an unknown kind with the nearest.

    Examples
    --------
    >>> read_kinds("DXF, step,dxf")
    ('dxf', 'step')
    """
    names = text.split(",") if isinstance(text, str) else list(text)
    wanted = list(dict.fromkeys(name.strip().lower() for name in names if name.strip()))
    known = ", ".join(EXPORTERS)
    if not wanted:
        raise UsageError(f"no kind of file is named; the kinds are {known}.")
    for name in wanted:
        if name not in EXPORTERS:
            hint = did_you_mean(name, EXPORTERS) or "."
            raise UsageError(
                f"'{name}' is not a kind of file to export{hint} The kinds are {known}."
            )
    return tuple(wanted)


_WITHOUT_SOLIDS = {"dxf", "svg", "edm", "gcode", "mjcf", "urdf", "card", "bam"}


def stages(kinds: Iterable[str]) -> int:
    """How often `export` tells its progress: every kind, and the parts where one needs them."""
    return len(list(kinds)) + bool(set(kinds) - _WITHOUT_SOLIDS)


def default_folder(design: Design) -> Path:
    """Where `export` writes when no folder is named: ``exports/<design name>``."""
    return Path("exports") / design.name


def export(
    machine: Machine,
    kinds: str | Iterable[str],
    folder: Path | None = None,
    *,
    force: bool = False,
    progress: Progress | None = None,
    options: ExportOptions = DEFAULTS,
    specimen: Specimen = AS_DRAWN,
) -> tuple[WrittenFile, ...]:
    """Write the files of a machine.

    Parameters
    ----------
    machine : Machine
        Of the specimen's motor.
    kinds : str or iterable of str
        Keys of `EXPORTERS`, such as ``"dxf,step"``.
    folder : Path, optional
        Where to; made if missing. Left out, it is `default_folder`, whose files are this
        function's own and are replaced.
    force : bool
        Replace existing files in a named folder.
    progress : callable, optional
        Called with a few words before each kind of file.
    options : ExportOptions, optional
        How files are written.
    specimen : Specimen
        Which actuator simulators get.

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
    wanted, design = read_kinds(kinds), machine.given
    target = default_folder(design) if folder is None else folder
    tell = progress if progress is not None else _silent
    made = _missing(target)
    staging = target / f".{design.name}-{uuid.uuid4().hex[:8]}"
    placed: list[WrittenFile] = []
    try:
        ensure_folder(staging)
        job = ExportJob(machine, staging, tell, options, specimen)
        for kind in wanted:
            tell(f"writing {kind}")
            placed += [
                dataclasses.replace(one, path=target / one.path.relative_to(staging))
                for one in _writer(kind)(job)
            ]
        for one in placed:
            refuse_overwrite(one.path, force=force or folder is None)
        below = {one.path.parent for one in placed} - {target}
        made = [*dict.fromkeys(lost for path in sorted(below) for lost in _missing(path)), *made]
        for path in sorted(below):
            ensure_folder(path)
        for one in placed:
            _move(staging / one.path.relative_to(target), one.path)
        made = []
    except UsageError as error:
        # Writers know only the staging folder, readers of the message only the target.
        raise type(error)(str(error).replace(str(staging), str(target))) from error
    finally:
        shutil.rmtree(staging, ignore_errors=True)
        for empty in made:
            with contextlib.suppress(OSError):
                empty.rmdir()
    return tuple(placed)


def _silent(message: str) -> None:
    """Progress that nobody asked for."""


def _writer(kind: str) -> Callable[[ExportJob], tuple[WrittenFile, ...]]:
    module, _, function = EXPORTERS[kind].partition(":")
    writer: Callable[[ExportJob], tuple[WrittenFile, ...]] = getattr(
        importlib.import_module(module), function
    )
    return writer


def _missing(folder: Path) -> list[Path]:
    """Those of a folder and its parents that do not exist or cannot be seen, deepest first."""
    return [path for path in (folder, *folder.parents) if not os.path.exists(path)]


def _move(source: Path, target: Path) -> None:
    try:
        os.replace(source, target)
    except OSError as error:
        raise UsageError(
            f"cannot write {target}: {error.strerror or error}; choose another place with --out."
        ) from error
