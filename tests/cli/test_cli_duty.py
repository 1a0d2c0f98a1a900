"""Duties over time and other requirements through the commands, right and wrong."""

import tomllib

import pytest

HEAD = "time [s],torque [N*m],speed [rad/s]"
GENTLE = f"{HEAD}\n0,1,0.5\n0.1,3,1\n0.3,2,-2\n0.5,-1,-3\n1,1,0.5\n"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (f"{HEAD}\n0,1,2\n0.1,,2\n", "knee.csv, line 3: a gap, 'torque [N*m]' is empty"),
        (HEAD + "\n" + "".join(f"{k if k < 30 else k + 9},1,2\n" for k in range(40)),
         "knee.csv, line 32: a gap of 10 s in column 'time [s]'"),
        (f"{HEAD}\n0,1,2\n2,1,2\n1,1,2\n", "line 4: 1 in column 'time [s]' does not rise above 2"),
        (f"{HEAD}\n0,1,2\n1,1,2\n1,1,2\n", "line 4: 1 in column 'time [s]' stands in the line"),
        (f"{HEAD}\n0,1,2\n1,1,nan\n", "line 3: column 'speed [rad/s]' is nan"),
        ("time [s],torque [N],speed [rad/s]\n0,1,2\n", "'N' is not a unit of torque"),
        (f"{HEAD}\n0,1,2\n", "has one row; a duty needs two or more"),
        ("a,b\n1,2\n", "has no column named time or t"),
    ],
)  # fmt: skip
def test_what_is_no_duty_is_refused_with_line_and_column(
    cqdd, tmp_path, paper_design_file, text, says
):
    (tmp_path / "knee.csv").write_text(text)
    for command in (("check", paper_design_file), ("size", "--quick", "--ratio", "10")):
        done = cqdd(*command, "--duty", "knee.csv")
        assert done.code in (2, 3), done.err
        assert says in done.err
        assert done.err.startswith("cqdd-design: ")
        assert done.out == ""


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (("--peak-torque", "5 N*m", "--continuous-torque", "6 N*m"), "above peak_torque 5 N*m"),
        (("--life", "0 h"), "0 h is outside 1 h to 100000 h"),
        (("--life", "1000"), 'write it like "1000 h"'),
        (("--continuous-speed", "2000 rpm"), "above input_speed 1286 rpm"),
        (("--speed-at-peak", "30 rad/s"), "above input_speed 1286 rpm"),
        (("--yield", "95"), "95 is not a number from 0.01 to 1"),
        (("--efficiency", "80"), "80 is not a number from 0.01 to 0.999"),
        (("--backlash", "6"), 'write it like "6 arcmin"'),
        (("--stiffness", "10 N*m"), "torque per angle"),
        (("--bore", "80 mm"), "not within outer_diameter 72 mm"),
        (("--mass", "1 N"), "'N' is not a unit of mass"),
        (("--ambient", "40"), 'write it like "40 degC"'),
        (("--duty-columns", "time=t"), "which is missing"),
        (("--duty", "gone.csv"), "there is no such file"),
    ],
)
def test_contradictions_are_a_sentence(cqdd, options, says):
    done = cqdd("size", "--quick", "--ratio", "10", *options)
    assert done.code == 2, done.err
    assert says in done.err
    assert done.out == ""


def test_a_speed_above_the_motors_is_told(cqdd):
    done = cqdd(
        "size", "--quick", "--ratio", "10", "--input-speed", "9000 rpm", "--peak-torque", "5 N*m"
    )
    told = " ".join((done.out + done.err).split())
    assert "Traceback" not in told
    assert done.code == 0


@pytest.mark.deep
def test_a_speed_above_the_motors_is_a_no_with_what_would_do(cqdd, tmp_path, paper_design_file):
    text = paper_design_file.read_text()
    (tmp_path / "fast.toml").write_text(text.replace('"1286 rpm"', '"9000 rpm"'))
    check = cqdd("check", "fast.toml")
    assert check.code == 4
    assert "raise motor.voltage (and requirements.voltage where it is stated) to about" in " ".join(
        check.out.split()
    )
    assert "does NOT meet its requirements" in check.out


@pytest.mark.deep
def test_a_day_of_a_million_rows_is_answered(cqdd, tmp_path, paper_design_file):
    second = "".join(f"%d.{k:02d},{k / 20},{(50 - k) / 10}\n" for k in range(100))
    with (tmp_path / "day.csv").open("w") as stream:
        stream.write(HEAD + "\n")
        stream.writelines(second.replace("%d", str(k)) for k in range(10_000))
    options = ("--duty", "day.csv", "--angles", "8", "--json")
    results = cqdd("analyse", paper_design_file, *options).document["results"]
    assert results["duty"]["rows"] == 1_000_000
    assert len(results["life"]["duty"]) <= 64
    assert results["duty"]["rows_outside"] == 0


@pytest.mark.deep
def test_points_outside_are_named_with_line_time_torque_speed_and_limit(
    cqdd, tmp_path, paper_design_file
):
    rows = "0,2,1\n0.2,90,1\n0.4,2,1\n0.6,3,60\n1,2,1\n"
    (tmp_path / "knee.csv").write_text(f"# knee\n{HEAD}\n{rows}")
    done = cqdd("analyse", paper_design_file, "--duty", "knee.csv", "--angles", "8", "--json")
    line = next(one for one in done.document["checks"] if one["id"] == "DUTY-ENVELOPE")
    assert (line["status"], line["value"]) == ("fail", 2.0)
    assert "2 of 5 rows in 2 stretches" in line["substituted"]
    assert "line 4 (0.2 s): 90 N*m at 1 rad/s, driver" in line["substituted"]
    assert "line 6 (0.6 s): 3 N*m at 60 rad/s, voltage" in line["substituted"]
    assert done.document["design"]["requirements"]["duty_file"] == "knee.csv"


@pytest.mark.deep
def test_a_given_duty_wins_over_that_of_the_design(cqdd, tmp_path, paper_design_file):
    own = tmp_path / "own.toml"
    text = paper_design_file.read_text()
    own.write_text(text.replace("[requirements]", '[requirements]\nduty_file = "logs/own.csv"', 1))
    (tmp_path / "logs").mkdir()
    (tmp_path / "logs" / "own.csv").write_text(GENTLE)
    (tmp_path / "other.csv").write_text(GENTLE.replace("0.3,2,-2", "0.3,4,-2"))
    usual = cqdd("export", own, "--to", "bom", "--json").document["design"]["requirements"]
    assert usual["duty_file"] == "logs/own.csv"
    done = cqdd("analyse", own, "--angles", "8", "--duty", "other.csv", "--json").document
    duty = done["results"]["duty"]
    assert (duty["file"], duty["torque_peak_Nm"]) == ("other.csv", 4.0)


@pytest.mark.deep
def test_a_sized_design_finds_its_duty_from_its_own_folder(cqdd, tmp_path):
    (tmp_path / "knee.csv").write_text(GENTLE.replace("time [s]", "t_of_log [s]"))
    options = ("--duty", "knee.csv", "--duty-columns", "time=t_of_log")
    wanted = ("--life", "500 h", "--yield", "0.9", "--ambient", "30 degC", "--voltage", "36 V")
    wanted += ("--peak-torque", "40 N*m", "--continuous-torque", "5 N*m")
    done = cqdd("size", "--quick", "--ratio", "10", *options, *wanted)
    assert done.code == 0, done.err
    written = tomllib.loads((tmp_path / "designs" / "sized-10.toml").read_text())
    asked = written["requirements"]
    assert asked["duty_file"] == "../knee.csv"
    assert asked["duty_columns"] == {"time": "t_of_log"}
    assert (asked["life"], asked["yield"]) == ("500 h", 0.9)
    assert written["environment"]["ambient"] == "30 degC"
    told = cqdd("analyse", "designs/sized-10.toml", "--angles", "8", "--json").document
    assert told["results"]["duty"]["rows"] == 5
    assert told["results"]["life"]["required_hours"] == 500.0


@pytest.mark.deep
def test_the_template_of_a_duty_is_sized_to_a_yes(cqdd):
    """As whoever tries it first does; and what `check` then says is the same."""
    assert cqdd("new", "duty").code == 0
    sized = cqdd("size", "--ratio", "10", "--duty", "duty.csv", "--out", "knee.toml", "--json")
    assert sized.code == 0, sized.err
    judged = cqdd("check", "knee.toml", "--json")
    assert judged.code == 0
    one, other = (done.document["results"]["verdict"] for done in (sized, judged))
    assert one["meets"] == other["meets"] == "yes"
    assert one["headline"] == other["headline"]


@pytest.mark.deep
def test_a_duty_that_is_too_much_for_the_motor_is_told_as_that(cqdd, tmp_path):
    """At once, and not as what a gearbox of that space bears."""
    rows = "0,5,0.5\n0.1,30,1\n0.3,22,-2\n0.5,-4,-3.5\n0.7,-6,4\n1,5,0.5\n"
    (tmp_path / "heavy.csv").write_text(f"{HEAD}\n{rows}")
    done = cqdd("size", "--ratio", "10", "--duty", "heavy.csv", "--json")
    assert done.code == 3
    error = done.document["error"]
    assert error["details"]["binding"] == ["THERMAL-RISE"]
    assert "lower torques or speeds of the duty" in error["message"]
    assert "No larger ring" not in error["message"]
    assert "pitting" not in error["message"]
