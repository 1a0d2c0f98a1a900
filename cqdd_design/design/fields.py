"""Field types of design files besides quantities: whole numbers, shares, catalogue names.

A bound carries its reason, because "must be greater than 4" helps nobody.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, NoReturn, Self

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError

from cqdd_design.catalog import (
    find_bare_motor,
    find_bearing,
    find_finish,
    find_lubricant,
    find_material,
)
from cqdd_design.errors import (
    CatalogError,
    DesignError,
    UsageError,
    did_you_mean,
    is_unprintable,
    shown,
)
from cqdd_design.units.plain import real_number, whole_number

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

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """A copy, with other values where they are given: the whole is checked as a file is.

        What is not given stays as it is, what follows from other keys among it.

        Parameters
        ----------
        update : mapping, optional
            By attribute; quantities as SI floats or with their unit.
        deep : bool
            Copy tables within as well.

        Raises
        ------
        DesignError
            One sentence a problem: key, value, range and nearest fix.
        """
        from cqdd_design.design.problems import describe_problems

        if not update:
            return super().model_copy(deep=deep)
        fields = type(self).model_fields
        values = {name: getattr(self, name) for name in fields} | dict(update)
        aliases = {name: field.alias for name, field in fields.items() if field.alias}
        table = {aliases.get(name, name): value for name, value in values.items()}
        try:
            checked = type(self).model_validate(table, context={"si": True})
        except ValidationError as error:
            raise describe_problems(error, type(self), type(self).__name__) from None
        found = {name: getattr(checked, name) for name in update}
        return super().model_copy(update=found, deep=deep)

    def unchecked_copy(self, update: Mapping[str, Any]) -> Self:
        """A copy with other SI values, taken as they are: for searches, which know their bounds.

        Parameters
        ----------
        update : mapping
            By attribute.
        """
        return super().model_copy(update=update)

    def __setattr__(self, name: str, value: Any) -> None:
        """Refuse any key: a table never changes."""
        if name.startswith("_"):
            super().__setattr__(name, value)
        else:
            self._refuse_change(name)

    def __delattr__(self, name: str) -> None:
        """Refuse any key: a table never changes."""
        self._refuse_change(name)

    def _refuse_change(self, name: str) -> NoReturn:
        kind, known = type(self).__name__, type(self).model_fields
        if name not in known:
            raise UsageError(f"{kind} has no key {name}{did_you_mean(name, known) or '.'}")
        raise UsageError(
            f"a design and its tables are frozen, and {name} of {kind} stays as it is; "
            "Design.replacing gives a design with another value, as in "
            'replacing({"reducer.eccentricity": "2 mm"}).'
        )


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
        number = whole_number(value)
        if number is None:
            raise ValueError(f"{shown(value)} is not {wanted}")
        if not self.low <= number <= self.high:
            nearest = self.low if number < self.low else self.high
            raise ValueError(f"{shown(number)} is not {wanted}; the nearest allowed is {nearest}")
        return number

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
        number = real_number(value)
        if number is None:
            raise ValueError(f"{shown(value)} is not {wanted}")
        if not self.low <= number <= self.high:
            nearest = self.high if number > self.high else self.low
            raise ValueError(f"{number:g} is not {wanted}; the nearest allowed is {nearest:g}")
        return number

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
MaterialOrAuto = Annotated[str, AfterValidator(_known(find_material, "auto"))]
MotorName = Annotated[str, AfterValidator(_known(find_bare_motor))]
BearingName = Annotated[str, AfterValidator(_known(find_bearing, "auto"))]
FinishName = Annotated[str, AfterValidator(_known(find_finish))]
LubricantName = Annotated[FreeText, AfterValidator(_known(find_lubricant))]
