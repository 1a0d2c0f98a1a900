"""Reading a DXF as plain group codes and values, not by the library that wrote it.

Contours come back as loops of arcs from any of the three ways this package writes them: light
polylines, the polylines with vertices of R12, and lines and arcs end to end.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.errors import ReadBackError
from cqdd_design.exporting.edm.loops import Loop
from cqdd_design.geometry.contours import Circle

if TYPE_CHECKING:
    from cqdd_design.exporting.options import ExportOptions

JOINED = 1e-9
"""Ends of lines and arcs this close are one joint, m: far inside what any control chains."""

_MM = 1e-3


@dataclass(frozen=True)
class Entity:
    """A graphic entity of a file: its type, and its group codes and values in order."""

    kind: str
    tags: tuple[tuple[int, str], ...]

    def numbers(self, code: int) -> list[float]:
        """Every value of a group code."""
        return [float(value) for key, value in self.tags if key == code]

    def first(self, code: int, default: str = "") -> str:
        """First value of a group code."""
        return next((value for key, value in self.tags if key == code), default)

    @property
    def ends(self) -> tuple[complex, complex]:
        """Ends of a LINE, m."""
        if self.kind != "LINE":
            raise ReadBackError(f"a stray {self.kind} is on layer {self.first(8)}.")
        (x0, y0), (x1, y1) = ([self.numbers(c)[0] for c in codes] for codes in ((10, 20), (11, 21)))
        return complex(x0, y0) * _MM, complex(x1, y1) * _MM


@dataclass(frozen=True)
class DxfContents:
    """What this package needs of a DXF: header variables and the entities of the model space."""

    header: dict[str, str]
    entities: tuple[Entity, ...]

    def on_layer(self, layer: str) -> list[Entity]:
        """Entities of one layer, in file order."""
        return [entity for entity in self.entities if entity.first(8) == layer]


def read_dxf(path: Path) -> DxfContents:
    """Read an ASCII DXF as group codes and values.

    Raises
    ------
    ReadBackError
        When it is not an ASCII DXF, or stops half-way.
    """
    lines = path.read_text(encoding="cp1252", errors="replace").splitlines()
    try:
        tags = [
            (int(code), value.strip()) for code, value in zip(lines[::2], lines[1::2], strict=True)
        ]
    except ValueError as error:
        raise ReadBackError(
            f"{path.name}: this is not an ASCII DXF, or only half of one."
        ) from error
    if not tags or tags[-1] != (0, "EOF"):
        raise ReadBackError(f"{path.name}: the DXF stops before its end.")
    header = {
        name: value for (code, name), (_, value) in pairwise(_section(tags, "HEADER")) if code == 9
    }
    drawn = _section(tags, "ENTITIES")
    starts = [index for index, (code, _) in enumerate(drawn) if code == 0]
    entities = tuple(
        Entity(drawn[begin][1], tuple(drawn[begin + 1 : end]))
        for begin, end in pairwise([*starts, len(drawn)])
    )
    return DxfContents(header, entities)


def _section(tags: list[tuple[int, str]], name: str) -> list[tuple[int, str]]:
    if (2, name) not in tags:
        return []
    begin = tags.index((2, name)) + 1
    return tags[begin : tags.index((0, "ENDSEC"), begin)]


def circles_of(contents: DxfContents, layer: str) -> list[Circle]:
    """Circles on a layer, m."""
    return [
        Circle(
            np.array([entity.numbers(10)[0], entity.numbers(20)[0]]) * _MM,
            entity.numbers(40)[0] * _MM,
        )
        for entity in contents.on_layer(layer)
        if entity.kind == "CIRCLE"
    ]


def loops_of(contents: DxfContents, layer: str, label: str, options: ExportOptions) -> list[Loop]:
    """Closed contours on a layer, circles apart, in the style they should have.

    Raises
    ------
    ReadBackError
        For a contour that is open, doubled in a joint or clockwise, and for a stray entity.
    """
    entities = [entity for entity in contents.on_layer(layer) if entity.kind != "CIRCLE"]
    if options.dxf_style == "entities":
        return _chained(entities, layer, label)
    loops: list[Loop] = []
    vertices: list[tuple[float, float, float]] | None = None
    for entity in entities:
        if entity.kind == "LWPOLYLINE":
            _refuse_open(entity, label)
            loops.append(_closed(_light_rows(entity), label))
        elif entity.kind == "POLYLINE" and vertices is None:
            _refuse_open(entity, label)
            vertices = []
        elif entity.kind == "VERTEX" and vertices is not None:
            x, y = entity.numbers(10)[0], entity.numbers(20)[0]
            vertices.append((x, y, float(entity.first(42, "0"))))
        elif entity.kind == "SEQEND" and vertices is not None:
            loops.append(_closed(vertices, label))
            vertices = None
        else:
            raise ReadBackError(f"{label}: a stray {entity.kind} is on layer {layer}.")
    if vertices is not None:
        raise ReadBackError(f"{label}: a polyline on layer {layer} does not end.")
    return loops


def _refuse_open(entity: Entity, label: str) -> None:
    if not int(entity.first(70, "0")) & 1:
        raise ReadBackError(f"{label}: a contour is not closed.")


def _light_rows(entity: Entity) -> list[tuple[float, float, float]]:
    """Vertices and bulges; a joint without a bulge of its own starts a line."""
    rows: list[list[float]] = []
    for code, value in entity.tags:
        if code == 10:
            rows.append([float(value), 0.0, 0.0])
        elif code in (20, 42) and rows:
            rows[-1][1 if code == 20 else 2] = float(value)
    return [(x, y, bulge) for x, y, bulge in rows]


def _closed(rows: Sequence[tuple[float, float, float]], label: str) -> Loop:
    x, y, bulges = np.array(rows).T
    joints = (x + 1j * y) * _MM
    return _checked(Loop(joints, np.roll(joints, -1), bulges), label)


def _checked(loop: Loop, label: str) -> Loop:
    if (loop.start == loop.end).any():
        raise ReadBackError(f"{label}: a contour has a joint twice in the same place.")
    if loop.area <= 0.0:
        raise ReadBackError(f"{label}: a contour runs clockwise.")
    return loop


_Segment = tuple[complex, complex, float]


def _segment(entity: Entity, layer: str, label: str) -> _Segment:
    """Start, end (m) and bulge of a line or arc as it stands in the file."""
    if entity.kind == "LINE":
        return (*entity.ends, 0.0)
    if entity.kind != "ARC":
        raise ReadBackError(f"{label}: a stray {entity.kind} is on layer {layer}.")
    centre = complex(entity.numbers(10)[0], entity.numbers(20)[0]) * _MM
    radius = entity.numbers(40)[0] * _MM
    start, end = (math.radians(entity.numbers(code)[0]) for code in (50, 51))
    sweep = (end - start) % (2.0 * math.pi)
    first, last = (centre + cmath.rect(radius, angle) for angle in (start, end))
    return first, last, math.tan(sweep / 4.0)


def _turned(segment: _Segment) -> _Segment:
    start, end, bulge = segment
    return end, start, -bulge


def _chained(entities: Sequence[Entity], layer: str, label: str) -> list[Loop]:
    """Chain lines and arcs in file order, each turned so that it goes on where the last ended."""
    loops: list[Loop] = []
    chain: list[_Segment] = []
    for entity in entities:
        segment = _segment(entity, layer, label)
        if not chain:
            chain = [segment]
            continue
        if len(chain) == 1 and min(abs(chain[0][1] - end) for end in segment[:2]) > JOINED:
            chain = [_turned(chain[0])]
        if abs(segment[0] - chain[-1][1]) > JOINED:
            segment = _turned(segment)
        if abs(segment[0] - chain[-1][1]) > JOINED:
            break
        chain.append(segment)
        if abs(chain[-1][1] - chain[0][0]) <= JOINED:
            start, end, bulge = (np.array(values) for values in zip(*chain, strict=True))
            loops.append(_checked(Loop(start, end, bulge), label))
            chain = []
    if chain:
        place = chain[-1][1] / _MM
        raise ReadBackError(
            f"{label}: a contour is not closed: a {entity.kind} on layer {layer} leaves a loose "
            f"end at ({place.real:.4f}, {place.imag:.4f}) mm."
        )
    return loops
