"""`--project` and `--where`: outputs go into one folder, and the command line says into which."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

import cqdd_design
from cqdd_design import environment

PACKAGE = Path(cqdd_design.__file__).parent


@pytest.mark.parametrize("by", ["option", "variable"])
def test_outputs_go_into_the_project(cqdd, tmp_path, paper_design_file, by):
    """Default places follow; a design is read, and --out is meant, from where one is."""
    start = ["--project", "knee"] if by == "option" else []
    given = {} if start else {environment.PROJECT: "knee"}
    for words in (["new", "motor"], ["export", paper_design_file, "--to", "dxf"]):
        done = cqdd(*start, *words, environment=given)
        assert done.code == 0, done.err
        assert f"wrote {Path('knee')}" in done.out
    done = cqdd(*start, "new", "duty", "--out", "duty.csv", environment=given)
    assert done.code == 0, done.err
    written = {one.relative_to(tmp_path).parts[0] for one in tmp_path.rglob("*") if one.is_file()}
    assert written == {"knee", "duty.csv"}
    assert (tmp_path / "knee" / "motor.toml").is_file()
    assert list((tmp_path / "knee" / "exports" / "cqdd-10").glob("*.dxf"))


def test_an_option_goes_before_the_variable(cqdd, tmp_path):
    done = cqdd("--project", "hip", "new", "motor", environment={environment.PROJECT: "knee"})
    assert done.code == 0
    assert [one.name for one in tmp_path.iterdir()] == ["hip"]


def test_where_tells_every_folder(cqdd, tmp_path):
    """In the order of options that people type them, and with a cache of one's own."""
    cache = str(tmp_path / "kept")
    for words in (["--project", "knee", "--where"], ["--where", "--project", "knee"]):
        done = cqdd(*words, environment={"CQDD_DESIGN_CACHE": cache})
        assert done.code == 0, done.err
        for name in environment.OUTPUTS:
            place = re.search(rf"^{name} +(/.*)$", done.out, re.M)
            assert place
            assert Path(place[1]) == tmp_path / "knee" / name
        assert cache in done.out
        assert re.search(r"^kernels +/.*$", done.out, re.M)
    assert list(tmp_path.iterdir()) == [], "to tell is not to make"


def test_where_tells_a_program_too(cqdd, tmp_path):
    before, after = ["--json", "--where"], ["--where", "--json"]
    told = [
        {
            one["name"]: one["folder"]
            for one in cqdd("--project", "knee", *words).document["results"]["places"]
        }
        for words in (before, after)
    ]
    assert told[0] == told[1]
    assert {name: told[0][name] for name in environment.OUTPUTS} == {
        name: str(tmp_path / "knee" / name) for name in environment.OUTPUTS
    }
    assert set(told[0]) == {*environment.OUTPUTS, "kept results", "kernels"}
    # Before a command it would ask for nothing.
    done = cqdd("--json", "catalog", "motors")
    assert done.code == 2
    assert "write it after the command" in done.document["error"]["message"]


def test_default_places_stand_once():
    """A folder's name joined by hand would not follow the project."""
    for path in PACKAGE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "Path" and node.args:
                told = getattr(node.args[0], "value", None)
                assert told not in environment.OUTPUTS, f"{path}: {told}"
