"""Field types of design files besides quantities: whole numbers, shares, catalogue names.

A bound carries its reason, because "must be greater than 4" helps nobody.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError

from cqdd_design.catalog import (
    find_bare_motor,
    find_bearing,
    find_finish,
    find_lubricant,
    find_material,
)
from cqdd_design.errors import CatalogError, DesignError, is_unprintable, shown

if TYPE_CHECKING:
    from pydantic import GetCoreSchemaHandler
    from pydantic_core import CoreSchema

_LONGEST_TEXT = 200


class FrozenModel(BaseModel):
    """Base of every table of a design file: immutable, and closed to unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    def __init__(self, **values: Any) -> None:
        """A table from its keys, quantities with their unit.

        Raises
        ------
        DesignError
            One sentence a problem: key, value, range and nearest fix.
        """
        from cqdd_design.design.problems import describe_problems

        try:
            super().__init__(**values)
        except ValidationError as error:
            raise describe_problems(error, type(self), type(self).__name__) from None

    # Tables within tables are still pydantic's to build, with the context of the whole.
    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]


def default(text: str) -> Any:
    """A field default written as a unit string, validated like a given value."""
    return Field(default=text, validate_default=True)


@dataclass(frozen=True)
class Whole:
    """Pydantic annotation: a whole number from `low` to `high`, both allowed."""

    low: int
    high: int
    reason: str

    def _validate(self, value: object) -> int:
        wanted = f"a whole number from {self.low} to {self.high} ({self.reason})"
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise ValueError(f"{shown(value)} is not {wanted}")
        if not math.isfinite(value) or value != math.floor(value):
            raise ValueError(f"{value} is not {wanted}")
        if not self.low <= value <= self.high:
            nearest = self.low if value < self.low else self.high
            raise ValueError(f"{value:.12g} is not {wanted}; the nearest allowed is {nearest}")
        return int(value)

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Check the value before pydantic could coerce it."""
        from pydantic_core import core_schema

        return core_schema.no_info_before_validator_function(
            self._validate, core_schema.int_schema(ge=self.low, le=self.high)
        )


@dataclass(frozen=True)
class Share:
    """Pydantic annotation: a pure number from `low` to `high`, both allowed."""

    low: float
    high: float
    reason: str

    def _validate(self, value: object) -> float:
        wanted = f"a number from {self.low:g} to {self.high:g} ({self.reason})"
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise ValueError(f"{shown(value)} is not {wanted}")
        if not self.low <= value <= self.high:
            nearest = self.high if value > self.high else self.low
            raise ValueError(f"{value:g} is not {wanted}; the nearest allowed is {nearest:g}")
        return float(value)

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Check the value before pydantic could coerce it."""
        from pydantic_core import core_schema

        return core_schema.no_info_before_validator_function(
            self._validate, core_schema.float_schema(ge=self.low, le=self.high)
        )


@dataclass(frozen=True)
class ShareOr:
    """Pydantic annotation: a pure number as :class:`Share` takes it, or one word."""

    share: Share
    word: str

    def _validate(self, value: object) -> float | str:
        if value == self.word:
            return self.word
        try:
            return self.share._validate(value)
        except ValueError as error:
            raise ValueError(f'{error}; or "{self.word}"') from None

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Check the value before pydantic could coerce it."""
        from pydantic_core import core_schema

        number = core_schema.float_schema(ge=self.share.low, le=self.share.high)
        either = core_schema.union_schema([core_schema.literal_schema([self.word]), number])
        return core_schema.no_info_before_validator_function(self._validate, either)


def _known(find: Callable[[str], Any], *also: str) -> Callable[[str], str]:
    def check(name: str) -> str:
        if name in also:
            return name
        try:
            row = find(name)
        except (CatalogError, DesignError) as error:
            raise ValueError(str(error)) from None
        return str(getattr(row, "name", None) or row.designation)

    return check


def _plain(text: str) -> str:
    if len(text) > _LONGEST_TEXT or any(map(is_unprintable, text)):
        raise ValueError(
            f"at most {_LONGEST_TEXT} characters, none of them a control or direction character"
        )
    return text


#: Text that goes to terminals, reports and programs.
FreeText = Annotated[str, AfterValidator(_plain)]
MaterialName = Annotated[str, AfterValidator(_known(find_material))]
MotorName = Annotated[str, AfterValidator(_known(find_bare_motor))]
BearingName = Annotated[str, AfterValidator(_known(find_bearing, "auto"))]
FinishName = Annotated[str, AfterValidator(_known(find_finish))]
LubricantName = Annotated[FreeText, AfterValidator(_known(find_lubricant))]
