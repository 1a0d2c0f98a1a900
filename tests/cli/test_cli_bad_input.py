"""Every wrong thing a person can type: one clear sentence, and the right exit code."""

import json
import os
import re

import pytest

MINIMAL = """\
[reducer]
ratio = 10
ring_pitch_radius = "32 mm"
eccentricity = "1.6 mm"
ring_pin_diameter = "7 mm"
"""


def with_line(old: str, new: str) -> str:
    assert old in MINIMAL
    return MINIMAL.replace(old, new)


@pytest.fixture
def complaint(cqdd, tmp_path):
    """Write a design file, check it, and return what is said about it."""

    def run(content: str | bytes, code: int = 3) -> str:
        path = tmp_path / "wrong.toml"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        done = cqdd("check", path)
        assert done.code == code, done.err
        assert done.out == ""
        assert done.err.startswith("cqdd-design: ")
        return done.err

    return run


def test_the_minimal_design_is_a_design(cqdd, tmp_path):
    (tmp_path / "fine.toml").write_text(MINIMAL)
    assert cqdd("export", "fine.toml", "--to", "bom").code == 0


# Files ------------------------------------------------------------------------------------------


def test_missing_file_suggests_its_neighbour(cqdd, tmp_path):
    (tmp_path / "knee-joint.toml").write_text(MINIMAL)
    done = cqdd("check", "kneejoint.toml")
    assert done.code == 2
    assert "there is no file kneejoint.toml" in done.err
    assert "did you mean knee-joint.toml?" in done.err


def test_folder_instead_of_a_file(cqdd, tmp_path):
    done = cqdd("check", tmp_path)
    assert done.code == 2
    assert "is a folder" in done.err


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="root may read everything")
def test_unreadable_file(cqdd, tmp_path):
    path = tmp_path / "secret.toml"
    path.write_text(MINIMAL)
    path.chmod(0)
    done = cqdd("check", path)
    assert done.code == 2
    assert "Permission denied" in done.err


@pytest.mark.skipif(not os.path.exists("/proc/self/mem"), reason="needs Linux")
def test_file_that_refuses_to_be_read(cqdd):
    done = cqdd("check", "/proc/self/mem")
    assert done.code == 2
    assert "cannot read" in done.err


@pytest.mark.skipif(not os.path.exists("/dev/zero"), reason="needs a device without end")
def test_device_without_end(cqdd):
    done = cqdd("check", "/dev/zero", timeout=60.0)
    assert done.code == 2
    assert "it is a device" in done.err


@pytest.mark.skipif(os.name != "posix", reason="needs pipes")
def test_pipe_that_nobody_writes_to(cqdd, tmp_path):
    os.mkfifo(tmp_path / "pipe.toml")
    done = cqdd("check", "pipe.toml", timeout=60.0)
    assert done.code == 2
    assert "it is a pipe" in done.err


@pytest.mark.parametrize(
    "arguments",
    [
        ("check", "DESIGN"),
        ("size", "--ratio", "10", "--requirements", "DESIGN"),
        ("report", "paper", "--out", "PAGE"),
        ("torque", "evaluate", "--data", "DESIGN", "--model", "a.npz"),
    ],
)
def test_name_that_no_file_system_takes(cqdd, paper_design_file, arguments):
    names = {"DESIGN": 400 * "9", "PAGE": f"{400 * '9'}.html", "paper": paper_design_file}
    done = cqdd(*(names.get(word, word) for word in arguments), timeout=60.0)
    assert done.code == 2
    assert re.search(r"999(\.html)?: File name too long", done.err.replace("...", ""))


def test_force_replaces_no_pipe(cqdd, tmp_path, paper_design_file):
    os.mkfifo(tmp_path / "report.html")
    done = cqdd("report", paper_design_file, "--out", "report.html", "--force", timeout=60.0)
    assert done.code == 2
    assert "it is a pipe, which is never replaced" in done.err


def test_nothing_of_the_input_moves_the_terminal(cqdd, tmp_path):
    (tmp_path / "a.toml").write_text(MINIMAL + '"a\\u001b[2J" = 1\n')
    done = cqdd("check", "a.toml")
    assert done.code == 3
    assert "\x1b" not in done.err


@pytest.mark.parametrize("told", ["abc", "-1", "9" * 30])
def test_nonsense_date_in_the_environment(cqdd, paper_design_file, told):
    done = cqdd("check", paper_design_file, environment={"SOURCE_DATE_EPOCH": told})
    assert done.code == 2
    assert "SOURCE_DATE_EPOCH" in done.err
    assert done.out == ""


def test_binary_file(complaint):
    assert "is not a text file" in complaint(b"\x7fELF\x02\x01\x01\x00\xff\xfe" * 20)


def test_text_with_null_bytes(complaint):
    assert "is not valid TOML" in complaint(b"name = \x00\x00\x00")


@pytest.mark.parametrize("content", ["", "\n \n\t\n"])
def test_empty_file(complaint, content):
    assert "is empty; `cqdd-design size --ratio 10" in complaint(content)


@pytest.mark.parametrize("share", [0.3, 0.6, 0.95])
def test_half_written_file(complaint, share):
    text = complaint(MINIMAL[: int(share * len(MINIMAL))])
    assert "not valid TOML" in text or "is missing" in text


def test_huge_file(complaint):
    assert "is larger than 1 MB" in complaint("# padding\n" * 200_000)


def test_deeply_nested_file(complaint):
    assert "TOML" in complaint("a = " + "[" * 20_000)


def test_unknown_schema_version(complaint):
    assert "reads schema_version = 1" in complaint("schema_version = 7\n" + MINIMAL)


# Keys and values --------------------------------------------------------------------------------


def test_unknown_key_suggests_the_nearest(complaint):
    text = complaint(with_line("eccentricity", "eccentricty"))
    assert "reducer.eccentricty" in text
    assert "did you mean 'eccentricity'?" in text


def test_unknown_table(complaint):
    assert "did you mean 'reducer'" in complaint(MINIMAL.replace("[reducer]", "[reducers]"))


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ('output_pins]\nsleeve = "needle"', "needs a sleeve for the needles"),
        ('output_pins]\nsleeve_diameter = "3 mm"', "make it at least 5 mm"),
        ('output_pins]\nsleeve = "needle"\nsleeve_diameter = "6 mm"', "_diameter to 8 mm"),
        ('output_pins]\nsleeve = "ball"', "must be 'plain', 'needle' or 'drawn cup'"),
        ('ring]\nroller = "needle"', "needs a roller for the needles"),
        ('ring]\nroller_diameter = "9 mm"', 'make ring_type "pinwheel"'),
    ],
)
def test_sleeves_and_rollers_that_cannot_be(complaint, table, said):
    assert said in complaint(f"{MINIMAL}[reducer.{table}\n")


def test_a_roller_smaller_than_its_pin(complaint):
    text = MINIMAL + 'ring_type = "pinwheel"\n[reducer.ring]\nroller_diameter = "6 mm"\n'
    assert "ring.roller_diameter 6 mm does not go over the 7 mm pin" in complaint(text)


def test_missing_key(complaint):
    text = complaint(with_line('eccentricity = "1.6 mm"\n', ""))
    assert "reducer.eccentricity is missing" in text


def test_bare_number_shows_the_right_form(complaint):
    text = complaint(with_line('"1.6 mm"', "1.6"))
    assert 'write it like "1.6 mm"' in text


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ('peak_torque = "120 J"', "not a unit of torque"),
        ('peak_torque = "120 kg"', "not a unit of torque"),
        ('input_speed = "20 Hz"', "not a unit of speed"),
        ('input_speed = "20 m/s"', "not a unit of speed"),
        ('outer_diameter = "72 mn"', "is not a unit"),
        ('peak_torque = "plenty"', "has no number"),
        ('peak_torque = "nan N*m"', "has no number"),
        ('peak_torque = "1e999 N*m"', "not a finite torque"),
        ('peak_torque = "-5 N*m"', "the nearest allowed is 0.001 N*m"),
        ('motor = "CubeMars RO10 KV55"', "CubeMars RO100 KV55"),
        ('disc_material = "AISI 4140 QT 540"', "AISI 4140 Q&T 540C"),
        ("disc_count = 4", "the nearest allowed is 3"),
        ("disc_count = 2.5", "is not a whole number"),
        ("disc_count = true", "is not a whole number"),
    ],
)
def test_wrong_requirement(complaint, line, said):
    text = complaint(f"[requirements]\n{line}\n{MINIMAL}")
    assert said in text
    assert f"requirements.{line.split()[0]}" in text


@pytest.mark.parametrize(
    ("value", "said"),
    [("3", "nearest allowed is 4"), ("120", "nearest allowed is 119"), ("nan", "whole number")],
)
def test_wrong_ratio_in_a_file(complaint, value, said):
    text = complaint(with_line("ratio = 10", f"ratio = {value}"))
    assert said in text
    assert text.count("ratio = ") == 1, "one problem is told once"


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ('joint = "bolted"', "reducer.carrier.joint = 'bolted' must be 'clamped', 'hinged'"),
        ('joint = "columns"', "column_diameter 0 mm must be from 3 to 100 mm"),
        ('column_diameter = "6 mm"', 'choose joint = "columns"'),
        ('joint = "columns"\ncolumn_diameter = "2 mm"', "the nearest allowed is 3 mm"),
        ('joint = "columns"\ncolumn_diameter = "6"', 'write it like "6 mm"'),
        (
            'joint = "columns"\ncolumn_diameter = "4 mm"\ncolumn_count = 4',
            "carrier.column_count 4 must be a divisor of output_pins.count 6",
        ),
        (
            'joint = "columns"\ncolumn_diameter = "12 mm"\n[reducer.cam_bearing]\n'
            'designation = "6801"',
            "in the discs run into the output holes beside them; lower it",
        ),
        (
            'joint = "columns"\ncolumn_diameter = "4 mm"\n[reducer.output_pins]\n'
            'support = "cantilever"',
            'has no cap; set support = "both"',
        ),
    ],
)
def test_columns_that_do_not_fit(complaint, lines, said):
    assert said in complaint(f"{MINIMAL}[reducer.carrier]\n{lines}\n")


def test_all_problems_are_told_at_once(complaint):
    text = complaint(
        MINIMAL.replace('"1.6 mm"', "1.6").replace('"7 mm"', '"7 kg"') + "lobes = 10\n"
    )
    assert text.count("\n  - ") == 3


# Shapes that cannot exist -----------------------------------------------------------------------


def test_eccentricity_that_undercuts(complaint):
    text = complaint(MINIMAL.replace('"1.6 mm"', '"2.4 mm"').replace('"7 mm"', '"16 mm"'))
    assert "undercut" in text
    assert re.search(r"\d mm", text)


def test_eccentricity_past_the_cusp(complaint):
    assert "eccentricity" in complaint(with_line('"1.6 mm"', '"3.2 mm"'))


@pytest.mark.parametrize(
    ("command", "options"),
    [
        ("check", ""),
        ("analyse", ""),
        ("tolerance", ""),
        ("simulate", ""),
        ("bench", ""),
        ("compare", ""),
        ("inertia", ""),
        ("report", ""),
        ("export", "--to dxf"),
        ("export", "--to urdf,mjcf"),
        ("torque generate", "--out data"),
    ],
)
def test_no_bearing_is_chosen_for_a_disc_that_cannot_be(cqdd, tmp_path, command, options):
    (tmp_path / "cusp.toml").write_text(with_line('"1.6 mm"', '"3.2 mm"'))
    done = cqdd(*command.split(), "cusp.toml", *options.split(), timeout=60.0)
    assert done.code == 3
    assert "where the disc undercuts" in done.err
    assert [path.name for path in tmp_path.iterdir()] == ["cusp.toml"]


def test_holes_that_break_out(complaint):
    text = complaint(MINIMAL + '[reducer.output_pins]\ncircle_radius = "27 mm"\n')
    assert "hole" in text


def test_holes_that_overlap(complaint):
    text = complaint(
        MINIMAL + '[reducer.output_pins]\ncount = 12\ndiameter = "9 mm"\ncircle_radius = "18 mm"\n'
    )
    assert "hole" in text


def test_ring_teeth_that_overlap(complaint):
    complaint(MINIMAL.replace('"7 mm"', '"19 mm"').replace('"1.6 mm"', '"0.2 mm"'))


# Options ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "ratio", ["3", "10.5", "-10", "0", "1000", "nan", "abc", "inf", "-inf", ""]
)
def test_wrong_ratio(cqdd, tmp_path, ratio):
    done = cqdd("size", "--quick", "--ratio", ratio)
    assert done.code == 2
    assert len(done.err.strip().splitlines()) == 1
    assert f"--ratio {ratio}" in done.err
    assert "from 4 to 119" in done.err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("ratio", "nearest"),
    [("3", "4"), ("0", "4"), ("1000", "119"), ("-10", "10"), ("10.5", "10 and 11")],
)
def test_wrong_ratio_names_the_nearest(cqdd, ratio, nearest):
    assert re.search(
        rf"nearest (is|are) {nearest}\b", cqdd("size", "--quick", "--ratio", ratio).err
    )


def test_air_that_no_design_stands_in_is_refused_by_its_option(cqdd):
    done = cqdd("size", "--quick", "--ratio", "10", "--ambient", "250 degC")
    assert done.code == 2
    assert "--ambient: 250 degC is outside -60 degC to 90 degC" in done.err


@pytest.mark.parametrize("peak", ["30", "-1 N*m"])
def test_of_a_torque_that_is_refused_no_other_is_complained_of(cqdd, peak):
    done = cqdd("size", "--quick", "--ratio", "10", "--peak-torque", peak)
    assert done.code == 2
    assert peak in done.err
    assert "continuous" not in done.err


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("analyse", "--torque", "40"), 'write it like "40 N*m"'),
        (("analyse", "--torque", "40 J"), "not a unit of torque"),
        (("analyse", "--torque", "0 N*m"), "the nearest is 0.001 N*m"),
        (("analyse", "--speed", "-9 rpm"), 'not above zero; use "9 rpm"'),
        (("analyse", "--speed", "20 Hz"), "write rpm or rad/s"),
        (("analyse", "--angles", "2"), "--angles"),
        (("compare", "--teeth", "12,36,22"), "4 whole numbers"),
        (("compare", "--teeth", "12,36,22,x"), "4 whole numbers"),
        (("compare", "--module", "1"), 'write it like "1 mm"'),
        (("compare", "--material", "AISI 4140 QT"), "AISI 4140 Q&T"),
        (("export", "--to", "dfx"), "did you mean 'dxf'"),
        (("export", "--to", ","), "no kind of file is named"),
        (("inertia", "--speed", "fast"), "has no number"),
        (("check", "--torqe", "1 N*m"), "No such option"),
    ],
)
def test_wrong_option(cqdd, paper_design_file, arguments, said):
    command, *options = arguments
    done = cqdd(command, paper_design_file, *options)
    assert done.code == 2
    assert said in done.err
    assert done.out == ""


def test_wrong_quantity_of_size(cqdd):
    done = cqdd("size", "--quick", "--ratio", "10", "--peak-torque", "90")
    assert done.code == 2
    assert "--peak-torque" in done.err
    assert '"90 N*m"' in done.err


def test_command_that_does_not_exist(cqdd):
    done = cqdd("sise", "--ratio", "10")
    assert done.code == 2
    assert "size" in done.err


def test_missing_argument(cqdd):
    done = cqdd("check")
    assert done.code == 2
    assert "DESIGN" in done.err


def test_errors_are_documents_too(cqdd):
    done = cqdd("check", "nothing.toml", "--json")
    assert done.code == 2
    error = done.document["error"]
    assert error["code"] == 2
    assert error["kind"] == "UsageError"
    assert error["message"] in done.err
    assert done.document["command"] == "check"
    assert done.document["results"] is None


def test_usage_errors_are_documents_too(cqdd):
    done = cqdd("check", "--nonsense", "--json")
    assert done.code == 2
    assert json.loads(done.out)["error"]["code"] == 2


def test_debug_shows_the_traceback(cqdd):
    done = cqdd("check", "nothing.toml", "--debug")
    assert done.code == 2
    assert "Traceback" in done.err


def test_a_missing_example_is_told_how_it_is_written(cqdd):
    done = cqdd("check", "designs/printed-13.toml")
    assert done.code == 2
    told = " ".join(done.err.split())
    assert "there is no file designs/printed-13.toml; `cqdd-design new --example printed-13" in told


@pytest.mark.parametrize(
    ("option", "given", "said"),
    [
        ("--samples", "0", "a whole number from 1 to 10000000, not '0'; the nearest is 1 "),
        ("--samples", "x", "a whole number from 1 to 10000000, not 'x' "),
        ("--samples", "2.7", "a whole number from 1 to 10000000, not '2.7'; the nearest is 3 "),
        ("--samples", "1e9", "from 1 to 10000000, not '1e9'; the nearest is 10000000 "),
        ("--seed", "-1", "not '-1'; the nearest is 0 "),
    ],
)
def test_a_number_that_an_option_does_not_take(cqdd, paper_design_file, option, given, said):
    done = cqdd("tolerance", paper_design_file, option, given)
    assert done.code == 2
    assert done.err.startswith(f"cqdd-design: {option} takes ")
    assert said in done.err
