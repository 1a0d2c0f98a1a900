"""Logs of real joints as a data set: columns mapped, gaps cut, one sample time, one filter."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from cqdd_design.errors import UsageError
from cqdd_design.torque.data.episodes import DataSet, Episode, FloatArray
from cqdd_design.torque.data.log_checks import check_limit, check_signals, check_time
from cqdd_design.torque.data.log_files import LogMap, read_columns
from cqdd_design.torque.data.sensing import LEAST_OVERSAMPLING, Filter
from cqdd_design.version import __version__

RATE = 200.0
"""Of the episodes, Hz."""
FILTER_SHARE = 0.4
"""Frequency of the anti-alias filter over the rate: 80 Hz at 200 Hz."""
GAP = 2.5
"""Sample times without a sample, from which a record is split."""
LEAST_SECONDS = 0.5
"""Shorter pieces are dropped: a network's history fits three times."""
PURGE_SECONDS, PURGE_SAMPLES = 0.5, 30
"""Left out between pieces of a record that is cut, the longer of both: no window of a network, of
30 samples at most, reaches across at any rate."""
_FLAGS = ("wall", "saturated")


class Gap(NamedTuple):
    """Missing time in a log, s."""

    log: str
    begin: float
    seconds: float


@dataclass
class Tally:
    """What becomes of logs: gaps, pieces too short to keep, warnings, logs that were filtered."""

    gaps: list[Gap] = field(default_factory=list)
    dropped: int = 0
    warnings: list[str] = field(default_factory=list)
    filtered: set[str] = field(default_factory=set)

    def to_dict(self) -> dict[str, Any]:
        """The JSON form."""
        return {
            "gaps": [
                {"log": gap.log, "begin_s": gap.begin, "seconds": gap.seconds} for gap in self.gaps
            ],
            "dropped": self.dropped,
        }


def import_logs(
    paths: Sequence[Path],
    mapped: LogMap,
    *,
    position_gain: float,
    velocity_gain: float,
    rate: float = RATE,
    dt: float | None = None,
    torque_limit: float | None = None,
    cut: float | None = None,
) -> tuple[DataSet, Tally]:
    """Import logs of one joint under one controller.

    Parameters
    ----------
    paths : sequence of Path
        Each log is one configuration, unless it is cut.
    position_gain, velocity_gain : float
        Of the joint's controller, N m/rad and N m s/rad.
    rate : float
        Of the episodes, Hz.
    dt : float, optional
        Sample time of logs without a time column, s.
    torque_limit : float, optional
        Most that the joint can be asked for, N m; default the greatest torque recorded.
    cut : float, optional
        Cut records into pieces of this length, s, each a configuration of its own, with
        `PURGE_SECONDS` left out between them, or `PURGE_SAMPLES`.

    Raises
    ------
    UsageError
        For gains that are not, logs that cannot be read, units or sample times that contradict
        each other, and when nothing is left.
    """
    if not paths:
        raise UsageError("there is no log to import; name one CSV, TSV or Parquet file at least.")
    for name, value in (("position", position_gain), ("velocity", velocity_gain)):
        if not (math.isfinite(value) and value >= 0.0):
            raise UsageError(
                f"a {name} gain of {value:g} must be 0 or more: a positive position error asks for "
                "a positive torque; turn the log's signs instead."
            )
    if position_gain == 0.0:
        raise UsageError("a position gain of 0 follows no target; give the controller's own.")
    if not (math.isfinite(rate) and rate > 0.0):
        raise UsageError(f"a rate of {rate:g} Hz must be above 0; 200 Hz is usual.")
    if cut is not None and not cut >= LEAST_SECONDS:
        raise UsageError(f"pieces of {cut:g} s are shorter than {LEAST_SECONDS:g} s.")
    if torque_limit is not None and not (math.isfinite(torque_limit) and torque_limit > 0.0):
        raise UsageError(f"a torque limit of {torque_limit:g} N*m must be above 0.")
    stems = [_safe(path.stem) for path in paths]
    twice = sorted({stem for stem in stems if stems.count(stem) > 1})
    if twice:
        raise UsageError(f"two logs are named '{twice[0]}'; rename one.")
    unknown = [name for name in mapped.groups if name not in {path.stem for path in paths}]
    if unknown:
        raise UsageError(f"the map has a group for '{unknown[0]}', and no log is named so.")
    tally = Tally()
    episodes: list[Episode] = []
    for path, stem in zip(paths, stems, strict=True):
        group = {"log": stem, **mapped.group, **mapped.groups.get(path.stem, {})}
        columns, times, own = _read(path, mapped, dt)
        for number, piece in enumerate(_pieces(path, times, own, tally)):
            some = {name: values[piece] for name, values in columns.items()}
            if (piece.stop - piece.start) * own < LEAST_SECONDS:
                tally.dropped += 1
                continue
            told = check_signals(
                path.name, some, own, position_gain=position_gain, velocity_gain=velocity_gain
            )
            tally.warnings += [text for text in told if text not in tally.warnings]
            sampled = _sampled(path, some, times[piece], own, rate, tally)
            begin = round((float(times[piece.start]) - float(times[0])) * rate)
            episodes += _cut(f"{stem}-{number:03d}", group, sampled, begin, rate, cut, tally)
    if not episodes:
        raise UsageError(
            f"the logs have no piece of {LEAST_SECONDS:g} s or more without a gap; record longer, "
            "or check the sample time."
        )
    most = max(float(np.max(np.abs(one.columns["torque"]))) for one in episodes)
    limit = most if torque_limit is None else torque_limit
    tally.warnings += check_limit([one.columns["torque"] for one in episodes], limit)
    facts = {
        "source": "logs",
        "version": __version__,
        "logs": [path.name for path in paths],
        "columns": dict(mapped.columns),
        "units_of_the_logs": dict(mapped.units),
        "torque_from": "torque" if "torque" in mapped.columns else "current",
        "current_to_torque_Nm_per_A": mapped.current_to_torque,
        "torque_range_from": "the greatest recorded" if torque_limit is None else "given",
        **Filter(FILTER_SHARE * rate).to_dict(),
        "filtered_logs": sorted(tally.filtered),
        "gaps": [list(gap) for gap in tally.gaps],
        "dropped_pieces": tally.dropped,
        "cut_s": cut,
        **mapped.facts,
    }
    data = DataSet(tuple(episodes), position_gain, velocity_gain, (-limit, limit), facts)
    return data, tally


def _safe(stem: str) -> str:
    """A log's name, fit for a file name."""
    return re.sub(r"[^A-Za-z0-9_.-]+", "-", stem).strip("-.") or "log"


def _read(
    path: Path, mapped: LogMap, dt: float | None
) -> tuple[dict[str, FloatArray], FloatArray, float]:
    """SI columns, times and sample time of one log."""
    names = list(dict.fromkeys(mapped.columns.values()))
    raw = read_columns(path, names)
    columns = {
        quantity: raw[name] * mapped.factor(quantity) for quantity, name in mapped.columns.items()
    }
    for flag in _FLAGS:
        if flag in columns and not np.all(np.isin(columns[flag], (0.0, 1.0))):
            raise UsageError(f"{path}: the flag '{mapped.columns[flag]}' must be 0 or 1.")
    if "torque" not in columns:
        assert mapped.current_to_torque is not None
        columns["torque"] = mapped.current_to_torque * columns["current"]
    times = columns.pop("time", None)
    if times is None:
        if dt is None:
            raise UsageError(
                f"{path}: without a time column the sample time must be given: name the column in "
                '--columns time=..., or use --dt "1 ms".'
            )
        if not (math.isfinite(dt) and dt > 0.0):
            raise UsageError(f"{path.name}: a sample time of {dt:g} s must be above 0.")
        times = np.asarray(dt * np.arange(len(columns["position"])), np.float64)
        check_time(path.name, times)
        return columns, times, dt
    own = check_time(path.name, times)
    if dt is not None and abs(own / dt - 1.0) > 0.1:
        raise UsageError(
            f"{path.name}: its samples are {own:g} s apart, not {dt:g} s as --dt says; leave --dt "
            "out, or correct the unit of time."
        )
    return columns, times, own


def _pieces(path: Path, times: FloatArray, dt: float, tally: Tally) -> Iterator[slice]:
    """Uninterrupted pieces of a log."""
    jumps = np.flatnonzero(np.diff(times) > GAP * dt)
    for jump in jumps:
        begin = float(times[jump])
        tally.gaps.append(Gap(path.name, begin, float(times[jump + 1]) - begin))
    edges = [0, *(int(jump) + 1 for jump in jumps), len(times)]
    for first, last in itertools.pairwise(edges):
        yield slice(first, last)


def _sampled(
    path: Path,
    columns: Mapping[str, FloatArray],
    times: FloatArray,
    dt: float,
    rate: float,
    tally: Tally,
) -> dict[str, FloatArray]:
    """A piece at the rate wanted, all signals through one causal filter where it is lowered."""
    own = 1.0 / dt
    if own < 0.99 * rate:
        raise UsageError(
            f"{path.name} is sampled at {own:.4g} Hz, slower than the {rate:g} Hz wanted; more "
            f'samples hold no more: use --rate "{round(own, 3):g} Hz".'
        )
    wanted = times[0] + np.arange(math.floor((times[-1] - times[0]) * rate + 1e-6) + 1) / rate
    if own < 1.01 * rate:
        return {
            name: _at(name, wanted, times, values, 1.0 / rate) for name, values in columns.items()
        }
    found = {}
    # Evenly spaced, and fast enough for the filter, before it and the lower rate.
    fold = max(math.ceil(LEAST_OVERSAMPLING * FILTER_SHARE * rate / own - 1e-9), 1)
    even = times[0] + np.arange(math.floor((times[-1] - times[0]) * own * fold + 1e-6) + 1) / (
        own * fold
    )
    passing = Filter(FILTER_SHARE * rate)
    tally.filtered.add(path.name)
    for name, values in columns.items():
        if name in _FLAGS:
            found[name] = _at(name, wanted, times, values, 1.0 / rate)
            continue
        smooth = passing.applied(np.asarray(np.interp(even, times, values)), own * fold)
        found[name] = np.asarray(np.interp(wanted, even, smooth), np.float64)
    return found


def _at(
    name: str, wanted: FloatArray, times: FloatArray, values: FloatArray, period: float
) -> FloatArray:
    """Values at times wanted; of a flag, whether it was up since the sample before."""
    if name not in _FLAGS:
        return np.asarray(np.interp(wanted, times, values), np.float64)
    up = np.concatenate([[0.0], np.cumsum(values)])
    last = np.searchsorted(times, wanted + 1e-9 * period, side="right")
    first = np.searchsorted(times, wanted - period * (1.0 - 1e-9), side="right")
    first = np.minimum(first, np.maximum(last - 1, 0))
    return np.asarray(up[last] - up[first] > 0.0, np.float64)


def _cut(
    name: str,
    group: Mapping[str, float | str],
    columns: Mapping[str, FloatArray],
    begin: int,
    rate: float,
    cut: float | None,
    tally: Tally,
) -> Iterator[Episode]:
    """Episodes of one piece, with their place in the record."""
    record = str(group["log"])
    count = len(columns["position"])
    if cut is None:
        place = {**group, "record": record, "first": begin}
        yield Episode(name, place, 1.0 / rate, dict(columns))
        return
    size, purge = round(cut * rate), max(round(PURGE_SECONDS * rate), PURGE_SAMPLES)
    for number, first in enumerate(range(0, count, size + purge)):
        last = min(first + size, count)
        if last - first < LEAST_SECONDS * rate:
            tally.dropped += 1
            continue
        some = {key: values[first:last] for key, values in columns.items()}
        piece = f"{name}-{number:03d}"
        place = {**group, "piece": piece, "record": record, "first": begin + first}
        yield Episode(piece, place, 1.0 / rate, some)
