"""--motor-file: the motor of a file, wherever a command has to do with one."""

import tomllib

import pytest

SMALL = """\
name = "rewound"
mass = "0.9 kg"
rotor_inertia = "2e-4 kg*m^2"
peak_torque = "13 N*m"
rated_torque = "5 N*m"
"""


@pytest.fixture
def motor_file(tmp_path):
    path = tmp_path / "motor.toml"
    path.write_text(SMALL)
    return path


def test_check_judges_the_motor_of_the_file(cqdd, tmp_path, motor_file):
    design = tmp_path / "sized-10.toml"
    assert cqdd("size", "--ratio", "10", "--out", design).code == 0
    usual = {one["id"]: one for one in cqdd("check", design, "--json").document["checks"]}
    done = cqdd("check", design, "--motor-file", motor_file, "--json")
    own = {one["id"]: one for one in done.document["checks"]}
    assert usual["MOTOR-PEAK"]["limit"] == own["MOTOR-PEAK"]["limit"] == 90.0
    assert usual["MOTOR-PEAK"]["value"] != own["MOTOR-PEAK"]["value"]
    motor_file.write_text(SMALL.replace("13 N*m", "2 N*m"))
    assert cqdd("check", design, "--motor-file", motor_file).code == 4


def test_size_designs_for_the_motor_of_the_file(cqdd, tmp_path, motor_file):
    usual = cqdd("size", "--ratio", "10", "--out", "a.toml", "--json").document["results"]
    done = cqdd("size", "--ratio", "10", "--motor-file", motor_file, "--out", "b.toml", "--json")
    assert done.code == 0, done.err
    own = done.document["results"]
    for results, inertia in ((usual, 8.7e-4), (own, 2e-4)):
        goal = results["objective"]
        rotor = goal["reflected_inertia_kgm2"] - goal["gearbox_inertia_kgm2"]
        assert rotor == pytest.approx(inertia)
    # Whoever gives a motor's data asks for that motor.
    assert tomllib.loads((tmp_path / "b.toml").read_text())["motor"]["name"]
    motor_file.write_text(SMALL.replace("13 N*m", "2 N*m"))
    weak = cqdd("size", "--ratio", "10", "--motor-file", motor_file, "--out", "c.toml")
    assert weak.code == 3
    assert "motor 'rewound' does not meet" in weak.err


@pytest.mark.deep
def test_inertia_weighs_the_motor_of_the_file(cqdd, paper_design_file, motor_file):
    done = cqdd("inertia", paper_design_file, "--motor-file", motor_file, "--json")
    results = done.document["results"]
    assert results["rotor_inertia_kgm2"] == 2e-4
    assert results["group_mass_kg"]["motor"] == pytest.approx(0.9, rel=1e-4)
    rotor = (
        results["reflected_inertia_input_kgm2"] - results["gearbox_reflected_inertia_input_kgm2"]
    )
    assert rotor == pytest.approx(2e-4, rel=1e-3)


def test_the_bill_names_the_motor_of_the_file(cqdd, tmp_path, paper_design_file, motor_file):
    out = tmp_path / "out"
    done = cqdd(
        "export", paper_design_file, "--to", "bom", "--out", out, "--motor-file", motor_file
    )
    assert done.code == 0, done.err
    (text,) = [path.read_text() for path in out.iterdir()]
    assert "rewound, stator" in text
    assert "motor.toml" in text
    assert "RO100 KV55, stator" not in text
