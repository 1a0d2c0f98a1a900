"""How far work is: a bar on a terminal, with the time left where work done tells it.

Equal things, such as gearboxes, are counted, and the time left follows from those that are done.
Stages of work are unlike each other: earlier runs tell about how long they take. Where there were
none, and of rounds of a search, the time left is said to be unknown. A bar of work that was done
ends at 100 % and stays; one of work that broke off is wiped.
"""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable
from typing import TextIO

_CELLS = 20
_WIPE = "\r\x1b[K"


class Bar:
    """One line of a terminal that is written over.

    Parameters
    ----------
    stream : TextIO
        Of a terminal.
    clock : callable
        Seconds that only grow.
    """

    def __init__(self, stream: TextIO, clock: Callable[[], float] = time.monotonic) -> None:
        self._stream, self._clock = stream, clock
        self._began = self._told = clock()
        self._counted_from: tuple[str, float] | None = None
        self._shown = self._complete = False

    def counted(self, done: int, total: int, noun: str, *, alike: bool = True) -> None:
        """Show how many things are done and, where all take alike long, the time left."""
        if self._counted_from is None or self._counted_from[0] != noun:
            self._counted_from = (noun, self._told)  # what was told last ended where these begin
        left = "" if alike or done >= total else self._since()
        if alike and 0 < done < total:
            seconds = (self._clock() - self._counted_from[1]) * (total - done) / done
            left = f", {duration(seconds)} left"
        self._draw(done / total, f"{done} of {total} {noun}", left)
        self._complete = done >= total

    def stage(self, number: int, total: int, text: str, left: float | None = None) -> None:
        """Show which stage begins, and about how many seconds are left where that is known."""
        after = self._since() if left is None else f" (about {duration(left)} left)"
        self._draw((number - 1) / total, f"{number} of {total}: {text}", after)

    def round(self, text: str) -> None:
        """Show what a search does that takes nobody knows how many rounds."""
        self._draw(None, text, self._since())

    def finish(self) -> None:
        """Leave a full bar behind, if one is shown whose work may be done."""
        if self._shown and self._complete:
            self._draw(1.0, f"done in {duration(self._clock() - self._began)}")
            self._stream.write("\n")
            self._shown = False
        self.wipe()

    def wipe(self) -> None:
        """Take the bar away."""
        if self._shown:
            self._stream.write(_WIPE)
            self._stream.flush()
            self._shown = False

    def _since(self) -> str:
        passed = self._clock() - self._began
        return f" ({duration(passed)} so far, time left unknown)" if passed >= 1.0 else ""

    def _draw(self, share: float | None, text: str, after: str = "") -> None:
        cells, percent = "." * _CELLS, ""
        if share is not None:
            full = int(_CELLS * share)
            cells, percent = "#" * full + "." * (_CELLS - full), f" {int(100.0 * share):3} %"
        start = f"[{cells}]{percent} "
        room = shutil.get_terminal_size().columns - 1
        shown = start + text[: max(0, room - len(start) - len(after))] + after
        self._stream.write(_WIPE + shown[:room])
        self._stream.flush()
        self._told, self._shown, self._complete = self._clock(), True, True


def duration(seconds: float) -> str:
    """A time for people, of two units at most.

    Examples
    --------
    >>> duration(7.3), duration(200.0), duration(4000.0)
    ('8 s', '3 min 20 s', '1 h 6 min')
    """
    whole = max(1, -int(-seconds // 1))
    if whole < 60:
        return f"{whole} s"
    minutes, rest = divmod(whole, 60)
    if minutes < 60:
        return f"{minutes} min {rest} s" if rest else f"{minutes} min"
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min" if minutes else f"{hours} h"
