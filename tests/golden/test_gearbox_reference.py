"""Golden numbers of the rigid law, the pins and the cam bearing for two designs.

Made with this package and reproduced by hand formulas where a comment gives one. To regenerate:
``python tests/golden/test_gearbox_reference.py`` prints the dictionary; review the difference.

Reference gearbox: R 40, r 3, e 1.5 mm, ratio 10, two 8 mm discs, 6 pins of 4 mm on 23 mm, 60 N m.
Paper's design: R 32, r 3.5, e 1.6 mm, ratio 10, two 8 mm discs 0.5 mm apart, 5 pins of 4 mm on
19.5 mm, the cap hinged on them, at 120 and 40 N m.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cqdd_design.design import load_design
from cqdd_design.gearbox.bearing_life import basic_rating_life_hours
from cqdd_design.gearbox.hertz import effective_modulus
from cqdd_design.gearbox.loads import rigid_maxima
from cqdd_design.gearbox.stages import Stages
from cqdd_design.geometry import kinematics
from cqdd_design.machine import resolve

STEEL_4140 = float(effective_modulus(205e9, 0.29, 205e9, 0.29))
REFERENCE = Stages(
    lobe_count=10,
    disc_count=2,
    pin_count=6,
    ring_pitch_radius=40e-3,
    eccentricity=1.5e-3,
    tooth_radius=3e-3,
    pin_circle_radius=23e-3,
    hole_clocking=0.0,
    pin_contact_radius=2e-3,
    hole_radius=3.5e-3,
    contact_length=8e-3,
    ring_modulus=STEEL_4140,
    pin_modulus=STEEL_4140,
)
#: The paper's design with nominal pins (no fit) and every part of 4140.
PAPER = replace(
    REFERENCE,
    pin_count=5,
    ring_pitch_radius=32e-3,
    eccentricity=1.6e-3,
    tooth_radius=3.5e-3,
    pin_circle_radius=19.5e-3,
    hole_radius=3.6e-3,
)
DESIGN = Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml"


def computed() -> dict[str, float]:
    reference = rigid_maxima(REFERENCE, 60.0)
    angle = np.linspace(0.0, kinematics.ring_period(10), 20_001)
    ring_only = np.hypot(REFERENCE.ring_radial_force(30.0, angle), 30.0 / (10 * 1.5e-3)).max()
    numbers = {
        "reference ring_force_N": reference.ring_force,
        "reference output_pin_force_N": reference.output_pin_force,
        "reference cam_load_N": reference.cam_bearing_load,
        "reference cam_load_without_pins_N": float(ring_only),
    }
    for torque in (120.0, 40.0):
        found = rigid_maxima(PAPER, torque)
        numbers[f"paper ring_pressure_MPa at {torque:g}"] = found.ring_pressure / 1e6
        numbers[f"paper output_pressure_MPa at {torque:g}"] = found.output_pressure / 1e6
        numbers[f"paper cam_load_N at {torque:g}"] = found.cam_bearing_load
    pitch = 2.0 * np.pi / 10
    for name, clocking in (("0", 0.0), ("quarter", pitch / 4.0), ("half", pitch / 2.0)):
        one = replace(PAPER, disc_count=1, hole_clocking=clocking)
        numbers[f"one disc cam_load_N clocked {name}"] = rigid_maxima(one, 60.0).cam_bearing_load
    analysis = resolve(load_design(DESIGN)).analysis
    pins, maxima = analysis.output_pins, analysis.rigid
    numbers |= {
        "cqdd-10 ring_force_N": maxima.ring_force,
        "cqdd-10 ring_pressure_MPa": maxima.ring_pressure / 1e6,
        "cqdd-10 output_pressure_MPa": maxima.output_pressure / 1e6,
        "cqdd-10 cam_load_N": maxima.cam_bearing_load,
        "cqdd-10 pin_bending_peak_MPa": pins.bending_stress_peak / 1e6,
        "cqdd-10 pin_bending_continuous_MPa": pins.bending_stress_continuous / 1e6,
        "cqdd-10 paper_torque_per_pin_Nm": pins.paper_torque_per_pin,
        "cqdd-10 paper_torque_total_Nm": pins.paper_torque_total,
        "cqdd-10 shared_torque_capacity_Nm": pins.shared_torque_capacity,
        "cqdd-10 bending_torque_capacity_Nm": pins.bending_torque_capacity,
        "cqdd-10 profile_area_mm2": analysis.geometry.profile_area * 1e6,
        "cqdd-10 thinnest_ligament_mm": analysis.geometry.ligaments[0].thickness * 1e3,
        "cqdd-10 L10h": analysis.cam_bearing.life_hours or 0.0,
    }
    return {name: float(value) for name, value in numbers.items()}


GOLDEN = {
    "reference ring_force_N": 730.364526,
    "reference output_pin_force_N": 869.565217,
    "reference cam_load_N": 2461.8536,
    "reference cam_load_without_pins_N": 2047.87243,
    "paper ring_pressure_MPa at 120": 1526.85533,
    "paper output_pressure_MPa at 120": 1598.88509,
    "paper cam_load_N at 120": 5051.1239,
    "paper ring_pressure_MPa at 40": 881.530333,
    "paper output_pressure_MPa at 40": 923.116739,
    "paper cam_load_N at 40": 1683.70797,
    "one disc cam_load_N clocked 0": 5051.1239,
    "one disc cam_load_N clocked quarter": 5003.02133,
    "one disc cam_load_N clocked half": 4901.29991,
    "cqdd-10 ring_force_N": 1355.03743,
    "cqdd-10 ring_pressure_MPa": 1526.85533,
    "cqdd-10 output_pressure_MPa": 1584.47516,
    "cqdd-10 cam_load_N": 5003.02133,
    "cqdd-10 pin_bending_peak_MPa": 2420.66,
    "cqdd-10 pin_bending_continuous_MPa": 806.886668,
    "cqdd-10 paper_torque_per_pin_Nm": 59.129172,
    "cqdd-10 paper_torque_total_Nm": 295.64586,
    "cqdd-10 shared_torque_capacity_Nm": 140.843678,
    "cqdd-10 bending_torque_capacity_Nm": 8.46876471,
    "cqdd-10 profile_area_mm2": 2584.74703,
    "cqdd-10 thinnest_ligament_mm": 1.9045,
    "cqdd-10 L10h": 201.970139,
}


@pytest.fixture(scope="module")
def found() -> dict[str, float]:
    return computed()


@pytest.mark.parametrize("name", GOLDEN)
def test_golden(found: dict[str, float], name: str) -> None:
    assert found[name] == pytest.approx(GOLDEN[name], rel=1e-6)


def test_nothing_is_left_out(found: dict[str, float]) -> None:
    assert set(found) == set(GOLDEN)


def test_hand_formulas(found: dict[str, float]) -> None:
    """Forces of even pin counts, pressures with the root of the torque, and bearing life.

    Leaving out the output pins overstates the life 1.74 times with balls, 1.85 with rollers.
    """
    assert found["reference output_pin_force_N"] == pytest.approx(4.0 * 60.0 / (2 * 6 * 23e-3))
    ratio = found["paper ring_pressure_MPa at 120"] / found["paper ring_pressure_MPa at 40"]
    assert ratio == pytest.approx(3.0**0.5)
    with_pins = found["reference cam_load_N"]
    without = found["reference cam_load_without_pins_N"]
    for exponent, overstated in ((3.0, 1.74), (10.0 / 3.0, 1.85)):
        lives = [
            float(basic_rating_life_hours(5e3, load, 100.0, exponent))
            for load in (without, with_pins)
        ]
        assert lives[0] / lives[1] == pytest.approx(overstated, abs=0.005)


if __name__ == "__main__":
    for key, value in computed().items():
        print(f'    "{key}": {value:.9g},')
