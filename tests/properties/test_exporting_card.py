"""Actuator card: both sides of every number, all of the parameters, and senses in each client."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from actuator_samples import paper_actuator, random_actuators
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from cqdd_design import __version__
from cqdd_design.actuator.joint_side import joint_side
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.exporting.simulators.actuator_card import (
    actuator_card,
    card_markdown,
    card_yaml,
)
from cqdd_design.exporting.simulators.card_clients import clients
from cqdd_design.exporting.simulators.card_rows import card_table
from cqdd_design.exporting.simulators.stated import effort_limit
from cqdd_design.exporting.simulators.yaml_text import yaml_text

TORQUES = ("torque_constant", "peak_torque", "stall_torque", "coulomb", "breakaway", "cogging")
SPEEDS = ("no_load_speed", "ideal_speed", "stribeck_speed", "backlash", "encoder_step")
SQUARES = ("motor_side_inertia", "output_inertia", "viscous", "stiffness", "position_gain")


def isaac_dc_motor(settings: dict[str, float], error: float, speed: float) -> float:
    """Torque of Isaac Lab's DCMotor (actuator_pd.py, release 2.3.2), which mjlab shares."""
    asked = settings["stiffness"] * error - settings["damping"] * speed
    top, limit, fastest = (
        settings["saturation_effort"],
        settings["effort_limit"],
        settings["velocity_limit"],
    )
    most = fastest * (1.0 + limit / top)
    held = float(np.clip(speed, -most, most))
    highest = min(top * (1.0 - held / fastest), limit)
    lowest = max(top * (-1.0 - held / fastest), -limit)
    return float(np.clip(asked, lowest, highest))


@settings(max_examples=examples(50), deadline=None)
@given(p=random_actuators())
def test_reflection(p: ActuatorParameters) -> None:
    rows = {row.key: row for row in actuator_card(p, "drawn").rows}
    n = abs(p.gear.ratio)
    for keys, factor in ((TORQUES, n), (SPEEDS, 1.0 / n), (SQUARES, n**2)):
        for key in keys:
            motor, joint = rows[key].motor, rows[key].joint
            assert motor is not None
            assert joint == pytest.approx(motor * factor)
    whole = n**2 * (p.motor.rotor_inertia + p.gear.input_inertia) + p.gear.output_inertia
    assert rows["reflected_inertia"].joint == pytest.approx(whole)


@settings(max_examples=examples(50), deadline=None)
@given(p=random_actuators(), error=st.floats(1e-3, 1.0))
def test_positive_error_gives_positive_torque_in_every_client(
    p: ActuatorParameters, error: float
) -> None:
    settings = actuator_card(p, "drawn").settings
    # At standstill the supply may end the torque before the drive and friction do.
    limit = min(effort_limit(p), joint_side(p).stall_torque)
    for client, kind in (("isaac_lab", "DCMotorCfg"), ("mjlab", "DcMotorActuatorCfg")):
        numbers = {key: float(str(one)) for key, one in settings[client][kind].items()}
        assert isaac_dc_motor(numbers, error, 0.0) > 0.0 or limit == 0.0
        assert isaac_dc_motor(numbers, -error, 0.0) < 0.0 or limit == 0.0
        # The motor gives nothing above its no-load speed, and no more than the drive allows.
        assert isaac_dc_motor(numbers, 1e9, numbers["velocity_limit"]) == pytest.approx(0.0)
        assert isaac_dc_motor(numbers, 1e9, 0.0) == pytest.approx(limit)
    for part in settings.values():
        for values in part.values():
            assert all(float(str(one)) >= 0.0 for one in values.values())


def test_torque_over_speed_is_that_of_the_motor() -> None:
    """Between corner and no-load speed Isaac Lab's line is (V - K n w)/R K n."""
    p = paper_actuator()
    numbers = {
        key: float(str(one))
        for key, one in actuator_card(p, "paper").settings["isaac_lab"]["DCMotorCfg"].items()
    }
    for speed in (11.3, 12.5, 13.4):
        torque = 1.78 * (24.0 - 1.78 * speed) / 0.098
        assert isaac_dc_motor(numbers, 1e9, speed) == pytest.approx(torque)


def test_every_parameter_is_on_the_card() -> None:
    """Changing any value of the parameters changes the YAML."""
    p = paper_actuator()
    before = card_yaml(actuator_card(p, "paper"))
    for part in ("motor", "drive", "thermal", "friction", "gear"):
        group = getattr(p, part)
        for one in dataclasses.fields(group):
            old = getattr(group, one.name)
            new = old + 1 if isinstance(old, int) or one.name == "error_orders" else old * 1.01
            zeros = ("bristle_damping", "coulomb", "viscous", "load_knee", "load_growth")
            none = one.name in zeros
            if none or (np.ndim(old) and one.name != "error_orders"):
                new = old + 1e-3
            changed = dataclasses.replace(
                p, **{part: dataclasses.replace(group, **{one.name: new})}
            )
            assert card_yaml(actuator_card(changed, "paper")) != before, f"{part}.{one.name}"


def test_constants_are_those_at_the_temperature_of_the_place() -> None:
    p = paper_actuator()
    hot = dataclasses.replace(p, thermal=dataclasses.replace(p.thermal, ambient=60.0))
    card = actuator_card(hot, "paper")
    k, r = 0.178 * (1.0 - 0.0011 * 35.0), 0.098 * (1.0 + 0.0039 * 35.0)
    own = card.settings["mujoco"]["dcmotor"]
    assert (own["motorconst"], own["resistance"]) == pytest.approx((k, r))
    assert card.settings["bam"]["m5"]["kt"] == pytest.approx(10.0 * k)
    assert card.settings["isaac_lab"]["DCMotorCfg"]["velocity_limit"] == pytest.approx(2.4 / k)
    rows = {row.key: row for row in card.rows}
    assert (rows["torque_constant"].motor, rows["resistance"].motor) == pytest.approx((k, r))
    assert rows["torque_constant"].origin.endswith("taken to 60 degC")
    assert "taken to" not in card_markdown(actuator_card(p, "paper"))
    assert "hold at 60 degC around" in card_markdown(card)


def test_yaml_reads_back() -> None:
    yaml = pytest.importorskip("yaml", reason="PyYAML is not installed")
    p = dataclasses.replace(
        paper_actuator(), motor=dataclasses.replace(paper_actuator().motor, rated_torque=math.nan)
    )
    card, again = (actuator_card(p, "paper", design_sha256="c0ffee") for _ in range(2))
    assert card_markdown(card) == card_markdown(again)
    text = card_yaml(card)
    assert text == card_yaml(again)
    document = yaml.safe_load(text)
    assert f"cqdd-design {__version__}" in text
    assert document["design_sha256"] == "c0ffee"
    assert document["sense"]["signed_ratio"] == -10.0
    assert document["sense"]["crank"] == "against the joint"
    assert document["harmonics"]["orders"] == [1, 5, 10, 11, 20]
    for row in card.rows:
        found = document["parameters"][row.key]
        for side in ("motor", "joint"):
            value = getattr(row, side)
            assert (found[side] is None) == (value is None)
            if value is not None:
                assert isinstance(found[side], float)
                assert found[side] == pytest.approx(value, rel=1e-11)
        assert found["unit"] == row.unit
    assert document["parameters"]["rated_torque"]["motor"] is None
    assert document["parameters"]["backlash"]["origin"].startswith("computed")
    assert set(document["clients"]) == {client.key for client in clients()}


def test_markdown_tells_both_sides_with_numbers_and_what_was_not_run() -> None:
    text = card_markdown(actuator_card(paper_actuator(), "paper"))
    assert "0.000501 x 100 = 0.0501 (n^2)" in text
    assert "catalogue (speed constant 55 rpm/V)" in text
    assert "v = R i + L di/dt + K w" in text
    assert "not run" in text
    assert "with a network of `torque export` set armature, friction and damping" in text
    assert f"cqdd-design {__version__}" in text
    rows = [line for line in text.splitlines() if line.startswith("| backlash, whole")]
    assert len(rows) == 2
    widths = {line.count("|") for line in text.splitlines() if line.startswith("| torque constant")}
    assert widths == {7, len(clients()) + 2}


def test_names_belong_to_rows_and_clients() -> None:
    keys = [row.key for row in actuator_card(paper_actuator(), "paper").rows]
    assert keys == [row["key"] for row in card_table()]
    assert len(set(keys)) == len(keys)
    assert set(list(card_table()[0])[6:]) == {client.key for client in clients()}


@settings(max_examples=examples(200), deadline=None)
@given(
    document=st.recursive(
        st.none()
        | st.booleans()
        | st.integers()
        | st.floats(allow_nan=False, allow_infinity=False)
        | st.text(
            st.characters(
                codec="utf-8",
                exclude_characters="\x7f\x85\u2028\u2029\ufeff",
                exclude_categories=("Cs", "Cc", "Cn", "Co"),
            )
        ),
        lambda inner: st.dictionaries(st.text("abcxyzno-: 1", min_size=1), inner),
        max_leaves=8,
    ).filter(lambda found: isinstance(found, dict))
)
def test_yaml_of_any_plain_data(document: dict[str, object]) -> None:
    yaml = pytest.importorskip("yaml", reason="PyYAML is not installed")

    def same(found: object, wanted: object) -> bool:
        if isinstance(wanted, dict):
            assert isinstance(found, dict)
            return set(found) == set(wanted) and all(same(found[k], wanted[k]) for k in wanted)
        if isinstance(wanted, float):
            return isinstance(found, float) and math.isclose(found, wanted, rel_tol=1e-11)
        return bool(found == wanted) and type(found) is type(wanted)

    assert same(yaml.safe_load(yaml_text(document)) if document else {}, document)


@settings(max_examples=examples(30), deadline=None)
@given(p=random_actuators())
def test_values_stand_on_the_side_they_are_given_on(p: ActuatorParameters) -> None:
    """Not only the factor between the columns: the columns themselves."""
    rows = {row.key: row for row in actuator_card(p, "drawn").rows}
    motor = {
        "torque_constant": p.motor.torque_constant,
        "rotor_inertia": p.motor.rotor_inertia,
        "input_inertia": p.gear.input_inertia,
        "stribeck_speed": p.friction.stribeck_speed,
        "bristle_deflection": p.friction.bristle_deflection,
        "motor_coulomb": p.friction.motor_coulomb + p.motor.hysteresis,
        "motor_viscous": p.friction.motor_viscous + p.motor.iron_loss,
        "cogging": p.motor.cogging_amplitude,
    }
    joint = {
        "output_inertia": p.gear.output_inertia,
        "output_coulomb": p.friction.output_coulomb,
        "output_viscous": p.friction.output_viscous,
        "backlash": p.gear.backlash,
        "stiffness": p.gear.stiffness,
        "damping": p.gear.damping,
        "position_gain": p.drive.position_gain,
        "velocity_gain": p.drive.velocity_gain,
        "load_forward": p.friction.load_forward,
    }
    for key, value in motor.items():
        assert rows[key].motor == pytest.approx(value, rel=1e-9, abs=1e-15), key
    for key, value in joint.items():
        assert rows[key].joint == pytest.approx(value, rel=1e-9, abs=1e-15), key
