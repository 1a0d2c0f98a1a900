"""URDF: what is written, and what arrives in those real clients that are installed."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from actuator_samples import paper_actuator, random_actuators
from examples import examples
from hypothesis import given, settings

from cqdd_design import __version__
from cqdd_design.actuator.bench.steady import stall_torque
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.exporting.simulators.mjcf import model_text
from cqdd_design.exporting.simulators.mjcf_classes import MjcfActuator
from cqdd_design.exporting.simulators.urdf import DRAKE, urdf_text


def expected(p: ActuatorParameters) -> dict[str, float]:
    """Joint side by the formulas of reflection, written out."""
    n, motor, friction = abs(p.gear.ratio), p.motor, p.friction
    return {
        "effort": stall_torque(p).value,
        "friction": n * (friction.motor_coulomb + motor.hysteresis) + friction.output_coulomb,
        "damping": n**2 * (friction.motor_viscous + motor.iron_loss) + friction.output_viscous,
        "rotor": motor.rotor_inertia + p.gear.input_inertia,
        "ratio": n,
        "output": p.gear.output_inertia,
    }


@pytest.fixture(params=[-10.0, 10.0])
def written(request: pytest.FixtureRequest, tmp_path: Path) -> tuple[str, dict[str, float]]:
    p = paper_actuator(request.param)
    path = tmp_path / "paper.urdf"
    path.write_text(urdf_text(p, "paper"))
    return str(path), expected(p)


@settings(max_examples=examples(40), deadline=None)
@given(p=random_actuators())
def test_values_in_the_text(p: ActuatorParameters) -> None:
    root = ElementTree.fromstring(urdf_text(p, "drawn"))
    wanted = expected(p)
    limit, dynamics = root.find("joint/limit"), root.find("joint/dynamics")
    actuator = root.find("transmission/actuator")
    inertia = root.find("link[@name='output']/inertial/inertia")
    assert limit is not None
    assert dynamics is not None
    assert actuator is not None
    assert inertia is not None
    found = {
        "effort": limit.get("effort"),
        "friction": dynamics.get("friction"),
        "damping": dynamics.get("damping"),
        "rotor": actuator.find(f"{{{DRAKE}}}rotor_inertia").get("value"),  # type: ignore[union-attr]
        "ratio": actuator.find(f"{{{DRAKE}}}gear_ratio").get("value"),  # type: ignore[union-attr]
        "output": inertia.get("izz"),
    }
    assert {key: float(str(value)) for key, value in found.items()} == pytest.approx(
        wanted, rel=1e-8
    )
    assert float(str(actuator.findtext("mechanicalReduction"))) == abs(p.gear.ratio)
    speed = float(str(limit.get("velocity")))
    fastest = p.drive.supply_voltage / p.motor.torque_constant / abs(p.gear.ratio)
    assert 0.0 <= speed <= fastest * (1.0 + 1e-8)


def test_reproducible_and_with_its_origin() -> None:
    p = paper_actuator()
    text = urdf_text(p, "paper", design_sha256="c0ffee")
    assert text == urdf_text(p, "paper", design_sha256="c0ffee")
    assert f"cqdd-design {__version__}" in text
    assert "c0ffee" in text
    assert "armature" in text


def test_the_mass_of_the_output_is_called_a_placeholder() -> None:
    p = paper_actuator()
    for text in (urdf_text(p, "paper"), model_text(MjcfActuator(p, "paper"))):
        told = " ".join(text.split())
        assert "0.001 kg of the output is a placeholder" in told
        assert f"{p.mass:.4g} kg, is in the housing" in told
        assert 'mass="0.001"' in told or '<mass value="0.001"/>' in told


def test_mujoco_reads_it_and_positive_torque_turns_it_positive(
    written: tuple[str, dict[str, float]],
) -> None:
    mujoco = pytest.importorskip("mujoco", reason="MuJoCo is not installed")
    path, wanted = written
    model = mujoco.MjModel.from_xml_path(path)
    data = mujoco.MjData(model)
    joint = model.joint("paper")
    assert model.njnt == 1
    assert joint.axis == pytest.approx([0.0, 0.0, 1.0])
    assert joint.damping == pytest.approx(wanted["damping"])
    assert joint.frictionloss == pytest.approx(wanted["friction"])
    assert model.jnt_actfrcrange[0] == pytest.approx([-wanted["effort"], wanted["effort"]])
    assert max(model.body("output").inertia) == pytest.approx(wanted["output"])
    # Rotor inertia has no place in what MuJoCo reads of a URDF, as the file says.
    assert joint.armature == 0.0
    data.qfrc_applied[0] = 2.0 * wanted["friction"]
    for _ in range(100):
        mujoco.mj_step(model, data)
    assert data.qvel[0] > 0.0
    assert data.qpos[0] > 0.0


def test_drake_reflects_the_rotor(written: tuple[str, dict[str, float]]) -> None:
    parsing = pytest.importorskip("pydrake.multibody.parsing", reason="Drake is not installed")
    plants = pytest.importorskip("pydrake.multibody.plant")
    path, wanted = written
    plant = plants.MultibodyPlant(0.0)
    parsing.Parser(plant).AddModels(path)
    plant.WeldFrames(plant.world_frame(), plant.GetFrameByName("housing"))
    plant.Finalize()
    actuator = plant.GetJointActuatorByName("paper-motor")
    assert actuator.effort_limit() == pytest.approx(wanted["effort"])
    assert actuator.default_rotor_inertia() == pytest.approx(wanted["rotor"])
    assert actuator.default_gear_ratio() == wanted["ratio"]
    assert plant.GetJointByName("paper").default_damping() == pytest.approx(wanted["damping"])
    reflected = wanted["rotor"] * wanted["ratio"] ** 2
    assert actuator.default_reflected_inertia() == pytest.approx(reflected)
    context = plant.CreateDefaultContext()
    mass = plant.CalcMassMatrix(context)
    assert mass[0, 0] == pytest.approx(reflected + wanted["output"])
    for sense in (1.0, -1.0):
        torque = 0.5 * sense * wanted["effort"]
        plant.get_actuation_input_port().FixValue(context, [torque])
        rise = plant.EvalTimeDerivatives(context).CopyToVector()[1]
        assert rise == pytest.approx(torque / (reflected + wanted["output"]))


def test_pinocchio_reads_limits_and_friction(written: tuple[str, dict[str, float]]) -> None:
    pinocchio = pytest.importorskip("pinocchio", reason="Pinocchio is not installed")
    path, wanted = written
    model = pinocchio.buildModelFromUrdf(path)
    assert model.upperEffortLimit[0] == pytest.approx(wanted["effort"])
    assert model.upperDryFrictionLimit[0] == pytest.approx(wanted["friction"])
    assert model.damping[0] == pytest.approx(wanted["damping"])
    # The transmission is not read: the armature is set by hand, as the card says.
    assert model.rotorInertia[0] == 0.0
    assert model.armature[0] == 0.0
    output = model.inertias[1].inertia[2, 2]
    assert output == pytest.approx(wanted["output"])
    model.armature[0] = wanted["rotor"] * wanted["ratio"] ** 2
    data = model.createData()
    still = pinocchio.neutral(model), np.zeros(1)
    for sense in (1.0, -1.0):
        pushed = pinocchio.aba(model, data, *still, np.array([sense * wanted["effort"]]))
        whole = model.armature[0] + wanted["output"]
        assert pushed[0] == pytest.approx(sense * wanted["effort"] / whole)


def test_yourdfpy_reads_it(written: tuple[str, dict[str, float]]) -> None:
    yourdfpy = pytest.importorskip("yourdfpy", reason="yourdfpy is not installed")
    path, wanted = written
    joint = yourdfpy.URDF.load(path).joint_map["paper"]
    assert joint.limit.effort == pytest.approx(wanted["effort"])
    assert float(joint.dynamics.damping) == pytest.approx(wanted["damping"])
