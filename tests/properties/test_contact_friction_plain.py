"""The plain equilibrium with friction: statics of every body, power, locking, published figures."""

from __future__ import annotations

import numpy as np
import pytest
from contact_checks import BALANCE, cross, some_angles, swept
from contact_designs import contact_designs, random_errors, usual_torque
from contact_friction_plain import (
    BACKDRIVE,
    DRIVE,
    PlainFriction,
    rubbing,
    solve_following,
    solve_friction_plain,
)
from examples import examples
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from reference_design import reference_s

from cqdd_design.design import Design
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.contact.states import NominalStates, error_states, nominal_states
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
from cqdd_design.gearbox.hertz import line_contact_pressure

SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much]
SENSES = st.sampled_from([DRIVE, BACKDRIVE])


def rubbed(
    sweep: ContactSweep, states: NominalStates, mu: tuple[float, float], sense: float
) -> list[PlainFriction]:
    """States with friction at every angle of a frictionless sweep of a perfect gearbox."""
    changed = error_states(sweep.model, states, None)
    start = sweep.state_vectors
    return [
        solve_friction_plain(sweep.model, states, changed, a, sweep.torque, mu, sense, start[a])
        for a in range(len(start))
    ]


def left_over(sweep: ContactSweep, a: int, found: PlainFriction) -> float:
    """Greatest force and moment left on any disc and the carrier over the greatest force.

    From the points and normals that a sweep reports, and none of the solver's own rows.
    """
    normal = np.concatenate([sweep.ring_normal[a], sweep.pin_normal[a]], axis=1)
    point = np.concatenate([sweep.ring_point[a], sweep.pin_point[a]], axis=1)
    tangent = np.stack([-normal[..., 1], normal[..., 0]], axis=-1)
    on_disc = found.force[..., None] * normal + found.tangential[..., None] * tangent
    teeth, cam = sweep.model.tooth_count, found.cam_force
    force = on_disc.sum(axis=1) + cam
    moment = cross(point, on_disc).sum(axis=1) + cross(sweep.disc_centre[a], cam)
    carrier = sweep.torque - cross(point[:, teeth:], on_disc[:, teeth:]).sum()
    load = max(float(found.force.max()), float(np.abs(cam).max()))
    arm = sweep.model.disc.ring_pitch_radius
    worst = (np.abs(force).max(), np.abs(moment).max() / arm, abs(float(carrier)) / arm)
    return float(max(worst)) / load


# ------------------------------------------------------------------ statics and power


@settings(max_examples=examples(12), deadline=None, suppress_health_check=SLOW)
@given(
    contact_designs(),
    st.floats(-2.0, 0.3),
    st.sampled_from([1.0, -1.0]),
    st.tuples(st.floats(0.0, 0.15), st.floats(0.0, 0.15)),
    SENSES,
    st.sampled_from(["palmgren", "linear", "johnson"]),
    st.integers(0, 2**32 - 1),
)
def test_every_body_balances_and_no_power_is_lost_but_by_friction(
    design: Design,
    decade: float,
    way: float,
    mu: tuple[float, float],
    sense: float,
    line_model: str,
    seed: int,
) -> None:
    model = ContactModel.from_design(design, line_model)
    torque = way * usual_torque(model, 10.0**decade)
    angle = some_angles(seed, model, 2)
    sweep = swept(model, torque, angle)
    states = nominal_states(model, angle)
    for a, found in enumerate(rubbed(sweep, states, mu, sense)):
        if found.reached < 1.0:
            continue
        assert found.force.min() >= 0.0
        assert left_over(sweep, a, found) < BALANCE
        slip = rubbing(model, states, a).slip * sense * way
        limit = np.where(np.arange(slip.shape[1]) < model.tooth_count, *mu) * found.force
        assert np.abs(np.abs(found.tangential) - limit).max() <= 1e-15 * found.force.max()
        assert (found.tangential * slip).max() <= 0.0
        # Flanks that are not conjugate press or give way a little as the crank turns.
        teeth = model.tooth_count
        pressed = float((found.force * states.rates[a, :, :, 2])[:, :teeth].sum())
        ideal = torque / model.lobe_count
        power = found.input_torque - ideal + pressed - way * sense * found.friction_work
        assert abs(power) < 1e-9 * (abs(ideal) + abs(pressed) + found.friction_work)


@settings(max_examples=examples(6), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), st.floats(-1.0, 0.3), SENSES, st.integers(0, 2**32 - 1))
def test_without_friction_it_is_the_compiled_equilibrium(
    design: Design, decade: float, sense: float, seed: int
) -> None:
    model = ContactModel.from_design(design)
    torque = usual_torque(model, 10.0**decade)
    angle = some_angles(seed, model, 2)
    errors = random_errors(model, np.random.default_rng(seed), 1e-6)
    sweep = swept(model, torque, angle, errors)
    states = nominal_states(model, angle)
    changed = error_states(model, states, errors)
    scale = sweep.ring_force.max()
    for a in range(len(angle)):
        start = sweep.state_vectors[a]
        found = solve_friction_plain(model, states, changed, a, torque, (0.0, 0.0), sense, start)
        assert found.reached == 1.0
        assert np.abs(found.tangential).max() == 0.0
        wanted = np.concatenate([sweep.ring_force[a], sweep.pin_force[a]], axis=1)
        assert np.abs(found.force - wanted).max() < 1e-9 * scale
        assert np.abs(found.cam_force - sweep.cam_force[a]).max() < 1e-9 * scale


# ------------------------------------------------------------------ the reference design


@pytest.mark.parametrize(
    ("torque", "growth", "pressure", "cam", "efficiency"),
    [(34.2, 1.11, 1054e6, 1155.0, 0.7725), (90.0, 1.13, 1610e6, 3081.0, 0.755)],
)
def test_reference_design_has_the_figures_of_a_second_implementation(
    torque: float, growth: float, pressure: float, cam: float, efficiency: float
) -> None:
    """Within 2 %: its normals follow the bodies, which is worth 1 to 3 % of a force."""
    model = reference_s()
    states = nominal_states(model, perfect_angles(model, 12))
    sweep = contact_sweep(model, torque, states=states)
    found = rubbed(sweep, states, (0.08, 0.08), DRIVE)
    force = np.array([one.force[:, : model.tooth_count] for one in found])
    radius, modulus = sweep.ring_equivalent_radius, model.ring_modulus
    pressed = line_contact_pressure(force, model.contact_length, radius, modulus)
    loads = [np.hypot(*one.cam_force.T).max() for one in found]
    spent = np.mean([one.input_torque for one in found])
    assert force.max() / sweep.ring_force.max() == pytest.approx(growth, rel=0.01)
    assert pressed.max() == pytest.approx(pressure, rel=0.005)
    assert max(loads) == pytest.approx(cam, rel=0.005)
    assert torque / model.lobe_count / spent == pytest.approx(efficiency, abs=0.002)


@pytest.mark.parametrize("mu", [0.0, 0.08])
def test_normals_that_follow_the_bodies_change_a_force_by_little(mu: float) -> None:
    """What the linearisation at the nominal pose leaves out, at the continuous torque."""
    model, torque = reference_s(), 34.2
    states = nominal_states(model, perfect_angles(model, 3))
    sweep = contact_sweep(model, torque, states=states)
    changed = error_states(model, states, None)
    nominal = rubbed(sweep, states, (mu, mu), DRIVE)
    scale = max(one.force.max() for one in nominal)
    for a, one in enumerate(nominal):
        moved = solve_following(model, states, changed, a, torque, (mu, mu), DRIVE, one.state)
        assert 1e-4 * scale < np.abs(moved.force - one.force).max() < 0.03 * scale


@pytest.mark.parametrize(
    ("torque", "cam", "efficiency"), [(34.2, 1155.0, 0.7725), (90.0, 3081.0, 0.755)]
)
def test_with_such_normals_the_second_implementation_agrees(
    torque: float, cam: float, efficiency: float
) -> None:
    model = reference_s()
    states = nominal_states(model, perfect_angles(model, 6))
    changed = error_states(model, states, None)
    sweep = contact_sweep(model, torque, states=states)
    start = sweep.state_vectors
    found = [
        solve_following(model, states, changed, a, torque, (0.08, 0.08), DRIVE, start[a])
        for a in range(len(start))
    ]
    spent = np.mean([one.input_torque for one in found])
    assert max(np.hypot(*one.cam_force.T).max() for one in found) == pytest.approx(cam, rel=1e-3)
    assert torque / model.lobe_count / spent == pytest.approx(efficiency, abs=5e-4)


def test_it_locks_where_friction_alone_can_hold_the_carrier() -> None:
    """The crank's torque falls through zero once; there the load stands with the crank let go."""
    model, torque = reference_s(), 34.2
    states = nominal_states(model, np.array([0.1]))
    sweep = contact_sweep(model, torque, states=states)
    low, high = 0.0, 0.4
    turned = [rubbed(sweep, states, (mu, mu), BACKDRIVE)[0] for mu in (0.1, 0.2, 0.3, 0.4)]
    out = [one.input_torque for one in turned]
    assert out == sorted(out, reverse=True)
    assert out[-2] > 0.0 > out[-1]
    for _ in range(40):
        middle = 0.5 * (low + high)
        held = rubbed(sweep, states, (middle, middle), BACKDRIVE)[0]
        low, high = (middle, high) if held.input_torque > 0.0 else (low, middle)
    # Balanced, within its friction cones at any greater coefficient, and nobody at the crank.
    assert left_over(sweep, 0, held) < BALANCE
    assert abs(held.input_torque) < 1e-9 * torque
    assert 0.3 < low < 0.35


def test_a_drive_that_jams_says_at_which_friction() -> None:
    """Friction at the teeth turns the disc against its load: at 0.58 no force carries it."""
    model, torque = reference_s(), 34.2
    states = nominal_states(model, np.array([0.1]))
    sweep = contact_sweep(model, torque, states=states)
    stopped = rubbed(sweep, states, (0.7, 0.7), DRIVE)[0]
    assert 0.7 * stopped.reached == pytest.approx(0.577, abs=0.005)
    assert stopped.force.max() > 10.0 * sweep.ring_force.max()
