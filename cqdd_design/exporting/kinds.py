"""Kinds of files that `export` writes: one row a kind, and nothing else lists them.

Help, progress, and the page of the command line read this table.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal

from cqdd_design.errors import UsageError, did_you_mean

if TYPE_CHECKING:
    from cqdd_design.exporting.job import ExportJob
    from cqdd_design.files import WrittenFile

    Writer = Callable[[ExportJob], tuple[WrittenFile, ...]]


@dataclass(frozen=True)
class ExportKind:
    """A kind of file.

    Attributes
    ----------
    name : str
        As on the command line.
    writer : str
        ``chapter.module:function`` of this room, imported only when asked for; the function writes
        all files of the kind from an `ExportJob`.
    needs_solids : bool
        Whether it is made of the machine's solids.
    reader : {"makers", "simulators"}
        Whom it is for.
    title : str
        What is written, in a few words.
    """

    name: str
    writer: str
    needs_solids: bool
    reader: Literal["makers", "simulators"]
    title: str

    def load(self) -> Writer:
        """Import the function that writes it."""
        found: Writer = load_writer(self.writer)
        return found


def load_writer(place: str) -> Any:
    """Import a function by ``chapter.module:function`` of this room."""
    module, _, function = place.partition(":")
    return getattr(importlib.import_module(f"cqdd_design.exporting.{module}"), function)


_SOLID, _PLAIN = True, False
_ROWS = (
    ExportKind("dxf", "edm.dxf:export_dxf", _PLAIN, "makers", "contours of the flat parts"),
    ExportKind("edm", "sheets.edm_package:export_edm", _PLAIN, "makers", "package for wire EDM"),
    ExportKind("gcode", "edm.gcode:export_gcode", _PLAIN, "makers", "programs for wire EDM"),
    ExportKind("step", "solids.step:export_step", _SOLID, "makers", "the machine, and every part"),
    ExportKind("stl", "solids.meshes:export_stl", _SOLID, "makers", "a mesh of every part"),
    ExportKind("3mf", "solids.meshes:export_3mf", _SOLID, "makers", "meshes of the machine"),
    ExportKind("glb", "solids.meshes:export_glb", _SOLID, "makers", "the machine for viewers"),
    ExportKind("svg", "sheets.svg:export_svg", _PLAIN, "makers", "front views, true to scale"),
    ExportKind("bom", "solids.bom:export_bom", _SOLID, "makers", "bill of materials"),
    ExportKind("mjcf", "simulators.mjcf:export_mjcf", _PLAIN, "simulators", "model for MuJoCo"),
    ExportKind("urdf", "simulators.urdf:export_urdf", _PLAIN, "simulators", "robot of one joint"),
    ExportKind(
        "card", "simulators.actuator_card:export_card", _PLAIN, "simulators", "every parameter"
    ),
    ExportKind("bam", "simulators.bam:export_bam", _PLAIN, "simulators", "friction for BAM"),
)
KINDS: Mapping[str, ExportKind] = MappingProxyType({row.name: row for row in _ROWS})
"""Every kind by its name, in the order of help."""


def stages(kinds: Iterable[str]) -> int:
    """How often `export` tells its progress: once a kind, and once where parts are laid out.

    Examples
    --------
    >>> stages(["dxf", "gcode"]), stages(["dxf", "step", "stl"])
    (2, 4)
    """
    wanted = [KINDS[kind] for kind in kinds]
    return len(wanted) + any(kind.needs_solids for kind in wanted)


def read_kinds(text: str | Iterable[str], table: Mapping[str, object] = KINDS) -> tuple[str, ...]:
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
    known = ", ".join(table)
    if not wanted:
        raise UsageError(f"no kind of file is named; the kinds are {known}.")
    for name in wanted:
        if name not in table:
            hint = did_you_mean(name, table) or "."
            raise UsageError(
                f"'{name}' is not a kind of file to export{hint} The kinds are {known}."
            )
    return tuple(wanted)


def kinds_for(reader: str) -> str:
    """Names of the kinds for ``makers`` or ``simulators``, as help lists them."""
    return ", ".join(kind.name for kind in _ROWS if kind.reader == reader)
