"""catalog, schema, doctor and explain."""

import json
import re
import tomllib
from pathlib import Path

import jsonschema
import pytest

from cqdd_design.environment import EXTRAS

REPOSITORY = Path(__file__).resolve().parents[2]

MINIMAL = {
    "ratio": 10,
    "ring_pitch_radius": "32 mm",
    "eccentricity": "1.6 mm",
    "ring_pin_diameter": "7 mm",
}


# catalog ----------------------------------------------------------------------------------------


def test_catalog_without_a_name_lists_the_catalogues(cqdd):
    done = cqdd("catalog")
    assert done.code == 0
    for kind in ("materials", "motors", "bearings", "screws", "fits"):
        assert kind in done.out


@pytest.mark.parametrize("words", [["6902"], ["show", "6902"], ["bearings", "6902"]])
def test_catalog_shows_a_row(cqdd, words):
    done = cqdd("catalog", *words)
    assert done.code == 0
    assert re.search(r"static rating +2250 N\n", done.out)
    assert "KOYO" in done.out


@pytest.mark.parametrize(
    ("kind", "row"),
    [
        ("materials", "AISI 4140 Q&T 540C"),
        ("motors", "CubeMars RO100 KV55"),
        ("bearings", "6902"),
        ("screws", "metric 4 mm M3"),
        ("fits", "f9 3-6 mm"),
        ("circlips", "DIN 472 - 65 x 2.5"),
        ("nuts", "KM 10"),
    ],
)
def test_catalog_lists_every_row_with_its_source(cqdd, kind, row):
    rows = cqdd("catalog", "list", kind, "--json").document["results"]["rows"]
    assert row in rows
    assert all(values["source"] for values in rows.values())
    assert row in cqdd("catalog", kind).out


def test_catalog_units_are_in_the_names(cqdd):
    row = cqdd("catalog", "aisi 4140  q&t 540c", "--json").document["results"]["rows"]
    assert row["AISI 4140 Q&T 540C"]["yield_strength_MPa"] == 834.0


def test_catalog_tells_a_hole_from_a_shaft(cqdd):
    assert "H7 " in cqdd("catalog", "H7").out
    assert "h7 " in cqdd("catalog", "h7").out


@pytest.mark.parametrize(
    ("name", "nearest"),
    [("690", "6900"), ("RO100 KV56", "RO100 KV55"), ("bearing list", "bearings")],
)
def test_catalog_near_miss(cqdd, name, nearest):
    done = cqdd("catalog", name)
    assert done.code == 2
    assert nearest in done.err


# schema -----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def schema():
    from cqdd_design.design.schema import design_schema

    return design_schema()


def test_schema_command_prints_the_committed_file(cqdd, repository):
    done = cqdd("schema")
    assert done.code == 0
    assert done.out == (repository / "docs" / "design.schema.json").read_text(encoding="utf-8")


def test_schema_is_a_schema(schema):
    jsonschema.Draft202012Validator.check_schema(schema)


def test_every_design_of_the_repository_is_valid(schema, repository):
    files = sorted((repository / "designs").glob("*.toml"))
    assert files
    for path in files:
        jsonschema.validate(tomllib.loads(path.read_text()), schema)


@pytest.mark.parametrize(
    "design",
    [
        {"reducer": MINIMAL},
        {"reducer": MINIMAL, "requirements": {"peak_torque": "1e2 N*m"}},
        {"reducer": {**MINIMAL, "output_pins": {"count": 8}, "ring": {}}},
    ],
)
def test_what_the_toolkit_reads_the_schema_allows(schema, design):
    from cqdd_design.design import Design

    Design.from_mapping(design)
    jsonschema.validate(design, schema)


@pytest.mark.parametrize(
    "design",
    [
        {},
        {"reducer": {**MINIMAL, "eccentricity": 1.6}},
        {"reducer": {**MINIMAL, "ratio": 3}},
        {"reducer": {**MINIMAL, "eccentricty": "1.6 mm"}},
        {"reducer": {key: value for key, value in MINIMAL.items() if key != "ratio"}},
        {"reducer": MINIMAL, "motors": {}},
    ],
)
def test_what_the_schema_forbids_the_toolkit_refuses(schema, design):
    from cqdd_design.design import Design
    from cqdd_design.errors import DesignError

    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(design, schema)
    with pytest.raises(DesignError):
        Design.from_mapping(design)


def test_schema_tells_units_bounds_and_defaults(schema):
    voltage = schema["$defs"]["MotorTable"]["properties"]["voltage"]
    assert voltage["default"] == "48 V"
    assert "from 1 V to 1000 V" in voltage["description"]
    assert (
        "9 N*m times the ratio"
        in (schema["$defs"]["Requirements"]["properties"]["peak_torque"]["description"])
    )
    assert "CubeMars RO100 KV55" in schema["$defs"]["MotorTable"]["properties"]["name"]["examples"]


# doctor -----------------------------------------------------------------------------------------


def test_doctor_finds_what_is_installed(cqdd):
    done = cqdd("doctor", "--json")
    assert done.code == 0, done.err
    found = {row["name"]: row for row in done.document["results"]["findings"]}
    for name in ("Python", "cadquery", "numpy", "libGL.so.1", "libX11.so.6", "exports/"):
        assert found[name]["state"] == "ok", found[name]
    assert found["browser"]["state"] in {"ok", "optional"}


def test_doctor_names_a_place_for_kernels_and_results(monkeypatch, tmp_path):
    from cqdd_design import environment
    from cqdd_design.files import kernel_cache
    from cqdd_design.roads.places import kept_places

    monkeypatch.setenv("CQDD_DESIGN_CACHE", str(tmp_path / "kept"))
    here = {one.name: one for one in kept_places()}
    assert here["compiled kernels"].state == here["kept results"].state == "ok"
    assert kernel_cache.KEPT_IN in here["compiled kernels"].detail
    monkeypatch.setattr(kernel_cache, "KEPT_IN", "")
    monkeypatch.setenv("CQDD_DESIGN_CACHE", "/proc/none")
    monkeypatch.setattr(environment.os, "access", lambda *_: False)
    none = {one.name: one for one in kept_places()}
    assert none["compiled kernels"].state == none["kept results"].state == "optional"
    assert "NUMBA_CACHE_DIR" in none["compiled kernels"].detail
    assert "CQDD_DESIGN_CACHE" in none["kept results"].detail


def test_doctor_says_each_thing_once(cqdd):
    """Extras repeat each other's packages; people get one line a thing, and no echo on stderr."""
    done = cqdd("doctor", "--json")
    names = [row["name"] for row in done.document["results"]["findings"]]
    assert len(names) == len(set(names)) > 20
    told = cqdd("doctor")
    assert told.err == ""
    shown = [
        re.split(r"  +", line)[1] for line in told.out.splitlines() if re.match(r"\w+  ", line)
    ]
    brought = {
        row["name"]
        for row in done.document["results"]["findings"]
        if row["state"] == "optional" and "for the extra" in row["detail"]
    }
    assert sorted(set(shown) - set(EXTRAS)) == sorted(set(names) - brought)
    assert len(shown) == len(set(shown))
    assert all(re.search(rf"[ ,]{re.escape(name)}(,|\n)", told.out) for name in brought)


def test_doctor_tells_packages_of_an_extra_together(capsys):
    """Forty lines of packages for tests hid the one that matters."""
    from cqdd_design.cli.doctor import _rows
    from cqdd_design.environment import Finding

    found = [
        Finding("numpy", "ok", "2.0"),
        Finding("torch", "optional", "is not installed", "torque"),
        Finding("onnx", "optional", "is not installed", "torque"),
    ]
    assert list(_rows(found)) == [
        ["ok", "numpy", "2.0"],
        [
            "optional",
            "torque",
            "for torque networks: pip install 'cqdd-design[torque]' brings torch, onnx",
        ],
    ]


def test_every_extra_says_what_it_is_for():
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert set(EXTRAS) == set(project["optional-dependencies"])


def test_doctor_takes_the_strictest_of_several_wishes():
    from cqdd_design.environment import _each_once, _Wanted

    wishes = [_Wanted("a", "1.9", "torque"), _Wanted("a", "1.10", ""), _Wanted("b", "2", "dev")]
    assert _each_once(wishes) == [_Wanted("a", "1.10", ""), _Wanted("b", "2", "dev")]
    assert _each_once(reversed(wishes))[1] == _Wanted("a", "1.10", "")
    # Who runs no tests is told of the smaller extra.
    mujoco = [_Wanted("mujoco", "4.0", "dev"), _Wanted("mujoco", "4.0", "sim")]
    assert _each_once(mujoco) == _each_once(mujoco[::-1]) == [_Wanted("mujoco", "4.0", "sim")]


def test_doctor_names_what_is_missing(monkeypatch, tmp_path):
    from cqdd_design import environment

    monkeypatch.setattr(environment, "SYSTEM_LIBRARIES", {"libNothing.so.7": "libnothing"})
    monkeypatch.setattr(
        environment, "_wanted", lambda: [environment._Wanted("no-such-package", "1.0", "")]
    )
    monkeypatch.setattr(environment.shutil, "which", lambda name: None)
    found = {row.name: row for row in environment.examine(tmp_path)}
    assert found["libNothing.so.7"].state == "missing"
    assert "apt-get install -y libgl1" in found["libNothing.so.7"].detail
    assert found["no-such-package"].state == "missing"
    assert "pip install 'no-such-package>=1.0'" in found["no-such-package"].detail
    assert found["browser"].state == "optional"


def test_doctor_ends_with_5_when_something_is_missing(monkeypatch, capsys):
    from cqdd_design import environment
    from cqdd_design.cli.doctor import doctor

    class Silent:
        as_json = False

        def say(self, *lines): ...
        def warn(self, *sentences): ...
        def document(self, results): ...

    missing = environment.Finding("libGL.so.1", "missing", "run apt-get")
    monkeypatch.setattr(environment, "examine", lambda folder: [missing])
    assert doctor(Silent()) == 5


def test_doctor_finds_a_folder_that_cannot_be_written(tmp_path):
    from cqdd_design import environment

    (tmp_path / "exports").write_text("a file where the folder should be")
    found = {row.name: row for row in environment.examine(tmp_path)}
    assert found["exports/"].state == "missing"
    assert found["reports/"].state == "ok"


def test_package_versions_are_compared_as_numbers():
    from cqdd_design.environment import _package, _Wanted

    assert _package(_Wanted("numpy", "1.9", "")).state == "ok"
    assert _package(_Wanted("numpy", "999.0", "")).state == "missing"
    assert _package(_Wanted("numpy", "999.0", "torque")).state == "optional"


# explain ----------------------------------------------------------------------------------------


def test_explain_lists_every_check_a_design_gets(cqdd, paper_design_file):
    listed = cqdd("explain", "--json").document["results"]["checks"]
    given = cqdd("check", paper_design_file, "--json").document["checks"]
    assert {check["id"] for check in given} <= set(listed)


def test_explain_tells_rule_reason_and_source(cqdd):
    done = cqdd("explain", "bearing-life")
    assert done.code == 0
    for said in ("BEARING-LIFE", "L10h", "ISO 281"):
        assert said in done.out


def test_explain_tells_where_a_violation_only_warns(cqdd):
    told = " ".join(cqdd("explain", "SPACE-DIAMETER").out.split())
    assert "`check`; only a warning where requirements.outer_diameter is not stated" in told


def test_explain_near_miss(cqdd):
    done = cqdd("explain", "CONTACT-RNG-PEAK")
    assert done.code == 2
    assert "did you mean 'CONTACT-RING-PEAK'" in done.err


def test_explain_knows_every_id(cqdd):
    from cqdd_design.gearbox import CHECK_GUIDE

    document = json.loads(cqdd("explain", "--json").out)
    assert list(document["results"]["checks"]) == list(CHECK_GUIDE)
