"""The compiled equilibrium with friction: its plain twin, statics of every body, power, locking."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from contact_checks import BALANCE, cross, some_angles, swept
from contact_designs import contact_designs, paper_design, random_errors, usual_torque
from contact_friction_plain import BACKDRIVE, DRIVE, solve_friction_plain
from examples import examples
from hypothesis import HealthCheck, given, reject, settings
from hypothesis import strategies as st

from cqdd_design.design import Design
from cqdd_design.errors import ContactError
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.part_errors import GearboxErrors
from cqdd_design.gearbox.contact.rubbing import ContactFriction, PowerSense, rubbing, slip
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.contact.states import error_states, nominal_states
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles

SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much]
SENSES = st.sampled_from(["drive", "backdrive"])
SEEDS = st.integers(0, 2**32 - 1)
COEFFICIENTS = st.floats(0.0, 0.15)


def left_over(sweep: ContactSweep) -> float:
    """Greatest force and moment left on any disc, and on the carrier, over the load."""
    force, moment = sweep.cam_force.copy(), cross(sweep.disc_centre, sweep.cam_force)
    carrier = np.full(len(force), sweep.torque)
    for point, normal, pressed, rubbed, of_carrier in (
        (sweep.ring_point, sweep.ring_normal, sweep.ring_force, sweep.ring_tangential, False),
        (sweep.pin_point, sweep.pin_normal, sweep.pin_force, sweep.pin_tangential, True),
    ):
        tangent = np.stack([-normal[..., 1], normal[..., 0]], axis=-1)
        on_disc = pressed[..., None] * normal + rubbed[..., None] * tangent
        force = force + on_disc.sum(axis=2)
        turned = cross(point, on_disc).sum(axis=2)
        moment = moment + turned
        if of_carrier:
            carrier = carrier - turned.sum(axis=1)
    load = max(float(sweep.ring_force.max()), float(np.abs(sweep.cam_force).max()))
    arm = sweep.model.disc.ring_pitch_radius
    worst = (np.abs(force).max(), np.abs(moment).max() / arm, np.abs(carrier).max() / arm)
    return float(max(worst)) / load


def rubbed(
    model: ContactModel,
    torque: float,
    angle: np.ndarray,
    friction: ContactFriction,
    errors: GearboxErrors | None = None,
) -> ContactSweep:
    """A sweep with friction, unless it jams or moves too far, which is not what is tested."""
    swept(model, torque, angle, errors)
    try:
        return contact_sweep(model, torque, angle, errors=errors, friction=friction)
    except ContactError as error:
        if "jams" in error.message or "would have to move" in error.message:
            reject()
        raise


# ------------------------------------------------------------------ statics, power, directions


@settings(max_examples=examples(40), deadline=None, suppress_health_check=SLOW)
@given(
    contact_designs(),
    st.floats(-4.0, 0.3),
    st.sampled_from([1.0, -1.0]),
    COEFFICIENTS,
    COEFFICIENTS,
    SENSES,
    st.sampled_from(["palmgren", "linear", "johnson"]),
    st.sampled_from([None, 0.0, 5e6]),
    SEEDS,
)
def test_every_body_balances_and_only_friction_takes_power(
    design: Design,
    decade: float,
    way: float,
    tooth: float,
    pin: float,
    sense: PowerSense,
    line_model: str,
    bed: float | None,
    seed: int,
) -> None:
    model = replace(ContactModel.from_design(design, line_model), carrier_stiffness=bed)
    torque = way * usual_torque(model, 10.0**decade)
    friction = ContactFriction(sense, tooth, pin)
    sweep = rubbed(model, torque, some_angles(seed, model), friction)
    assert left_over(sweep) < BALANCE
    # Power in at one end is power out at the other and what the contacts turn into heat, but for
    # flanks that are not conjugate: they press or give way a little as the crank turns.
    states = nominal_states(model, sweep.crank_angle)
    opening = np.sum(sweep.ring_force * states.ring.rates[..., 2], axis=(1, 2))
    ideal = torque / model.lobe_count
    heat = friction.crank_sense(torque) * sweep.friction_work
    off = sweep.crank_torque - ideal + opening - heat
    assert np.abs(off).max() < 1e-9 * (abs(ideal) + np.abs(opening).max() + np.abs(heat).max())
    assert np.abs(sweep.disc_torque.sum(axis=1) - torque).max() < 1e-8 * abs(torque)


@settings(max_examples=examples(20), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), st.floats(-2.0, 0.0), COEFFICIENTS, SENSES, SEEDS)
def test_friction_of_parts_with_errors_balances(
    design: Design, decade: float, mu: float, sense: PowerSense, seed: int
) -> None:
    model = ContactModel.from_design(design)
    torque = usual_torque(model, 10.0**decade)
    errors = random_errors(model, np.random.default_rng(seed), 2e-6)
    friction = ContactFriction(sense, mu, mu)
    assert left_over(rubbed(model, torque, some_angles(seed, model), friction, errors)) < BALANCE


@settings(max_examples=examples(20), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), SEEDS)
def test_slip_is_that_of_points_carried_along_by_the_bodies(design: Design, seed: int) -> None:
    """Points fixed to disc and carrier, moved with their bodies by a small turn of the crank."""
    model = ContactModel.from_design(design)
    angle = some_angles(seed, model, 2)
    states = nominal_states(model, angle)
    sweep = swept(model, usual_torque(model), angle)
    n, step = model.lobe_count, 1e-6
    own = angle[:, None, None] + model.phases[:, None]
    centre = model.eccentricity * np.exp(1j * own)
    moved = model.eccentricity * np.exp(1j * (own + step))
    back = np.exp(-1j * step / n)
    found = slip(model, states)
    for part, point, turn in (
        (slice(None, model.tooth_count), sweep.ring_point, 1.0),
        (slice(model.tooth_count, None), sweep.pin_point, back),
    ):
        at = point[..., 0] + 1j * point[..., 1]
        of_disc = moved + (at - centre) * back
        along = states.rows[:, :, part, 0] + 1j * states.rows[:, :, part, 1]
        path = (of_disc - at * turn) * np.conj(1j * along)
        assert np.abs(path.real / step - found[:, :, part]).max() < 1e-5 * model.eccentricity


def test_friction_opposes_the_slip_of_either_sense() -> None:
    model = ContactModel.from_design(paper_design())
    states = nominal_states(model, perfect_angles(model, 7))
    for torque in (40.0, -40.0):
        for sense, turning in (("drive", 1.0), ("backdrive", -1.0)):
            share = rubbing(model, states, ContactFriction(sense, 0.1, 0.05), torque).share
            # The carrier turns against the crank: driven against its torque, or driving with it.
            carrier = -turning * math.copysign(1.0, torque)
            assert (carrier * torque < 0.0) == (sense == "drive")
            assert (share * slip(model, states) * -carrier).max() < 0.0
            assert set(np.unique(np.abs(share))) == {0.05, 0.1}


# ------------------------------------------------------------------ the same as other ways


@settings(max_examples=examples(8), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), st.floats(-1.0, 0.3), COEFFICIENTS, COEFFICIENTS, SENSES, SEEDS)
def test_the_plain_twin_finds_the_same(
    design: Design, decade: float, tooth: float, pin: float, sense: PowerSense, seed: int
) -> None:
    model = ContactModel.from_design(design)
    torque = usual_torque(model, 10.0**decade)
    angle = some_angles(seed, model, 2)
    errors = random_errors(model, np.random.default_rng(seed), 1e-6)
    smooth = swept(model, torque, angle, errors)
    sweep = rubbed(model, torque, angle, ContactFriction(sense, tooth, pin), errors)
    states = nominal_states(model, angle)
    changed = error_states(model, states, errors)
    way = DRIVE if sense == "drive" else BACKDRIVE
    scale = sweep.ring_force.max()
    for a in range(len(angle)):
        start = smooth.state_vectors[a]
        found = solve_friction_plain(model, states, changed, a, torque, (tooth, pin), way, start)
        assert found.reached == 1.0
        force = np.concatenate([sweep.ring_force[a], sweep.pin_force[a]], axis=1)
        along = np.concatenate([sweep.ring_tangential[a], sweep.pin_tangential[a]], axis=1)
        assert np.abs(force - found.force).max() < 1e-8 * scale
        assert np.abs(along - found.tangential).max() < 1e-8 * scale
        assert np.abs(sweep.cam_force[a] - found.cam_force).max() < 1e-8 * scale
        assert sweep.friction_work[a] == pytest.approx(found.friction_work, rel=1e-8, abs=1e-12)


@settings(max_examples=examples(15), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), st.floats(-2.0, 0.3), SENSES, SEEDS)
def test_no_friction_is_the_equilibrium_without_it(
    design: Design, decade: float, sense: PowerSense, seed: int
) -> None:
    model = ContactModel.from_design(design)
    torque = usual_torque(model, 10.0**decade)
    angle = some_angles(seed, model)
    smooth = swept(model, torque, angle)
    none = contact_sweep(model, torque, angle, friction=ContactFriction(sense, 0.0, 0.0))
    scale = smooth.ring_force.max()
    for name in ("ring_force", "pin_force", "cam_force"):
        assert np.abs(getattr(none, name) - getattr(smooth, name)).max() < 1e-9 * scale, name
    assert np.abs(none.stiffness / smooth.stiffness - 1.0).max() < 1e-6
    assert none.efficiency == 1.0
    assert not none.ring_tangential.any()


def test_stiffness_is_the_slope_of_torque_over_angle() -> None:
    model = ContactModel.from_design(paper_design())
    angle, friction = np.array([0.3]), ContactFriction("drive", 0.08, 0.08)
    low, mid, high = (
        contact_sweep(model, torque, angle, friction=friction) for torque in (39.99, 40.0, 40.01)
    )
    slope = 0.02 / (high.carrier_angle_error - low.carrier_angle_error)
    assert mid.stiffness == pytest.approx(slope, rel=1e-5)


# ------------------------------------------------------------------ locking and jamming


@pytest.mark.parametrize("torque", [40.0, -40.0])
def test_a_locked_gearbox_is_a_state_with_no_efficiency(torque: float) -> None:
    """More friction always leaves less at the crank; below nothing the carrier cannot turn it."""
    model = ContactModel.from_design(paper_design())
    angle = perfect_angles(model, 7)
    left, locked = [], []
    for mu in (0.05, 0.1, 0.2, 0.3, 0.4):
        sweep = contact_sweep(model, torque, angle, friction=ContactFriction("backdrive", mu, mu))
        assert left_over(sweep) < BALANCE
        crank = float(sweep.crank_torque.mean()) * math.copysign(1.0, torque)
        assert (sweep.efficiency > 0.0) == (crank > 0.0)
        left.append(crank)
        locked.append(sweep.efficiency == 0.0)
    assert left == sorted(left, reverse=True)
    assert locked == [False, False, False, locked[3], True]


def test_a_jam_is_a_sentence() -> None:
    model = ContactModel.from_design(paper_design())
    jamming = ContactFriction("drive", 1.0, 1.0)
    with pytest.raises(ContactError, match=r"friction of 1 at the teeth and 1 at the pins jams"):
        contact_sweep(model, 40.0, np.array([0.1]), friction=jamming)


# ------------------------------------------------------------------ what is told


def test_json_lets_a_reader_add_up_every_disc() -> None:
    model = ContactModel.from_design(paper_design())
    angle = perfect_angles(model, 5)
    friction = ContactFriction("backdrive", 0.08, 0.06)
    told = json.loads(json.dumps(contact_sweep(model, 40.0, angle, friction=friction).to_dict()))
    assert told["friction"] == "backdrive"
    total = np.asarray(told["cam_force_N"])
    for kind in ("ring", "output_pin"):
        normal = np.asarray(told[f"{kind}_normal"])
        pressed = np.asarray(told[f"{kind}_force_N"])[..., None] * normal
        tangent = np.stack([-normal[..., 1], normal[..., 0]], axis=-1)
        along = np.asarray(told[f"{kind}_tangential_N"])[..., None] * tangent
        total = total + (pressed + along).sum(axis=2)
    assert np.abs(total).max() < 1e-9 * told["cam_bearing_load_max_N"]
    without = contact_sweep(model, 40.0, angle).to_dict()
    assert without["friction"] == "off"
    assert without["efficiency"] == 1.0
    assert not np.any(without["ring_tangential_N"])
    assert not np.any(without["output_pin_tangential_N"])


@pytest.mark.parametrize("sense", ["drive", "backdrive"])
@pytest.mark.parametrize("torque", [40.0, -40.0])
def test_the_ripple_is_that_of_the_crank_torque(sense: PowerSense, torque: float) -> None:
    """By virtual work of the contacts, and read at the cams: two ways to one figure.

    The crank torque of the sweep is that of the nominal pose, so the cams' displacements add to
    it; what is left is of second order.
    """
    model = ContactModel.from_design(paper_design())
    friction = ContactFriction.of(model, sense)
    sweep = contact_sweep(model, torque, perfect_angles(model, 90), friction=friction)
    read = sweep.crank_torque
    assert read.mean() == pytest.approx(
        torque / 10.0 + friction.crank_sense(torque) * sweep.friction_work.mean(), rel=1e-9
    )
    assert sweep.crank_ripple == pytest.approx(read - read.mean(), abs=2e-3 * abs(read.mean()))
    assert np.ptp(sweep.crank_ripple) > 1e-3 * abs(read.mean())
