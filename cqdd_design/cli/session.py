"""What every command shares: its common options and where it prints.

Only this module writes to standard output. Whatever else a process prints there, CAD kernels in
C++ included, is sent to standard error, so that ``--json`` gives exactly one document.
"""

from __future__ import annotations

import contextlib
import functools
import inspect
import itertools
import os
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any, Protocol, TextIO

import typer

from cqdd_design.cli import interruption
from cqdd_design.cli.colour import WARNING, coloured, is_coloured, with_coloured_start
from cqdd_design.cli.fitting import on_screen
from cqdd_design.cli.progress import Bar
from cqdd_design.environment import source_date
from cqdd_design.errors import UsageError, printable

if TYPE_CHECKING:
    from pathlib import Path

    from cqdd_design.actuator.specimen import Specimen
    from cqdd_design.cli.stage_times import StageTimes
    from cqdd_design.design import Design
    from cqdd_design.files import WrittenFile
    from cqdd_design.results import Check

INTERRUPTED_WITH_RESULTS = -130
"""Returned by a command that was interrupted and has told what was done by then: exit code 130."""

_COMMON: dict[str, Any] = {
    "as_json": Annotated[
        bool, typer.Option("--json", help="Print one JSON document on stdout, all else on stderr.")
    ],
    "quiet": Annotated[
        bool, typer.Option("--quiet", help="Print nothing but errors (and JSON with --json).")
    ],
    "debug": Annotated[bool, typer.Option("--debug", help="Show the traceback of an error.")],
}

_LINES_WITHOUT_TERMINAL = 10
"""Of progress in a log, where a bar cannot move."""


class Tell(Protocol):
    """Tells which stage begins, and how many seconds are left where the caller knows."""

    def __call__(self, text: str, left: float | None = None) -> None:
        """Tell it."""


def command(function: Callable[..., int | None], name: str = "") -> Callable[..., int | None]:
    """Turn ``f(out, ...)`` into a Typer command with ``--json``, ``--quiet`` and ``--debug``.

    The function gets an `Output` first and returns its exit code, or None for 0. Its name is that
    of the command, unless another is given.
    """
    called = name or function.__name__
    own = list(inspect.signature(function, eval_str=True).parameters.values())[1:]
    common = [
        inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=False, annotation=kind)
        for name, kind in _COMMON.items()
    ]

    def run(*, as_json: bool, quiet: bool, debug: bool, **given: Any) -> int | None:
        # `debug` is read by `main` from the raw arguments: an error may come before parsing.
        out = Output(called, as_json=as_json, quiet=quiet)
        source_date()  # a wrong one is told before the work, not after it
        try:
            return function(out, **given)
        finally:
            out.end_progress()

    run.__name__ = function.__name__
    run.__doc__ = function.__doc__
    run.__signature__ = inspect.Signature(  # type: ignore[attr-defined]
        [p.replace(kind=inspect.Parameter.KEYWORD_ONLY) for p in own] + common
    )
    return run


@functools.lru_cache(maxsize=1)
def standard_output() -> TextIO:
    """The process's standard output, kept for results; descriptor 1 becomes standard error."""
    try:
        kept = os.dup(1)
    except OSError:  # closed by the caller: nobody reads the result
        return open(os.devnull, "w")
    with contextlib.suppress(OSError):
        os.dup2(2, 1)
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    return open(kept, "w", encoding=encoding, errors="backslashreplace")


def print_result(text: str) -> None:
    """Print on standard output; a reader that has gone away ends no command.

    ``cqdd-design check d.toml | head -1`` must keep the exit code of the check.
    """
    stream = standard_output()
    try:
        stream.write(text + "\n")
        stream.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())  # for the flush at exit
        raise UsageError(f"cannot write to standard output: {error.strerror}.") from error


class Output:
    """Where one command prints.

    Attributes
    ----------
    command : str
        Name of the command, for the envelope.
    as_json, quiet : bool
        The common options.
    warnings : list of str
        Sentences told so far; part of the envelope.
    """

    def __init__(self, command: str, *, as_json: bool, quiet: bool) -> None:
        self.command = command
        self.as_json = as_json
        self.quiet = quiet
        self.warnings: list[str] = []
        self._bar: Bar | None = None
        self._times: StageTimes | None = None
        standard_output()

    def say(self, *lines: str) -> None:
        """Print a part of the result for people."""
        if not (self.as_json or self.quiet):
            self.end_progress(done=True)
            text = "\n".join(lines)
            print_result(coloured(text) if is_coloured(standard_output()) else text)

    def warn(self, *sentences: str) -> None:
        """Tell warnings on stderr and keep them for the envelope."""
        self.warnings += sentences
        for sentence in sentences:
            self.note(f"{WARNING} {sentence}")

    def note(self, sentence: str) -> None:
        """Narrate on stderr."""
        if not self.quiet:
            self.end_progress()
            told = printable(sentence)
            if told.startswith(WARNING):
                told = on_screen(told, sys.stderr)
            told = with_coloured_start(told, WARNING, sys.stderr)
            print(told, file=sys.stderr, flush=True)

    def compile_ahead(
        self,
        design: Design | None = None,
        *,
        simulation: bool = False,
        ensembles: bool = False,
        sizing: bool = False,
    ) -> None:
        """On the first run after installation, compile what the command will call, and tell so.

        What of a design's analysis needs none of it is done meanwhile.
        """
        from cqdd_design.roads.kernels import compile_kernels, missing

        kernels = missing(simulation=simulation, ensembles=ensembles, sizing=sizing)
        if kernels:
            self.note("compiling on this first use; what is kept of it is not compiled again")
            compile_kernels(kernels, self.counting("kernels compiled", alike=False), design)
            self.end_progress(done=True)
            self._bar = None

    def stages(self, total: int) -> Tell:
        """A function that tells, on stderr, which of about `total` stages of work begins.

        A bar on a terminal, with the seconds left that are told, else as the last run had them;
        elsewhere one line a stage.
        """
        from cqdd_design.cli.stage_times import StageTimes

        numbers = itertools.count(1)
        self._times = times = StageTimes(self.command, total)

        def tell(text: str, left: float | None = None) -> None:
            number = min(next(numbers), total)
            if (bar := self._on_terminal()) is not None:
                bar.stage(number, total, text, times.left(text) if left is None else left)
            else:
                self.note(f"[{number}/{total}] {text}")

        return tell

    def counting(self, noun: str, *, alike: bool = True) -> Callable[[int, int], None]:
        """Progress of many things: a bar on a terminal; elsewhere about ten lines in all.

        Of things that take alike long, a terminal shows the time left.
        """
        told = [0]

        def progress(done: int, total: int) -> None:
            tenth = _LINES_WITHOUT_TERMINAL * done // total
            if (bar := self._on_terminal()) is not None:
                bar.counted(done, total, noun, alike=alike)
            elif tenth > told[0]:
                told[0] = tenth
                self.note(f"[{tenth}/{_LINES_WITHOUT_TERMINAL}] {done} of {total} {noun}")

        return progress

    def rounds(self) -> Callable[[str], None]:
        """A function that tells what a search does, of which nobody knows how long it takes.

        A whole sentence, with its full stop, is what it has found out: that stays on a terminal.
        """

        def tell(text: str) -> None:
            if not text.endswith(".") and (bar := self._on_terminal()) is not None:
                bar.round(text)
            else:
                self.note(text)

        return tell

    def _on_terminal(self) -> Bar | None:
        """The bar, where stderr is a terminal and asked to say something."""
        if self._bar is None and not self.quiet and sys.stderr.isatty():
            self._bar = Bar(sys.stderr)
        return self._bar

    def end_progress(self, *, done: bool = False) -> None:
        """End the bar, if one is shown: full where work is done, else wiped."""
        if self._bar is None:
            return
        if done and interruption.exit_code() is None:
            self._bar.finish()
            if self._times is not None:
                self._times.keep()
        else:
            self._bar.wipe()

    def wrote(self, files: Iterable[WrittenFile]) -> None:
        """Tell which files were written, and which of them in place of another."""
        for file in files:
            older = ", in place of an older one" if file.replaced else ""
            self.say(f"wrote {file.path} ({file.kind}, {file.bytes:,} bytes{older})")

    def document(
        self,
        results: Mapping[str, Any],
        *,
        design: Design | None = None,
        checks: Sequence[Check] = (),
        files: Sequence[WrittenFile] = (),
    ) -> None:
        """Print the JSON document, when one is asked for."""
        if not self.as_json:
            return
        from cqdd_design.library.envelope import result_document

        self.end_progress(done=True)
        text = result_document(
            self.command,
            results,
            design=design,
            checks=checks,
            warnings=self.warnings,
            files=files,
        )
        print_result(text)


def read_design(
    out: Output, path: Path, motor: str | None = None, motor_file: Path | None = None
) -> Design:
    """The design of a file with the motor of ``--motor`` and ``--motor-file``.

    Whatever a command does, it does with this motor, and shows the design with it.
    """
    from cqdd_design.library.inputs import read_design as read

    chosen, told = read(path, motor, motor_file)
    out.warn(*told)
    return chosen


def read_specimen(
    out: Output,
    design: Design,
    *,
    calibration: Path | None = None,
    seed: int | None = None,
) -> Specimen:
    """The actuator of ``--calibration`` and ``--seed``."""
    from cqdd_design.library.inputs import specimen_of

    specimen, told = specimen_of(design, seed=seed, calibration=calibration)
    out.warn(*told)
    return specimen


def read_factors(out: Output, path: Path | None, design: Design) -> Mapping[str, float] | None:
    """Factors of ``--calibration``, with a warning where they come from another design."""
    if path is None:
        return None
    from cqdd_design.actuator.bench.calibration_file import read_calibration

    factors, warning = read_calibration(path, design.sha256)
    if warning:
        out.warn(warning)
    return factors
