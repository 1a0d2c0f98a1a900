"""How long the stages of a command took in earlier runs, for the time that is left.

Stages are unlike each other, so what is done tells nothing of what is left; earlier runs do, near
enough for another design of about the same size. What is kept is the mean of the last run and of
what was kept before: the same design again finds most of its results on disk.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from itertools import pairwise
from pathlib import Path

from cqdd_design.environment import cache_folder
from cqdd_design.errors import CqddError
from cqdd_design.files.reading import read_regular_file
from cqdd_design.files.writing import write_atomically

_MOST_BYTES, _MOST_SECONDS = 100_000, 1e6


class StageTimes:
    """The stages of one run, beside those of earlier ones.

    Parameters
    ----------
    command : str
    total : int
        Stages of this run: another number of them is other work.
    clock : callable
        Seconds that only grow.
    """

    def __init__(
        self, command: str, total: int, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._path = cache_folder() / "stages" / f"{command.replace(' ', '-')}-{total}.json"
        self._total, self._clock = total, clock
        self._begun: list[tuple[str, float]] = []
        self._last: list[tuple[str, float]] | None = None

    def left(self, text: str) -> float | None:
        """Seconds from the beginning of a stage, which is now, to the end of the last.

        None where the last run did something else, or there was none.
        """
        if self._last is None:
            self._last = _read(self._path)
        self._begun.append((text, self._clock()))
        done = len(self._begun) - 1
        if len(self._last) != self._total or _texts(self._last[: done + 1]) != _texts(self._begun):
            return None
        return sum(seconds for _, seconds in self._last[done:])

    def keep(self) -> None:
        """Keep the times where all stages are done; a folder that cannot be written is no harm."""
        if len(self._begun) != self._total:
            return
        begins = [*(begin for _, begin in self._begun), self._clock()]
        took = [end - begin for begin, end in pairwise(begins)]
        if self._last and _texts(self._last) == _texts(self._begun):
            took = [0.5 * (now + old) for now, (_, old) in zip(took, self._last, strict=True)]
        kept = [
            (text, round(seconds, 3))
            for text, seconds in zip(_texts(self._begun), took, strict=True)
        ]
        with suppress(CqddError):
            write_atomically(self._path, json.dumps(kept), "stages")
        self._begun = []


def _texts(stages: Iterable[tuple[str, float]]) -> list[str]:
    return [text for text, _ in stages]


def _read(path: Path) -> list[tuple[str, float]]:
    """Stages with their seconds; none where there is no such file, or it is no list of them."""
    if not path.exists():
        return []
    try:
        found = json.loads(read_regular_file(path, _MOST_BYTES))
        stages = [(str(text), float(seconds)) for text, seconds in found]
    except (CqddError, ValueError, TypeError):
        return []
    return stages if all(0.0 <= seconds < _MOST_SECONDS for _, seconds in stages) else []
