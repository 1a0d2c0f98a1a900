"""STEP files as others read them: by the rules of the standard, and by a kernel that is not ours.

Files are written by Open CASCADE. They are read here as plain text (`part21`) and by arris, a
kernel in Rust that shares no code with Open CASCADE, heals nothing unsaid and checks every solid.
"""

from __future__ import annotations

import importlib.util
import math
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from part21 import Part21
from solids_designs import known_design, known_parts

from cqdd_design.design import Design
from cqdd_design.exporting.solids.step import write_part_step, write_step
from cqdd_design.solids.features.holes import FittedHole, TappedHole
from cqdd_design.solids.features.kinds import AxialThread, Chamfer, Groove, Seat, Undercut
from cqdd_design.solids.part import Part

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("cadquery") is None, reason="cadquery is not installed"
)
KINDS = {"plane": "PLANE", "cylinder": "CYLINDER", "cone": "CONE", "torus": "TORUS"}
SURFACES = {
    "PLANE": "PLANE",
    "CYLINDRICAL_SURFACE": "CYLINDER",
    "CONICAL_SURFACE": "CONE",
    "TOROIDAL_SURFACE": "TORUS",
}


class Round(NamedTuple):
    """A face's surface: what it is and its size, mm or degrees."""

    kind: str
    size: float = 0.0


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("step") / "machine.step"
    write_step(known_design("paper"), known_parts("paper"), path)
    return path.read_text(encoding="ascii")


@pytest.fixture(scope="module")
def arris() -> Any:
    return pytest.importorskip(
        "arris", reason="arris, a second kernel (extra `dev`), is not installed"
    )


def in_text(text: str) -> list[Counter[str]]:
    """The surfaces of every solid of a file whose boundaries are whole."""
    read = Part21(text)
    assert not read.unresolved
    shells = read.shells()
    for one in shells:
        assert one.used_wrongly == ()
        assert one.genus == int(one.genus) >= 0
    return [Counter({SURFACES[k]: n for k, n in one.surfaces.items()}) for one in shells]


def in_arris(arris: Any, text: str, level: str) -> Iterator[tuple[Any, Any]]:
    """A model and every body that it takes from a file, none of them mended."""
    model = arris.Model()
    for solid in model.read_step(text, length_unit="mm").solids:
        assert solid.ok, (solid.refusal.kind, solid.refusal.message)
        assert not solid.healing.grown
        assert not solid.healing.turned
        report = model.check(solid.body, level)
        assert report.ok, [(one.code, one.entity) for one in report.violations]
        yield model, solid.body


def faces_of(model: Any, body: Any) -> Counter[Round]:
    """Surfaces with their sizes: radii, the lesser of a torus; half angles of cones."""
    found: Counter[Round] = Counter()
    for face in model.faces(body):
        one = model.surface(face)
        size = {
            "plane": lambda _: 0.0,
            "cylinder": lambda one: one.radius,
            "cone": lambda one: math.degrees(one.half_angle),
            "torus": lambda one: one.minor_radius,
        }[one.kind](one)
        found[Round(KINDS[one.kind], round(abs(size), 4))] += 1
    return found


def drawn_faces(part: Part) -> Counter[Round]:
    """The same of the solid as the kernel that writes it has it."""
    found: Counter[Round] = Counter()
    for face in part.solid.Faces():
        one = face._geomAdaptor()
        size = {
            "PLANE": lambda _: 0.0,
            "CYLINDER": lambda one: one.Cylinder().Radius(),
            "CONE": lambda one: math.degrees(one.Cone().SemiAngle()),
            "TORUS": lambda one: one.Torus().MinorRadius(),
        }[face.geomType()](one)
        found[Round(face.geomType(), round(abs(size), 4))] += 1
    return found


def stated_faces(part: Part) -> tuple[Counter[str], list[tuple[float, float, float]]]:
    """Cones and tori that a part's features make, and the axes and radii of its cylinders, mm."""
    made: Counter[str] = Counter()
    cylinders: list[tuple[float, float, float]] = []

    def stand(diameter: float, *centres: tuple[float, float]) -> None:
        cylinders.extend((1e3 * x, 1e3 * y, 500.0 * diameter) for x, y in centres)

    for one in part.features:
        if isinstance(one, Chamfer):
            made["CONE"] += len(one.centres)
        elif isinstance(one, Undercut):
            # The run-out at 15 degrees to the cylinder, eased into its floor, and the fillet.
            made["CONE"] += 1
            made["TORUS"] += 2
        elif isinstance(one, Groove):
            made["TORUS"] += 2
            stand(one.diameter, (0.0, 0.0))
        elif isinstance(one, TappedHole):
            ends = (one.countersink > one.drill) + (not one.through)
            made["CONE"] += ends * one.circle.count
            stand(one.drill, *one.circle.centres)
        elif isinstance(one, FittedHole) and not one.seam:
            made["CONE"] += one.pointed * one.circle.count
            stand(one.diameter, *one.circle.centres)
        elif isinstance(one, Seat):
            stand(one.diameter, one.centre)
        elif isinstance(one, AxialThread):
            stand(one.core, (0.0, 0.0))
    return made, cylinders


def stands_in(model: Any, body: Any, cylinder: tuple[float, float, float]) -> bool:
    """Whether a body has a face of this cylinder about this axis, mm."""
    x, y, radius = cylinder
    return any(
        abs(one.radius - radius) < 1e-6
        and math.hypot(one.origin[0] - x, one.origin[1] - y) < 1e-6
        and abs(one.axis[2]) > 1.0 - 1e-12
        for one in map(model.surface, model.faces(body))
        if one.kind == "cylinder"
    )


def test_boundaries_are_whole_by_the_standard(whole: str) -> None:
    """Every edge twice, once in each sense; Euler's formula; every reference stands; mm."""
    parts = known_parts("paper")
    shells = in_text(whole)
    assert len(shells) == len(parts)
    assert sum(shells, Counter()) == sum(
        (Counter(face.geomType() for face in part.solid.Faces()) for part in parts), Counter()
    )
    read = Part21(whole)
    (unit,) = {body for body in read.texts.values() if "LENGTH_UNIT" in body}
    assert "SI_UNIT(.MILLI.,.METRE.)" in unit
    assert len(read.all("NEXT_ASSEMBLY_USAGE_OCCURRENCE")) == sum(p.count for p in parts)
    # As many handles as the disc has holes and the ring openings.
    for name, holes in (("disc", 1 + 5), ("ring", 1)):
        (genus,) = (
            one.genus for one, part in zip(read.shells(), parts, strict=True) if part.name == name
        )
        assert genus == holes


def damaged(whole: str) -> dict[str, str]:
    """The file with an edge of a face run the wrong way, and with a face lost."""
    read = Part21(whole)
    edge = read.texts[read.all("ORIENTED_EDGE")[0]]
    shell = read.texts[read.all("CLOSED_SHELL")[0]]
    senses = {".T.": ".F.", ".F.": ".T."}
    first, _, others = shell.partition(",")[2].partition(",")
    assert first.startswith("(#")
    return {
        "turned": whole.replace(edge, re.sub(r"\.[TF]\.", lambda one: senses[one[0]], edge), 1),
        "lost": whole.replace(shell, f"CLOSED_SHELL('',({others}", 1),
    }


@pytest.mark.parametrize("harm", ["turned", "lost"])
def test_a_boundary_that_is_not_whole_is_seen(harm: str, whole: str) -> None:
    assert any(one.used_wrongly for one in Part21(damaged(whole)[harm]).shells())


@pytest.mark.parametrize("harm", ["turned", "lost"])
def test_the_other_kernel_sees_it_too(harm: str, whole: str, arris: Any) -> None:
    refused = [
        one.refusal
        for one in arris.Model().read_step(damaged(whole)[harm], length_unit="mm").solids
        if not one.ok
    ]
    # The two discs of the first solid.
    assert len(refused) == 2


def agrees(design: Design, parts: tuple[Part, ...], text: str, arris: Any, level: str) -> None:
    """The whole machine: every piece valid, of its volume, in its place, with the faces drawn."""
    pieces = [(part, piece) for part in parts for piece in part.instances]
    found: Counter[Round] = Counter()
    bodies = list(in_arris(arris, text, level))
    assert len(bodies) == len(pieces)
    for (part, piece), (model, body) in zip(pieces, bodies, strict=True):
        mass = model.mass_properties(body)
        assert mass.volume * 1e-9 == pytest.approx(part.volume, rel=1e-9), piece.name
        pose, drawn = piece.pose(design), part.shape.mass_properties(1.0)
        for cut in part.cuts:
            drawn = drawn + cut.mass_properties(-1.0)
        wanted = 1e3 * (pose[:3, :3] @ drawn.centre + pose[:3, 3])
        assert np.abs(np.array(mass.centroid) - wanted).max() < 1e-6, piece.name
        found += faces_of(model, body)
    drawn_ones = (drawn_faces(part) for part in parts for _ in part.instances)
    assert found == sum(drawn_ones, Counter())


def test_another_kernel_takes_the_whole_machine(whole: str, arris: Any) -> None:
    agrees(known_design("paper"), known_parts("paper"), whole, arris, "fast")


@pytest.mark.deep
def test_made_parts_have_their_features_in_another_kernel(tmp_path: Path, arris: Any) -> None:
    """Cones, tori and cylinders of the feature list, in files of AP242 with what they state."""
    design = known_design("paper")
    made = [part for part in known_parts("paper") if part.source == "make"]
    total: Counter[str] = Counter()
    for part in made:
        path = tmp_path / "part.step"
        write_part_step(design, part, path, "AP242")
        text = path.read_text(encoding="ascii")
        ((model, body),) = in_arris(arris, text, "full")
        faces = faces_of(model, body)
        assert faces == drawn_faces(part), part.name
        kinds: Counter[str] = Counter()
        for one, count in faces.items():
            kinds[one.kind] += count
        assert [kinds] == in_text(text), part.name
        stated, cylinders = stated_faces(part)
        assert {k: kinds[k] for k in ("CONE", "TORUS")} == {
            k: stated[k] for k in ("CONE", "TORUS")
        }, part.name
        for cylinder in cylinders:
            assert stands_in(model, body, cylinder), (part.name, cylinder)
        total += kinds
    assert len(made) >= 10
    assert total["CONE"] > 50
    assert total["TORUS"] == 6
