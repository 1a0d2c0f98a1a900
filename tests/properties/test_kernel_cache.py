"""Spoilt files in the cache of compiled kernels: compiled anew, and said so."""

import subprocess
import sys

import pytest

RUN = """
from cqdd_design.gearbox.contact.laws_kernel import johnson_force
print(johnson_force(2e-5, 1e-6, 1e-7, 3e-5))
"""


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Run a small kernel in a process of its own, with a cache of its own."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    monkeypatch.setenv("PYTHONPATH", ":".join(sys.path))

    def process():
        return subprocess.run(
            [sys.executable, "-c", RUN], capture_output=True, text=True, check=False, timeout=300
        )

    return process


@pytest.mark.deep
def test_a_spoilt_kernel_is_compiled_anew(run, tmp_path):
    first = run()
    assert first.returncode == 0, first.stderr
    assert first.stderr == ""
    files = sorted(tmp_path.rglob("*johnson_force*"))
    assert {path.suffix for path in files} == {".nbi", ".nbc"}
    index, code = (next(p for p in files if p.suffix == kind) for kind in (".nbi", ".nbc"))
    for path, content in (
        (code, code.read_bytes()[:100]),
        (code, b""),
        (code, b"nonsense" * 100),
        (index, index.read_bytes()[:-20]),
        (index, b"nonsense" * 100),
    ):
        path.write_bytes(content)
        spoilt = run()
        assert spoilt.returncode == 0, spoilt.stderr
        assert spoilt.stdout == first.stdout
        assert "johnson_force" in spoilt.stderr
        assert "compiling it anew" in spoilt.stderr
        assert "Traceback" not in spoilt.stderr
    again = run()
    assert (again.stdout, again.stderr) == (first.stdout, "")
