"""Life: published numbers.

- Stress-cycle factor for pitting: AGMA 2101-D04, figure 17 (lower curve above 1e7 cycles).
- Stress over cycles of pins: Budynas and Nisbett, Shigley's Mechanical Engineering Design, examples
  of the section on fatigue strength (90 kpsi steel: 64.6 kpsi at 1e4 cycles, 77 500 cycles at
  55 kpsi, with f 0.86 read from the figure).
- Cycle counting: ASTM E1049-85, example of section 5.4.4.
- Mean loads: bearing makers' catalogues after ISO 281 (NTN, Ball and Roller Bearings, section 4):
  0.75 P_max for a load like |sin|, close to (P_min + 2 P_max)/3 for one that rises evenly.
- Two bearings of equal life together: 2^(-1/b) of it (Lundberg and Palmgren 1947), 0.536 for balls.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable

import numpy as np
import pytest
from published_rows import Row, inputs, label, published_rows

from cqdd_design.gearbox.bearing_life import basic_rating_life_hours
from cqdd_design.gearbox.life.cam import equivalent_load, set_life
from cqdd_design.gearbox.life.fatigue import (
    contact_cycle_factor,
    contact_cycles,
    fatigue_strength_fraction,
    goodman_pulsating,
    goodman_reversed,
    pin_cycles,
    rainflow,
)

Compared = Callable[..., None]
KPSI = 6.894757e6


@pytest.mark.parametrize("row", published_rows("pitting over cycles"), ids=label)
def test_stress_cycle_factor(row: Row, compared: Compared) -> None:
    cycles = float(row["inputs"].removeprefix("N="))
    compared(row, lambda: float(contact_cycle_factor(cycles)), contact_cycle_factor)


def test_the_two_branches_meet_at_the_knee() -> None:
    below, above = contact_cycle_factor([1e7, 1e7 * (1 + 1e-9)])
    assert below == pytest.approx(above, abs=1e-3)


@pytest.mark.parametrize("cycles", [1e5, 1e6, 3e7, 1e9])
def test_cycles_invert_the_factor(cycles: float) -> None:
    pressure = 944e6 * float(contact_cycle_factor(cycles))
    assert float(contact_cycles(pressure, 944e6)) == pytest.approx(cycles, rel=1e-6)


@pytest.mark.parametrize("row", published_rows("fatigue of steel pins", "share"), ids=label)
def test_strength_at_a_thousand_cycles(row: Row, compared: Compared) -> None:
    strength = inputs(row)["Su"] * KPSI
    compared(row, lambda: float(fatigue_strength_fraction(strength)), fatigue_strength_fraction)


@pytest.mark.parametrize("row", published_rows("fatigue of steel pins", "cycles"), ids=label)
def test_pin_line_of_the_book_steel(row: Row, compared: Compared) -> None:
    # The strength at 1e4 cycles is read back: at it the life is 1e4, to the reading of f.
    g = inputs(row)

    def ours() -> float:
        return float(pin_cycles(g["S"] * KPSI, g["Se"] * KPSI, g["Su"] * KPSI))

    compared(row, ours, pin_cycles, fatigue_strength_fraction)
    assert float(pin_cycles(44.9 * KPSI, g["Se"] * KPSI, g["Su"] * KPSI)) == np.inf


def test_goodman_of_the_tabled_screw() -> None:
    # 300 MPa pulsating on S_u 1220 MPa: 150/(1 - 150/1220) = 171.0 MPa reversed, and back.
    swing = float(goodman_reversed(0.0, 300e6, 1220e6))
    assert swing / 1e6 == pytest.approx(171.0, abs=0.05)
    assert goodman_pulsating(swing, 1220e6) == pytest.approx(300e6)
    assert float(goodman_reversed(-100e6, 100e6, 1220e6)) == pytest.approx(100e6)
    assert float(goodman_reversed(-300e6, 0.0, 1220e6)) == pytest.approx(150e6)


def _ranges() -> Counter[float]:
    counted: Counter[float] = Counter()
    for low, high, count in rainflow([-2, 1, -3, 5, -1, 3, -4, 4, -2]):
        counted[high - low] += count
    return counted


@pytest.mark.parametrize("row", published_rows("rainflow counting"), ids=label)
def test_rainflow_of_the_standard(row: Row, compared: Compared) -> None:
    compared(row, lambda: _ranges()[inputs(row)["range"]], rainflow)


def test_rainflow_finds_nothing_else() -> None:
    assert set(_ranges()) == {inputs(row)["range"] for row in published_rows("rainflow counting")}


def test_equivalent_load_of_two_halves() -> None:
    # P = ((P1^3 + P2^3)/2)^(1/3) for equal shares at one speed.
    loads = np.array([[[1000.0]], [[2000.0]]])
    found = equivalent_load(loads, np.array([0.5, 0.5]), np.array([1.0, 1.0]), 3.0)
    assert found[0] == pytest.approx(1650.96, abs=0.01)


def test_equivalent_load_of_catalogue_shapes() -> None:
    once, even = np.ones(1), (np.arange(2000) + 0.5) / 2000
    sine = np.sin(np.pi * even)[None, :, None]
    assert equivalent_load(sine, once, once, 3.0)[0] == pytest.approx(0.75, abs=0.005)
    rising = (2.0 + even)[None, :, None]
    assert equivalent_load(rising, once, once, 3.0)[0] == pytest.approx((2 + 2 * 3) / 3, rel=0.06)


def test_ten_times_the_load_at_a_thousand_turns_a_minute() -> None:
    # L10h = 1e6/(60 x 1000) (C/P)^p: 16 667 h for balls at C/P = 10, 35 907 h for rollers.
    speed = 1000.0 * 2.0 * np.pi / 60.0
    assert float(basic_rating_life_hours(10e3, 1e3, speed)) == pytest.approx(16_667, abs=1)
    rollers = basic_rating_life_hours(10e3, 1e3, speed, 10.0 / 3.0)
    assert float(rollers) == pytest.approx(35_907, abs=1)


def test_bearings_in_a_set() -> None:
    assert set_life([1000.0, 1000.0], "ball") == pytest.approx(536, abs=0.5)
    assert set_life([1000.0, 1000.0], "roller") == pytest.approx(540, abs=0.5)
    assert set_life([1000.0], "ball") == pytest.approx(1000.0)
