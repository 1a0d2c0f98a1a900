"""Tables of a design as nested mappings with unit strings, and their dotted keys."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any, get_args

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from cqdd_design.errors import DesignError, shown
from cqdd_design.units import Dimension, QuantityIn, format_quantity


def dump(model: BaseModel) -> dict[str, Any]:
    """A model as nested tables with unit strings."""
    result: dict[str, Any] = {}
    for attribute, name, dimension in _told_fields(type(model)):
        value = getattr(model, attribute)
        if value is None:  # not asked for, and TOML has no word for it
            continue
        if isinstance(value, BaseModel):
            result[name] = dump(value)
        elif isinstance(value, tuple):
            if value:
                result[name] = [dump(item) for item in value]
        elif dimension is not None:
            result[name] = format_quantity(value, dimension)
        else:
            result[name] = value
    return result


@cache
def _told_fields(model: type[BaseModel]) -> tuple[tuple[str, str, Dimension | None], ...]:
    """Attribute, name in a file and dimension of every field of a model."""
    return tuple(
        (attribute, field.alias or attribute, field_dimension(field))
        for attribute, field in model.model_fields.items()
    )


def field_dimension(field: FieldInfo) -> Dimension | None:
    """The dimension of a quantity field, optional or not, or None for other fields."""
    optional = [args for args in map(get_args, get_args(field.annotation)) if args]
    for item in (*field.metadata, *(part for args in optional for part in args[1:])):
        if isinstance(item, QuantityIn):
            return item.dimension
    return None


def leaves_of(model: BaseModel, prefix: str = "") -> Iterator[str]:
    """Dotted keys of what `dump` makes of a model."""
    for attribute, name, _ in _told_fields(type(model)):
        value = getattr(model, attribute)
        if isinstance(value, BaseModel):
            yield from leaves_of(value, f"{prefix}{name}.")
        elif value is not None and value != ():
            yield f"{prefix}{name}"


def leaves(data: Mapping[str, Any], prefix: str = "") -> Iterator[str]:
    """Dotted keys of nested tables."""
    for key, value in data.items():
        if isinstance(value, Mapping):
            yield from leaves(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}"


def delete_key(mapping: dict[str, Any], key: str) -> None:
    """Take a dotted key out of nested tables, where it is there."""
    *tables, last = key.split(".")
    for table in tables:
        mapping = mapping.get(table, {})
    mapping.pop(last, None)


def insert_key(mapping: dict[str, Any], key: object, value: Any) -> None:
    """Put a value under a dotted key of nested tables; a `DesignError` where that is no key."""
    if not isinstance(key, str):
        raise DesignError(f'{shown(key)} is not a dotted key, such as "reducer.eccentricity".')
    *tables, last = key.split(".")
    for table in tables:
        mapping = mapping.setdefault(table, {})
        if not isinstance(mapping, dict):
            raise DesignError(f"{key} is not a key: {table} is no table.")
    mapping[last] = value
