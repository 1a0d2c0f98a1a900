"""Solids and meshes against closed forms, and against each other: needs the CAD kernel."""

from __future__ import annotations

import dataclasses
import importlib.util
import math
from pathlib import Path

import numpy as np
import pytest
from solids_designs import known_design, known_parts, part_named

from cqdd_design.design import load_design
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.disc import profile_moments
from cqdd_design.machine import resolve
from cqdd_design.solids.clearances import assembly_motion
from cqdd_design.solids.features.revolved import Revolved
from cqdd_design.solids.interference import overlap_of, posed_manifold
from cqdd_design.solids.mesh import (
    DISPLAY,
    FINE,
    Quality,
    closed_mesh,
    facets,
    mass_properties,
    mesh_volume,
    tessellate,
)
from cqdd_design.solids.part import Instance, Part
from cqdd_design.solids.poses import transform

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("cadquery") is None, reason="cadquery is not installed"
)

DESIGNS = Path(__file__).resolve().parents[2] / "designs"
# Shapes that differ in kind from those of the paper's machine.
OTHERS = [
    ("three discs", "disc 2"),
    ("three discs", "eccentric shaft"),
    ("three discs", "eccentric cam"),
    ("pinwheel", "ring"),
    ("pinwheel", "ring pin"),
    ("pinwheel", "pin sleeve"),
    ("conjugate", "ring"),
    ("one disc", "dowel pin"),
    ("columns", "disc"),
    ("columns", "carrier plate"),
    ("columns", "carrier cap"),
    ("columns", "carrier column"),
    ("columns", "column screw"),
]
#: Parts that no other shape stands for; the rest of the machine is turned, or bought.
DAILY = (
    "disc",
    "ring",
    "carrier plate",
    "carrier cap",
    "eccentric shaft",
    "shoulder screw",
    "housing",
)
CASES = [
    pytest.param(("paper", part), marks=[] if part.name in DAILY else [pytest.mark.deep])
    for part in known_parts("paper")
] + [
    pytest.param((name, part_named(known_parts(name), part)), marks=pytest.mark.deep)
    for name, part in OTHERS
]


def ids(case: tuple[str, Part]) -> str:
    return f"{case[0]}: {case[1].name}"


def slopes_of(cut: Revolved) -> int:
    """Straight sides of an outline that are neither along the axis nor across it."""
    corners = zip(cut.outline, (*cut.outline[1:], cut.outline[0]), strict=True)
    bulges = cut.bulges or (0.0,) * len(cut.outline)
    return sum(
        bulge == 0.0 and abs(r1 - r0) > 1e-12 and abs(z1 - z0) > 1e-12
        for ((r0, z0), (r1, z1)), bulge in zip(corners, bulges, strict=True)
    )


@pytest.mark.parametrize("case", CASES, ids=ids)
def test_solid_and_mesh_agree_with_the_closed_form(case: tuple[str, Part]) -> None:
    part = case[1]
    assert part.solid.isValid()
    assert part.solid.ShapeType() == "Solid"
    # Arcs only: the kernel's own integral is that of the arcs to rounding.
    assert part.solid.Volume() * 1e-9 == pytest.approx(part.volume, rel=1e-9)
    kinds = {face.geomType() for face in part.solid.Faces()}
    assert kinds <= {"PLANE", "CYLINDER", "CONE", "TORUS"}
    # A cone for every chamfer, countersink and drill point, a torus for every fillet.
    found_cones = sum(face.geomType() == "CONE" for face in part.solid.Faces())
    slopes = sum(len(cut.centres) * slopes_of(cut) for cut in part.cuts)
    assert found_cones == slopes
    fillets = sum(len(cut.centres) * sum(map(bool, cut.bulges)) for cut in part.cuts)
    assert sum(face.geomType() == "TORUS" for face in part.solid.Faces()) == fillets

    mesh = tessellate(part, FINE)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh_volume(part) == pytest.approx(part.exact_volume, rel=8e-5)
    assert mesh_volume(part) != part.exact_volume
    found, exact = mass_properties(part), part.exact_properties
    assert found.mass == pytest.approx(exact.mass, rel=8e-5)
    size = np.abs(exact.inertia).max()
    assert np.abs(found.inertia - exact.inertia).max() < 8e-5 * size
    for axis in range(3):
        assert found.inertia[axis, axis] == pytest.approx(exact.inertia[axis, axis], rel=1e-4)
    assert np.abs(found.centre - exact.centre).max() < 1e-4 * part.shape.outside_radius


def test_disc_without_holes_has_the_area_of_greens_theorem() -> None:
    design = known_design("paper")
    disc = part_named(known_parts("paper"), "disc")
    shape = disc.shape.layers[0].shape
    holes = sum(hole.moments().area for hole in shape.holes)
    lobed = mesh_volume(disc) / design.reducer.disc_thickness + holes
    exact = profile_moments(CycloidDisc.from_design(design)).area
    assert lobed == pytest.approx(exact, rel=1e-4)


@pytest.mark.deep
def test_display_meshes_are_closed_and_small() -> None:
    count = 0
    for part in known_parts("paper"):
        mesh = closed_mesh(part, DISPLAY)
        count += len(mesh.triangles)
        assert mesh.volume == pytest.approx(part.volume * 1e9, rel=2e-3)
        raw = facets(part, DISPLAY)
        assert len(raw.vertices) > len(mesh.vertices)  # no smoothing across edges
        # Welding drops slivers without area.
        assert 0 <= len(raw.triangles) - len(mesh.triangles) < 2e-3 * len(raw.triangles)
    # Chamfers, undercuts and drills are a tenth of them.
    assert count < 120_000


@pytest.mark.parametrize(
    ("name", "angles", "quality"),
    [
        pytest.param("paper", [2.3], FINE, marks=pytest.mark.deep),
        pytest.param("three discs", [1.1], DISPLAY, marks=pytest.mark.deep),
        pytest.param("pinwheel", [4.0], DISPLAY, marks=pytest.mark.deep),
        pytest.param("conjugate", [7.7], DISPLAY, marks=pytest.mark.deep),
        pytest.param("one disc", [30.0], DISPLAY, marks=pytest.mark.deep),
        pytest.param("columns", [3.1], DISPLAY, marks=pytest.mark.deep),
        pytest.param("clamped", [3.1], DISPLAY, marks=pytest.mark.deep),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_nothing_runs_into_anything(name: str, angles: list[float], quality: Quality) -> None:
    design, parts = known_design(name), known_parts(name)
    found = assembly_motion(design, parts, np.array(angles), quality).collisions
    assert found == (), [f"{o.first} and {o.second}: {o.volume * 1e9:.3g} mm3" for o in found]


def gear_train(parts: tuple[Part, ...]) -> tuple[Part, ...]:
    return tuple(part for part in parts if part.name in {"disc", "ring", "shoulder screw"})


def moved(part: Part, piece: str, placement: np.ndarray) -> Part:
    """The part with one piece placed elsewhere in its body."""
    pieces = tuple(
        Instance(one.name, one.body, placement @ one.placement) if one.name == piece else one
        for one in part.instances
    )
    return dataclasses.replace(part, instances=pieces)


def test_gear_train_clears_over_many_angles() -> None:
    angles = 2.0 * math.pi * np.arange(4) / 4 * known_design("paper").reducer.ratio
    found = assembly_motion(known_design("paper"), gear_train(known_parts("paper")), angles)
    # The teeth leave 6 um and the holes 8 um: more than the facets.
    assert found.collisions == ()
    assert min(one.gap for one in found.clearances) > 0.0


@pytest.mark.parametrize(
    ("fault", "placement"),
    [
        pytest.param("not turned over", transform(z=0.0), marks=pytest.mark.deep),
        ("a lobe pitch out by a tenth of a millimetre", transform(0.1 / 32.0)),
        pytest.param("half a lobe out", transform(math.pi / 10), marks=pytest.mark.deep),
    ],
)
def test_a_wrongly_phased_disc_is_caught(fault: str, placement: np.ndarray) -> None:
    design = known_design("paper")
    train = gear_train(known_parts("paper"))
    disc = part_named(train, "disc")
    if fault == "not turned over":
        plain = transform(z=design.reducer.disc_thickness + design.reducer.disc_spacing)
        second = disc.instances[1]
        wrong = dataclasses.replace(
            disc, instances=(disc.instances[0], Instance(second.name, second.body, plain))
        )
    else:
        wrong = moved(disc, "disc 2", placement)
    found = assembly_motion(design, (wrong, *train[1:]), np.array([0.4])).collisions
    assert found, fault
    assert all("disc 2" in {one.first, one.second} for one in found)
    others = {one.first for one in found} | {one.second for one in found}
    # Lobes that mesh but holes that do not, or both.
    if fault == "not turned over":
        assert "ring" not in others
        assert any(name.startswith("shoulder screw") for name in others)
    else:
        assert "ring" in others


def test_shared_volume_is_that_of_the_lens() -> None:
    """Two equal cylinders a little apart share a lens of known area."""
    screw = part_named(known_parts("paper"), "shoulder screw")
    design = known_design("paper")
    drawn = next(part for part in known_parts("pinwheel") if part.name == "ring pin")
    # Bought ones come without the chamfers of our making.
    pin = dataclasses.replace(drawn, source="buy")
    first = pin.instances[0]
    apart, radius = 0.004, 0.0035
    second = Instance("moved", first.body, transform(x=apart) @ first.placement)
    lens = 2.0 * radius**2 * math.acos(apart / (2.0 * radius)) - 0.5 * apart * math.sqrt(
        4.0 * radius**2 - apart**2
    )
    height = pin.shape.top - pin.shape.bottom
    here, there, far = (
        posed_manifold(part, piece.pose(design), FINE)
        for part, piece in ((pin, first), (pin, second), (screw, screw.instances[2]))
    )
    shared = overlap_of(here, there)
    assert shared is not None
    assert shared[0] == pytest.approx(lens * height, rel=2e-4)
    assert overlap_of(here, far) is None


def test_pieces_of_the_assembly_stand_where_they_are_posed() -> None:
    from cqdd_design.solids.assembly import build_assembly

    design, parts = known_design("paper"), known_parts("paper")
    angle = 1.3
    assembly = build_assembly(design, parts, angle)
    placed = {child.name: child for child in assembly.children}
    for part in parts[:3]:
        for piece in part.instances:
            pose = piece.pose(design, angle)
            wanted = pose[:3, :3] @ tessellate(part).center_mass + 1e3 * pose[:3, 3]
            child = placed[piece.name]
            centre = child.obj.moved(child.loc).Center()  # type: ignore[union-attr]
            assert np.abs(np.array(centre.toTuple()) - wanted).max() < 1e-3
    assert len(placed) == sum(part.count for part in parts)


def test_merging_faces_moves_no_surface() -> None:
    """The seat of the ring in this housing, with grooves all round, once lost their mouths."""
    machine = resolve(load_design(DESIGNS / "reference-s.toml"))
    housing = part_named(machine.parts, "housing")
    pack, dowels = machine.layout.pack, machine.layout.dowels
    seat = math.fsum(
        face.Area()
        for face in housing.solid.Faces()
        if face.geomType() == "CYLINDER"
        and math.isclose(face._geomAdaptor().Cylinder().Radius(), 1e3 * pack.ring_radius)
        and abs(face.Center().z) < 1e3 * pack.top
    )
    mouth = 2.0 * math.asin(0.5 * dowels.radius / pack.ring_radius) * 2.0 * pack.ring_radius
    grooves = len(dowels.angles) * mouth * (pack.top - dowels.bottom)
    whole = 2.0 * math.pi * pack.ring_radius * pack.top
    assert seat == pytest.approx(1e6 * (whole - grooves), rel=0.02)
    assert len(facets(housing, DISPLAY).triangles) > 1000
