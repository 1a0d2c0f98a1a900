"""A motor from a file: conventions, what it leaves to the catalogue, and what no motor has."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from cqdd_design.actuator.bench import run_bench
from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.motor_file import read_motor
from cqdd_design.actuator.specimen import Specimen
from cqdd_design.design import load_design
from cqdd_design.errors import CqddError
from cqdd_design.machine import resolve

DESIGN = load_design(Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml")


@pytest.fixture
def motor(tmp_path: Path):  # type: ignore[no-untyped-def]
    """Read a motor from a text."""

    def read(text: str):  # type: ignore[no-untyped-def]
        path = tmp_path / "motor.toml"
        path.write_text(text)
        return read_motor(path)

    return read


@pytest.mark.parametrize(
    ("convention", "factor"),
    [
        ("dc", 1.0),
        ("torque_per_peak", math.sqrt(3.0) / 2.0),
        ("torque_per_rms", math.sqrt(1.5)),
        ("emf_phase_peak", 1.0 / math.sqrt(3.0)),
    ],
)
def test_constants_of_every_convention_are_one_motor(motor, convention, factor):
    found = motor(f'torque_constant = "{0.17 * factor!r} N*m/A"\nconvention = "{convention}"')
    own = actuator_parameters(Specimen(motor=found).machine(DESIGN), Specimen(motor=found)).motor
    assert own.torque_constant == pytest.approx(0.17, rel=1e-12)


def test_speed_constant_and_phase_values(motor):
    found = motor(
        'speed_constant = "55 rpm/V"\nresistance = "71.5 mohm"\ninductance = "68.5 uH"\n'
        'measured_between = "phase"'
    )
    own = actuator_parameters(Specimen(motor=found).machine(DESIGN), Specimen(motor=found))
    usual = actuator_parameters(resolve(DESIGN))
    # The very values of the catalogue's RO100, in other words.
    for name in ("torque_constant", "resistance", "inductance", "rotor_inertia", "peak_torque"):
        assert getattr(own.motor, name) == pytest.approx(getattr(usual.motor, name), rel=1e-3), name
    assert own.origins["motor.resistance"] == "file: motor.toml"
    assert own.origins["motor.rotor_inertia"].startswith("catalogue")


def test_cogging_of_the_file_must_be_overcome(motor):
    found = motor('cogging_amplitude = "0.02 N*m"\ncogging_order = 252')
    bare = (
        run_bench(actuator_parameters(resolve(DESIGN)), only=["backdrive_static"]).metrics[0].value
    )
    own = actuator_parameters(Specimen(motor=found).machine(DESIGN), Specimen(motor=found))
    cogged = run_bench(own, only=["backdrive_static"]).metrics[0].value
    # What the output must bring for it, friction under load on the way at its breakaway.
    friction = own.friction
    passed = 1.0 - friction.load_backward * (1.0 + friction.stribeck_extra)
    assert cogged - bare == pytest.approx(0.02 * 10.0 / passed, rel=0.1)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ('resistance = "0 ohm"', "must be above 0"),
        ('resistance = "-1 ohm"', "must be above 0"),
        ('rotor_inertia = "-1e-4 kg*m^2"', "must be 0 or more"),
        ("resistance = 0.1", "has no unit"),
        ('resistance = "0.1 N"', "not a unit of resistance"),
        ('resistanc = "0.1 ohm"', "did you mean 'resistance'"),
        ('torque_constant = "0.1 N*m/A"\nspeed_constant = "55 rpm/V"', "keep one"),
        ('convention = "dc"', "torque_constant, which is missing"),
        ('torque_constant = "0.1 N*m/A"\nconvention = "rms"', "none of dc"),
        ('measured_between = "wire"', "none of line, phase"),
        ("pole_pairs = 0", "whole number from 1"),
        ("pole_pairs = 2.5", "whole number from 1"),
        ("name = ", "is not valid TOML"),
    ],
)
def test_impossible_motors_are_refused(motor, text, says):
    with pytest.raises(CqddError, match=says):
        motor(text)


def test_missing_file(tmp_path):
    with pytest.raises(CqddError, match="cannot read"):
        read_motor(tmp_path / "none.toml")
