"""Many designs at once, each in a process of its own.

A CAD kernel that crashes takes its process with it. With a process to each design that is one
failed design, told with its name, while all others are written.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

from cqdd_design.errors import UsageError
from cqdd_design.files import WrittenFile

COMMAND = (sys.executable, "-m", "cqdd_design")


@dataclass(frozen=True)
class DesignExport:
    """What became of one design.

    Attributes
    ----------
    path : Path
        Design file.
    exit_code : int
        Of its process: 0, one of the command line's codes, or 1 after a crash.
    files : tuple of WrittenFile
        None of a design that failed.
    error : str
        Why it failed; empty where it did not.
    warnings : tuple of str
        As of an export of it alone.
    """

    path: Path
    exit_code: int
    files: tuple[WrittenFile, ...]
    error: str
    warnings: tuple[str, ...] = ()

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form."""
        return {
            "design_file": str(self.path),
            "exit_code": self.exit_code,
            "files": [one.to_dict() for one in self.files],
            "error": self.error or None,
            "warnings": list(self.warnings),
        }


def export_many(
    designs: Sequence[Path],
    arguments: Sequence[str],
    folder: Path | None = None,
    *,
    workers: int | None = None,
    progress: Callable[[int, int], None] | None = None,
    command: Sequence[str] = COMMAND,
) -> tuple[DesignExport, ...]:
    """Export several designs in parallel.

    Parameters
    ----------
    arguments : sequence of str
        Options of ``cqdd-design export``, the same for all.
    folder : Path, optional
        Where to; each design has a folder of its own there, called like its file. Default
        ``exports/NAME``.
    workers : int, optional
        Processes at a time; default one for each core.
    progress : callable, optional
        Told how many designs of how many are done.
    command : sequence of str
        How to start the command line.

    Returns
    -------
    tuple of DesignExport
        In the order of `designs`, the failed ones among them.

    Raises
    ------
    UsageError
        When two designs would write to the same folder.
    """
    _refuse_one_folder(designs)
    most = min(workers or os.cpu_count() or 1, len(designs))
    found: dict[int, DesignExport] = {}
    with ThreadPoolExecutor(most) as pool:
        waiting = {
            pool.submit(_export_one, path, [*arguments, *_place(folder, path)], command): place
            for place, path in enumerate(designs)
        }
        for done in as_completed(waiting):
            found[waiting[done]] = done.result()
            if progress is not None:
                progress(len(found), len(designs))
    return tuple(found[place] for place in range(len(designs)))


def _export_one(path: Path, arguments: Sequence[str], command: Sequence[str]) -> DesignExport:
    process = subprocess.run(
        [*command, "export", str(path), *arguments, "--json"],
        capture_output=True,
        text=True,
        encoding="utf-8",
        errors="replace",
        check=False,
    )
    code = process.returncode
    if code == 0:
        told = json.loads(process.stdout)
        files = tuple(WrittenFile(**(one | {"path": Path(one["path"])})) for one in told["files"])
        return DesignExport(path, 0, files, "", tuple(told["warnings"]))
    # The sentence comes last, after the progress.
    last = process.stderr.strip().rpartition("cqdd-design: ")[2] or "it said nothing"
    if code < 0:
        return DesignExport(path, 1, (), f"the process was ended by {_signal_name(-code)}: {last}")
    return DesignExport(path, code, (), last)


def _refuse_one_folder(designs: Sequence[Path]) -> None:
    """Refuse designs whose files would be called alike: one would replace the other's."""
    seen: dict[str, Path] = {}
    for path in designs:
        other = seen.setdefault(path.stem.casefold(), path)
        if other is not path:
            raise UsageError(
                f"{other} and {path} would both be exported as '{path.stem}'; give one another "
                "file name, or export them one after the other with --out."
            )


def _place(folder: Path | None, path: Path) -> list[str]:
    return [] if folder is None else ["--out", str(folder / path.stem)]


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
