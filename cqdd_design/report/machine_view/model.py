"""The machine for the interactive view: one binary glTF with everything that moves it.

Positions are steps of the part's own box (glTF extension KHR_mesh_quantization), normals
bytes, and all pieces of a part share one mesh, so that the file stays small enough to travel inside
the report. A node stands for a piece; its ``extras`` say what it is, what it moves with, and how
far it goes when the machine is taken apart. Lengths are in metres, z along the axis as in the
package: the report's viewer wants no other axis up.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from cqdd_design.design import Design
from cqdd_design.exporting.bill.substitutes import ordered
from cqdd_design.exporting.solids import gltf
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.report.machine_view.explode import take_apart
from cqdd_design.report.machine_view.stills import EXPLODED_TILT
from cqdd_design.solids.cad import MM
from cqdd_design.solids.mesh import Facets, facets, picture_quality
from cqdd_design.solids.part import Part
from cqdd_design.solids.stations import stations

_SMOOTH = np.cos(np.radians(28.0))
"""Facets that turn by less than this at a vertex share a normal there."""
_STEPS = 16383
"""Of the largest side of a part's box: 6 um in 100 mm, a tenth of a facet's distance."""
_NARROW = 65535
"""Most vertices that two bytes can count."""


@dataclass(frozen=True)
class ViewerData:
    """What the page needs for the interactive view.

    Attributes
    ----------
    glb : bytes
        Binary glTF 2.0.
    turns : int
        Turns of the crank in one turn of the carrier.
    """

    glb: bytes
    turns: int


def viewer_data(design: Design, parts: Sequence[Part]) -> ViewerData:
    """The machine at crank angle 0 with its law of motion; the same parts give the same bytes.

    Errors are those of `hidden_line_views`, and a GeometryError where a part's mesh is not closed.
    """
    found = stations(parts)
    _, moved = take_apart(found, EXPLODED_TILT)
    shifts = {
        piece.name: shift
        for station, shift in zip(found, moved, strict=True)
        for piece in station.pieces
    }
    buffer = gltf.Buffer()
    meshes, materials, boxes = [], [], []
    for index, part in enumerate(parts):
        primitive, box = _primitive(part, index, buffer)
        meshes.append({"name": part.name, "primitives": [primitive]})
        boxes.append(box)
        materials.append(gltf.material(part, *_finish(part)))
    nodes: list[dict[str, Any]] = [
        {
            "name": design.name,
            "extras": {
                "ratio": design.reducer.ratio,
                "eccentricity": design.reducer.eccentricity,
                "discCount": design.reducer.disc_count,
            },
        }
    ]
    for index, part in enumerate(parts):
        low, step = boxes[index]
        metalness, roughness = _finish(part)
        for piece in part.instances:
            extras: dict[str, Any] = {
                "part": part.name,
                "name": piece.name,
                "material": part.material,
                "designation": ordered(part.designation),
                "body": piece.body.kind,
                "explode": round(shifts[piece.name], 6),
                "placement": (np.round(piece.placement, 12) + 0.0).T.ravel().tolist(),
                "metalness": metalness,
                "roughness": roughness,
                # Bearings and what is bought stay without hatching when they are cut.
                "hatch": 0.0 if part.source == "buy" or part.inner_body else _hatch(parts),
                "slope": 1.0 if index % 2 == 0 else -1.0,
            }
            if piece.body.kind == "disc":
                extras["disc"] = piece.body.disc
            nodes.append(
                {
                    "name": piece.name,
                    "mesh": index,
                    "translation": low.tolist(),
                    "scale": [step, step, step],
                    "extras": extras,
                }
            )
    content = gltf.scene(
        design, nodes, meshes, materials, buffer, extensions=["KHR_mesh_quantization"]
    )
    return ViewerData(content, design.reducer.ratio)


def _hatch(parts: Sequence[Part]) -> float:
    """Distance of hatching lines, m: about fifty across the machine."""
    return round(max(part.shape.outside_radius for part in parts) / 25.0, 5)


def _finish(part: Part) -> tuple[float, float]:
    """Metalness and roughness: everything is metal, ground and bought pieces shine more."""
    if part.source == "buy" or part.inner_body is not None:
        return 0.6, 0.32
    return 0.35, 0.45


def _primitive(
    part: Part, material: int, buffer: gltf.Buffer
) -> tuple[dict[str, Any], tuple[FloatArray, float]]:
    """The mesh of a part; and the lowest corner (m) and the size of a step (m) of its box."""
    mesh = _in_order_of_use(facets(part, picture_quality(part)))
    vertices = mesh.vertices / MM
    low = vertices.min(axis=0)
    step = float((vertices.max(axis=0) - low).max()) / _STEPS
    steps = np.round((vertices - low) / step).astype("<u2")
    normals = np.round(127.0 * _normals(mesh.vertices, mesh.triangles)).astype("i1")
    triangles = mesh.triangles.ravel()
    primitive = {
        "attributes": {
            "POSITION": buffer.add(steps, bounds=True),
            "NORMAL": buffer.add(normals, normalized=True),
        },
        # As narrow as their number allows.
        "indices": buffer.add(triangles.astype("<u2" if triangles.max() < _NARROW else "<u4")),
        "material": material,
    }
    return primitive, (np.round(low, 12) + 0.0, step)


def _in_order_of_use(mesh: Facets) -> Facets:
    """The same mesh, its vertices in the order in which the triangles first use them."""
    corners = mesh.triangles.ravel()
    used, first = np.unique(corners, return_index=True)
    order = used[np.argsort(first)]
    place = np.zeros(len(mesh.vertices), dtype=mesh.triangles.dtype)
    place[order] = np.arange(len(order))
    return Facets(mesh.vertices[order], place[mesh.triangles])


def _normals(vertices: FloatArray, triangles: np.ndarray) -> FloatArray:
    """Unit normals (v, 3), the same on both sides of a smooth seam between faces."""
    own = gltf.vertex_normals(vertices, triangles)
    keys = np.round(vertices * 1e4).astype(np.int64)
    _, place = np.unique(keys, axis=0, return_inverse=True)
    order = np.argsort(place, axis=None, kind="stable")
    counts = np.bincount(place.ravel())
    starts = np.cumsum(counts) - counts
    joined = own.copy()
    for count in np.unique(counts[counts > 1]):
        rows = order[starts[counts == count][:, None] + np.arange(count)]
        met = own[rows]
        alike = met @ met.swapaxes(1, 2) > _SMOOTH
        joined[rows] = alike @ met
    return gltf.unit(joined)
