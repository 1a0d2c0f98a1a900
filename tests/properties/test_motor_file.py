"""A motor from a file: conventions, what it leaves to the catalogue, and what no motor has."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import pytest

from cqdd_design.actuator.bench import run_bench
from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.design import load_design
from cqdd_design.design.motor import MotorFile, read_motor
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


def built(own: MotorFile) -> ActuatorParameters:
    return actuator_parameters(resolve(DESIGN.with_motor(motor=own)))


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
    own = built(found).motor
    assert own.torque_constant == pytest.approx(0.17, rel=1e-12)


def test_speed_constant_and_phase_values(motor):
    found = motor(
        f'based_on = "{DESIGN.motor.name}"\n'
        'speed_constant = "55 rpm/V"\nresistance = "71.5 mohm"\ninductance = "68.5 uH"\n'
        'measured_between = "phase"'
    )
    own = built(found)
    usual = actuator_parameters(resolve(DESIGN))
    # The very values of the catalogue's RO100, in other words.
    for name in ("torque_constant", "resistance", "inductance", "rotor_inertia", "peak_torque"):
        assert getattr(own.motor, name) == pytest.approx(getattr(usual.motor, name), rel=1e-3), name
    assert own.origins["motor.resistance"] == "file: motor.toml, line to line"
    assert own.origins["motor.rotor_inertia"].startswith("catalogue")


def test_cogging_of_the_file_must_be_overcome(motor):
    smooth = motor('cogging_amplitude = "0 N*m"')
    without = built(smooth)
    assert without.motor.cogging_amplitude == 0.0
    found = motor('cogging_amplitude = "0.02 N*m"\ncogging_order = 252')
    own = built(found)
    own = dataclasses.replace(own, friction=without.friction)
    bare, cogged = (
        run_bench(one, only=["backdrive_static"]).metrics[0].value for one in (without, own)
    )
    # What the output must bring for it, friction under load on the way at its breakaway.
    friction = own.friction
    passed = 1.0 - friction.load_backward * (1.0 + friction.stribeck_extra)
    assert cogged - bare == pytest.approx(0.02 * 10.0 / passed, rel=0.1)


def test_drag_of_the_file_is_the_whole_drag(motor):
    """Whoever measures one part of it measured all: nothing of the catalogue's comes on top."""
    found = motor('hysteresis = "20 mN*m"\niron_loss = "4e-4 N*m*s/rad"')
    own = built(found)
    assert (own.motor.dry_drag, own.motor.drag_slope) == pytest.approx((0.02, 4e-4), rel=1e-12)
    assert own.motor.coulomb == own.motor.viscous == 0.0
    assert own.origins["motor.hysteresis"] == "file: motor.toml"
    assert own.origins["motor.coulomb"] == "file: motor.toml, which gives the drag without it"
    # Cogging is none of the drag, and stays the catalogue's.
    usual = actuator_parameters(resolve(DESIGN))
    assert own.motor.cogging_amplitude == usual.motor.cogging_amplitude == 0.055
    more = motor('coulomb = "0.12 N*m"\nviscous = "1 mN*m*s/rad"')
    own = built(more)
    assert (own.motor.coulomb, own.motor.viscous) == pytest.approx((0.12, 1e-3), rel=1e-12)
    assert own.origins["motor.rotor_inertia"].startswith(
        "catalogue: CubeMars RO100 Lite KV55, its bell"
    )


def test_a_rotor_that_no_mass_within_the_diameter_can_have(motor):
    found = motor('rotor_inertia = "2e-3 kg*m^2"')
    with pytest.raises(CqddError, match=r"is more than 0.525 kg within 108.3 mm can have"):
        resolve(DESIGN.with_motor(motor=found))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ('coulomb = "-0.1 N*m"', "outside 0 N"),
        ('coulomb = "inf N*m"', "coulomb"),
        ('coulomb = "0.1 W"', "not a unit of torque"),
        ("coulomb = 0.1", "has no unit"),
        ('viscous = "-1e-4 N*m*s/rad"', "outside 0 N"),
        ('viscous = "0.1 N*m"', "viscous"),
        ('hysteresis = "nan N*m"', "hysteresis"),
        ('cogging_amplitude = "-5 mN*m"', "outside 0 N"),
        ("cogging_order = 0", "whole number from 1"),
        ('resistance = "0 ohm"', "outside 0.00001 ohm to"),
        ('resistance = "-1 ohm"', "outside 0.00001 ohm to"),
        ('rotor_inertia = "-1e-4 kg*m^2"', "rotor with its bell, if it is known"),
        ('rotor_inertia = "0 kg*m^2"', "rotor with its bell, if it is known"),
        ("resistance = 0.1", "has no unit"),
        ('resistance = "0.1 N"', "not a unit of resistance"),
        ('mass = "1 kg"\nrotor_mass = "0.4 kg"\nstator_mass = "0.5 kg"', "keep it, or keep both"),
        ('rotor_mass = "0.4 kg"', "give both, or mass"),
        ('measured_between = "phase"', "resistance and an inductance, which are missing"),
        ('bore_diameter = "80 mm"\nouter_diameter = "70 mm"', "is not inside outer_diameter"),
        ('based_on = "CubeMars AK80-9 V3"', "is a geared actuator"),
        ('based_on = "CubeMars R0100"', "the catalogue has no motor"),
        ('name = "CubeMars RO80 KV105"\nbased_on = "CubeMars RI60 KV120"', "is another; leave"),
        ('winding_limit = "1000 degC"', "outside 40 degC to 300 degC"),
        ('resistanc = "0.1 ohm"', "did you mean 'resistance'"),
        ('torque_constant = "0.1 N*m/A"\nspeed_constant = "55 rpm/V"', "keep one"),
        ('convention = "dc"', "torque_constant, which is missing"),
        ('torque_constant = "0.1 N*m/A"\nconvention = "rms"', "must be 'dc'"),
        ('measured_between = "wire"', "must be 'line' or 'phase'"),
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
