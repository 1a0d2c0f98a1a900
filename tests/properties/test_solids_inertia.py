"""Reflected inertia against the kinetic energy of the moving parts, found another way."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from solids_designs import CHANGES, known_design, known_parts, part_named

from cqdd_design.catalog import find_bearing, find_motor
from cqdd_design.design import Design
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.machine import resolve
from cqdd_design.results import MassProperties
from cqdd_design.solids.counterweights import crank_moments
from cqdd_design.solids.mesh import mass_properties
from cqdd_design.solids.part import Part
from cqdd_design.solids.poses import SHAFT, Body, body_pose
from cqdd_design.solids.throw import throw_of

STEP = 1e-6


def kinetic_inertia(
    design: Design, own: MassProperties, body: Body, placement: FloatArray, angle: float
) -> float:
    """2 T / w^2 of a rigid body from two poses a small crank angle apart."""
    before, after = (
        body_pose(design, body, angle + sign * STEP) @ placement for sign in (-0.5, 0.5)
    )
    middle = body_pose(design, body, angle) @ placement
    velocity = (
        (after[:3, :3] @ own.centre + after[:3, 3]) - (before[:3, :3] @ own.centre + before[:3, 3])
    ) / STEP
    slip = (after[:3, :3] - before[:3, :3]) / STEP @ middle[:3, :3].T
    spin = np.array([slip[2, 1], slip[0, 2], slip[1, 0]])
    inertia = middle[:3, :3] @ own.inertia @ middle[:3, :3].T
    return float(own.mass * velocity @ velocity + spin @ inertia @ spin)


@pytest.mark.parametrize("name", CHANGES)
def test_reflected_inertia_is_twice_the_kinetic_energy(name: str) -> None:
    design, parts = known_design(name), known_parts(name)
    found = resolve(design).inertia
    for part, row in zip(parts, found.parts, strict=True):
        if part.inner_body is not None:
            continue
        # Parts off the axis of an orbiting body would change over the turn; take the mean.
        energy = [
            kinetic_inertia(design, part.exact_properties, piece.body, piece.placement, angle)
            for angle in np.linspace(0.0, 2.0 * np.pi, 9)[:-1]
            for piece in part.instances
        ]
        assert row.reflected == pytest.approx(sum(energy) / 8.0, rel=1e-6, abs=1e-16), part.name


@pytest.mark.parametrize("name", ["paper", "three discs"])
def test_a_bearing_counts_between_its_two_rings(name: str) -> None:
    design, parts = known_design(name), known_parts(name)
    found = resolve(design).inertia
    for part, row in zip(parts, found.parts, strict=True):
        if part.inner_body is None:
            continue
        lowest = highest = 0.0
        for piece in part.instances:
            with_outer = kinetic_inertia(
                design, part.exact_properties, piece.body, piece.placement, 0.3
            )
            # An orbiting bearing keeps its centre on the orbit whichever ring carries it.
            throw = design.reducer.eccentricity if piece.body.kind == "disc" else 0.0
            spin = part.exact_properties.inertia[2, 2]
            speed = 1.0 if part.inner_body == SHAFT else 1.0 / design.reducer.ratio
            with_inner = spin * speed**2 + part.exact_properties.mass * throw**2
            lowest += min(with_inner, with_outer)
            highest += max(with_inner, with_outer)
        assert lowest < row.reflected < highest, part.name


def test_sums_and_signs() -> None:
    design, parts = known_design("paper"), known_parts("paper")
    found = resolve(design).inertia
    rotor = find_motor("CubeMars RO100 Lite KV55").rotor_inertia
    assert found.rotor_inertia == rotor == 5.29e-4
    # Magnets and bell are drawn so that they have the catalogue's inertia together.
    assert found.rotor_drawn == pytest.approx(rotor, rel=1e-12)
    assert found.reflected_input == pytest.approx(sum(p.reflected for p in found.parts))
    assert found.gearbox_reflected == pytest.approx(found.reflected_input - rotor)
    assert sum(found.group_masses.values()) == pytest.approx(found.total.mass)
    assert sum(found.group_inertias.values()) == pytest.approx(found.reflected_input)
    assert found.group_masses["motor"] == pytest.approx(0.525)
    assert found.reflected_output == pytest.approx(100.0 * found.reflected_input)
    assert found.total.mass == pytest.approx(
        sum(row.count * row.properties.mass for row in found.parts)
    )
    still = {"ring", "ring dowel", "housing", "ring clamp", "output cover", "cover screw"}
    still |= {
        "output shim",
        "motor stator",
        "motor cover",
        "motor cover screw",
        "encoder board",
        "encoder screw",
    }
    assert {row.name for row in found.parts if row.reflected == 0.0} == still
    # Two opposed discs and a round shaft: what moves has its centre of mass on the axis.
    moving = MassProperties(0.0)
    for part in parts:
        for piece in part.instances:
            if piece.body.kind != "housing":
                pose = piece.pose(design)
                moving += part.exact_properties.moved(pose[:3, 3], pose[:3, :3])
    assert np.abs(moving.centre[:2]).max() < 1e-12


@pytest.mark.parametrize("name", CHANGES)
def test_the_balance_is_that_of_the_parts_as_drawn(name: str) -> None:
    """Closed forms without a layout against the first moments of every part that was built."""
    design, machine = known_design(name), resolve(known_design(name))
    static, couple = crank_moments(design, known_parts(name))
    middle = 0.5 * design.reducer.pack_length
    balance, throw = machine.balance, machine.balance.throw_mass * design.reducer.eccentricity
    assert balance.static_unbalance == pytest.approx(abs(static), abs=1e-12 * throw)
    about_the_middle = abs(couple - middle * static)
    assert balance.couple_unbalance == pytest.approx(about_the_middle, abs=1e-12 * throw * middle)


@pytest.mark.parametrize("designation", ["6710", "needle cage K20x24x10"])
def test_a_bearing_without_mass_and_one_without_rings_throw_what_is_drawn(designation: str) -> None:
    """An envelope stands for an unknown mass; the lobe is the raceway of a needle cage."""
    wide = {
        "reducer.ring_pitch_radius": 0.055,
        "reducer.ring.outer_diameter": 0.12,
        "reducer.disc_count": 1,
        "reducer.disc_thickness": 0.011,
        "reducer.output_pins.circle_radius": 0.039,
        "reducer.cam_bearing.designation": designation,
    }
    machine = resolve(known_design("paper").replacing(wide))
    static, _ = crank_moments(machine.design, machine.parts)
    assert machine.balance.static_unbalance == pytest.approx(abs(static), rel=1e-12)


def test_meshes_agree_with_the_closed_forms_of_the_balance() -> None:
    """Disc and lobe from their tessellation: 1e-4, the facets of the curves."""
    design, parts = known_design("one disc"), known_parts("one disc")
    disc = mass_properties(part_named(parts, "disc"))
    shaft = mass_properties(part_named(parts, "eccentric shaft"))
    bearing = find_bearing(design.reducer.cam_bearing.designation).mass
    meshed = (disc.mass + bearing) * design.reducer.eccentricity + shaft.mass * shaft.centre[0]
    assert resolve(design).balance.static_unbalance == pytest.approx(meshed, rel=1e-4)


def test_discs_weigh_on_the_input_by_orbit_and_spin() -> None:
    design, parts = known_design("paper"), known_parts("paper")
    disc = part_named(parts, "disc")
    row = next(one for one in resolve(design).inertia.parts if one.name == "disc")
    own = disc.exact_properties
    e, n = design.reducer.eccentricity, design.reducer.ratio
    assert row.reflected == pytest.approx(2.0 * (own.mass * e**2 + own.inertia[2, 2] / n**2))


def test_a_motor_without_rotor_inertia_is_told() -> None:
    design = known_design("paper").replacing({"motor.name": "CubeMars R100 KV90"})
    found = resolve(design).inertia
    assert found.rotor_inertia is None
    assert found.reflected_input is found.reflected_output is None
    assert found.to_dict()["reflected_inertia_input_kgm2"] is None
    assert found.gearbox_reflected > 0.0
    assert found.group_inertias["motor"] is None
    assert "of CubeMars R100 KV90 are not known" in found.warnings[0]
    assert "rotor inertia of CubeMars R100 KV90 is not known" in found.warnings[1]
    assert "not known" in found.inertia_scope
    assert resolve(known_design("paper")).inertia.warnings == ()


def test_the_eccentrics_take_part_in_the_balance() -> None:
    """A lobe as wide as its bearing, of the shaft's steel, at the eccentricity of every disc."""
    shaft = part_named(known_parts("one disc"), "eccentric shaft")
    bearing = find_bearing("6902")
    lobe = np.pi * (bearing.bore_diameter / 2.0) ** 2 * bearing.width * shaft.density
    for name in ("one disc", "paper"):
        machine = resolve(known_design(name))
        disc = part_named(known_parts(name), "disc").mass
        mass = disc + bearing.mass + lobe
        assert machine.balance.throw_mass == pytest.approx(mass, rel=1e-12)
    # Of one disc, what its shaft alone has off the axis.
    own = shaft.exact_properties
    throw = throw_of(known_design("one disc"), bearing).eccentric * 1.2e-3
    assert own.mass * own.centre[0] == pytest.approx(throw, rel=1e-9)
    assert throw == pytest.approx(lobe * 1.2e-3, rel=1e-12)


def test_eccentricity_and_density_have_their_effect() -> None:
    design = known_design("paper")

    def reflected(changes: dict[str, object]) -> dict[str, float]:
        changed = design.replacing(changes)
        rows = resolve(changed).inertia.parts
        return {row.name: row.reflected for row in rows}

    base, less = reflected({}), reflected({"reducer.eccentricity": 0.0014})
    assert less["cam bearing"] < base["cam bearing"]
    assert less["eccentric shaft"] != base["eccentric shaft"]
    bronze = reflected({"reducer.disc_material": "Bronze CuSn12"})
    assert bronze["disc"] / base["disc"] == pytest.approx(8800.0 / 7850.0)


def test_catalogue_mass_overrides_the_envelope() -> None:
    bearing = part_named(known_parts("paper"), "cam bearing")
    assert bearing.mass == pytest.approx(0.017)
    bare = dataclasses.replace(bearing, catalogue_mass=None)
    assert bare.mass == pytest.approx(bearing.shape.volume * 7810.0)
    assert isinstance(bare, Part)


def test_json_form_has_the_fixed_keys() -> None:
    found = resolve(known_design("paper")).inertia.to_dict()
    assert {
        "parts",
        "total_mass_kg",
        "reflected_inertia_input_kgm2",
        "reflected_inertia_output_kgm2",
    } <= set(found)
    rows = found["parts"]
    assert isinstance(rows, list)
    for row in rows:
        assert {
            "name",
            "material",
            "count",
            "volume_mm3",
            "mass_kg",
            "centre_of_mass_mm",
            "inertia_kgm2",
            "exact_volume_mm3",
        } <= set(row)
        assert row["volume_mm3"] == pytest.approx(row["exact_volume_mm3"], rel=2e-5)
        tensor = np.array(row["inertia_kgm2"])
        assert np.allclose(tensor, tensor.T, rtol=0.0, atol=1e-18)
        assert (np.linalg.eigvalsh(tensor) > 0.0).all()
