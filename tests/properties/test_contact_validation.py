"""The headline validations of the contact engine, whose figures docs/contact-model.md shows.

Each test records what it compared with, the worst difference it met and the bound it holds to;
`docs/build.py` runs this file and writes the table from those records.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from backlash_oracle import carrier_range
from contact_checks import imbalance
from contact_designs import ARCMIN, machine_of, paper_design, peer_design, random_errors, rigid_of
from contact_oracle import solve
from contact_plain import solve_plain

from cqdd_design.gearbox import rigid
from cqdd_design.gearbox.contact.laws import CamSpring, LineLaw
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.states import error_states, nominal_states
from cqdd_design.gearbox.contact.sweep import contact_sweep, output_turn_angles, perfect_angles
from cqdd_design.gearbox.losses import LossModel
from cqdd_design.gearbox.precision.backlash import backlash
from cqdd_design.geometry import kinematics
from cqdd_design.machine import resolve


def _models() -> list[ContactModel]:
    paper, peer = paper_design(), peer_design()
    return [
        ContactModel.from_design(paper),
        ContactModel.from_design(paper, "johnson"),
        ContactModel.from_design(paper.replacing({"reducer.disc_count": 1})),
        ContactModel.from_design(
            paper.replacing({"reducer.disc_count": 3, "reducer.carrier_bearing.stiffness": 2e8})
        ),
        ContactModel.from_design(peer),
    ]


def test_balance(validated: Callable[..., None]) -> None:
    rng = np.random.default_rng(1)
    worst = 0.0
    for model in _models():
        for torque in (1e-6, 5.0, -40.0, 120.0):
            worst = max(worst, imbalance(contact_sweep(model, torque)))
        errors = random_errors(model, rng, size=2e-6)
        worst = max(worst, imbalance(contact_sweep(model, 40.0, errors=errors)))
    validated(
        "balance of force and moment on every disc and the carrier, share of the load",
        "the reported forces, points and normals added up",
        worst,
        1e-9,
    )


def test_energy_slope_integrates_to_zero(validated: Callable[..., None]) -> None:
    worst = 0.0
    for model in _models():
        sweep = contact_sweep(model, 40.0, perfect_angles(model, 2880))
        period = kinematics.mesh_period(model.lobe_count, model.pin_count)
        size = np.abs(sweep.energy_slope).max()
        worst = max(worst, abs(sweep.energy_slope.mean()) / max(size, 40.0 / model.lobe_count))
        assert period > 0.0
    validated("energy derivative over a period, share of the input torque", "zero", worst, 1e-6)


def test_energy_slope_is_the_derivative(validated: Callable[..., None]) -> None:
    worst = 0.0
    step = 1e-5
    for model in _models():
        middle = perfect_angles(model, 40) + 0.01
        around = np.concatenate([[a - step, a, a + step] for a in middle])
        sweep = contact_sweep(model, 40.0, around)
        energy = sweep.energy.reshape(-1, 3)
        slope = sweep.energy_slope.reshape(-1, 3)[:, 1]
        found = (energy[:, 2] - energy[:, 0]) / (2.0 * step)
        worst = max(worst, float(np.abs(found - slope).max()) / 4.0)
    validated(
        "energy derivative, share of the input torque", "differences of the energy", worst, 1e-6
    )


def _rigid_limit(model: ContactModel) -> ContactModel:
    """The same gearbox on equal linear springs, without clearance, on rigid bearings."""
    pins_touch = model.pin_contact_radius + model.eccentricity
    return replace(
        model,
        disc=replace(model.disc, equidistant=0.0),
        hole_radius=pins_touch,
        ring_law=LineLaw("linear"),
        pin_law=LineLaw("linear"),
        pin_series=np.zeros(model.disc_count),
        cam=CamSpring(1e17, 1.0, 0.0),
    )


@pytest.mark.parametrize("discs", [1, 2, 3])
def test_rigid_limit(discs: int, validated: Callable[..., None]) -> None:
    design = paper_design().replacing({"reducer.disc_count": discs})
    model = _rigid_limit(ContactModel.from_design(design))
    sweep = contact_sweep(model, 40.0)
    worst = 0.0
    for d, phase in enumerate(model.phases):
        angle = sweep.crank_angle + phase
        for row, own in enumerate(angle):
            # Each disc with its own computed torque; the law's sense is the drive's.
            torque = -sweep.disc_torque[row, d]
            expected = rigid.ring_forces(
                model.lobe_count, model.disc.ring_pitch_radius, model.eccentricity, torque, [own]
            )[0]
            off = np.abs(sweep.ring_force[row, d] - expected).max()
            worst = max(worst, float(off / expected.max()))
    words = "one disc" if discs == 1 else f"each of {discs} discs with its own torque"
    validated(
        f"ring forces on equal linear springs without clearance, {words}",
        "the rigid law",
        worst,
        1e-6,
    )


def test_plain_twin(validated: Callable[..., None]) -> None:
    worst = 0.0
    for model in _models():
        states = nominal_states(model, np.array([0.1, 0.7]))
        perfect = error_states(model, states, None)
        sweep = contact_sweep(model, 40.0, states=states)
        plain = solve_plain(
            model,
            states.rows[1],
            states.gaps[1],
            states.coefficient[1],
            perfect.offset[1],
            perfect.half_play,
            40.0,
        )
        force = np.concatenate([sweep.ring_force, sweep.pin_force], axis=2)[1]
        worst = max(worst, float(np.abs(force - plain.force).max() / force.max()))
    validated("forces of the compiled kernel", "its plain numpy twin", worst, 1e-9)


def test_independent_minimisation(validated: Callable[..., None]) -> None:
    worst = 0.0
    for model in _models()[:3]:
        for crank in (0.3, 2.9):
            sweep = contact_sweep(model, 40.0, np.array([crank]))
            found = solve(machine_of(model), crank, 40.0)
            off = np.abs(np.asarray(found.ring_force) - sweep.ring_force[0]).max()
            worst = max(worst, float(off / sweep.ring_force.max()))
    validated("ring forces", "scipy minimising the energy, written from the equations", worst, 1e-6)


def test_backlash(validated: Callable[..., None]) -> None:
    worst = 0.0
    for model in (*_models()[:3], *_models()[4:]):
        for crank in (0.2, 1.9, 4.4):
            found = backlash(model, np.array([crank]))
            low, high = carrier_range(rigid_of(model), crank)
            worst = max(worst, abs(found.free[0] - (high - low)) / ARCMIN)
    validated("backlash, arcmin", "a search on the exact profile by linear programs", worst, 0.02)


def test_period(validated: Callable[..., None]) -> None:
    worst = 0.0
    for model in _models():
        period = kinematics.mesh_period(model.lobe_count, model.pin_count)
        angle = np.array([0.4])
        here = contact_sweep(model, 40.0, angle).carrier_angle_error
        there = contact_sweep(model, 40.0, angle + period).carrier_angle_error
        worst = max(worst, float(abs(here - there)[0]) / ARCMIN)
    validated("carrier angle one period later, arcmin", "the same", worst, 1e-6)


def test_input_torque(validated: Callable[..., None]) -> None:
    model = _models()[0]
    sweep = contact_sweep(model, 40.0, output_turn_angles(model, 97))
    x, f = sweep.disc_centre, sweep.cam_force
    cam = np.sum(x[..., 0] * f[..., 1] - x[..., 1] * f[..., 0], axis=1)
    worst = float(np.abs(cam - 40.0 / model.lobe_count).max() / 4.0)
    validated("moment of the cam forces on the crank", "T/n", worst, 1e-9)


def test_friction_of_the_ring(validated: Callable[..., None]) -> None:
    design = paper_design()
    model = _rigid_limit(ContactModel.from_design(design))
    machine = resolve(design).friction
    smooth = contact_sweep(model, 40.0)
    losses = LossModel.from_sweeps(machine, [smooth], [smooth]).at(100.0, 40.0)
    disc = model.disc
    closed = (
        4.0
        * design.reducer.friction.tooth
        * (disc.ring_pitch_radius - disc.tooth_radius)
        / (math.pi * model.lobe_count * model.eccentricity)
    )
    # Loss torque over output torque; the closed form takes sums over teeth as integrals.
    found = losses.by_source["ring_teeth"] / (40.0 * 100.0 / model.lobe_count)
    validated(
        "power lost at the teeth in the rigid limit by forces without friction, relative",
        "4 μ (R - r)/(π n e)",
        abs(found / closed - 1.0),
        1e-3,
    )
