"""Figures of the paper: consistent with each other, and beside its own actuator alone."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from cqdd_design.actuator.bench import METRICS
from cqdd_design.catalog import paper
from cqdd_design.design import load_design
from cqdd_design.gearbox.output_pins import single_shear_torque_per_pin

PAPER = load_design(Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml")
KSI = 6.894757e6


def test_every_measured_figure_is_a_row_of_the_bench_and_says_its_place() -> None:
    assert set(paper.METRICS) == set(METRICS)
    assert paper.METRICS["stall_torque"] == paper.METRICS["peak_torque"]
    assert all("table" in figure.place for figure in paper.METRICS.values())


def test_figures_agree_with_each_other() -> None:
    value = {name: figure.value for name, figure in paper.METRICS.items()}
    assert value["peak_torque"] / value["mass"] == pytest.approx(value["torque_density"], abs=0.05)
    counts = 2**14 * paper.RATIO
    assert 360.0 / counts == pytest.approx(value["output_resolution"], rel=5e-3)
    # The constant that the speed without load stands for, and the limit behind the peak torque.
    constant = paper.SUPPLY_VOLTAGE / (value["no_load_speed"] * paper.RATIO * math.pi / 30.0)
    limit = paper.ACTUATOR["motor.current_limit"]
    assert constant * float(limit) * paper.RATIO == pytest.approx(value["peak_torque"], rel=2e-3)


def test_pins_are_those_of_the_printed_capacity() -> None:
    told = paper.ACTUATOR
    each = single_shear_torque_per_pin(
        float(told["reducer.output_pins.diameter"]),
        35.0 * KSI,
        float(told["reducer.output_pins.circle_radius"]),
    )
    assert each == pytest.approx(paper.PIN_TORQUE, abs=5e-3)
    assert told["reducer.output_pins.count"] == 5
    assert pytest.approx(paper.PINS_TORQUE) == 5 * paper.PIN_TORQUE


@pytest.mark.parametrize(
    "changes",
    [
        {"name": "another name"},
        {"tolerances.tooth_position": "4 um", "reducer.friction.tooth": 0.03},
        {"reducer.output_pins.hole_clearance": "20 um", "drive.thermal_resistance": "0.7 K/W"},
    ],
)
def test_a_copy_of_the_papers_actuator_is_one(changes: dict[str, object]) -> None:
    assert paper.is_papers_actuator(PAPER.replacing(changes))


@pytest.mark.parametrize(
    "changes",
    [
        {"reducer.output_pins.count": 6},
        {"reducer.output_pins.diameter": "4.5 mm"},
        {"reducer.eccentricity": "1.5 mm"},
        {"reducer.ring_type": "pinwheel"},
        {"reducer.disc_count": 3},
        {"motor.name": "CubeMars RI100 KV105"},
        {"motor.current_limit": "40 A"},
    ],
)
def test_another_machine_is_not_the_papers_by_its_name(changes: dict[str, object]) -> None:
    other = PAPER.replacing(changes)
    assert other.name == "cqdd-10"
    assert not paper.is_papers_actuator(other)
