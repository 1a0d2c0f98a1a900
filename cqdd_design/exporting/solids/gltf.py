"""Binary glTF 2.0, as every file of it needs: buffer, document, normals, material of a part."""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from cqdd_design.design import Design
    from cqdd_design.geometry.contours import FloatArray
    from cqdd_design.solids.part import Part

_COMPONENTS = {"<f4": 5126, "<u4": 5125, "<u2": 5123, "|i1": 5120}
_VERTICES, INDICES = 34962, 34963


class Buffer:
    """The one binary buffer of a file and the views into it, each from a multiple of 4 bytes on."""

    def __init__(self) -> None:
        self.content = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def add(self, array: np.ndarray, *, bounds: bool = False, normalized: bool = False) -> int:
        """Append vectors (v, 3), each padded to a multiple of 4 bytes, or indices (i,).

        Returns the number of their accessor, which tells their `bounds` if asked.
        """
        vectors = array.ndim == 2
        accessor: dict[str, Any] = {
            "bufferView": len(self.views),
            "componentType": _COMPONENTS[array.dtype.str],
            "count": len(array),
            "type": "VEC3" if vectors else "SCALAR",
        }
        if bounds:
            accessor["min"] = array.min(axis=0).tolist()
            accessor["max"] = array.max(axis=0).tolist()
        if normalized:
            accessor["normalized"] = True
        room = -array.itemsize * array.shape[-1] % 4 if vectors else 0
        if room:
            array = np.pad(array, ((0, 0), (0, room // array.itemsize)))
        content = array.tobytes()
        view: dict[str, Any] = {
            "buffer": 0,
            "byteOffset": len(self.content),
            "byteLength": len(content),
            "target": _VERTICES if vectors else INDICES,
        }
        if room:
            view["byteStride"] = array.itemsize * array.shape[1]
        self.views.append(view)
        self.accessors.append(accessor)
        self.content += content + b"\0" * (-len(content) % 4)
        return len(self.accessors) - 1


def scene(
    design: Design,
    nodes: Sequence[dict[str, Any]],
    meshes: Sequence[Mapping[str, Any]],
    materials: Sequence[Mapping[str, Any]],
    buffer: Buffer,
    *,
    generator: str = "",
    extensions: Sequence[str] = (),
) -> bytes:
    """The file of one scene: the first node, and all others below it.

    Parameters
    ----------
    design : Design
        Gives the scene its name, and its hash goes into the asset's ``extras``.
    nodes, meshes, materials : sequences
        Of glTF; materials are those of the meshes, in order.
    buffer : Buffer
        What the meshes point to.
    generator : str
        Left out where empty.
    extensions : sequence of str
        That a reader must know.
    """
    asset: dict[str, Any] = {"version": "2.0"}
    if generator:
        asset["generator"] = generator
    asset["extras"] = {"design_sha256": design.sha256}
    document: dict[str, Any] = {"asset": asset}
    if extensions:
        document |= {"extensionsUsed": extensions, "extensionsRequired": extensions}
    document |= {
        "scene": 0,
        "scenes": [{"name": design.file_name, "nodes": [0]}],
        "nodes": [nodes[0] | {"children": list(range(1, len(nodes)))}, *nodes[1:]],
        "meshes": meshes,
        "materials": materials,
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": len(buffer.content)}],
    }
    return container(document, bytes(buffer.content))


def vertex_normals(vertices: FloatArray, triangles: np.ndarray) -> FloatArray:
    """Unit normals (v, 3): the mean of the triangles at a vertex, weighted by their areas."""
    corners = vertices[triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros_like(vertices)
    for corner in range(3):
        np.add.at(normals, triangles[:, corner], across)
    return unit(normals)


def unit(vectors: FloatArray) -> FloatArray:
    """Vectors (v, 3) of length 1; any for one without length, so that a file stays legal."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.asarray(
        np.where(length > 0.0, vectors / np.where(length == 0.0, 1.0, length), (0.0, 0.0, 1.0))
    )


def container(document: Mapping[str, Any], binary: bytes) -> bytes:
    """The file of a document and its one buffer, each filled up to a multiple of 4 bytes."""
    text = json.dumps(document, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    total = 12 + 8 + len(text) + 8 + len(binary)
    return b"".join(
        [
            struct.pack("<4sII", b"glTF", 2, total),
            struct.pack("<I4s", len(text), b"JSON"),
            text,
            struct.pack("<I4s", len(binary), b"BIN\0"),
            binary,
        ]
    )


def material(part: Part, metalness: float, roughness: float) -> dict[str, Any]:
    """A part's material in its colour."""
    # glTF colours are linear; those of the parts are sRGB (IEC 61966-2-1).
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in part.colour]
    return {
        "name": part.material,
        "pbrMetallicRoughness": {
            "baseColorFactor": [*(round(value, 6) for value in linear), 1.0],
            "metallicFactor": metalness,
            "roughnessFactor": roughness,
        },
    }
