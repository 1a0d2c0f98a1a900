"""Visible lines of posed solids by the CAD kernel's exact hidden-line removal.

Edges where the surface bends are drawn, seams between faces that continue each other smoothly are
not. The kernel's curves come back as chains of short straight lines on the page, in mm.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from cqdd_design.geometry.contours import FloatArray
from cqdd_design.solids.cad import import_cadquery

if TYPE_CHECKING:
    from cadquery import Shape

_SAG = 0.02
"""Most distance of the straight lines from the curve, mm."""
_TURN = 0.2
"""Most turn from line to line, rad."""
_JOIN = 1e-3
"""Ends within this of each other are one, mm."""


@dataclass(frozen=True, eq=False)
class VisibleLines:
    """What can be seen of some solids.

    Attributes
    ----------
    edges : tuple of array (k, 2)
        Chains along sharp edges, mm on the page, y up.
    outlines : tuple of array (k, 2)
        Chains along which a curved surface turns away from the viewer.
    """

    edges: tuple[FloatArray, ...]
    outlines: tuple[FloatArray, ...]

    def moved(self, shift: FloatArray) -> VisibleLines:
        """The same lines elsewhere on the page; `shift` (2,) in mm."""
        return VisibleLines(
            tuple(line + shift for line in self.edges),
            tuple(line + shift for line in self.outlines),
        )


def visible_lines(shapes: Sequence[Shape], right: FloatArray, towards: FloatArray) -> VisibleLines:
    """Lines of posed shapes that nothing hides.

    Parameters
    ----------
    shapes : sequence of cadquery.Shape
        In mm, in the machine's frame.
    right, towards : array (3,)
        Unit vectors in the machine's frame: to the right on the page, and to the viewer.

    Raises
    ------
    DependencyError
        When CadQuery is not usable.
    """
    import_cadquery()
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
    from OCP.HLRAlgo import HLRAlgo_Projector
    from OCP.HLRBRep import HLRBRep_Algo, HLRBRep_HLRToShape, HLRBRep_TypeOfResultingEdge

    algorithm = HLRBRep_Algo()
    for shape in shapes:
        algorithm.Add(shape.wrapped)
    algorithm.Projector(
        HLRAlgo_Projector(gp_Ax2(gp_Pnt(), gp_Dir(*towards.tolist()), gp_Dir(*right.tolist())))
    )
    algorithm.Update()
    algorithm.Hide()
    found = HLRBRep_HLRToShape(algorithm)
    sharp = HLRBRep_TypeOfResultingEdge.HLRBRep_Sharp
    outline = HLRBRep_TypeOfResultingEdge.HLRBRep_OutLine
    edges, outlines = (
        chained(list(_polylines(found.CompoundOfEdges(kind, True, False))))
        for kind in (sharp, outline)
    )
    return VisibleLines(edges, outlines)


def _polylines(compound: Any) -> Iterator[FloatArray]:
    from OCP.BRepAdaptor import BRepAdaptor_Curve
    from OCP.BRepLib import BRepLib
    from OCP.GCPnts import GCPnts_TangentialDeflection
    from OCP.TopAbs import TopAbs_ShapeEnum
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopoDS import TopoDS

    if compound is None or compound.IsNull():
        return
    BRepLib.BuildCurves3d_s(compound)
    explorer = TopExp_Explorer(compound, TopAbs_ShapeEnum.TopAbs_EDGE)
    while explorer.More():
        curve = BRepAdaptor_Curve(TopoDS.Edge_s(explorer.Current()))
        samples = GCPnts_TangentialDeflection(curve, _TURN, _SAG)
        points = [samples.Value(i + 1) for i in range(samples.NbPoints())]
        explorer.Next()
        line = np.array([(point.X(), point.Y()) for point in points])
        if len(line) > 1 and float(np.abs(line - line[0]).max()) > _JOIN:
            yield line


def chained(lines: Sequence[FloatArray]) -> tuple[FloatArray, ...]:
    """Lines (k, 2) that meet end to end, joined; the answer does not depend on their order."""
    rest = {index: line for index, line in enumerate(sorted(map(_directed, lines), key=_sort_key))}
    ends: dict[tuple[int, int], list[int]] = {}
    for index, line in rest.items():
        for end in (line[0], line[-1]):
            ends.setdefault(_cell(end), []).append(index)
    chains = []
    while rest:
        chain = rest.pop(next(iter(rest)))
        for _ in range(2):
            while (grown := _grown(chain, rest, ends)) is not None:
                chain = grown
            chain = chain[::-1]
        chains.append(chain)
    return tuple(chains)


def _grown(
    chain: FloatArray, rest: dict[int, FloatArray], ends: dict[tuple[int, int], list[int]]
) -> FloatArray | None:
    """The chain with the next line at its end, which it takes from `rest`; None without one."""
    if len(chain) > 2 and _cell(chain[0]) == _cell(chain[-1]):
        return None
    for index in ends.get(_cell(chain[-1]), ()):
        line = rest.get(index)
        if line is None:
            continue
        del rest[index]
        if _cell(line[0]) != _cell(chain[-1]):
            line = line[::-1]
        return np.concatenate([chain, line[1:]])
    return None


def _cell(point: FloatArray) -> tuple[int, int]:
    return (round(float(point[0]) / _JOIN), round(float(point[1]) / _JOIN))


def _directed(line: FloatArray) -> FloatArray:
    return line if tuple(line[0]) <= tuple(line[-1]) else line[::-1]


def _sort_key(line: FloatArray) -> tuple[float, ...]:
    rounded = np.round(line, 4)
    middle = rounded[len(rounded) // 2]
    return (*map(float, rounded[0]), *map(float, rounded[-1]), *map(float, middle))
