"""Life under a duty: cycle counts, Miner's rule, senses, spectra."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design, load_design
from cqdd_design.gearbox import output_pins
from cqdd_design.gearbox.carrier import pin_of
from cqdd_design.gearbox.checks import allowables
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.rubbing import ContactFriction, PowerSense
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.contact.sweep import contact_sweep
from cqdd_design.gearbox.contact.tables import pin_table, ring_table
from cqdd_design.gearbox.life import LifeResult, PartLife, contacts, cycles, life, pins
from cqdd_design.gearbox.life.fatigue import contact_cycles, rainflow
from cqdd_design.machine import resolve

PAPER = Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml"


def changed_design(lobes: int, pin_count: int, discs: int = 2, **changes: object) -> Design:
    """Return the paper's gearbox with another number of lobes, pins and discs."""
    return load_design(PAPER).replacing(
        {
            "requirements.ratio": lobes,
            "reducer.ratio": lobes,
            "reducer.output_pins.count": pin_count,
            "reducer.disc_count": discs,
            "reducer.eccentricity": 12e-3 / (lobes + 1),
            **changes,
        }
    )


def modelled(lobes: int, pin_count: int, discs: int = 2) -> ContactModel:
    return ContactModel.from_design(changed_design(lobes, pin_count, discs))


def lived(*cases: tuple[float, float, float], **changes: object) -> LifeResult:
    """Life of the paper's gearbox with 12.9 pins under (torque, output speed, share) cases."""
    design = load_design(PAPER)
    mapping = design.to_mapping()
    mapping["requirements"]["duty"] = [
        {"torque": f"{t} N*m", "speed": f"{w} rad/s", "share": s} for t, w, s in cases
    ]
    mapping["reducer"]["output_pins"]["material"] = "Alloy steel 12.9 (ISO 7379)"
    changed = Design.from_mapping(mapping).replacing(changes)
    return life(changed, ContactModel.from_design(changed))


def part(result: LifeResult, words: str) -> PartLife:
    return next(one for one in result.parts if one.part.startswith(words))


# ------------------------------------------------------------------ cycles


GEARBOXES = [(10, 5, 2), (7, 4, 2), (12, 6, 3), (9, 6, 1)]


@pytest.mark.parametrize(("lobes", "pin_count", "discs"), GEARBOXES)
def test_cycles_counted_in_the_kinematics(lobes: int, pin_count: int, discs: int) -> None:
    model = modelled(lobes, pin_count, discs)
    angle = np.linspace(0.0, 2.0 * math.pi * lobes, 40 * lobes * (lobes + 1), endpoint=False)
    ring = ring_table(model, angle)
    for disc in range(discs):
        for tooth in range(lobes + 1):
            arm = ring.rows[:, disc, tooth, 2]
            begins = np.sum((arm > 0.0) & (np.roll(arm, 1) <= 0.0))
            assert begins == cycles.ring_tooth_cycles(lobes)
    # A point of the flank: every tooth passes it once.
    t = np.mod(ring.parameter[:, 0, :] - 1.2345, 2.0 * math.pi)
    passes = np.sum((t < math.pi) & (np.roll(t, 1, axis=0) > math.pi))
    assert passes == cycles.disc_cycles(lobes)
    # A pin, and a point of a hole: the direction of the push in the disc's frame goes round.
    arm = pin_table(model, angle)[0][:, 0, 0, 2]
    assert np.sum((arm > 0.0) & (np.roll(arm, 1) <= 0.0)) == cycles.disc_cycles(lobes)
    push = np.mod(np.append(angle, 2.0 * math.pi * lobes) * (1.0 + 1.0 / lobes), 2.0 * math.pi)
    crossed = (push[1:] > 0.7) & (push[:-1] <= 0.7)
    assert np.sum(crossed) == cycles.disc_cycles(lobes)


def test_a_place_of_a_tooth_is_touched_twice_each_time() -> None:
    model = modelled(10, 5)
    angle = np.linspace(0.0, 2.0 * math.pi, 720, endpoint=False)
    normal = ring_table(model, angle).rows[:, 0, 0, :2]
    # Tooth 0 stands on +x; its contact normal leans off the radius by psi.
    lean = np.arctan2(normal[:, 1], -normal[:, 0])
    shortening = model.disc.shortening_coefficient
    assert np.abs(lean) == pytest.approx(
        np.abs(cycles.contact_inclination(shortening, angle)), abs=1e-6
    )
    again = cycles.other_touch(shortening, angle)
    assert cycles.contact_inclination(shortening, again) == pytest.approx(
        cycles.contact_inclination(shortening, angle), abs=1e-12
    )
    assert cycles.other_touch(shortening, again) == pytest.approx(angle, abs=1e-9)
    # On its way round the crank the touch runs out over any place and back again.
    half = 0.5 * np.abs(lean).max()
    loaded = np.abs(lean[(angle > 0.0) & (angle < math.pi)])
    assert np.sum(np.diff((loaded > half).astype(int)) != 0) == 2


def test_a_place_of_the_flank_always_meets_the_same_pressure() -> None:
    model = modelled(10, 5)
    # The crank comes back to its place against the disc every 2 pi n/(n+1).
    start = np.linspace(0.1, 0.5, 5)
    first = contact_sweep(model, 40.0, start)
    for turn in (1, 4):
        later = contact_sweep(model, 40.0, start + turn * 2.0 * math.pi * 10 / 11)
        for a in range(len(start)):
            for d in range(2):
                order = np.argsort(np.mod(first.ring_parameter[a, d] + 1e-6, 2.0 * math.pi))
                other = np.argsort(np.mod(later.ring_parameter[a, d] + 1e-6, 2.0 * math.pi))
                assert later.ring_parameter[a, d][other] == pytest.approx(
                    first.ring_parameter[a, d][order], abs=1e-9
                )
                assert later.ring_pressure[a, d][other] == pytest.approx(
                    first.ring_pressure[a, d][order], rel=1e-6, abs=1.0
                )


def whole_turn(model: ContactModel, torque: float) -> tuple[ContactSweep, int]:
    """Sweep a whole output turn on the angles of the life calculation, and its steps a tooth."""
    steps = cycles.steps_per_tooth(model.lobe_count, model.pin_count)
    count = steps * model.lobe_count * (model.lobe_count + 1)
    angle = 2.0 * math.pi * model.lobe_count * np.arange(count) / count
    return contact_sweep(model, torque, angle), steps


@pytest.mark.parametrize(("lobes", "pin_count", "discs"), GEARBOXES)
def test_passes_of_a_tooth_are_those_of_a_whole_turn(
    lobes: int, pin_count: int, discs: int
) -> None:
    model = modelled(lobes, pin_count, discs)
    period = contact_sweep(model, 20.0, cycles.crank_angles(lobes, pin_count))
    whole, steps = whole_turn(model, 20.0)
    angle, tooth = cycles.tooth_passes(lobes, pin_count)
    shared = math.gcd(lobes, pin_count)
    passed = period.ring_pressure[angle, 0, tooth][:, :-1]
    for looked_at in (0, lobes // 2):
        seen = np.roll(whole.ring_pressure[:, 0, looked_at], -steps * looked_at)
        seen = seen.reshape(lobes, (lobes + 1) * steps)
        counted = np.repeat(np.sort(passed, axis=0), shared, axis=0)
        assert counted == pytest.approx(np.sort(seen, axis=0), rel=1e-6, abs=1e3)


@pytest.mark.parametrize(("lobes", "pin_count", "discs"), GEARBOXES)
def test_tooth_damage_is_that_of_counting_over_a_whole_turn(
    lobes: int, pin_count: int, discs: int
) -> None:
    """Both touches of every pass, found on a tooth by where its contact normal points."""
    model = modelled(lobes, pin_count, discs)
    limit = 944e6
    period = contact_sweep(model, 20.0, cycles.crank_angles(lobes, pin_count))
    damage = contacts.tooth_contact([period]).damage(np.array([1.0]), limit)
    whole, _ = whole_turn(model, 20.0)
    pressure = whole.ring_pressure[:, discs - 1, 0].reshape(lobes, -1)
    crank = whole.crank_angle[: pressure.shape[1]] + model.phases[discs - 1]
    lean = cycles.contact_inclination(model.disc.shortening_coefficient, crank)
    place = int(np.argmax(np.where(np.abs(lean) < 0.9 * np.abs(lean).max(), pressure.max(0), 0.0)))
    total = 0.0
    for turn in range(lobes):
        off = lean - lean[place]
        crossing = np.flatnonzero(np.signbit(off) != np.signbit(np.roll(off, -1)))
        for at in crossing:
            after = (at + 1) % len(off)
            share = off[at] / (off[at] - off[after])
            later = pressure[(turn + (after == 0)) % lobes, after]
            met = math.sqrt((1 - share) * pressure[turn, at] ** 2 + share * later**2)
            total += 1.0 / float(contact_cycles(met, limit))
    places = damage.reshape(discs, -1)
    assert places[discs - 1, place] == pytest.approx(total, rel=0.02)


@pytest.mark.parametrize(("lobes", "pin_count", "discs"), GEARBOXES)
def test_pin_histories_are_those_of_a_whole_turn(lobes: int, pin_count: int, discs: int) -> None:
    model = modelled(lobes, pin_count, discs)
    period = contact_sweep(model, 20.0, cycles.crank_angles(lobes, pin_count))
    whole, steps = whole_turn(model, 20.0)
    history = pins.pin_histories(model, period.pin_moment)
    shared = math.gcd(lobes, pin_count)
    assert history.shape == (steps * lobes, discs + 2, pin_count // shared)
    for pin in range(pin_count // shared):
        seen = whole.pin_moment[: steps * lobes, :, pin]
        assert np.abs(history[:, :, pin] - seen).max() < 1e-6 * np.abs(seen).max()
        # Pushed along the crank, so on the side where the torque is resisted: tangentially back.
        assert history[:, 0, pin].imag.max() <= 1e-6 * np.abs(history).max()


# ------------------------------------------------------------------ damage


def test_two_halves_are_one_whole() -> None:
    whole = lived((30.0, 10.0, 1.0))
    halves = lived((30.0, 10.0, 0.5), (30.0, 10.0, 0.5))
    for one, two in zip(whole.parts, halves.parts, strict=True):
        assert two.damage_per_hour == pytest.approx(one.damage_per_hour)
    assert halves.cam.equivalent_load == pytest.approx(whole.cam.equivalent_load)
    assert halves.cam.set_hours == pytest.approx(whole.cam.set_hours)


def test_idle_time_wears_nothing() -> None:
    busy = lived((30.0, 10.0, 0.5), (30.0, 10.0, 0.5))
    for idle in ((30.0, 10.0, 0.5), (0.0, 10.0, 0.5)), ((30.0, 10.0, 0.5), (30.0, 0.0, 0.5)):
        result = lived(*idle)
        for one, two in zip(busy.parts, result.parts, strict=True):
            assert two.damage_per_hour == pytest.approx(0.5 * one.damage_per_hour)


def test_more_torque_wears_more() -> None:
    rates = [[one.damage_per_hour for one in lived((t, 10.0, 1.0)).parts] for t in (20, 40, 80)]
    assert np.all(np.diff(np.array(rates), axis=0) >= 0.0)
    loads = [lived((t, 10.0, 1.0)).cam.equivalent_load[0] for t in (20, 40, 80)]
    assert loads == sorted(loads)


def test_a_reversing_duty_is_harder_on_pins_and_easier_on_flanks() -> None:
    one = lived((30.0, 10.0, 1.0))
    both = lived((30.0, 10.0, 0.5), (-30.0, 10.0, 0.5))
    assert part(both, "output pins, bending").limit < part(one, "output pins, bending").limit
    assert (
        part(both, "output pins, bending").damage_per_hour
        > part(one, "output pins, bending").damage_per_hour
    )
    assert part(both, "ring teeth").damage_per_hour == pytest.approx(
        0.5 * part(one, "ring teeth").damage_per_hour, rel=1e-3
    )


def test_equivalent_load_lies_between_least_and_greatest() -> None:
    result = lived((40.0, 10.0, 1.0))
    design = load_design(PAPER)
    model = ContactModel.from_design(design)
    load = contact_sweep(model, 40.0, friction=ContactFriction.of(model, "drive")).cam_load
    for disc, equal in enumerate(result.cam.equivalent_load):
        assert load[:, disc].min() < equal < load[:, disc].max()
    assert min(result.cam.hours) > result.cam.hours_at_greatest
    assert result.cam.set_hours < min(result.cam.hours)
    slope = 10.0 / 9.0
    together = sum(h**-slope for h in result.cam.hours) ** (-1.0 / slope)
    assert result.cam.set_hours == pytest.approx(together)


def test_every_case_alike_is_the_sum_of_its_parts() -> None:
    """Two torques together wear a place at most as their own worst places, at least as either."""
    both = lived((30.0, 10.0, 0.4), (50.0, 5.0, 0.6))
    one, two = lived((30.0, 10.0, 0.4), (0.0, 5.0, 0.6)), lived((0.0, 9.0, 0.4), (50.0, 5.0, 0.6))
    for all_of_it, first, second in zip(both.parts, one.parts, two.parts, strict=True):
        greater = max(first.damage_per_hour, second.damage_per_hour)
        most = first.damage_per_hour + second.damage_per_hour
        assert greater * (1 - 1e-9) <= all_of_it.damage_per_hour <= most * (1 + 1e-9)


def test_reserve_is_the_factor_at_which_a_part_just_lasts() -> None:
    values = np.array([[[900e6, 700e6], [500e6, 700e6]], [[300e6, 800e6], [0.0, 100e6]]])
    turns = np.array([5e3, 2e3])
    found = contacts.Pressures(values, 3)
    factor = found.reserve(turns, 944e6, 1000.0)
    assert found.scaled(0.9999 * factor).damage(turns, 944e6).max() * 1000.0 < 1.0
    assert found.scaled(1.0001 * factor).damage(turns, 944e6).max() * 1000.0 > 1.0
    result = lived((40.0, 10.0, 1.0))
    for one in result.parts:
        assert (one.reserve < 1.0) == (one.hours is not None and one.hours < result.required_hours)


def test_a_hotter_place_may_take_over_at_the_reserve() -> None:
    """The place with most damage as it is is not always the one that limits the factor."""
    # Above the knee damage grows with p^17.9, below with p^43.5: a rare high pressure gains less.
    rare, often = np.array([[1100e6, 1e3]]), np.array([[1e3, 940e6]])
    values = np.stack([rare, often])
    found = contacts.Pressures(values, 1)
    turns = np.array([60.0, 1e4])
    as_it_is = found.damage(turns, 944e6)
    factor = found.reserve(turns, 944e6, 1e6)
    there = found.scaled(factor).damage(turns, 944e6)
    assert there.max() * 1e6 == pytest.approx(1.0, rel=1e-6)
    assert as_it_is.argmax() != there.argmax()


# ------------------------------------------------------------------ pins


def duty_sweep(model: ContactModel, torque: float, sense: PowerSense = "drive") -> ContactSweep:
    """The equilibria that a duty's case is judged by."""
    angles = cycles.crank_angles(model.lobe_count, model.pin_count)
    return contact_sweep(model, torque, angles, friction=ContactFriction.of(model, sense))


@pytest.mark.parametrize("joint", ["clamped", "hinged", "cantilever"])
def test_one_sense_pulsates_at_the_stress_of_the_equilibrium(joint: str) -> None:
    """The worst fibre goes from nothing, or little, to the greatest stress of the pin."""
    support = "cantilever" if joint == "cantilever" else "both"
    changes = {
        "reducer.output_pins.support": support,
        "reducer.carrier.joint": "hinged" if joint == "hinged" else "clamped",
        "reducer.output_pins.material": "Alloy steel 12.9 (ISO 7379)",
    }
    result = lived((15.0, 10.0, 1.0), **changes)
    model = ContactModel.from_design(load_design(PAPER).replacing(changes))
    sweep = duty_sweep(model, 15.0)
    assert result.loads[0].pin_bending == pytest.approx(sweep.pin_bending.max(), rel=1e-9)
    stress = part(result, "output pins, bending").stress
    # Friction turns the force a little beyond either end of its half turn.
    assert stress <= 1.02 * result.loads[0].pin_bending
    # A cap that hangs on the pins keeps them bent while no disc pushes them.
    assert stress > (0.97 if joint == "cantilever" else 0.7) * result.loads[0].pin_bending


@pytest.mark.parametrize("discs", [1, 2, 3])
@pytest.mark.parametrize("ends", [("clamped", "clamped"), ("clamped", "hinged")])
def test_pins_hand_the_whole_torque_to_the_plate(ends: tuple[str, str], discs: int) -> None:
    """Statics of all pins: moments at their ends balance what the discs push, wherever it is.

    The torque's share of a pin stands on its plate alone, and what bends it there and at the cap
    together is that share's moment about the plate.
    """
    design = load_design(PAPER).replacing({"reducer.disc_count": discs})
    model = replace(ContactModel.from_design(design), pin=pin_of(design, ends))
    sweep = contact_sweep(model, 40.0)
    radius = model.pin_circle_radius
    at = output_pins.disc_positions(discs, 8e-3, 0.5e-3)
    per_disc = np.abs(sweep.disc_torque) / radius
    wanted = per_disc @ at
    ends_of_pins = sweep.pin_moment[:, [0, -1]].imag.sum(axis=2)
    found = np.abs(ends_of_pins[:, 0] - ends_of_pins[:, 1])
    assert found == pytest.approx(wanted, rel=1e-9)


def test_who_drives_decides_on_the_forces_of_a_duty() -> None:
    """A case whose torque and speed oppose each other is driven by the output: friction helps."""
    driving, driven = lived((40.0, 10.0, 1.0)), lived((40.0, -10.0, 1.0))
    steel = {"reducer.output_pins.material": "Alloy steel 12.9 (ISO 7379)"}
    model = ContactModel.from_design(load_design(PAPER).replacing(steel))
    for result, sense in ((driving, "drive"), (driven, "backdrive")):
        sweep = duty_sweep(model, 40.0, sense)
        assert result.loads[0].cam_load == pytest.approx(sweep.cam_load.max(), rel=1e-9)
    assert driven.loads[0].cam_load < 0.7 * driving.loads[0].cam_load
    for name in ("ring teeth", "disc flanks"):
        assert part(driven, name).damage_per_hour < 0.5 * part(driving, name).damage_per_hour
    both = lived((40.0, 10.0, 0.5), (40.0, -10.0, 0.5))
    each = [part(one, "ring teeth").damage_per_hour for one in (driving, driven)]
    assert 0.9 < part(both, "ring teeth").damage_per_hour / (0.5 * sum(each)) <= 1.0 + 1e-9


def test_limits_of_pins_lie_on_one_goodman_line() -> None:
    one = part(lived((30.0, 10.0, 1.0)), "output pins, bending")
    both = part(lived((30.0, 10.0, 0.5), (-30.0, 10.0, 0.5)), "output pins, bending")
    assert one.limit / 1e6 == pytest.approx(300.0)
    assert both.limit / 1e6 == pytest.approx(150.0 / (1.0 - 150.0 / 1220.0))
    # The same peak both ways is the amplitude; the senses differ a little in their peaks. One
    # sense alone never lets go of the pins: the cap that hangs on them keeps them bent.
    peaks = [lived((sense * 30.0, 10.0, 1.0)).loads[0].pin_bending for sense in (1.0, -1.0)]
    assert min(peaks) * 0.999 < both.stress < max(peaks) * 1.001
    assert 0.7 * both.stress < one.stress < both.stress


def test_a_whisper_of_the_other_sense_changes_little() -> None:
    one = lived((30.0, 10.0, 1.0))
    nearly = lived((30.0, 10.0, 0.5), (-1e-4, 10.0, 0.5))
    first, second = (part(one, "output pins, bending"), part(nearly, "output pins, bending"))
    # It lets the pins spring back, whatever its size.
    other = part(lived((30.0, 10.0, 0.5), (-2e-4, 10.0, 0.5)), "output pins, bending")
    assert second.damage_per_hour > 0.5 * first.damage_per_hour
    assert second.damage_per_hour == pytest.approx(other.damage_per_hour, rel=0.01)
    assert second.reserve == pytest.approx(other.reserve, rel=0.01)


def test_a_torque_held_the_other_way_reverses_the_pins() -> None:
    pulsating = part(lived((30.0, 10.0, 0.5), (0.0, 0.0, 0.5)), "output pins, bending")
    reversed_ = part(lived((30.0, 10.0, 0.5), (-30.0, 0.0, 0.5)), "output pins, bending")
    assert reversed_.damage_per_hour > 2.0 * pulsating.damage_per_hour > 0.0


CYCLES = st.lists(
    st.tuples(st.floats(-9.0, 0.0), st.floats(0.0, 9.0), st.floats(0.1, 9.0)), max_size=5
)


@given(CYCLES, CYCLES)
@settings(max_examples=examples(60), deadline=None)
def test_pairing_keeps_every_pulse_once(
    one: list[tuple[float, float, float]], other: list[tuple[float, float, float]]
) -> None:
    paired = pins.paired_cycles(one, other)
    rates = [sum(rate for *_, rate in group) for group in (one, other)]
    assert sum(rate for *_, rate in paired) == pytest.approx(max(rates))
    if one or other:
        assert max(high for _, high, _ in paired) == max(c[1] for c in (*one, *other))


@given(st.lists(st.integers(-20, 20), min_size=3, max_size=30), st.integers(0, 29))
@settings(max_examples=examples(100), deadline=None)
def test_a_history_that_repeats_counts_alike_from_either_end(values: list[int], cut: int) -> None:
    """Begun and ended at its greatest value: half of all travel is the sum of ranges counted."""
    history = np.roll(np.array(values, dtype=float), cut)
    start = int(history.argmax())
    closed = np.append(np.roll(history, -start), history[start])
    ranges = sum((high - low) * count for low, high, count in rainflow(closed))
    assert ranges == pytest.approx(0.5 * np.abs(np.diff(closed)).sum())


# ------------------------------------------------------------------ the whole result


def test_without_a_duty_the_continuous_torque_is_assumed() -> None:
    design = load_design(PAPER)
    result = life(design, ContactModel.from_design(design))
    assert result.assumed
    assert result.duty[0].torque == 40.0
    assert result.duty[0].speed == pytest.approx(design.requirements.input_speed / 10)
    assert result.to_dict()["duty_assumed"] is True


def test_limits_are_those_of_the_allowables() -> None:
    result = lived((40.0, 10.0, 1.0))
    steel = find_material("AISI 4140 Q&T 540C")
    assert part(result, "ring teeth").limit == allowables.contact_limit_fatigue(steel).value


def test_the_check_of_the_bearing_stands_beside() -> None:

    design = load_design(PAPER)
    result = life(design, ContactModel.from_design(design))
    assert result.cam.hours_of_rigid_law == resolve(design).analysis.cam_bearing.life_hours
    assert result.cam.speed == pytest.approx(1.1 * design.requirements.input_speed)


def test_turns_and_hours_agree() -> None:
    result = lived((40.0, 2.0 * math.pi, 0.25), (20.0, 0.0, 0.75))
    one = part(result, "disc flanks")
    assert one.output_turns == pytest.approx(one.hours * 900.0)
    assert [loads.turns_per_hour for loads in result.loads] == pytest.approx([900.0, 0.0])


def test_a_duty_that_never_turns_has_no_wear_and_says_so() -> None:
    result = lived((40.0, 0.0, 0.5), (0.0, 10.0, 0.5))
    for one in result.parts:
        assert (one.damage_per_hour, one.hours, one.reserve) == (0.0, None, None)
    still = lived((40.0, 0.0, 1.0))
    assert still.cam.hours is None
    assert any("never turns" in words for words in still.warnings)
    json.dumps([result.to_dict(), still.to_dict()], allow_nan=False)


def test_a_pressure_beyond_the_curve_is_named() -> None:
    result = lived((110.0, 10.0, 0.01), (10.0, 10.0, 0.99))
    assert part(result, "disc flanks").stress > 1.48 * part(result, "disc flanks").limit
    assert any("pitting curve" in words for words in result.warnings)
    assert not any("pitting curve" in words for words in lived((10.0, 10.0, 1.0)).warnings)


def test_a_part_without_a_limit_has_no_life() -> None:
    result = lived((10.0, 10.0, 1.0), **{"reducer.ring_material": "7075-T6"})
    ring = part(result, "ring teeth")
    assert (ring.limit, ring.hours, ring.damage_per_hour) == (0.0, None, None)
    assert any("ring teeth" in words for words in result.warnings)


def test_interference_wears_both_flanks_under_either_torque() -> None:
    """With preload the idle flank is loaded too, and adds to the damage of the same place."""
    tight = {"reducer.modification.equidistant": -4e-6, "reducer.output_pins.hole_clearance": -6e-6}
    forth = lived((20.0, 10.0, 1.0), **tight)
    both = lived((20.0, 10.0, 0.5), (-20.0, 10.0, 0.5), **tight)
    # Without preload exactly half (above); here the other sense adds to it.
    assert (
        part(both, "disc flanks").damage_per_hour
        > 0.5005 * part(forth, "disc flanks").damage_per_hour
    )


TORQUES = st.one_of(st.just(0.0), st.floats(1e-6, 80.0), st.floats(-80.0, -1e-6))


@given(TORQUES, TORQUES, st.floats(0.0, 30.0), st.floats(0.01, 0.99))
@settings(max_examples=examples(12), deadline=None)
def test_any_duty_gives_finite_numbers(
    one: float, other: float, speed: float, share: float
) -> None:
    result = lived((one, speed, share), (other, 5.0, 1.0 - share))
    json.dumps(result.to_dict(), allow_nan=False)
    for found in result.parts:
        assert found.damage_per_hour >= 0.0
        assert found.reserve is None or found.reserve > 0.0
