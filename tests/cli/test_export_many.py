"""Several designs in processes of their own: all are written, and a crash is one design's."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from cqdd_design.exporting.many import COMMAND, export_many

CRASHING = """
import os, runpy, signal, sys
if any(word.endswith("crash.toml") for word in sys.argv):
    os.kill(os.getpid(), signal.SIGSEGV)
sys.argv[0] = "cqdd-design"
runpy.run_module("cqdd_design", run_name="__main__")
"""


@pytest.fixture
def folder(tmp_path: Path, repository: Path) -> Path:
    text = (repository / "designs" / "cqdd-10.toml").read_text(encoding="utf-8")
    for name in ("one", "two", "crash", "broken"):
        own = text.replace('name = "cqdd-10"', f'name = "{name}"', 1)
        if name == "broken":
            own = own.replace('eccentricity = "1.6 mm"', 'eccentricity = "2.9 mm"', 1)
        (tmp_path / f"{name}.toml").write_text(own, encoding="utf-8")
    return tmp_path


@pytest.mark.deep
def test_a_crash_is_that_designs_failure(folder: Path) -> None:
    wrapper = folder / "wrapper.py"
    wrapper.write_text(CRASHING, encoding="utf-8")
    told: list[tuple[int, int]] = []
    names = ("one", "crash", "broken", "two")
    found = export_many(
        [folder / f"{name}.toml" for name in names],
        ["--to", "edm"],
        folder / "files",
        workers=2,
        progress=lambda *done: told.append(done),
        command=[sys.executable, str(wrapper)],
    )
    by_name = dict(zip(names, found, strict=True))
    assert [one.exit_code for one in found] == [0, 1, 3, 0]
    assert "SIGSEGV" in by_name["crash"].error
    assert "eccentricity" in by_name["broken"].error
    assert told == [(1, 4), (2, 4), (3, 4), (4, 4)]
    assert sorted(path.name for path in (folder / "files").iterdir()) == ["one", "two"]
    for name in ("one", "two"):
        written = sorted(path.name for path in (folder / "files" / name / "edm").glob("*.dxf"))
        assert written == [f"{name}-disc.dxf", f"{name}-ring.dxf"]
        assert len(by_name[name].files) == len(list((folder / "files" / name / "edm").iterdir()))


def test_the_command_line_takes_several_designs(folder: Path, cqdd) -> None:  # type: ignore[no-untyped-def]
    files = [str(folder / f"{name}.toml") for name in ("one", "two", "broken")]
    done = cqdd("export", *files, "--to", "dxf", "--out", str(folder / "out"), "--json")
    assert done.code == 3
    results = json.loads(done.out)["results"]
    assert [one["exit_code"] for one in results["designs"]] == [0, 0, 3]
    assert "broken.toml" in done.err
    assert (folder / "out" / "one" / "one-disc.dxf").exists()
    assert not (folder / "out" / "broken").exists()


def test_options_travel(folder: Path, cqdd) -> None:  # type: ignore[no-untyped-def]
    files = [str(folder / f"{name}.toml") for name in ("one", "two")]
    options = ("--dxf-version", "R12", "--tab-length", "2 mm", "--workers", "1")
    done = cqdd("export", *files, "--to", "dxf,gcode", "--out", str(folder / "o"), *options)
    assert done.code == 0
    for name in ("one", "two"):
        assert "AC1009" in (folder / "o" / name / f"{name}-disc.dxf").read_text(encoding="utf-8")
        assert "TAB OF 2.000 MM" in (folder / "o" / name / "edm" / f"{name}-disc.nc").read_text()


def test_command_starts_this_python() -> None:
    assert COMMAND[0] == sys.executable
