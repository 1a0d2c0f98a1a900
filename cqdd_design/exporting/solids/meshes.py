"""Mesh files: STL a part, 3MF and GLB of the machine, all from one tessellation.

Written here rather than by a library, because names, units, colours and reproducible bytes are
the point: 3MF gets millimetres and material colours, GLB metres, the Y axis up and smooth normals
within every face of the solids.
"""

from __future__ import annotations

import io
import struct
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import escape, quoteattr

import numpy as np

from cqdd_design.exporting.solids import gltf
from cqdd_design.files import WrittenFile, file_label, write_atomically
from cqdd_design.version import __version__

if TYPE_CHECKING:
    from cqdd_design.design import Design
    from cqdd_design.exporting.job import ExportJob
    from cqdd_design.geometry.contours import FloatArray
    from cqdd_design.solids.part import Colour, Part

_GENERATOR = f"cqdd-design {__version__}"
_ZIP_TIME = (1980, 1, 1, 0, 0, 0)
"""The earliest time a zip can hold: the same design gives the same bytes."""
_STL_TRIANGLE = np.dtype(
    [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")], align=False
)

_CONTENT_TYPES = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
    '<Default Extension="rels" '
    'ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    '<Default Extension="model" '
    'ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>\n'
)
_RELATIONS = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    '<Relationship Target="/3D/3dmodel.model" Id="rel0" '
    'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>\n'
)

_QUARTER_TURN = 0.7071067811865476
_FINISH = (0.4, 0.5)
"""Metalness and roughness of every part."""


def export_stl(job: ExportJob) -> tuple[WrittenFile, ...]:
    """Write ``<name>-<part>.stl`` for every part, in its own frame."""
    return tuple(write_stl(part, job.path(f"-{file_label(part.name)}.stl")) for part in job.parts)


def export_3mf(job: ExportJob) -> tuple[WrittenFile, ...]:
    """Write ``<name>.3mf``."""
    return (write_3mf(job.design, job.parts, job.path(".3mf")),)


def export_glb(job: ExportJob) -> tuple[WrittenFile, ...]:
    """Write ``<name>.glb``."""
    return (write_glb(job.design, job.parts, job.path(".glb")),)


def write_stl(part: Part, path: Path) -> WrittenFile:
    """Write one part as binary STL in mm, in its own frame.

    Raises
    ------
    GeometryError
        When its mesh is not watertight.
    DependencyError
        When CadQuery is not usable.
    """
    from cqdd_design.solids.mesh import DISPLAY, closed_mesh

    mesh = closed_mesh(part, DISPLAY)
    corners = mesh.vertices[mesh.triangles]
    records = np.zeros(len(corners), dtype=_STL_TRIANGLE)
    records["corners"] = corners
    records["normal"] = gltf.unit(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    )
    # A header that began with "solid" would be taken for the text form.
    header = f"{_GENERATOR}: {part.name}, millimetres".encode("ascii", "replace")[:80].ljust(80)
    content = header + struct.pack("<I", len(records)) + records.tobytes()
    return write_atomically(path, content, "stl")


def write_3mf(design: Design, parts: Sequence[Part], path: Path) -> WrittenFile:
    """Write the machine at crank angle 0 as 3MF in mm.

    Every part is one object with name, material and colour; every piece is a build item whose
    ``partnumber`` is its name. Errors as `write_stl`.
    """
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED, compresslevel=6) as archive:
        for name, text in (
            ("[Content_Types].xml", _CONTENT_TYPES),
            ("_rels/.rels", _RELATIONS),
            ("3D/3dmodel.model", _model_xml(design, parts)),
        ):
            entry = zipfile.ZipInfo(name, _ZIP_TIME)
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, text.encode())
    return write_atomically(path, stream.getvalue(), "3mf")


def _model_xml(design: Design, parts: Sequence[Part]) -> str:
    materials = "".join(
        f"<base name={quoteattr(part.material)} displaycolor={quoteattr(_hex(part.colour))}/>"
        for part in parts
    )
    objects, items = [], []
    corner = _lowest_corner(design, parts)
    for index, part in enumerate(parts):
        # Resource 1 is the list of materials.
        number = index + 2
        objects.append(_object_xml(part, number, index))
        for piece in part.instances:
            pose = piece.pose(design)
            rows = [*pose[:3, :3].T.ravel(), *(pose[:3, 3] * 1e3 - corner)]
            numbers = " ".join(_number(value) for value in rows)
            items.append(
                f'<item objectid="{number}" transform="{numbers}" '
                f"partnumber={quoteattr(piece.name)}/>"
            )
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<model unit="millimeter" xml:lang="en-US" '
        'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">\n'
        f'<metadata name="Title">{escape(design.file_name)}</metadata>\n'
        f'<metadata name="Application">{_GENERATOR}</metadata>\n'
        f'<metadata name="Description">design sha256 {design.sha256}</metadata>\n'
        f'<resources>\n<basematerials id="1">{materials}</basematerials>\n'
        + "".join(objects)
        + "</resources>\n<build>\n"
        + "\n".join(items)
        + "\n</build>\n</model>\n"
    )


def _object_xml(part: Part, number: int, material: int) -> str:
    from cqdd_design.solids.mesh import DISPLAY, closed_mesh

    mesh = closed_mesh(part, DISPLAY)
    vertices = "".join(
        f'<vertex x="{x:.6f}" y="{y:.6f}" z="{z:.6f}"/>'
        for x, y, z in (mesh.vertices + 0.0).tolist()
    )
    triangles = "".join(
        f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in mesh.triangles.tolist()
    )
    return (
        f'<object id="{number}" name={quoteattr(part.name)} type="model" '
        f'partnumber={quoteattr(part.designation)} pid="1" pindex="{material}">'
        f"<mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh>"
        "</object>\n"
    )


def _lowest_corner(design: Design, parts: Sequence[Part]) -> FloatArray:
    """Least coordinates (3,) of the machine, mm: 3MF wants everything in the positive octant."""
    from cqdd_design.solids.mesh import DISPLAY, closed_mesh

    lowest = [
        (closed_mesh(part, DISPLAY).vertices @ pose[:3, :3].T + pose[:3, 3] * 1e3).min(axis=0)
        for part in parts
        for pose in (piece.pose(design) for piece in part.instances)
    ]
    return np.asarray(np.floor(np.min(lowest, axis=0)))


def write_glb(design: Design, parts: Sequence[Part], path: Path) -> WrittenFile:
    """Write the machine at crank angle 0 as binary glTF 2.0: metres, Y up, names and colours.

    One mesh a part, one node a piece. A node's ``extras`` name the body it moves with, so that a
    viewer can turn the mechanism. Errors as `write_stl`.
    """
    nodes: list[dict[str, Any]] = [
        {"name": design.file_name, "rotation": [-_QUARTER_TURN, 0.0, 0.0, _QUARTER_TURN]}
    ]
    meshes, materials = [], []
    buffer = gltf.Buffer()
    for index, part in enumerate(parts):
        meshes.append({"name": part.name, "primitives": [_primitive(part, index, buffer)]})
        materials.append(gltf.material(part, *_FINISH))
        for piece in part.instances:
            body: dict[str, Any] = {"part": part.name, "body": piece.body.kind}
            if piece.body.kind == "disc":
                body["disc"] = piece.body.disc
            matrix = np.round(piece.pose(design), 15) + 0.0
            nodes.append(
                {
                    "name": piece.name,
                    "mesh": index,
                    "matrix": matrix.T.ravel().tolist(),
                    "extras": body,
                }
            )
    content = gltf.scene(design, nodes, meshes, materials, buffer, generator=_GENERATOR)
    return write_atomically(path, content, "glb")


def _primitive(part: Part, material: int, buffer: gltf.Buffer) -> dict[str, Any]:
    from cqdd_design.solids.mesh import DISPLAY, facets

    found = facets(part, DISPLAY)
    normals = gltf.vertex_normals(found.vertices, found.triangles)
    return {
        "attributes": {
            "POSITION": buffer.add((found.vertices * 1e-3).astype("<f4"), bounds=True),
            "NORMAL": buffer.add(normals.astype("<f4")),
        },
        "indices": buffer.add(found.triangles.astype("<u4").ravel()),
        "material": material,
    }


def _hex(colour: Colour) -> str:
    return "#" + "".join(f"{round(255 * value):02X}" for value in colour)


def _number(value: float) -> str:
    return f"{round(float(value), 9) + 0.0:.9g}"
