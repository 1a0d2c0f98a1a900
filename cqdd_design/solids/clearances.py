"""Clearances through one revolution of the output: who comes near whom, and who must not touch.

Every pair of pieces on different bodies is measured at each crank angle, mesh to mesh. Bearings
touch what they carry; those pairs are the *seats*. All others must keep clear, and are listed with
the least gap and where it occurs. Meshes follow the surfaces within the facets' slack, which is
given beside each gap.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from cqdd_design.design import Design
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.solids.cad import MM
from cqdd_design.solids.interference import (
    Overlap,
    boxes_meet,
    closer_look,
    overlap_of,
    posed_manifold,
)
from cqdd_design.solids.mesh import FINE, Quality, surface_slack
from cqdd_design.solids.part import Instance, Part

SEARCH = 1e-3
"""Gaps up to this are measured, m."""

ANGLES = 72
"""Crank angles over one revolution of the output, unless asked for otherwise."""

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Clearance:
    """Least gap of two parts over the motion.

    Attributes
    ----------
    first, second : str
        Names of the parts.
    gap : float
        m.
    crank_angle : float
        Where, rad.
    slack : float
        By how much the facets of both can be wrong, m.
    """

    first: str
    second: str
    gap: float
    crank_angle: float
    slack: float

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form."""
        return {
            "first": self.first,
            "second": self.second,
            "gap_um": self.gap * 1e6,
            "crank_angle_deg": math.degrees(self.crank_angle),
            "mesh_slack_um": self.slack * 1e6,
        }


@dataclass(frozen=True)
class AssemblyMotion:
    """What a revolution of the output shows.

    Attributes
    ----------
    angles : int
        Crank angles looked at.
    pairs : int
        Pairs of pieces compared, over all angles.
    collisions : tuple of Overlap
        Parts that run into each other, the worst first; none in a sound machine.
    clearances : tuple of Clearance
        Of parts on different bodies that come within `SEARCH`, the nearest first.
    seats : tuple of (str, str)
        Parts on different bodies that touch: bearings on what they carry.
    """

    angles: int
    pairs: int
    collisions: tuple[Overlap, ...]
    clearances: tuple[Clearance, ...]
    seats: tuple[tuple[str, str], ...]

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form (``results.assembly`` of ``check``)."""
        return {
            "crank_angles": self.angles,
            "pairs_compared": self.pairs,
            "collisions": [
                {
                    "first": one.first,
                    "second": one.second,
                    "crank_angle_deg": math.degrees(one.crank_angle),
                    "volume_mm3": one.volume * MM**3,
                    "thickness_um": one.thickness * 1e6,
                    "explained_by_facets_um": one.allowed * 1e6,
                }
                for one in self.collisions
            ],
            "clearances": [one.to_dict() for one in self.clearances],
            "seats": [list(pair) for pair in self.seats],
        }


def output_revolution(design: Design, count: int = ANGLES) -> FloatArray:
    """Crank angles (count,) evenly over one revolution of the output, n turns of the crank, rad.

    They start off a symmetric position and, as `count` shares no factor with n or n + 1 but by
    chance, meet the teeth in many phases.
    """
    turns = 2.0 * math.pi * design.reducer.ratio
    return np.asarray(turns * (np.arange(count) + 0.37) / count)


def assembly_motion(
    design: Design,
    parts: Sequence[Part],
    crank_angles: FloatArray | None = None,
    quality: Quality = FINE,
    progress: Progress | None = None,
) -> AssemblyMotion:
    """Compare every pair of pieces through the motion.

    Parameters
    ----------
    parts : sequence of Part
        From `build_parts`.
    crank_angles : array (A,), optional
        rad; default `output_revolution`. Pieces on one body are compared at the first only.
    quality : Quality
        Of the meshes.
    progress : callable, optional
        Told how many angles of how many are done.
    """
    angles = output_revolution(design) if crank_angles is None else np.asarray(crank_angles)
    pieces = [(part, piece) for part in parts for piece in part.instances]
    collisions: list[Overlap] = []
    nearest: dict[tuple[str, str], Clearance] = {}
    pairs = 0
    for number, angle in enumerate(angles.tolist()):
        poses = [piece.pose(design, angle) for _, piece in pieces]
        posed = [
            posed_manifold(part, pose, quality)
            for (part, _), pose in zip(pieces, poses, strict=True)
        ]
        boxes = np.array([solid.bounding_box() for solid in posed])
        near = boxes.copy()
        near[:, :3] -= SEARCH * MM
        near[:, 3:] += SEARCH * MM
        for i, j in combinations(range(len(pieces)), 2):
            one, other = pieces[i], pieces[j]
            still = one[1].body == other[1].body
            if (still and number > 0) or not boxes_meet(near[i], boxes[j]):
                continue
            pairs += 1
            slack = surface_slack(one[0], quality) + surface_slack(other[0], quality)
            overlap = overlap_of(posed[i], posed[j]) if boxes_meet(boxes[i], boxes[j]) else None
            if overlap is not None:
                found = closer_look(
                    Overlap(one[1].name, other[1].name, angle, *overlap, slack),
                    [(one[0], poses[i], quality), (other[0], poses[j], quality)],
                )
                if found.collides:
                    collisions.append(found)
            if not still:
                gap = 0.0 if overlap else posed[i].min_gap(posed[j], SEARCH * MM) / MM
                _keep(nearest, one, other, gap, angle, slack)
        if progress is not None:
            progress(number + 1, len(angles))
    every = sorted(nearest.values(), key=lambda one: one.gap)
    seats = [one for one in every if one.gap <= one.slack and _is_seat(parts, one)]
    return AssemblyMotion(
        angles=len(angles),
        pairs=pairs,
        collisions=tuple(sorted(collisions, key=lambda one: -one.thickness / one.allowed)),
        clearances=tuple(one for one in every if one not in seats and one.gap < 0.999 * SEARCH),
        seats=tuple((one.first, one.second) for one in seats),
    )


def _keep(
    nearest: dict[tuple[str, str], Clearance],
    one: tuple[Part, Instance],
    other: tuple[Part, Instance],
    gap: float,
    angle: float,
    slack: float,
) -> None:
    key = (one[0].name, other[0].name)
    if key not in nearest or gap < nearest[key].gap:
        nearest[key] = Clearance(*key, gap, angle, slack)


def _is_seat(parts: Sequence[Part], one: Clearance) -> bool:
    """Whether one of the two is a bearing, which turns on what it touches."""
    bearings = {part.name for part in parts if part.inner_body is not None}
    return one.first in bearings or one.second in bearings
