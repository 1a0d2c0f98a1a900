"""STL, 3MF and GLB read back by another library and by hand."""

from __future__ import annotations

import importlib.util
import json
import struct
import xml.etree.ElementTree as ElementTree
import zipfile
from pathlib import Path

import numpy as np
import pytest
from solids_designs import known_design, known_parts, part_named

from cqdd_design.exporting import ExportJob
from cqdd_design.exporting.solids.meshes import (
    export_3mf,
    export_glb,
    export_stl,
    write_3mf,
    write_glb,
    write_stl,
)
from cqdd_design.machine import resolve
from cqdd_design.solids.mesh import DISPLAY, closed_mesh

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("cadquery") is None, reason="cadquery is not installed"
)

CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"


def bounds() -> tuple[np.ndarray, np.ndarray]:
    """Least and greatest coordinates of the paper's machine, mm."""
    design = known_design("paper")
    corners = [
        closed_mesh(part, DISPLAY).vertices @ pose[:3, :3].T + pose[:3, 3] * 1e3
        for part in known_parts("paper")
        for pose in (piece.pose(design) for piece in part.instances)
    ]
    points = np.concatenate(corners)
    return points.min(axis=0), points.max(axis=0)


@pytest.mark.parametrize("name", ["disc", "ring", "shoulder screw", "housing"])
def test_stl_is_watertight_and_in_millimetres(name: str, tmp_path: Path) -> None:
    import trimesh

    part = part_named(known_parts("paper"), name)
    written = write_stl(part, tmp_path / "part.stl")
    assert written.path.read_bytes()[:11] == b"cqdd-design"
    mesh = trimesh.load(written.path)
    assert mesh.is_watertight
    assert mesh.volume * 1e-9 == pytest.approx(part.exact_volume, rel=2e-3)
    stored = np.frombuffer(written.path.read_bytes()[84:], dtype="V50")
    normals = np.array([struct.unpack("<3f", record[:12]) for record in stored.tolist()])
    assert np.abs(normals - mesh.face_normals).max() < 1e-3


def test_one_stl_a_part(tmp_path: Path) -> None:
    job = ExportJob(resolve(known_design("paper")), tmp_path, lambda _: None)
    job.__dict__["parts"] = known_parts("paper")
    files = export_stl(job)
    assert [one.path.name for one in files][:3] == [
        "cqdd-10-disc.stl",
        "cqdd-10-ring.stl",
        "cqdd-10-ring-dowel.stl",
    ]
    assert len(files) == len(known_parts("paper"))


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("meshes") / "machine.3mf"
    write_3mf(known_design("paper"), known_parts("paper"), path)
    return path


def test_3mf_has_units_names_and_colours(model: Path) -> None:
    parts = known_parts("paper")
    with zipfile.ZipFile(model) as archive:
        assert archive.testzip() is None
        assert archive.namelist()[0] == "[Content_Types].xml"
        root = ElementTree.fromstring(archive.read("3D/3dmodel.model"))
    assert root.get("unit") == "millimeter"
    objects = root.findall(f".//{CORE}object")
    assert [one.get("name") for one in objects] == [part.name for part in parts]
    bases = root.findall(f".//{CORE}base")
    assert [base.get("name") for base in bases] == [part.material for part in parts]
    assert bases[0].get("displaycolor") == "#EDB021"
    items = root.findall(f".//{CORE}item")
    pieces = [piece.name for part in parts for piece in part.instances]
    assert [item.get("partnumber") for item in items] == pieces
    for one, part in zip(objects, parts, strict=True):
        mesh = closed_mesh(part, DISPLAY)
        assert len(one.findall(f".//{CORE}vertex")) == len(mesh.vertices)
        assert len(one.findall(f".//{CORE}triangle")) == len(mesh.triangles)


def test_3mf_loads_elsewhere_as_the_same_machine(model: Path) -> None:
    import trimesh

    scene = trimesh.load(model)
    least, greatest = bounds()
    assert scene.units == "millimeter"
    assert np.asarray(scene.bounds).min() >= 0.0  # the positive octant
    size = scene.bounds[1] - scene.bounds[0]
    assert np.abs(size - (greatest - least)).max() < 1e-4
    assert all(mesh.is_watertight for mesh in scene.geometry.values())


@pytest.fixture(scope="module")
def glb(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("meshes") / "machine.glb"
    write_glb(known_design("paper"), known_parts("paper"), path)
    return path


def document(path: Path) -> dict:
    data = path.read_bytes()
    magic, version, total = struct.unpack("<4sII", data[:12])
    assert (magic, version, total) == (b"glTF", 2, len(data))
    length, kind = struct.unpack("<I4s", data[12:20])
    assert kind == b"JSON"
    assert length % 4 == 0
    return json.loads(data[20 : 20 + length])


def test_glb_is_in_metres_with_y_up(glb: Path) -> None:
    import trimesh

    scene = trimesh.load(glb)
    least, greatest = bounds()
    found = np.asarray(scene.bounds) * 1e3
    # Our z is glTF's y, our y its -z.
    assert np.abs(found[:, 1] - [least[2], greatest[2]]).max() < 1e-4
    assert np.abs(found[:, 2] - [-greatest[1], -least[1]]).max() < 1e-4
    assert np.abs(found[:, 0] - [least[0], greatest[0]]).max() < 1e-4


def test_glb_names_colours_and_bodies(glb: Path) -> None:
    parts = known_parts("paper")
    content = document(glb)
    assert [mesh["name"] for mesh in content["meshes"]] == [part.name for part in parts]
    nodes = {node["name"]: node for node in content["nodes"]}
    assert nodes["disc 2"]["extras"] == {"part": "disc", "body": "disc", "disc": 1}
    assert nodes["shoulder screw 4"]["extras"]["body"] == "carrier"
    assert nodes["eccentric shaft"]["extras"]["body"] == "shaft"
    pieces = sum(part.count for part in parts)
    assert len(nodes) == pieces + 1
    ring = content["materials"][1]
    assert ring["name"] == "AISI 4140 Q&T 540C"
    # 0.70 in sRGB is 0.448 in linear light.
    assert ring["pbrMetallicRoughness"]["baseColorFactor"][2] == pytest.approx(0.448, abs=1e-3)


def test_glb_normals_are_unit_and_point_outward(glb: Path) -> None:
    content = document(glb)
    data = glb.read_bytes()
    start = 20 + struct.unpack("<I", data[12:16])[0] + 8

    def array(index: int) -> np.ndarray:
        accessor = content["accessors"][index]
        view = content["bufferViews"][accessor["bufferView"]]
        kind = "<f4" if accessor["componentType"] == 5126 else "<u4"
        begin = start + view["byteOffset"]
        found = np.frombuffer(data[begin : begin + view["byteLength"]], dtype=kind)
        return found.reshape(-1, 3)

    for mesh in content["meshes"]:
        primitive = mesh["primitives"][0]
        points = array(primitive["attributes"]["POSITION"])
        normals = array(primitive["attributes"]["NORMAL"])
        triangles = array(primitive["indices"])
        assert np.abs(np.linalg.norm(normals, axis=1) - 1.0).max() < 1e-5
        a, b, c = (points[triangles[:, k]].astype(float) for k in range(3))
        across = np.cross(b - a, c - a)
        large = np.linalg.norm(across, axis=1) > 1e-9
        agreement = np.einsum("ij,ij->i", across[large], normals[triangles[large, 0]])
        assert (agreement > 0.0).all()


def test_mesh_files_are_reproducible(model: Path, glb: Path, tmp_path: Path) -> None:
    job = ExportJob(resolve(known_design("paper")), tmp_path, lambda _: None)
    job.__dict__["parts"] = known_parts("paper")
    (again,) = export_3mf(job)
    assert again.path.read_bytes() == model.read_bytes()
    (again,) = export_glb(job)
    assert again.path.read_bytes() == glb.read_bytes()
