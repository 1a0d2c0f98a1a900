"""CAD files from real processes: complete, the same bytes twice, and nothing half-written."""

from __future__ import annotations

import importlib.util
import os
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("cadquery") is None, reason="cadquery is not installed"
)

KINDS = "step,stl,3mf,glb"


@pytest.mark.deep
def test_two_runs_give_the_same_bytes(cqdd, paper_design_file, tmp_path):
    runs = []
    for name in ("one", "two"):
        done = cqdd("export", paper_design_file, "--to", KINDS, "--out", tmp_path / name, "--json")
        assert done.code == 0, done.err
        files = done.document["files"]
        runs.append({Path(one["path"]).name: one["sha256"] for one in files})
        assert {one["kind"] for one in files} == set(KINDS.split(","))
        assert {path.name for path in (tmp_path / name).iterdir()} == set(runs[-1])
    assert runs[0] == runs[1]
    assert {"cqdd-10.step", "cqdd-10-disc.step", "cqdd-10.3mf", "cqdd-10.glb"} <= set(runs[0])


def test_without_the_system_library_the_message_gives_the_apt_line(
    cqdd, paper_design_file, repository, tmp_path
):
    """A package of the same name that fails as the real one does without libGL."""
    broken = tmp_path / "broken" / "cadquery"
    broken.mkdir(parents=True)
    (broken / "__init__.py").write_text(
        "raise ImportError('libGL.so.1: cannot open shared object file: "
        "No such file or directory')\n"
    )
    out = tmp_path / "out"
    path = os.pathsep.join([str(broken.parent), str(repository)])
    done = cqdd(
        *("export", paper_design_file, "--to", "dxf,step", "--out", out),
        environment={"PYTHONPATH": path},
    )
    assert done.code == 5
    assert "apt-get install -y libgl1" in done.err
    assert not out.exists()
    light = cqdd(
        *("export", paper_design_file, "--to", "dxf,bom", "--out", out),
        environment={"PYTHONPATH": path},
    )
    assert light.code == 0, light.err
