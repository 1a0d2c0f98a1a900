"""Closed triangle meshes of the solids, and mass properties from them.

Qualities: `FINE` for mass, inertia and interference, `DISPLAY` for files that are looked at or
printed, and that of the report's pictures. Every part is tessellated once for each and kept.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from cqdd_design.errors import GeometryError
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.results import MassProperties
from cqdd_design.solids.cad import MM
from cqdd_design.solids.part import Part

if TYPE_CHECKING:
    from trimesh import Trimesh

IntArray = NDArray[np.int64]

_INTERIOR = 16.0
"""How much farther than at its rims a face may be off within, where it is curved two ways."""
_JOIN = 1e-6
"""Vertices within this of each other are one, mm: far above rounding, far below a facet."""


@dataclass(frozen=True)
class Quality:
    """How closely facets follow the surface.

    Attributes
    ----------
    deflection : float
        Most distance of a facet from the surface, as a share of the part's outside radius.
    angle : float
        Most turn of the surface from facet to facet, rad.
    chords : bool
        Whether the smallest arcs are meshed as chords: of finer facets a torus would take
        thousands.
    """

    deflection: float
    angle: float
    chords: bool = True


# A polygon that stays within s of a circle of radius r misses 4 s/(3 r) of its area and twice that
# of its polar moment: 2.5e-5 of the outside radius costs 7e-5 there at most, and less in holes.
FINE = Quality(deflection=2.5e-5, angle=0.2)
DISPLAY = Quality(deflection=4e-4, angle=0.25)

_PICTURE_CHORD = 0.05
"""Most distance of a picture's facet from the surface, mm: a quarter of a pixel and less."""


def picture_quality(part: Part) -> Quality:
    """Of pictures of the whole machine, and of what turns in the browser."""
    chord = _PICTURE_CHORD / (part.shape.outside_radius * MM)
    return Quality(min(2e-3, chord), 0.38, chords=False)


@dataclass(frozen=True, eq=False)
class Facets:
    """Triangles of a solid, face by face: no two faces of the solid share a vertex.

    Attributes
    ----------
    vertices : array (v, 3)
        mm, in the part's frame.
    triangles : array (t, 3)
        Rows of `vertices`, counter-clockwise seen from outside.
    """

    vertices: FloatArray
    triangles: IntArray


class ClosedMesh(Facets):
    """A watertight mesh: every edge belongs to two triangles that run through it in turn.

    No two of its vertices are at the same place.
    """

    @property
    def volume(self) -> float:
        """Enclosed volume, mm^3."""
        a, b, c = (self.vertices[self.triangles[:, k]] for k in range(3))
        return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6.0


@lru_cache(maxsize=512)
def facets(part: Part, quality: Quality = FINE) -> Facets:
    """Facets of a part's solid; tessellated once a part and quality.

    Raises
    ------
    GeometryError
        When they do not enclose the volume of the solid without a gap.
    DependencyError
        When CadQuery is not usable.
    """
    slack = 10.0 * quality.deflection + 1e-5
    # The fast mesher leaves gaps on rare faces; the slow one then has its turn, and faces as they
    # were before the kernel merged them.
    for mesher, seamed in (("delabella", False), ("watson", False), ("delabella", True)):
        found = _facets(part, quality, mesher, seamed=seamed)
        joined = _joined(found)
        off = abs(joined.volume / (part.volume * MM**3) - 1.0)
        if _is_closed(joined.triangles) and off < slack:
            return found
    raise GeometryError(
        f"the mesh of {part.name} is not closed, or {off:.2g} off its volume; "
        "change a diameter or thickness of it slightly."
    )


@lru_cache(maxsize=512)
def closed_mesh(part: Part, quality: Quality = FINE) -> ClosedMesh:
    """The watertight mesh of a part in its own frame, in mm; errors as `facets`."""
    return _joined(facets(part, quality))


@lru_cache(maxsize=512)
def tessellate(part: Part, quality: Quality = FINE) -> Trimesh:
    """The watertight mesh of a part in its own frame, in mm; errors as `facets`.

    Returns
    -------
    trimesh.Trimesh
        Shared between callers: copy before changing it.
    """
    import trimesh

    mesh = closed_mesh(part, quality)
    result = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
    if not result.is_watertight:
        raise GeometryError(f"the mesh of {part.name} is not watertight.")
    return result


def _joined(found: Facets) -> ClosedMesh:
    """The facets with vertices at one place made one, and triangles without area left out."""
    keys = np.round(found.vertices / _JOIN).astype(np.int64)
    packed = np.ascontiguousarray(keys).view([("", np.int64)] * 3).ravel()
    _, first, inverse = np.unique(packed, return_index=True, return_inverse=True)
    triangles = inverse[found.triangles]
    a, b, c = triangles.T
    real = (a != b) & (b != c) & (c != a)
    return ClosedMesh(found.vertices[first], triangles[real])


def _is_closed(triangles: IntArray) -> bool:
    """Whether every directed edge occurs once and its reverse once."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    size = int(edges.max()) + 1
    forward = np.sort(edges[:, 0] * size + edges[:, 1])
    backward = np.sort(edges[:, 1] * size + edges[:, 0])
    return bool((np.diff(forward) > 0).all() and (forward == backward).all())


def _facets(part: Part, quality: Quality, mesher: str, *, seamed: bool) -> Facets:
    from OCP.BRep import BRep_Tool
    from OCP.TopLoc import TopLoc_Location

    # A copy, so that the facets of one quality never reach another or a STEP file.
    whole = part.faceted_solid if quality.chords else part.solid
    solid = (part.seamed_solid if seamed else whole).copy()
    _mesh_in_place(solid.wrapped, quality, mesher, part.shape.outside_radius * MM)
    vertices: list[tuple[float, float, float]] = []
    blocks: list[IntArray] = []
    for face in solid.Faces():
        net = BRep_Tool.Triangulation_s(face.wrapped, TopLoc_Location())
        if net is None:
            continue
        block = np.array(list(_triangles(net)), dtype=np.int64) + (len(vertices) - 1)
        if face.wrapped.Orientation().name == "TopAbs_REVERSED":
            block = block[:, ::-1]
        blocks.append(block)
        vertices.extend(_points(net))
    return Facets(np.array(vertices), np.concatenate(blocks))


def _points(net: Any) -> Iterator[tuple[float, float, float]]:
    for i in range(1, net.NbNodes() + 1):
        yield net.Node(i).Coord()


def _triangles(net: Any) -> Iterator[tuple[int, int, int]]:
    for i in range(1, net.NbTriangles() + 1):
        yield net.Triangle(i).Get()


def _mesh_in_place(shape: Any, quality: Quality, mesher: str, radius: float) -> None:
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.IMeshTools import IMeshTools_MeshAlgoType, IMeshTools_Parameters
    from OCP.Message import Message_ProgressRange

    settings = IMeshTools_Parameters()
    settings.Deflection = quality.deflection * radius
    settings.Angle = quality.angle
    # Cones get points within them that their rims do not need.
    settings.DeflectionInterior = _INTERIOR * settings.Deflection
    settings.AngleInterior = 2.0 * quality.angle
    settings.Relative = False
    settings.InParallel = False
    settings.MeshAlgo = (
        IMeshTools_MeshAlgoType.IMeshTools_MeshAlgoType_Delabella
        if mesher == "delabella"
        else IMeshTools_MeshAlgoType.IMeshTools_MeshAlgoType_Watson
    )
    BRepMesh_IncrementalMesh(shape, settings, Message_ProgressRange())


@lru_cache(maxsize=512)
def mass_properties(part: Part) -> MassProperties:
    """Mass, centre and inertia of one piece in the part's own frame, from its fine mesh.

    The density is that of the material; where a catalogue gives the mass, it is that mass over the
    volume of the envelope.
    """
    mesh = tessellate(part, FINE)
    scale = part.density / MM**3
    return MassProperties(
        float(mesh.volume) * scale,
        np.asarray(mesh.center_mass) / MM,
        np.asarray(mesh.moment_inertia) * scale / MM**2,
    )


def mesh_volume(part: Part) -> float:
    """Volume of one piece from its fine mesh, m^3."""
    return float(tessellate(part, FINE).volume) / MM**3


_ROUGHLY = 2.2
"""Of a deflection, what a mesh may lie off."""


def surface_slack(part: Part, quality: Quality = FINE) -> float:
    """How far the mesh of a part may lie off its surface, m.

    The kernel keeps to a deflection but roughly: beside the half grooves of ring and housing twice
    as much was met (2.1 times at a coarse deflection, 1.7 at one of a sixteenth).
    """
    return _ROUGHLY * quality.deflection * part.shape.outside_radius
