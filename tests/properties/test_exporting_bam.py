"""BAM's parameter file, read back by BAM's own formulas written out here."""

from __future__ import annotations

import json
import math

import pytest
from actuator_samples import paper_actuator, random_actuators
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from cqdd_design import __version__
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.exporting.simulators.bam import UNITS, bam_document

NEEDED = {
    "kt",
    "R",
    "armature",
    "friction_base",
    "friction_stribeck",
    "friction_viscous",
    "load_friction_motor",
    "load_friction_external",
    "load_friction_motor_stribeck",
    "load_friction_external_stribeck",
    "dtheta_stribeck",
    "alpha",
    "model",
    "actuator",
}
"""Keys of the files that BAM comes with, model m5."""


def budget(data: dict[str, float], motor: float, external: float, speed: float) -> float:
    """Most friction of model m5: Model.compute_frictions of bam/model.py."""
    at_rest = math.exp(-(abs(speed / data["dtheta_stribeck"]) ** data["alpha"]))
    loss = data["friction_base"]
    loss += abs(external * data["load_friction_external"] - motor * data["load_friction_motor"])
    loss += at_rest * data["friction_stribeck"]
    loss += at_rest * abs(
        external * data["load_friction_external_stribeck"]
        - motor * data["load_friction_motor_stribeck"]
    )
    return loss + data["friction_viscous"] * abs(speed)


def step(
    data: dict[str, float], motor: float, external: float, speed: float, inertia: float, dt: float
) -> float:
    """Speed after a step: Simulator.step of bam/simulate.py."""
    net = motor + external
    stopping = inertia / dt * speed + net
    net -= math.copysign(min(abs(stopping), budget(data, motor, external, speed)), stopping)
    return speed + net / inertia * dt


def ours(p: ActuatorParameters, speed: float, carried: float, coefficient: float) -> float:
    """Friction at the joint by the actuator's model, for a torque carried to the output."""
    n, friction = abs(p.gear.ratio), p.friction
    rise = 1.0 + friction.stribeck_extra * math.exp(-((n * speed / friction.stribeck_speed) ** 2))
    motor_side = (friction.motor_coulomb + coefficient * carried / n) * rise + p.motor.hysteresis
    viscous = n**2 * (friction.motor_viscous + p.motor.iron_loss) + friction.output_viscous
    return n * motor_side + friction.output_coulomb * rise + viscous * speed


@settings(max_examples=examples(80), deadline=None)
@given(p=random_actuators(), speed=st.floats(0.0, 20.0), carried=st.floats(0.0, 200.0))
def test_the_same_friction_budget_under_load(
    p: ActuatorParameters, speed: float, carried: float
) -> None:
    """Steady motion, driven by the motor and driven from outside, at rest and at any speed."""
    data = json.loads(json.dumps(bam_document(p, "drawn")))
    n, friction = abs(p.gear.ratio), p.friction
    rise = 1.0 + friction.stribeck_extra * math.exp(-((n * speed / friction.stribeck_speed) ** 2))
    forward = carried * (1.0 + friction.load_forward * rise)
    assert budget(data, forward, -carried, speed) == pytest.approx(
        ours(p, speed, carried, friction.load_forward), rel=1e-9, abs=1e-12
    )
    backward = -carried * (1.0 - friction.load_backward * rise)
    assert budget(data, backward, carried, speed) == pytest.approx(
        ours(p, speed, carried, friction.load_backward), rel=1e-9, abs=1e-12
    )


@pytest.mark.parametrize("ratio", [-10.0, 10.0])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_positive_current_gives_positive_motion(ratio: float, sense: float) -> None:
    data = bam_document(paper_actuator(ratio), "paper")
    numbers = {key: float(value) for key, value in data.items() if isinstance(value, float)}
    speed = 0.0
    for _ in range(100):
        speed = step(numbers, numbers["kt"] * 5.0 * sense, 0.0, speed, numbers["armature"], 1e-3)
    assert sense * speed > 1.0


def test_it_stands_still_up_to_breakaway() -> None:
    p = paper_actuator()
    data = {k: v for k, v in bam_document(p, "paper").items() if isinstance(v, float)}
    # Breakaway with the share that the motor's own torque adds by load_friction_motor.
    limit = (10.0 * 0.05 + 0.3) * 1.3 + 10.0 * 0.02
    slack = 1.0 / (1.0 - abs(data["load_friction_motor"]))
    assert step(data, 0.999 * limit, 0.0, 0.0, data["armature"], 1e-3) == 0.0
    assert step(data, 1.001 * limit * slack, 0.0, 0.0, data["armature"], 1e-3) > 0.0


def test_motor_and_inertia_at_the_joint() -> None:
    data = bam_document(paper_actuator(), "paper")
    assert data["kt"] == pytest.approx(1.78)
    assert data["R"] == pytest.approx(0.098)
    assert data["armature"] == pytest.approx(0.0501 + 4e-4)
    assert data["friction_base"] == pytest.approx(1.0)


def test_document_has_all_that_bam_reads_with_units_and_origin() -> None:
    p = paper_actuator()
    data = bam_document(p, "paper", design_sha256="c0ffee")
    text = json.dumps(data, allow_nan=False)
    assert text == json.dumps(bam_document(p, "paper", design_sha256="c0ffee"))
    assert json.loads(text) == data
    assert set(data) >= NEEDED
    numbers = {key for key, value in data.items() if isinstance(value, float)}
    assert numbers == set(UNITS) == set(data["_units"])
    assert data["model"] == "m5"
    assert __version__ in data["_provenance"]
    assert "c0ffee" in data["_provenance"]
