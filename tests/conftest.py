"""Fixtures shared by the tests: the command line as a real process, and the paper's design."""

from __future__ import annotations

import hashlib
import json
import math
import os
import pickle
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

# Modules and rewritten tests stay compiled, for every process of a run and for the next run,
# whatever the environment says: a thousand files would be compiled anew in each.
sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
# Workers share the cores already: threads of linear algebra would mostly wait for each other.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import cqdd_design  # noqa: E402

REPOSITORY = Path(__file__).resolve().parents[1]
PACKAGE = REPOSITORY / "cqdd_design"

#: Files that take longest, which the workers begin with: then they end together.
SLOW = (
    *("test_cli_docs", "test_cli_torque_docs", "test_machine_in_browser", "test_cli_json"),
    *("test_cli_verdict", "test_cli_duty", "test_sizing_comparison", "test_cli_friction"),
    *("test_cli_motor_file", "test_duty", "test_elastic_bodies", "test_sizing_verified"),
    *("test_sizing_requirements", "test_precision", "test_machine_view", "test_solids_clearances"),
    *("test_fuzz", "test_cli_simulate", "test_cli_tolerance", "test_solids_meshes"),
    *("test_torque_runtime", "test_cli_process", "test_exporting_dialects", "test_exporting_step"),
    *("test_cli_bench", "test_cli_size", "test_cli_bad_input", "test_torque_c_header"),
    *("test_sizing_screen", "test_geometry_ring", "test_report_bench", "test_cli_torque_data"),
)

#: Commands that write nothing, and those that write nothing outside the folder they run in.
READING = ("analyse", "bench", "catalog", "check", "compare", "explain", "inertia", "tolerance")
WRITING = ("export", "report", "simulate", "size")

# The same examples every time; `python -m tools.fuzz --properties` draws others.
settings.register_profile("steady", derandomize=True, deadline=None)
settings.register_profile("random", print_blob=True, deadline=None)
settings.load_profile("steady")


def pytest_configure(config: pytest.Config) -> None:
    """Tell `examples.py` how many examples a property test draws in this run."""
    os.environ["CQDD_TEST_DEPTH"] = "deep" if _is_deep(config) else "daily"
    config.option.loadscopereorder = False
    # One for all workers and processes of a run, and never the user's own.
    if "CQDD_DESIGN_CACHE" not in os.environ and (kept := _kept_cache(config)):
        os.environ["CQDD_DESIGN_CACHE"] = str(kept)
    for name in ("CQDD_DESIGN_CACHE", "CQDD_TEST_RUNS"):
        if name not in os.environ:
            folder = tempfile.mkdtemp(prefix="cqdd-cache-")
            os.environ[name] = folder
            config.add_cleanup(partial(shutil.rmtree, folder, ignore_errors=True))


def _kept_cache(config: pytest.Config) -> Path | None:
    """Meshes and gearboxes that this very package has worked in an earlier run.

    A byte of the package or a version of what it rests on that changed, and all is worked anew.
    """
    if not hasattr(config, "cache"):
        return None
    state = hashlib.sha256(sys.version.encode())
    for name in ("llvmlite", "numba", "numpy", "scikit-fem", "scipy"):
        state.update(f"{name} {version(name)}".encode())
    for path in sorted(PACKAGE.rglob("*")):
        if path.is_file() and path.suffix not in {".pyc", ".nbc", ".nbi"}:
            state.update(f"{path.relative_to(PACKAGE)}\0".encode() + path.read_bytes() + b"\0")
    folder = config.cache.mkdir("cqdd-design")
    now = folder / state.hexdigest()[:16]
    for other in folder.iterdir():
        if other != now:
            shutil.rmtree(other, ignore_errors=True)
    now.mkdir(exist_ok=True)
    return now


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Property tests belong to the deep run too, with more examples; slow files start first."""
    if _is_deep(config):
        for item in items:
            if getattr(getattr(item, "obj", None), "is_hypothesis_test", False):
                item.add_marker("deep")
    items.sort(key=lambda item: SLOW.index(item.path.stem) if item.path.stem in SLOW else len(SLOW))


def _is_deep(config: pytest.Config) -> bool:
    return config.option.markexpr == "deep"


@pytest.hookimpl(tryfirst=True)
def pytest_sessionstart(session: pytest.Session) -> None:
    """Compile the kernels once, on two cores, before workers start that would each compile them."""
    workers = getattr(session.config.option, "numprocesses", None)
    if not workers or session.config.option.collectonly:
        return
    kept = _kept_cache(session.config)
    if kept and (kept / "kernels").exists() and any(PACKAGE.rglob("*.nbi")):
        return
    script = Path(__file__).with_name("compile_kernels.py")
    done = []
    for together in (("elastic", "moving"), ("gearboxes",)):
        started = [
            subprocess.Popen([sys.executable, str(script), part], env=process_environment())
            for part in together
        ]
        # What does not compile here is told by the tests that need it.
        done += [one.wait() == 0 for one in started]
    if kept and all(done):
        (kept / "kernels").touch()


#: What passing tests recorded, by folder and file, in the order of the file; None where one failed.
_recorded: dict[str, list[tuple[str, Any]] | None] = {}


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    """Collect it; of workers too."""
    parts = Path(report.nodeid.partition("::")[0]).parts
    if len(parts) < 3 or parts[0] != "tests":
        return
    file = "/".join(parts[1:])
    rows = _recorded.setdefault(file, [])
    if report.failed:
        _recorded[file] = None
    elif rows is not None and report.when == "call":
        rows += report.user_properties


def pytest_sessionfinish(session: pytest.Session) -> None:
    """Leave what whole files recorded to docs/recorded.py, which would run them again for it."""
    chosen, config = session.config.option, session.config
    whole = not chosen.keyword and not any("::" in one for one in config.args)
    if hasattr(config, "workerinput") or not whole or session.shouldstop or session.shouldfail:
        return
    if chosen.markexpr == "not deep":
        known = {file: rows for file, rows in _recorded.items() if rows is not None}
        place = Path(os.environ["CQDD_TEST_RUNS"]) / "recorded.pickle"
        # An earlier run of the same process may have taken its folder away.
        if not place.parent.is_dir():
            return
        before = pickle.loads(place.read_bytes()) if place.exists() else {}
        place.write_bytes(pickle.dumps(before | known))


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Keep a file's tests on one worker: its costly fixtures are made once."""
    from xdist.scheduler import LoadFileScheduling

    return LoadFileScheduling(config, log)


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


class WarmProcesses:
    """Client of `warm_process.py`, which is started when the first process is asked for."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._server: subprocess.Popen[bytes] | None = None

    def run(
        self, arguments: list[str], folder: Path, environment: Mapping[str, str], timeout: float
    ) -> Finished:
        """Run the command line in a process forked from the server."""
        if self._server is None:
            self._start()
        out, err = self._folder / "out", self._folder / "err"
        request = {
            "arguments": arguments,
            "folder": str(folder),
            "environment": dict(environment),
            "out": str(out),
            "err": str(err),
        }
        self._socket.sendall(json.dumps(request).encode() + b"\n")
        process = int(self._answers.readline())
        self._socket.settimeout(timeout)
        try:
            code = int(self._answers.readline())
        except TimeoutError:
            os.killpg(process, signal.SIGKILL)
            self.stop()
            raise subprocess.TimeoutExpired(arguments, timeout) from None
        self._socket.settimeout(None)
        return Finished(code, out.read_text(encoding="utf-8"), err.read_text(encoding="utf-8"))

    def _start(self) -> None:
        door = self._folder / "door"
        door.unlink(missing_ok=True)
        self._server = subprocess.Popen(
            [sys.executable, str(Path(__file__).with_name("warm_process.py")), str(door)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            env=process_environment(),
        )
        self._socket = socket.socket(socket.AF_UNIX)
        while True:
            try:
                self._socket.connect(str(door))
                break
            except (FileNotFoundError, ConnectionRefusedError):
                assert self._server.poll() is None, "the server of warm processes has ended"
                time.sleep(0.02)
        self._answers = self._socket.makefile("r")

    def stop(self) -> None:
        """End the server; a later run starts another."""
        if self._server is not None:
            self._answers.close()
            self._socket.close()
            self._server.kill()
            self._server.wait()
            self._server = None


@pytest.fixture(scope="session")
def warm_processes() -> Iterator[WarmProcesses]:
    """One server for all tests of a worker."""
    with tempfile.TemporaryDirectory() as folder:  # short: a socket's path has 107 bytes
        server = WarmProcesses(Path(folder))
        yield server
        server.stop()


@pytest.fixture(scope="session")
def shared_runs() -> Path:
    """Folder of what commands told and wrote; all workers of a run have the same."""
    return Path(os.environ["CQDD_TEST_RUNS"])


@pytest.fixture
def cqdd(tmp_path: Path, shared_runs: Path, request: pytest.FixtureRequest) -> CommandLine:
    """Run ``cqdd-design`` with the given arguments as a process, in an empty folder.

    The process is forked from one that has its imports done, unless it gets an environment that
    imports depend on. What reads nothing but files of the repository is run once for all tests,
    which get its words and files (see `shared_runs`); asked for twice by one test, it is run again.
    Every run is held to a promise: no traceback reaches the terminal without ``--debug``.
    """
    asked: set[tuple[str, ...]] = set()

    def run(
        *arguments: str | Path,
        folder: Path = tmp_path,
        environment: Mapping[str, str] | None = None,
        timeout: float = 600.0,
    ) -> Finished:
        words, given = [str(one) for one in arguments], environment or {}
        told = None
        if not given and tuple(words) not in asked and folder == tmp_path:
            asked.add(tuple(words))
            if _repeats(words, folder):
                told = shared_runs / hashlib.sha256("\0".join(words).encode()).hexdigest()
                if told.is_dir():
                    return _recalled(told, folder)
        surroundings = {**process_environment(), **given}
        if hasattr(os, "fork") and not any(name.startswith(("PYTHON", "NUMBA")) for name in given):
            warm: WarmProcesses = request.getfixturevalue("warm_processes")
            done = warm.run(words, folder, surroundings, timeout)
        else:
            fresh = subprocess.run(
                [sys.executable, "-m", "cqdd_design", *words],
                cwd=folder,
                env=surroundings,
                capture_output=True,
                encoding="utf-8",
                timeout=timeout,
                check=False,
            )
            done = Finished(fresh.returncode, fresh.stdout, fresh.stderr)
        if "--debug" not in arguments:
            assert "Traceback" not in done.err, done.err
        if told is not None:
            _remember(told, done, folder if words[0] in WRITING else None)
        return done

    return run


def _repeats(words: list[str], folder: Path) -> bool:
    """Whether a command would do the same in other folders; what writes asks for an empty one."""
    if not words or words[0] not in READING + WRITING:
        return False
    paths = [Path(word) for word in words if os.sep in word]
    here = {one.name for one in folder.iterdir()}
    return all(one.is_relative_to(REPOSITORY) for one in paths) and (
        not here if words[0] in WRITING else here.isdisjoint(words) and "--out" not in words
    )


def _remember(told: Path, done: Finished, folder: Path | None) -> None:
    """Keep what a run said and wrote; where two workers ran it at once, what came first stays."""
    mine = told.with_suffix(f".{os.getpid()}")
    mine.mkdir()
    if folder is not None:
        shutil.copytree(folder, mine / "written", symlinks=True)
    said = json.dumps([done.code, done.out, done.err])
    (mine / "said.json").write_text(said, encoding="utf-8")
    try:
        mine.rename(told)
    except OSError:
        shutil.rmtree(mine)


def _recalled(told: Path, folder: Path) -> Finished:
    if (told / "written").is_dir():
        shutil.copytree(told / "written", folder, symlinks=True, dirs_exist_ok=True)
    return Finished(*json.loads((told / "said.json").read_text(encoding="utf-8")))


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
        record_property("validation", (quantity, against, _below(worst, bound), f"{bound:g}"))
        assert worst <= bound

    return check


def _below(worst: float, bound: float) -> str:
    """The next power of ten, because what rounding leaves differs from machine to machine.

    Never above the bound, which the difference has been shown to keep.
    """
    decade = 10.0 ** math.ceil(math.log10(max(worst, 1e-12)))
    return f"below {min(decade, bound):g}"
