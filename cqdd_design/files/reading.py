"""Reading whole files within bounds.

Every file that a command reads is opened by `open_regular_file`: a pipe would block for ever, and
a device has no end.
"""

from __future__ import annotations

import contextlib
import os
import stat
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from cqdd_design.errors import CqddError, UsageError


@contextlib.contextmanager
def open_regular_file(path: Path) -> Iterator[BinaryIO]:
    """Open a regular file, or a link to one, for reading.

    Raises
    ------
    UsageError
        When there is none, it is a folder, a device, a pipe or a socket, or cannot be read, also
        while the block reads.
    """
    try:
        _refuse_irregular(path, os.stat(path).st_mode)
        # A file may turn into a pipe after the look at it: never wait for a writer.
        flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
        with os.fdopen(os.open(path, flags), "rb") as stream:
            _refuse_irregular(path, os.fstat(stream.fileno()).st_mode)
            yield stream
    except FileNotFoundError:
        raise UsageError(f"cannot read {path}: there is no such file.") from None
    except OSError as error:
        raise UsageError(f"cannot read {path}: {error.strerror or error}.") from error


def read_regular_file(path: Path, most: int, *, wrong: type[CqddError] = UsageError) -> bytes:
    """The content of a regular file.

    Parameters
    ----------
    path : Path
        The file, or a link to it.
    most : int
        The most bytes; never are more than one above it read, whatever size the file claims.
    wrong : type
        Error for a file that is too large.

    Raises
    ------
    UsageError
        As `open_regular_file`.
    """
    with open_regular_file(path) as stream:
        content = stream.read(most + 1)
    if len(content) > most:
        raise wrong(
            f"{path} is larger than {most / 1e6:g} MB, the most that is read; "
            "this is another kind of file."
        )
    return content


def _refuse_irregular(path: Path, mode: int) -> None:
    if stat.S_ISREG(mode):
        return
    if stat.S_ISDIR(mode):
        raise UsageError(f"cannot read {path}: it is a folder; name a file.")
    raise UsageError(
        f"cannot read {path}: it is {irregular(mode)}; put what comes from it into a file first."
    )


def irregular(mode: int) -> str:
    """What stands in place of a file."""
    if stat.S_ISDIR(mode):
        return "a folder"
    if stat.S_ISFIFO(mode):
        return "a pipe"
    return "a socket" if stat.S_ISSOCK(mode) else "a device"


def read_text_file(path: Path, most: int, *, wrong: type[CqddError] = UsageError) -> str:
    """The text of a regular file in UTF-8; a mark at its beginning (Windows) is left out.

    Raises
    ------
    UsageError
        As `read_regular_file`; and the error `wrong` where it is not UTF-8.
    """
    content = read_regular_file(path, most, wrong=wrong)
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise wrong(f"{path} is not a text file in UTF-8 but in UTF-16; save it as UTF-8.")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise wrong(
            f"{path} is not a text file (byte {error.start} is not UTF-8); save it as UTF-8."
        ) from None
