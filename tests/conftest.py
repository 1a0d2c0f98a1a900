"""Fixtures shared by the tests: the command line as a real process, and the paper's design."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

import cqdd_design

REPOSITORY = Path(__file__).resolve().parents[1]


@dataclass(frozen=True)
class Finished:
    """A process that has ended."""

    code: int
    out: str
    err: str

    @property
    def document(self) -> dict[str, Any]:
        """The one JSON document on standard output."""
        loaded: dict[str, Any] = json.loads(self.out)
        return loaded


CommandLine = Callable[..., Finished]


@pytest.fixture
def cqdd(tmp_path: Path) -> CommandLine:
    """Run ``cqdd-design`` with the given arguments as a process, in an empty folder.

    Every run is held to a promise: no traceback reaches the terminal without ``--debug``.
    """

    def run(
        *arguments: str | Path,
        folder: Path = tmp_path,
        environment: Mapping[str, str] | None = None,
        timeout: float = 400.0,
    ) -> Finished:
        done = subprocess.run(
            [sys.executable, "-m", "cqdd_design", *map(str, arguments)],
            cwd=folder,
            env={**process_environment(), **(environment or {})},
            capture_output=True,
            encoding="utf-8",
            timeout=timeout,
            check=False,
        )
        if "--debug" not in arguments:
            assert "Traceback" not in done.stderr, done.stderr
        return Finished(done.returncode, done.stdout, done.stderr)

    return run


@pytest.fixture
def in_two_processes(
    paper_design_file: Path, tmp_path: Path
) -> Callable[[str], tuple[Finished, Finished]]:
    """Run code in two processes that hash differently, on the paper's design and a folder each.

    The code finds the design's path and the folder's in ``sys.argv``.
    """

    def run(code: str, seed: str) -> Finished:
        done = subprocess.run(
            [sys.executable, "-c", code, str(paper_design_file), str(tmp_path / seed)],
            env={**process_environment(), "PYTHONHASHSEED": seed},
            capture_output=True,
            encoding="utf-8",
            check=False,
        )
        assert done.returncode == 0, done.stderr
        return Finished(done.returncode, done.stdout, done.stderr)

    return lambda code: (run(code, "1"), run(code, "2"))


def process_environment() -> dict[str, str]:
    """The environment of a child process that must find the same package as this one."""
    package = str(Path(cqdd_design.__file__).resolve().parents[1])
    inherited = os.environ.get("PYTHONPATH", "")
    path = os.pathsep.join(part for part in (package, inherited) if part)
    return {**os.environ, "PYTHONPATH": path, "PYTHONIOENCODING": "utf-8"}


@pytest.fixture(scope="session")
def repository() -> Path:
    """The root of the repository."""
    return REPOSITORY


@pytest.fixture(scope="session")
def paper_design_file() -> Path:
    """The design file of the paper's actuator."""
    return REPOSITORY / "designs" / "cqdd-10.toml"


Record = Callable[[str, object], None]


@pytest.fixture
def validated(record_property: Record) -> Callable[[str, str, float, float], None]:
    """Assert that a difference is within its bound, and record both for the documentation."""

    def check(quantity: str, against: str, worst: float, bound: float) -> None:
        record_property("validation", (quantity, against, _below(worst), f"{bound:g}"))
        assert worst <= bound

    return check


def _below(worst: float) -> str:
    """The next power of ten, because what rounding leaves differs from machine to machine."""
    return f"below {10.0 ** math.ceil(math.log10(max(worst, 1e-12))):.0g}"
