"""Ctrl-C and SIGTERM as KeyboardInterrupt, so that temporary files are removed on the way out.

Never in the middle of an import: compiled packages turn the exception into an ImportError there,
or crash. The signal then waits, a twentieth of a second at a time, until the import is done.
"""

from __future__ import annotations

import signal
from types import FrameType

_WAIT = 0.05

_received: list[int] = []


def listen() -> None:
    """Answer both signals from now on."""
    signal.signal(signal.SIGINT, _interrupt)
    signal.signal(signal.SIGTERM, _interrupt)


def exit_code() -> int | None:
    """130 after Ctrl-C, 143 after SIGTERM, None when neither came."""
    return 128 + _received[0] if _received else None


def _interrupt(number: int, frame: FrameType | None) -> None:
    _received.append(number)
    _raise_when_safe(number, frame)


def _raise_when_safe(number: int, frame: FrameType | None) -> None:
    if _is_importing(frame) and hasattr(signal, "setitimer"):
        signal.signal(signal.SIGALRM, _raise_when_safe)
        signal.setitimer(signal.ITIMER_REAL, _WAIT)
        return
    raise KeyboardInterrupt


def _is_importing(frame: FrameType | None) -> bool:
    while frame is not None:
        if frame.f_code.co_filename.startswith("<frozen importlib"):
            return True
        frame = frame.f_back
    return False
