"""The commands of docs/torque-estimation.md, one after the other as a reader would type them."""

from __future__ import annotations

import re
import shlex
import shutil
from pathlib import Path

import pytest

pytest.importorskip("torch")
REPOSITORY = Path(__file__).resolve().parents[2]


@pytest.mark.deep
def test_every_command_shown_runs(cqdd, tmp_path):
    text = (REPOSITORY / "docs" / "torque-estimation.md").read_text(encoding="utf-8")
    shown = "".join(re.findall(r"^```console\n(.*?)^```$", text, flags=re.MULTILINE | re.DOTALL))
    commands = [line[2:] for line in shown.splitlines() if line.startswith("$ ")]
    assert [shlex.split(command)[2] for command in commands] == [
        "generate",
        "train",
        "evaluate",
        "export",
    ]
    shutil.copytree(REPOSITORY / "designs", tmp_path / "designs")
    for command in commands:
        program, *arguments = shlex.split(command)
        assert program == "cqdd-design"
        done = cqdd(*arguments, timeout=600)
        assert done.code == 0, f"{command}\n{done.err}"
    assert (tmp_path / "exports" / "first.npz").exists()
    assert list((tmp_path / "exports" / "first").glob("*.h"))
    assert list((tmp_path / "exports" / "first").glob("*.onnx"))
