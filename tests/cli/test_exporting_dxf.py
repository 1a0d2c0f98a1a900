"""``export`` as a process: files, exit codes, and what it does not import."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import ezdxf


def test_dxf_files_and_their_list(cqdd, paper_design_file, tmp_path):
    done = cqdd("export", paper_design_file, "--to", "dxf", "--json")
    assert done.code == 0
    files = done.document["files"]
    assert [Path(file["path"]).name for file in files] == ["cqdd-10-disc.dxf", "cqdd-10-ring.dxf"]
    for file in files:
        written = tmp_path / file["path"]
        assert written.stat().st_size == file["bytes"]
        assert not ezdxf.readfile(written).audit().errors
    assert not [path for path in (tmp_path / "exports").rglob(".*")]


def test_dxf_and_bom_do_not_import_cad(paper_design_file, tmp_path):
    done = subprocess.run(
        [
            *(sys.executable, "-X", "importtime", "-m", "cqdd_design"),
            *("export", str(paper_design_file), "--to", "dxf,svg,bom"),
        ],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(paper_design_file.parents[1])},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-2000:]
    imported = {line.rpartition("|")[2].strip() for line in done.stderr.splitlines()}
    assert "ezdxf" in imported
    assert not imported & {"cadquery", "OCP", "scipy", "trimesh", "vtkmodules", "matplotlib"}


def test_a_wire_that_cannot_cut_the_part_is_exit_4_and_leaves_nothing(
    cqdd, sharp_design_file, tmp_path
):
    done = cqdd("export", sharp_design_file, "--to", "dxf", "--out", "files")
    assert done.code == 4, done.err
    assert "choose a wire of at most" in done.err
    assert [path.name for path in tmp_path.iterdir()] == [sharp_design_file.name]


def test_a_folder_that_is_a_file(cqdd, paper_design_file, tmp_path):
    (tmp_path / "exports").write_text("mine")
    done = cqdd("export", paper_design_file, "--to", "dxf")
    assert done.code == 2
    assert "cannot write" in done.err
    assert (tmp_path / "exports").read_text() == "mine"


def test_a_named_folder_is_not_overwritten(cqdd, paper_design_file):
    arguments = ("export", paper_design_file, "--to", "svg", "--out", "files")
    assert cqdd(*arguments).code == 0
    again = cqdd(*arguments)
    assert again.code == 2
    assert "--force" in again.err
    assert cqdd(*arguments, "--force").code == 0
