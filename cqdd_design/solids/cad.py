"""The door to CadQuery: from stacks in metres to solids in millimetres.

CadQuery is imported only here, in `assembly` and in the exporters, inside functions, so that
commands without CAD neither pay for it nor need its system libraries.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from cqdd_design.environment import missing_dependency
from cqdd_design.errors import GeometryError
from cqdd_design.geometry.contours import ArcContour, Circle, Contour, FloatArray, PlanarPart
from cqdd_design.solids.features.revolved import Revolved
from cqdd_design.solids.layers import Layer, Stack

if TYPE_CHECKING:
    from cadquery import Face, Location, Shape, Solid, Wire

MM = 1e3
"""Millimetres in a metre: the solids' unit."""
_VOLUME_TOLERANCE = 1e-6
_AREA_TOLERANCE = 1e-6
_DECIMALS = 10
"""Of coordinates in mm: a tenth of a picometre."""
_DIGITS = 15
"""Of direction cosines."""


def import_cadquery() -> Any:
    """The cadquery module, or a sentence on what to install.

    Raises
    ------
    DependencyError
        When the package or one of its system libraries is missing.
    """
    try:
        import cadquery
    except ImportError as error:
        missing = missing_dependency(error)
        if missing is None:
            raise
        raise missing from error
    return cadquery


def build_solid(
    name: str, shape: Stack, cuts: Sequence[Revolved] = (), *, merged: bool = True
) -> Solid:
    """The solid of a stack of layers without what is turned or drilled off it, in mm.

    Every layer is a prism over a face whose edges are the very lines and arcs of its contours;
    layers are fused and faces that continue each other are merged where the kernel can. Bodies of
    revolution are then cut away, with true cones and tori. Where they are not to be `merged`, faces
    keep the seams between layers.

    Raises
    ------
    DependencyError
        When CadQuery is not usable.
    GeometryError
        When the kernel's answer is not one valid solid with the closed-form volume.
    """
    cadquery = import_cadquery()
    fused = _fused([_prism(layer) for layer in shape.layers])
    tools = [tool for cut in cuts for tool in _revolved(cut)]
    exact = (shape.volume - math.fsum(cut.volume for cut in cuts)) * MM**3
    # Merging faces now and then loses some; the solid with its seams is sound then.
    tries: list[Shape] = [_merged(fused), fused] if merged else [fused]
    for whole in tries:
        found = _without(whole, tools) if tools else whole
        solids = found.Solids()
        sound = len(solids) == 1 and solids[0].isValid()
        if sound and math.isclose(solids[0].Volume(), exact, rel_tol=_VOLUME_TOLERANCE):
            break
    else:
        raise GeometryError(
            f"the CAD kernel could not build {name}: {len(solids)} solids of "
            f"{sum(s.Volume() for s in solids):.6g} mm3 instead of one valid solid of "
            f"{exact:.6g} mm3; change a diameter or thickness of it slightly."
        )
    solid: Solid = cadquery.Solid(solids[0].wrapped)
    return solid


def _fused(solids: Sequence[Solid]) -> Shape:
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Fuse

    first, *rest = solids
    return _combined(BRepAlgoAPI_Fuse(), first, rest) if rest else first


def _without(whole: Shape, tools: Sequence[Shape]) -> Shape:
    """What some bodies leave of another."""
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut

    return _combined(BRepAlgoAPI_Cut(), whole, tools)


def within(whole: Shape, tool: Shape) -> Shape:
    """What of a body lies in another."""
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Common

    return _combined(BRepAlgoAPI_Common(), whole, [tool])


def _combined(operation: Any, whole: Shape, tools: Sequence[Shape]) -> Shape:
    """CadQuery's own operations on one core, and without the history that nobody reads.

    The kernel's threads take a third more of the processor than one alone for bodies as small as
    these.
    """
    cadquery = import_cadquery()
    from OCP.TopTools import TopTools_ListOfShape

    pieces = list(whole) if isinstance(whole, cadquery.Compound) else [whole]
    for give, shapes in ((operation.SetArguments, pieces), (operation.SetTools, tools)):
        listed = TopTools_ListOfShape()
        for shape in shapes:
            listed.Append(shape.wrapped)
        give(listed)
    operation.SetToFillHistory(False)
    operation.SetRunParallel(False)
    operation.Build()
    found: Shape = cadquery.Shape.cast(operation.Shape())
    return found


def _merged(fused: Shape) -> Shape:
    """A solid with faces that continue each other as one, or as it was where that spoils a face.

    Merging moves no surface. On a bore with grooves all round it the kernel once lost the grooves'
    mouths: a face as large as the whole bore, which later cuts leave valid and no mesher closes.
    """
    found: Shape = fused.clean()
    areas = [math.fsum(face.Area() for face in one.Faces()) for one in (fused, found)]
    return found if math.isclose(*areas, rel_tol=_AREA_TOLERANCE) else fused


def _prism(layer: Layer) -> Solid:
    cadquery = import_cadquery()
    face = planar_face(layer.shape, layer.bottom)
    solid: Solid = cadquery.Solid.extrudeLinear(face, cadquery.Vector(0.0, 0.0, layer.height * MM))
    return solid


def _revolved(cut: Revolved) -> Iterator[Solid]:
    """The bodies of a cut, each about its own axis."""
    cadquery = import_cadquery()
    points = np.array(cut.outline)
    bulges = np.array(cut.bulges) if cut.bulges else np.zeros(len(points))
    halfway = ArcContour(points, bulges).evaluate([0.5])[0][:, 0]
    for x, y in cut.centres:
        wire = _joined_wire(_beside(x, y, points), _beside(x, y, halfway), bulges)
        foot = _rounded(np.array([x, y]))
        axis = [cadquery.Vector(*foot, z) for z in (0.0, 1.0)]
        yield cadquery.Solid.revolve(wire, [], 360.0, *axis)


def _beside(x: float, y: float, flat: FloatArray) -> FloatArray:
    """Points (r, z) beside an upright axis, as (x + r, y, z) in mm."""
    return _rounded(np.column_stack([x + flat[:, 0], np.full(len(flat), y), flat[:, 1]]))


def planar_face(shape: PlanarPart, height: float = 0.0) -> Face:
    """A flat part as a CadQuery face in mm at a height (m)."""
    cadquery = import_cadquery()
    face: Face = cadquery.Face.makeFromWires(
        contour_wire(shape.outer, height), [contour_wire(hole, height) for hole in shape.holes]
    )
    return face


def contour_wire(contour: Contour, height: float = 0.0) -> Wire:
    """A contour as a closed CadQuery wire of lines and circular arcs, in mm at a height (m)."""
    cadquery = import_cadquery()
    z = height * MM
    if isinstance(contour, Circle):
        x, y = (float(v) for v in _rounded(contour.centre))
        wire: Wire = cadquery.Wire.makeCircle(
            contour.radius * MM, cadquery.Vector(x, y, z), cadquery.Vector(0.0, 0.0, 1.0)
        )
        return wire
    return _arc_wire(contour, z)


def _arc_wire(contour: ArcContour, z: float) -> Wire:
    flat = [_rounded(contour.points), _rounded(contour.evaluate([0.5])[0][:, 0])]
    corners, halfway = (np.column_stack([one, np.full(len(one), z)]) for one in flat)
    return _joined_wire(corners, halfway, contour.bulges)


def _joined_wire(points: FloatArray, halfway: FloatArray, bulges: FloatArray) -> Wire:
    """Edges between shared vertices: the kernel would merge separate ones by chance of memory.

    Parameters
    ----------
    points, halfway : array (k, 3)
        Corners, and the middles of the segments from them, mm.
    """
    cadquery = import_cadquery()
    from OCP.BRepBuilderAPI import (
        BRepBuilderAPI_MakeEdge,
        BRepBuilderAPI_MakeVertex,
        BRepBuilderAPI_MakeWire,
    )
    from OCP.GC import GC_MakeArcOfCircle, GC_MakeSegment
    from OCP.gp import gp_Pnt

    joints = [gp_Pnt(*point) for point in points.tolist()]
    middles = [gp_Pnt(*point) for point in halfway.tolist()]
    vertices = [BRepBuilderAPI_MakeVertex(joint).Vertex() for joint in joints]
    maker = BRepBuilderAPI_MakeWire()
    for i, bulge in enumerate(bulges):
        j = (i + 1) % len(joints)
        if bulge == 0.0:
            curve = GC_MakeSegment(joints[i], joints[j]).Value()
        else:
            curve = GC_MakeArcOfCircle(joints[i], middles[i], joints[j]).Value()
        maker.Add(BRepBuilderAPI_MakeEdge(curve, vertices[i], vertices[j]).Edge())
    wire: Wire = cadquery.Wire(maker.Wire())
    return wire


def _rounded(points: FloatArray) -> FloatArray:
    """Points in mm without the last digits, which differ from one process to the next."""
    # Adding zero turns -0.0 into 0.0.
    return np.round(points * MM, _DECIMALS) + 0.0


def location(pose: FloatArray) -> Location:
    """A transform (4, 4) in metres as a CadQuery location in mm."""
    cadquery = import_cadquery()
    from OCP.gp import gp_Trsf

    trsf = gp_Trsf()
    rows = np.round(pose[:3], _DIGITS)
    rows[:, 3] = _rounded(pose[:3, 3])
    trsf.SetValues(*(float(v) for v in rows.ravel()))
    result: Location = cadquery.Location(trsf)
    return result
