"""What shells offer after TAB, asked for as their scripts ask."""

import os
import re
import shlex
import subprocess
import sys

import pytest
import typer

from cqdd_design import catalog
from cqdd_design.actuator.bench import METRICS
from cqdd_design.actuator.bench.unknowns import UNKNOWNS
from cqdd_design.cli import completion, known_names, main
from cqdd_design.cli.check_names import CHECKS
from cqdd_design.design import templates
from cqdd_design.gearbox.checks.guide import CHECK_GUIDE
from cqdd_design.planetary.iso6336.influence import MESH_LOAD_TABLES
from cqdd_design.torque.data.splits import PROTOCOLS
from cqdd_design.torque.networks.modules import MODELS

ASK = """
import sys
from cqdd_design.cli.main import run
try:
    run([])
finally:
    heavy = [name for name in ("numpy", "pint") if name in sys.modules]
    assert not heavy, heavy
"""


@pytest.fixture
def offered(tmp_path):
    """Lines that a shell gets for a command line whose last word is being typed."""
    (tmp_path / "joints").mkdir()
    for name in ("knee.toml", "joints/hip.toml", "notes.txt"):
        (tmp_path / name).touch()

    def ask(shell, *words):
        line = " ".join(("cqdd-design", *words))
        environment = {
            **os.environ,
            "_CQDD_DESIGN_COMPLETE": f"complete_{shell}",
            "COMP_WORDS": line,
            "COMP_CWORD": str(len(words)),
            "_TYPER_COMPLETE_ARGS": line,
        }
        done = subprocess.run(
            [sys.executable, "-W", "error::DeprecationWarning", "-c", ASK],
            env=environment, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=60,
        )  # fmt: skip
        assert "Error" not in done.stderr, done.stderr
        return done.stdout

    return ask


def test_bash_is_offered_commands_designs_and_names(offered) -> None:
    assert offered("bash", "ana").split() == ["analyse"]
    assert offered("bash", "check", "").split() == ["joints/", "knee.toml"]
    assert offered("bash", "check", "joints/").split() == ["joints/hip.toml"]
    assert "RING-STRESS" in offered("bash", "explain", "ring").split()
    motors = offered("bash", "size", "--motor", "cube").splitlines()
    assert r"CubeMars\ RO100\ KV55" in motors


def test_bash_can_run_what_it_is_offered(offered) -> None:
    """Signs that bash reads as its own are escaped, but for within quotes, where nothing is."""
    compare = "compare", "knee.toml", "--material"
    for begun, steel in (("AISI\\ 4140\\ Q", "AISI 4140 Q&T 540C"), ("POM", "POM (acetal)")):
        lines = offered("bash", *compare, begun).splitlines()
        assert [steel] in [shlex.split(line) for line in lines]
        assert not any(re.search(r"(?<!\\)[&() ]", line) for line in lines)
    for mark in "\"'":
        assert "AISI 4140 Q&T 540C" in offered("bash", *compare, f"{mark}AISI").splitlines()
    assert r"POM\ \(acetal\)" in offered("bash", *compare[:2], "'closed'", "--material", "POM")


def test_kinds_templates_and_examples_are_offered(offered) -> None:
    assert offered("bash", "export", "knee.toml", "--to", "d").split() == ["dxf"]
    assert offered("bash", "export", "knee.toml", "--to", "dxf,st").split() == [
        "dxf,step",
        "dxf,stl",
    ]
    assert offered("bash", "export", "knee.toml", "--to", "step,st").split() == ["step,stl"]
    assert offered("bash", "new", "d").split() == ["design", "duty"]
    assert offered("bash", "new", "--example", "cq").split() == ["cqdd-10"]


@pytest.mark.parametrize(
    ("words", "found"),
    [
        (("report", "knee.toml", "--format", ""), "html pdf"),
        (("export", "knee.toml", "--step-schema", ""), "AP214 AP242"),
        (("export", "knee.toml", "--dxf-version", "r1"), "R12"),
        (("export", "kn"), "knee.toml"),
        (("size", "--export", "bo"), "bom"),
        (("size", "--motor", "an"), "any"),
        (("bench", "knee.toml", "--only", "mass,back"), "mass,backlash"),
        (("calibrate", "knee.toml", "--unknowns", "fr"), "friction_load"),
        (("simulate", "knee.toml", "--load", "p"), "pendulum"),
        (("compare", "knee.toml", "--material-quality", "MQ"), "MQ"),
        (("torque", "train", "--model", "phase"), "phase-gru"),
        (("torque", "export", "a.npz", "--to", "onnx,"), "onnx,c"),
    ],
)
def test_choices_are_offered(offered, words, found) -> None:
    assert set(found.split()) <= set(offered("bash", *words).split())


def _closed(command):
    """Options of a command whose help tells all that they can be, and how they complete."""
    for one in command.params:
        names = (one.metavar or "").split("|")
        if one.param_type_name == "option" and len(names) > 1:
            yield one, names


def test_every_option_that_lists_its_choices_completes_them(monkeypatch) -> None:
    monkeypatch.delenv("_CQDD_DESIGN_COMPLETE", raising=False)
    app = typer.main.get_command(main.app)
    commands = {**app.commands, **app.commands["torque"].commands}
    seen = 0
    for name, command in commands.items():
        for one, names in _closed(command):
            context = typer.Context(command, info_name=name)
            offers = [str(item.value) for item in one.shell_complete(context, "")]
            assert offers == names, (name, one.name)
            seen += 1
    assert seen >= 9


def test_zsh_is_offered_names_as_they_are(offered) -> None:
    assert "AISI 4140" in offered("zsh", "catalog", "aisi")
    assert "knee.toml" in offered("zsh", "analyse", "kn")


def test_names_are_those_of_catalogue_and_guide(monkeypatch) -> None:
    monkeypatch.delenv("_CQDD_DESIGN_COMPLETE", raising=False)
    assert tuple(CHECK_GUIDE) == CHECKS
    assert completion.motors("") == list(catalog.motors())
    assert completion.templates("") == list(templates.TEMPLATES)
    assert completion.examples("") == list(templates.examples())
    assert completion.geared_actuators("")
    for name in completion.geared_actuators(""):
        assert catalog.find_motor(name).torque_at == "output"
    assert tuple(METRICS) == known_names.MEASUREMENTS
    assert tuple(UNKNOWNS) == known_names.UNKNOWNS
    assert tuple(MODELS) == known_names.ESTIMATED
    assert tuple(PROTOCOLS) == known_names.SETS
    assert tuple(MESH_LOAD_TABLES) == known_names.LOADS_BY_PLANETS
    for name in (*catalog.materials(), *catalog.motors()):
        assert name in completion.catalogued(name)
