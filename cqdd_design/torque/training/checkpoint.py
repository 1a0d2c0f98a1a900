"""Where a training stands, on disk: an ``.npz`` with one JSON text, no pickle."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cqdd_design.errors import UsageError, shown
from cqdd_design.files import WrittenFile, read_arrays, write_with
from cqdd_design.torque.stored import CHECKPOINT, require

FORMAT = "cqdd-design torque checkpoint 1"
_MOST_BYTES = 1_000_000_000
_WHAT = (
    "a checkpoint of this program (an .npz without pickles, which are never read); delete it and "
    "train anew"
)

Arrays = Mapping[str, NDArray[np.float32]]
_GROUPS = ("weights", "first_moment", "second_moment", "best")


@dataclass(frozen=True, eq=False)
class Checkpoint:
    """After a whole number of epochs.

    Attributes
    ----------
    identity : mapping
        All that the result depends on: model, seed, data, split, recipe, program; JSON.
    epoch, step : int
        Done.
    weights, first_moment, second_moment, best : mapping of str to array
        By the names of the weights; `best` those of the least validation RMSE.
    best_rmse : float or None
        N m; None before the first epoch.
    log : tuple of mapping
        One row an epoch.
    random_state : mapping of str to int
        Seeds from which each epoch's draws follow; see `training`.
    """

    identity: Mapping[str, Any]
    epoch: int
    step: int
    weights: Arrays
    first_moment: Arrays
    second_moment: Arrays
    best: Arrays
    best_rmse: float | None
    log: tuple[Mapping[str, Any], ...]
    random_state: Mapping[str, int]
    facts: Mapping[str, Any] = field(default_factory=dict)


def write_checkpoint(checkpoint: Checkpoint, path: Path) -> WrittenFile:
    """Write where a training stands."""
    told = {key: value for key, value in vars(checkpoint).items() if key not in _GROUPS}
    content = {"format": FORMAT, **told}
    arrays = {
        f"{group}:{name}": values
        for group in _GROUPS
        for name, values in getattr(checkpoint, group).items()
    }
    text = json.dumps(content, allow_nan=False)

    def write(place: Path) -> None:
        with place.open("wb") as stream:
            np.savez(stream, allow_pickle=False, metadata=np.array(text), **arrays)

    return write_with(path, "npz", write)


def read_checkpoint(path: Path) -> Checkpoint:
    """Read where a training stands.

    Raises
    ------
    UsageError
        When there is none, or it is of another version, or broken.
    """
    if not path.exists():
        raise UsageError(
            f"there is no checkpoint {path} to resume from; leave --resume out, or give the --out "
            "of the training that was interrupted."
        )
    arrays, content = read_arrays(path, _MOST_BYTES, _WHAT)
    told = content.pop("format", None) if isinstance(content, dict) else None
    if told != FORMAT:
        raise UsageError(
            f"{path} is {shown(told)}, not '{FORMAT}': a checkpoint is resumed by the version that "
            "wrote it; train anew."
        )
    require(CHECKPOINT, content, str(path), "delete it and train anew")
    groups: dict[str, Any] = {name: {} for name in _GROUPS}
    for key, values in arrays.items():
        group, _, name = key.partition(":")
        if group not in groups or values.dtype != np.float32 or not np.all(np.isfinite(values)):
            raise UsageError(f"{path}: {shown(key)} is no weight; delete it and train anew.")
        groups[group][name] = values
    shapes = {name: values.shape for name, values in groups["weights"].items()}
    for group, found in groups.items():
        own = {name: values.shape for name, values in found.items()}
        if own != shapes and not (group == "best" and not own and not content["epoch"]):
            raise UsageError(f"{path}: its {group} do not fit; delete it and train anew.")
    return Checkpoint(**content | {"log": tuple(content["log"])}, **groups)


def require_same(checkpoint: Checkpoint, identity: Mapping[str, Any], path: Path) -> None:
    """Refuse a checkpoint of another training.

    Raises
    ------
    UsageError
        Naming what differs.
    """
    for key, own in identity.items():
        there = checkpoint.identity.get(key)
        if there != own:
            raise UsageError(
                f"the checkpoint {path} belongs to another training: {key} is {_short(there)} "
                f"there and {_short(own)} here; give the same, or train anew without --resume."
            )


def _short(value: Any) -> str:
    text = str(value)
    return text if len(text) <= 40 else text[:12] + "..."
