"""new: templates that load as they stand, examples that an installed package has."""

import re
import tomllib
from pathlib import Path

import pytest

from cqdd_design.design import (
    Design,
    Requirements,
    load_design,
    load_requirements,
    requirements_from_mapping,
)
from cqdd_design.design.motor import MotorData, MotorFile, read_motor
from cqdd_design.design.tables import dump
from cqdd_design.design.templates import TEMPLATES, example_text, examples
from cqdd_design.machine import resolve

DESIGNS = Path(__file__).resolve().parents[2] / "designs"
ALTERNATIVES = {"based_on", "speed_constant", "rotor_mass", "stator_mass"}
"""Keys of a motor that stand for others which the template gives."""


@pytest.mark.parametrize("kind", TEMPLATES)
def test_every_kind_is_written_and_nothing_is_overwritten(cqdd, tmp_path, kind):
    done = cqdd("new", kind, "--json")
    assert done.code == 0, done.err
    (written,) = done.document["files"]
    path = tmp_path / TEMPLATES[kind].file
    assert Path(written["path"]).name == path.name
    text = path.read_text()
    path.write_text("mine")
    again = cqdd("new", kind)
    assert again.code == 2
    assert "--force" in again.err
    assert path.read_text() == "mine"
    assert cqdd("new", kind, "--force").code == 0
    assert path.read_text() == text
    assert cqdd("new", kind, "--out", f"elsewhere{path.suffix}").code == 0
    assert (tmp_path / f"elsewhere{path.suffix}").read_text() == text


def test_the_design_template_is_a_design(cqdd, tmp_path):
    assert cqdd("new", "design").code == 0
    path = tmp_path / "design.toml"
    design = load_design(path)
    text = path.read_text()
    # Every key of a design is there; with all comments taken off it is the same design.
    opened = re.sub(r"^# (?=[a-z_]+ = )", "", text, flags=re.MULTILINE)
    for line in re.findall(r"^# ([a-z_]+ = .*)$", text, re.MULTILINE):
        tomllib.loads(line)
    defaults = tomllib.loads(opened)
    asked = defaults["requirements"]
    for key in set(asked) - set(dump(Requirements.model_validate({"ratio": 10}))):
        del asked[key]  # no default: asked for only where it is stated
    # Without them the play is that of the drawn fits.
    del defaults["reducer"]["output_pins"]["sleeve_play"]
    del defaults["reducer"]["ring"]["roller_play"]
    assert Design.from_mapping(defaults).sha256 == design.sha256
    for key in design.dotted_keys():
        assert re.search(rf"^(# )?{key.rpartition('.')[2]} = ", text, re.MULTILINE), key
    checks = {one.id: one.status for one in resolve(design).analysis.checks}
    assert "fail" not in checks.values()


def test_the_motor_template_is_a_motor(cqdd, tmp_path):
    assert cqdd("new", "motor").code == 0
    path = tmp_path / "motor.toml"
    motor = read_motor(path)
    assert motor.stands_alone
    row = load_design(DESIGNS / "reference-s.toml").with_motor(motor=motor).motor_row
    assert row.name == "my motor"
    assert row.missing == ()
    text = path.read_text()
    for key in MotorData.model_fields:
        (line,) = re.findall(rf"^(?:# )?({key} = \S.*?) +# \S", text, re.MULTILINE)
        if key not in ALTERNATIVES:
            MotorFile.from_mapping({**tomllib.loads(text), **tomllib.loads(line)})
    for key in ALTERNATIVES - {"rotor_mass", "stator_mass"}:
        (line,) = re.findall(rf"^# ({key} = \S.*?) +# \S", text, re.MULTILINE)
        assert MotorFile.from_mapping(tomllib.loads(line)).base or key != "based_on"


def test_the_requirements_template_is_sized(cqdd, tmp_path):
    assert cqdd("new", "requirements").code == 0
    path = tmp_path / "requirements.toml"
    assert load_requirements(path) == Requirements.model_validate({"ratio": 10})
    keys = {field.alias or key for key, field in Requirements.model_fields.items()}
    for line in re.findall(r"^# ([a-z_]+ = .*)$", path.read_text(), re.MULTILINE):
        ((key, value),) = tomllib.loads(line).items()
        keys.remove(key)
        if not key.startswith("duty_"):  # these name a file
            requirements_from_mapping({"ratio": 10, key: value})
    assert keys == {"ratio"}


@pytest.mark.parametrize("name", examples())
def test_an_example_is_the_committed_design(cqdd, tmp_path, name):
    """The package has a copy, because an installed one has no `designs/`: never another one."""
    assert example_text(name) == (DESIGNS / f"{name}.toml").read_text(encoding="utf-8")
    assert cqdd("new", "--example", name).code == 0
    written = tmp_path / f"{name}.toml"
    assert written.read_bytes() == (DESIGNS / f"{name}.toml").read_bytes()
    assert load_design(written).name == load_design(DESIGNS / f"{name}.toml").name


def test_every_committed_design_is_an_example():
    assert set(examples()) == {path.stem for path in DESIGNS.glob("*.toml")}


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["new"], "cqdd-design new --example cqdd-10"),
        (["new", "design", "--example", "cqdd-10"], "one of design, duty, motor, requirements"),
        (["new", "gearbox"], "there is no template 'gearbox'; there are design, duty, motor"),
        (["new", "--example", "cqdd10"], "the nearest is cqdd-10"),
        (["new", "motor", "--out", "."], "folder"),
    ],
)
def test_what_cannot_be_written_is_said(cqdd, words, says):
    done = cqdd(*words)
    assert done.code == 2
    assert says in done.err
