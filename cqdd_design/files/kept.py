"""Arrays kept on disk, by everything they depend on.

An entry is the SHA-256 of what follows, a line of JSON (what it is of, the kinds and shapes of its
arrays), and the arrays. What is not whole, or is of something else, does not count; entries appear
under their name whole, so two processes may make the same one. What was used last is kept.
"""

from __future__ import annotations

import hashlib
import json
import logging
import os
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cqdd_design.errors import CqddError
from cqdd_design.files.reading import read_regular_file
from cqdd_design.files.writing import write_atomically

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_log = logging.getLogger("cqdd_design")

_MOST_BYTES = 1_000_000_000


def entry_path(folder: Path, text: str, suffix: str) -> Path:
    """Where the entry of a text stands."""
    return folder / f"{hashlib.sha256(text.encode()).hexdigest()}.{suffix}"


def read_entry(path: Path, text: str) -> tuple[list[NDArray[Any]], Any] | None:
    """The arrays of an entry and what was told with them; None where there is none that is whole.

    Parameters
    ----------
    text : str
        What it has to be of. An entry of anything else, or one that is spoilt, is told of in a
        warning of the log.
    """
    if not path.exists():
        return None
    import numpy as np

    try:
        content = read_regular_file(path, _MOST_BYTES)
        if hashlib.sha256(memoryview(content)[65:]).hexdigest().encode() != content[:64]:
            raise ValueError("its checksum is wrong")
        end = content.index(b"\n", 65)
        line = json.loads(content[65:end])
        if line["of"] != text:
            raise ValueError("it is of something else")
        arrays: list[NDArray[Any]] = []
        first = end + 1
        for shape, kind in zip(line["shapes"], line["kinds"], strict=True):
            count = int(np.prod(shape))
            found: NDArray[np.generic] = np.frombuffer(content, kind, count, first)
            arrays.append(found.reshape(shape))
            first += found.nbytes
    except (CqddError, ValueError, KeyError, TypeError) as error:
        # Another process may have cleared it away in between.
        if path.exists():
            _log.warning("%s is spoilt (%s); computing it anew", path, error)
        return None
    with suppress(OSError):
        os.utime(path)
    return arrays, line["told"]


def write_entry(
    path: Path, text: str, arrays: Sequence[NDArray[np.generic]], told: Any, most: int
) -> None:
    """Keep an entry and those used last; a folder that cannot be written to is no harm.

    Parameters
    ----------
    text : str
        What it is of.
    told : json value
        Kept with the arrays.
    most : int
        Bytes that all entries of this folder and suffix may take together.
    """
    line = {
        "of": text,
        "shapes": [one.shape for one in arrays],
        "kinds": [one.dtype.str for one in arrays],
        "told": told,
    }
    # Spaces up to where the arrays stand as a processor wants them; after checksum and line ends.
    head = json.dumps(line, sort_keys=True)
    padded = (head + " " * (-(len(head) + 66) % 16)).encode()
    content = b"\n".join([padded, b"".join(one.tobytes() for one in arrays)])
    digest = hashlib.sha256(content).hexdigest().encode()
    try:
        write_atomically(path, b"\n".join([digest, content]), path.suffix[1:])
        _make_room(path.parent, path.suffix, len(content), most)
    except (CqddError, OSError) as error:
        _log.info("%s is not kept (%s)", path.name, error)


_TAKEN: dict[tuple[Path, str], int] = {}
"""Bytes of a folder's entries with a suffix, as they were counted last and written since."""


def _make_room(among: Path, suffix: str, written: int, most: int) -> None:
    """Take old entries away where all may be too many bytes: a folder of thousands takes long."""
    taken = _TAKEN.get((among, suffix), most) + written
    _TAKEN[among, suffix] = taken if taken <= most else _clear(among, suffix, most)


def _clear(among: Path, suffix: str, most: int) -> int:
    """Take away what was not used for longest, as far as all entries are too many bytes.

    Returns
    -------
    int
        Bytes that are left.
    """
    entries = sorted(
        ((one.stat(), one) for one in among.glob(f"*{suffix}")),
        key=lambda entry: entry[0].st_mtime,
        reverse=True,
    )
    kept, left = 0, 0
    for status, one in entries:
        kept += status.st_size
        if kept > most:
            one.unlink(missing_ok=True)
        else:
            left = kept
    return left
