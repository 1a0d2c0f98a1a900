"""How files are written: dialects, styles and the few sizes that a shop may want otherwise."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

from cqdd_design.errors import UsageError, did_you_mean

if TYPE_CHECKING:
    from cqdd_design.exporting.bill.prices import PriceList

CHOICES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "dxf_version": ("R12", "R2000", "R2010"),
        "dxf_style": ("polyline", "entities"),
        "step_schema": ("AP214", "AP242"),
        "gcode_dialect": ("iso", "sodick"),
    }
)
"""What each option may be, the default among them."""


class Read(NamedTuple):
    """What an option of `export` does, and the kinds of file that read it."""

    does: str
    kinds: tuple[str, ...]


_SIMULATORS = ("mjcf", "urdf", "card", "bam")
READ_BY: Mapping[str, Read] = MappingProxyType(
    {
        "dxf_version": Read("chooses the dialect of DXF", ("dxf", "edm")),
        "dxf_style": Read("chooses how DXF draws contours", ("dxf", "edm")),
        "step_schema": Read("chooses the protocol of STEP", ("step", "print")),
        "gcode_dialect": Read("chooses the dialect of G-code", ("gcode", "edm")),
        "passes": Read("counts the cuts of a wire program", ("gcode", "edm")),
        "tab_length": Read("is what a wire leaves uncut", ("dxf", "edm", "gcode", "sheets")),
        "prices": Read("fills in the bill of materials", ("bom",)),
        "seed": Read("draws the gearbox of a simulator", _SIMULATORS),
        "calibration": Read("fits the actuator of a simulator", _SIMULATORS),
    }
)
"""Who reads which option; what no kind of file reads that is asked for is refused."""

MOST_PASSES = 4
LEAST_TAB, MOST_TAB = 0.1e-3, 50e-3
"""Between these a tab holds a slug and is still a tab, m."""


@dataclass(frozen=True)
class ExportOptions:
    """Choices that no design makes: how its files are written.

    Attributes
    ----------
    dxf_version : str
        ``R12`` (polylines with bulges, no units in the header), ``R2000`` (the oldest dialect with
        light-weight polylines) or ``R2010``.
    dxf_style : str
        ``polyline``: each contour is one closed entity; ``entities``: lines and arcs end to end,
        for controls that chain them by themselves.
    step_schema : str
        ``AP214`` or ``AP242``.
    gcode_dialect : str
        ``iso``: offsets D, set on the control, and subprograms by O numbers; ``sodick``: offsets
        H, set in the program, and subprograms by N numbers.
    passes : int
        Of the wire along every contour, the rough cut among them, 1 to 4.
    tab_length : float
        Of every contour, left uncut in G-code until the slug or the part is held, m. Contours
        shorter than eight tabs get an eighth of their length.
    prices : PriceList or None
        What parts cost, for the bill of materials.

    Raises
    ------
    UsageError
        For a value that is not among the choices.
    """

    dxf_version: str = "R2000"
    dxf_style: str = "polyline"
    step_schema: str = "AP214"
    gcode_dialect: str = "iso"
    passes: int = 4
    tab_length: float = 3e-3
    prices: PriceList | None = None

    def __post_init__(self) -> None:
        """Refuse what no writer knows."""
        for field, choices in CHOICES.items():
            value = getattr(self, field)
            if value not in choices:
                option = "--" + field.replace("_", "-")
                hint = did_you_mean(str(value), choices) or "."
                raise UsageError(
                    f"{option} cannot be '{value}'{hint} The choices are {', '.join(choices)}."
                )
        if not 1 <= self.passes <= MOST_PASSES:
            raise UsageError(
                f"--passes {self.passes} is outside 1 to {MOST_PASSES}; the nearest is "
                f"{min(max(self.passes, 1), MOST_PASSES)}."
            )
        if not (math.isfinite(self.tab_length) and LEAST_TAB <= self.tab_length <= MOST_TAB):
            nearest = LEAST_TAB if self.tab_length < LEAST_TAB else MOST_TAB
            raise UsageError(
                f"--tab-length {self.tab_length * 1e3:g} mm is outside {LEAST_TAB * 1e3:g} mm to "
                f"{MOST_TAB * 1e3:g} mm; the nearest is {nearest * 1e3:g} mm."
            )

    def arguments(self) -> list[str]:
        """These options as arguments of the command line."""
        return [
            *("--dxf-version", self.dxf_version),
            *("--dxf-style", self.dxf_style),
            *("--step-schema", self.step_schema),
            *("--gcode-dialect", self.gcode_dialect),
            *("--passes", str(self.passes)),
            *("--tab-length", f"{self.tab_length * 1e3!r} mm"),
            *(() if self.prices is None else ("--prices", str(self.prices.path))),
        ]


DEFAULTS = ExportOptions()
"""What files look like when nobody asks for anything else."""


def refuse_unread(kinds: Collection[str], options: ExportOptions, **others: object) -> None:
    """Refuse an option that is not at its default and that no kind of file reads.

    Parameters
    ----------
    kinds : collection of str
        That are asked for.
    options : ExportOptions
        How they are written.
    **others
        Options of `READ_BY` as given, that are none of `options` or not read yet; None where
        they are left out.

    Raises
    ------
    UsageError
        Naming the option, and the kinds that read it.
    """
    for name, read in READ_BY.items():
        value = others.get(name, getattr(options, name, None))
        usual = getattr(DEFAULTS, name, None)
        if value != usual and not set(read.kinds) & set(kinds):
            raise UsageError(
                f"--{name.replace('_', '-')} {read.does}; ask for it with --to "
                f"{' or '.join(read.kinds)}, or leave the option out."
            )
