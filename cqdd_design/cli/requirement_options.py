"""The options of ``size`` that are keys of ``[requirements]``: one row each, read by their key."""

from __future__ import annotations

import inspect
import keyword
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

from cqdd_design.cli.options import option, parse_option

if TYPE_CHECKING:
    pass


class _Row(NamedTuple):
    """A key, what its option's help says, and whether it is a pure number."""

    key: str
    help: str
    share: bool = False

    @property
    def argument(self) -> str:
        """The key as a name of Python."""
        return f"{self.key}_share" if keyword.iskeyword(self.key) else self.key

    @property
    def flag(self) -> str:
        """As it is typed."""
        return f"--{self.key.replace('_', '-')}"


_ROWS = (
    _Row("peak_torque", "At the output; default what the motor reaches at rest."),
    _Row(
        "continuous_torque",
        "At the output; default what the motor holds for ever, 0.38 of a stated peak at most.",
    ),
    _Row("input_speed", 'Default "1286 rpm".'),
    _Row(
        "continuous_speed",
        'Of the input, under the continuous torque; default --input-speed, or "300 rpm" where '
        "neither that torque nor a speed is stated.",
    ),
    _Row("speed_at_peak", "Of the output, up to which the peak torque is reached."),
    _Row("shock_speed", "Of the output, when it meets a rigid stop."),
    _Row("life", 'At the continuous torque or over the duty; default "1000 h".'),
    _Row("outer_diameter", 'Of the ring; default "72 mm".'),
    _Row("length", 'Of the disc pack; default "20 mm".'),
    _Row("bore", "Through the middle, at least."),
    _Row("mass", "Of the actuator, at most."),
    _Row("reflected_inertia", "Felt at the output, at most."),
    _Row("backlash", 'Of 95 % of gearboxes, at most, as in "6 arcmin".'),
    _Row("lost_motion", "At 3 % of the continuous torque, at most."),
    _Row("stiffness", 'At the output, at least, as in "10 N*m/arcmin".'),
    _Row("efficiency", "At least, as in 0.8.", share=True),
    _Row("surface_temperature", "Of the housing outside, at most."),
    _Row("external_moment", "Tilting the output from outside."),
    _Row("external_axial", "Force along the output's axis from outside."),
    _Row("external_radial", "Force across it."),
    _Row("voltage", "Of the supply there is."),
    _Row("current", "Of the motor, at most."),
    _Row("yield", "Share of gearboxes that meet all of it; default 0.95.", share=True),
)


def with_requirements(function: Callable[..., int]) -> Callable[..., int]:
    """Give a command an option for every requirement, after its first own, in its ``**asked``."""
    signature = inspect.signature(function, eval_str=True)
    kind = inspect.Parameter.KEYWORD_ONLY
    out, *own = (one for one in signature.parameters.values() if one.kind is not one.VAR_KEYWORD)
    first, *others = (one.replace(kind=kind) for one in own)
    added = [
        inspect.Parameter(row.argument, kind, default=None, annotation=_annotation(row))
        for row in _ROWS
    ]
    function.__signature__ = signature.replace(  # type: ignore[attr-defined]
        parameters=[out, first, *added, *others]
    )
    return function


def _annotation(row: _Row) -> Any:
    if row.share:
        return Annotated[float | None, option("X", row.help, row.flag)]
    return Annotated[str | None, option("Q", row.help, row.flag)]


def stated(asked: Mapping[str, Any]) -> dict[str, Any]:
    """The requirements that were given, by key; their units can be read.

    Raises
    ------
    UsageError
        Naming the option and the right form, for a text that is no such quantity.
    """
    from cqdd_design.design import Requirements
    from cqdd_design.design.tables import field_dimension

    given = {row: asked[row.argument] for row in _ROWS if asked[row.argument] is not None}
    for row, text in given.items():
        dimension = field_dimension(Requirements.model_fields[row.argument])
        if dimension is not None:
            parse_option(row.flag, text, dimension)
    return {row.key: value for row, value in given.items()}
