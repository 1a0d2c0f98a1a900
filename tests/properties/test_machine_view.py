"""Pictures and model of the machine: complete, the same every time, and true to the motion."""

from __future__ import annotations

import base64
import gzip
import hashlib
import importlib.util
import io
import json
import math
import pickle
import re
import shutil
import struct
import subprocess
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lxml import etree
from solids_designs import CHANGES, known_design, known_parts, part_named

from cqdd_design.design import Design
from cqdd_design.machine import resolve
from cqdd_design.report.ink.page import environment
from cqdd_design.report.ink.svg import Figure, thinned
from cqdd_design.report.machine_view import (
    MachineViews,
    ViewerData,
    apart,
    hidden_line_views,
    viewer_data,
)
from cqdd_design.report.machine_view.aligned_section import cut_faces, section_figure
from cqdd_design.report.machine_view.camera import Camera, tinted
from cqdd_design.report.machine_view.explode import take_apart
from cqdd_design.report.machine_view.packing import machine_values, packed_model, packed_script
from cqdd_design.report.machine_view.stills import exploded_figure
from cqdd_design.solids.cad import MM
from cqdd_design.solids.cut_plane import cut_angles
from cqdd_design.solids.disassembly import disassembly_order
from cqdd_design.solids.hidden_lines import chained
from cqdd_design.solids.layers import Annulus, turned
from cqdd_design.solids.part import Part
from cqdd_design.solids.poses import Body, BodyKind, body_pose
from cqdd_design.solids.stations import stations

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("cadquery") is None, reason="cadquery is not installed"
)

VIEWER = Path(__file__).resolve().parents[2] / "cqdd_design/report/vendor/machine-viewer.min.js"
BOTH = "three discs in a pinwheel"
"""The two machines least like the paper's, in one."""
SVG = "{http://www.w3.org/2000/svg}"


@lru_cache(maxsize=4)
def machine(name: str) -> tuple[Design, tuple[Part, ...]]:
    if name != BOTH:
        return known_design(name), known_parts(name)
    changes = {
        **CHANGES["three discs"],
        "reducer.ring_type": "pinwheel",
        "reducer.ring.outer_diameter": 0.078,
    }
    design = known_design("paper").replacing(changes)
    return design, resolve(design).parts


@lru_cache(maxsize=4)
def views(name: str) -> MachineViews:
    return hidden_line_views(*machine(name))


@lru_cache(maxsize=4)
def model(name: str) -> ViewerData:
    return viewer_data(*machine(name))


def texts(markup: str) -> list[str]:
    root = etree.fromstring(markup.encode())
    return ["".join(item.itertext()) for item in root.iter("text", f"{SVG}text")]


@pytest.mark.deep
@pytest.mark.parametrize("name", ["paper", BOTH])
def test_pictures_are_well_formed_light_and_name_every_part(name: str) -> None:
    found, (design, parts) = views(name), machine(name)
    for figure in (found.assembled, found.exploded, found.section):
        markup = figure.render()
        root = etree.fromstring(markup.encode())
        assert len(list(root.iter("path"))) > 30
        assert len(markup) < 400_000
        assert "nan" not in markup
        assert not re.search(r"https?:", markup)
    listed = texts(found.exploded.render())
    for number, part in enumerate(parts, start=1):
        label = part.name if part.count == 1 else f"{part.count} \u00d7 {part.name}"
        assert label in listed
        assert str(number) in listed
    drawn = [
        title.text for title in etree.fromstring(found.exploded.render().encode()).iter("title")
    ]
    for station in stations(parts):
        pieces = len(station.pieces)
        assert (station.name if pieces == 1 else f"{station.name}, {pieces} pieces") in drawn
    # A part that the cut misses, such as a row of dowels, has no name in the section.
    angles = cut_angles(design, stations(parts))
    cut = {
        face.station.part.name
        for direction in angles
        for face in cut_faces(design, stations(parts), angles[0], direction)
    }
    assert cut >= {part.name for part in parts if part.name in ("ring", "eccentric shaft")}
    named = " ".join(texts(found.section.render()))
    assert all(part in named for part in cut)
    # In the same test, so that one process draws the first set once.
    assert name != "paper" or drawn_again_the_same()


def drawn_again_the_same() -> bool:
    """Whether freshly built parts of the paper's design give the same bytes."""
    design = known_design("paper")
    again = resolve(design).parts
    first, found = views("paper"), stations(again)
    return (
        exploded_figure(design, again, found).render() == first.exploded.render()
        and section_figure(design, again, found).render() == first.section.render()
        and viewer_data(design, again).glb == model("paper").glb
    )


@pytest.mark.parametrize("name", CHANGES)
def test_the_machine_comes_apart_in_an_order_that_frees_every_piece(name: str) -> None:
    found = stations(known_parts(name))
    order = disassembly_order(found)
    assert sorted(order) == list(range(len(found)))
    rank = {found[index].name: position for position, index in enumerate(order)}
    discs = [rank[piece] for piece in rank if piece.startswith("disc")]
    assert discs == sorted(discs)
    assert rank["housing"] < min(discs)
    assert max(discs) < rank["carrier plate"] < rank["output bearing"] < rank["output cover"]
    assert rank["output cover"] < rank["cover screw"]
    # Nothing overlaps along the axis any more.
    order, shifts = take_apart(found, math.radians(60.0))
    ends = [(found[i].bottom + shifts[i], found[i].top + shifts[i]) for i in order]
    assert all(below[1] < above[0] for below, above in pairwise(ends))


@pytest.mark.deep
def test_section_cuts_what_the_plane_meets() -> None:
    """Height and bore of the first disc in the cut, and the pin beside it."""
    design, parts = known_design("paper"), known_parts("paper")
    found = stations(parts)
    right, _ = cut_angles(design, found)
    faces = {face.station.name: face for face in cut_faces(design, found, right, right)}
    assert "eccentric shaft" in faces
    disc = faces["disc 1"]
    points = np.concatenate(disc.loops)
    assert points[:, 1].min() == pytest.approx(0.0, abs=1e-3)
    assert points[:, 1].max() == pytest.approx(design.reducer.disc_thickness * MM, abs=1e-3)
    # The crank runs along the cut, so the bore of the first disc lies one eccentricity outward, as
    # near as facets of a picture keep to it.
    bore = part_named(parts, "cam bearing").shape.outside_radius + design.reducer.eccentricity
    assert points[:, 0].min() == pytest.approx(bore * MM, abs=0.05)
    # The pin of the carrier stands in the same half plane.
    assert any("shoulder screw" in face for face in faces)


@pytest.mark.deep
def test_hidden_lines_of_a_tube() -> None:
    """Along the axis only circles are left; from the side a rectangle, the bore hidden."""
    from cqdd_design.solids.cad import build_solid

    tube = build_solid("tube", turned([Annulus(0.0, 0.010, 0.004, 0.006)]))
    side = Camera(np.eye(3)[0], np.eye(3)[2], -np.eye(3)[1])
    lines = side.lines([tube])
    for chain in (*lines.edges, *lines.outlines):
        assert ((abs(abs(chain[:, 0]) - 6.0) < 1e-3) | (abs(chain[:, 1] % 10.0) < 1e-3)).all()
    above = Camera(np.eye(3)[0], np.eye(3)[1], np.eye(3)[2])
    radii = {round(float(r), 2) for chain in above.lines([tube]).edges for r in np.hypot(*chain.T)}
    assert radii == {4.0, 6.0}


def test_chains_do_not_depend_on_the_order_of_lines() -> None:
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]])
    lines = [square[i : i + 2] for i in range(4)]
    there, back = chained(lines), chained([line[::-1] for line in reversed(lines)])
    assert len(there) == len(back) == 1
    assert len(there[0]) == 5
    assert np.array_equal(there[0], back[0])


def test_thinning_keeps_corners_and_drops_what_is_straight() -> None:
    line = np.column_stack([np.arange(9.0), np.zeros(9)])
    corner = np.concatenate([line, [[8.0, 5.0]]])
    assert thinned(corner, 0.16).tolist() == [[0.0, 0.0], [8.0, 0.0], [8.0, 5.0]]


def test_light_goes_from_dark_to_pale() -> None:
    shades = [int(tinted((0.4, 0.5, 0.6), b)[1:3], 16) for b in (0.0, 0.3, 0.6, 1.0)]
    assert shades == sorted(shades)
    assert shades[0] < shades[-1]


def glb_parts(content: bytes) -> tuple[dict[str, Any], bytes]:
    magic, version, length = struct.unpack_from("<4sII", content)
    assert (magic, version, length) == (b"glTF", 2, len(content))
    size = struct.unpack_from("<I", content, 12)[0]
    document = json.loads(content[20 : 20 + size])
    return document, content[20 + size + 8 :]


def read(document: dict[str, Any], binary: bytes, index: int) -> np.ndarray:
    accessor = document["accessors"][index]
    view = document["bufferViews"][accessor["bufferView"]]
    kind = {5123: "<u2", 5125: "<u4", 5120: "i1"}[accessor["componentType"]]
    raw = np.frombuffer(
        binary, kind, view["byteLength"] // np.dtype(kind).itemsize, view["byteOffset"]
    )
    if accessor["type"] == "SCALAR":
        return raw[: accessor["count"]]
    return raw.reshape(accessor["count"], -1)[:, :3]


def unpacked(text: str, *, restored: bool = True) -> bytes:
    """What a page carries, turned back as its script does it."""
    content = bytearray(gzip.decompress(base64.b64decode(text)))
    if not restored:
        return bytes(content)
    document, _ = glb_parts(bytes(content))
    start = 28 + struct.unpack_from("<I", content, 12)[0]
    for accessor in document["accessors"]:
        view = document["bufferViews"][accessor["bufferView"]]
        if accessor["type"] == "SCALAR":
            kind = {5123: "H", 5125: "I"}[accessor["componentType"]]
            corners = memoryview(content)[start + view["byteOffset"] :][: view["byteLength"]]
            corners, fresh = corners.cast(kind), 0
            for i, back in enumerate(corners):
                corners[i] = fresh - back
                fresh += back == 0
    return bytes(content)


@pytest.mark.deep
def test_model_decodes_back_to_the_solids() -> None:
    parts = known_parts("paper")
    data = model("paper")
    document, binary = glb_parts(data.glb)
    assert len(packed_model(data.glb)) + len(packed_script()) < 750_000
    assert unpacked(packed_model(data.glb)) == data.glb
    assert unpacked(packed_script(), restored=False) == VIEWER.read_bytes()
    assert document["extensionsRequired"] == ["KHR_mesh_quantization"]
    pieces = {node["name"]: node for node in document["nodes"][1:]}
    assert set(pieces) == {piece.name for part in parts for piece in part.instances}
    for part in parts:
        piece = part.instances[0]
        node = pieces[piece.name]
        primitive = document["meshes"][node["mesh"]]["primitives"][0]
        steps = read(document, binary, primitive["attributes"]["POSITION"])
        corners = read(document, binary, primitive["indices"]).reshape(-1, 3)
        vertices = steps * node["scale"][0] + node["translation"]
        size = part.shape.outside_radius
        # Half a step, 1/16383 of the greatest side: two radii or the length at most.
        step = max(2.0 * size, part.shape.top - part.shape.bottom) / 16383
        assert vertices[:, 2].min() == pytest.approx(part.shape.bottom, abs=0.51 * step)
        assert vertices[:, 2].max() == pytest.approx(part.shape.top, abs=0.51 * step)
        a, b, c = (vertices[corners[:, k]] for k in range(3))
        volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0
        assert volume == pytest.approx(part.volume, rel=0.02)
        normals = read(document, binary, primitive["attributes"]["NORMAL"]) / 127.0
        assert np.linalg.norm(normals, axis=1) == pytest.approx(1.0, abs=0.02)
        flat = np.cross(b - a, c - a)
        flat /= np.linalg.norm(flat, axis=1, keepdims=True) + 1e-30
        real = np.linalg.norm(flat, axis=1) > 0.5
        assert ((flat * normals[corners[:, 0]]).sum(axis=1)[real] > 0.3).mean() > 0.99
        assert (
            pytest.approx(piece.placement, abs=1e-9)
            == np.array(node["extras"]["placement"]).reshape(4, 4).T
        )


@pytest.mark.parametrize("name", ["paper", pytest.param("three discs", marks=pytest.mark.deep)])
def test_the_viewer_moves_bodies_by_the_same_law(tmp_path: Path, name: str) -> None:
    node = shutil.which("node")
    if node is None:
        pytest.skip("node is not installed; the browser's test covers the law too")
    design = known_design(name)
    document, _ = glb_parts(model(name).glb)
    mechanism = document["nodes"][0]["extras"]
    last = design.reducer.disc_count - 1
    bodies: list[tuple[BodyKind, int]] = [("housing", 0), ("shaft", 0), ("carrier", 0)]
    bodies += [("disc", 0), ("disc", last)]
    samples = [(*body, angle) for body in bodies for angle in (0.0, 0.7, 5.0, 40.0)]
    script = tmp_path / "law.js"
    script.write_text(
        f"{VIEWER.read_text(encoding='utf-8')}\n"
        f"const samples = {json.dumps(samples)}, mechanism = {json.dumps(mechanism)};\n"
        "console.log(JSON.stringify(samples.map(([body, disc, angle]) =>"
        " cqddMachine.bodyPose(mechanism, body, disc, angle))));\n",
        encoding="utf-8",
    )
    done = subprocess.run([node, script], capture_output=True, text=True, timeout=60, check=True)
    for (kind, disc, angle), pose in zip(samples, json.loads(done.stdout), strict=True):
        expected = body_pose(design, Body(kind, disc), angle)
        assert [pose["x"], pose["y"]] == pytest.approx(expected[:2, 3].tolist(), abs=1e-15)
        turned_by = [math.cos(pose["angle"]), math.sin(pose["angle"])]
        assert turned_by == pytest.approx(expected[:2, 0].tolist(), abs=1e-12)


@pytest.mark.deep
def test_the_fragment_needs_no_network() -> None:
    fragment = (
        environment()
        .get_template("machine3d.html")
        .render(machine_values(views("paper"), model("paper")))
    )
    addresses = set(re.findall(r"https?://[\w./-]+", fragment))
    # The name of a namespace, which is no address to load from.
    assert addresses <= {"http://www.w3.org/1999/xhtml", "http://www.w3.org/2000/svg"}
    assert not re.search(r"<(?:script|img|link|iframe)[^>]+(?:src|href)=", fragment)
    assert len(fragment) < 1_300_000
    still = (
        environment().get_template("machine3d.html").render(machine_values(views("paper"), None))
    )
    assert "<script" not in still
    assert "machine-exploded" in still


def test_pictures_of_an_earlier_run_are_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By design and layout and the package's state; what is spoilt is drawn anew."""
    monkeypatch.setenv("CQDD_DESIGN_CACHE", str(tmp_path))
    found = resolve(known_design("paper"))
    first = apart.start_drawing(found, _Drawn)
    assert first.process is not None
    assert first.fetch() == apart.start_drawing(found, _Drawn).fetch() == _Drawn.views
    assert apart.start_drawing(found, _Drawn).process is None
    other = resolve(known_design("paper").replacing({"reducer.disc_spacing": 1e-3}))
    assert apart.start_drawing(other, _Drawn).process is not None
    (entry,) = (tmp_path / "pictures").iterdir()
    entry.write_bytes(entry.read_bytes()[:-1] + b"0")
    assert apart.start_drawing(found, _Drawn).process is not None


class _Drawn:
    """Stands for the process that draws: it has drawn this."""

    views = (
        MachineViews(*(Figure(name, "a", "b", 3.5, 2.0, "<g/>", "c") for name in "xyz")),
        ViewerData(b"glTF\x00\xff", 7),
    )
    returncode = 0

    def __init__(self, *_: object, **__: object) -> None:
        self.stdin = io.BytesIO()

    def communicate(self) -> tuple[bytes, bytes]:
        drawn = pickle.dumps(self.views)
        return hashlib.sha256(drawn).digest() + drawn, b""


def test_the_vendored_script_carries_its_licence() -> None:
    head = VIEWER.read_text(encoding="utf-8")[:200]
    licence = (VIEWER.parent / "three-LICENSE.txt").read_text(encoding="utf-8")
    assert "three-LICENSE.txt" in head
    assert "The MIT License" in licence
    assert VIEWER.stat().st_size < 800_000
