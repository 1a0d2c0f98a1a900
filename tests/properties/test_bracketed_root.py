"""Brent's root against scipy's: the same numbers, the same steps."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from cqdd_design.gearbox.bracketed_root import bracketed_root

FUNCTIONS = {
    "power": lambda x, c: x**3.7 - c,
    "logarithm": lambda x, c: math.log(x) - c,
    "flat": lambda x, c: (x - c) ** 3 + 0.01 * (x - c),
    "step": lambda x, c: math.tanh(50.0 * (x - c)) + 0.1,
    "falling": lambda x, c: math.exp(-x) - 0.1 * c,
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_roots_are_scipys_to_the_bit(name: str) -> None:
    """Over random roots, ends and tolerances; and as many values of the function are asked."""
    rng = np.random.default_rng(5)
    met = 0
    for _ in range(300):
        c, low, high = rng.uniform(0.2, 4.0), rng.uniform(0.01, 2.0), rng.uniform(2.0, 9.0)
        absolute, relative = 10.0 ** rng.uniform(-15, -3), 10.0 ** rng.uniform(-15, -6)
        asked: list[float] = []

        def function(x: float, c: float = c, asked: list[float] = asked) -> float:
            asked.append(x)
            return float(FUNCTIONS[name](x, c))

        if function(low) * function(high) > 0.0:
            continue
        asked.clear()
        ours = bracketed_root(function, low, high, absolute=absolute, relative=relative)
        steps = asked.copy()
        asked.clear()
        assert ours == brentq(function, low, high, xtol=absolute, rtol=relative)
        assert steps == asked
        met += 1
    assert met > 30


def test_an_end_may_be_the_root_and_no_bracket_is_refused() -> None:
    assert bracketed_root(lambda x: x, 0.0, 1.0, absolute=1e-9) == 0.0
    assert bracketed_root(lambda x: x - 1.0, 0.0, 1.0, absolute=1e-9) == 1.0
    with pytest.raises(ValueError, match="no root"):
        bracketed_root(lambda x: x + 2.0, 0.0, 1.0, absolute=1e-9)
    with pytest.raises(ValueError, match="after 100 steps"):
        bracketed_root(lambda x: (x - 1.7) ** 9, 0.0, 3.0, absolute=1e-15)
    with pytest.raises(ValueError, match="not a number"):
        bracketed_root(lambda x: x - 0.5 if x in (0.0, 1.0) else math.nan, 0.0, 1.0, absolute=1e-9)
