"""Front views: true arcs to scale, well-formed XML, every part in its place."""

from __future__ import annotations

import math
import re
from xml.etree import ElementTree

import numpy as np
import pytest

from cqdd_design.design import load_design
from cqdd_design.exporting.edm.flat_parts import flat_parts
from cqdd_design.exporting.sheets.svg import front_view, part_view, path_data
from cqdd_design.geometry.contours import ArcContour, Circle
from cqdd_design.machine import resolve
from cqdd_design.roads.export import export

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def paper(paper_design_file):
    return load_design(paper_design_file)


def _joints(path: str) -> np.ndarray:
    """End points of the steps of a path, mm."""
    steps = re.findall(r"[MLA]([^MLAZ]*)", path)
    return np.array([[float(v) for v in step.split()[-2:]] for step in steps])


def test_a_path_has_the_arcs_of_its_contour(paper):
    contour = flat_parts(resolve(paper))[0].shape.outer
    assert isinstance(contour, ArcContour)
    path = path_data(contour)
    assert path.count("A") == len(contour)
    joints = _joints(path)
    assert np.allclose(joints[:-1], contour.points * 1e3, atol=1e-6)
    assert np.allclose(joints[-1], joints[0])
    radii = [float(r) for r in re.findall(r"A(\S+) ", path)]
    assert np.allclose(radii, contour.arcs().radii * 1e3, atol=1e-6)
    sweeps = [int(flag) for flag in re.findall(r"A\S+ \S+ 0 0 (\d)", path)]
    assert sweeps == [int(bulge > 0.0) for bulge in contour.bulges]


def test_lines_and_long_arcs():
    contour = ArcContour(np.array([[0.0, 0.0], [1e-3, 0.0], [1e-3, 1e-3]]), np.array([0.0, 2.0, 0]))
    path = path_data(contour)
    assert "L1 0" in path
    assert re.search(r"A0\.625 0\.625 0 1 1 1 1", path)


def test_a_circle_is_two_half_circles():
    path = path_data(Circle(np.array([1e-3, -2e-3]), 0.5e-3))
    assert path == "M1.5 -2A0.5 0.5 0 0 1 0.5 -2A0.5 0.5 0 0 1 1.5 -2Z"


def test_views_are_to_scale_and_well_formed(paper):
    for flat in flat_parts(resolve(paper)):
        root = ElementTree.fromstring(part_view(flat, paper))
        width = float(root.get("width").removesuffix("mm"))
        assert float(root.get("viewBox").split()[2]) == width
        assert root.find(f"{SVG}title").text.startswith(f"cqdd-10 {flat.label}")


def test_the_mechanism_is_put_together_right(paper):
    """Every pin touches its hole on the side of the crank; lobes do not cross the ring's teeth."""
    root = ElementTree.fromstring(front_view(resolve(paper)))
    kinds = [path.get("class") for path in root.iter(f"{SVG}path")]
    assert kinds.count("part ring") == 1
    assert kinds.count("part disc") == 1
    assert kinds.count("part disc behind") == 1
    assert kinds.count("part pin") == paper.reducer.output_pins.count
    (front,) = (p for p in root.iter(f"{SVG}path") if p.get("class") == "part disc")
    outline, bore, *holes = front.get("d").removesuffix("Z").split("Z ")
    lobes = _joints(outline)
    teeth = 2.0 * math.pi * np.arange(11) / 11
    centres = 32.0 * np.stack([np.cos(teeth), np.sin(teeth)], axis=-1)
    gaps = np.hypot(*(lobes[:, None] - centres).transpose(2, 0, 1)).min() - 3.5
    assert gaps >= 0.006 - 1e-3
    assert np.allclose(_joints(bore).mean(axis=0)[1], 0.0, atol=1e-6)
    pins = [p.get("d") for p in root.iter(f"{SVG}path") if p.get("class") == "part pin"]
    for hole, pin in zip(holes, pins, strict=True):
        apart = _joints(hole)[:2].mean(axis=0) - _joints(pin)[:2].mean(axis=0)
        assert apart == pytest.approx([1.6, 0.0], abs=1e-5)


def test_columns_stand_in_their_holes(paper):
    columns = {"reducer.carrier.joint": "columns", "reducer.carrier.column_diameter": "4 mm"}
    root = ElementTree.fromstring(front_view(resolve(paper.replacing(columns))))
    drawn = [p.get("d") for p in root.iter(f"{SVG}path") if p.get("class") == "part pin"]
    (front,) = (p for p in root.iter(f"{SVG}path") if p.get("class") == "part disc")
    holes = front.get("d").removesuffix("Z").split("Z ")[2:]
    assert len(drawn) == len(holes) == 10
    for hole, pin in zip(holes, drawn, strict=True):
        apart = _joints(hole)[:2].mean(axis=0) - _joints(pin)[:2].mean(axis=0)
        assert apart == pytest.approx([1.6, 0.0], abs=1e-5)


def test_names_are_escaped(paper):
    odd = paper.replacing({"name": "a & b"})
    assert (
        ElementTree.fromstring(front_view(resolve(odd)))
        .find(f"{SVG}title")
        .text.startswith("a & b")
    )


def test_files(paper, tmp_path):
    names = [file.path.name for file in export(paper, "svg", tmp_path)]
    assert names == ["cqdd-10-disc.svg", "cqdd-10-ring.svg", "cqdd-10-front.svg"]
