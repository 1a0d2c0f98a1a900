"""The comparison with a planetary: the cycloid's limits are those of its checks."""

import math
from pathlib import Path

import pytest

from cqdd_design.design import load_design
from cqdd_design.errors import UsageError
from cqdd_design.machine import resolve
from cqdd_design.sizing.comparison import (
    DEFAULT_STEEL,
    compare_with_planetary,
    cycloid_limits,
)

PAPER = load_design(Path(__file__).parents[2] / "designs" / "cqdd-10.toml")


def test_at_its_capacity_a_limit_is_just_met():
    """Every capacity, computed from one torque, is where the check itself turns."""
    for limit in cycloid_limits(resolve(PAPER).analysis):
        key = f"requirements.{limit.load}_torque"
        torque = {"requirements.peak_torque": 2000.0, key: limit.torque_capacity}
        if limit.load == "peak":
            torque["requirements.continuous_torque"] = 0.5 * limit.torque_capacity
        again = cycloid_limits(resolve(PAPER.replacing(torque)).analysis)
        (same,) = [one for one in again if one.title == limit.title]
        assert math.isclose(same.value, limit.limit, rel_tol=1e-6), limit


def test_every_strength_check_of_ring_pins_and_bearing_takes_part():
    limits = cycloid_limits(resolve(PAPER).analysis)
    assert {limit.part for limit in limits} == {"ring teeth", "output pins", "cam bearing"}
    assert len(limits) == 10


def test_discs_of_bronze_are_compared_with_gears_of_steel():
    design = PAPER.replacing({"reducer.disc_material": "Bronze CuSn12"})
    found = compare_with_planetary(resolve(design))
    assert found.material.label.startswith(DEFAULT_STEEL)
    assert DEFAULT_STEEL in found.warnings[0]
    with pytest.raises(UsageError):
        compare_with_planetary(resolve(design), material="Bronze CuSn12")


def test_options_left_out_are_the_papers():
    found = compare_with_planetary(resolve(PAPER)).to_dict()["planetary"]
    assert found["ratio"] == pytest.approx(10.5455, abs=1e-4)
    assert found["centre_distance_mm"] == pytest.approx(24.0)
    assert found["planets_that_fit"] == 3
    other = compare_with_planetary(resolve(PAPER), module=2e-3, planets=2).to_dict()["planetary"]
    assert other["centre_distance_mm"] == pytest.approx(48.0)
    assert other["planets"] == 2
