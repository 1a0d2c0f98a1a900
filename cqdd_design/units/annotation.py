"""The pydantic annotation of a field that holds a quantity."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from cqdd_design.errors import DesignError
from cqdd_design.units.dimensions import Dimension
from cqdd_design.units.plain import real_number
from cqdd_design.units.quantities import format_quantity, parse_quantity, read_quantity

if TYPE_CHECKING:
    from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
    from pydantic_core import CoreSchema


@dataclass(frozen=True)
class QuantityIn:
    """Pydantic annotation: a bounded quantity, read from a unit string and held as an SI float.

    A bare number is refused with the right form shown, unless the validation context says
    ``{"si": True}``, which is how the package's own code builds designs.

    Attributes
    ----------
    dimension : Dimension
        What the field holds.
    low, high : str
        Unit strings of the least and the most allowed, both included.
    reason : str
        Why these bounds; part of the error message.
    """

    dimension: Dimension
    low: str
    high: str
    reason: str

    def _validate(self, value: object, info: Any) -> float:
        bare = real_number(value)
        if bare is not None and info.context is not None and info.context.get("si"):
            return self._bounded(bare)
        try:
            return self._bounded(read_quantity(value, self.dimension))
        except DesignError as error:
            raise ValueError(str(error)) from None

    def _bounded(self, value: float) -> float:
        least = parse_quantity(self.low, self.dimension)
        most = parse_quantity(self.high, self.dimension)
        slack = 1e-12 * max(abs(least), abs(most))
        if least - slack <= value <= most + slack:
            return value
        nearest = self.high if value > most else self.low
        shown = format_quantity(value, self.dimension) if math.isfinite(value) else str(value)
        raise ValueError(
            f"{shown} is outside {self.low} to {self.high} ({self.reason}); "
            f"the nearest allowed is {nearest}"
        )

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Validate strings before pydantic's own float checks (bounds come after)."""
        from pydantic_core import core_schema

        return core_schema.with_info_before_validator_function(
            self._validate,
            core_schema.float_schema(allow_inf_nan=False),
            serialization=core_schema.plain_serializer_function_ser_schema(
                lambda value: format_quantity(value, self.dimension), when_used="json"
            ),
        )

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """A string with a pattern and an example, for editors."""
        return {
            "type": "string",
            "pattern": r"^\s*[+-]?[0-9.]+([eE][+-]?[0-9]+)?\s*\S.*$",
            "description": f"{self.dimension.name} from {self.low} to {self.high}: {self.reason}",
            "examples": [f"1 {self.dimension.unit}"],
        }
