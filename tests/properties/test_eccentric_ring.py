"""An eccentric ring pressed on a core: Lame, Betti, finite elements, and what is known besides."""

from __future__ import annotations

import numpy as np
import pytest
from pressed_ring_fe import pressed_ring_fe

from cqdd_design.catalog.materials import find_material
from cqdd_design.gearbox import eccentric_ring
from cqdd_design.gearbox.eccentric_ring import pressed_ring

STEEL = find_material("AISI 4140 Q&T 540C")
SHAPES = ((5e-3, 8.5e-3, 1.5e-3), (5.11e-3, 8.5e-3, 2.54e-3), (4e-3, 7.5e-3, 2.9e-3))


@pytest.mark.parametrize("core", [3e-3, 5e-3, 7.5e-3])
def test_concentric_it_is_lame(core: float) -> None:
    outside, interference = 8.5e-3, 10e-6
    share = (core / outside) ** 2
    on = pressed_ring(core, outside, 0.0, interference, STEEL)
    pressure = STEEL.youngs_modulus * interference / (4.0 * core) * (1.0 - share)
    assert on.pressure == pytest.approx(pressure, rel=1e-9)
    assert on.across == pytest.approx(pressure, rel=1e-9)
    assert on.hoop == pytest.approx(pressure * (1.0 + share) / (1.0 - share), rel=1e-9)
    assert on.out_of_round < 1e-15
    pushed = 20e6
    both = on.across + pushed
    assert on.mises(pushed) == pytest.approx(np.sqrt(on.hoop**2 + on.hoop * both + both**2))


@pytest.mark.parametrize(("core", "outside", "throw"), SHAPES)
def test_its_outside_grows_as_betti_says(core: float, outside: float, throw: float) -> None:
    """Of a solid core, by delta a/b: an even pull on the outside widens both alike."""
    on = pressed_ring(core, outside, throw, 10e-6, STEEL)
    assert on.growth == pytest.approx(10e-6 * core / outside, rel=1e-9)
    twice = pressed_ring(core, outside, throw, 20e-6, STEEL)
    assert twice.hoop == pytest.approx(2.0 * on.hoop)


@pytest.mark.parametrize(("core", "outside", "throw"), SHAPES)
def test_more_terms_change_nothing(
    core: float, outside: float, throw: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    few = pressed_ring(core, outside, throw, 10e-6, STEEL)
    monkeypatch.setattr(eccentric_ring, "_TERMS", 44)
    monkeypatch.setattr(eccentric_ring, "_POINTS", 332)
    many = pressed_ring(core, outside, throw, 10e-6, STEEL)
    assert many.mises() == pytest.approx(few.mises(), rel=1e-4)


def test_an_even_pressure_says_too_little() -> None:
    """Jeffery 1921 (Timoshenko and Goodier 1970, section 66), with the joint's mean pressure."""
    a, b, e = SHAPES[1]
    on = pressed_ring(a, b, e, 10e-6, STEEL)
    above = 2.0 * b**2 * (b**2 + a**2 - 2.0 * a * e - e**2)
    below = (a**2 + b**2) * (b**2 - a**2 - 2.0 * a * e - e**2)
    assert on.pressure * (above / below - 1.0) == pytest.approx(0.87 * on.hoop, rel=0.01)


def test_the_thinner_its_side_the_more_it_bears() -> None:
    walls = [pressed_ring(5e-3, 8.5e-3, throw, 10e-6, STEEL) for throw in (0.5e-3, 1.5e-3, 2.7e-3)]
    assert sorted(one.mises() for one in walls) == [one.mises() for one in walls]


@pytest.mark.parametrize("interference", [0.0, -5e-6])
def test_a_play_puts_nothing_into_it(interference: float) -> None:
    on = pressed_ring(5e-3, 8.5e-3, 1.5e-3, interference, STEEL)
    assert (on.mises(), on.growth, on.out_of_round) == (0.0, 0.0, 0.0)


@pytest.mark.deep
@pytest.mark.parametrize(("core", "outside", "throw"), SHAPES)
def test_finite_elements_say_the_same(core: float, outside: float, throw: float) -> None:
    on = pressed_ring(core, outside, throw, 10e-6, STEEL)
    mises, growth = pressed_ring_fe(
        core, outside, throw, 10e-6, STEEL.youngs_modulus, STEEL.poisson_ratio
    )
    assert on.mises() == pytest.approx(mises, rel=0.02)
    assert on.growth == pytest.approx(growth, rel=0.005)
