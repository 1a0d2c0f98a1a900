"""The contact equilibrium: balance in every state, energy, and agreement with a plain solution."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from contact_checks import BALANCE, assert_sound, cross, one_body, some_angles, swept
from contact_designs import (
    contact_designs,
    machine_of,
    paper_design,
    random_errors,
    torques,
    usual_torque,
)
from contact_oracle import solve
from examples import examples
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cqdd_design.design import Design
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.part_errors import GearboxErrors
from cqdd_design.gearbox.contact.sweep import (
    contact_sweep,
    output_turn_angles,
    perfect_angles,
)
from cqdd_design.gearbox.contact.sweep_kernel import predict
from cqdd_design.geometry import kinematics

LINE_MODELS = st.sampled_from(["palmgren", "johnson", "linear"])
SEEDS = st.integers(0, 2**32 - 1)
SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much]


# ------------------------------------------------------------------ balance


@settings(max_examples=examples(50), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), torques(), st.sampled_from(["palmgren", "linear"]), SEEDS)
def test_everything_balances_at_any_torque(
    design: Design, torque: float, line_model: str, seed: int
) -> None:
    model = ContactModel.from_design(design, line_model)
    assert_sound(swept(model, torque, some_angles(seed, model)))


@settings(max_examples=examples(20), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), st.floats(-4.0, 0.3), st.sampled_from([1.0, -1.0]), SEEDS)
def test_everything_balances_with_johnsons_law(
    design: Design, decade: float, sense: float, seed: int
) -> None:
    """Up to twice the usual load: far above, the contacts would be wider than the parts."""
    model = ContactModel.from_design(design, "johnson")
    torque = sense * usual_torque(model, 10.0**decade)
    assert_sound(swept(model, torque, some_angles(seed, model)))


@settings(max_examples=examples(30), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), torques(1e-3, 1e2), LINE_MODELS, st.floats(0.1e-6, 8e-6), SEEDS)
def test_everything_balances_with_part_errors(
    design: Design, torque: float, line_model: str, size: float, seed: int
) -> None:
    model = ContactModel.from_design(design, line_model)
    if line_model == "johnson":
        torque = math.copysign(usual_torque(model), torque)
    errors = random_errors(model, np.random.default_rng(seed), size)
    assert_sound(swept(model, torque, some_angles(seed, model), errors))


@pytest.mark.parametrize("torque", [5.0, -40.0, 120.0])
@pytest.mark.parametrize("line_model", ["palmgren", "johnson", "linear"])
def test_the_papers_gearbox_balances_over_its_period(torque: float, line_model: str) -> None:
    model = ContactModel.from_design(paper_design(), line_model)
    sweep = contact_sweep(model, torque)
    period = kinematics.mesh_period(10, 5)
    assert sweep.crank_angle[0] == 0.0
    assert sweep.crank_angle[-1] < period
    assert sweep.crank_angle[-1] + np.diff(sweep.crank_angle).max() > period * (1.0 - 1e-12)
    assert_sound(sweep)
    total = sweep.disc_torque.sum(axis=1)
    assert np.abs(np.abs(total) - abs(torque)).max() < 1e-9 * abs(torque)


@settings(max_examples=examples(16), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), torques(1e-2, 1e2), st.floats(6.0, 9.0), SEEDS)
def test_a_soft_carrier_bearing_balances_too(
    design: Design, torque: float, decade: float, seed: int
) -> None:
    model = replace(ContactModel.from_design(design), carrier_stiffness=10.0**decade)
    sweep = swept(model, torque, some_angles(seed, model, 3))
    assert_sound(sweep)
    pins = (sweep.pin_force[..., None] * sweep.pin_normal).sum(axis=(1, 2))
    spring = -model.carrier_stiffness * sweep.carrier_displacement
    load = np.abs(sweep.pin_force).max(axis=(1, 2))[:, None]
    assert (np.abs(spring - pins) / load).max() < BALANCE


# ------------------------------------------------------------------ against the plain solution


def assert_agrees(
    model: ContactModel,
    torque: float,
    crank: float,
    errors: GearboxErrors | None = None,
    tolerance: float = 1e-6,
) -> None:
    """Forces to 1e-6 of the load, displacements to 1e-6 of the greatest approach."""
    sweep = swept(model, torque, np.array([crank]), errors)
    plain = solve(machine_of(model, errors), crank, torque)
    assert plain.residual < 1e-7
    load = max(plain.ring_force.max(), plain.pin_force.max())
    assert np.abs(sweep.ring_force[0] - plain.ring_force).max() < tolerance * load
    assert np.abs(sweep.pin_force[0] - plain.pin_force).max() < tolerance * load
    assert np.abs(sweep.cam_force[0] - plain.cam_force).max() < tolerance * load
    assert np.abs(sweep.ring_normal[0] - plain.ring_normal).max() < 1e-8
    assert np.abs(sweep.pin_normal[0] - plain.pin_normal).max() < 1e-12
    assert np.abs(sweep.ring_point[0] - plain.ring_point).max() < 1e-9
    lag = np.mod(sweep.ring_parameter[0] - plain.ring_parameter + 1.0, 2.0 * math.pi) - 1.0
    assert np.abs(lag).max() < 1e-7
    size = 1e-10 + tolerance * np.abs(plain.displacement[:, :2]).max()
    assert sweep.carrier_angle_error[0] == pytest.approx(
        plain.gamma, rel=tolerance, abs=size / model.pin_circle_radius
    )
    work = abs(plain.energy + torque * plain.gamma) + abs(torque * plain.gamma)
    assert sweep.energy[0] == pytest.approx(plain.energy, abs=tolerance * work + 1e-18)
    # A disc that carries nothing may rest anywhere in its play: only loaded discs are compared.
    loaded = plain.ring_force.max(axis=1) > 1e-3 * load
    moved = sweep.disc_displacement[0] - plain.displacement
    assert np.abs(moved[loaded, :2]).max(initial=0.0) < 1e-9 + 1e-4 * size / tolerance
    assert sweep.stiffness[0] == pytest.approx(plain.stiffness, rel=1e-3)


@settings(max_examples=examples(30), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), torques(1e-2, 3e2), LINE_MODELS, st.floats(0.0, 60.0))
def test_forces_are_those_of_a_plain_minimisation(
    design: Design, torque: float, line_model: str, crank: float
) -> None:
    model = one_body(ContactModel.from_design(design, line_model))
    if line_model == "johnson":
        torque = math.copysign(usual_torque(model), torque)
    assert_agrees(model, torque, crank)


@settings(max_examples=examples(20), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), torques(1.0, 1e2), st.floats(0.0, 60.0), SEEDS)
def test_forces_with_part_errors_are_those_of_a_plain_minimisation(
    design: Design, torque: float, crank: float, seed: int
) -> None:
    model = one_body(ContactModel.from_design(design))
    errors = random_errors(model, np.random.default_rng(seed))
    assert_agrees(model, torque, crank, errors)


def test_the_papers_gearbox_at_many_states() -> None:
    model = one_body(ContactModel.from_design(paper_design()))
    for torque in (-120.0, -5.0, 0.5, 40.0, 120.0):
        for crank in (0.0, 0.7, 3.3):
            assert_agrees(model, torque, crank)
    assert_agrees(replace(model, carrier_stiffness=2e7), 40.0, 0.4)


@settings(max_examples=examples(20), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), torques(1e-2, 1e2), SEEDS)
def test_the_road_there_does_not_matter(design: Design, torque: float, seed: int) -> None:
    """Warm starts from a neighbour, from afar, or none at all: one equilibrium."""
    model = ContactModel.from_design(design)
    angles = some_angles(seed, model, 6)
    together = swept(model, torque, angles)
    backwards = contact_sweep(model, torque, angles[::-1].copy())
    load = together.ring_force.max()
    assert np.abs(backwards.ring_force[::-1] - together.ring_force).max() < 1e-7 * load
    for i, angle in enumerate(angles):
        alone = contact_sweep(model, torque, np.array([angle]))
        assert np.abs(alone.ring_force[0] - together.ring_force[i]).max() < 1e-7 * load
        assert np.abs(alone.pin_force[0] - together.pin_force[i]).max() < 1e-7 * load


# ------------------------------------------------------------------ energy


@settings(max_examples=examples(30), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(modified=False), torques(1e-3, 3e2), LINE_MODELS, SEEDS)
def test_the_crank_carries_torque_over_ratio_where_normals_are_nominal(
    design: Design, torque: float, line_model: str, seed: int
) -> None:
    """An equidistant offset keeps every normal through the pitch point: no ripple in statics."""
    model = ContactModel.from_design(design, line_model)
    if line_model == "johnson":
        torque = math.copysign(usual_torque(model), torque)
    sweep = swept(model, torque, some_angles(seed, model))
    crank = cross(sweep.disc_centre, sweep.cam_force).sum(axis=1)
    scale = np.hypot(sweep.cam_force[..., 0], sweep.cam_force[..., 1]).sum(axis=1)
    scale = scale * model.eccentricity + abs(torque) / model.lobe_count
    assert (np.abs(crank - torque / model.lobe_count) / scale).max() < 1e-8


def fourth_order(values: np.ndarray, step: float) -> np.ndarray:
    """Derivative from values at -2, -1, 1, 2 steps."""
    return (values[0] - 8.0 * values[1] + 8.0 * values[2] - values[3]) / (12.0 * step)


def slope_by_difference(
    model: ContactModel, torque: float, angle: np.ndarray, errors: GearboxErrors | None = None
) -> np.ndarray:
    """The energy's derivative from the energy itself, at two steps: the better agreed one."""
    found = []
    for step in (4e-4, 1e-4):
        shifted = [swept(model, torque, angle + k * step, errors).energy for k in (-2, -1, 1, 2)]
        found.append(fourth_order(np.array(shifted), step))
    return found[1]


@settings(max_examples=examples(24), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), torques(1e-1, 1e2), st.booleans(), SEEDS)
def test_energy_slope_is_the_derivative_of_the_energy(
    design: Design, torque: float, faulty: bool, seed: int
) -> None:
    model = ContactModel.from_design(design)
    errors = random_errors(model, np.random.default_rng(seed)) if faulty else None
    angle = some_angles(seed, model, 4)
    slope = swept(model, torque, angle, errors).energy_slope
    by_difference = slope_by_difference(model, torque, angle, errors)
    # Contacts that open within a step leave the difference a little rough.
    assert np.abs(slope - by_difference).max() < 2e-6 * abs(torque) / model.lobe_count


@settings(max_examples=examples(12), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(most_lobes=16), torques(1.0, 1e2))
def test_energy_slope_integrates_to_zero_over_the_period(design: Design, torque: float) -> None:
    model = ContactModel.from_design(design)
    sweep = swept(model, torque, perfect_angles(model, 5760))
    # Evenly spaced over a whole period, the mean is the integral.
    assert abs(sweep.energy_slope.mean()) < 1e-6 * abs(torque) / model.lobe_count


def test_energy_slope_integrates_to_zero_over_an_output_turn_with_errors() -> None:
    model = ContactModel.from_design(paper_design())
    errors = random_errors(model, np.random.default_rng(5), 2e-6)
    angle = output_turn_angles(model)
    assert len(angle) >= 8 * 10 * 11
    sweep = contact_sweep(model, 40.0, angle, errors=errors)
    assert_sound(sweep)
    assert abs(sweep.energy_slope.mean()) < 2e-6 * 40.0 / 10.0
    # The energy itself comes back: the sum of slopes is the change of energy between samples.
    step = angle[1] - angle[0]
    trapezoid = 0.5 * step * (sweep.energy_slope[1:] + sweep.energy_slope[:-1])
    change = np.diff(sweep.energy)
    assert np.abs(trapezoid - change).max() < 0.02 * np.ptp(sweep.energy)


# ------------------------------------------------------------------ period


@settings(max_examples=examples(24), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), torques(1e-1, 1e2), SEEDS)
def test_a_perfect_gearbox_repeats_after_its_mesh_period(
    design: Design, torque: float, seed: int
) -> None:
    model = ContactModel.from_design(design)
    n, pins = model.lobe_count, model.pin_count
    period = kinematics.mesh_period(n, pins)
    angle = some_angles(seed, model, 3)
    now = swept(model, torque, angle)
    later = swept(model, torque, angle + period)
    load = now.ring_force.max() + now.pin_force.max()
    assert np.abs(later.carrier_angle_error - now.carrier_angle_error).max() < 1e-8 * (
        np.abs(now.carrier_angle_error).max()
    )
    assert np.abs(later.energy_slope - now.energy_slope).max() < 1e-7 * abs(torque)
    # Teeth and pins change their names: each period turns the ring's pattern by whole teeth.
    teeth = round(period * (n + 1) / (2.0 * math.pi))
    assert teeth == pytest.approx(period * (n + 1) / (2.0 * math.pi), abs=1e-9)
    moved = np.roll(now.ring_force, teeth, axis=2)
    assert np.abs(later.ring_force - moved).max() < 1e-6 * load
    assert np.abs(np.sort(later.pin_force, axis=2) - np.sort(now.pin_force, axis=2)).max() < (
        1e-6 * load
    )


def test_a_gearbox_with_errors_repeats_only_after_an_output_turn() -> None:
    model = ContactModel.from_design(paper_design())
    errors = random_errors(model, np.random.default_rng(3), 3e-6)
    angle = np.array([0.3, 1.9])
    now = contact_sweep(model, 40.0, angle, errors=errors)
    turn = kinematics.imperfect_period(10)
    later = contact_sweep(model, 40.0, angle + turn, errors=errors)
    assert np.abs(later.ring_force - now.ring_force).max() < 1e-6 * now.ring_force.max()
    for part in (2.0 * math.pi, kinematics.mesh_period(10, 5), turn / 2.0):
        other = contact_sweep(model, 40.0, angle + part, errors=errors)
        gamma = other.carrier_angle_error - now.carrier_angle_error
        assert np.abs(gamma).max() > 1e-6


@pytest.mark.parametrize("known", [1, 2])
def test_a_state_that_turns_with_the_crank_is_its_own_start(known: int) -> None:
    """Discs carried round by the crank, turning evenly, are where the next angle is started."""
    turn, slow = 0.3, 1e-4 if known > 1 else 0.0
    carrier, offset = np.array([1e-6, -2e-6, 3e-5]), np.array([4e-6 + 1e-6j, -2e-6 + 5e-6j])

    def state(step: int) -> np.ndarray:
        centres = offset * np.exp(1j * turn * step)
        discs = np.column_stack([centres.real, centres.imag, np.full(2, slow * step)])
        return np.concatenate([carrier * (1.0 + slow * step), discs.ravel()])

    found = np.empty(9)
    predict(state(1), state(0), turn, known, found)
    np.testing.assert_allclose(found, state(2), rtol=0.0, atol=1e-18)
