"""Influence matrices on disk, by everything they depend on.

An entry is the SHA-256 of what follows, a line of JSON (what it is of, the shapes of its arrays),
and the arrays, in single precision: 6e-8 is a thousandth of what the mesh leaves, and reading and
checking take half as long. What is not whole, or is of something else, is computed anew and
written over; entries appear under their name whole, so two processes may make the same one. What
was used last is kept.
"""

from __future__ import annotations

import hashlib
import json
import logging
import os
from collections.abc import Callable
from contextlib import suppress
from dataclasses import asdict, is_dataclass
from pathlib import Path
from typing import TypeVar

import numpy as np

from cqdd_design.environment import cache_folder
from cqdd_design.errors import CqddError
from cqdd_design.files import read_regular_file, write_atomically
from cqdd_design.gearbox.bodies.model import Body

_log = logging.getLogger("cqdd_design")

VERSION = 3
"""Of the method: raised whenever the same shape would give other numbers."""
Shape = TypeVar("Shape")

_MOST_BYTES = 1_000_000_000
_MOST_KEPT = 600_000_000
"""Bytes of all entries together: a hundred shapes or more."""


def folder() -> Path:
    """Where entries are kept."""
    return cache_folder() / "bodies"


def cached(shape: Shape, compute: Callable[[Shape], Body]) -> Body:
    """The body of a shape, from disk or computed and put there; in single precision either way.

    Parameters
    ----------
    shape : DiscShape or RingShape
    compute : callable
        Makes it.
    """
    text = json.dumps({"version": VERSION, "shape": _plain(shape)}, sort_keys=True)
    path = folder() / f"{hashlib.sha256(text.encode()).hexdigest()}.body"
    body = _read(path, text)
    if body is None:
        made = compute(shape)
        matrix, stress = (np.ascontiguousarray(one, "<f4") for one in (made.matrix, made.stress))
        body = Body(matrix, stress, made.reciprocity)
        _write(path, text, body)
    else:
        with suppress(OSError):
            os.utime(path)
    return body


def _plain(value: object) -> object:
    """Numbers of a value, written so that no two differ by nothing and none is lost."""
    if is_dataclass(value) and not isinstance(value, type):
        return {"kind": type(value).__name__, **{k: _plain(v) for k, v in asdict(value).items()}}
    if isinstance(value, dict):
        return {str(key): _plain(one) for key, one in value.items()}
    if isinstance(value, np.ndarray):
        return hashlib.sha256(np.ascontiguousarray(value, dtype="<f8").tobytes()).hexdigest()
    if isinstance(value, (list, tuple)):
        return [_plain(one) for one in value]
    return float(value).hex() if isinstance(value, float) else value


def _read(path: Path, text: str) -> Body | None:
    """The entry at `path`, or None where there is none that is whole and of this shape."""
    if not path.exists():
        return None
    try:
        content = read_regular_file(path, _MOST_BYTES)
        if hashlib.sha256(memoryview(content)[65:]).hexdigest().encode() != content[:64]:
            raise ValueError("its checksum is wrong")
        end = content.index(b"\n", 65)
        told = json.loads(content[65:end])
        if told["of"] != text:
            raise ValueError("it is of another body")
        arrays, first = [], end + 1
        for shape in told["shapes"]:
            count = int(np.prod(shape))
            arrays.append(np.frombuffer(content, "<f4", count, first).reshape(shape))
            first += 4 * count
        return Body(arrays[0], arrays[1], told["reciprocity"])
    except (CqddError, ValueError, KeyError, TypeError) as error:
        # Another process may have cleared it away in between.
        if path.exists():
            _log.warning("%s is spoilt (%s); computing it anew", path, error)
        return None


def _write(path: Path, text: str, body: Body) -> None:
    """Keep an entry and those used last; a folder that cannot be written to is no harm."""
    arrays = [body.matrix, body.stress]
    told = {
        "of": text,
        "shapes": [one.shape for one in arrays],
        "reciprocity": body.reciprocity,
    }
    # Spaces up to where the arrays stand as a processor wants them; after checksum and line ends.
    text_of = json.dumps(told, sort_keys=True)
    line = (text_of + " " * (-(len(text_of) + 66) % 16)).encode()
    told_and_arrays = b"\n".join([line, b"".join(one.tobytes() for one in arrays)])
    digest = hashlib.sha256(told_and_arrays).hexdigest().encode()
    try:
        write_atomically(path, b"\n".join([digest, told_and_arrays]), "body")
        _clear(path.parent)
    except (CqddError, OSError) as error:
        _log.info("no elastic body is kept (%s)", error)


def _clear(among: Path) -> None:
    """Take away what was not used for longest, as far as all entries are too many bytes."""
    entries = sorted(
        ((one.stat(), one) for one in among.glob("*.body")),
        key=lambda entry: entry[0].st_mtime,
        reverse=True,
    )
    kept = 0
    for status, one in entries:
        kept += status.st_size
        if kept > _MOST_KEPT:
            one.unlink(missing_ok=True)
