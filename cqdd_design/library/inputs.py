"""Designs, requirements, duties and actuators, as a call or a command is given them."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from cqdd_design.errors import DesignError, UsageError

if TYPE_CHECKING:
    from cqdd_design.actuator.specimen import Specimen
    from cqdd_design.design import Design, Requirements
    from cqdd_design.design.duty_log import DutyColumns
    from cqdd_design.design.motor import MotorFile

PathLike: TypeAlias = str | os.PathLike[str]
DesignLike: TypeAlias = "Design | PathLike"
"""A design, or the path of its file, or the name of an example."""

ANY = "any"
"""Of a motor that is asked for: the first of the catalogue that fits."""


def design_of(given: DesignLike) -> Design:
    """The design that is given, from its file where a path is.

    A text without an ending that no file has as its name is the name of an example design.
    """
    from cqdd_design.design import Design, load_design

    if isinstance(given, Design):
        return given
    if not isinstance(given, (str, os.PathLike)):
        raise UsageError(
            f"design must be a Design or the path of its file, not a {type(given).__name__}; "
            "Design.from_mapping makes a design of nested tables."
        )
    path = Path(os.fspath(given))
    if isinstance(given, os.PathLike) or path.suffix or path.parent != Path() or path.exists():
        return load_design(path)
    from cqdd_design.design.templates import example_text, examples
    from cqdd_design.design.toml import design_of_text

    if path.name not in examples():
        there = ", ".join(examples())
        raise UsageError(f"there is neither a file {path} nor such an example; there are {there}.")
    return design_of_text(example_text(path.name), path)


def source_of(given: DesignLike) -> Path | None:
    """The file that a design was read from, where a file's path was given."""
    if not isinstance(given, (str, os.PathLike)):
        return None
    path = Path(given)
    return path if path.exists() else None


def path_of(name: str, given: object) -> Path:
    """The path that an argument is."""
    if isinstance(given, (str, os.PathLike)):
        return Path(os.fspath(given))
    raise UsageError(f"{name} must be a path, not a {type(given).__name__}.")


def read_design(
    given: DesignLike, motor: str | None = None, motor_file: Path | None = None
) -> tuple[Design, tuple[str, ...]]:
    """A design with another motor, and a sentence where some of its own motor's data are lost."""
    from cqdd_design.catalog import find_motor
    from cqdd_design.design.motor import read_motor

    loaded = design_of(given)
    name = None if motor is None else find_motor(motor).name
    own = None if motor_file is None else read_motor(motor_file)
    chosen = loaded.with_motor(name, own)
    kept = chosen.motor.data
    lost = [key for key, value in loaded.motor.data.items() if kept.get(key) != value]
    if not lost:
        return chosen, ()
    before = f"--motor {motor}" if motor_file is None else str(motor_file)
    place = loaded.name if not isinstance(given, (str, os.PathLike)) else given
    verb, keys = "does" if len(lost) == 1 else "do", ", ".join(lost)
    return chosen, (f"{before} goes before [motor] of {place}, whose {keys} {verb} not apply.",)


def read_duty_columns(duty: Path | None, columns: str | None) -> DutyColumns | None:
    """The columns of ``--duty-columns``, which belong to a ``--duty``."""
    if columns is None:
        return None
    if duty is None:
        raise UsageError("--duty-columns names columns of --duty FILE, which is missing.")
    from cqdd_design.design.duty_file import read_columns

    return read_columns(columns)


def under_duty(design: Design, duty: Path | None, columns: str | None) -> Design:
    """The design under the duty of ``--duty``, where there is one, instead of its own."""
    named = read_duty_columns(duty, columns)
    if duty is None:
        return design
    from cqdd_design.design.duty_file import read_duty

    return design.under_duty(read_duty(duty, named), str(duty), named)


def not_taken_over(path: Path) -> str:
    """What `size` leaves unread of a requirements or design file, in a sentence; or nothing."""
    from cqdd_design.design.toml import tables_not_asked

    names = ", ".join(f"[{name}]" for name in tables_not_asked(path))
    if not names:
        return ""
    return (
        f"of {path} what is asked for and the motor are read, but not {names}: the design has its "
        "defaults there; --ambient states the air."
    )


class Wanted(NamedTuple):
    """What is to be sized.

    Attributes
    ----------
    motor : MotorFile or None
        What a file says of the required motor.
    any_motor : bool
        Whether any motor of the catalogue will do.
    """

    requirements: Requirements
    motor: MotorFile | None
    any_motor: bool


def read_wanted(
    asked: Mapping[str, Any],
    source: Requirements | Path | None = None,
    *,
    motor: str | None = None,
    motor_file: Path | None = None,
    duty: Path | None = None,
    duty_columns: str | None = None,
) -> Wanted:
    """Requirements from their keys, over those of a file or of others.

    Parameters
    ----------
    asked : mapping
        Keys of ``[requirements]``, quantities with their unit.
    motor : str, optional
        A name of the catalogue, or `ANY`.

    Raises
    ------
    UsageError
        Where only `asked` is wrong, or no ratio is stated.
    DesignError
        Where the file's values are.
    """
    from cqdd_design.catalog import find_bare_motor
    from cqdd_design.design import load_required_motor
    from cqdd_design.design.model import duty_keys
    from cqdd_design.design.motor import read_motor

    any_motor = motor is not None and motor.strip().lower() == ANY
    keys = dict(asked)
    if motor is not None and not any_motor:
        find_bare_motor(motor)
        keys["motor"] = motor
    columns = read_duty_columns(duty, duty_columns)
    if duty is not None:
        keys |= duty_keys(str(duty), columns)
    own = None
    if motor_file is not None:
        own = read_motor(motor_file)
    elif motor is None and isinstance(source, Path):
        own = load_required_motor(source)
    return Wanted(_requirements(keys, source), own, any_motor)


def _requirements(asked: dict[str, Any], source: Requirements | Path | None) -> Requirements:
    from cqdd_design.design import load_requirements, requirements_from_mapping

    if isinstance(source, Path):
        return load_requirements(source, asked)
    if source is not None:
        return requirements_from_mapping(_stated(source, asked) | asked) if asked else source
    if "ratio" not in asked:
        raise UsageError("size needs --ratio N or --requirements FILE.")
    try:
        return requirements_from_mapping(asked, source="size")
    except DesignError as error:
        raise UsageError(error.message) from None


def _stated(source: Requirements, asked: Mapping[str, Any]) -> dict[str, Any]:
    """The keys of requirements that were stated, with their unit; no duty beside another one."""
    from cqdd_design.design.tables import dump

    fields, values = type(source).model_fields, dump(source)
    own = source.model_fields_set - source.derived
    stated = {fields[name].alias or name for name in own}
    if any(key.startswith("duty") for key in asked):
        stated = {key for key in stated if not key.startswith("duty")}
    return {key: value for key, value in values.items() if key in stated}


def specimen_of(
    design: Design,
    *,
    seed: int | None = None,
    calibration: Path | Mapping[str, float] | None = None,
) -> tuple[Specimen, tuple[str, ...]]:
    """The actuator of a seed and a calibration, and a sentence where that is of another design.

    Parameters
    ----------
    seed : int, optional
        Of a gearbox drawn from the tolerances; default perfect parts.
    calibration : Path or mapping of str to float, optional
        A file that `calibrate` wrote, or what it found.
    """
    from cqdd_design.actuator.bench.calibration_file import read_calibration
    from cqdd_design.actuator.specimen import Specimen

    if calibration is None:
        return Specimen(seed=seed), ()
    if not isinstance(calibration, Path):
        return Specimen(seed=seed, factors=calibration), ()
    factors, warning = read_calibration(calibration, design.sha256)
    return Specimen(seed=seed, factors=factors), (warning,) if warning else ()
