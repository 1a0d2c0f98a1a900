"""Stops of the output on the command line: JSON, table, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from cqdd_design.cli.main import run

DESIGN = Path(__file__).resolve().parents[2] / "designs" / "reference-s.toml"


def with_speed(folder: Path, value: str) -> Path:
    path = folder / "s.toml"
    text = DESIGN.read_text(encoding="utf-8")
    path.write_text(text.replace('"1286 rpm"', f'"1286 rpm"\nshock_speed = {value}', 1))
    return path


def test_analyse_tells_what_a_stop_does(cqdd, tmp_path):
    path = with_speed(tmp_path, '"3 rad/s"')
    found = cqdd("analyse", str(path), "--angles", "24", "--json").document
    given, rated = found["results"]["shock"]["given"], found["results"]["shock"]["rated"]
    assert given["speed_rad_per_s"] == 3.0
    by_energy = given["by_energy"]
    assert by_energy["torque_Nm"] > given["by_secant"]["torque_Nm"] > 100.0
    assert by_energy["forces"]["ring_pressure_max_MPa"] > 1000.0
    assert {"check", "title", "value", "limit", "unit"} == set(by_energy["static_limits"][0])
    assert rated["by_energy"]["torque_Nm"] is None
    assert rated["by_energy"]["forces"] is None
    assert "farther than they reach" in rated["by_energy"]["told"]
    assert found["design"]["requirements"]["shock_speed"] == "3 rad/s"
    assert "requirements.shock_speed" not in found["assumed"]


@pytest.mark.parametrize(
    ("value", "says"),
    [
        ("3", "has no unit"),
        ('"-1 rad/s"', "0 rad/s"),
        ('"3 N*m"', "speed"),
        ('"1e5 rad/s"', "1000 rad/s"),
    ],
)
def test_speeds_that_are_none(value, says, tmp_path, capfd):
    assert run(["analyse", str(with_speed(tmp_path, value))]) == 3
    told = capfd.readouterr().err
    assert "requirements.shock_speed" in told
    assert says in told
