"""Life: stress-cycle factors of AGMA 2101-D04 (figure 17) and ISO 281 lives."""

from __future__ import annotations

import numpy as np
import pytest

from cqdd_design.gearbox.life.fatigue import contact_cycle_factor, contact_cycles
from cqdd_design.gearbox.life.life import equivalent_load


@pytest.mark.parametrize(
    ("cycles", "factor", "tolerance"),
    [
        (1e4, 1.472, 1e-3),
        (1e6, 1.138, 1e-3),
        (1e7, 1.000, 1e-3),
        (1e8, 0.948, 1e-3),
        (1e10, 0.853, 1e-3),
    ],
)
def test_stress_cycle_factor(cycles: float, factor: float, tolerance: float) -> None:
    assert float(contact_cycle_factor(cycles)) == pytest.approx(factor, abs=tolerance)


def test_the_two_branches_meet_at_the_knee() -> None:
    below, above = contact_cycle_factor([1e7, 1e7 * (1 + 1e-9)])
    assert below == pytest.approx(above, abs=2e-3)


@pytest.mark.parametrize("cycles", [1e5, 1e6, 3e7, 1e9])
def test_cycles_invert_the_factor(cycles: float) -> None:
    pressure = 944e6 * float(contact_cycle_factor(cycles))
    assert float(contact_cycles(pressure, 944e6)) == pytest.approx(cycles, rel=1e-6)


def test_equivalent_load_of_two_halves() -> None:
    # ISO 281: P = ((P1^3 + P2^3)/2)^(1/3) for equal shares at one speed.
    loads = np.array([[[1000.0]], [[2000.0]]])
    found = equivalent_load(loads, np.array([0.5, 0.5]), np.array([1.0, 1.0]), 3.0)
    assert found[0] == pytest.approx((0.5 * (1e9 + 8e9)) ** (1 / 3))
