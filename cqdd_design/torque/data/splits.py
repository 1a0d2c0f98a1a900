"""Who is trained on, who decides when to stop, who is tested: by configuration, before windowing.

Windows of one episode overlap, and two episodes of one configuration repeat each other. A split by
windows therefore tests on what was trained on. Here whole configurations change sides, and
`audit` fails any split that does not keep to that.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from cqdd_design.errors import UsageError, did_you_mean
from cqdd_design.torque.data.episodes import REQUIRED, DataSet, Episode

Protocol = Literal["trajectory", "mass", "wall", "gearbox"]
PROTOCOLS: Mapping[str, str] = {
    "trajectory": "held-out experiments of the same kind",
    "mass": "a mass that training never carried",
    "wall": "wall contact, which training never saw",
    "gearbox": "other gearboxes drawn from the same tolerances",
}
TEST_SHARE, VALIDATION_SHARE = 0.2, 0.15
LEAST_CONFIGURATIONS = 5
"""One to test on, one to stop by, three to train on."""
LEAD = 8
"""Samples before a random window, for the acceleration's differentiator."""
PLACE = ("record", "first")
"""Keys of a group that say where an episode was cut from, not what was done."""


@dataclass(frozen=True)
class Split:
    """Names of episodes on three sides.

    Attributes
    ----------
    protocol : str
        One of `PROTOCOLS`, or "random-window".
    """

    train: tuple[str, ...]
    validation: tuple[str, ...]
    test: tuple[str, ...]
    protocol: str
    seed: int

    def sides(self) -> dict[str, tuple[str, ...]]:
        """The three by name."""
        return {"train": self.train, "validation": self.validation, "test": self.test}

    def to_dict(self) -> dict[str, Any]:
        """The JSON form."""
        return {"protocol": self.protocol, "seed": self.seed} | {
            side: list(names) for side, names in self.sides().items()
        }


def configuration(episode: Episode) -> tuple[tuple[str, float | str], ...]:
    """What was done in an episode: its group, without where it was cut from."""
    items = ((key, value) for key, value in episode.group.items() if key not in PLACE)
    return tuple(sorted((k, v if isinstance(v, str) else round(float(v), 9)) for k, v in items))


def split(data: DataSet, protocol: str, seed: int = 0) -> Split:
    """Split a data set; the same seed gives the same split.

    Parameters
    ----------
    data : DataSet
        Its facts ``training_gearbox`` and ``held_mass_kg``, where there are any, say what no
        training may see.
    protocol : str
        One of `PROTOCOLS`.

    Returns
    -------
    Split
        Already audited but for the distance of pieces of one record; see `audit`.

    Raises
    ------
    UsageError
        For an unknown protocol, a data set that has not got what it tests, or too few
        configurations, with the least number.
    """
    if protocol not in PROTOCOLS:
        raise UsageError(
            f"'{protocol}' is no split{did_you_mean(protocol, PROTOCOLS) or '.'} "
            f"There are {', '.join(PROTOCOLS)}."
        )
    own = [one for one in data.episodes if _own(one, data)]
    pool, test = own, None
    if protocol == "wall":
        _need(data, "wall", protocol)
        pool = [one for one in own if not _flag(one)]
        test = [one for one in own if _flag(one)]
    elif protocol == "mass":
        _need_fact(data, "held_mass_kg", "mass", protocol)
        held = data.facts["held_mass_kg"]
        test = [one for one in data.episodes if _same(one, "mass", held) and _trained_on(one, data)]
    elif protocol == "gearbox":
        _need_fact(data, "training_gearbox", "gearbox", protocol)
        test = [one for one in data.episodes if not _trained_on(one, data)]
    if test is not None and not test:
        raise UsageError(
            f"the data set has no episode for the split '{protocol}' ({PROTOCOLS[protocol]}); "
            "record some, or choose another split."
        )
    return _divided(pool, test, protocol, seed)


def _divided(
    pool: Sequence[Episode], test: Sequence[Episode] | None, protocol: str, seed: int
) -> Split:
    """Configurations of a pool drawn for each side; a test set given stays as it is."""
    grouped: dict[tuple[Any, ...], list[str]] = {}
    for one in pool:
        grouped.setdefault(configuration(one), []).append(one.name)
    least = LEAST_CONFIGURATIONS if test is None else LEAST_CONFIGURATIONS - 1
    if len(grouped) < least:
        raise UsageError(
            f"{len(pool)} episodes of {len(grouped)} configurations are too few for the split "
            f"'{protocol}', which needs {least} configurations at least; record more different "
            "motions, or cut long records with `torque import --cut`."
        )
    lists = list(grouped.values())
    order = np.random.default_rng([seed, 7]).permutation(len(lists))
    drawn = [lists[i] for i in order]
    tests, stops = _shares(len(drawn))
    if test is not None:
        tests, drawn = 1, [[one.name for one in test], *drawn]

    def named(groups: list[list[str]]) -> tuple[str, ...]:
        return tuple(sorted(name for names in groups for name in names))

    return Split(
        train=named(drawn[tests + stops :]),
        validation=named(drawn[tests : tests + stops]),
        test=named(drawn[:tests]),
        protocol=protocol,
        seed=seed,
    )


def _shares(count: int) -> tuple[int, int]:
    """How many of some groups test, and how many say when to stop."""
    return max(round(TEST_SHARE * count), 1), max(round(VALIDATION_SHARE * count), 1)


def audit(data: DataSet, split: Split, history: int) -> None:
    """Fail a split that leaks.

    A network looks back over `history` samples; pieces of one record on different sides must lie
    that far apart.

    Raises
    ------
    UsageError
        For an empty side, an episode that does not exist or stands on two sides, a configuration
        or samples on two sides, pieces of a record too near to each other, and for a held mass,
        another gearbox or (split "wall") a wall outside the test.
    """
    if history < 1:
        raise UsageError(f"a history of {history} samples must be 1 or more.")
    known = {one.name: one for one in data.episodes}
    seen: dict[str, str] = {}
    for side, names in split.sides().items():
        if not names:
            raise UsageError(f"the split's {side} side is empty.")
        for name in names:
            if name not in known:
                raise UsageError(f"the split names episode '{name}', which the data do not have.")
            if name in seen:
                raise UsageError(
                    f"leak: episode {name} is in {seen[name]} and in {side}; an episode belongs "
                    "to one side."
                )
            seen[name] = side
    sides = {side: [known[name] for name in names] for side, names in split.sides().items()}
    _audit_configurations(sides)
    _audit_records(sides, history)
    _audit_held(data, sides, split.protocol)
    _audit_samples(sides, history)


def _audit_configurations(sides: Mapping[str, Sequence[Episode]]) -> None:
    found: dict[tuple[Any, ...], tuple[str, str]] = {}
    for side, episodes in sides.items():
        for one in episodes:
            where, other = found.setdefault(configuration(one), (side, one.name))
            if where != side:
                told = ", ".join(f"{key} {value}" for key, value in configuration(one))
                raise UsageError(
                    f"leak: {other} ({where}) and {one.name} ({side}) are of one configuration "
                    f"({told}); keep a configuration on one side."
                )


def _audit_records(sides: Mapping[str, Sequence[Episode]], history: int) -> None:
    pieces: dict[str, list[tuple[int, int, str, str]]] = {}
    for side, episodes in sides.items():
        for one in episodes:
            if "record" in one.group:
                first = round(float(one.group.get("first", 0)))
                piece = (first, first + len(one), side, one.name)
                pieces.setdefault(str(one.group["record"]), []).append(piece)
    for record, found in pieces.items():
        # Against the farthest end so far of the other sides: a long piece may reach past others.
        ends: dict[str, tuple[int, str]] = {}
        for first, end, side, name in sorted(found):
            for other, (last, former) in ends.items():
                if other != side and first - last < history:
                    raise UsageError(
                        f"leak: {former} ({other}) and {name} ({side}) of record '{record}' lie "
                        f"{first - last} samples apart, and a window reaches back {history}; leave "
                        f"{history} samples between them."
                    )
            ends[side] = max(ends.get(side, (end, name)), (end, name))


def _audit_held(data: DataSet, sides: Mapping[str, Sequence[Episode]], protocol: str) -> None:
    if protocol == "random-window":
        return
    for side in ("train", "validation"):
        for one in sides[side]:
            told = ""
            if not _trained_on(one, data):
                told = f"gearbox {one.group.get('gearbox')}, not that of training"
            elif not _own(one, data):
                told = f"the held mass of {data.facts['held_mass_kg']:g} kg"
            elif protocol == "wall" and _flag(one):
                told = "a wall"
            if told:
                raise UsageError(
                    f"leak: {one.name} ({side}) has {told}; that belongs to the test alone."
                )


def _audit_samples(sides: Mapping[str, Sequence[Episode]], history: int) -> None:
    """The same readings under two names: a copy, or records that overlap."""
    pieces = [(side, one) for side, episodes in sides.items() for one in episodes]
    names = [f"{one.name} ({side})" for side, one in pieces]
    tables = [
        np.stack([np.asarray(one.columns[c], "<f4") for c in REQUIRED], axis=1) for _, one in pieces
    ]
    # A row of four readings as two numbers that sort.
    rows = [np.unique(np.ascontiguousarray(table).view("V16").ravel()) for table in tables]
    counts = [len(one) for one in rows]
    key = np.frombuffer(np.concatenate(rows).tobytes(), dtype=[("a", "<u8"), ("b", "<u8")])
    order = np.lexsort((key["b"], key["a"]))
    key, episode = key[order], np.repeat(np.arange(len(pieces)), counts)[order]
    owner = np.array([list(sides).index(side) for side, _ in pieces])[episode]
    shared = np.flatnonzero((key[1:] == key[:-1]) & (owner[1:] != owner[:-1]))
    if not len(shared):
        return
    # Single readings may agree by chance, as at rest; a window's worth of them does not.
    found = np.sort(np.stack([episode[shared], episode[shared + 1]], axis=1))
    pairs, times = np.unique(found, axis=0, return_counts=True)
    most = int(np.argmax(times))
    if times[most] >= history:
        first, second = (names[int(i)] for i in pairs[most])
        raise UsageError(
            f"leak: {first} and {second} share {times[most]} readings; one is a copy or a part "
            "of the other."
        )


def _trained_on(episode: Episode, data: DataSet) -> bool:
    """Whether an episode's gearbox is the one of training."""
    trained = data.facts.get("training_gearbox")
    return trained is None or _same(episode, "gearbox", trained)


def _own(episode: Episode, data: DataSet) -> bool:
    """Whether training may see an episode."""
    held = data.facts.get("held_mass_kg")
    return _trained_on(episode, data) and (held is None or not _same(episode, "mass", held))


def _same(episode: Episode, key: str, value: Any) -> bool:
    found = episode.group.get(key)
    if isinstance(found, int | float) and isinstance(value, int | float):
        return abs(found - value) <= 1e-6 * max(abs(value), 1e-12)
    return bool(found == value)


def _flag(episode: Episode) -> bool:
    """Whether an episode has a wall, by its group or by what it touches."""
    return bool(float(episode.group.get("wall", 0.0)) > 0.5 or episode.flag("wall").any())


def _need(data: DataSet, key: str, protocol: str) -> None:
    if not any(key in one.group or key in one.columns for one in data.episodes):
        raise UsageError(
            f"the split '{protocol}' needs '{key}' in the group of every episode, and no episode "
            f"has it; give it with --group {key}=VALUE or in the map file."
        )


def _need_fact(data: DataSet, fact: str, key: str, protocol: str) -> None:
    _need(data, key, protocol)
    if data.facts.get(fact) is None:
        raise UsageError(
            f"the split '{protocol}' needs to know what is held back, and the data set's facts "
            f"have no {fact}; generate with it, or give [facts] {fact} in the map file."
        )


def random_window_split(
    data: DataSet, seed: int = 0, *, history: int = 30, lead: int = LEAD, most: int = 20_000
) -> tuple[DataSet, Split]:
    """Random windows on all sides, AS IT SHOULD NOT BE DONE, to show how a score is inflated.

    Neighbouring windows share all but a few of their samples, so nearly every test window has its
    twin in training. Published actuator networks are often scored so; nothing but the comparison
    with an honest split may use this, and `audit` refuses it.

    Every window is an episode of ``history + lead`` samples, of training's gearbox and masses; the
    lead is for the acceleration's differentiator. The split is of protocol "random-window".
    """
    if history < 1 or lead < 0 or most < LEAST_CONFIGURATIONS:
        raise UsageError(
            f"windows of {history} samples with {lead} before them, {most} in all, cannot be "
            f"drawn; use 1, 0 and {LEAST_CONFIGURATIONS} or more."
        )
    size = history + lead
    pool = [one for one in data.episodes if _own(one, data) and len(one) >= size]
    counts = np.array([len(one) - size + 1 for one in pool], dtype=np.int64)
    total = int(counts.sum()) if pool else 0
    if total < LEAST_CONFIGURATIONS:
        raise UsageError(
            f"no episodes of {size} samples or more to draw {LEAST_CONFIGURATIONS} windows from."
        )
    generator = np.random.default_rng([seed, 13])
    places = generator.permutation(total)[: min(most, total)]
    ends = np.cumsum(counts)
    windows = []
    for number, place in enumerate(places):
        owner = int(np.searchsorted(ends, place, side="right"))
        first = int(place - (ends[owner] - counts[owner]))
        one = pool[owner]
        columns = {name: values[first : first + size] for name, values in one.columns.items()}
        group = {**one.group, "record": one.name, "first": first}
        windows.append(Episode(f"window-{number:06d}", group, one.dt, columns))
    names = [one.name for one in windows]
    tests, stops = _shares(len(names))
    train, validation = names[tests + stops :], names[tests : tests + stops]
    found = Split(tuple(train), tuple(validation), tuple(names[:tests]), "random-window", seed)
    return replace(data, episodes=tuple(windows)), found
