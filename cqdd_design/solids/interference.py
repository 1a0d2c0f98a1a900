"""Whether two solids run into each other.

Two parts that touch along a fit overlap a little as meshes, because facets stand off the true
surface. A real collision is told from that by its thickness: every connected piece of an
intersection has the mean thickness 2 V/A, and only pieces thicker than the facets of both meshes
can explain are reported. Facets of a fit explain a tenth of what is allowed, as a rule; what is
thicker and still allowed is meshed anew, more finely: facets shrink, and a real overlap stays.
"""

from __future__ import annotations

import atexit
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.geometry.contours import FloatArray
from cqdd_design.solids.cad import MM
from cqdd_design.solids.features.removal import threads
from cqdd_design.solids.mesh import Quality, closed_mesh, surface_slack
from cqdd_design.solids.part import Part

if TYPE_CHECKING:
    from manifold3d import Manifold

_THREAD_SIDES = 48
_CLOSER = 4.0
"""How much finer a closer look is, and the share of what is allowed from which it is taken."""
_STAYS = 0.5
"""Least share of an overlap that finer facets leave, if it is real."""


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


@lru_cache(maxsize=512)
def _manifold(part: Part, quality: Quality) -> Manifold:
    """A part as screws find it: threads, which are drawn at their drill, cut to their diameter."""
    import manifold3d

    mesh = closed_mesh(part, quality)
    body = manifold3d.Manifold(
        manifold3d.Mesh64(
            np.ascontiguousarray(mesh.vertices, dtype=np.float64),
            np.ascontiguousarray(mesh.triangles, dtype=np.uint64),
        )
    )
    cut = []
    for thread in threads(part.features):
        # Corners of the prism lie outside the thread.
        radius = thread.radius * MM / math.cos(math.pi / _THREAD_SIDES)
        height = (thread.top - thread.bottom) * MM
        one = manifold3d.Manifold.cylinder(height, radius, circular_segments=_THREAD_SIDES)
        cut += [one.translate((x * MM, y * MM, thread.bottom * MM)) for x, y in thread.centres]
    return body - manifold3d.Manifold.batch_boolean(cut, manifold3d.OpType.Add) if cut else body


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


def closer_look(found: Overlap, pieces: Sequence[tuple[Part, FloatArray, Quality]]) -> Overlap:
    """An overlap by finer facets where it may be real and yet no thicker than facets explain.

    So an overlap is told from a fit down to a quarter of what the first meshes allow. Facets leave
    a third of theirs at most, where half has to stay.

    Parameters
    ----------
    pieces : sequence of (Part, array (4, 4), Quality)
        The two, where they stand, and the meshes that the overlap was found with.
    """
    if found.collides or found.thickness <= found.allowed / _CLOSER:
        return found
    finely = [
        (part, pose, replace(one, deflection=one.deflection / _CLOSER, angle=one.angle / 2.0))
        for part, pose, one in pieces
    ]
    first, second = (posed_manifold(*one) for one in finely)
    volume, thickness = overlap_of(first, second) or (0.0, 0.0)
    slack = sum(surface_slack(part, quality) for part, _, quality in finely)
    allowed = max(slack, _STAYS * found.thickness)
    return replace(found, volume=volume, thickness=thickness, allowed=allowed)
