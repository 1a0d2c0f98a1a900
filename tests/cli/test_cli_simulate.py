"""``simulate``: files read back, their physics, determinism by seed, and every wrong option."""

from __future__ import annotations

import io
import json
import math
import os
import re
import shlex
import sys
from pathlib import Path

import numpy as np
import pytest

from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.cli import session
from cqdd_design.cli.main import run
from cqdd_design.design import load_design
from cqdd_design.machine import resolve

DESIGN = Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml"
GRAVITY = 9.80665


def columns(path: Path) -> dict[str, np.ndarray]:
    with np.load(path, allow_pickle=False) as file:
        return {name: file[name] for name in file.files if name != "metadata"}


# Processes --------------------------------------------------------------------------------------


def test_a_record_too_coarse_for_its_signal_says_so(cqdd, tmp_path):
    words = (
        *("simulate", DESIGN, "--signal", "sine", "--frequency", "1000 Hz"),
        *("--amplitude", "40 N*m", "--duration", "50 ms", "--load", "locked", "--force"),
    )
    coarse = cqdd(*words, "--out", "a.npz")
    assert coarse.code == 0, coarse.err
    warned = " ".join(coarse.err.split())
    assert "swings at up to 1000 Hz, and 1000 records a second show no more than 500 Hz" in warned
    assert "current, r.m.s. of the records" in coarse.out
    (named,) = re.findall(r"raise the rate to (\d+ Hz)", warned)
    fine = cqdd(*words, "--out", "b.npz", "--rate", named)
    assert "records a second" not in fine.err
    assert "of the records" not in fine.out
    assert "current, r.m.s." in fine.out


def test_a_motor_beyond_its_own_peak_torque_is_told(cqdd, tmp_path):
    (tmp_path / "weak.toml").write_text('peak_torque = "4 N*m"\n', "utf-8")
    words = (
        *("simulate", DESIGN, "--motor-file", "weak.toml", "--load", "locked"),
        *("--duration", "50 ms", "--force"),
    )
    told = "the motor gives more than its own peak torque of 4 N*m"
    beyond = cqdd(*words, "--amplitude", "60 N*m")
    assert beyond.code == 0, beyond.err
    assert told in " ".join(beyond.err.split())
    assert told not in " ".join(cqdd(*words, "--amplitude", "40 N*m").err.split())


def test_a_motor_of_which_no_drag_is_known_is_told(cqdd, tmp_path):
    (tmp_path / "own.toml").write_text(
        'torque_constant = "0.1 N*m/A"\nresistance = "0.1 ohm"\ninductance = "0.1 mH"\n'
        'rotor_inertia = "2e-4 kg*m^2"\npole_pairs = 14\n',
        "utf-8",
    )
    words = ("simulate", DESIGN, "--load", "locked", "--duration", "20 ms", "--force")
    told = "the motor turns without drag of its own"
    own = cqdd(*words, "--motor-file", "own.toml")
    assert own.code == 0, own.err
    assert told in " ".join(own.err.split())
    assert told not in " ".join(cqdd(*words).err.split())


def test_a_pendulum_held_at_rest_weighs_what_it_weighs(cqdd, tmp_path):
    """At rest the flange carries m g r sin q, and the angle is off by torque over gain."""
    done = cqdd(
        *("simulate", DESIGN, "--load", "pendulum", "--mass", "2 kg", "--arm", "400 mm"),
        *("--load-damping", "1 N*m*s/rad", "--command", "position", "--amplitude", "0.6 rad"),
        *("--duration", "4 s", "--json"),
    )
    assert done.code == 0, done.err
    document = done.document
    (file,) = document["files"]
    assert file["path"] == "exports/cqdd-10-simulation.npz"
    assert file["kind"] == "npz"
    found = columns(tmp_path / file["path"])
    results = document["results"]
    assert [one["name"] for one in results["columns"]] == list(found)
    assert results["rows"] == len(found["time [s]"]) == 4000
    assert results["options"]["--mass"] == "2 kg"
    assert results["options"]["--position-gain"] == "60 N*m/rad"
    assert results["sets"][0]["residual_share"] < 1e-6
    assert results["sets"][0]["output_torque_Nm_peak"] == np.abs(found["output_torque [N m]"]).max()
    rest = found["time [s]"] > 3.5
    angle, torque = found["output_angle [rad]"][rest], found["output_torque [N m]"][rest]
    assert np.abs(found["output_speed [rad/s]"][rest]).max() < 0.01
    np.testing.assert_allclose(torque, 2.0 * GRAVITY * 0.4 * np.sin(angle), rtol=1e-3)
    # Friction of the gearbox holds a part: the drive gives less than the weight, or more.
    missing = 60.0 * (0.6 - angle.mean())
    assert 0.3 * torque.mean() < missing < 1.6 * torque.mean()
    assert found["commanded_torque [N m]"][-1] == pytest.approx(missing, rel=0.05)


@pytest.mark.parametrize("model", ["clip", "lugre"])
def test_a_locked_output_gives_what_is_commanded_less_friction(cqdd, tmp_path, model):
    """On a slow rise friction is that of breakaway: T = (command - dry) / (1 + load share).

    Dry are the gearbox's friction, the motor's own drag, and cogging where the rotor stands.
    """
    parquet = pytest.importorskip("pyarrow.parquet")
    done = cqdd(
        *("simulate", DESIGN, "--load", "locked", "--signal", "ramp", "--amplitude", "12 N*m"),
        *("--duration", "600 ms", "--rate", "500 Hz", "--friction", model),
        *("--out", "deep/locked.parquet"),
    )
    assert done.code == 0, done.err
    assert "output torque, peak" in done.out
    assert "wrote deep/locked.parquet (parquet," in done.out
    table = parquet.read_table(tmp_path / "deep" / "locked.parquet")
    assert table.schema.field("output_torque [N m]").metadata[b"unit"] == b"N m"
    told = {key.decode(): json.loads(value) for key, value in table.schema.metadata.items()}
    assert told["friction"] == model
    assert told["rate_Hz"] == pytest.approx(500.0)
    assert told["load"]["sensor_stiffness_Nm_per_rad"] == 50000.0
    assert told["command"]["reference"]["slope"] == pytest.approx(20.0)
    assert told["seeds"] == []
    machine = actuator_parameters(resolve(load_design(DESIGN)))
    friction, motor, ratio = machine.friction, machine.motor, abs(machine.gear.ratio)
    rise = 1.0 + friction.stribeck_extra
    dry = rise * (friction.motor_coulomb * ratio + friction.output_coulomb)
    angle = table["motor_angle [rad]"].to_numpy()
    cogging = motor.cogging_amplitude * np.sin(motor.cogging_order * angle)
    dry = dry + ratio * motor.dry_drag + machine.gear.ratio * cogging
    command = table["commanded_torque [N m]"].to_numpy()
    wanted = (command - dry) / (1.0 + rise * friction.load_forward)
    late = command > 4.0
    torque = table["output_torque [N m]"].to_numpy()
    np.testing.assert_allclose(torque[late], wanted[late], rtol=0.02)
    current = abs(table["current [A]"].to_numpy()[late])
    asked = command[late] / (ratio * machine.motor.torque_constant)
    np.testing.assert_allclose(current, asked, rtol=0.01)


@pytest.mark.deep
def test_the_same_seed_gives_the_same_bytes(cqdd, tmp_path):
    arguments = (
        "simulate",
        DESIGN,
        "--duration",
        "100 ms",
        "--command",
        "voltage",
        "--samples",
        "2",
    )
    arguments += ("--amplitude", "12 V", "--quiet")
    for name, seed in (("a.npz", 7), ("b.npz", 7), ("c.npz", 8)):
        done = cqdd(*arguments, "--seed", str(seed), "--out", name)
        assert (done.code, done.out, done.err) == (0, "", "")
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()
    first, other = columns(tmp_path / "a.npz"), columns(tmp_path / "c.npz")
    assert set(first["set"]) == {0, 1}
    speed = "output_speed [rad/s]"
    assert not np.array_equal(first[speed], other[speed])
    np.testing.assert_allclose(first[speed][first["set"] == 1], other[speed][other["set"] == 0])


def test_a_reference_file_is_followed(cqdd, tmp_path):
    times = np.arange(0.0, 0.5, 0.01)
    lines = [f"{1e3 * t:.0f},{30.0 * math.sin(9.0 * t):.6f}" for t in times]
    (tmp_path / "gait.csv").write_text("\n".join(["time [ms],knee [deg]", *lines]) + "\n")
    done = cqdd(
        *("simulate", DESIGN, "--command", "impedance", "--reference", "gait.csv"),
        *("--load", "inertia", "--load-inertia", "0.01 kg*m^2", "--json"),
    )
    assert done.code == 0, done.err
    found = columns(tmp_path / "exports" / "cqdd-10-simulation.npz")
    assert found["time [s]"][-1] == pytest.approx(0.49)
    wanted = math.radians(30.0) * np.sin(9.0 * found["time [s]"])
    np.testing.assert_allclose(found["reference_angle [rad]"], wanted, atol=1e-3)
    late = found["time [s]"] > 0.2
    np.testing.assert_allclose(found["output_angle [rad]"][late], wanted[late], atol=0.12)
    again = cqdd(
        *("simulate", DESIGN, "--command", "impedance", "--reference", "gait.csv"),
        *("--duration", "0.6 s"),
    )
    assert again.code == 0
    assert "gait.csv ends at 0.49 s; its last value is held from there" in again.err


# In this process --------------------------------------------------------------------------------


@pytest.fixture
def simulate(monkeypatch, tmp_path, capsys):
    """Run the command here, in an empty folder; its exit code and what it says."""
    printed = io.StringIO()
    monkeypatch.setattr(session, "standard_output", lambda: printed)
    monkeypatch.chdir(tmp_path)

    def call(*arguments: str) -> tuple[int, str]:
        code = run(["simulate", str(DESIGN), "--quiet", *arguments])
        return code, capsys.readouterr().err

    return call


WRONG = {
    ("--voltage", "0 V"): '--voltage 0 V is not above zero; use "24 V", for example',
    ("--voltage", "48"): "--voltage: '48' has no unit; write it like \"48 V\"",
    ("--duration", "0 s"): "--duration 0 s is not above zero",
    ("--duration", "-2 s"): "--duration -2 s is not above zero",
    ("--duration", "5"): 'write it like "5 s"',
    ("--duration", "1 hour"): "more than 20 million steps of 2e-05 s; use a duration of 200 s",
    ("--step", "1 ms"): "too large for the stiffness of gearbox and load, which needs 7.33e-05 s",
    ("--step", "0 s"): 'use "20 us"',
    ("--rate", "10 MHz"): "use a rate of 500000 Hz or less",
    ("--rate", "60 rpm"): "a rate is in Hz here",
    ("--rate", "0.1 Hz"): "has no record at a rate of 0.1 Hz; use a rate of 0.2 Hz or more",
    ("--samples", "5000"): "for 5000 sets",
    ("--load", "pendulm"): "is none of free, locked, inertia, driven, pendulum, wall; did you mean",
    ("--signal", "sinus"): "--signal 'sinus' is none of constant, sine, chirp, ramp, file; did you",
    ("--command", "speed"): "is none of torque, current, voltage, impedance, position, open",
    ("--friction", "coulomb"): "--friction 'coulomb' is none of clip, lugre",
    ("--mass", "1 kg"): "--mass does not belong to --load free; leave it out, or use --load "
    "pendulum or wall.",
    ("--load", "locked", "--start-angle", "1 deg"): "does not belong to --load locked",
    ("--load", "pendulum", "--wall-angle", "1 deg"): "use --load wall.",
    ("--load", "pendulum", "--mass", "-1 kg"): '--mass -1 kg is not above zero; use "2.28 kg"',
    ("--load", "inertia", "--load-inertia", "1 kg"): "'kg' is not a unit of moment of inertia",
    ("--load", "inertia", "--load-damping", "-1 N*m*s/rad"): "is below zero",
    ("--load", "wall", "--start-angle", "1 rad"): "is within the wall at 0.5 rad",
    ("--load", "wall", "--wall-angle", "-9 deg", "--start-angle", "-1 rad"): "within the wall",
    ("--command", "position", "--amplitude", "20 N*m"): "--amplitude of --command position: 'N*m' "
    "is not a unit of angle",
    ("--command", "voltage", "--amplitude", "20 A"): "'A' is not a unit of voltage",
    ("--command", "open", "--amplitude", "20 A"): "--amplitude does not belong to --command open",
    ("--command", "open", "--signal", "sine"): "--signal does not belong to --command open",
    ("--position-gain", "9 N*m/rad"): "use --command impedance or position",
    ("--offset", "1 N*m"): "--offset does not belong to --signal constant",
    ("--signal", "ramp", "--frequency", "1 Hz"): "--frequency does not belong to --signal ramp",
    ("--frequency", "0 Hz"): "--frequency 0 Hz is not above zero",
    ("--frequency", "5 kHz", "--step", "20 us"): "20 steps in a period of 5000 Hz; use 1e-05 s",
    ("--end-frequency", "0.2 Hz"): "--end-frequency 0.2 Hz is not above --frequency 0.5 Hz",
    ("--signal", "file"): "needs --reference FILE.csv with the columns time [s],torque [N*m]",
    ("--signal", "sine", "--reference", "r.csv"): "--reference does not belong to --signal sine",
    ("--reference", "none.csv"): "cannot read none.csv: there is no such file",
    ("--out", "trace.csv"): "trace.csv ends neither in .npz nor in .parquet; name it trace.npz",
    ("--out", "."): "name it simulation.npz",
    ("--seed", "18446744073709551615", "--samples", "2"): "seeds end at 18446744073709551615",
    ("--samples", "0"): "--samples takes a whole number from 1 to 10000, not '0'; the nearest is 1",
}


@pytest.mark.parametrize("arguments", WRONG, ids=" ".join)
def test_wrong_options_are_refused_with_what_works(simulate, tmp_path, arguments):
    code, said = simulate(*arguments)
    assert code == 2, said
    assert WRONG[arguments] in said
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("time [s],torque [N m]\n0,0\n1,nan\n", "line 3: 'torque [N m]' is nan"),
        ("time [s],angle [deg]\n0,0\n1,1\n", "'deg' is not a unit of torque"),
        ("time [s],torque [N m]\n0,0\n0,1\n", "does not rise"),
        ("time [s],torque [N m]\n-2,0\n-1,1\n", "its times must go beyond 0"),
    ],
)
def test_a_wrong_reference_is_refused(simulate, tmp_path, content, said):
    (tmp_path / "r.csv").write_text(content)
    code, text = simulate("--reference", "r.csv")
    assert code == 2
    assert said in text


def test_a_reference_has_its_own_amplitude(simulate, tmp_path):
    (tmp_path / "r.csv").write_text("time [s],torque [N m]\n0,0\n1,1\n")
    code, text = simulate("--reference", "r.csv", "--amplitude", "2 N*m")
    assert code == 2
    assert "--amplitude does not belong to --signal file" in text


SHORT = ("--duration", "50 ms")


def test_a_named_file_is_replaced_only_by_force(simulate, tmp_path):
    assert simulate(*SHORT, "--out", "mine.npz")[0] == 0
    before = (tmp_path / "mine.npz").read_bytes()
    code, said = simulate("--duration", "60 ms", "--out", "mine.npz")
    assert code == 2
    assert "mine.npz exists already; add --force" in said
    assert (tmp_path / "mine.npz").read_bytes() == before
    assert simulate("--duration", "60 ms", "--out", "mine.npz", "--force")[0] == 0
    assert (tmp_path / "mine.npz").read_bytes() != before


def test_its_own_default_file_is_replaced(simulate, tmp_path):
    assert simulate(*SHORT)[0] == simulate(*SHORT)[0] == 0
    assert [path.name for path in (tmp_path / "exports").iterdir()] == ["cqdd-10-simulation.npz"]


def test_a_file_stands_where_a_folder_is_needed(simulate, tmp_path):
    (tmp_path / "taken").write_text("a file")
    code, said = simulate(*SHORT, "--out", "taken/a.npz")
    assert code == 2
    assert "cannot write" in said
    assert (tmp_path / "taken").read_text() == "a file"


@pytest.mark.skipif(
    not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write everywhere"
)
def test_a_read_only_folder(simulate, tmp_path):
    (tmp_path / "locked").mkdir(mode=0o555)
    code, said = simulate(*SHORT, "--out", "locked/a.npz")
    assert code == 2
    assert "the folder is not writable" in said


def test_parquet_without_pyarrow(simulate, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    code, said = simulate(*SHORT, "--out", "a.parquet")
    assert code == 5
    assert 'pip install "cqdd-design[parquet]"' in said
    assert list(tmp_path.iterdir()) == []


DEGREE = math.pi / 180.0
#: Options, and what they come to in the metadata of the file, in SI.
REACHES = {
    '--start-angle "10 deg" --signal ramp --amplitude "3 N*m" --offset "1 N*m"': {
        "load.kind": "free",
        "start_angle_rad": 10.0 * DEGREE,
        "command.reference.start": 1.0,
        "command.reference.slope": 3.0 / 0.05,
    },
    '--load inertia --load-damping "0.1 N*m*s/rad" --end-frequency "20 Hz"': {
        "load.kind": "inertia",
        "load.inertia_kgm2": 0.05,
        "load.viscous_Nms_per_rad": 0.1,
        "command.reference.signal": "chirp",
        "command.reference.first_Hz": 0.5,
        "command.reference.last_Hz": 20.0,
        "command.reference.duration_s": 0.05,
        "command.reference.amplitude": 40.0,
    },
    '--load driven --output-speed "-60 deg/s" --command open': {
        "load.kind": "driven",
        "load.speed.value": -60.0 * DEGREE,
        "command.kind": "open",
    },
    '--load wall --wall-angle "-20 deg" --wall-stiffness "900 N*m/rad" '
    '--load-inertia "0.2 kg*m^2" --command impedance --velocity-gain "3 N*m*s/rad"': {
        "load.kind": "wall",
        "load.inertia_kgm2": 2.28 * 0.5**2 + 0.2,
        "load.wall.angle_rad": -20.0 * DEGREE,
        "load.wall.stiffness_Nm_per_rad_to_exponent": 900.0,
        "load.wall.side": -1,
        "command.position_gain_Nm_per_rad": 60.0,
        "command.velocity_gain_Nms_per_rad": 3.0,
    },
    '--load locked --sensor-stiffness "2e4 N*m/rad" --command current': {
        "load.kind": "locked",
        "load.sensor_stiffness_Nm_per_rad": 2e4,
        "command.reference.value": 0.25 * 50.5,
    },
    '--load pendulum --arm "200 mm" --voltage "24 V" --command voltage --frequency "5 Hz" '
    '--offset "2 V"': {
        "supply_voltage_V": 24.0,
        "load.kind": "pendulum",
        "load.gravity_moment_Nm": 2.28 * GRAVITY * 0.2,
        "command.reference.amplitude": 12.0,
        "command.reference.offset": 2.0,
        "command.reference.frequency_Hz": 5.0,
    },
    '--step "10 us" --rate "2 kHz" --friction lugre': {
        "step_s": 1e-5,
        "rate_Hz": 2000.0,
        "friction": "lugre",
        "seeds": [],
    },
    '--load inertia --seed 5 --duration "70 ms" --position-gain "9 N*m/rad" --command position': {
        "seeds": [5],
        "rate_Hz": 1000.0,
        "command.position_gain_Nm_per_rad": 9.0,
        "command.reference.value": 0.5,
    },
}


@pytest.mark.parametrize("options", REACHES)
def test_every_option_reaches_the_file(simulate, tmp_path, options):
    arguments = shlex.split(options)
    code, said = simulate(*SHORT, *arguments)
    assert code == 0, said
    with np.load(tmp_path / "exports" / "cqdd-10-simulation.npz") as file:
        told = json.loads(str(file["metadata"]))
        angle = file["output_angle [rad]"]
    given = dict(zip(arguments[::2], arguments[1::2], strict=True))
    for option, text in given.items():
        assert option == "--seed" or told["options"][option] == text
    for key, wanted in REACHES[options].items():
        value = told
        for part in key.split("."):
            value = value[part]
        assert value == (pytest.approx(wanted) if isinstance(wanted, float) else wanted), key
    if "--start-angle" in given:
        assert angle[0] == pytest.approx(told["start_angle_rad"], abs=1e-2)
