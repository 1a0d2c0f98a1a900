"""Films: how they grow, the friction they leave in equilibrium and losses; wear; bad input."""

from __future__ import annotations

import functools
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cqdd_design.actuator.friction import STRIBECK_SPEED, friction_parameters
from cqdd_design.catalog.lubricants import find_lubricant, lubricants, walther_viscosity
from cqdd_design.design import Design, load_design
from cqdd_design.errors import CqddError, DesignError, UsageError
from cqdd_design.gearbox.checks.rubbing import rubbing_check
from cqdd_design.gearbox.contact.films import SETTLED, hole_film, ring_film, travel
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.part_errors import GearboxErrors
from cqdd_design.gearbox.contact.rubbing import ContactFriction, slip
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.contact.states import NominalStates, nominal_states
from cqdd_design.gearbox.contact.sweep import (
    contact_sweep,
    output_turn_angles,
    perfect_angles,
)
from cqdd_design.gearbox.film import running as film_running
from cqdd_design.gearbox.film.law import FilmLaw
from cqdd_design.gearbox.film.mixed import BOUNDARY_FRICTION, mixed_friction
from cqdd_design.gearbox.film.plastics import (
    RubbingPlastic,
    rubbing_plastics,
    sliding_plastics,
)
from cqdd_design.gearbox.film.wear import wear_depth
from cqdd_design.gearbox.heat.expansion import PartTemperatures
from cqdd_design.gearbox.losses import LossModel
from cqdd_design.gearbox.losses.machine import SOURCES, total
from cqdd_design.gearbox.losses.rolling import seal_torque
from cqdd_design.gearbox.tolerance import evaluate
from cqdd_design.gearbox.tolerance.draws import draw_errors
from cqdd_design.geometry.output_pins import mean_pin_diameter
from cqdd_design.geometry.runners import pin_runner
from cqdd_design.machine import Machine, resolve
from cqdd_design.verdict import judge

S = load_design(Path(__file__).parents[2] / "designs" / "reference-s.toml")
FILMS = {"reducer.friction.tooth": "film", "reducer.friction.pin": "film"}
TORQUE, FAST = 34.2, 134.7


@functools.cache
def machine() -> Machine:
    return resolve(S.replacing(FILMS))


@functools.cache
def states() -> NominalStates:
    return nominal_states(machine().contact, perfect_angles(machine().contact, 48))


@functools.cache
def swept(speed: float | None = None, sense: str = "drive") -> ContactSweep:
    model = machine().contact
    friction = ContactFriction.of(model, sense, speed)
    return contact_sweep(model, TORQUE, states=states(), friction=friction)


def forces(sweep: ContactSweep) -> np.ndarray:
    return np.concatenate([sweep.ring_force, sweep.pin_force], axis=2)


def ring_of(model: ContactModel, sweep: ContactSweep, speed: float = FAST) -> np.ndarray:
    film = ring_film(model, states(), slip(model, states()), sweep.ring_force, speed)
    assert film is not None
    return film.thickness


# --- how thick ------------------------------------------------------------------------------------


def test_the_film_of_the_reference_is_seven_to_eight_hundredths_of_a_micrometre() -> None:
    sweep = swept()
    film = ring_of(machine().contact, sweep)
    loaded = sweep.ring_force > 0.0
    mean = np.average(film[loaded], weights=sweep.ring_force[loaded])
    assert 0.07e-6 < mean < 0.08e-6


def test_contacts_travel_on_the_flank_as_its_parameter_says() -> None:
    """The way on the disc by slip and spin of the normal, and by the profile itself.

    Slip takes the foot on the flank and travel the tooth's arc, a clearance of 6 um apart.
    """
    model = machine().contact
    _, on_disc = travel(model, states(), slip(model, states()))
    speed, _ = model.disc.rates(states().ring.parameter)
    own = np.abs(speed * states().ring.parameter_rate)
    loaded = swept().ring_force > 0.0
    assert np.abs(on_disc)[loaded] == pytest.approx(own[loaded], abs=6e-6)
    wrong = np.abs(on_disc + 2.0 * slip(model, states())[:, :, : model.tooth_count])
    assert np.abs(wrong - own)[loaded].max() > 1e-3


@given(st.floats(1.01, 10.0))
def test_films_grow_with_speed_and_viscosity_and_hardly_shrink_with_load(times: float) -> None:
    law = machine().contact.tooth_film
    assert law is not None
    thin = law.law.at(100.0, 0.1, 3e-3)
    faster = law.law.at(100.0, 0.1 * times, 3e-3)
    thicker = replace(law.law, viscosity=law.law.viscosity * times).at(100.0, 0.1, 3e-3)
    heavier = law.law.at(100.0 * times, 0.1, 3e-3)
    assert faster.thickness / thin.thickness == pytest.approx(times**0.7)
    assert thicker.thickness == pytest.approx(faster.thickness)
    assert heavier.thickness / thin.thickness == pytest.approx(times**-0.13)
    assert faster.friction < thin.friction < heavier.friction


def test_warm_grease_has_a_thinner_film() -> None:
    sweep = swept()
    hot = ContactModel.from_design(machine().design, temperature=80.0)
    assert np.all(ring_of(hot, sweep) < ring_of(machine().contact, sweep))


def test_a_sleeve_leaves_its_film_no_more_room_than_its_play() -> None:
    sleeved = S.replacing({**FILMS, "reducer.output_pins.sleeve_diameter": 6e-3})
    model = ContactModel.from_design(sleeved)
    film = hole_film(model, np.array([0.0, 1.0, 1e3]), FAST)
    assert film is not None
    runner = pin_runner(sleeved)
    assert runner is not None
    assert film.thickness.max() <= 0.5 * runner.play
    assert np.all(film.friction < 0.7 * BOUNDARY_FRICTION)


# --- friction -------------------------------------------------------------------------------------


@given(st.floats(0.0, 1.0), st.floats(0.0, 1.0), st.floats(0.0, 1e3))
def test_friction_lies_between_its_limits(boundary: float, film: float, ratio: float) -> None:
    low, high = sorted((boundary, film))
    assert low - 1e-15 <= mixed_friction(boundary, film, ratio) <= high + 1e-15


@pytest.mark.parametrize("sense", ["drive", "backdrive"])
def test_discs_balance_with_a_coefficient_of_their_own_at_every_contact(sense: str) -> None:
    sweep = swept(None, sense)
    friction = sweep.friction
    assert friction is not None
    assert friction.felt is not None
    coefficient = friction.felt.coefficient[forces(sweep) > 0.0]
    assert 0.05 < coefficient.min() < coefficient.max() < BOUNDARY_FRICTION
    across = np.stack([-sweep.ring_normal[..., 1], sweep.ring_normal[..., 0]], axis=-1)
    ring = (
        sweep.ring_force[..., None] * sweep.ring_normal + sweep.ring_tangential[..., None] * across
    )
    left = ring.sum(axis=2) + sweep.pin_load.sum(axis=2) + sweep.cam_force
    assert np.abs(left).max() < 1e-9 * sweep.ring_force.max()
    assert np.abs(sweep.disc_torque.sum(axis=1) - TORQUE).max() < 1e-7 * TORQUE


def test_coefficients_are_those_of_the_forces_they_lead_to() -> None:
    sweep = swept()
    friction = sweep.friction
    assert friction is not None
    assert friction.felt is not None
    again = friction.under(machine().contact, states(), forces(sweep)).felt
    assert again is not None
    change = np.abs(again.coefficient - friction.felt.coefficient) * forces(sweep)
    assert change.max() <= SETTLED * forces(sweep).max()
    rubbed = np.abs(sweep.ring_tangential[sweep.ring_force > 0.0])
    mu = friction.felt.coefficient[..., : machine().contact.tooth_count]
    own = (mu * sweep.ring_force)[sweep.ring_force > 0.0]
    assert rubbed == pytest.approx(own, rel=1e-12)


def test_equal_limits_are_plain_friction() -> None:
    model, mu = machine().contact, 0.07

    def flat(law: FilmLaw) -> FilmLaw:
        return replace(law, boundary=mu, film=mu)

    assert model.tooth_film is not None
    assert model.hole_film is not None
    same = replace(
        model,
        tooth_film=model.tooth_film._replace(law=flat(model.tooth_film.law)),
        hole_film=model.hole_film._replace(law=flat(model.hole_film.law)),
    )
    by_film = contact_sweep(
        same, TORQUE, states=states(), friction=ContactFriction.of(same, "drive")
    )
    plain = contact_sweep(model, TORQUE, states=states(), friction=ContactFriction("drive", mu, mu))
    assert by_film.ring_force == pytest.approx(plain.ring_force, rel=1e-9, abs=1e-9)
    assert by_film.efficiency == pytest.approx(plain.efficiency, rel=1e-12)


def test_at_rest_there_is_no_film() -> None:
    model = machine().contact
    rest = swept(0.0)
    plain = contact_sweep(
        model,
        TORQUE,
        states=states(),
        friction=ContactFriction("drive", BOUNDARY_FRICTION, BOUNDARY_FRICTION),
    )
    assert np.array_equal(rest.ring_force, plain.ring_force)
    slow, fast = swept(1.0), swept(FAST)
    assert (rest.efficiency or 0.0) < (slow.efficiency or 0.0) < (fast.efficiency or 0.0)


def test_a_stated_coefficient_stays_that_of_any_speed() -> None:
    model = resolve(S).contact
    friction = ContactFriction.of(model, "drive", 1e3)
    assert friction == ContactFriction("drive", 0.08, 0.08)


def test_needles_ask_for_no_film() -> None:
    needles = {"reducer.output_pins.sleeve_diameter": 9e-3, "reducer.output_pins.sleeve": "needle"}
    wide = {"reducer.output_pins.count": 6, "reducer.disc_thickness": 10e-3}
    try:
        model = ContactModel.from_design(S.replacing({**FILMS, **needles, **wide}))
    except CqddError:
        pytest.skip("no needle cage of the catalogue fits these pins")
    assert model.hole_film is None
    assert model.by_film == (True, False)


# --- losses, actuator, tolerances -----------------------------------------------------------------


@pytest.mark.parametrize("speed", [5.0, 60.0, 400.0])
def test_work_at_any_speed_is_that_of_its_own_equilibrium(speed: float) -> None:
    sweep = swept(speed)
    own = sum(machine().friction.coulomb_work(sweep).values())
    found = machine().losses.coulomb_work(TORQUE, "drive", speed).sum()
    assert found == pytest.approx(own, rel=3.1e-3)


def test_breaking_away_is_without_a_film() -> None:
    losses = machine().losses
    fast = losses.backdrive(film_speed=FAST)
    slow = losses.backdrive()
    assert 0.0 < fast.dynamic_torque < slow.dynamic_torque < slow.static_torque  # type: ignore[operator]
    assert fast.static_torque == slow.static_torque


def test_what_slides_breaks_away_at_its_boundary_and_bearings_above_theirs() -> None:
    """The boundary's coefficient is that of rest already; it is not raised once more."""
    losses = machine().losses
    n, ratio = losses.machine.lobe_count, 1.5
    found = losses.backdrive(static_ratio=ratio).static_torque
    assert found is not None
    work = dict(zip(SOURCES, losses.coulomb_work(found, "backdrive", 0.0), strict=True))
    sliding = work.pop("ring_teeth") + work.pop("output_pins")
    grease = losses.machine.grease_torque(0.0)
    bearings = sum(work.values()) + total(losses.machine.drag(0.0)) - grease
    assert found == pytest.approx(n * (sliding + ratio * bearings + grease), rel=1e-6)


def test_the_stribeck_curve_follows_the_films() -> None:
    losses = machine().losses
    found = friction_parameters(losses, TORQUE, FAST)
    assert found.stribeck_speed != STRIBECK_SPEED
    assert 1.0 < found.stribeck_speed < FAST
    rest, fast = (losses.coulomb_work(TORQUE, "drive", w).sum() for w in (0.0, FAST))
    at = losses.coulomb_work(TORQUE, "drive", found.stribeck_speed).sum()
    assert fast < at < rest
    plain = friction_parameters(resolve(S).losses, TORQUE, FAST)
    assert plain.stribeck_speed == STRIBECK_SPEED


def test_toleranced_gearboxes_have_the_mean_coefficient() -> None:
    found = evaluate._driving(machine().contact, TORQUE)
    teeth, pins = swept().mean_friction
    assert found.film_speed == 0.0
    assert (found.tooth, found.pin) == pytest.approx((teeth, pins), rel=5e-3)


def test_seals_drag_on_what_is_sealed_and_nothing_else() -> None:
    sealed = resolve(S.replacing({"reducer.friction.seals": "contact"}))
    plain, more = (one.friction.drag(FAST) for one in (resolve(S), sealed))
    support, output = (seat.bearing for seat in sealed.seats)
    own = [seal_torque(one.bore_diameter, one.outer_diameter) for one in (support, output)]
    rise = {name: float(more[name] - plain[name]) for name in plain}
    assert rise["support_bearings"] == pytest.approx(2.1 * own[0])
    assert rise["output_bearing"] == pytest.approx(own[1] / 10.0)
    assert {name for name, value in rise.items() if value} == {"support_bearings", "output_bearing"}
    with pytest.raises(DesignError, match="seals"):
        S.replacing({"reducer.friction.seals": "felt"})


def test_seal_friction_is_the_published_formula() -> None:
    """d_s 29 mm: 0.028 x 29^2.25 + 2 N mm."""
    assert 1e3 * seal_torque(20e-3, 47e-3) == pytest.approx(0.028 * 29.0**2.25 + 2.0)
    assert 1e3 * seal_torque(60e-3, 90e-3) == pytest.approx(0.018 * 70.0**2.25 + 15.0)


@pytest.mark.parametrize("torque", [34.2, 90.0])
def test_gearboxes_of_an_ensemble_hardly_know_that_their_films_are_a_mean(torque: float) -> None:
    """Toleranced gearboxes by films of their own, and by the perfect one's mean coefficients.

    The bounds are those that docs/assumptions.md states.
    """
    made = replace(machine(), stiff=True)
    model = made.contact
    held = replace(model, pin=None)
    angles = output_turn_angles(model, 220)
    perfect = contact_sweep(
        held, torque, perfect_angles(held, 48), friction=ContactFriction.of(held, "drive")
    )
    mean = ContactFriction("drive", *perfect.mean_friction)
    drawn = draw_errors(model, made.design.tolerances, 3, 0, 8)

    def figures(errors: GearboxErrors, friction: ContactFriction | None) -> np.ndarray:
        found = contact_sweep(model, torque, angles, errors=errors, friction=friction)
        sense = 1.0 if friction is None else friction.crank_sense(torque)
        return np.array(
            [
                found.ring_force.max(),
                found.maxima["ring_pressure_max_MPa"],
                found.maxima["cam_bearing_load_max_N"],
                found.pin_force.max(),
                found.friction_work.mean(),
                np.ptp(found.carrier_angle_error),
                np.ptp(found.contact_slope + sense * found.friction_work),
            ]
        )

    films = ContactFriction.of(model, "drive")
    off = np.array(
        [figures(drawn.one(k), mean) / figures(drawn.one(k), films) - 1.0 for k in range(8)]
    )
    forces, work, error, ripple = off[:, :4], off[:, 4], off[:, 5], off[:, 6]
    assert np.abs(forces).max() < 0.005
    assert np.abs(work).max() < 0.005
    assert np.abs(error).max() < 0.02
    assert -0.02 < ripple.min() < ripple.max() < 0.12
    # And not because there is nothing to see: films differ from contact to contact.
    assert perfect.friction is not None
    assert perfect.friction.felt is not None
    assert np.ptp(perfect.friction.felt.coefficient) > 0.01


# --- wear and plastics ----------------------------------------------------------------------------


def told(design: Design) -> film_running.Running:
    made = resolve(design)
    return film_running.running(made.design, made.contact, made.losses, swept(), states())


def test_wear_of_the_reference_is_a_micrometre_to_a_dozen() -> None:
    wear = told(S.replacing(FILMS)).wear
    assert wear.hours == 1000.0
    assert 1.2e-6 < wear.disc_flank[0] < 1.5e-6
    assert wear.disc_flank[1] == pytest.approx(10.0 * wear.disc_flank[0])
    # The flank is some ten times as long as the way on the teeth.
    assert wear.ring_tooth[0] > 5.0 * wear.disc_flank[0]


def test_a_ring_tooth_wears_over_the_way_that_contacts_go_on_it() -> None:
    """Followed in the plane: the loaded points of one tooth through a whole turn of the crank."""
    design = S.replacing(FILMS)
    wear = told(design).wear
    model = resolve(design).contact
    turn = nominal_states(model, np.linspace(0.0, 2.0 * np.pi, 1441))
    sweep = contact_sweep(model, design.requirements.continuous_torque, states=turn)
    point, loaded = sweep.ring_point[:, 0, 3], sweep.ring_force[:, 0, 3] > 0.0
    steps = np.hypot(*np.diff(point, axis=0).T)
    way = float(steps[loaded[1:] & loaded[:-1]].sum())
    perimeter = resolve(design).analysis.to_dict()["geometry"]["disc_profile_perimeter_mm"] * 1e-3
    assert 1e-3 < way < 4e-3
    assert wear.ring_tooth[0] / wear.disc_flank[0] == pytest.approx(
        perimeter / (model.tooth_count * way), rel=0.03
    )


def test_half_the_time_wears_half() -> None:
    duty = [
        {"torque": "34.2 N*m", "speed": "13.466960508388246 rad/s", "share": 0.5},
        {"torque": "34.2 N*m", "speed": "0 rad/s", "share": 0.5},
    ]
    data = S.replacing(FILMS).to_mapping()
    data["requirements"]["duty"] = duty
    half, whole = (told(d).wear for d in (Design.from_mapping(data), S.replacing(FILMS)))
    assert half.disc_flank[0] == pytest.approx(0.5 * whole.disc_flank[0])


def of_plastics(**materials: str) -> tuple[RubbingPlastic, ...]:
    keys = {"disc": "reducer.disc_material", "pin": "reducer.output_pins.material"}
    changes = {keys[part]: name for part, name in materials.items()}
    design = resolve(S.replacing(changes)).design
    return rubbing_plastics(design, ContactModel.from_design(design), swept(), FAST)


def test_plastics_are_pressed_by_the_mean_force_on_the_projected_area() -> None:
    (found,) = of_plastics(pin="PEEK")
    pins = S.reducer.output_pins
    force = swept().pin_force.mean(axis=0).max()
    area = mean_pin_diameter(pins) * S.reducer.disc_thickness
    assert found.pressure == pytest.approx(force / area, rel=1e-12)
    assert found.speed == pytest.approx(S.reducer.eccentricity * 1.1 * FAST, rel=1e-12)
    assert found.value == pytest.approx(found.pressure * found.speed)


def test_what_rubs_is_judged_by_the_limit_of_its_plastic() -> None:
    """0.167 MPa m/s of POM; PEEK has no row, and steel no line at all."""
    assert of_plastics(pin="AISI 52100 / 100Cr6 hardened") == ()
    (pom,) = of_plastics(pin="POM (acetal)")
    check = rubbing_check((pom,), TORQUE)
    assert (check.id, check.status) == ("PIN-RUBBING", "fail")
    assert check.limit == pytest.approx(0.167)
    assert check.value == pytest.approx(1e-6 * pom.pressure * pom.speed)
    assert "Delrin" in check.source
    assert rubbing_check((replace(pom, speed=0.999 * pom.limit / pom.pressure),), 1.0).satisfied
    unknown = rubbing_check(of_plastics(pin="PEEK"), TORQUE)
    assert (unknown.status, unknown.limit) == ("unknown", None)
    assert "no limit of it" in unknown.substituted
    # Of two the one beyond its limit is told, then the one whose limit is not known.
    both = of_plastics(disc="POM (acetal)", pin="PEEK")
    assert rubbing_check(both, TORQUE).status == "fail"
    slow = tuple(replace(one, speed=1e-9) for one in both)
    assert rubbing_check(slow, TORQUE).status == "unknown"


def test_under_plain_sleeves_the_pin_rubs_and_on_needles_nothing_does() -> None:
    plastics = {"reducer.disc_material": "POM (acetal)", "reducer.output_pins.material": "PA66"}
    sleeved = S.replacing(plastics | {"reducer.output_pins.sleeve_diameter": 6e-3})
    design = resolve(sleeved).design
    (found,) = rubbing_plastics(design, ContactModel.from_design(design), swept(), FAST)
    assert found.material == "PA66"
    (bare,) = of_plastics(pin="PA66")
    diameter = mean_pin_diameter(S.reducer.output_pins)
    assert found.speed == pytest.approx(bare.speed * diameter / 6e-3, rel=1e-9)
    printed = resolve(load_design(Path(__file__).parents[2] / "designs" / "printed-13.toml"))
    assert sliding_plastics(printed.design, printed.contact) == ()


def test_a_verdict_has_the_line_of_what_slides() -> None:
    mild = {"requirements.peak_torque": 4.0, "requirements.continuous_torque": 2.0}
    pins = resolve(S.replacing({**mild, "reducer.output_pins.material": "PEEK"}))
    lines = {one.id: one for one in judge(replace(pins, stiff=True), samples=0).lines}
    assert lines["PIN-RUBBING"].status == "unknown"
    steel = judge(replace(resolve(S.replacing(mild)), stiff=True), samples=0)
    assert "PIN-RUBBING" not in {one.id for one in steel.lines}


def test_no_band_of_wear_is_told_of_plastics() -> None:
    printed = load_design(Path(__file__).parents[2] / "designs" / "printed-13.toml")
    made = resolve(printed)
    states_there = nominal_states(made.contact, perfect_angles(made.contact, 24))
    friction = ContactFriction.of(made.contact, "drive")
    sweep = contact_sweep(made.contact, 5.0, states=states_there, friction=friction)
    few = LossModel.from_sweeps(made.friction, [sweep], [sweep])
    found = film_running.running(made.design, made.contact, few, sweep, states_there)
    assert found.wear.disc_flank is None
    assert found.wear.pin is None
    assert found.pins is None
    assert found.teeth is not None
    assert found.teeth.ratio < 0.02


@pytest.mark.parametrize(("celsius", "taken"), [(-40.0, -30.0), (80.0, 80.0), (150.0, 120.0)])
def test_warm_parts_warm_the_film_as_far_as_the_lubricant_works(
    celsius: float, taken: float
) -> None:
    warm = machine().at(PartTemperatures.even(celsius))
    assert warm.lubricant_temperature == taken
    assert any("outside the -30 to 120 degC" in one for one in warm.too_warm) == (celsius != taken)
    assert warm.friction.temperature == taken
    law, cool = warm.contact.tooth_film, machine().contact.tooth_film
    assert law is not None
    assert cool is not None
    assert (law.law.viscosity < cool.law.viscosity) == (taken > 40.0)


# --- lubricants and bad input ---------------------------------------------------------------------


@pytest.mark.parametrize("name", lubricants())
def test_viscosity_meets_both_printed_figures_and_falls_with_temperature(name: str) -> None:
    one = find_lubricant(name)
    assert one.viscosity_at(40.0) == pytest.approx(one.viscosity, rel=1e-12)
    assert walther_viscosity(100.0, one.viscosity, one.hot_viscosity) == pytest.approx(
        one.hot_viscosity, rel=1e-12
    )
    over = [one.viscosity_at(t) for t in np.linspace(one.coldest, one.hottest, 20)]
    assert np.all(np.diff(over) < 0.0)


def test_oils_between_the_rows_lie_between_them() -> None:
    hot = [find_lubricant(f"ISO VG {g} oil").hot_viscosity for g in (15, 22, 130, 150, 1000)]
    assert np.all(np.diff(hot) > 0.0)


@pytest.mark.parametrize("temperature", [-31.0, 121.0, float("nan"), -300.0])
def test_a_temperature_outside_the_lubricants_is_a_sentence(temperature: float) -> None:
    with pytest.raises(UsageError, match="works from -30 to 120 degC"):
        ContactModel.from_design(machine().design, temperature=temperature)


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("reducer.friction.tooth", -0.1, 'or "film"'),
        ("reducer.friction.pin", "oily", 'or "film"'),
        ("reducer.finish.disc", "chewed", "the catalogue has no finish"),
    ],
)
def test_bad_keys_are_sentences(key: str, value: object, words: str) -> None:
    with pytest.raises(DesignError, match=words):
        S.replacing({key: value})


@pytest.mark.parametrize("bad", [(-1e-18, 1.0, 1.0), (1e-18, -1.0, 1.0), (1e-18, 1.0, 0.0)])
def test_impossible_wear_is_a_sentence(bad: tuple[float, float, float]) -> None:
    with pytest.raises(UsageError, match="wear needs"):
        wear_depth(*bad)
