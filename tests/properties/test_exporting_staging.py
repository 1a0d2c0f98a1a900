"""Staging folders: those of killed runs go, those of runs that live stay."""

import os
import subprocess
import sys

import pytest

from cqdd_design.errors import UsageError
from cqdd_design.exporting.staging import staging_folder

fcntl = pytest.importorskip("fcntl")

HOLD = """
import os, sys
from pathlib import Path
from cqdd_design.exporting.staging import staging_folder

with staging_folder(Path(sys.argv[1]), "arm") as staging:
    (staging / "half.dxf").write_text("half")
    print(staging, flush=True)
    sys.stdin.read()
"""


@pytest.fixture
def holder(tmp_path):
    """Another process in the middle of an export, and its staging folder."""
    process = subprocess.Popen(
        [sys.executable, "-c", HOLD, str(tmp_path)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    yield process, process.stdout.readline().strip()
    process.kill()
    process.communicate()


def test_what_a_killed_export_left_is_removed_by_the_next(holder, tmp_path):
    process, left = holder
    process.kill()
    process.wait()
    assert os.path.exists(left)
    with staging_folder(tmp_path, "arm") as staging:
        assert list(tmp_path.iterdir()) == [staging]
    assert list(tmp_path.iterdir()) == []


def test_an_export_leaves_those_beside_it_alone(holder, tmp_path):
    _, living = holder
    for other in (".arm-notes", ".leg-01234567", ".arm-0123456789"):
        (tmp_path / other).mkdir()
    (tmp_path / ".arm-89abcdef").write_text("a file")
    with staging_folder(tmp_path, "arm") as staging:
        assert staging.is_dir()
    assert os.path.exists(os.path.join(living, "half.dxf"))
    assert len(list(tmp_path.iterdir())) == 5


def test_an_error_names_the_target_and_leaves_nothing(tmp_path):
    with (
        pytest.raises(UsageError, match=r"cannot write .*/a\.dxf") as caught,
        staging_folder(tmp_path, "arm") as staging,
    ):
        raise UsageError(f"cannot write {staging / 'a.dxf'}")
    assert ".arm" not in str(caught.value)
    assert list(tmp_path.iterdir()) == []
