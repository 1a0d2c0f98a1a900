"""One case: files, and a command line or a reader; and what must hold whatever it is."""

from __future__ import annotations

import contextlib
import json
import os
import resource
import shutil
import signal
import sys
import tempfile
import time
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

#: The promises: seconds of a processor, bytes resident, and the exit codes of docs/cli.md without
#: the bug's. A case that waits instead of working is ended by the clock on the wall.
LONGEST, MOST_MEMORY = 60.0, 1_000_000_000
_PATIENCE = 240.0
CODES = {0, 2, 3, 4, 5}
#: Memory that a case may ask for at all, so that a broken promise does not end the machine.
_ADDRESSES = 12_000_000_000


@dataclass(frozen=True)
class Case:
    """What to run.

    Attributes
    ----------
    files : mapping of str to bytes
        Relative to the folder that the case runs in.
    arguments : tuple of str
        Of the command line; empty where a reader is called instead.
    call : callable, optional
        Called in the folder; may raise errors of the package's own family only.
    environment : mapping
        Added to the environment.
    """

    files: Mapping[str, bytes] = field(default_factory=dict)
    arguments: tuple[str, ...] = ()
    call: Callable[[], object] | None = None
    environment: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Outcome:
    """How a case went: exit code, seconds, bytes resident at most, and the broken promises."""

    code: int
    seconds: float
    memory: int
    broken: tuple[str, ...]


def run(case: Case) -> Outcome:
    """Run a case in a process forked from this one, in a folder of its own."""
    with tempfile.TemporaryDirectory(prefix="cqdd-fuzz-") as name:
        folder = Path(name)
        work = folder / "work"
        work.mkdir()
        for place, content in case.files.items():
            (work / place).parent.mkdir(parents=True, exist_ok=True)
            (work / place).write_bytes(content)
        began = time.monotonic()
        process = os.fork()
        if process == 0:
            _become(case, folder)
        code, seconds, memory = _wait(process, began)
        out = (folder / "out").read_text("utf-8", "replace")
        err = (folder / "err").read_text("utf-8", "replace")
        broken = tuple(_broken(case, code, seconds, memory, out, err, work))
        shutil.rmtree(work, ignore_errors=True)
    return Outcome(code, seconds, memory, broken)


def _become(case: Case, folder: Path) -> None:
    """Run the case as this process, to its end."""
    code = 1
    try:
        os.setsid()
        resource.setrlimit(resource.RLIMIT_AS, (_ADDRESSES, _ADDRESSES))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_CPU, (int(LONGEST) + 5, int(LONGEST) + 6))
        os.chdir(folder / "work")
        os.environ.update({"TMPDIR": str(folder), **case.environment})
        tempfile.tempdir = None
        for number, name in ((1, "out"), (2, "err")):
            flags = os.O_WRONLY | os.O_CREAT | os.O_TRUNC
            os.dup2(os.open(folder / name, flags, 0o600), number)
        sys.stdout = os.fdopen(1, "w", encoding="utf-8", closefd=False)
        sys.stderr = os.fdopen(2, "w", encoding="utf-8", closefd=False)
        code = _called(case.call) if case.call is not None else _command(case.arguments)
        sys.stdout.flush()
        sys.stderr.flush()
    except BaseException:
        traceback.print_exc()
        sys.stderr.flush()
    finally:
        os._exit(code)


def _command(arguments: tuple[str, ...]) -> int:
    from cqdd_design.cli.main import run as run_command

    return run_command(arguments)


def _called(call: Callable[[], object]) -> int:
    from cqdd_design.errors import CqddError, printable

    try:
        call()
    except CqddError as error:
        print(printable(error.message), file=sys.stderr)
        return error.exit_code
    return 0


def _wait(process: int, began: float) -> tuple[int, float, int]:
    """Exit code (below 0: the signal), seconds and memory of a process, which is killed when late.

    Seconds are those of the processor, so that a busy machine breaks no promise; those of the
    clock where a case had to be ended.
    """
    pause = 0.002
    while True:
        ended, status, usage = os.wait4(process, os.WNOHANG)
        if ended:
            seconds = usage.ru_utime + usage.ru_stime
            return os.waitstatus_to_exitcode(status), seconds, usage.ru_maxrss * 1024
        if time.monotonic() - began > _PATIENCE:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process, signal.SIGKILL)
            _, status, usage = os.wait4(process, 0)
            return -signal.SIGKILL, time.monotonic() - began, usage.ru_maxrss * 1024
        time.sleep(pause)
        pause = min(2.0 * pause, 0.05)


def _broken(
    case: Case, code: int, seconds: float, memory: int, out: str, err: str, work: Path
) -> list[str]:
    found = []
    if code not in CODES:
        found.append(f"exit code {code}: {err.strip()[-600:]}")
    if "Traceback" in err or "this is a bug" in err:
        found.append(f"a traceback or a bug message: {err.strip()[-600:]}")
    if any(ord(c) < 32 and c not in "\n\t\r" for c in err):
        found.append(f"a control character on the terminal: {err!r:.300}")
    if seconds > LONGEST:
        found.append(f"{seconds:.0f} s")
    if memory > MOST_MEMORY:
        found.append(f"{memory / 1e6:.0f} MB")
    if code not in {0, 4} and not err.strip():
        found.append("an error without a sentence")
    if "--json" in case.arguments:
        found += _bad_json("standard output", out)
    if case.call is None:
        for path in work.rglob("*.json"):
            place = str(path.relative_to(work))
            if place not in case.files:
                found += _bad_json(place, path.read_text("utf-8", "replace"))
    return found


def _bad_json(place: str, text: str) -> list[str]:
    def refuse(word: str) -> None:
        raise ValueError(f"it holds {word}")

    try:
        json.loads(text, parse_constant=refuse)
    except ValueError as error:
        return [f"{place} is not one JSON document: {error}; it begins {text[:80]!r}"]
    return []
