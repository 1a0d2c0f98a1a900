"""Kinds of files that `export` writes: one row a kind, and nothing else lists them.

Help, progress, and the page of the command line read this table.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal

from cqdd_design.errors import UsageError, did_you_mean

if TYPE_CHECKING:
    from cqdd_design.machine import Machine


@dataclass(frozen=True)
class Kind:
    """A kind of file.

    Attributes
    ----------
    name : str
        As on the command line.
    writer : str
        ``chapter.module:function`` of this room; the function writes all files of the kind.
    title : str
        What is written, in a few words.
    """

    name: str
    writer: str
    title: str

    def load(self) -> Any:
        """Import the function that writes it, which nothing does before it is asked for."""
        return _function(self.writer)


@dataclass(frozen=True)
class ExportKind(Kind):
    """A kind of file of a design, written from an `ExportJob`.

    Attributes
    ----------
    needs_solids : bool
        Whether it is made of the machine's solids.
    reader : {"makers", "simulators"}
        Whom it is for.
    refusal : str
        As `writer`: the function raises for machines that have no such files, before any file of
        any kind is written; empty where every machine has some.
    """

    needs_solids: bool
    reader: Literal["makers", "simulators"]
    refusal: str = ""

    def refuse(self, machine: Machine) -> None:
        """Raise the DesignError of a machine that has no such files."""
        if self.refusal:
            _function(self.refusal)(machine)


def _function(name: str) -> Any:
    module, _, function = name.partition(":")
    return getattr(importlib.import_module(f"cqdd_design.exporting.{module}"), function)


_SOLID, _PLAIN = True, False
_ROWS = (
    ExportKind("dxf", "edm.dxf:export_dxf", "contours of the flat parts", _PLAIN, "makers"),
    ExportKind("edm", "sheets.edm_package:export_edm", "package for wire EDM", _PLAIN, "makers"),
    ExportKind("gcode", "edm.gcode:export_gcode", "programs for wire EDM", _PLAIN, "makers"),
    ExportKind("step", "solids.step:export_step", "the machine, and every part", _SOLID, "makers"),
    ExportKind("stl", "solids.meshes:export_stl", "a mesh of every part", _SOLID, "makers"),
    ExportKind("3mf", "solids.meshes:export_3mf", "meshes of the machine", _SOLID, "makers"),
    ExportKind("glb", "solids.meshes:export_glb", "the machine for viewers", _SOLID, "makers"),
    ExportKind("svg", "sheets.svg:export_svg", "front views, true to scale", _PLAIN, "makers"),
    ExportKind(
        "sheets", "sheets.sheet_files:export_sheets", "a drawing of every part", _SOLID, "makers"
    ),
    ExportKind(
        "print",
        "printing.package:export_print",
        "printed parts, and a coupon",
        _SOLID,
        "makers",
        refusal="printing.package:refuse_metal",
    ),
    ExportKind("bom", "solids.bom:export_bom", "bill of materials", _SOLID, "makers"),
    ExportKind("mjcf", "simulators.mjcf:export_mjcf", "model for MuJoCo", _PLAIN, "simulators"),
    ExportKind("urdf", "simulators.urdf:export_urdf", "robot of one joint", _PLAIN, "simulators"),
    ExportKind(
        "card",
        "simulators.actuator_card:export_card",
        "every parameter and its origin",
        _PLAIN,
        "simulators",
    ),
    ExportKind(
        "bam",
        "simulators.bam:export_bam",
        "friction in the names of Rhoban's BAM",
        _PLAIN,
        "simulators",
    ),
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
