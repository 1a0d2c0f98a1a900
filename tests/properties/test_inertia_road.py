"""One balance on every road, and the counterweights that would balance a stack."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from cqdd_design.design import load_design
from cqdd_design.errors import GeometryError
from cqdd_design.gearbox.balance import stack_balance
from cqdd_design.machine import resolve
from cqdd_design.machine.weighing import weigh
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
        balance={discs: found},
        inertia=SimpleNamespace(to_dict=dict, mass=1.0, whole_mass=1.0, mass_scope=""),
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


@pytest.mark.parametrize("discs", [1, 2, 3])
def test_check_analyse_and_inertia_tell_the_same_balance(discs: int) -> None:
    """Eccentrics included: the same numbers under the same keys, to the last digit."""
    changes = {"reducer.disc_count": discs, "reducer.disc_thickness": 6e-3}
    design = PAPER.replacing({**changes, "reducer.cam_bearing.designation": "6802"})
    machine = resolve(design)
    told = weigh(machine).balance[discs].to_dict()
    assert machine.analysis.to_dict()["balance"] == told
    check = {one.id: one for one in machine.analysis.checks}["BALANCE-STATIC"]
    assert check.value == 1e6 * told["static_unbalance_kgm"]
    assert told["shaking_moment_Nm"] == told["couple_unbalance_kgm2"] * (
        design.requirements.input_speed**2
    )
    # And another number of discs is balanced as the design with that number would be.
    other = 1 if discs != 1 else 2
    alone = resolve(design.replacing({"reducer.disc_count": other})).balance
    assert weigh(machine).balance[other] == alone


WEIGHTS = {"reducer.disc_count": 1, "reducer.balance.counterweights": True}


def test_weights_as_drawn_leave_nothing_to_the_checks() -> None:
    checks = {one.id: one for one in resolve(PAPER.replacing(WEIGHTS)).analysis.checks}
    assert checks["BALANCE-STATIC"].value == checks["BALANCE-COUPLE"].value == 0.0
    assert "as drawn" in checks["BALANCE-STATIC"].substituted
    assert "BALANCE-WEIGHTS" not in checks


def test_weights_that_cannot_be_built_balance_nothing() -> None:
    """A stator too narrow for a neck: there is no bell to carry weights, and it is said."""
    narrow = {"name": "CubeMars RO100 Lite KV55", "bore_diameter": "20 mm"}
    wide = PAPER.replacing({**WEIGHTS, "motor": narrow, "reducer.ring.outer_diameter": 0.11})
    bare = resolve(wide.replacing({"reducer.balance.counterweights": False}))
    machine = resolve(wide)
    with pytest.raises(GeometryError, match="sit on the motor's bell"):
        weigh(machine)
    checks = {one.id: one for one in machine.analysis.checks}
    static = checks["BALANCE-STATIC"]
    real = weigh(bare).balance[1].static_unbalance
    assert real > 1e-4
    assert static.value == 1e6 * real
    assert static.status == checks["BALANCE-WEIGHTS"].status == "fail"
    assert "on a neck in its 20 mm stator bore" in static.substituted
    assert "choose another motor.name" in checks["BALANCE-WEIGHTS"].remedy


def test_two_discs_pass_by_themselves_but_not_without_the_weights_they_ask_for() -> None:
    """Nothing to cancel statically, so only the line of the weights fails."""
    heavy = {"reducer.balance.counterweights": True, "motor.name": "CubeMars R100 KV90"}
    checks = {one.id: one for one in resolve(PAPER.replacing(heavy)).analysis.checks}
    assert checks["BALANCE-STATIC"].status == "pass"
    assert checks["BALANCE-COUPLE"].value > 0.0
    assert checks["BALANCE-WEIGHTS"].status == "fail"


def test_weights_too_heavy_for_the_bell_leave_the_whole_unbalance() -> None:
    thick = {**WEIGHTS, "reducer.disc_thickness": 60e-3}
    checks = {one.id: one for one in resolve(PAPER.replacing(thick)).analysis.checks}
    assert checks["BALANCE-STATIC"].value > 500.0
    assert checks["BALANCE-STATIC"].status == "fail"
    assert "the motor's bell has room for" in checks["BALANCE-WEIGHTS"].remedy
