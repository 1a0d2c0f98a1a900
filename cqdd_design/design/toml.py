"""Design and requirements files: TOML in, and TOML out with comments kept."""

from __future__ import annotations

from collections.abc import Mapping, MutableMapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError

from cqdd_design.design.contradictions import parts_not_asked_for
from cqdd_design.design.model import SCHEMA_VERSION, Design
from cqdd_design.design.motor import MotorFile, motor_of_requirements, supply_of_requirements
from cqdd_design.design.problems import describe_problems, listed
from cqdd_design.design.requirements import Requirements
from cqdd_design.errors import DesignError, UsageError, nearest_names
from cqdd_design.files import (
    WrittenFile,
    parse_toml,
    read_text_file,
    refuse_extremes,
    write_atomically,
)

if TYPE_CHECKING:
    from cqdd_design.design.duty_log import DutyLog

#: A design file is a few kilobytes; anything past this is the wrong file.
LARGEST_FILE = 1_000_000


def load_design(path: Path) -> Design:
    """Read a design file.

    Raises
    ------
    UsageError
        When there is no such file, or it cannot be opened.
    DesignError
        When its content is no valid design; one sentence a problem.
    """
    return _design(_read(path), path)


def design_of_text(text: str, path: Path) -> Design:
    """The design of a file's text, as `load_design` reads it from `path`."""
    return _design(parse_toml(text, path, wrong=DesignError), path)


def _design(data: dict[str, Any], path: Path) -> Design:
    data.setdefault("name", path.stem)
    design = Design.from_mapping(_migrated(data, path), source=str(path), file=path.stem)
    # Of a file alone: whoever gives a command another motor means that one.
    if others := parts_not_asked_for(design.requirements, design.reducer, design.motor):
        raise listed(others, str(path))
    log = _duty(design.requirements, path.parent)
    return design if log is None else design.with_duty_log(log)


def _duty(asked: Requirements, folder: Path) -> DutyLog | None:
    """The duty whose file requirements name, from a folder on."""
    if asked.duty_file is None:
        return None
    # Reading it takes numpy, which most files do without.
    from cqdd_design.design.duty_file import read_duty
    from cqdd_design.design.duty_log import DutyColumns

    named = asked.duty_columns
    columns = DutyColumns()
    if named is not None:
        columns = DutyColumns(named.time or "", named.torque or "", named.speed or "")
    return read_duty(folder / asked.duty_file, columns)


def load_requirements(path: Path, changes: Mapping[str, Any] | None = None) -> Requirements:
    """Read the ``[requirements]`` table of a requirements or design file.

    A duty's file that it names is read, and its name is one from the working folder on.

    Parameters
    ----------
    path : Path
        The file.
    changes : mapping, optional
        Keys (with unit strings) that replace or add to those of the file.
    """
    data = _migrated(_read(path), path)
    table = data.get("requirements")
    if not isinstance(table, dict):
        raise DesignError(f"{path}: there is no table [requirements] with at least ratio = N.")
    given = dict(changes or {})
    if "duty_file" in given:
        table = {key: value for key, value in table.items() if not key.startswith("duty")}
    elif isinstance(table.get("duty_file"), str):
        given["duty_file"] = str(path.parent / table["duty_file"])
    # A design's motor is asked for too, unless its requirements name another.
    base, _ = motor_of_requirements(data.get("motor"), path)
    asked = {"motor": base} if base else {}
    asked |= supply_of_requirements(data.get("motor"))
    return requirements_from_mapping({**asked, **table, **given}, source=str(path))


def tables_not_asked(path: Path) -> tuple[str, ...]:
    """Tables of a requirements or design file that say more than what is asked for, by name.

    A design's gearbox is sized anew; where it works and how it is made is not asked for.
    """
    asked = {"requirements", "motor", "reducer"}
    data = _migrated(_read(path), path)
    return tuple(key for key, value in data.items() if isinstance(value, dict) and key not in asked)


def load_required_motor(path: Path) -> MotorFile | None:
    """What a requirements or design file says of its motor, other than its name; None for nothing.

    Raises
    ------
    DesignError
        When it is no motor.
    """
    return motor_of_requirements(_migrated(_read(path), path).get("motor"), path)[1]


def requirements_from_mapping(
    data: Mapping[str, Any], *, source: str = "requirements"
) -> Requirements:
    """Validate a mapping of requirement keys (unit strings); a `DesignError` says what is wrong.

    The file of a duty is read, from the working folder on.
    """
    refuse_extremes(data, source, wrong=DesignError)
    try:
        asked = Requirements.model_validate(dict(data))
    except ValidationError as error:
        raise describe_problems(error, Requirements, source) from None
    log = _duty(asked, Path())
    return asked if log is None else asked.with_duty_log(log)


def save_design(
    path: Path, design: Design, *, comments: Mapping[str, str] | None = None
) -> WrittenFile:
    """Write a design file.

    An existing file at `path` keeps its comments, order and layout: only values that differ are
    replaced. A new file holds every key that was not assumed, with `comments` (dotted key to
    text) at the end of its line.

    Parameters
    ----------
    path : Path
        Destination; written atomically.
    design : Design
        What to write.
    comments : mapping, optional
        Remarks for single keys of a new file.
    """
    if not path.exists():
        return write_atomically(path, design_text(design, comments), "design")
    import tomlkit

    document = tomlkit.parse(read_text_file(path, LARGEST_FILE, wrong=DesignError))
    old = Design.from_mapping(document.unwrap(), source=str(path))
    _update(document, design.to_mapping(), old.to_mapping(), set(design.assumed))
    return write_atomically(path, tomlkit.dumps(document), "design")


def design_text(design: Design, comments: Mapping[str, str] | None = None) -> str:
    """A new design file with every key that was not assumed, as `save_design` writes it."""
    import tomlkit

    document = tomlkit.document()
    _fill(document, design.to_mapping(), set(design.assumed), comments or {})
    return tomlkit.dumps(document)


def _read(path: Path) -> dict[str, Any]:
    if not path.exists():
        folder = path.parent if path.parent.is_dir() else Path()
        near = nearest_names(path.name, [p.name for p in folder.glob("*.toml")])
        if near:
            raise UsageError(f"there is no file {path}; did you mean {folder / near[0]}?")
        from cqdd_design.design.templates import examples

        name = path.stem
        if name in examples():
            raise UsageError(
                f"there is no file {path}; `cqdd-design new --example {name} --out "
                f"{path.with_suffix('.toml')}` writes this example."
            )
        raise UsageError(f"there is no file {path}.")
    text = read_text_file(path, LARGEST_FILE, wrong=DesignError)
    if not text.strip():
        raise DesignError(
            f"{path} is empty; `cqdd-design size --ratio 10 --out FILE` writes a complete one."
        )
    return parse_toml(text, path, wrong=DesignError)


def _migrated(data: dict[str, Any], path: Path) -> dict[str, Any]:
    """The data at the current schema version; only version 1 exists so far."""
    version = data.get("schema_version", SCHEMA_VERSION)
    if version != SCHEMA_VERSION:
        raise DesignError(
            f"{path}: schema_version {version!r} is not known; this version of cqdd-design reads "
            f"schema_version = {SCHEMA_VERSION}."
        )
    return data


def _update(
    document: MutableMapping[str, Any],
    new: Mapping[str, Any],
    old: Mapping[str, Any],
    assumed: set[str],
    prefix: str = "",
) -> None:
    for key, value in new.items():
        dotted = f"{prefix}{key}"
        if isinstance(value, Mapping):
            if key not in document:
                if _all_assumed(value, f"{dotted}.", assumed):
                    continue
                document[key] = {}
            _update(document[key], value, old.get(key, {}), assumed, f"{dotted}.")
        elif (key in document and value != old.get(key)) or (
            key not in document and dotted not in assumed
        ):
            document[key] = value


def _fill(
    document: MutableMapping[str, Any],
    data: Mapping[str, Any],
    assumed: set[str],
    comments: Mapping[str, str],
    prefix: str = "",
) -> None:
    import tomlkit

    for key, value in data.items():
        dotted = f"{prefix}{key}"
        if isinstance(value, Mapping):
            if _all_assumed(value, f"{dotted}.", assumed):
                continue
            table = tomlkit.table()
            _fill(table, value, assumed, comments, f"{dotted}.")
            document[key] = table
        elif dotted not in assumed:
            item = tomlkit.item(value)
            if dotted in comments:
                item.comment(comments[dotted])
            document[key] = item


def _all_assumed(table: Mapping[str, Any], prefix: str, assumed: set[str]) -> bool:
    return all(
        _all_assumed(value, f"{prefix}{key}.", assumed)
        if isinstance(value, Mapping)
        else f"{prefix}{key}" in assumed
        for key, value in table.items()
    )
