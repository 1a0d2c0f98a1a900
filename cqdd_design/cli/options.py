"""Parsing of what people type: ratios, quantities, lists, file names."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cqdd_design.cli import completion
from cqdd_design.errors import UsageError
from cqdd_design.library.calls import names, si_value

if TYPE_CHECKING:
    from cqdd_design.units import Dimension


def option(metavar: str, text: str, *names: str, **more: Any) -> Any:
    """An option, called like its argument unless named: what stands for its value, and its help.

    The shell offers the choices of a metavar such as ``iso|sodick``.
    """
    more.setdefault("autocompletion", completion.choices(metavar))
    return typer.Option(*names, metavar=metavar, help=text, **more)


def quantity_option(text: str) -> Any:
    """Option of a number with its unit."""
    return option("Q", text)


def count_option(text: str, least: int = 1) -> Any:
    """Option of a whole number."""
    return option("N", text, min=least)


DesignFile = Annotated[
    Path,
    typer.Argument(metavar="DESIGN", help="Design file (TOML).", autocompletion=completion.designs),
]
Force = Annotated[bool, typer.Option("--force", help="Replace files that exist.")]
Calibrated = Annotated[
    Path | None,
    typer.Option("--calibration", metavar="FILE", help="Factors that `calibrate` wrote."),
]
NamedMotor = Annotated[
    str | None,
    option(
        "NAME",
        "Motor of the catalogue, instead of all that the design's [motor] says of one.",
        "--motor",
        autocompletion=completion.motors,
    ),
]
OwnMotor = Annotated[
    Path | None,
    option(
        "FILE",
        "TOML of a motor's keys, over the design's [motor] and the catalogue.",
        "--motor-file",
    ),
]
Duty = Annotated[
    Path | None,
    typer.Option(
        "--duty", metavar="FILE", help="Duty over time (CSV) instead of the design's; see docs."
    ),
]
DutyColumnNames = Annotated[
    str | None,
    typer.Option(
        "--duty-columns",
        metavar="MAP",
        help='Of --duty, where headings do not say, as in "time=t [ms],torque=tau [N*m]".',
    ),
]
Supply = Annotated[str | None, quantity_option("Supply; default that of the design.")]
BenchSupply = Annotated[str | None, quantity_option('Supply of the dynamic rows; default "24 V".')]
RigStiffness = Annotated[
    str | None,
    quantity_option(
        'Of what holds the output for the torque bandwidth, as in "8000 N*m/rad"; default a torque '
        "sensor's."
    ),
]
BenchSeed = Annotated[
    int | None, option("N", "Of one drawn gearbox; default perfect parts.", min=0)
]


def parse_ratio(text: str) -> int:
    """The whole ratio of ``--ratio``.

    Raises
    ------
    UsageError
        With the range and the nearest ratio, for anything else.
    """
    from cqdd_design.design.requirements import LEAST_RATIO, MOST_RATIO

    allowed = (
        f"a reduction is the number of lobes on the disc, "
        f"a whole number from {LEAST_RATIO} to {MOST_RATIO}"
    )
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if math.isnan(value):
        raise UsageError(f"--ratio {text} is not a number; {allowed}, such as --ratio 10.")
    nearest = min(max(value, LEAST_RATIO), MOST_RATIO)
    if value < 0.0:
        raise UsageError(
            f"--ratio {text} is negative; {allowed}, written without the sign of the reversed "
            f"output; the nearest is {min(max(round(-value), LEAST_RATIO), MOST_RATIO)}."
            if math.isfinite(value)
            else f"--ratio {text} is not finite; {allowed}; the nearest is {LEAST_RATIO}."
        )
    if nearest != value:
        raise UsageError(f"--ratio {text} is out of range; {allowed}; the nearest is {nearest}.")
    if value != math.floor(value):
        below = math.floor(value)
        raise UsageError(
            f"--ratio {text} is not whole; {allowed}; the nearest are {below} and {below + 1}."
        )
    return int(value)


def parse_option(name: str, text: str | None, dimension: Dimension) -> float | None:
    """The SI value of a quantity option, or None when it was not given.

    Raises
    ------
    UsageError
        Naming the option and the right form.
    """
    return si_value(name, text, dimension)


def parse_positive(name: str, text: str | None, dimension: Dimension) -> float | None:
    """As `parse_option`, refusing zero and less."""
    return si_value(name, text, dimension, positive=True)


def parse_whole_list(name: str, text: str, count: int, example: str) -> tuple[int, ...]:
    """A fixed number of comma-separated whole numbers above zero."""
    parts = [part.strip() for part in text.split(",")]
    if len(parts) != count or not all(part.isdecimal() and int(part) > 0 for part in parts):
        raise UsageError(
            f"{name} {text!r} must be {count} whole numbers with commas, such as {example}."
        )
    return tuple(int(part) for part in parts)


def parse_names(text: str | None) -> tuple[str, ...]:
    """Names separated by commas; none for None."""
    return names("names", text or "", "mass")
