"""Recordings: planned steps, columns with units, files read back, references from CSV."""

from __future__ import annotations

import functools
import json
import math
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.packing import largest_step
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.actuator.recording import (
    LONGEST_STEP,
    MOST_STEPS,
    MOST_VALUES,
    Recording,
    plan,
    unit_of,
    write_npz,
    write_parquet,
)
from cqdd_design.actuator.reference import read_reference
from cqdd_design.actuator.scenario import (
    Command,
    Constant,
    Load,
    Sampled,
    Scenario,
    Sine,
    Start,
    Wall,
)
from cqdd_design.actuator.specimen import Specimen
from cqdd_design.design import load_design
from cqdd_design.errors import DependencyError, DesignError, UsageError
from cqdd_design.machine import resolve
from cqdd_design.roads import simulate as road
from cqdd_design.units import ANGLE, CURRENT, TIME, TORQUE, parse_quantity

DESIGN = load_design(Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml")
LOCKED = Scenario(Command("torque", Constant(5.0)), Load.locked())
SWINGING = Scenario(
    Command("impedance", Sine(0.4, 1.2)), Load.pendulum(1.0, 0.4, wall=Wall(0.3, 500.0))
)


@functools.lru_cache(maxsize=1)
def perfect() -> ActuatorParameters:
    return actuator_parameters(resolve(DESIGN))


def recorded(
    scenario: Scenario, duration: float = 0.5, *, seed: int | None = None, **more: object
) -> Recording:
    return road.simulate(DESIGN, scenario, Specimen(seed=seed), duration=duration, **more)


@pytest.fixture(scope="module")
def swinging() -> Recording:
    return recorded(SWINGING, 1.0)


# The plan ---------------------------------------------------------------------------------------


@settings(deadline=None, max_examples=examples(60))
@given(rate=st.floats(1.0, 2e5), frequency=st.floats(0.1, 2000.0), locked=st.booleans())
def test_default_steps_are_safe_and_fill_every_record(rate, frequency, locked):
    load = Load.locked() if locked else Load.free()
    scenario = Scenario(Command("torque", Sine(1.0, frequency)), load)
    chosen = plan([perfect()], scenario, 1.0, rate)
    assert chosen.step * chosen.every == pytest.approx(1.0 / rate, rel=1e-12)
    assert chosen.rate == pytest.approx(rate, rel=1e-12)
    limit, _ = largest_step(perfect(), scenario)
    assert chosen.step <= min(0.5 * limit, LONGEST_STEP, 0.05 / frequency) * (1.0 + 1e-9)


def refused(**asked: float) -> str:
    frequency = asked.pop("frequency", 0.0)
    command = Command("torque", Sine(1.0, frequency) if frequency else Constant(1.0))
    sets = [perfect()] * int(asked.pop("sets", 1))
    with pytest.raises(UsageError) as caught:
        plan(sets, Scenario(command, Load.locked()), **{"duration": 5.0, "rate": 1e3, **asked})
    return str(caught.value)


def named(pattern: str, text: str) -> float:
    found = re.search(pattern, text)
    assert found, text
    return float(found[1])


@pytest.mark.parametrize("step", [5e-5, 1e-3, 1.0, 1e3])
def test_a_step_too_large_names_one_that_works(step):
    text = refused(step=step)
    assert "too large for the stiffness of gearbox and load" in text
    works = named(r"use ([0-9.e+-]+) s", text)
    assert plan([perfect()], LOCKED, 5.0, 1e3, works).step == works < step


def test_a_step_too_long_for_the_sine_names_one_that_works():
    text = refused(step=2e-5, frequency=5e3)
    works = named(r"use ([0-9.e+-]+) s", text)
    fast = Scenario(Command("torque", Sine(1.0, 5e3)), Load.locked())
    assert plan([perfect()], fast, 5.0, 1e3, works).step == works == 1e-5


@pytest.mark.parametrize(("rate", "sets"), [(1e6, 1), (1e12, 1), (2e4, 50)])
def test_a_huge_record_names_the_rate_that_works(rate, sets):
    text = refused(rate=rate, sets=sets)
    works = named(r"use a rate of ([0-9.e+-]+) Hz", text)
    columns = named(r"of (\d+) columns", text)
    plan([perfect()] * sets, LOCKED, 5.0, works)
    assert works < rate
    assert works * 5.0 * sets * columns <= MOST_VALUES < 2.5 * works * 5.0 * sets * columns


@pytest.mark.parametrize("duration", [1e4, 1e300])
def test_a_long_run_names_the_duration_that_works(duration):
    works = named(r"duration of ([0-9.e+-]+) s or less", refused(duration=duration, rate=1.0))
    chosen = plan([perfect()], LOCKED, works, 1.0)
    assert works / chosen.step <= MOST_STEPS


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"duration": 5e-4}, "use a rate of 2000 Hz or more"),
        ({"rate": 1e5, "step": 2e-5}, "use 50000 Hz or less, or a step of 1e-05 s"),
        ({"frequency": 1e9}, "use 200000 Hz or less"),
    ],
)
def test_what_does_not_go_together_is_refused(asked, said):
    assert said in refused(**asked)


# Columns and files ------------------------------------------------------------------------------


def test_every_column_has_the_unit_of_its_name(swinging):
    columns = swinging.columns()
    assert all(unit_of(name) for name in columns)
    assert unit_of("motor_speed [rad/s]") == "rad/s"
    assert {len(values) for values in columns.values()} == {1000}
    np.testing.assert_allclose(columns["time [s]"], 1e-3 * np.arange(1, 1001), rtol=1e-12)
    wanted = 0.4 * np.sin(2.0 * math.pi * 1.2 * columns["time [s]"])
    np.testing.assert_allclose(columns["reference_angle [rad]"], wanted, atol=1e-12)


@pytest.mark.parametrize(
    ("mode", "column"),
    [
        ("torque", "commanded_torque [N m]"),
        ("current", "commanded_current [A]"),
        ("voltage", "commanded_voltage [V]"),
    ],
)
def test_a_command_is_recorded_in_its_own_unit(mode, column):
    columns = recorded(Scenario(Command(mode, Constant(2.0)), Load.locked()), 0.02).columns()
    assert [name for name in columns if name.startswith("commanded")] == [column]
    assert np.all(columns[column] == 2.0)


@pytest.mark.deep
def test_sets_stand_one_after_the_other_and_come_of_their_seeds():
    many = recorded(LOCKED, 0.1, step=1e-5, seed=3, samples=2)
    alone = recorded(LOCKED, 0.1, step=1e-5, seed=4)
    columns = many.columns()
    assert "set" not in alone.columns()
    np.testing.assert_array_equal(columns["set"], np.repeat([0, 1], 100))
    second = columns["set"] == 1
    for name, values in alone.columns().items():
        np.testing.assert_array_equal(columns[name][second], values)
    assert not np.array_equal(
        columns["deflection [rad]"][second], columns["deflection [rad]"][:100]
    )
    assert many.metadata()["seeds"] == [3, 4]
    assert many.metadata()["parts"] != recorded(LOCKED, 0.01).metadata()["parts"]


def test_npz_reads_back_without_pickles(swinging, tmp_path):
    write_npz(tmp_path / "a.npz", swinging)
    with np.load(tmp_path / "a.npz", allow_pickle=False) as file:
        metadata = json.loads(str(file["metadata"]))
        assert set(file.files) == {"metadata", *swinging.columns()}
        for name, values in swinging.columns().items():
            np.testing.assert_array_equal(file[name], values)
    assert metadata["columns"] == {name: unit_of(name) for name in swinging.columns()}
    assert metadata["design_sha256"] == DESIGN.sha256
    assert metadata["step_s"] == swinging.simulation.step
    write_npz(tmp_path / "b.npz", recorded(SWINGING, 1.0))
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


def test_parquet_reads_back_with_units_and_metadata(swinging, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    write_parquet(tmp_path / "a.parquet", swinging)
    table = parquet.read_table(tmp_path / "a.parquet")
    assert table.column_names == list(swinging.columns())
    for name, values in swinging.columns().items():
        np.testing.assert_array_equal(table[name].to_numpy(), values)
        assert table.schema.field(name).metadata[b"unit"].decode() == unit_of(name)
    told = {key.decode(): json.loads(value) for key, value in table.schema.metadata.items()}
    assert told == json.loads(json.dumps(swinging.metadata()))
    assert told["design_sha256"] == DESIGN.sha256


def test_without_pyarrow_the_sentence_says_what_to_install(swinging, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(DependencyError, match=r'pip install "cqdd-design\[parquet\]"') as caught:
        write_parquet(tmp_path / "a.parquet", swinging)
    assert caught.value.exit_code == 5
    with pytest.raises(DependencyError):
        road.simulation_kind(tmp_path / "a.parquet")
    assert not list(tmp_path.iterdir())


def test_metadata_says_command_and_load_in_si(swinging):
    told = swinging.metadata()
    assert told["command"]["kind"] == "impedance"
    assert told["command"]["reference"] == {
        "signal": "sine",
        "unit": "rad",
        "amplitude": 0.4,
        "frequency_Hz": 1.2,
        "offset": 0.0,
        "phase_rad": 0.0,
    }
    assert told["command"]["position_gain_Nm_per_rad"] == DESIGN.drive.position_gain
    assert told["load"]["kind"] == "wall"
    assert told["load"]["gravity_moment_Nm"] == pytest.approx(0.4 * 9.80665)
    assert told["load"]["wall"]["angle_rad"] == 0.3
    sampled = Sampled(np.array([0.0, 1.0]), np.array([0.0, 2.0]))
    other = Sampled(np.array([0.0, 1.0]), np.array([0.0, 3.0]))
    digests = [
        recorded(Scenario(Command("current", s), Load.driven(Constant(1.0))), 0.01).metadata()
        for s in (sampled, other)
    ]
    assert digests[0]["load"]["kind"] == "driven"
    assert digests[0]["load"]["speed"]["value"] == 1.0
    first, second = (one["command"]["reference"]["samples_sha256"] for one in digests)
    assert first != second


def test_the_summary_is_that_of_the_columns_and_balances(swinging):
    (told,) = swinging.summary()
    columns = swinging.columns()
    torque = columns["output_torque [N m]"]
    assert told["output_torque_Nm_peak"] == np.abs(torque).max()
    assert told["output_torque_Nm_rms"] == pytest.approx(np.sqrt(np.mean(torque**2)))
    assert told["current_A_peak"] == np.abs(columns["current [A]"]).max()
    left = told["electrical_J"] + told["external_J"] - told["dissipated_J"] - told["stored_J"]
    assert left == pytest.approx(told["residual_J"], abs=1e-12)
    assert told["dissipated_J"] > 0.0
    assert told["residual_share"] < 1e-6


def test_limits_that_bind_are_told():
    calm = recorded(LOCKED, 0.05)
    (told,) = calm.warnings
    assert "does not carry it" in told
    strong = recorded(Scenario(Command("torque", Constant(500.0)), Load.locked()), 0.05)
    assert any("current limit of 50.5 A binds" in text for text in strong.warnings)
    fast = recorded(Scenario(Command("voltage", Constant(48.0)), Load.free()), 0.2)
    assert any("supply of 48 V binds" in text for text in fast.warnings)
    hot = Start(winding_temperature=115.0, housing_temperature=90.0)
    warm = recorded(Scenario(LOCKED.command, LOCKED.load, hot), 0.05)
    assert any("the winding reaches 115 degC" in text for text in warm.warnings)
    whirl = recorded(Scenario(Command("open"), Load.driven(Constant(60.0))), 0.05)
    assert any("finest ripple" in text for text in whirl.warnings)


def test_seeds_beyond_the_last_are_refused():
    with pytest.raises(UsageError, match="lower seed"):
        recorded(LOCKED, 0.1, seed=2**64 - 1, samples=2)


@pytest.mark.parametrize(("text", "value"), [("20 us", 2e-5), ("2 min", 120.0), ("1 hour", 3600.0)])
def test_units_of_time(text, value):
    assert parse_quantity(text, TIME) == pytest.approx(value, rel=1e-12)
    with pytest.raises(DesignError):
        parse_quantity("1 Hz", TIME)


# References -------------------------------------------------------------------------------------

EVEN = "time [s],torque [N m]\n" + "".join(f"{0.01 * k:.2f},{k % 7}\n" for k in range(60))


def test_a_reference_in_any_fitting_unit(tmp_path):
    path = tmp_path / "r.csv"
    path.write_text(
        "\ufeff# measured on a bench\ntime [ms], knee torque [N*mm]\n0,1000\n\n10,-2000\n25,500\n",
        encoding="utf-8",
    )
    read = read_reference(path, TORQUE)
    np.testing.assert_allclose(read.times, [0.0, 0.01, 0.025])
    np.testing.assert_allclose(read.samples, [1.0, -2.0, 0.5])
    path.write_text("time [s],angle [deg]\n0,0\n1,90\n")
    np.testing.assert_allclose(read_reference(path, ANGLE).samples, [0.0, math.pi / 2.0])


def test_corner_points_far_apart_are_no_gap(tmp_path):
    path = tmp_path / "r.csv"
    path.write_text("time [s],current [A]\n0,0\n0.1,5\n4,5\n4.1,0\n")
    assert len(read_reference(path, CURRENT).times) == 4
    path.write_text(EVEN)
    assert len(read_reference(path, TORQUE).times) == 60


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("", "is empty; a reference begins with the line time [s],torque [N*m]"),
        ("time [s]\n0\n1\n", "a reference has two, such as time [s],torque [N*m]"),
        ("torque [N m],time [s]\n0,0\n1,1\n", "a reference has two"),
        ("time [s],torque [N m],speed [rad/s]\n0,0,0\n", "a reference has two"),
        ("time,torque\n0,0\n1,1\n", "the column 'time' has no unit; write time [s]"),
        ("time [s],torque\n0,0\n1,1\n", "the column 'torque' has no unit"),
        ("time [s],angle [rad]\n0,0\n1,1\n", "'rad' is not a unit of torque"),
        ("time [Hz],torque [N m]\n0,0\n1,1\n", "'Hz' is not a unit of time"),
        ("time [s],torque [N m]\n0,0\n1,\n2,1\n", "line 3: a gap, 'torque [N m]' is empty"),
        ("time [s],torque [N m]\n0,0\n1\n", "line 3 has 1 cells instead of 2"),
        ("time [s],torque [N m]\n0,0\n1,nan\n", "line 3: 'torque [N m]' is nan"),
        ("time [s],torque [N m]\n0,0\ninf,1\n", "line 3: 'time [s]' is inf"),
        ("time [s],torque [N m]\n0,0\n1,5 N m\n", "line 3: '5 N m' in 'torque [N m]' is no number"),
        ("time [s],torque [N m]\n0,0\n2,1\n1,1\n", "line 4: the time 1 does not rise above 2"),
        ("time [s],torque [N m]\n0,0\n0,1\n", "line 3: the time 0 does not rise"),
        ("time [s],torque [N m]\n0,0\n", "has 1 rows; a reference needs two or more"),
        ("time [s],torque [N m]\n", "has 0 rows"),
        (re.sub(r"0\.3\d,\d\n", "", EVEN), "a gap of 0.11 s before line 32"),
        (b"\xff\xfe\x00\x80", "is not a text file"),
    ],
)
def test_a_reference_that_is_none(tmp_path, content, said):
    path = tmp_path / "r.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(UsageError) as caught:
        read_reference(path, TORQUE)
    assert said in str(caught.value)
    assert str(path) in str(caught.value)


def test_a_reference_that_cannot_be_read(tmp_path):
    with pytest.raises(UsageError, match="there is no such file"):
        read_reference(tmp_path / "none.csv", TORQUE)
    with pytest.raises(UsageError, match="it is a folder"):
        read_reference(tmp_path, TORQUE)
