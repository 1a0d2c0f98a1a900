"""Files to start from: every key with its default, its range and what it is; and whole examples."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from importlib import resources
from types import MappingProxyType
from typing import Annotated, Any, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from cqdd_design.catalog.motors import CONVENTIONS, Motor, find_motor
from cqdd_design.design.fields import Share, ShareOr, Whole
from cqdd_design.design.model import Design
from cqdd_design.design.motor import DEFAULT_MOTOR, MotorData
from cqdd_design.design.requirements import Requirements
from cqdd_design.design.tables import dump, field_dimension
from cqdd_design.errors import CatalogError, nearest_names
from cqdd_design.units import QuantityIn, format_quantity

_EXAMPLES = "examples"
_EXAMPLE = "example"
_REMARKS_AT = 44
"""Column of the remarks."""
_NOT_OF_ROW = ("name", "based_on", "speed_constant", "winding_limit")
"""Keys of a motor whose row says them otherwise."""
_TABLES: Mapping[str, str] = MappingProxyType(
    {
        "duty": '[{ torque = "30 N*m", speed = "10 rad/s", share = 0.7 }]',
        "duty_columns": '{ time = "t [s]", torque = "T [N m]", speed = "w [rad/s]" }',
    }
)
"""How lists of tables and tables in a line are written."""
_ASKED: Mapping[str, Any] = MappingProxyType(
    {
        "continuous_speed": "600 rpm",
        "speed_at_peak": "3 rad/s",
        "duty_file": "duty.csv",
        "bore": "8 mm",
        "mass": "1.5 kg",
        "reflected_inertia": "0.08 kg*m^2",
        "backlash": "6 arcmin",
        "shrinkage": 0.003,
        "lost_motion": "4 arcmin",
        "stiffness": "8000 N*m/rad",
        "efficiency": 0.75,
        "surface_temperature": "70 degC",
        "external_moment": "20 N*m",
        "external_axial": "100 N",
        "external_radial": "100 N",
        "voltage": "48 V",
        "current": "50 A",
    }
)
"""Examples of what is asked for only where it is stated."""


@dataclass(frozen=True)
class Template:
    """A file that a person fills in.

    Attributes
    ----------
    file : str
        Its usual name.
    says : str
        What it is for, in a few words.
    text : callable
        Its content.
    """

    file: str
    says: str
    text: Callable[[], str]


def motor_template() -> str:
    """A motor file: the data of a motor of the catalogue under a name of one's own."""
    row = find_motor(DEFAULT_MOTOR)
    known = _of_row(row)
    told = {"name": "my motor", **known}
    lines = [
        "# A motor of your own, for --motor-file; the same keys may stand in [motor] of a design.",
        f"# The values are those of {row.name}, to be replaced. What you do not know, leave out:",
        "# it then counts as unknown, never as zero, and what hangs on it is not judged.",
        "",
    ]
    notes = {
        "name": "yours; one of the catalogue takes what is left out from there",
        "based_on": "instead: a motor of the catalogue that gives what is left out",
        "kind": "outrunner (rotor outside its stator) or inrunner",
        "convention": f"of torque_constant: {', '.join(CONVENTIONS)}",
        "measured_between": "line or phase (of a star): resistance and inductance",
    }
    examples = {
        "based_on": row.name,
        "speed_constant": "55 rpm/V",
        "rotor_mass": "0.3 kg",
        "stator_mass": "0.41 kg",
        "winding_limit": "120 degC",
        "thermal_resistance": "1.2 K/W",
        "hollow_diameter": "10 mm",
    }
    for key, field in MotorData.model_fields.items():
        value = told.get(key, examples.get(key, 0.0))
        lines.append(_line(key, value, notes.get(key) or _range(field), given=key in told))
    return "\n".join(lines) + "\n"


def _of_row(row: Motor) -> dict[str, Any]:
    """The keys of a motor file that say what a row of the catalogue does."""
    values: dict[str, Any] = {
        "torque_constant": row.torque_constant,
        "convention": "dc",
        "resistance": row.line_resistance,
        "inductance": row.line_inductance,
        "measured_between": "line",
    }
    values["kind"] = "inrunner" if row.is_inrunner else "outrunner"
    found: dict[str, Any] = {}
    for key, field in MotorData.model_fields.items():
        value = values.get(key, getattr(row, key, None))
        dimension = field_dimension(field)
        if key in _NOT_OF_ROW or value is None:
            continue
        if dimension is not None:
            value = format_quantity(float(f"{value:.4g}"), dimension)
        found[key] = value
    return found


def requirements_template() -> str:
    """A requirements file with all that `size` can be asked for."""
    asked = Requirements.model_validate({"ratio": 10})
    lines = [
        "# What a gearbox must do, for `cqdd-design size --requirements FILE`. Take the # off",
        "# what you want: behind it stands the default, or an example of what is not asked for",
        "# unless it is stated. Torques that are left out are what motor and gearbox can do.",
        "# [motor] may describe a motor of your own with the keys of `cqdd-design new motor`.",
        "",
        "[requirements]",
        *_lines(Requirements, dump(asked), {"ratio"}),
    ]
    return "\n".join(lines) + "\n"


def duty_template() -> str:
    """A duty over time to fill in."""
    # Its room reads duties with numpy, which the other templates do without.
    from cqdd_design.design import duty_file

    return duty_file.duty_template()


def design_template() -> str:
    """A design file with every key; those that have a default are comments."""
    reducer = {
        "ratio": 10,
        "ring_pitch_radius": "33.5 mm",
        "eccentricity": "1.57 mm",
        "ring_pin_diameter": "6.5 mm",
        "disc_thickness": "9 mm",
        "output_pins": {"count": 16, "circle_radius": "23.6 mm"},
        "cam_bearing": {"designation": "6904"},
        "ring": {"outer_diameter": "72 mm"},
    }
    design = Design.from_mapping({"name": "design", "reducer": reducer})
    assumed = set(design.assumed)
    lines = [
        "# A design: what `cqdd-design check`, `report`, `export` and others read. Behind a #",
        "# stands the default of a key, or an example of what counts only where it is stated;",
        "# take the # off to change it. `cqdd-design size` finds one for what you require.",
        "",
    ]
    # Its name is that of the file, wherever it is put.
    given = {key for key in design.dotted_keys() if key not in {*assumed, "name"}}
    lines += [*_tables(Design, design.to_mapping(), given), *_optional_tables(Design)]
    return "\n".join(lines) + "\n"


def _tables(
    model: type[BaseModel], values: Mapping[str, Any], given: set[str], prefix: str = ""
) -> Iterator[str]:
    """Lines of a table and of the tables in it."""
    inner = {key: kind for key, kind in _models(model).items() if key in values}
    own = {key.removeprefix(prefix) for key in given if key.startswith(prefix)}
    plain = {key: value for key, value in values.items() if key not in inner}
    yield from _lines(model, plain, own)
    for key, kind in inner.items():
        below = f"{prefix}{key}."
        yield ""
        yield f"[{below[:-1]}]"
        yield from _tables(kind, values[key], given, below)


def _optional_tables(model: type[BaseModel]) -> Iterator[str]:
    """Lines of tables that a file has or has not, all behind a #; their keys are set in."""
    for key, kind in _optional_models(model).items():
        yield from ("", f"# [{key}]   # {(kind.__doc__ or '').splitlines()[0]}")
        for line in _lines(kind, dump(kind()), set()):
            yield line.replace("# ", "#   ", 1)


def _optional_models(model: type[BaseModel]) -> dict[str, type[BaseModel]]:
    """Tables that may be left out, but for those of `_TABLES`, which fit a line."""
    return {
        key: one
        for key, field in model.model_fields.items()
        for one in get_args(field.annotation)
        if key not in _TABLES
        and type(None) in get_args(field.annotation)
        and isinstance(one, type)
        and issubclass(one, BaseModel)
    }


def _models(model: type[BaseModel]) -> dict[str, type[BaseModel]]:
    return {
        key: field.annotation
        for key, field in model.model_fields.items()
        if isinstance(field.annotation, type) and issubclass(field.annotation, BaseModel)
    }


def _lines(model: type[BaseModel], values: Mapping[str, Any], given: set[str]) -> Iterator[str]:
    """A line for every key, but for those of a motor's data, which have a template of their own."""
    for attribute, field in model.model_fields.items():
        key = field.alias or attribute
        if key in _models(model) or key in _optional_models(model):
            continue
        if issubclass(model, MotorData) and key in MotorData.model_fields and key != "name":
            continue
        if key in values:
            yield _line(key, values[key], _range(field), given=key in given)
        elif key in _TABLES:
            yield f"# {key} = {_TABLES[key]}   # {_EXAMPLE}"
        elif field.default is None:
            dimension = field_dimension(field)
            plain = "" if dimension is None else dimension.example().strip('"')
            remark = "; ".join(words for words in (_EXAMPLE, _range(field)) if words)
            yield _line(key, _ASKED.get(key, plain), remark, given=False)
    if issubclass(model, MotorData):
        yield "# and the keys of `cqdd-design new motor`, for a motor that the catalogue lacks"


def _line(key: str, value: Any, remark: str, *, given: bool) -> str:
    written = json.dumps(value, ensure_ascii=False)
    line = f"{'' if given else '# '}{key} = {written}"
    return f"{line:<{_REMARKS_AT}} # {remark}" if remark else line


def _range(field: FieldInfo) -> str:
    """What a key may be, from the very bounds that are checked."""
    for item in (*field.metadata, *_nested(field.annotation)):
        if isinstance(item, QuantityIn):
            return f"{item.low} to {item.high}: {item.reason}"
        if isinstance(item, (Whole, Share)):
            return f"{item.low:g} to {item.high:g}: {item.reason}"
        if isinstance(item, ShareOr):
            share = item.share
            return f'{share.low:g} to {share.high:g}: {share.reason}; or "{item.word}"'
    words = [one for one in get_args(field.annotation) if isinstance(one, str)]
    return " or ".join(json.dumps(word) for word in words)


def _nested(annotation: Any) -> tuple[Any, ...]:
    """Metadata inside an annotation, as of a type that is one of several."""
    if get_origin(annotation) is Annotated:
        return get_args(annotation)[1:]
    return tuple(item for one in get_args(annotation) for item in _nested(one))


TEMPLATES: Mapping[str, Template] = MappingProxyType(
    {
        "design": Template("design.toml", "a design, every key with its default", design_template),
        "duty": Template("duty.csv", "a duty over time, in rows", duty_template),
        "motor": Template("motor.toml", "a motor that the catalogue lacks", motor_template),
        "requirements": Template(
            "requirements.toml", "what `size` is asked for", requirements_template
        ),
    }
)
"""Kinds of file that a person writes, in the order of the alphabet."""


def find_template(kind: str) -> Template:
    """The template of a kind.

    Raises
    ------
    CatalogError
        With all kinds, when there is none.
    """
    if kind in TEMPLATES:
        return TEMPLATES[kind]
    raise CatalogError(f"there is no template '{kind}'; there are {', '.join(TEMPLATES)}.")


def examples() -> tuple[str, ...]:
    """Names of the example designs that come with the package."""
    folder = resources.files("cqdd_design.design") / _EXAMPLES
    return tuple(sorted(one.name.removesuffix(".toml") for one in folder.iterdir()))


def example_text(name: str, called: str = "") -> str:
    """An example design, as its file is, or with another name in it for a file of that name.

    Raises
    ------
    CatalogError
        With the nearest names and all of them, when there is none.
    """
    known = examples()
    if name not in known:
        near = nearest_names(name, known)
        hint = f", the nearest is {near[0]}" if near else ""
        raise CatalogError(f"there is no example '{name}'{hint}; there are {', '.join(known)}.")
    file = resources.files("cqdd_design.design") / _EXAMPLES / f"{name}.toml"
    text, given = file.read_text(encoding="utf-8"), f'name = "{name}"'
    return text.replace(given, f"name = {json.dumps(called or name)}", 1)
