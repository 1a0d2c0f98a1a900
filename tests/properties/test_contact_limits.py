"""The contact engine at its limits: the rigid law, scaling, mirrors, signs of part errors."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from contact_checks import imbalance, one_body, some_angles, swept
from contact_designs import (
    contact_designs,
    paper_design,
    random_errors,
    torques,
    usual_torque,
)
from examples import examples
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cqdd_design.design import Design
from cqdd_design.gearbox import rigid
from cqdd_design.gearbox.contact.laws import CamSpring, LineLaw
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.part_errors import GearboxErrors
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
from cqdd_design.geometry import kinematics

SEEDS = st.integers(0, 2**32 - 1)
SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much]
LINEAR = LineLaw("linear")


def ideal(model: ContactModel, cam_stiffness: float = 1e17) -> ContactModel:
    """Equal linear springs, no clearance anywhere, rigid bearings."""
    return replace(
        one_body(model),
        disc=model.disc.unmodified,
        hole_radius=model.pin_contact_radius + model.eccentricity,
        sleeve_play=0.0,
        ring_law=LINEAR,
        pin_law=LINEAR,
        pin_series=np.zeros(model.disc_count),
        cam=CamSpring(cam_stiffness, 1.0, 0.0),
        carrier_stiffness=None,
    )


# ------------------------------------------------------------------ the rigid law


@settings(max_examples=examples(40), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), torques(1.0, 1e2), SEEDS)
def test_equal_linear_springs_without_clearance_share_by_the_rigid_law(
    design: Design, torque: float, seed: int
) -> None:
    """For one disc, and for each disc of several with the torque it was found to carry.

    From 1 N m on: a gap of zero is known to 1e-17 m, which on these springs is 1e-8 N.
    """
    model = ideal(ContactModel.from_design(design))
    angle = some_angles(seed, model)
    sweep = swept(model, torque, angle)
    n, phases = model.lobe_count, model.phases
    radius, e = model.disc.ring_pitch_radius, model.eccentricity
    for d in range(model.disc_count):
        clocking = model.hole_clocking + phases[d] / n
        for a in range(len(angle)):
            own = angle[a : a + 1] + phases[d]
            # The rigid law counts the torque the gearbox gives out; here it is what acts on it.
            share = -sweep.disc_torque[a, d]
            ring = rigid.ring_forces(n, radius, e, share, own)[0]
            pins = rigid.output_pin_forces(
                n, model.pin_count, model.pin_circle_radius, share, own, clocking
            )[0]
            assert np.abs(sweep.ring_force[a, d] - ring).max() < 1e-6 * ring.max()
            assert np.abs(sweep.pin_force[a, d] - pins).max() < 1e-6 * pins.max()
    if model.disc_count == 1:
        assert np.abs(sweep.disc_torque - torque).max() < 1e-9 * abs(torque)


def test_discs_of_an_ideal_stack_share_by_their_stiffness() -> None:
    """Two ideal discs at 180 degrees are not equally stiff at every angle, so not equally loaded.

    By the rigid law a disc turns gamma under k gamma (1/sum(ring arms^2) + 1/sum(pin arms^2))^-1.
    """
    model = ideal(ContactModel.from_design(paper_design()))
    angle = perfect_angles(model, 24)
    sweep = contact_sweep(model, 40.0, angle)
    n, k_ratio = 10, model.pin_coefficient() / float(model.ring_coefficient(np.ones(1))[0])
    stiff = []
    for phase in model.phases:
        own = angle + phase
        k1 = model.disc.shortening_coefficient
        arms = n * model.eccentricity * rigid.ring_directions(n, k1, own)[1]
        beta = kinematics.output_pin_angles(n, 5, model.hole_clocking + phase / n, own)
        pins = model.pin_circle_radius * np.sin(own[:, None] - beta)
        ring_side = (np.minimum(arms, 0.0) ** 2).sum(axis=1)
        pin_side = (np.minimum(pins, 0.0) ** 2).sum(axis=1)
        stiff.append(1.0 / (1.0 / ring_side + k_ratio / pin_side))
    share = np.array(stiff).T
    share /= share.sum(axis=1, keepdims=True)
    assert np.abs(sweep.disc_torque / 40.0 - share).max() < 1e-6
    assert np.abs(share - 0.5).max() > 0.005


# ------------------------------------------------------------------ scaling and mirrors


@settings(max_examples=examples(24), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), torques(1e-1, 1e2), st.floats(0.2, 5.0), SEEDS)
def test_linear_springs_scale_with_all_lengths(
    design: Design, torque: float, factor: float, seed: int
) -> None:
    """Lengths by s at equal stiffnesses: forces by s, same angles, torque and energy by s^2."""
    model = ContactModel.from_design(design, "linear")
    model = replace(model, cam=CamSpring(1e8, 1.0, model.cam.play))
    disc = model.disc
    larger = replace(
        model,
        disc=replace(
            disc,
            ring_pitch_radius=factor * disc.ring_pitch_radius,
            eccentricity=factor * disc.eccentricity,
            tooth_radius=factor * disc.tooth_radius,
            equidistant=factor * disc.equidistant,
            radial=factor * disc.radial,
        ),
        pin_circle_radius=factor * model.pin_circle_radius,
        hole_radius=factor * model.hole_radius,
        pin_contact_radius=factor * model.pin_contact_radius,
        sleeve_play=factor * model.sleeve_play,
        ring_pitch_radius=factor * model.ring_pitch_radius,
        eccentricity=factor * model.eccentricity,
        tooth_radius=factor * model.tooth_radius,
        cam=CamSpring(1e8, 1.0, factor * model.cam.play),
    )
    angle = some_angles(seed, model, 3)
    one, two = swept(model, torque, angle), swept(larger, factor**2 * torque, angle)
    load = one.ring_force.max()
    assert np.abs(two.ring_force / factor - one.ring_force).max() < 1e-7 * load
    assert np.abs(two.pin_force / factor - one.pin_force).max() < 1e-7 * load
    assert two.carrier_angle_error == pytest.approx(one.carrier_angle_error, rel=1e-8)
    assert two.energy / factor**2 == pytest.approx(one.energy, rel=1e-8)
    assert two.energy_slope / factor**2 == pytest.approx(
        one.energy_slope, rel=1e-6, abs=1e-8 * abs(torque)
    )
    # A linear contact that just touches has no stiffness of its own: it is there or not.
    at_all = np.concatenate([one.ring_force, one.pin_force], axis=2).reshape(len(angle), -1)
    clear = ~np.any((at_all > 0.0) & (at_all < 1e-7 * load), axis=1)
    at_all = np.concatenate([two.ring_force, two.pin_force], axis=2).reshape(len(angle), -1)
    clear &= ~np.any((at_all > 0.0) & (at_all < 1e-7 * factor * load), axis=1)
    assert two.stiffness[clear] / factor**2 == pytest.approx(one.stiffness[clear], rel=1e-6)


@settings(max_examples=examples(20), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(clearances=False, modified=False), torques(1.0, 1e2), st.floats(0.1, 1e2))
def test_without_clearance_linear_forces_follow_the_torque(
    design: Design, torque: float, factor: float
) -> None:
    model = ideal(ContactModel.from_design(design), cam_stiffness=1e8)
    angle = np.array([0.1, 1.7])
    one, two = swept(model, torque, angle), swept(model, factor * torque, angle)
    assert np.abs(two.ring_force / factor - one.ring_force).max() < 1e-7 * one.ring_force.max()
    assert two.carrier_angle_error / factor == pytest.approx(one.carrier_angle_error, rel=1e-7)
    assert two.energy / factor**2 == pytest.approx(one.energy, rel=1e-7)
    # A linear stack gives back half of what the torque puts in.
    assert one.energy == pytest.approx(-0.5 * torque * one.carrier_angle_error, rel=1e-7)
    assert one.stiffness == pytest.approx(torque / one.carrier_angle_error, rel=1e-6)


@settings(max_examples=examples(24), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), torques(1e-2, 1e2), st.sampled_from(["palmgren", "johnson"]), SEEDS)
def test_the_mirrored_gearbox_carries_the_mirrored_torque(
    design: Design, torque: float, line_model: str, seed: int
) -> None:
    """Mirrored about the x axis: angles, clocking and torque change sign, discs keep pace."""
    model = one_body(ContactModel.from_design(design, line_model))
    if line_model == "johnson":
        torque = math.copysign(usual_torque(model), torque)
    angle = some_angles(seed, model, 3)
    one = swept(model, torque, angle)
    # The stack's order along the pins is not mirrored, so each disc keeps its own pin compliance.
    discs = -np.arange(model.disc_count) % model.disc_count
    mirrored = replace(
        model, hole_clocking=-model.hole_clocking, pin_series=model.pin_series[discs]
    )
    two = swept(mirrored, -torque, -angle)
    teeth = -np.arange(model.tooth_count) % model.tooth_count
    pins = -np.arange(model.pin_count) % model.pin_count
    load = one.ring_force.max()
    assert np.abs(two.ring_force[:, discs][..., teeth] - one.ring_force).max() < 1e-6 * load
    assert np.abs(two.pin_force[:, discs][..., pins] - one.pin_force).max() < 1e-6 * load
    assert two.carrier_angle_error == pytest.approx(-one.carrier_angle_error, rel=1e-8)
    assert two.energy == pytest.approx(one.energy, rel=1e-8)
    assert two.energy_slope == pytest.approx(-one.energy_slope, rel=1e-5, abs=1e-8 * abs(torque))


@settings(max_examples=examples(24), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), st.booleans(), SEEDS)
def test_more_torque_turns_the_carrier_further(design: Design, faulty: bool, seed: int) -> None:
    model = ContactModel.from_design(design)
    errors = random_errors(model, np.random.default_rng(seed)) if faulty else None
    angle = some_angles(seed, model, 2)
    rated = usual_torque(model)
    ladder = rated * np.array([-2.0, -1.0, -0.1, -1e-3, 1e-3, 0.1, 1.0, 2.0])
    runs = [swept(model, float(torque), angle, errors) for torque in ladder]
    gamma = np.array([run.carrier_angle_error for run in runs])
    assert (np.diff(gamma, axis=0) > 0.0).all()
    # The potential is concave in the torque, with -gamma as its slope.
    energy = np.array([run.energy for run in runs])
    chord = np.diff(energy, axis=0) / np.diff(ladder)[:, None]
    slack = 1e-9 * np.abs(gamma).max()
    assert (chord <= -gamma[:-1] + slack).all()
    assert (chord >= -gamma[1:] - slack).all()


# ------------------------------------------------------------------ part errors


FIELDS = GearboxErrors._fields


def only(model: ContactModel, errors: GearboxErrors, name: str, factor: float) -> GearboxErrors:
    """The errors with everything but one field taken away, times a factor."""
    none = GearboxErrors.none(model, errors.disc_profile.shape[-1])
    return none._replace(**{name: factor * getattr(errors, name)})


def work_rate(sweep: ContactSweep, errors: GearboxErrors) -> float:
    """Work the forces of one state oppose to these errors: sum of force times closing, J.

    A tooth displaced along its force on the disc, or grown, closes its gap; so does material on
    the disc. A pin displaced along its force or grown closes; a hole opens. A cam displaced along
    its force presses, and half of a growing play is lost. A carrier off the ring's axis takes all
    pins along, and the cams half as far.
    """
    n = sweep.model.lobe_count
    ring = sweep.ring_force[0, ..., None] * sweep.ring_normal[0]
    pins = sweep.pin_force[0, ..., None] * sweep.pin_normal[0]
    turn = np.exp(-1j * sweep.crank_angle[0] / n)

    def seen(vectors: np.ndarray) -> np.ndarray:
        """From the frame of carrier or disc into the ring's."""
        turned = turn * (vectors[..., 0] + 1j * vectors[..., 1])
        return np.stack([turned.real, turned.imag], axis=-1)

    order = np.arange(1, errors.disc_profile.shape[-1] + 1)
    angle = sweep.ring_parameter[0][..., None] * order
    material = (
        np.cos(angle) * errors.disc_profile[:, None, 0]
        + np.sin(angle) * errors.disc_profile[:, None, 1]
    ).sum(axis=-1)
    own = sweep.crank_angle[0] + sweep.model.phases
    u = np.stack([np.cos(own), np.sin(own)], axis=-1)
    v = np.stack([-u[:, 1], u[:, 0]], axis=-1)
    cam = errors.cam_centre[:, :1] * u + errors.cam_centre[:, 1:] * v
    return float(
        (ring * errors.tooth_position).sum()
        + (sweep.ring_force[0] * (errors.tooth_radius + material)).sum()
        + (pins * (seen(errors.pin_position) - seen(errors.hole_position))).sum()
        + (sweep.pin_force[0] * (errors.pin_radius - errors.hole_radius)).sum()
        + (sweep.cam_force[0] * (cam + 0.5 * errors.output_axis)).sum()
        + (pins * errors.output_axis).sum()
        - 0.5 * (sweep.cam_load[0] * errors.cam_play).sum()
    )


@settings(max_examples=examples(24), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), st.sampled_from([1.0, -1.0]), st.floats(0.0, 30.0), SEEDS)
def test_every_part_error_does_its_work(
    design: Design, sense: float, crank: float, seed: int
) -> None:
    """Castigliano, field by field: the energy changes by force times closing.

    And the potential is convex in the gaps, so the forces meet a growing error with more, never
    with less.
    """
    model = ContactModel.from_design(design)
    torque, angle = sense * usual_torque(model), np.array([crank])
    errors = random_errors(model, np.random.default_rng(seed), 2e-6)
    errors = errors._replace(cam_play=np.abs(errors.cam_play))
    base = swept(model, torque, angle)
    # The work of two microns at the greatest force: what a wrong sign would be out by.
    scale = 2e-6 * max(base.ring_force.max(), base.pin_force.max())
    for name in FIELDS:
        alone = only(model, errors, name, 1.0)
        rate = work_rate(base, alone)
        step = 1e-3
        # A play cannot fall below zero, so it is only ever added to.
        behind = 0.0 if name == "cam_play" else -step
        energies = [
            swept(model, torque, angle, only(model, errors, name, s)).energy[0]
            for s in (behind, step)
        ]
        assert (energies[1] - energies[0]) / (step - behind) == pytest.approx(
            rate, rel=2e-3, abs=2e-3 * scale
        ), name
        after = swept(model, torque, angle, alone)
        assert work_rate(after, alone) >= rate - 1e-9 * scale, name
        assert imbalance(after) < 1e-9


def test_part_errors_of_the_papers_gearbox_act_as_a_machinist_expects() -> None:
    """Two microns on the feature that carries most."""
    model = ContactModel.from_design(paper_design())
    angle = np.array([0.5])
    base = contact_sweep(model, 40.0, angle)
    d, i = (int(k) for k in np.unravel_index(base.ring_force[0].argmax(), (2, 11)))
    p, j = (int(k) for k in np.unravel_index(base.pin_force[0].argmax(), (2, 5)))
    none = GearboxErrors.none(model, 1)

    def run(name: str, at: tuple[int, ...], value: object) -> ContactSweep:
        changed = getattr(none, name).copy()
        changed[at] = value
        return contact_sweep(model, 40.0, angle, errors=none._replace(**{name: changed}))

    tooth, pin = base.ring_force[0, d, i], base.pin_force[0, p, j]
    toward = 2e-6 * base.ring_normal[0, d, i]
    assert run("tooth_position", (i,), toward).ring_force[0, d, i] > 1.05 * tooth
    assert run("tooth_position", (i,), -toward).ring_force[0, d, i] < 0.95 * tooth
    assert run("tooth_radius", (i,), 2e-6).ring_force[0, d, i] > 1.05 * tooth
    across = np.array([-toward[1], toward[0]])
    assert run("tooth_position", (i,), across).ring_force[0, d, i] == pytest.approx(tooth, rel=0.02)
    assert run("hole_radius", (p, j), 2e-6).pin_force[0, p, j] < 0.98 * pin
    assert run("pin_radius", (j,), 2e-6).pin_force[0, p, j] > 1.02 * pin
    # A disc grown at every loaded tooth takes the torque earlier: the carrier lags behind less.
    t = float(base.ring_parameter[0, d, i])
    grown = run("disc_profile", (d, slice(None), 0), (2e-6 * math.cos(t), 2e-6 * math.sin(t)))
    assert grown.ring_force[0, d, i] > tooth
    assert abs(grown.disc_torque[0, d]) > abs(base.disc_torque[0, d])
    for name, at in (("tooth_radius", slice(None)), ("pin_radius", slice(None))):
        assert run(name, (at,), 2e-6).carrier_angle_error[0] < base.carrier_angle_error[0]
    looser = run("cam_play", (d,), 4e-6)
    assert looser.cam_load[0, d] < base.cam_load[0, d]
    assert looser.carrier_angle_error[0] > base.carrier_angle_error[0]


@settings(max_examples=examples(12), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), st.floats(0.0, 30.0), SEEDS)
def test_errors_of_no_size_are_no_errors(design: Design, crank: float, seed: int) -> None:
    model = ContactModel.from_design(design)
    torque, angle = usual_torque(model), np.array([crank])
    perfect = swept(model, torque, angle)
    none = swept(model, torque, angle, GearboxErrors.none(model, harmonics=5))
    assert np.array_equal(perfect.ring_force, none.ring_force)
    # A change of all parts alike is a change of the design.
    errors = GearboxErrors.none(model)
    grown = errors._replace(pin_radius=errors.pin_radius + 2e-6)
    by_error = swept(model, torque, angle, grown)
    by_design = swept(replace(model, hole_radius=model.hole_radius - 2e-6), torque, angle)
    assert np.abs(by_error.pin_force - by_design.pin_force).max() < 1e-4 * perfect.pin_force.max()
    played = errors._replace(cam_play=errors.cam_play + 4e-6)
    looser = replace(model, cam=replace(model.cam, play=model.cam.play + 4e-6))
    one, two = swept(model, torque, angle, played), swept(looser, torque, angle)
    assert np.abs(one.ring_force - two.ring_force).max() < 1e-7 * perfect.ring_force.max()


@settings(max_examples=examples(16), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), SEEDS)
def test_moving_the_whole_ring_moves_the_whole_mechanism(design: Design, seed: int) -> None:
    """Ring, cams and carrier displaced alike carry the same forces: errors compose as a motion."""
    model = ContactModel.from_design(design)
    torque = usual_torque(model)
    rng = np.random.default_rng(seed)
    angle = some_angles(seed, model, 1)
    shift = 3e-6 * rng.normal(size=2)
    errors = GearboxErrors.none(model)
    own = angle[0] + model.phases
    u = np.stack([np.cos(own), np.sin(own)], axis=-1)
    v = np.stack([-u[:, 1], u[:, 0]], axis=-1)
    back = np.exp(1j * angle[0] / model.lobe_count) * complex(*shift)
    together = errors._replace(
        tooth_position=errors.tooth_position + shift,
        cam_centre=np.stack([u @ shift, v @ shift], axis=-1),
        pin_position=errors.pin_position + np.array([back.real, back.imag]),
    )
    still, moved = swept(model, torque, angle), swept(model, torque, angle, together)
    load = still.ring_force.max()
    assert np.abs(moved.ring_force - still.ring_force).max() < 1e-6 * load
    assert np.abs(moved.cam_force - still.cam_force).max() < 1e-6 * load
    change = moved.disc_displacement[0, :, :2] - still.disc_displacement[0, :, :2]
    loaded = still.ring_force[0].max(axis=1) > 1e-3 * load
    assert np.abs(change[loaded] - shift).max() < 1e-9
