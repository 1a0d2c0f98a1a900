"""Influence matrices on disk, by everything they depend on.

They are kept in single precision: 6e-8 is a thousandth of what the mesh leaves, and reading and
checking take half as long. What is spoilt is computed anew and written over.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from dataclasses import asdict, is_dataclass
from pathlib import Path
from typing import TypeVar

import numpy as np

from cqdd_design.environment import cache_folder
from cqdd_design.files.kept import entry_path, read_entry, write_entry
from cqdd_design.gearbox.bodies.model import Body

VERSION = 7
"""Of the method: raised whenever the same shape would give other numbers."""
Shape = TypeVar("Shape")

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
    path = entry_path(folder(), text, "body")
    kept = read_entry(path, text)
    if kept is not None:
        (matrix, stress), reciprocity = kept
        return Body(matrix, stress, reciprocity)
    made = compute(shape)
    matrix, stress = (np.ascontiguousarray(one, "<f4") for one in (made.matrix, made.told_stress))
    write_entry(path, text, [matrix, stress], made.reciprocity, _MOST_KEPT)
    return Body(matrix, stress, made.reciprocity)


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
