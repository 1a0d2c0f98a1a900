"""Places that cannot be written: one sentence, exit code 2, nothing half-written."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

COMMANDS = {
    "size": lambda design, out: ["size", "--quick", "--ratio", "10", "--out", out / "sized.toml"],
    "export": lambda design, out: ["export", design, "--to", "dxf", "--out", out],
    "report": lambda design, out: ["report", design, "--out", out / "report.html"],
}
#: A search takes seconds and a report many before they find that they cannot be written.
CHEAP_BY_DEFAULT = [
    "export",
    *(pytest.param(name, marks=pytest.mark.deep) for name in ("size", "report")),
]


def files_below(folder: Path) -> list[str]:
    return sorted(str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file())


@pytest.mark.parametrize("command", COMMANDS)
def test_a_file_stands_where_a_folder_is_needed(cqdd, tmp_path, paper_design_file, command):
    (tmp_path / "taken").write_text("a file")
    done = cqdd(*COMMANDS[command](paper_design_file, tmp_path / "taken"))
    assert done.code == 2
    assert "cannot write" in done.err
    assert "choose another" in done.err
    assert files_below(tmp_path) == ["taken"]
    assert (tmp_path / "taken").read_text() == "a file"


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="needs Linux")
@pytest.mark.parametrize("command", ["size", "export"])
def test_a_file_system_that_takes_no_files(cqdd, tmp_path, paper_design_file, command):
    done = cqdd(*COMMANDS[command](paper_design_file, Path("/proc/self")))
    assert done.code == 2
    assert "cannot write /proc/self" in done.err


@pytest.mark.skipif(
    not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write everywhere"
)
@pytest.mark.parametrize("command", COMMANDS)
def test_a_read_only_folder(cqdd, tmp_path, paper_design_file, command):
    locked = tmp_path / "locked"
    locked.mkdir(mode=0o555)
    done = cqdd(*COMMANDS[command](paper_design_file, locked))
    assert done.code == 2
    assert "the folder is not writable" in done.err
    assert files_below(tmp_path) == []


@pytest.mark.parametrize("command", CHEAP_BY_DEFAULT)
def test_a_disk_that_fills_up(tmp_path, paper_design_file, command):
    """A limit on the size of files stands in for the full disk: the write fails half-way."""
    design = paper_design_file
    resource = pytest.importorskip("resource")
    if command == "report":
        # Teeth that never touch and a motor without data: a page without ensembles and bench.
        text = design.read_text().replace('equidistant = "6 um"', 'equidistant = "400 um"')
        design = tmp_path / "loose.toml"
        design.write_text(text.replace("CubeMars RO100 KV55", "T-Motor MN1010 KV90"))
    arguments = COMMANDS[command](design, tmp_path / "out")
    done = subprocess.run(
        [sys.executable, "-m", "cqdd_design", *map(str, arguments)],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (300, 300)),
    )
    assert done.returncode == 2, done.stderr
    assert "cannot write" in done.stderr
    assert "Traceback" not in done.stderr
    assert files_below(tmp_path) == ([design.name] if command == "report" else [])


def test_export_replaces_a_named_folder_only_by_force(cqdd, tmp_path, paper_design_file):
    arguments = ["export", paper_design_file, "--to", "dxf", "--out", "mine"]
    assert cqdd(*arguments).code == 0
    before = {p.name: p.stat().st_mtime_ns for p in (tmp_path / "mine").iterdir()}
    refused = cqdd(*arguments)
    assert refused.code == 2
    assert "--force" in refused.err
    assert {p.name: p.stat().st_mtime_ns for p in (tmp_path / "mine").iterdir()} == before
    assert cqdd(*arguments, "--force").code == 0


def test_its_own_default_output_is_replaced(cqdd, paper_design_file):
    for _ in range(2):
        assert cqdd("export", paper_design_file, "--to", "dxf").code == 0


def test_files_are_called_after_the_file_and_not_by_the_name_within(
    cqdd, tmp_path, paper_design_file
):
    copy = tmp_path / "mine.toml"
    copy.write_bytes(Path(paper_design_file).read_bytes())
    done = cqdd("export", copy, "--to", "dxf,edm,bom,card")
    assert done.code == 0, done.err
    written = files_below(tmp_path)
    assert len(written) > 6
    assert all("cqdd-10" not in name for name in written)
    folder = tmp_path / "exports" / "mine"
    told = (folder / "edm" / "README.txt").read_text()
    assert "mine-disc.dxf" in told
    assert "cqdd-10" not in told
    assert (folder / "edm" / "mine-disc.dxf").is_file()
    assert (folder / "mine-bom.csv").is_file()


def test_what_is_replaced_is_said(cqdd, tmp_path, paper_design_file):
    words = ("export", paper_design_file, "--to", "bom")
    assert "in place of" not in cqdd(*words).out
    again = cqdd(*words)
    (line,) = (line for line in again.out.splitlines() if line.startswith("wrote "))
    assert line.endswith("bytes, in place of an older one)")
    words = ("size", "--quick", "--ratio", "10")
    assert "in place of" not in cqdd(*words).out
    assert "in place of an older one" in cqdd(*words).out
    words = ("new", "motor", "--force")
    assert "in place of" not in cqdd(*words).out
    assert "in place of an older one" in cqdd(*words).out
