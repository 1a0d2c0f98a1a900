"""Discs with holes for columns as elastic bodies: they give more, and are stressed beside them."""

from __future__ import annotations

import functools
import itertools
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from disc_patches import DiscPatches

from cqdd_design.design import Design, load_design
from cqdd_design.errors import GeometryError
from cqdd_design.gearbox.bodies.disc import GRIDS, DiscShape
from cqdd_design.gearbox.bodies.made import elastic_bodies
from cqdd_design.gearbox.bodies.mesh import mesh
from cqdd_design.gearbox.bodies.model import Body, disc_body, of_standard, to_standard
from cqdd_design.gearbox.bodies.strength import LIGAMENTS, Peak, Swing
from cqdd_design.gearbox.bodies.stress import disc_regions, disc_stress
from cqdd_design.gearbox.checks.bodies import body_checks
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.states import nominal_states
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.columns import column_hole_diameter
from cqdd_design.geometry.disc import column_hole_centres
from cqdd_design.machine import body_analysis, resolve
from cqdd_design.report.drawings.outlines import Outlines
from cqdd_design.report.gearbox.stress import stress_picture

PER_LOBE, PER_HOLE = GRIDS[0]

DESIGNS = Path(__file__).resolve().parents[2] / "designs"


@functools.cache
def design_of_s(pins: int = 5, columns: int = 5, diameter: float = 4.0) -> Design:
    """The reference design with few pins, so that columns have room between them."""
    return load_design(DESIGNS / "reference-s.toml").replacing(
        {
            "reducer.output_pins.count": pins,
            "reducer.carrier.joint": "columns",
            "reducer.carrier.column_count": columns,
            "reducer.carrier.column_diameter": f"{diameter} mm",
        }
    )


@functools.cache
def disc_of_s(diameter: float) -> tuple[DiscShape, Body]:
    """A disc with column holes for `diameter` in mm, and without for 0."""
    shape = DiscShape.from_design(design_of_s(diameter=diameter or 4.0), 0)
    if not diameter:
        shape = replace(shape, column_count=0, column_radius=0.0, first_column=0.0)
    return shape, disc_body(shape)


@pytest.mark.parametrize(("pins", "columns"), [(5, 5), (6, 3)])
@pytest.mark.parametrize("disc", [0, 1])
def test_columns_holes_are_where_the_disc_is_cut(pins: int, columns: int, disc: int) -> None:
    design = design_of_s(pins, columns, 3.0)
    shape = DiscShape.from_design(design, disc)
    expected = column_hole_centres(design, disc) @ np.array([1.0, 1.0j])
    assert shape.columns == pytest.approx(expected, abs=1e-12)
    loaded, seen = shape.places(), shape.seen()
    assert len(loaded) == 10 * PER_LOBE + pins * PER_HOLE
    assert (seen.point[: len(loaded)] == loaded.point).all()
    walls = seen.point[len(loaded) :].reshape(columns, PER_HOLE) - expected[:, None]
    assert np.abs(walls) == pytest.approx(0.5 * column_hole_diameter(design.reducer))
    assert walls / np.abs(walls) == pytest.approx(
        seen.inward[len(loaded) :].reshape(columns, PER_HOLE)
    )
    made = mesh(shape.loops(), shape.side, "the disc")
    corner = made.vertices[made.triangles]
    area = 0.5 * (np.conj(corner[1] - corner[0]) * (corner[2] - corner[0])).imag.sum()
    bare = replace(shape, column_count=0)
    made = mesh(bare.loops(), bare.side, "the disc")
    corner = made.vertices[made.triangles]
    whole = 0.5 * (np.conj(corner[1] - corner[0]) * (corner[2] - corner[0])).imag.sum()
    holes = columns * math.pi * shape.column_radius**2
    assert whole - area == pytest.approx(holes, rel=1e-2)


def test_places_are_named_by_the_edge_across_the_material() -> None:
    """Six holes and three columns: a column on one side of each hole, a hole on the other."""
    shape = DiscShape.from_design(design_of_s(6, 3, 3.0), 1)
    regions = np.array(disc_regions(shape))
    seen = shape.seen()
    assert len(regions) == len(seen)
    centre = np.concatenate([shape.holes, shape.columns])
    radius = np.concatenate([np.full(6, shape.hole_radius), np.full(3, shape.column_radius)])
    rim = shape.outline.profile(np.linspace(0.0, 2.0 * np.pi, 4001))[0]
    kinds = ["hole"] * 6 + ["column"] * 3
    for hole in range(9):
        own = slice(10 * PER_LOBE + PER_HOLE * hole, 10 * PER_LOBE + PER_HOLE * (hole + 1))
        # Straight outward and inward the nearest edge, to both sides the next hole.
        for step in (0, 12):
            at = seen.point[own][step]
            across = np.abs(at - rim).min() < abs(at) - shape.bearing.outer
            assert regions[own][step] == f"{kinds[hole]} to {'profile' if across else 'bore'}"
        for step, side in ((6, 1.0), (18, -1.0)):
            apart = np.abs(seen.point[own][step] - centre) - radius
            apart[side * np.angle(centre / centre[hole]) < 1e-6] = np.inf
            pair = {kinds[hole], kinds[int(apart.argmin())]}
            between = "column to hole" if "column" in pair else "hole to hole"
            assert regions[own][step] == between
    # Six holes have a column on one side each, three columns holes on both.
    counts = dict(zip(*np.unique(regions, return_counts=True), strict=True))
    assert counts["column to hole"] == 2 * counts["hole to hole"]


def test_holes_for_columns_make_a_disc_give_more_under_any_forces() -> None:
    """The same loads and reactions on less material: no difference of energies is negative."""
    whole, narrow, wide = (disc_of_s(diameter)[1].matrix for diameter in (0.0, 3.0, 4.0))
    for one, other in ((whole, narrow), (narrow, wide)):
        assert (np.diag(other) > np.diag(one)).all()
        gained = np.linalg.eigvalsh(other - one)
        assert gained.min() > -3e-3 * gained.max()
    teeth = np.arange(0, 20 * PER_LOBE, 2)
    grown = np.diag(wide)[teeth].mean() / np.diag(whole)[teeth].mean()
    assert grown == pytest.approx(1.45, abs=0.03)
    for _, body in (disc_of_s(3.0), disc_of_s(4.0)):
        assert np.abs(body.matrix - body.matrix.T).max() <= 1e-9 * np.abs(body.matrix).max()
        assert body.reciprocity < 1e-9


def test_a_disc_of_few_columns_comes_from_the_standard_one_of_its_kind() -> None:
    """Three columns between six pins leave no turn that carries the disc into itself."""
    design = design_of_s(6, 3, 3.0)
    shape = DiscShape.from_design(design, 1)
    shape = replace(shape, side=1.5 * shape.side)
    assert shape.turns == 1
    bare = replace(shape, column_count=0)
    assert bare.turns == 2
    standard, turn, mirrored = shape.standard()
    assert (turn, mirrored) != (0.0, False)
    moved = np.exp(1j * turn) * (np.conj(shape.columns) if mirrored else shape.columns)
    assert np.abs(moved[:, None] - standard.columns).min(axis=1).max() < 1e-10
    ours, direct = of_standard(disc_body(standard), to_standard(shape)), disc_body(shape)
    assert np.abs(ours.matrix - direct.matrix).max() < 1e-2 * np.abs(direct.matrix).max()
    columns = slice(10 * PER_LOBE + 6 * PER_HOLE, None)
    assert ours.stress[columns] == pytest.approx(
        direct.stress[columns], abs=5e-2 * np.abs(direct.stress[columns]).max()
    )


def test_a_period_lasts_until_columns_stand_as_they_did() -> None:
    model = ContactModel.from_design(design_of_s(6, 3, 3.0))
    assert model.period == pytest.approx(2.0 * kinematics.mesh_period(10, 6))
    assert ContactModel.from_design(design_of_s()).period == kinematics.mesh_period(10, 5)
    turned = model.period * (1.0 + 1.0 / 10.0)
    # Seen from the disc the crank has turned by as much as carries columns into columns.
    assert math.remainder(turned, 2.0 * math.pi / 3.0) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    ("coarse", "within"), [(0.4e-3, 5e-2), pytest.param(0.2e-3, 3e-2, marks=pytest.mark.deep)]
)
@pytest.mark.parametrize("place", [3, pytest.param(10 * PER_LOBE + 6, marks=pytest.mark.deep)])
def test_stress_beside_columns_agrees_with_elongations_on_a_second_mesh(
    place: int, coarse: float, within: float
) -> None:
    """Under a force on a flank and in an output hole; at the holes of columns 3 mm thick."""
    shape = disc_of_s(3.0)[0]
    shape = replace(shape, bearing=replace(shape.bearing, raceway=shape.bearing.outer))
    ours = disc_body(shape).stress[:, 2 * place]
    patches = DiscPatches(shape, [place], 0.3e-3, coarse)
    at = shape.seen().point
    for column, centre in enumerate(shape.columns):
        edge = 1 + shape.hole_count + column
        own = len(shape.places()) + PER_HOLE * column + np.arange(PER_HOLE)
        own = own[np.abs(at[own] - at[place]) > 4e-3]
        expected = patches.stress_at(edge, centre, at[own])
        assert ours[own] == pytest.approx(expected, abs=within * float(np.abs(expected).max()))


def test_stress_beside_columns_rises_as_their_holes_grow() -> None:
    """Under the same forces of an equilibrium, which none of them is near."""
    model = ContactModel.from_design(design_of_s())
    states = nominal_states(model, perfect_angles(model, 24))
    sweep = contact_sweep(model, 90.0, states=states)
    forces = np.concatenate([sweep.ring_force, sweep.pin_force], axis=2)[:, 0]
    greatest: list[dict[str, float]] = []
    for diameter in (3.0, 4.0, 5.0):
        shape, body = disc_of_s(diameter)
        found = disc_stress(shape, body, model, states, 0, forces, sweep.cam_force[:, 0])
        regions = np.array(disc_regions(shape))
        assert not np.isnan(found[:, len(shape.places()) :]).any()
        greatest.append(
            {
                name: float(np.nanmax(np.abs(found[:, regions == name])))
                for name in ("column to profile", "column to bore")
            }
        )
    for less, more in itertools.pairwise(greatest):
        assert all(more[name] > 1.05 * less[name] for name in less)


def test_checks_and_picture_have_the_ligaments_of_columns(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(body_analysis, "_ANGLES", 16)
    machine = resolve(design_of_s(diameter=5.0))
    found = body_analysis.analyse_bodies(machine)
    regions = [one.region for one in found.peaks]
    # A column between every two pins: no hole has another hole beside it.
    assert {one for one in regions if one in LIGAMENTS} == {*LIGAMENTS} - {"hole to hole"}
    assert [one.region for one in found.swings] == regions
    for one in (*found.peaks, *found.swings):
        shape = DiscShape.from_design(machine.design, one.disc)
        if one.region in {"column to profile", "column to bore"}:
            on = np.abs(one.place - shape.columns).min()
            assert on == pytest.approx(shape.column_radius, rel=1e-9)
    assert len(found.picture.edges) == 1 + 5 + 5
    outlines = Outlines.from_design(machine.design, machine.cam)
    figure = stress_picture(found.picture, outlines).render()
    bare = replace(found.picture, edges=found.picture.edges[:6])
    assert figure.count("stressed") > stress_picture(bare, outlines).render().count("stressed")
    most = max(abs(found.peak(one).stress) for one in LIGAMENTS if one in regions)
    checks = {one.id: one for one in body_checks(machine.design, found)}
    assert checks["LIGAMENT-STRESS"].value == pytest.approx(most / 1e6)
    worse = replace(
        found,
        peaks=(*found.peaks, Peak("column to profile", 9e8, 90.0, 0.0, 0, 0j)),
        swings=(*found.swings, Swing("column to profile", -8e8, 8e8, 8e8, 0, 0j)),
    )
    for kind in ("STRESS", "FATIGUE"):
        told = {one.id: one for one in body_checks(machine.design, worse)}[f"LIGAMENT-{kind}"]
        assert "(column to profile)" in told.substituted
        assert told.remedy.startswith("lower carrier.column_diameter, or raise disc_thickness")


def test_columns_that_leave_too_little_are_a_sentence() -> None:
    """4 hundredths of a millimetre to the profile: holes that can be cut, and not be meshed."""
    design = design_of_s(diameter=6.5)
    with pytest.raises(GeometryError, match=r"0\.04\d* mm of material .* too thin"):
        elastic_bodies(design)
    checks, told = body_analysis.judged_or_told(resolve(design))[1:]
    assert checks == ()
    assert "no stress of discs and ring" in told[0]


def test_a_disc_of_very_many_holes_is_a_sentence() -> None:
    reducer = design_of_s().reducer
    pins = reducer.output_pins.unchecked_copy({"count": 30})
    carrier = reducer.carrier.unchecked_copy({"column_count": 30})
    reducer = reducer.unchecked_copy({"output_pins": pins, "carrier": carrier})
    many = design_of_s().unchecked_copy({"reducer": reducer})
    with pytest.raises(GeometryError, match="60 holes, 30 of them for columns, has more than"):
        DiscShape.from_design(many, 0)
