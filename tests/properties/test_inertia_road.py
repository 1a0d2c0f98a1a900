"""What the inertia road adds to the bodies: the counterweights that would balance a stack."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from cqdd_design.design import load_design
from cqdd_design.gearbox.balance import stack_balance
from cqdd_design.machine import resolve
from cqdd_design.results import MassProperties
from cqdd_design.roads.inertia import InertiaAndBalance

PAPER = load_design(Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml")


@pytest.mark.parametrize("discs", [1, 2])
def test_weights_of_the_stated_moment_at_both_ends_balance_the_stack(discs: int) -> None:
    """Half of the static moment at each end, or a pair against the couple, at the pack's ends."""
    reducer = PAPER.reducer
    b, s, e, mass, speed = reducer.disc_thickness, reducer.disc_spacing, 1.6e-3, 0.1, 130.0
    found = stack_balance(mass, e, b, s, discs, speed)
    bodies = SimpleNamespace(
        balance={discs: found}, inertia=SimpleNamespace(to_dict=dict, total=MassProperties(1.0))
    )
    document = InertiaAndBalance(resolve(PAPER), bodies, 2).to_dict()  # type: ignore[arg-type]
    moment = document["balance"]["by_disc_count"][str(discs)]["counterweight_each_end_kgm"]
    half = 0.5 * (discs * b + (discs - 1) * s)
    # One disc stands on +x: both weights opposite. Of two the lower stands on +x, the upper on -x.
    sides = (-1.0, -1.0) if discs == 1 else (-1.0, 1.0)
    weights = [
        MassProperties(1.0, np.array([side * moment, 0.0, z]))
        for side, z in zip(sides, (-half, half), strict=True)
    ]
    left = stack_balance(mass, e, b, s, discs, speed, weights)
    assert left.static_unbalance == pytest.approx(0.0, abs=1e-12)
    assert left.couple_unbalance == pytest.approx(0.0, abs=1e-9 * found.couple_unbalance + 1e-15)
