"""Actuator card of whole designs: every row by hand, what a simulation delivers, bad motors."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from cqdd_design.actuator.bench import steady
from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.joint_side import ripple_harmonics
from cqdd_design.actuator.motor import torque_constant_at
from cqdd_design.actuator.parameters import ActuatorParameters, FrictionParameters
from cqdd_design.actuator.scenario import Command, Constant, Load, Scenario, Start
from cqdd_design.actuator.simulate import simulate
from cqdd_design.actuator.thermal import continuous_current
from cqdd_design.design import Design
from cqdd_design.design.toml import load_design
from cqdd_design.errors import DesignError
from cqdd_design.exporting.simulators.actuator_card import actuator_card, card_yaml
from cqdd_design.machine import resolve
from cqdd_design.roads.export import export

DESIGN = Path(__file__).parents[2] / "designs" / "cqdd-10.toml"
OTHER = (
    ("CubeMars RO100 Lite KV55", "maxon EC frameless DT85L"),
    ("48 V", "36 V"),
    ("50.5 A", "30 A"),
)
"""Changes that make another actuator of the design: a motor of which less is known."""


def designed(which: str, folder: Path) -> Design:
    text = DESIGN.read_text()
    for old, new in OTHER if which == "other" else ():
        assert old in text
        text = text.replace(old, new)
    path = folder / "design.toml"
    path.write_text(text)
    return load_design(path)


@pytest.fixture(scope="module", params=["paper", "other"])
def built(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> ActuatorParameters:
    return actuator_parameters(resolve(designed(request.param, tmp_path_factory.mktemp("design"))))


def by_hand(p: ActuatorParameters) -> dict[str, tuple[float | None, float | None]]:
    """Every row at motor and joint, from the parameters by the formulas of a gear."""
    motor, drive, thermal, friction, gear = p.motor, p.drive, p.thermal, p.friction, p.gear
    n = abs(gear.ratio)

    def torque(at_motor: float) -> tuple[float, float]:
        return at_motor, n * at_motor

    def speed(at_motor: float) -> tuple[float, float]:
        return at_motor, at_motor / n

    def square(at_motor: float) -> tuple[float, float]:
        return at_motor, n**2 * at_motor

    constant, volts, ohms = motor.torque_constant, drive.supply_voltage, motor.resistance
    amps = min(drive.current_limit, volts / ohms)
    coulomb = friction.motor_coulomb + motor.dry_drag
    rest = friction.motor_coulomb * (1.0 + friction.stribeck_extra) + motor.dry_drag
    drag = friction.motor_viscous + motor.drag_slope
    outer, outer_drag = friction.output_coulomb / n, friction.output_viscous / n**2
    inertia = motor.rotor_inertia + gear.input_inertia
    held = float(torque_constant_at(motor, thermal.most)) * continuous_current(motor, thermal)
    idle = (constant * volts / ohms - coulomb - outer) / (constant**2 / ohms + drag + outer_drag)
    error = math.sqrt(0.5 * float(np.sum(gear.error_cosine**2 + gear.error_sine**2)))
    ripple = math.sqrt(0.5 * sum(one.amplitude**2 for one in ripple_harmonics(p)))
    delivered = _through(friction, n * (constant * amps - coulomb))
    return {
        "reduction": (None, n),
        "torque_constant": torque(constant),
        "rated_torque": torque(motor.rated_torque),
        "peak_motor": torque(motor.peak_torque),
        "resistance": (ohms, None),
        "inductance": (motor.inductance, None),
        "pole_pairs": (motor.pole_pairs, None),
        "supply_voltage": (volts, None),
        "current_limit": (drive.current_limit, None),
        "stall_torque": torque(constant * volts / ohms),
        "peak_torque": torque(constant * amps),
        "effort_limit": (None, steady.stall_torque(p).value),
        "delivered_peak_torque": (None, delivered - friction.output_coulomb),
        "continuous_torque": torque(held),
        "ideal_speed": speed(volts / constant),
        "no_load_speed": speed(idle),
        "corner_speed": speed((volts - amps * ohms) / constant),
        "cogging": torque(motor.cogging_amplitude),
        "cogging_order": torque(motor.cogging_order),
        "rotor_inertia": square(motor.rotor_inertia),
        "input_inertia": square(gear.input_inertia),
        "motor_side_inertia": square(inertia),
        "output_inertia": square(gear.output_inertia / n**2),
        "reflected_inertia": square(inertia + gear.output_inertia / n**2),
        "mass": (None, p.mass),
        "motor_coulomb": torque(coulomb),
        "motor_breakaway": torque(rest),
        "output_coulomb": torque(outer),
        "coulomb": torque(coulomb + outer),
        "breakaway": torque(rest + outer * (1.0 + friction.stribeck_extra)),
        "stribeck_speed": speed(friction.stribeck_speed),
        "bristle_deflection": speed(friction.bristle_deflection),
        "bristle_damping": square(friction.bristle_damping),
        "motor_viscous": square(drag),
        "output_viscous": square(outer_drag),
        "viscous": square(drag + outer_drag),
        "load_forward": (None, friction.load_forward),
        "load_backward": (None, friction.load_backward),
        "load_knee": (None, friction.load_knee),
        "load_growth": (None, friction.load_growth),
        "backlash": speed(gear.backlash * n),
        "stiffness": square(gear.stiffness / n**2),
        "stiffening": (None, gear.stiffening),
        "damping": square(gear.damping / n**2),
        "error_torque": torque(gear.error_torque / n),
        "kinematic_error": speed(error * n),
        "ripple": torque(ripple / n),
        "position_gain": square(drive.position_gain / n**2),
        "velocity_gain": square(drive.velocity_gain / n**2),
        "delay": (drive.delay, None),
        "current_bandwidth": (drive.current_bandwidth, None),
        "control_rate": (drive.control_rate, None),
        "encoder_step": speed(2.0 * math.pi / 2.0**drive.encoder_bits),
        "winding_to_housing": (thermal.winding_to_housing, None),
        "housing_to_ambient": (thermal.housing_to_ambient, None),
        "winding_capacity": (thermal.winding_capacity, None),
        "housing_capacity": (thermal.housing_capacity, None),
        "reference_temperature": (motor.reference_temperature, None),
        "ambient": (thermal.ambient, None),
        "derating_begins": (thermal.derating_begins, None),
        "most": (thermal.most, None),
    }


def _through(friction: FrictionParameters, given: float) -> float:
    """What is carried of a torque that the motor gives, by halving."""
    low, high = 0.0, given
    for _ in range(60):
        middle = 0.5 * (low + high)
        above = max(middle - friction.load_knee, 0.0)
        taken = middle + friction.load_forward * (middle + friction.load_growth * above)
        low, high = (middle, high) if taken <= given else (low, middle)
    return low


def test_every_row_of_a_design(built: ActuatorParameters) -> None:
    """Numbers and sides, with nothing where the catalogue has nothing."""
    yaml = pytest.importorskip("yaml", reason="PyYAML is not installed")
    written = yaml.safe_load(card_yaml(actuator_card(built, "designed")))["parameters"]
    expected = by_hand(built)
    assert set(written) == set(expected)
    for key, sides in expected.items():
        for side, value in zip(("motor", "joint"), sides, strict=True):
            found = written[key][side]
            if value is None or not math.isfinite(value):
                assert found is None, (key, side)
            else:
                assert found == pytest.approx(value, rel=1e-9, abs=1e-15), (key, side)


def test_delivered_torque_is_that_of_the_simulation(built: ActuatorParameters) -> None:
    """Full current at a slow steady speed, above that of the Stribeck effect."""
    speed, friction = built.friction.stribeck_speed, built.friction
    sense = math.copysign(1.0, built.gear.ratio)
    scene = Scenario(
        Command("current", Constant(sense * built.drive.current_limit)),
        Load.driven(Constant(speed)),
        Start(output_speed=speed),
    )
    run = simulate(steady.cold(built), scene, 1.0, 5e-5, every=20)
    torque = float(run.output_torque[0][run.time > 0.5].mean())
    n = abs(built.gear.ratio)
    dragged = n**2 * (friction.motor_viscous + built.motor.drag_slope) * speed
    dragged /= 1.0 + friction.load_forward * (1.0 + friction.load_growth)
    dragged += friction.output_viscous * speed
    rows = {row.key: row for row in actuator_card(built, "designed").rows}
    delivered = rows["delivered_peak_torque"].joint
    assert delivered is not None
    assert torque == pytest.approx(delivered - dragged, rel=1e-3)


def test_values_of_the_card_move_a_joint_in_mujoco(built: ActuatorParameters) -> None:
    """Its plain motor and joint: positive command, positive motion, at the card's inertia."""
    mujoco = pytest.importorskip("mujoco", minversion="4.0.0", reason="MuJoCo 4 is not installed")
    yaml = pytest.importorskip("yaml", reason="PyYAML is not installed")
    document = yaml.safe_load(card_yaml(actuator_card(built, "designed")))
    values = document["clients"]["mujoco"]["settings"]["motor and joint"]
    most = values["motor.ctrlrange upper, lower its negative"]
    inertia = document["parameters"]["output_inertia"]["joint"]
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option gravity="0 0 0"/><worldbody><body>
        <joint name="j" axis="0 0 1" armature="{values["joint.armature"]}"
         damping="{values["joint.damping"]}" frictionloss="{values["joint.frictionloss"]}"/>
        <inertial pos="0 0 0" mass="0.001" diaginertia="{inertia} {inertia} {inertia}"/>
        </body></worldbody><actuator><motor joint="j" gear="{values["motor.gear"]}"
         ctrlrange="{-most} {most}"/></actuator></mujoco>"""
    )
    for sense in (1.0, -1.0):
        data = mujoco.MjData(model)
        data.ctrl[0] = 2.0 * sense * most
        mujoco.mj_step(model, data)
        rise = data.qvel[0] / model.opt.timestep
        # A step of MuJoCo takes the damping at its end.
        damped = 1.0 + model.opt.timestep * values["joint.damping"] / built.reflected_inertia
        expected = (most - values["joint.frictionloss"]) / built.reflected_inertia / damped
        assert rise == pytest.approx(sense * expected, rel=1e-3)


@pytest.mark.parametrize(
    ("motor", "said"),
    [
        ("Kollmorgen TBM6013-A", "the torque constant of Kollmorgen TBM6013-A is not known"),
        ("U12", "the resistance of U12 is not known"),
        ("DJI GM6020", "neither rotor inertia nor mass and diameter of DJI GM6020 are"),
    ],
)
@pytest.mark.parametrize("kind", ["card", "mjcf", "urdf", "bam"])
def test_a_motor_without_data_is_refused_and_leaves_nothing(
    tmp_path: Path, motor: str, said: str, kind: str
) -> None:
    path = tmp_path / "design.toml"
    path.write_text(DESIGN.read_text().replace("CubeMars RO100 Lite KV55", motor))
    design = load_design(path)
    with pytest.raises(DesignError, match=said):
        export(design, f"bom,{kind}", tmp_path / "new")
    assert not (tmp_path / "new").exists()
    (tmp_path / "old").mkdir()
    before = tmp_path / "old" / "cqdd-10.urdf"
    before.write_text("another")
    with pytest.raises(DesignError, match=said):
        export(design, kind, tmp_path / "old", force=True)
    assert [one.name for one in (tmp_path / "old").iterdir()] == ["cqdd-10.urdf"]
    assert before.read_text() == "another"


@pytest.mark.parametrize(("old", "new"), [("48 V", "2 V"), ("50.5 A", "900 A")])
def test_limits_that_never_bind_are_refused(tmp_path: Path, old: str, new: str) -> None:
    path = tmp_path / "design.toml"
    path.write_text(DESIGN.read_text().replace(f'"{old}"', f'"{new}"'))
    with pytest.raises(DesignError, match="never binds"):
        export(load_design(path), "card,mjcf,urdf,bam", tmp_path / "new")
    assert not (tmp_path / "new").exists()


def test_files_are_named_for_the_design_and_carry_its_hash(tmp_path: Path) -> None:
    design = load_design(DESIGN)
    files = export(design, "card,mjcf,urdf,bam", tmp_path / "one")
    assert [one.path.name for one in files] == [
        f"cqdd-10{ending}"
        for ending in ("-card.yaml", "-card.md", "-test.xml", ".xml", ".urdf", "-bam.json")
    ]
    assert all(design.sha256 in one.path.read_text(encoding="utf-8") for one in files)
    again = export(design, "card,mjcf,urdf,bam", tmp_path / "two")
    assert [one.sha256 for one in files] == [one.sha256 for one in again]
