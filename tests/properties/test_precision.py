"""Backlash, lost motion, stiffness, transmission error and ripple, each by another road."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from backlash_oracle import DiscGaps, Rigid, carrier_range
from contact_checks import some_angles, swept
from contact_designs import (
    ARCMIN,
    contact_designs,
    machine_of,
    paper_design,
    random_errors,
    rigid_of,
    usual_torque,
)
from contact_oracle import solve
from examples import examples
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from scipy import optimize

from cqdd_design.design import Design
from cqdd_design.errors import ContactError, CqddError
from cqdd_design.gearbox.contact.gaps_kernel import fill_errors
from cqdd_design.gearbox.contact.kernel_values import Toleranced
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.part_errors import GearboxErrors
from cqdd_design.gearbox.contact.rubbing import ContactFriction
from cqdd_design.gearbox.contact.states import error_states
from cqdd_design.gearbox.contact.sweep import contact_sweep, output_turn_angles, perfect_angles
from cqdd_design.gearbox.precision.backlash import backlash
from cqdd_design.gearbox.precision.backlash_kernel import OVERLAP
from cqdd_design.gearbox.precision.orders import order_spectrum
from cqdd_design.gearbox.precision.precision import precision
from cqdd_design.gearbox.tolerance.draws import draw_errors
from cqdd_design.gearbox.tolerance.evaluate import (
    OUTPUTS,
    ensemble_tables,
    evaluate_gearboxes,
    nominal_of,
)
from cqdd_design.geometry import kinematics

SEEDS = st.integers(0, 2**32 - 1)
SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much]
AGREED = 0.02 * ARCMIN


# ------------------------------------------------------------------ backlash


def assert_backlash(
    model: ContactModel,
    crank: float,
    errors: GearboxErrors | None = None,
    tolerance: float = AGREED,
) -> None:
    found = backlash(model, np.array([crank]), errors=errors)
    try:
        low, high = carrier_range(rigid_of(model, errors), crank)
    except ValueError:
        # No pose is free: no backlash either, but for what second-order errors could free.
        assert found.free[0] < tolerance
        return
    if high < low:
        # Each disc is free by itself, but not at the same carrier angle.
        assert found.free[0] < tolerance
        return
    # Second and third orders count once parts move by tenths of a millimetre.
    tolerance = max(tolerance, 3e-4 * max(high - low - 15.0 * ARCMIN, 0.0))
    assert found.free[0] == pytest.approx(high - low, abs=tolerance)
    if not found.preloaded:
        assert found.least[0] == pytest.approx(low, abs=tolerance)
        assert found.greatest[0] == pytest.approx(high, abs=tolerance)


@settings(max_examples=examples(24), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), st.floats(0.0, 60.0))
def test_backlash_is_that_of_a_search_on_the_exact_profile(design: Design, crank: float) -> None:
    assert_backlash(ContactModel.from_design(design), crank)


@settings(max_examples=examples(16), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), st.floats(0.0, 60.0), st.floats(0.2e-6, 2e-6), SEEDS)
def test_backlash_with_part_errors_is_that_of_the_search(
    design: Design, crank: float, size: float, seed: int
) -> None:
    model = ContactModel.from_design(design)
    # A looser gearbox, so that most draws leave some play.
    model = replace(
        model,
        hole_radius=model.hole_radius + 10e-6,
        cam=replace(model.cam, play=model.cam.play + 10e-6),
        disc=replace(model.disc, equidistant=model.disc.equidistant + 8e-6),
    )
    # Errors count to first order: waves of twelve to the turn would need the second.
    errors = random_errors(model, np.random.default_rng(seed), size, harmonics=5)
    assert_backlash(model, crank, errors, tolerance=2.0 * AGREED)


def test_backlash_of_the_papers_gearbox() -> None:
    """To a hundredth of what is asked, at angles all over the period, one to three discs."""
    for discs in (1, 2, 3):
        model = ContactModel.from_design(paper_design().replacing({"reducer.disc_count": discs}))
        for crank in (0.0, 0.37, 0.9, 4.0):
            assert_backlash(model, crank, tolerance=2e-4 * ARCMIN)


@pytest.mark.parametrize(
    "changes",
    [
        {"reducer.modification.radial": 20e-6},
        {"reducer.modification.rotation": 2e-4},
        {"reducer.modification.equidistant": 60e-6, "reducer.output_pins.hole_clearance": 150e-6},
        {"reducer.cam_bearing.radial_clearance": 80e-6},
        {"reducer.output_pins.count": 3},
        {"reducer.modification.equidistant": 0.0},
        {"reducer.output_pins.hole_clearance": 0.0},
        {"reducer.cam_bearing.radial_clearance": 0.0},
    ],
)
def test_backlash_far_from_the_papers_clearances(changes: dict[str, object]) -> None:
    model = ContactModel.from_design(paper_design().replacing(changes))
    for crank in (0.1, 2.2):
        assert_backlash(model, crank)


def test_the_two_searches_agree_with_each_other() -> None:
    """Successive linear programs and SLSQP: two oracles that share only the gaps."""
    stack = rigid_of(ContactModel.from_design(paper_design()))
    for crank in (0.0, 1.1):
        one, two = carrier_range(stack, crank), carrier_range(stack, crank, "slsqp")
        assert one == pytest.approx(two, abs=1e-5 * ARCMIN)


def test_the_searches_gaps_are_distances_to_the_profile() -> None:
    """Derivatives by differences, and distances by brute force over the profile."""
    stack = rigid_of(ContactModel.from_design(paper_design()))
    gaps = DiscGaps(stack, 0.7, 1)
    v = np.array([1.2, -0.8, 3.0, -12.0])
    values, rows = gaps(v)
    for k in range(4):
        step = np.eye(4)[k] * 1e-2
        assert (gaps(v + step)[0] - gaps(v - step)[0]) / 2e-2 == pytest.approx(rows[:, k], abs=1e-5)
    disc, arm = stack.disc, stack.pin_circle_radius
    t = np.linspace(0.0, 2.0 * math.pi, 400_001)
    own = 0.7 + math.pi
    outline = (disc.flank(t) @ np.array([1.0, 1j])) * np.exp(1j * (3e-6 / arm - own / 10.0))
    outline = outline + disc.eccentricity * np.exp(1j * own) + 1.2e-6 - 0.8e-6j
    teeth = disc.ring_pitch_radius * np.exp(2j * math.pi * np.arange(11) / 11)
    nearest = np.abs(outline[:, None] - teeth).min(axis=0) - disc.tooth_radius
    assert values[:11] * 1e-6 == pytest.approx(nearest, abs=1e-10)


@settings(max_examples=examples(20), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), st.floats(0.0, 60.0), st.floats(1e-6, 20e-6))
def test_more_clearance_is_more_backlash(design: Design, crank: float, more: float) -> None:
    model = ContactModel.from_design(design)
    at = np.array([crank])
    base = float(backlash(model, at).free[0])
    assert base >= 0.0
    looser = (
        replace(model, hole_radius=model.hole_radius + more),
        replace(model, cam=replace(model.cam, play=model.cam.play + more)),
        replace(model, disc=replace(model.disc, equidistant=model.disc.equidistant + more)),
    )
    for one in looser:
        assert float(backlash(one, at).free[0]) >= base - 1e-5 * ARCMIN
    # All of it at once is felt, whatever held the carrier before.
    everything = replace(looser[0], cam=looser[1].cam, disc=looser[2].disc)
    assert float(backlash(everything, at).free[0]) > base + 1e-3 * more / model.pin_circle_radius


@settings(max_examples=examples(16), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(disc_counts=(2, 3)), st.floats(0.0, 60.0))
def test_a_stack_is_as_free_as_its_discs_allow_together(design: Design, crank: float) -> None:
    """The intersection: never freer than any of its discs alone."""
    model = ContactModel.from_design(design)
    whole = backlash(model, np.array([crank]))
    low, high = [], []
    for phase in model.phases:
        # Disc at phase p: the single disc at crank phi + p, its carrier p/n further on.
        alone = replace(
            model,
            disc_count=1,
            hole_clocking=model.hole_clocking + phase / model.lobe_count,
            pin_series=model.pin_series[:1],
        )
        ends = backlash(alone, np.array([crank + phase]))
        low.append(ends.least[0])
        high.append(ends.greatest[0])
    together = min(high) - max(low)
    assert whole.free[0] == pytest.approx(max(together, 0.0), abs=2e-3 * ARCMIN)


@settings(max_examples=examples(12), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), st.floats(0.0, 60.0))
def test_backlash_is_where_vanishing_torques_hold_the_carrier(design: Design, crank: float) -> None:
    """The elastic carrier at a tiny torque stands at the ends of the rigid range.

    The elastic model has one linearisation, the rigid one has many: they differ by second order.
    """
    model = ContactModel.from_design(design)
    ends = backlash(model, np.array([crank]))
    assume(ends.free[0] > 0.1 * ARCMIN)
    tiny = 1e-7 * usual_torque(model)
    ahead = swept(model, tiny, np.array([crank])).carrier_angle_error[0]
    behind = swept(model, -tiny, np.array([crank])).carrier_angle_error[0]
    size = 0.03 * ends.free[0] + 0.01 * ARCMIN
    assert ahead == pytest.approx(ends.greatest[0], abs=size)
    assert behind == pytest.approx(ends.least[0], abs=size)


def test_no_clearance_no_backlash() -> None:
    design = paper_design().replacing(
        {
            "reducer.modification.equidistant": 0.0,
            "reducer.output_pins.hole_clearance": 0.0,
            "reducer.cam_bearing.radial_clearance": 0.0,
        }
    )
    found = backlash(ContactModel.from_design(design), np.linspace(0.0, 3.0, 7))
    assert found.free.max() < 1e-3 * ARCMIN
    assert not found.preloaded


def test_parts_pressed_from_both_sides_leave_no_backlash() -> None:
    """Holes so small that they draw the discs into the teeth."""
    changes = {"reducer.output_pins.hole_clearance": -20e-6}
    model = ContactModel.from_design(paper_design().replacing(changes))
    found = backlash(model, np.linspace(0.0, 1.1, 5))
    assert found.preloaded
    assert found.free.max() == 0.0
    assert np.isfinite(found.overlap).all()
    assert found.overlap.min() > 1e-7


def pressed(stack: Rigid, phi: float, carrier: float) -> float:
    """Least sum of the squares of all overlaps with the carrier held at an angle (rad), um^2."""
    gamma = carrier * stack.pin_circle_radius * 1e6
    least = 0.0
    for index in range(stack.disc_count):
        gaps = DiscGaps(stack, phi, index)

        def overlaps(pose: np.ndarray, gaps: DiscGaps = gaps) -> np.ndarray:
            off = float(np.hypot(*(pose[:2] - gaps.cam))) - 1e6 * gaps.half_play
            return np.maximum([*-gaps(np.append(pose, gamma))[0], off], 0.0)

        found = optimize.least_squares(overlaps, np.zeros(3), xtol=1e-14, ftol=1e-14, gtol=1e-14)
        least += 2.0 * found.cost
    return least


@pytest.mark.parametrize(
    ("gap", "clearance", "least"), [(-3e-6, 60e-6, 8.0), (6e-6, -10e-6, 1.5), (6e-6, -6e-6, 1.5)]
)
def test_what_is_pressed_leaves_other_joints_their_play(
    gap: float, clearance: float, least: float
) -> None:
    """Ends by an own search: up to them no joint is pressed more, beyond them some are."""
    changes = {
        "reducer.modification.equidistant": gap,
        "reducer.output_pins.hole_clearance": clearance,
    }
    model = ContactModel.from_design(paper_design().replacing(changes))
    found = backlash(model, np.array([0.4]))
    assert found.preloaded
    assert found.free[0] > least * ARCMIN
    assert_pressed_alike(rigid_of(model), 0.4, found.least[0], found.greatest[0])


def assert_pressed_alike(stack: Rigid, crank: float, low: float, high: float) -> None:
    """Overlaps are the same all over a range, but for a little, and grow beyond it."""
    rest = pressed(stack, crank, 0.5 * (low + high))
    micron = 1e-6 / stack.pin_circle_radius
    inside = min(micron, 0.4 * (high - low))
    for end, outward in ((low, -1.0), (high, 1.0)):
        within = pressed(stack, crank, end - outward * inside)
        assert within <= 1.05 * rest + 0.02
        assert pressed(stack, crank, end + outward * micron) > within + 0.05


@pytest.mark.parametrize("hole_clearance", [16e-6, 200e-6])
def test_backlash_goes_on_where_the_last_gap_at_the_teeth_is_gone(hole_clearance: float) -> None:
    """From 0.1 um of gap to 0.1 um of overlap, and at none at all, which many teeth share."""
    found = []
    for gap in (1e-7, 1e-8, 0.0, -1e-8, -1e-7):
        changes = {
            "reducer.modification.equidistant": gap,
            "reducer.output_pins.hole_clearance": hole_clearance,
        }
        model = ContactModel.from_design(paper_design().replacing(changes))
        found.append(backlash(model, perfect_angles(model, 72)).mean / ARCMIN)
    assert np.all(np.diff(found) < 1e-3)
    assert max(found) - min(found) < 0.09
    assert min(found) > 3.8


def test_parts_too_loose_for_a_backlash() -> None:
    model = ContactModel.from_design(
        paper_design().replacing({"reducer.output_pins.hole_clearance": 1000e-6})
    )
    try:
        found = backlash(model, np.linspace(0.0, 1.1, 3))
    except ContactError as error:
        told = error.message
    else:
        low, high = carrier_range(rigid_of(model), 0.0)
        assert found.free[0] == pytest.approx(high - low, rel=1e-3)
        return
    assert "loose" in told


def test_play_is_total_play() -> None:
    """ISO 5753: the centre may move by half of it either way."""
    stack = rigid_of(ContactModel.from_design(paper_design()))
    none = Rigid(**{**vars(stack), "cam_play": 0.0})
    gaps = DiscGaps(stack, 0.0, 0)
    assert gaps.half_play == 2.5e-6
    model = ContactModel.from_design(
        paper_design().replacing({"reducer.cam_bearing.radial_clearance": 0.0})
    )
    low, high = carrier_range(none, 0.3)
    assert backlash(model, np.array([0.3])).free[0] == pytest.approx(high - low, abs=AGREED)


def test_backlash_repeats_after_the_mesh_period() -> None:
    model = ContactModel.from_design(paper_design())
    angle = some_angles(4, model, 4)
    period = kinematics.mesh_period(10, 5)
    assert backlash(model, angle + period).free == pytest.approx(
        backlash(model, angle).free, abs=1e-6 * ARCMIN
    )


@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(seed, marks=pytest.mark.deep) for seed in (1, 2, 3))]
)
def test_backlash_of_drawn_gearboxes_is_that_of_the_search(seed: int) -> None:
    """Line to line: some angles are free by microns, some pressed, and all must be told.

    Errors count to first order, which leaves tens of nanometres, and what overlaps by no more than
    `OVERLAP` counts as touching: the range lies between those of the search with holes smaller and
    larger by as much.
    """
    design, left_out = paper_design(), OVERLAP
    model = ContactModel.from_design(design)
    errors = draw_errors(model, design.tolerances, seed, 0, 1).one(0)
    angle = np.linspace(0.0, 20.0 * math.pi, 9, endpoint=False)
    found = backlash(model, angle, errors=errors)
    for a, crank in enumerate(angle):
        least = searched(model, errors, crank, -left_out)
        most = searched(model, errors, crank, left_out)
        if least > 0.0:
            assert found.overlap[a] < found.preload_limit
        if most > 0.0:
            assert least - AGREED <= found.free[a] <= most + AGREED
        else:
            ends = found.least[a], found.greatest[a]
            assert_pressed_alike(rigid_of(model, errors), crank, *ends)


@pytest.mark.parametrize(("seed", "place"), [(5, 21), (7, 21)])
def test_ends_of_a_shallow_valley_are_where_it_gets_steep(seed: int, place: int) -> None:
    """Pressed flanks that bend over the range would hold the carrier in its middle."""
    design = paper_design()
    model = ContactModel.from_design(design)
    errors = draw_errors(model, design.tolerances, 0, seed, 1).one(0)
    crank = output_turn_angles(model, 88)[[place]]
    found = backlash(model, crank, errors=errors)
    assert found.preloaded
    assert found.free[0] > 1.5 * ARCMIN
    ends = found.least[0], found.greatest[0]
    assert_pressed_alike(rigid_of(model, errors), float(crank[0]), *ends)


def searched(model: ContactModel, errors: GearboxErrors, crank: float, larger: float) -> float:
    """Backlash by the search with all holes' radii larger, rad."""
    loose = replace(model, hole_radius=model.hole_radius + larger)
    try:
        low, high = carrier_range(rigid_of(loose, errors), crank)
    except ValueError:
        return 0.0
    return max(high - low, 0.0)


# ------------------------------------------------------------------ ensembles


def test_an_ensemble_gives_what_its_gearboxes_give_alone() -> None:
    """Each output of the batch kernel from sweeps and backlash of every gearbox by itself."""

    model = ContactModel.from_design(paper_design())
    rng = np.random.default_rng(11)
    drawn = [random_errors(model, rng, size) for size in (0.5e-6, 1.5e-6, 3e-6)]
    batch = GearboxErrors(*(np.stack(fields) for fields in zip(*drawn, strict=True)))
    tables = ensemble_tables(model, 40.0)
    values = evaluate_gearboxes(tables, batch, threads=2)
    assert np.array_equal(values, evaluate_gearboxes(tables, batch, threads=1))
    angle = output_turn_angles(model)
    assert len(angle) == 880
    friction = ContactFriction.of(model, "drive")
    for row, errors in zip(values, drawn, strict=True):
        told = dict(zip(OUTPUTS, row, strict=True))
        full = contact_sweep(model, 40.0, angle, errors=errors, friction=friction)
        half = contact_sweep(model, 20.0, angle, errors=errors, friction=friction)
        gamma = full.carrier_angle_error
        expected = {
            "backlash_arcmin": backlash(model, angle, errors=errors).mean / ARCMIN,
            "transmission_error_pp_arcmin": np.ptp(gamma) / ARCMIN,
            "ring_force_max_N": full.ring_force.max(),
            "stiffness_Nm_per_arcmin": 20.0 / (gamma - half.carrier_angle_error).mean() * ARCMIN,
            "torque_ripple_pp_Nm": 10.0 * np.ptp(full.crank_ripple),
            "ring_pressure_max_MPa": full.ring_pressure.max() / 1e6,
            "cam_bearing_load_max_N": full.cam_load.max(),
        }
        # The ensemble's backlash sees flanks as osculating circles, at every thirteenth angle.
        some = angle[tables.start.marked][tables.start.thinned]
        coarse = backlash(model, some, errors=errors).mean / ARCMIN
        assert told["backlash_arcmin"] == pytest.approx(coarse, abs=0.02)
        assert told["backlash_arcmin"] == pytest.approx(expected.pop("backlash_arcmin"), abs=0.1)
        for name, value in expected.items():
            # The stiffness is a mean, which fewer angles give nearly as well.
            tolerance = 8e-3 if name.startswith("stiffness") else 1e-4
            assert told[name] == pytest.approx(value, rel=tolerance), name


def test_a_tight_gearbox_takes_a_torque_to_turn_and_a_loose_one_none() -> None:
    """Forces without load from sweeps of their own, friction laid over them by hand."""
    tight = paper_design().replacing(
        {
            "reducer.modification.equidistant": -4e-6,
            "reducer.output_pins.hole_clearance": -6e-6,
            "reducer.cam_bearing.radial_clearance": 0.0,
        }
    )
    for design, binds in ((paper_design(), False), (tight, True)):
        model = ContactModel.from_design(design)
        errors = random_errors(model, np.random.default_rng(2), 0.2e-6)
        batch = GearboxErrors(*(field[None] for field in errors))
        tables = ensemble_tables(model, 40.0, 88)
        told = dict(zip(OUTPUTS, evaluate_gearboxes(tables, batch)[0], strict=True))
        assert (told["unloaded_torque_Nm"] > 0.0) == binds
        assert (told["preload_force_max_N"] > 0.0) == binds
        if not binds:
            continue
        angle = tables.states.crank_angle[tables.start.marked]
        # Without load but for a thousandth of it, which gives what hangs loose its place.
        sweep = contact_sweep(model, 0.04, angle, errors=errors)
        force = np.concatenate([sweep.ring_force, sweep.pin_force], axis=2)
        assert told["preload_force_max_N"] == pytest.approx(force.max(), rel=1e-6)
        # At a pin by e (1 + 1/n), at a tooth by its distance from the pitch point over n.
        at_pins = 1.1 * 1.6e-3 * sweep.pin_force.sum(axis=(1, 2))
        pitch = 11.0 * sweep.disc_centre[:, :, None]
        arm = np.abs(np.sum((sweep.ring_point - pitch) * sweep.ring_normal, axis=-1)) / 10.0
        work = 0.08 * (at_pins + np.sum(sweep.ring_force * arm, axis=(1, 2)))
        wanted = 10.0 * (sweep.energy_slope + work).max()
        assert told["unloaded_torque_Nm"] == pytest.approx(wanted, rel=1e-5)


def test_the_ripple_of_a_gearbox_is_that_of_its_energy() -> None:
    """n times the derivative of the resampled potential, by a spectral derivative."""

    model = ContactModel.from_design(paper_design())
    errors = random_errors(model, np.random.default_rng(2), 2e-6)
    angle = output_turn_angles(model, 16 * 880)
    sweep = contact_sweep(model, 40.0, angle, errors=errors)
    order = np.fft.rfftfreq(len(angle), 1.0 / len(angle)) / 10.0
    spectral = np.fft.irfft(1j * order * np.fft.rfft(sweep.energy), len(angle))
    assert np.abs(spectral - sweep.energy_slope).max() < 5e-3 * np.ptp(sweep.energy_slope)
    ripple = 10.0 * np.ptp(sweep.energy_slope)
    assert 10.0 * np.ptp(spectral) == pytest.approx(ripple, rel=5e-3)


# ------------------------------------------------------------------ precision of one gearbox


@pytest.mark.deep
def test_precision_of_the_papers_gearbox_by_other_roads() -> None:
    """Every figure again: from the exact search, the plain minimisation, and bare sweeps."""
    model = replace(ContactModel.from_design(paper_design()), pin=None)
    found = precision(model, 40.0)
    told = found.to_dict()
    period = kinematics.mesh_period(10, 5)
    angle = period * np.arange(12) / 12
    # Twelve of 360 angles: three to a tooth, five to a pin, which give the means.
    ends = np.array([carrier_range(rigid_of(model), float(phi)) for phi in angle])
    free = (ends[:, 1] - ends[:, 0]) / ARCMIN
    assert told["backlash_arcmin"] == pytest.approx(free.mean(), abs=0.01)
    assert free.min() > told["backlash_min_arcmin"] - 0.001
    assert free.max() < told["backlash_max_arcmin"] + 0.001

    machine = machine_of(model)

    def plain(torque: float) -> np.ndarray:
        return np.array([solve(machine, float(phi), torque).gamma for phi in angle])

    windup = plain(40.0)
    assert told["stiffness_Nm_per_rad"] == pytest.approx(
        20.0 / (windup - plain(20.0)).mean(), rel=2e-3
    )
    assert told["stiffness_Nm_per_arcmin"] == pytest.approx(
        told["stiffness_Nm_per_rad"] * ARCMIN, rel=1e-12
    )
    assert told["lost_motion_arcmin"] == pytest.approx(
        (plain(1.2) - plain(-1.2)).mean() / ARCMIN, rel=2e-3
    )
    at = np.rint(angle / period * 360.0).astype(int)
    assert found.loaded[at] == pytest.approx(windup, rel=1e-6)
    assert found.unloaded[at] == pytest.approx(ends[:, 1], abs=1e-4 * ARCMIN)
    assert np.ptp(windup) <= found.transmission_error * (1.0 + 1e-9)
    assert told["transmission_error_pp_arcmin"] == pytest.approx(0.139, abs=0.002)
    # The ripple from the energy of the plain minimisation.
    step = 1e-4
    for phi in angle[:4]:
        ahead, behind = (solve(machine, float(phi) + s, 40.0).energy for s in (step, -step))
        index = round(float(phi) / period * 360.0)
        assert found.ripple[index] == pytest.approx(
            10.0 * (ahead - behind) / (2.0 * step), abs=2e-4
        )
    assert told["torque_ripple_pp_Nm"] == pytest.approx(np.ptp(found.ripple), rel=1e-12)


@settings(max_examples=examples(10), deadline=None, suppress_health_check=SLOW)
@given(contact_designs(), st.sampled_from([None, 2e-6]), SEEDS)
def test_precision_figures_hang_together(design: Design, size: float | None, seed: int) -> None:
    design = design if size is None or design.reducer.ratio < 12 else paper_design()
    model = ContactModel.from_design(design)
    torque = 0.3 * usual_torque(model)
    errors = None if size is None else random_errors(model, np.random.default_rng(seed), size)
    try:
        found = precision(model, torque, angles=120, errors=errors)
    except ContactError as error:
        assume("would have to move" not in error.message and "loose" not in error.message)
        raise
    told = found.to_dict()
    json.dumps(told, allow_nan=False)
    assert 0.0 <= told["backlash_min_arcmin"] <= told["backlash_arcmin"]
    assert told["backlash_arcmin"] <= told["backlash_max_arcmin"]
    # Between plus and minus 3 % of the torque the clearance is used up and a little more.
    assert told["lost_motion_arcmin"] > told["backlash_arcmin"] - 0.05
    assert told["stiffness_Nm_per_rad"] > 0.0
    windup = [point.windup for point in found.curve]
    assert (np.diff(windup) > 0.0).all()
    assert np.abs(np.mean(found.ripple)) < 1e-3 * torque
    amplitudes = [order.amplitude for order in found.orders]
    assert amplitudes == sorted(amplitudes, reverse=True)
    # Half of the peak to peak is no less than the strongest order's share of the energy.
    rms = math.sqrt(sum(a * a for a in amplitudes) / 2.0)
    assert rms <= np.std(found.loaded) * (1.0 + 1e-9)
    # A perfect gearbox knows only whole teeth and pins.
    if errors is None:
        met = model.lobe_count + 1
        assert all(order.per_output_turn % met == 0 for order in found.orders)


@pytest.mark.parametrize(
    ("field", "order"),
    [("tooth_position", "crank 1"), ("pin_position", "lobes and pins 1")],
)
def test_an_eccentric_part_shows_at_its_own_order(field: str, order: str) -> None:
    """A ring beside the axis is met once a crank turn; a carrier once a turn of crank on it."""
    model = ContactModel.from_design(paper_design().replacing({"reducer.disc_count": 1}))
    none = GearboxErrors.none(model)
    shifted = none._replace(**{field: getattr(none, field) + np.array([10e-6, 0.0])})
    found = precision(model, 40.0, errors=shifted)
    assert found.orders[0].name == order
    assert found.orders[0].per_output_turn == (10 if field == "tooth_position" else 11)


def test_order_spectrum_finds_what_was_put_in() -> None:
    phi = 2.0 * math.pi * 10.0 * np.arange(880) / 880
    values = 7.0 + 3.0 * np.cos(phi) + 2.0 * np.sin(1.1 * phi) - 0.5 * np.cos(11.0 * phi + 0.3)
    found = order_spectrum(values, 20.0 * math.pi, 10, 5)
    assert [(o.per_output_turn, o.name) for o in found] == [
        (10, "crank 1"),
        (11, "lobes and pins 1"),
        (110, "teeth 1 (all)"),
    ]
    assert [o.amplitude for o in found] == pytest.approx([3.0, 2.0, 0.5], rel=1e-9)


@pytest.mark.parametrize("torque", [120.0, 1e-6])
def test_precision_at_any_torque_the_gearbox_carries(torque: float) -> None:
    """The paper's peak torque, and next to nothing."""
    model = ContactModel.from_design(paper_design())
    told = precision(model, torque).to_dict()
    json.dumps(told, allow_nan=False)
    assert told["backlash_arcmin"] == pytest.approx(6.80, abs=0.01)
    assert told["lost_motion_arcmin"] > told["backlash_arcmin"] - 0.01
    assert told["stiffness_Nm_per_rad"] > 0.0
    assert told["transmission_error_pp_arcmin"] > 0.0


def test_precision_in_the_other_sense_is_refused_or_the_same() -> None:
    model = replace(ContactModel.from_design(paper_design()), pin=None)
    one = precision(model, 40.0).to_dict()
    try:
        two = precision(model, -40.0).to_dict()
    except CqddError:
        return
    # The paper's stack is its own mirror image at another angle, where both plates are alike.
    for key in ("lost_motion_arcmin", "stiffness_Nm_per_rad", "transmission_error_pp_arcmin"):
        assert two[key] == pytest.approx(one[key], rel=1e-3), key


@pytest.mark.parametrize("torque", [0.0, math.nan, math.inf, 1e9])
def test_precision_at_no_possible_torque_is_refused(torque: float) -> None:
    with pytest.raises(CqddError):
        precision(ContactModel.from_design(paper_design()), torque)


def test_more_clearance_is_less_precise_and_more_stiffness_is_more() -> None:
    base = ContactModel.from_design(paper_design())
    loose = ContactModel.from_design(
        paper_design().replacing({"reducer.output_pins.hole_clearance": 30e-6})
    )
    thick = ContactModel.from_design(
        paper_design().replacing({"reducer.output_pins.diameter": "5 mm"})
    )
    one, two, three = (precision(model, 40.0, angles=90) for model in (base, loose, thick))
    assert two.free.mean > one.free.mean
    assert two.lost_motion > one.lost_motion
    assert three.stiffness > 1.05 * one.stiffness


def test_the_kernels_part_errors_are_those_of_the_plain_twin() -> None:
    """Gaps, their rates, cam offsets and play of a drawn gearbox."""
    model = ContactModel.from_design(paper_design())
    errors = random_errors(model, np.random.default_rng(5), 2e-6)
    tables = ensemble_tables(model, 40.0)
    wanted = error_states(model, tables.states, errors)
    found = Toleranced(*(np.empty_like(values) for values in wanted))
    fill_errors(nominal_of(tables, errors.disc_profile.shape[-1]), errors, found)
    for name, kernel, plain in zip(Toleranced._fields, found, wanted, strict=True):
        np.testing.assert_allclose(kernel, plain, rtol=0.0, atol=2e-9, err_msg=name)
    assert np.abs(wanted.gap_rates).max() > 1e-6
