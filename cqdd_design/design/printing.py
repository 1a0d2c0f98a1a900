"""The table [printing] of a design file: what a printer was measured to do."""

from __future__ import annotations

from typing import Annotated

from cqdd_design.design.fields import FrozenModel, MaterialName, Share, default
from cqdd_design.units import SMALL_LENGTH, QuantityIn

_Error = Annotated[
    float,
    QuantityIn(
        SMALL_LENGTH, "-1000 um", "1000 um", "measured less drawn and shrunk, on the diameter"
    ),
]


class PrintedErrors(FrozenModel):
    """A printer and a plastic as a test coupon shows them.

    `hole_error` and `outside_error` are diameters as measured less what the shrinkage alone leaves
    of those of the file, which files of printed parts are then corrected by; `shrinkage` is the
    share by which long dimensions come out short, that of the material where it is left out.
    """

    hole_error: _Error = default("0 um")
    outside_error: _Error = default("0 um")
    shrinkage: Annotated[float, Share(0.0, 0.05, "a share of every length")] | None = None


class OtherPlastic(PrintedErrors):
    """The same of another plastic of the design."""

    material: MaterialName


class Printing(PrintedErrors):
    """What a coupon of `material` showed, and those of `others`.

    Without a `material` it is the plastic that most parts are of.
    """

    material: MaterialName | None = None
    others: tuple[OtherPlastic, ...] = ()
