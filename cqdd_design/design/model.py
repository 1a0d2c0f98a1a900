"""The `Design`: everything a design file says, resolved, immutable, SI inside."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal, get_args, get_origin

from pydantic import BaseModel, PrivateAttr, ValidationError, model_validator

from cqdd_design.design.actuator import Drive, Edm, Environment, Housing, MotorTable, Tolerances
from cqdd_design.design.fields import FrozenModel
from cqdd_design.design.problems import describe_problems
from cqdd_design.design.reducer import Reducer
from cqdd_design.design.requirements import Requirements
from cqdd_design.errors import DesignError, is_unprintable
from cqdd_design.files import refuse_extremes
from cqdd_design.units import Dimension, QuantityIn, format_quantity

SCHEMA_VERSION: Literal[1] = 1
#: Bytes of a name; file names add theirs, and 255 is the most that file systems take.
_LONGEST_NAME = 200


class Design(FrozenModel):
    """A complete actuator design.

    Attribute names are the keys of the file; every quantity is an SI float, so
    ``design.reducer.eccentricity`` is in metres. Keys that the file left out hold their defaults
    and are listed by `assumed`.
    """

    schema_version: Literal[1] = SCHEMA_VERSION
    name: str = "unnamed"
    requirements: Requirements
    reducer: Reducer
    motor: MotorTable = MotorTable()
    drive: Drive = Drive()
    housing: Housing = Housing()
    environment: Environment = Environment()
    tolerances: Tolerances = Tolerances()
    edm: Edm = Edm()

    _assumed: tuple[str, ...] = PrivateAttr(default=())

    @model_validator(mode="before")
    @classmethod
    def _ratio_once(cls, data: Any) -> Any:
        """The requirements' ratio is that of the reducer unless the file says it again."""
        if not isinstance(data, dict):
            return data
        filled = dict(data)
        reducer = filled.get("reducer")
        requirements = filled.get("requirements", {})
        if isinstance(reducer, dict) and isinstance(requirements, dict) and "ratio" in reducer:
            filled["requirements"] = {"ratio": reducer["ratio"], **requirements}
        return filled

    @model_validator(mode="after")
    def _consistent(self) -> Design:
        if self.requirements.ratio != self.reducer.ratio:
            raise ValueError(
                f"requirements.ratio {self.requirements.ratio} is not reducer.ratio "
                f"{self.reducer.ratio}; make them equal or leave requirements.ratio out"
            )
        if (
            not self.name.strip(" .")
            or len(self.name.encode("utf-8", "replace")) > _LONGEST_NAME
            or any(c in '/\\:*?"<>|' or is_unprintable(c) for c in self.name)
        ):
            raise ValueError(
                f"name {self.name[:_LONGEST_NAME]!a} becomes part of file names; "
                f"use letters, digits, blanks, '-' and '_', {_LONGEST_NAME} bytes at most"
            )
        return self

    @classmethod
    def from_mapping(
        cls, data: Mapping[str, Any], *, source: str = "design", si: bool = False
    ) -> Design:
        """Validate a nested mapping with the keys of a design file.

        Parameters
        ----------
        data : mapping
            Nested tables; quantities as unit strings, or as SI floats when `si` is true.
        source : str
            What to call the input in messages (a file name).
        si : bool
            Accept SI floats for quantities.

        Returns
        -------
        Design
            Resolved, with `assumed` naming every key that was left to its default.

        Raises
        ------
        DesignError
            One sentence a problem: key, value, range and nearest fix.
        """
        refuse_extremes(data, source, wrong=DesignError)
        try:
            design = cls.model_validate(dict(data), context={"si": si})
        except ValidationError as error:
            raise describe_problems(error, cls, source) from None
        given = set(_leaves(data))
        design._assumed = tuple(
            key for key in design.dotted_keys() if key not in given and not _below(key, given)
        )
        return design

    @property
    def assumed(self) -> tuple[str, ...]:
        """Dotted keys left to their defaults, in file order."""
        return self._assumed

    def dotted_keys(self) -> tuple[str, ...]:
        """All dotted keys of the resolved design, in file order."""
        return tuple(_leaves(self.to_mapping()))

    def to_mapping(self) -> dict[str, Any]:
        """The design as nested tables with unit strings, every key present."""
        return dump(self)

    def replacing(self, changes: Mapping[str, Any]) -> Design:
        """A design in which the given dotted keys have new values (SI floats or unit strings).

        Keys that were assumed before stay assumed unless they are among the changes.
        """
        mapping = self.to_mapping()
        for key in self.assumed:
            _delete(mapping, key)
        for key, value in changes.items():
            _insert(mapping, key, value)
        return Design.from_mapping(mapping, source=self.name, si=True)

    @property
    def sha256(self) -> str:
        """Hash of the resolved design: equal designs, equal hash, whatever the file looks like."""
        text = json.dumps(self.to_mapping(), sort_keys=True, ensure_ascii=False)
        return hashlib.sha256(text.encode()).hexdigest()


def dump(model: BaseModel) -> dict[str, Any]:
    """A model as nested tables with unit strings."""
    result: dict[str, Any] = {}
    for name, field in type(model).model_fields.items():
        value = getattr(model, name)
        dimension = field_dimension(field.metadata)
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


def field_dimension(metadata: list[Any]) -> Dimension | None:
    """The dimension of a quantity field, or None for other fields."""
    for item in metadata:
        if isinstance(item, QuantityIn):
            return item.dimension
        if get_origin(item) is Annotated:
            return field_dimension(list(get_args(item)[1:]))
    return None


def _leaves(data: Mapping[str, Any], prefix: str = "") -> Iterator[str]:
    for key, value in data.items():
        if isinstance(value, Mapping):
            yield from _leaves(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}"


def _below(key: str, given: set[str]) -> bool:
    return any(key.startswith(f"{other}.") for other in given)


def _delete(mapping: dict[str, Any], key: str) -> None:
    *tables, last = key.split(".")
    for table in tables:
        mapping = mapping.get(table, {})
    mapping.pop(last, None)


def _insert(mapping: dict[str, Any], key: str, value: Any) -> None:
    *tables, last = key.split(".")
    for table in tables:
        mapping = mapping.setdefault(table, {})
    mapping[last] = value
