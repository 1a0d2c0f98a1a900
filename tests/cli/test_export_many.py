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


def test_no_design_replaces_another(folder: Path, cqdd) -> None:  # type: ignore[no-untyped-def]
    """Two of one file name would be written to one folder, and both be reported."""
    (folder / "other").mkdir()
    (folder / "other" / "one.toml").write_bytes((folder / "one.toml").read_bytes())
    files = [str(folder / "one.toml"), str(folder / "other" / "one.toml")]
    done = cqdd("export", *files, "--to", "dxf", "--out", str(folder / "out"))
    assert done.code == 2
    assert "would both be exported as 'one'" in done.err
    assert not (folder / "out").exists()


def test_warnings_and_files_are_those_of_every_design(folder: Path, cqdd) -> None:  # type: ignore[no-untyped-def]
    files = [str(folder / f"{name}.toml") for name in ("one", "two")]
    alone = cqdd("export", files[0], "--to", "urdf", "--out", str(folder / "a"), "--json")
    (told,) = [one for one in json.loads(alone.out)["warnings"] if "effort limit" in one]
    done = cqdd("export", *files, "--to", "urdf", "--out", str(folder / "b"), "--json")
    both = json.loads(done.out)
    assert f"{files[0]}: {told}" in both["warnings"]
    assert sum("effort limit" in one for one in both["warnings"]) == 2
    assert {Path(one["path"]).name for one in both["files"]} == {"one.urdf", "two.urdf"}


def test_a_file_name_with_signs_is_its_own(folder: Path, cqdd) -> None:  # type: ignore[no-untyped-def]
    """Never that of the `name` within, whose files it would replace."""
    odd = folder / "10:1 <b>.toml"
    odd.write_bytes((folder / "one.toml").read_bytes())
    done = cqdd("export", str(odd), "--to", "dxf", "--out", str(folder / "out"))
    assert done.code == 0
    written = {path.name for path in (folder / "out").rglob("*.dxf")}
    assert written == {"10_1 _b_-disc.dxf", "10_1 _b_-ring.dxf"}


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
