"""What shells offer after TAB, asked for as their scripts ask."""

import os
import subprocess
import sys

import pytest

from cqdd_design import catalog
from cqdd_design.cli import completion
from cqdd_design.cli.check_names import CHECKS
from cqdd_design.design import templates
from cqdd_design.gearbox.checks.guide import CHECK_GUIDE

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


def test_kinds_templates_and_examples_are_offered(offered) -> None:
    assert offered("bash", "export", "knee.toml", "--to", "d").split() == ["dxf"]
    assert offered("bash", "export", "knee.toml", "--to", "dxf,st").split() == [
        "dxf,step",
        "dxf,stl",
    ]
    assert offered("bash", "new", "d").split() == ["design", "duty"]
    assert offered("bash", "new", "--example", "cq").split() == ["cqdd-10"]


def test_zsh_is_offered_names_as_they_are(offered) -> None:
    assert "AISI 4140" in offered("zsh", "catalog", "aisi")
    assert "knee.toml" in offered("zsh", "analyse", "kn")


def test_names_are_those_of_catalogue_and_guide(monkeypatch) -> None:
    monkeypatch.delenv("_CQDD_DESIGN_COMPLETE", raising=False)
    assert tuple(CHECK_GUIDE) == CHECKS
    assert completion.motors("") == list(catalog.motors())
    assert completion.templates("") == list(templates.TEMPLATES)
    assert completion.examples("") == list(templates.examples())
    for name in (*catalog.materials(), *catalog.motors()):
        assert name in completion.catalogued(name)
