"""Whether solids run into each other anywhere in the motion.

Two parts that touch along a fit overlap a little as meshes, because facets stand off the true
surface. A real collision is told from that by its thickness: every connected piece of an
intersection has the mean thickness 2 V/A, and only pieces thicker than the facets of both meshes
can explain are reported.
"""

from __future__ import annotations

import atexit
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.design import Design
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.solids.cad import MM
from cqdd_design.solids.mesh import FINE, Quality, closed_mesh, surface_slack
from cqdd_design.solids.part import Instance, Part

if TYPE_CHECKING:
    from manifold3d import Manifold


@dataclass(frozen=True)
class Overlap:
    """Two pieces that share space at a crank angle.

    Attributes
    ----------
    first, second : str
        Names of the pieces.
    crank_angle : float
        rad.
    volume : float
        Of the whole intersection, m^3.
    thickness : float
        Mean thickness of its thickest connected piece, m.
    allowed : float
        What the facets of both meshes explain, m.
    """

    first: str
    second: str
    crank_angle: float
    volume: float
    thickness: float
    allowed: float

    @property
    def collides(self) -> bool:
        """Whether the overlap is more than facets of touching surfaces."""
        return self.thickness > self.allowed


def find_overlaps(
    design: Design,
    parts: Sequence[Part],
    crank_angles: Iterable[float],
    quality: Quality = FINE,
) -> tuple[Overlap, ...]:
    """Every overlap of two pieces at the given crank angles (rad), the thickest first.

    Parameters
    ----------
    design : Design
    parts : sequence of Part
        Of that design. Pieces on the same body are compared once.
    crank_angles : iterable of float
        rad. One turn of the output is ``ratio`` turns of the crank.
    quality : Quality
        Of the meshes: `FINE` sees collisions of a few micrometres, `DISPLAY` of a few hundredths
        of a millimetre, several times faster.

    Returns
    -------
    tuple of Overlap
        Facet overlaps of touching parts included; ask `Overlap.collides`, or use `collisions`.
    """
    pieces = [(part, piece) for part in parts for piece in part.instances]
    found: list[Overlap] = []
    still_done = False
    for angle in crank_angles:
        posed = [posed_manifold(part, piece.pose(design, angle), quality) for part, piece in pieces]
        boxes = np.array([solid.bounding_box() for solid in posed])
        for i, j in combinations(range(len(pieces)), 2):
            (part, piece), (other_part, other) = pieces[i], pieces[j]
            if still_done and piece.body == other.body:
                continue
            if not boxes_meet(boxes[i], boxes[j]):
                continue
            overlap = overlap_of(posed[i], posed[j])
            if overlap is not None:
                allowed = surface_slack(part, quality) + surface_slack(other_part, quality)
                found.append(Overlap(piece.name, other.name, angle, *overlap, allowed))
        still_done = True
    return tuple(sorted(found, key=lambda one: -one.thickness / one.allowed))


def collisions(
    design: Design,
    parts: Sequence[Part],
    crank_angles: Iterable[float],
    quality: Quality = FINE,
) -> tuple[Overlap, ...]:
    """The overlaps that are real: parts that run into each other, the worst first."""
    found = find_overlaps(design, parts, crank_angles, quality)
    return tuple(overlap for overlap in found if overlap.collides)


def shared_volume(
    design: Design,
    first: tuple[Part, Instance],
    second: tuple[Part, Instance],
    crank_angle: float,
) -> float:
    """Volume (m^3) of the intersection of two pieces at a crank angle (rad)."""
    solids = [
        posed_manifold(part, piece.pose(design, crank_angle), FINE)
        for part, piece in (first, second)
    ]
    return float((solids[0] ^ solids[1]).volume()) / MM**3


@lru_cache(maxsize=512)
def _manifold(part: Part, quality: Quality) -> Manifold:
    import manifold3d

    mesh = closed_mesh(part, quality)
    return manifold3d.Manifold(
        manifold3d.Mesh64(
            np.ascontiguousarray(mesh.vertices, dtype=np.float64),
            np.ascontiguousarray(mesh.triangles, dtype=np.uint64),
        )
    )


# Meshes that outlive the interpreter's modules would be reported as leaks.
atexit.register(_manifold.cache_clear)


def posed_manifold(part: Part, pose: FloatArray, quality: Quality) -> Manifold:
    """The mesh of a part at a pose (4, 4), in mm."""
    placed = np.array(pose[:3], dtype=float)
    placed[:, 3] *= MM
    return _manifold(part, quality).transform(placed)


def boxes_meet(one: FloatArray, other: FloatArray) -> bool:
    """Whether two boxes (6,), lowest corner first, share a point."""
    return bool((one[:3] <= other[3:]).all() and (other[:3] <= one[3:]).all())


def overlap_of(one: Manifold, other: Manifold) -> tuple[float, float] | None:
    """Volume (m^3) of an intersection and mean thickness (m) of its thickest piece."""
    common = one ^ other
    if common.is_empty():
        return None
    thickness = max(
        2.0 * piece.volume() / piece.surface_area()
        for piece in common.decompose()
        if piece.surface_area() > 0.0
    )
    return float(common.volume()) / MM**3, float(thickness) / MM
