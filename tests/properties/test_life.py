"""Life under a duty: cycle counts, Miner's rule, senses, spectra."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design, load_design
from cqdd_design.gearbox import allowables
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.sweep import contact_sweep
from cqdd_design.gearbox.contact.tables import pin_table, ring_table
from cqdd_design.gearbox.life import LifeResult, life
from cqdd_design.gearbox.life.cycles import disc_cycles, ring_tooth_cycles
from cqdd_design.gearbox.life.fatigue import damage_rate, pin_cycles, stress_reserve

PAPER = Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml"


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


def part(result: LifeResult, words: str) -> object:
    return next(one for one in result.parts if one.part.startswith(words))


# ------------------------------------------------------------------ cycles


@pytest.mark.parametrize(("lobes", "pins"), [(10, 5), (7, 4), (12, 6)])
def test_cycles_counted_in_the_kinematics(lobes: int, pins: int) -> None:
    design = load_design(PAPER).replacing(
        {
            "requirements.ratio": lobes,
            "reducer.ratio": lobes,
            "reducer.output_pins.count": pins,
            "reducer.eccentricity": 1.2e-3,
        }
    )
    model = ContactModel.from_design(design)
    angle = np.linspace(0.0, 2.0 * math.pi * lobes, 40 * lobes * (lobes + 1), endpoint=False)
    arms = ring_table(model, angle).rows[:, 0, :, 2]
    begins = np.sum((arms[:, 0] > 0.0) & (np.roll(arms[:, 0], 1) <= 0.0))
    assert begins == ring_tooth_cycles(lobes)
    # A point of the flank: every tooth passes it once.
    t = np.mod(ring_table(model, angle).parameter[:, 0, :] - 1.2345, 2.0 * math.pi)
    passes = np.sum((t < math.pi) & (np.roll(t, 1, axis=0) > math.pi))
    assert passes == disc_cycles(lobes)
    arms = pin_table(model, angle).rows[:, 0, 0, 2]
    assert np.sum((arms > 0.0) & (np.roll(arms, 1) <= 0.0)) == disc_cycles(lobes)


def test_a_point_of_the_flank_always_meets_the_same_pressure() -> None:
    model = ContactModel.from_design(load_design(PAPER))
    angle = 2.0 * math.pi * 10 * np.arange(11) / 11
    sweep = contact_sweep(model, 40.0, angle + 0.3)
    t = np.mod(sweep.ring_parameter[:, 0, :], 2.0 * math.pi)
    place = t[0, int(sweep.ring_pressure[0, 0].argmax())]
    seen = [
        sweep.ring_pressure[a, 0, int(np.abs(np.angle(np.exp(1j * (t[a] - place)))).argmin())]
        for a in range(11)
    ]
    # The pins differ from touch to touch, the geometry of the touch does not.
    assert np.ptp(seen) < 0.02 * max(seen)


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
    one = lived((60.0, 10.0, 1.0))
    both = lived((60.0, 10.0, 0.5), (-60.0, 10.0, 0.5))
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
    load = contact_sweep(ContactModel.from_design(design), 40.0).cam_load
    for disc, equal in enumerate(result.cam.equivalent_load):
        assert load[:, disc].min() < equal < load[:, disc].max()
    assert min(result.cam.hours) > result.cam.hours_at_greatest
    assert result.cam.set_hours < min(result.cam.hours)
    slope = 10.0 / 9.0
    together = sum(h**-slope for h in result.cam.hours) ** (-1.0 / slope)
    assert result.cam.set_hours == pytest.approx(together)


def test_reserve_is_the_factor_at_which_it_just_lasts() -> None:
    stress, rate = np.array([200e6, 350e6]), np.array([1e4, 2e3])

    def to_failure(s: np.ndarray) -> np.ndarray:
        return pin_cycles(s, 300e6, 1200e6)

    factor = stress_reserve(stress, rate, to_failure, 1000.0)
    assert damage_rate(0.999 * factor * stress, rate, to_failure) * 1000.0 <= 1.0
    assert damage_rate(1.001 * factor * stress, rate, to_failure) * 1000.0 > 1.0


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
