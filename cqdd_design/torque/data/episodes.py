"""Episodes of a joint's motion and torque, and the data set that holds them with its manifest.

A data set is a folder: ``manifest.json`` says what was recorded, how, in which units, and lists
the episodes; ``episodes/NAME.parquet`` holds the columns of each. Everything is in the joint's
frame and in SI: a positive position error asks for a positive torque.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cqdd_design.actuator.recording import require_pyarrow
from cqdd_design.errors import UsageError, shown
from cqdd_design.files import (
    WrittenFile,
    ensure_folder,
    open_regular_file,
    parse_json,
    read_text_file,
    write_atomically,
    write_with,
)
from cqdd_design.torque.stored import MANIFEST, require

FloatArray = NDArray[np.float64]

FORMAT = "cqdd-design torque data 1"
_MOST_OF_MANIFEST, _MOST_VALUES = 64_000_000, 50_000_000
UNITS: Mapping[str, str] = {
    "position": "rad",
    "target": "rad",
    "velocity": "rad/s",
    "torque": "N m",
    "current": "A",
    "wall": "1",
    "saturated": "1",
}
"""Columns and their units; `wall` and `saturated` are 1 while the joint touches a wall, or the
drive's voltage or current limit binds."""
REQUIRED = ("position", "target", "velocity", "torque")
"""Columns that no episode goes without."""


@dataclass(frozen=True, eq=False)
class Episode:
    """One uninterrupted record.

    Attributes
    ----------
    name : str
        Unique in its data set, fit for a file name.
    group : mapping of str to float or str
        The configuration, constant through the episode: ``frequency`` (Hz), ``amplitude`` (rad),
        ``start`` (rad), ``mass`` (kg), ``arm`` (m), ``wall`` (0 or 1), ``gearbox`` (seed of the
        tolerances) where the data are simulated; whatever a log's owner says otherwise.
    dt : float
        Sample time, s.
    columns : mapping of str to array (N,)
        `REQUIRED` at least; names and units of `UNITS`.
    """

    name: str
    group: Mapping[str, float | str]
    dt: float
    columns: Mapping[str, FloatArray]

    def __post_init__(self) -> None:
        """Refuse an episode that cannot be learned from."""
        missing = [name for name in REQUIRED if name not in self.columns]
        if missing:
            raise UsageError(
                f"episode {self.name} has no {', '.join(missing)}; name its columns in the map."
            )
        unknown = [name for name in self.columns if name not in UNITS]
        if unknown:
            raise UsageError(f"episode {self.name}: {', '.join(unknown)} is no column of a record.")
        if not (math.isfinite(self.dt) and self.dt > 0.0):
            raise UsageError(f"episode {self.name}: sample time {self.dt:g} s must be above 0.")
        lengths = {len(values) for values in self.columns.values()}
        if len(lengths) != 1 or not min(lengths):
            raise UsageError(f"episode {self.name}: columns of {sorted(lengths)} samples.")
        for name, values in self.columns.items():
            if not np.all(np.isfinite(values)):
                row = int(np.flatnonzero(~np.isfinite(values))[0])
                raise UsageError(
                    f"episode {self.name}: {name} is not finite at sample {row}; split the record "
                    "there, or leave it out."
                )

    def __len__(self) -> int:
        """Samples."""
        return len(self.columns["torque"])

    @property
    def time(self) -> FloatArray:
        """Seconds from the first sample (N,)."""
        return np.asarray(self.dt * np.arange(len(self)), np.float64)

    def flag(self, name: str) -> NDArray[np.bool_]:
        """`wall` or `saturated` as booleans (N,); all false where not recorded."""
        values = self.columns.get(name)
        return np.zeros(len(self), bool) if values is None else np.asarray(values) > 0.5


def asked_torque(
    columns: Mapping[str, FloatArray], position_gain: float, velocity_gain: float
) -> FloatArray:
    """What the joint's controller asks for (N,), N m: kp (target - position) - kd velocity."""
    target, position, velocity = (
        np.asarray(columns[name], np.float64) for name in ("target", "position", "velocity")
    )
    return np.asarray(position_gain * (target - position) - velocity_gain * velocity)


@dataclass(frozen=True, eq=False)
class DataSet:
    """Episodes of one joint under one controller.

    Attributes
    ----------
    position_gain, velocity_gain : float
        Of the joint's controller, N m/rad and N m s/rad: a network is valid for these only.
    torque_range : tuple of float
        Least and greatest torque that the actuator can be asked for, N m.
    facts : mapping
        What else made the data: design name and hash, seed, sensor chain, physics step,
        calibration, infeasible corners; JSON.
    """

    episodes: tuple[Episode, ...]
    position_gain: float
    velocity_gain: float
    torque_range: tuple[float, float]
    facts: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Refuse episodes that do not belong together."""
        if not self.episodes:
            raise UsageError("a data set needs one episode at least.")
        names = [episode.name for episode in self.episodes]
        if len(set(names)) != len(names):
            twice = next(name for k, name in enumerate(names) if name in names[:k])
            raise UsageError(f"two episodes are named {twice}; names must differ.")
        times = {episode.dt for episode in self.episodes}
        if max(times) - min(times) > 1e-9 * max(times):
            raise UsageError(
                f"episodes are sampled every {min(times):g} to {max(times):g} s; resample them to "
                "one time."
            )

    @property
    def dt(self) -> float:
        """Sample time of all episodes, s."""
        return self.episodes[0].dt

    @property
    def sha256(self) -> str:
        """Of every column of every episode and of the gains."""
        digest = hashlib.sha256(
            json.dumps([self.dt, self.position_gain, self.velocity_gain]).encode()
        )
        for episode in sorted(self.episodes, key=lambda one: one.name):
            digest.update(episode.name.encode())
            for name in sorted(episode.columns):
                digest.update(name.encode())
                digest.update(np.ascontiguousarray(episode.columns[name], "<f4").tobytes())
        return digest.hexdigest()

    def named(self, names: tuple[str, ...]) -> tuple[Episode, ...]:
        """Episodes by name, in that order."""
        known = {episode.name: episode for episode in self.episodes}
        return tuple(known[name] for name in names)


def write_data(data: DataSet, folder: Path, *, force: bool = False) -> tuple[WrittenFile, ...]:
    """Write a data set; an existing one is replaced with `force` only.

    Raises
    ------
    UsageError
        When there is one and `force` is not set, or the folder cannot be written.
    DependencyError
        Without pyarrow.
    """
    pyarrow, parquet = require_pyarrow()
    manifest = folder / "manifest.json"
    if manifest.exists() and not force:
        raise UsageError(f"{manifest} exists; choose another --out, or replace it with --force.")
    ensure_folder(folder / "episodes")
    files = []
    for episode in data.episodes:
        fields = [
            pyarrow.field(name, pyarrow.float32(), metadata={"unit": UNITS[name]})
            for name in episode.columns
        ]
        arrays = [np.asarray(values, np.float32) for values in episode.columns.values()]
        table = pyarrow.table(arrays, schema=pyarrow.schema(fields))
        path = folder / "episodes" / f"{episode.name}.parquet"
        files.append(write_with(path, "parquet", partial(parquet.write_table, table)))
    content = {
        "format": FORMAT,
        "dt_s": data.dt,
        "units": dict(UNITS),
        "position_gain_Nm_per_rad": data.position_gain,
        "velocity_gain_Nms_per_rad": data.velocity_gain,
        "torque_range_Nm": list(data.torque_range),
        "sha256": data.sha256,
        "facts": dict(data.facts),
        "episodes": [
            {"name": one.name, "samples": len(one), "group": dict(one.group)}
            for one in data.episodes
        ],
    }
    text = json.dumps(content, indent=1, allow_nan=False) + "\n"
    return (*files, write_atomically(manifest, text, "json"))


def read_data(folder: Path) -> DataSet:
    """Read a data set.

    Raises
    ------
    UsageError
        When the folder holds none, it is of another version, or an episode is missing or broken.
    DependencyError
        Without pyarrow.
    """
    manifest = folder / "manifest.json"
    if not manifest.exists():
        raise UsageError(
            f"{folder} holds no data set (no manifest.json); `cqdd-design torque generate` or "
            "`torque import` writes one."
        )
    content = parse_json(read_text_file(manifest, _MOST_OF_MANIFEST), manifest)
    told = content.get("format") if isinstance(content, dict) else None
    if told != FORMAT:
        raise UsageError(f"{manifest} is {shown(told)}, not '{FORMAT}'; write the data set anew.")
    require(MANIFEST, content, str(manifest), "write the data set anew")
    episodes = []
    for entry in content["episodes"]:
        path = folder / "episodes" / f"{entry['name']}.parquet"
        columns = read_parquet(path, lambda names: names)
        episodes.append(Episode(entry["name"], entry["group"], content["dt_s"], columns))
    low, high = content["torque_range_Nm"]
    return DataSet(
        episodes=tuple(episodes),
        position_gain=content["position_gain_Nm_per_rad"],
        velocity_gain=content["velocity_gain_Nms_per_rad"],
        torque_range=(low, high),
        facts=content["facts"],
    )


def read_parquet(
    path: Path, choose: Callable[[Sequence[str]], Sequence[str]]
) -> dict[str, FloatArray]:
    """Columns of a Parquet file.

    Parameters
    ----------
    choose : callable
        Gets the names of all columns and returns those to read.

    Raises
    ------
    UsageError
        When it cannot be read, is too large, or a column holds no numbers.
    DependencyError
        Without pyarrow.
    """
    _, parquet = require_pyarrow()
    with open_regular_file(path) as stream:
        try:
            file = parquet.ParquetFile(stream)
            names = list(choose(file.schema_arrow.names))
            values = file.metadata.num_rows * len(names)
            if values <= _MOST_VALUES:
                table = file.read(columns=names)
        except UsageError:
            raise
        except Exception as error:  # pyarrow has a dozen kinds for a damaged file
            raise UsageError(f"cannot read {path}: {error}".split("\n")[0][:300]) from error
    if values > _MOST_VALUES:
        raise UsageError(f"{path} has more than {_MOST_VALUES / 1e6:g} million values; split it.")
    columns = {}
    for name in names:
        try:
            column = table.column(name).to_numpy(zero_copy_only=False)
            columns[name] = np.asarray(column).astype(np.float64)
        except (KeyError, TypeError, ValueError) as error:
            raise UsageError(f"{path}: column '{name}' does not hold numbers.") from error
    return columns
