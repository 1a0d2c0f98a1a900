"""The JSON documents: one envelope for every command, finite numbers, reproducible."""

import json
import math

import pytest

KEYS = [
    "schema_version",
    "command",
    "design",
    "assumed",
    "results",
    "checks",
    "warnings",
    "files",
    "provenance",
]
CHECK_KEYS = {"id", "title", "value", "limit", "unit", "margin", "status", "source"}


def numbers(value):
    if isinstance(value, dict):
        for item in value.values():
            yield from numbers(item)
    elif isinstance(value, list):
        for item in value:
            yield from numbers(item)
    elif isinstance(value, float):
        yield value


ON_DESIGN = [
    ("check",),
    ("analyse", "--torque", "40 N*m", "--angles", "24"),
    ("compare",),
    pytest.param(("inertia",), marks=pytest.mark.deep),
    ("export", "--to", "dxf"),
]
OTHERS = [("catalog",), ("catalog", "6902"), ("schema",), ("explain",), ("explain", "BEARING-LIFE")]


@pytest.mark.parametrize("arguments", ON_DESIGN + OTHERS, ids=" ".join)
def test_one_document_with_the_envelope(cqdd, paper_design_file, arguments):
    command, *options = arguments
    on_design = arguments not in OTHERS
    done = cqdd(command, *([paper_design_file] if on_design else []), *options, "--json")
    assert done.code == (4 if command == "check" else 0), done.err
    assert_envelope(done.document, command, on_design)


def assert_envelope(document, command, on_design):
    assert list(document) == KEYS
    assert document["schema_version"] == 1
    assert document["command"] == command
    assert all(math.isfinite(value) for value in numbers(document))
    assert document["provenance"]["version"]
    if on_design:
        assert document["design"]["reducer"]["eccentricity"] == "1.6 mm"
        assert "reducer.ring.relief_clearance" in document["assumed"]
        assert len(document["provenance"]["design_sha256"]) == 64
    else:
        assert document["design"] is None
    for check in document["checks"]:
        assert set(check) >= CHECK_KEYS
        assert check["status"] in {"pass", "warn", "fail"}
    for file in document["files"]:
        assert set(file) == {"path", "kind", "bytes", "sha256"}


@pytest.mark.deep
def test_a_report_replaces_its_own_page_and_shows_the_motor_of_the_file(
    cqdd, tmp_path, paper_design_file
):
    page = tmp_path / "reports" / "cqdd-10.html"
    page.parent.mkdir()
    page.write_text("of yesterday")
    motor = tmp_path / "motor.toml"
    motor.write_text(
        'name = "rewound"\nmass = "0.9 kg"\nrotor_inertia = "2e-4 kg*m^2"\n'
        'peak_torque = "13 N*m"\nrated_torque = "5 N*m"\n'
    )
    done = cqdd("report", paper_design_file, "--motor-file", motor, "--json")
    assert done.code == 0, done.err
    assert_envelope(done.document, "report", True)
    text = page.read_text()
    assert len(text) > 1e5
    assert "rewound, ring of magnets" in text
    assert "file: motor.toml, over the catalogue" in text
    assert "rewound of motor.toml" in text


@pytest.mark.deep
def test_the_time_is_that_of_the_environment(cqdd, paper_design_file):
    fixed = {"SOURCE_DATE_EPOCH": "1700000000"}
    first = cqdd("check", paper_design_file, "--json", environment=fixed)
    now = cqdd("check", paper_design_file, "--json")
    told, time = "2023-11-14T22:13:20Z", now.document["provenance"]["time"]
    assert first.document["provenance"]["time"] == told != time
    assert first.out == now.out.replace(time, told)


def test_quiet_prints_nothing(cqdd, paper_design_file):
    done = cqdd("export", paper_design_file, "--to", "dxf", "--quiet")
    assert (done.code, done.out, done.err) == (0, "", "")


def test_quiet_still_tells_errors(cqdd):
    done = cqdd("check", "nothing.toml", "--quiet")
    assert done.code == 2
    assert "there is no file" in done.err


def test_narration_is_on_stderr(cqdd, paper_design_file):
    done = cqdd("export", paper_design_file, "--to", "dxf", "--json")
    assert "writing dxf" in done.err
    assert len(done.document["files"]) == 2


def test_help_and_version(cqdd):
    shown = cqdd("--help")
    assert shown.code == 0
    assert cqdd().out == shown.out
    for command in ("size", "check", "analyse", "compare", "inertia", "export", "report"):
        assert f"  {command} " in shown.out
    assert cqdd("--version").out.startswith("cqdd-design 0.")


def test_check_says_what_would_make_it_pass(cqdd, paper_design_file):
    done = cqdd("check", paper_design_file)
    assert done.code == 4
    assert "CONTACT-RING-PEAK" in done.out
    assert "lower the continuous torque to" in done.out
    assert "designation to 'THK RA6008'" in " ".join(done.out.split())
    assert "does NOT meet its requirements" in done.out.splitlines()[-1]


@pytest.mark.deep
def test_analyse_torque_moves_loads_and_not_checks(cqdd, paper_design_file):
    few = ("--angles", "24", "--json")
    peak = cqdd("analyse", paper_design_file, *few).document
    less = cqdd("analyse", paper_design_file, "--torque", "60 N*m", *few).document
    key = "ring_force_max_N"
    assert less["results"]["rigid"][key] == pytest.approx(0.5 * peak["results"]["rigid"][key])
    assert less["checks"] == peak["checks"]


@pytest.mark.deep
def test_analyse_speed_moves_the_life(cqdd, paper_design_file):
    few = ("--angles", "24", "--json")
    slow = cqdd("analyse", paper_design_file, "--speed", "643 rpm", *few).document
    full = cqdd("analyse", paper_design_file, *few).document
    hours = [d["results"]["bearings"]["cam"]["L10h"] for d in (slow, full)]
    assert hours[0] == pytest.approx(2.0 * hours[1])


@pytest.mark.deep
def test_analyse_angles_are_the_points_of_the_curves(cqdd, paper_design_file):
    done = cqdd("analyse", paper_design_file, "--angles", "24", "--json").document
    assert len(done["results"]["rigid_series"]["crank_angle_deg"]) == 24


def test_numbers_that_do_not_exist_are_null_with_a_warning():
    from cqdd_design.library.envelope import json_ready

    told = []
    assert json_ready({"a": [1.0, math.nan]}, "results", told) == {"a": [1.0, None]}
    assert told == ["results.a[1] does not exist for this design (it came out as nan)."]
    assert json.dumps(json_ready({"b": math.inf}, "results", told), allow_nan=False)
