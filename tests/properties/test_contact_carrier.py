"""The equilibrium with plate and cap apart: its plain twin, statics of every body, the design S."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from contact_carrier_plain import CarrierProblem, solve_carrier_plain
from contact_checks import BALANCE, cross, some_angles, swept
from contact_designs import contact_designs, random_errors, usual_torque
from examples import examples
from hypothesis import HealthCheck, given, reject, settings
from hypothesis import strategies as st
from reference_design import reference_s

from cqdd_design.errors import ContactError
from cqdd_design.gearbox.contact.compliant import (
    carrier_compliance,
    compliant_energy,
    compliant_slope,
    compliant_states,
)
from cqdd_design.gearbox.contact.kernel_values import SweepResult, YieldingResult
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.part_errors import GearboxErrors
from cqdd_design.gearbox.contact.pin_beam import PinBeam, PinEnd, pin_in_stack, pin_section
from cqdd_design.gearbox.contact.rubbing import ContactFriction, PowerSense, rubbing
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.contact.states import error_states, nominal_states
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
from cqdd_design.gearbox.hertz import line_contact_pressure

SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much]
SEEDS = st.integers(0, 2**32 - 1)
SENSES = st.sampled_from(["drive", "backdrive"])
ENDS: list[tuple[PinEnd, PinEnd]] = [
    ("clamped", "clamped"),
    ("clamped", "hinged"),
    ("bedded", "bedded"),
    ("clamped", "free"),
]


def beam_of(
    model: ContactModel, ends: tuple[PinEnd, PinEnd], diameter: float | None = None
) -> PinBeam:
    """A steel pin, of the contact's diameter, through a model's discs, in plates of 7075."""
    thick = diameter or 2.0 * model.pin_contact_radius
    section = pin_section(thick, 205e9, 0.29, 71.7e9)
    return pin_in_stack(model.disc_count, model.contact_length, 0.5e-3, section, ends)


def pin_of_s(ends: tuple[PinEnd, PinEnd], discs: int = 2) -> PinBeam:
    """A 4 mm shoulder screw of the reference design."""
    return beam_of(reference_s(discs), ends, 4e-3)


def held(beam: PinBeam) -> PinBeam:
    """The same pin between plates that are one body, without a force reaching another disc."""
    return PinBeam(
        np.ones_like(beam.at_plate),
        np.zeros_like(beam.at_cap),
        np.diag(np.diag(beam.influence)),
        0.0,
    )


def soft_bodies(model: ContactModel, count: int, size: float, seed: int) -> np.ndarray:
    """A symmetric positive compliance of every disc's contacts, (A, D, C, C), m/N."""
    rng = np.random.default_rng(seed)
    each = model.tooth_count + model.pin_count
    a = rng.normal(size=(count, model.disc_count, each, each)) / np.sqrt(each)
    return size * (a @ np.swapaxes(a, -1, -2))


def solved(sweep: ContactSweep) -> SweepResult:
    """A sweep of held plates as the kernel leaves it."""
    force = np.concatenate([sweep.ring_force, sweep.pin_force], axis=2)
    return SweepResult(
        sweep.state_vectors, force, sweep.cam_force, sweep.stiffness, np.zeros(len(force), int)
    )


def yielding(
    sweep: ContactSweep,
    beam: PinBeam,
    friction: ContactFriction | None = None,
    errors: GearboxErrors | None = None,
    bodies: np.ndarray | None = None,
) -> YieldingResult:
    """Equilibria from those of a sweep with held plates, its own or one with the friction."""
    start = sweep
    if friction is not None and friction.tooth < 0.5:
        start = contact_sweep(
            sweep.model, sweep.torque, sweep.crank_angle, errors=errors, friction=friction
        )
    model, states = sweep.model, nominal_states(sweep.model, sweep.crank_angle)
    changed = error_states(model, states, errors)
    compliance = carrier_compliance(model.pin_count, beam, bodies)
    return compliant_states(
        model, sweep.torque, states, changed, solved(start), compliance, friction
    )


def unless_it_jams(
    sweep: ContactSweep,
    beam: PinBeam,
    friction: ContactFriction | None,
    errors: GearboxErrors | None = None,
    bodies: np.ndarray | None = None,
) -> YieldingResult:
    """The same, unless friction jams it or it moves too far, which is not what is tested."""
    try:
        found = yielding(sweep, beam, friction, errors, bodies)
    except ContactError as error:
        told = ("no forces carry the load", "jams the gearbox", "would have to move")
        if friction is not None and any(words in error.message for words in told):
            reject()
        raise
    if np.abs(found.states).max() > 0.25 * sweep.model.eccentricity:
        reject()
    return found


def left_over(
    sweep: ContactSweep, found: YieldingResult, beam: PinBeam, friction: ContactFriction | None
) -> float:
    """Greatest force and moment left on a disc, plate or cap over the load.

    From the points and normals that a sweep reports, and none of the solver's own rows. The pins'
    share of a force that the cap gets, and the torque by which they bring it back.
    """
    model, teeth = sweep.model, sweep.model.tooth_count
    states = nominal_states(model, sweep.crank_angle)
    normal = np.concatenate([sweep.ring_normal, sweep.pin_normal], axis=2)
    point = np.concatenate([sweep.ring_point, sweep.pin_point], axis=2)
    share = np.zeros(found.force.shape)
    if friction is not None:
        share = rubbing(model, states, friction, sweep.torque).share
    tangent = np.stack([-normal[..., 1], normal[..., 0]], axis=-1)
    on_disc = found.force[..., None] * (normal + share[..., None] * tangent)
    force = on_disc.sum(axis=2) + found.cam_force
    moment = cross(point, on_disc).sum(axis=2) + cross(sweep.disc_centre, found.cam_force)
    taken = cross(point[:, :, teeth:], on_disc[:, :, teeth:]).sum(axis=2)
    radius = model.pin_circle_radius
    turned = (found.states[:, 3] - found.states[:, 2]) / radius
    back = model.pin_count * beam.joint * radius**2 * turned
    plate = sweep.torque - (taken * beam.at_plate).sum(axis=1) + back
    cap = (taken * beam.at_cap).sum(axis=1) + back
    load = max(float(found.force.max()), float(np.abs(found.cam_force).max()))
    arm = model.disc.ring_pitch_radius
    worst = (np.abs(force).max(), *(np.abs(m).max() / arm for m in (moment, plate, cap)))
    return float(max(worst)) / load


# ------------------------------------------------------------------ statics


@settings(max_examples=examples(120), deadline=None, suppress_health_check=SLOW)
@given(
    contact_designs(),
    st.floats(-3.0, 0.3),
    st.sampled_from([1.0, -1.0]),
    st.sampled_from([0.0, 0.0, 0.08]),
    SENSES,
    st.sampled_from(ENDS),
    st.sampled_from(["palmgren", "linear", "johnson"]),
    st.sampled_from([None, 5e6]),
    st.booleans(),
    SEEDS,
)
def test_every_body_balances(
    design: object,
    decade: float,
    way: float,
    mu: float,
    sense: PowerSense,
    ends: tuple[PinEnd, PinEnd],
    line_model: str,
    bed: float | None,
    soft: bool,
    seed: int,
) -> None:
    model = replace(ContactModel.from_design(design, line_model), carrier_stiffness=bed)  # type: ignore[arg-type]
    torque = way * usual_torque(model, 10.0**decade)
    angle = some_angles(seed, model)
    sweep = swept(model, torque, angle)
    beam = beam_of(model, ends)
    friction = ContactFriction(sense, mu, mu) if mu else None
    bodies = soft_bodies(model, len(angle), 3e-9, seed) if soft else None
    found = unless_it_jams(sweep, beam, friction, None, bodies)
    assert found.force.min() >= 0.0
    assert left_over(sweep, found, beam, friction) < BALANCE


# ------------------------------------------------------------------ the same as other ways


@settings(max_examples=examples(20), deadline=None, suppress_health_check=SLOW)
@given(
    contact_designs(),
    st.floats(-1.5, 0.3),
    st.sampled_from([0.0, 0.08]),
    SENSES,
    st.sampled_from(ENDS),
    st.booleans(),
    SEEDS,
)
def test_the_plain_twin_finds_the_same(
    design: object,
    decade: float,
    mu: float,
    sense: PowerSense,
    ends: tuple[PinEnd, PinEnd],
    soft: bool,
    seed: int,
) -> None:
    model = ContactModel.from_design(design)  # type: ignore[arg-type]
    torque = usual_torque(model, 10.0**decade)
    angle = some_angles(seed, model, 2)
    errors = random_errors(model, np.random.default_rng(seed), 1e-6)
    sweep = swept(model, torque, angle, errors)
    beam = beam_of(model, ends)
    friction = ContactFriction(sense, mu, mu) if mu else None
    bodies = soft_bodies(model, len(angle), 3e-9, seed) if soft else None
    if bodies is not None and friction is not None:
        # Forces along the tangents make it one-sided.
        bodies = bodies + 0.2 * (np.triu(bodies) - np.tril(bodies))
    found = unless_it_jams(sweep, beam, friction, errors, bodies)
    states = nominal_states(model, angle)
    changed = error_states(model, states, errors)
    share = rubbing(model, states, friction or ContactFriction(sense, 0.0, 0.0), torque).share
    each = states.gaps.shape[2]
    scale = found.force.max()
    for a in range(len(angle)):
        w = np.zeros((model.disc_count, each, model.disc_count, each))
        for d in range(model.disc_count if bodies is not None else 0):
            w[d, :, d] = bodies[a, d]  # type: ignore[index]
        problem = CarrierProblem(
            model, states, changed, a, torque, beam, friction=share[a], bodies=w
        )
        one = solve_carrier_plain(problem, sweep.state_vectors[a])
        assert one.reached == 1.0
        assert np.abs(one.balance).max() < 1e-9 * scale
        assert np.abs(found.force[a] - one.force).max() < 1e-8 * scale
        assert np.abs(found.cam_force[a] - one.cam_force).max() < 1e-8 * scale
        stiffness = found.torsional[a] * model.pin_circle_radius**2
        assert stiffness == pytest.approx(one.torsional, rel=1e-4, abs=1e-9 * abs(torque))


@settings(max_examples=examples(40), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), st.floats(-2.0, 0.3), st.sampled_from([0.0, 0.1]), SENSES, SEEDS)
def test_held_plates_and_rigid_bodies_are_the_former_equilibrium(
    design: object, decade: float, mu: float, sense: PowerSense, seed: int
) -> None:
    model = ContactModel.from_design(design)  # type: ignore[arg-type]
    torque = usual_torque(model, 10.0**decade)
    angle = some_angles(seed, model)
    smooth = swept(model, torque, angle)
    friction = ContactFriction(sense, mu, mu) if mu else None
    none = np.zeros(model.disc_count)
    lone = PinBeam(1.0 - none, none, np.diag(model.pin_series), 0.0)
    found = unless_it_jams(smooth, lone, friction)
    former = contact_sweep(model, torque, angle, friction=friction)
    wanted = np.concatenate([former.ring_force, former.pin_force], axis=2)
    scale = wanted.max()
    assert np.abs(found.force - wanted).max() < 1e-9 * scale
    assert np.abs(found.cam_force - former.cam_force).max() < 1e-9 * scale
    stiffness = found.torsional * model.pin_circle_radius**2
    assert stiffness == pytest.approx(former.stiffness, rel=1e-4)


def test_stiffness_is_the_slope_of_torque_over_the_plates_turn() -> None:
    model, angle = reference_s(), np.array([0.3])
    beam = pin_of_s(("clamped", "clamped"))
    low, mid, high = (
        yielding(contact_sweep(model, torque, angle), beam, ContactFriction("drive", 0.08, 0.08))
        for torque in (34.19, 34.2, 34.21)
    )
    radius = model.pin_circle_radius
    slope = 0.02 / (high.states[:, 2] - low.states[:, 2]) * radius
    assert mid.torsional * radius**2 == pytest.approx(slope, rel=1e-5)


@settings(max_examples=examples(20), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), st.floats(-1.0, 0.3), st.sampled_from(ENDS), SEEDS)
def test_work_at_held_motions_is_the_slope_of_the_energy(
    design: object, decade: float, ends: tuple[PinEnd, PinEnd], seed: int
) -> None:
    """By differences over crank angle: the envelope of the least energies."""
    model = ContactModel.from_design(design)  # type: ignore[arg-type]
    torque = usual_torque(model, 10.0**decade)
    errors = random_errors(model, np.random.default_rng(seed), 1e-6)
    step = 1e-4
    angle = float(some_angles(seed, model, 1)[0]) + step * np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
    beam = beam_of(model, ends)
    bodies = np.repeat(soft_bodies(model, 1, 3e-9, seed), len(angle), axis=0)
    found = unless_it_jams(swept(model, torque, angle, errors), beam, None, errors, bodies)
    states = nominal_states(model, angle)
    changed = error_states(model, states, errors)
    compliance = carrier_compliance(model.pin_count, beam, bodies)
    energy = compliant_energy(model, torque, states, compliance, found)
    slope = compliant_slope(model, states, changed, compliance, found)
    differences = (energy[0] - 8.0 * energy[1] + 8.0 * energy[3] - energy[4]) / (12.0 * step)
    assert slope[2] == pytest.approx(differences, abs=1e-6 * torque / model.lobe_count)


def test_a_drive_that_jams_says_so() -> None:
    model, angle = reference_s(), np.array([0.1])
    sweep = contact_sweep(model, 34.2, angle)
    jamming = ContactFriction("drive", 0.7, 0.7)
    with pytest.raises(ContactError, match=r"5\.72958 deg and 34\.2 N\*m no forces carry"):
        yielding(sweep, pin_of_s(("clamped", "clamped")), jamming)


# ------------------------------------------------------------------ the reference design

FIGURES = [
    ("clamped", 34.2, 1068e6, 1075.0, (0.60, 0.62)),
    ("clamped", 90.0, 1647e6, 2905.0, (0.60, 0.635)),
    ("hinged", 34.2, 1145e6, 1255.0, (0.695, 0.715)),
    ("hinged", 90.0, 1772e6, 3423.0, (0.725, 0.745)),
]


def shares(sweep: ContactSweep, found: YieldingResult) -> np.ndarray:
    """Torque of every disc over that of all, (A, D)."""
    teeth = sweep.model.tooth_count
    moment = cross(sweep.pin_point, found.force[:, :, teeth:, None] * sweep.pin_normal).sum(axis=2)
    return moment / sweep.torque


@pytest.mark.parametrize(("cap", "torque", "pressure", "load", "share"), FIGURES)
def test_reference_design_has_the_figures_of_a_second_implementation(
    cap: PinEnd, torque: float, pressure: float, load: float, share: tuple[float, float]
) -> None:
    """Within 2 %; its normals follow the bodies, and how its seats yield is not known."""
    model = reference_s()
    sweep = contact_sweep(model, torque, perfect_angles(model, 90))
    found = yielding(sweep, pin_of_s(("clamped", cap)))
    pressed = line_contact_pressure(
        found.force[:, :, : model.tooth_count],
        model.contact_length,
        sweep.ring_equivalent_radius,
        model.ring_modulus,
    )
    assert pressed.max() == pytest.approx(pressure, rel=0.02)
    assert np.hypot(*np.moveaxis(found.cam_force, -1, 0)).max() == pytest.approx(load, rel=0.02)
    first = shares(sweep, found)[:, 0]
    assert share[0] - 0.01 < first.min()
    assert first.max() < share[1] + 0.01


def test_what_a_cap_that_also_moves_sideways_would_change() -> None:
    """Discs that share unevenly push the cap sideways: S from 61:39 to 67:33, if nothing holds it.

    The second implementation's cap turns alone, as ours does; a bearing or columns hold it so.
    """
    model, torque = reference_s(), 34.2
    sweep = contact_sweep(model, torque, perfect_angles(model, 3))
    states = nominal_states(model, sweep.crank_angle)
    changed = error_states(model, states, None)
    beam = pin_of_s(("clamped", "clamped"))
    first = []
    for floating in (False, True):
        one = [
            solve_carrier_plain(
                CarrierProblem(model, states, changed, a, torque, beam, floating=floating), start
            )
            for a, start in enumerate(sweep.state_vectors)
        ]
        force = np.array([state.force for state in one])[:, :, model.tooth_count :, None]
        moment = cross(sweep.pin_point, force * sweep.pin_normal).sum(axis=2)
        first.append(float(moment[:, 0].mean()) / torque)
    assert first[0] == pytest.approx(0.608, abs=0.004)
    assert first[1] == pytest.approx(0.665, abs=0.004)


def test_reference_design_as_a_cantilever() -> None:
    model = reference_s()
    sweep = contact_sweep(model, 34.2, perfect_angles(model, 30))
    first = shares(sweep, yielding(sweep, pin_of_s(("clamped", "free"))))[:, 0]
    assert first.mean() == pytest.approx(0.82, rel=0.02)


def test_reference_design_between_held_plates() -> None:
    """Pins hinged in plates of one body, disc by disc: what the design had, to 1e-9."""
    model = reference_s()
    beam = held(pin_of_s(("hinged", "hinged")))
    for torque, pressure, load in ((34.2, 998.8e6, 901.1), (90.0, 1512.2e6, 2334.8)):
        sweep = contact_sweep(model, torque, perfect_angles(model, 360))
        found = yielding(sweep, beam)
        wanted = np.concatenate([sweep.ring_force, sweep.pin_force], axis=2)
        assert np.abs(found.force - wanted).max() < 1e-9 * wanted.max()
        assert np.abs(found.cam_force - sweep.cam_force).max() < 1e-9 * wanted.max()
        assert sweep.ring_pressure.max() == pytest.approx(pressure, rel=1e-4)
        assert sweep.cam_load.max() == pytest.approx(load, rel=1e-4)


def test_columns_that_stiffen_the_cap_bring_even_shares_back() -> None:
    """The cap of S on springs beside its pins: shares go from those of the pins alone to even."""
    model = reference_s()
    sweep = contact_sweep(model, 34.2, perfect_angles(model, 6))
    beam = pin_of_s(("clamped", "clamped"))
    first = [
        shares(sweep, yielding(sweep, replace(beam, joint=factor * beam.joint)))[:, 0].mean()
        for factor in (1.0, 3.0, 10.0, 1e4)
    ]
    assert first == sorted(first, reverse=True)
    assert first[0] > 0.6
    assert first[-1] == pytest.approx(0.5, abs=0.003)


@pytest.mark.parametrize("discs", [1, 2, 3])
def test_one_to_three_discs(discs: int) -> None:
    """The middle disc of three hangs on both plates alike; one disc bears all."""
    model = reference_s(discs)
    sweep = contact_sweep(model, 34.2, perfect_angles(model, 12))
    friction = ContactFriction("drive", 0.08, 0.08)
    beam = pin_of_s(("clamped", "clamped"), discs)
    found = yielding(sweep, beam, friction)
    assert left_over(sweep, found, beam, friction) < BALANCE
    if discs == 3:
        assert beam.at_cap[1] == pytest.approx(0.5, rel=1e-12)
    # The cap always gives way: the plate turns further than the cap under the plate's torque.
    assert np.all(found.states[:, 2] > found.states[:, 3])
