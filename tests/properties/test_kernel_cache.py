"""The cache of compiled kernels: spoilt files and kernels of other code are compiled anew."""

import os
import shutil
import subprocess
import sys
from pathlib import Path
from types import FunctionType

import numpy as np
import pytest

import cqdd_design.files
from cqdd_design.actuator.kernels.stepping import run_sets
from cqdd_design.files.kernel_stamp import kernel_stamp

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


NOWHERE = """
from numba.core import caching
caching.CacheImpl._locator_classes = [caching.UserProvidedCacheLocator]
"""


def test_where_no_folder_can_be_written_kernels_are_kept_for_one_run(tmp_path, monkeypatch):
    """As for a user without a home, of a package that another user installed."""
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setenv("PYTHONPATH", ":".join(sys.path))
    done = subprocess.run(
        [sys.executable, "-c", NOWHERE + RUN], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("(1.52")
    assert "set NUMBA_CACHE_DIR" in done.stderr
    assert not list(tmp_path.iterdir())


VALUES = """
from typing import NamedTuple
FACTOR = 2.0
class Pair(NamedTuple):
    first: float
    second: float
"""
CALLED = """
from cqdd_design.files.kernel_cache import numba
@numba.njit(cache=True, inline="always")
def less(x, pair):
    return x * pair.first - pair.second
"""
KERNEL = """
from cqdd_design.files.kernel_cache import numba
from cqdd_design.called import less
from cqdd_design.values import FACTOR, Pair
@numba.njit(cache=True)
def kernel(x, pair):
    return FACTOR * less(x, pair)
if __name__ == "cqdd_design.kernel":
    print(kernel(3.0, Pair(5.0, 1.0)), sum(kernel.stats.cache_hits.values()))
"""


@pytest.mark.deep
def test_a_kernel_of_other_code_is_compiled_anew(tmp_path, monkeypatch):
    """A constant, a function and the order of fields in other files, times of files as they were.

    The kernel's own file never changes, which is all that numba looks at.
    """
    package = tmp_path / "cqdd_design"
    (package / "files").mkdir(parents=True)
    for name in ("__init__.py", "files/__init__.py"):
        (package / name).touch()
    for name in ("kernel_cache.py", "kernel_stamp.py"):
        shutil.copy(Path(cqdd_design.files.__file__).parent / name, package / "files" / name)
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setenv("PYTHONDONTWRITEBYTECODE", "1")

    def told(**files):
        for name, text in files.items():
            path = package / f"{name}.py"
            path.write_text(text)
            os.utime(path, (1e9, 1e9))
        done = subprocess.run(
            [sys.executable, "-c", "import cqdd_design.kernel"],
            capture_output=True, text=True, check=True, timeout=300, cwd=tmp_path,
        )  # fmt: skip
        value, hits = done.stdout.split()
        return float(value), int(hits) > 0

    assert told(values=VALUES, called=CALLED, kernel=KERNEL) == (28.0, False)
    assert told() == (28.0, True)
    assert told(values="# what they are\n" + VALUES) == (28.0, True)
    assert told(values=VALUES.replace("2.0", "3.0")) == (42.0, False)
    assert told(called=CALLED.replace("-", "+")) == (48.0, False)
    turned = VALUES.replace("first", "x").replace("second", "first").replace("x:", "second:")
    assert told(values=turned) == (2.0 * (3.0 * 1.0 + 5.0), False)
    assert told() == (16.0, True)


def made(text, **around):
    space = {"__name__": "cqdd_design.made", **around}
    exec(compile(text, "made", "exec"), space)
    return space["f"]


def test_a_stamp_is_of_what_is_compiled_and_of_nothing_else():
    plain = kernel_stamp(made("def f(x):\n    return A * x + 1.0\n", A=2.0))
    told = 'def f(x):\n    "Twice."\n\n    # and one\n    return A * x + 1.0\n'
    assert kernel_stamp(made(told, A=2.0)) == plain
    assert kernel_stamp(made("def f(x):\n    return A * x + 1.5\n", A=2.0)) != plain
    assert kernel_stamp(made("def f(x):\n    return A * x + 1.0\n", A=2.5)) != plain
    assert kernel_stamp(made("def f(x):\n    return A * x - 1.0\n", A=2.0)) != plain
    table = "def f(x):\n    return A[x]\n"
    first, second = (kernel_stamp(made(table, A=np.array([1.0, k]))) for k in (2.0, 3.0))
    assert first != second


def test_a_stamp_is_the_same_in_every_process():
    """Of the largest kernel: sets have another order there, and objects another place."""
    assert isinstance(run_sets.py_func, FunctionType)
    code = (
        "from cqdd_design.actuator.kernels.stepping import run_sets\n"
        "from cqdd_design.files.kernel_stamp import kernel_stamp\n"
        "print(kernel_stamp(run_sets.py_func))"
    )
    told = [
        subprocess.run(
            [sys.executable, "-c", code],
            capture_output=True, text=True, check=True, timeout=300,
            env={**os.environ, "PYTHONPATH": ":".join(sys.path), "PYTHONHASHSEED": seed},
        ).stdout.strip()
        for seed in ("1", "2")
    ]  # fmt: skip
    assert told == [kernel_stamp(run_sets.py_func)] * 2
