"""--motor, --motor-file and [motor]: one motor, wherever a command has to do with one."""

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


@pytest.mark.deep
def test_check_judges_the_motor_of_the_file(cqdd, paper_design_file, motor_file):
    usual = {
        one["id"]: one for one in cqdd("check", paper_design_file, "--json").document["checks"]
    }
    motor_file.write_text(SMALL.replace("13 N*m", "2 N*m"))
    done = cqdd("check", paper_design_file, "--motor-file", motor_file, "--json")
    assert done.code == 4
    own = {one["id"]: one for one in done.document["checks"]}
    assert usual["MOTOR-PEAK"]["limit"] == own["MOTOR-PEAK"]["limit"] == 120.0
    assert own["MOTOR-PEAK"]["value"] < 20.0 < usual["MOTOR-PEAK"]["value"]


def test_size_designs_for_the_motor_of_the_file(cqdd, tmp_path, motor_file):
    motor_file.unlink()  # so that what follows is what others have asked for
    usual = cqdd("size", "--quick", "--ratio", "10", "--json").document["results"]
    motor_file.write_text(SMALL)
    done = cqdd(
        "size", "--quick", "--ratio", "10", "--motor-file", motor_file, "--out", "b.toml", "--json"
    )
    assert done.code == 0, done.err
    own = done.document["results"]
    for results, inertia in ((usual, 8.7e-4), (own, 2e-4)):
        goal = results["objective"]
        rotor = goal["reflected_inertia_kgm2"] - goal["gearbox_inertia_kgm2"]
        assert rotor == pytest.approx(inertia)
    # The design says its motor, so that no later command sees another one.
    motor = tomllib.loads((tmp_path / "b.toml").read_text())["motor"]
    assert motor["name"] == "rewound"
    assert motor["based_on"] == "CubeMars RO100 KV55"
    assert motor["rotor_inertia"] == "0.0002 kg*m^2"
    assert motor["peak_torque"] == "13 N*m"
    motor_file.write_text(SMALL.replace("13 N*m", "2 N*m"))
    weak = cqdd("size", "--quick", "--ratio", "10", "--motor-file", motor_file, "--out", "c.toml")
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
    assert ",rewound,bonded" in text.replace(chr(34), "")
    assert "rewound, ring of magnets" in text
    assert "motor.toml" in text
    assert "RO100 KV55, stator" not in text


WINDING = """
torque_constant = "0.1504 N*m/A"
convention = "torque_per_peak"
resistance = "71.5 mohm"
measured_between = "phase"
"""


@pytest.fixture
def inline(tmp_path, paper_design_file):
    """The paper's design, with data of its motor in the table."""
    path = tmp_path / "inline.toml"
    text = paper_design_file.read_text()
    assert "[motor]\n" in text
    path.write_text(text.replace("[motor]\n", '[motor]\npeak_torque = "5 N*m"\n'))
    return path


def motor_of(cqdd, tmp_path, *words):
    """The motor that an inexpensive command works with, and its warnings."""
    done = cqdd("export", *words, "--to", "bom", "--out", tmp_path / "o", "--json", "--force")
    assert done.code == 0, done.err
    return done.document["design"]["motor"], done.document["warnings"]


def test_the_option_goes_over_the_table_and_that_over_the_catalogue(
    cqdd, tmp_path, inline, motor_file
):
    found, _ = motor_of(cqdd, tmp_path, inline)
    assert found["peak_torque"] == "5 N*m"
    motor_file.write_text('name = "other"\nrated_torque = "3 N*m"\n')
    found, told = motor_of(cqdd, tmp_path, inline, "--motor-file", motor_file)
    assert (found["peak_torque"], found["rated_torque"]) == ("5 N*m", "3 N*m")
    assert not any("goes before" in one for one in told)
    motor_file.write_text(SMALL)
    found, told = motor_of(cqdd, tmp_path, inline, "--motor-file", motor_file)
    assert found["peak_torque"] == "13 N*m"
    assert found["based_on"] == "CubeMars RO100 Lite KV55"
    (over,) = [one for one in told if "goes before [motor]" in one]
    assert over.endswith("whose peak_torque does not apply.")
    other = ("--motor", "CubeMars RO80 KV105")
    found, told = motor_of(cqdd, tmp_path, inline, *other)
    assert found["name"] == "CubeMars RO80 KV105"
    assert "peak_torque" not in found
    assert any("whose peak_torque does not apply" in one for one in told)
    found, _ = motor_of(cqdd, tmp_path, inline, *other, "--motor-file", motor_file)
    assert found["based_on"] == "CubeMars RO80 KV105"


def test_the_keys_may_stand_under_motor_in_the_file(cqdd, tmp_path, paper_design_file, motor_file):
    option = ("--motor-file", motor_file)
    alone, _ = motor_of(cqdd, tmp_path, paper_design_file, *option)
    motor_file.write_text(f"[motor]\n{SMALL}")
    assert motor_of(cqdd, tmp_path, paper_design_file, *option)[0] == alone
    for text, says in (
        (f"[motor]\n{SMALL}[drive]\nencoder_bits = 14\n", "beside [motor] it has 'drive'"),
        (f'[motor]\n{SMALL}voltage = "48 V"\n', "no motor file has voltage; the driver's supply"),
        (
            f'{SMALL}current_limit = "9 A"\nvoltage = "9 V"\n',
            "no motor file has voltage or current_limit",
        ),
    ):
        motor_file.write_text(text)
        done = cqdd("check", paper_design_file, *option)
        assert done.code == 3
        assert says in done.err


def test_a_motor_of_its_own_leaves_what_it_does_not_say_unknown(cqdd, paper_design_file, tmp_path):
    own = tmp_path / "own.toml"
    own.write_text(WINDING)
    done = cqdd("check", paper_design_file, "--motor-file", own, "--json")
    lines = {one["id"]: one for one in done.document["checks"]}
    # No figure of the design's former motor stands in for one of this.
    assert lines["MOTOR-BORE"]["status"] == lines["MOTOR-DATA"]["status"] == "unknown"
    assert lines["MOTOR-PEAK"]["status"] == "unknown"
    assert done.document["results"]["verdict"]["meets"] != "yes"
    assert done.code == 4


#: Every command that takes a motor, with what else it needs; none does its work here.
COMMANDS = [
    ("check", "DESIGN"),
    ("analyse", "DESIGN"),
    ("bench", "DESIGN"),
    ("calibrate", "DESIGN"),
    ("simulate", "DESIGN"),
    ("tolerance", "DESIGN"),
    ("compare", "DESIGN"),
    ("inertia", "DESIGN"),
    ("export", "DESIGN"),
    ("report", "DESIGN"),
    ("size", "--quick", "--ratio", "10"),
    ("torque", "generate", "DESIGN"),
]


@pytest.mark.parametrize("words", COMMANDS, ids=lambda words: " ".join(words))
def test_every_command_refuses_a_geared_actuator(cqdd, paper_design_file, tmp_path, words):
    """By option, by the design and by a file: exit code 3, its name, and what to take instead."""
    words = [paper_design_file if word == "DESIGN" else word for word in words]
    done = cqdd(*words, "--motor", "CubeMars AK80-9 V3")
    assert done.code == 3, done.err
    assert "'CubeMars AK80-9 V3' is a geared actuator" in done.err
    assert "'CubeMars RO80 KV105'" in done.err
    own = tmp_path / "own.toml"
    own.write_text('based_on = "CubeMars AK80-9 V3"\ncoulomb = "0.1 N*m"\n')
    done = cqdd(*words, "--motor-file", own)
    assert done.code == 3, done.err
    assert "is a geared actuator" in done.err
    unknown = cqdd(*words, "--motor", "CubeMars AK81")
    assert unknown.code == 2, unknown.err
    assert "the catalogue has no motor 'CubeMars AK81'; the nearest are" in unknown.err


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ('torque_constant = "0.1 N*m/A"\nspeed_constant = "55 rpm/V"', "say the same; keep one"),
        ('resistance = "-0.1 ohm"', "outside 0.00001 ohm to"),
        ('torque_constant = "0.1 N*m/A"\nconvention = "rms"', "'torque_per_rms'"),
        ('rotor_inertia = "1e-4 kg*m"', "not a unit of moment of inertia"),
        ('resistence = "1 ohm"', "did you mean 'resistance'"),
    ],
)
def test_wrong_data_of_a_motor_end_with_a_sentence(cqdd, tmp_path, paper_design_file, text, says):
    """In a file and in the table: the same sentence, exit code 3."""
    own = tmp_path / "own.toml"
    own.write_text(text)
    in_file = cqdd("check", paper_design_file, "--motor-file", own)
    inline = tmp_path / "inline.toml"
    inline.write_text(paper_design_file.read_text().replace("[motor]\n", f"[motor]\n{text}\n"))
    in_table = cqdd("check", inline)
    for done in (in_file, in_table):
        assert done.code == 3
        assert says in done.err


def test_the_catalogue_shows_torque_speed_bore_inertia_and_what_is_missing(cqdd):
    listed = cqdd("catalog", "motors").out.splitlines()
    head = " ".join(" ".join(listed[:4]).split())
    for word in ("peak", "rated", "torque N*m", "speed", "bore", "rotor inertia", "missing"):
        assert word in head
    row = listed[listed.index("CubeMars RO80 KV105") + 1]
    assert row.split() == ["4", "1.3", "105", "rpm/V", "55", "0.0002612", "0.352", "d"]
    (legend,) = [line for line in listed if line.startswith("missing: ")]
    assert "d drag" in legend
    geared = next(k for k, line in enumerate(listed) if line.startswith("geared actuators"))
    (one,) = [k for k, line in enumerate(listed) if line.startswith("CubeMars AK80-9 V3 ")]
    assert one > geared > listed.index("CubeMars RO80 KV105")
    one = cqdd("catalog", "motors", "CubeMars R100 KV90")
    assert "line resistance " in one.out
    assert "What hangs on rated torque, rotor inertia, drag, cogging, stator bore stays" in one.out
    assert "[motor]" in one.out
    rows = cqdd("catalog", "motors", "--json").document["results"]["rows"]
    assert rows["CubeMars R100 KV90"]["rotor_inertia_kgm2"] is None
    assert rows["MIT mini-cheetah motor (U8-class)"]["speed"] == "110.3 rpm/V"


def test_size_keeps_the_motor_of_its_requirements_file(cqdd, tmp_path):
    asked = tmp_path / "asked.toml"
    asked.write_text(
        '[requirements]\nratio = 10\npeak_torque = "60 N*m"\n[motor]\nname = "mine"\n'
        f'peak_torque = "11 N*m"\nrated_torque = "4 N*m"\n{WINDING}'
    )
    done = cqdd("size", "--quick", "--requirements", asked, "--out", "own.toml", "--json")
    assert done.code == 0, done.err
    assert done.document["design"]["motor"]["name"] == "mine"
    assert done.document["results"]["objective"]["reflected_inertia_kgm2"] is None
    motor, _ = motor_of(cqdd, tmp_path, "own.toml")
    assert motor["peak_torque"] == "11 N*m"
    assert motor["resistance"] == "0.0715 ohm"
