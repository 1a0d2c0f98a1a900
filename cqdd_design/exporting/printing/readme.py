"""README.txt of the package of printed parts, plain ASCII, lines of at most 78."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from cqdd_design.catalog import find_material
from cqdd_design.files import ascii_text
from cqdd_design.solids.features.kinds import fit_label
from cqdd_design.version import __version__

if TYPE_CHECKING:
    from cqdd_design.design import Design
    from cqdd_design.exporting.printing.coupon import Coupon
    from cqdd_design.exporting.printing.printed_part import PrintedPart

_MM, _UM = 1e3, 1e6
_WIDTH = 78


def readme_text(design: Design, parts: Sequence[PrintedPart], tests: Sequence[Coupon]) -> str:
    """Return the README of a package; `tests` are none where no fit goes on a coupon."""
    title = f"{design.file_name}: printed and moulded parts"
    lines = [title, "=" * len(title), ""]
    lines += _wrapped(
        "All files are in millimetres, each part in its own frame with its axis upright. STEP, STL "
        "and 3MF of a part are compensated as below: send them as they are, without a scale or a "
        "hole compensation of the slicer on top. Drawn sizes are those of the STEP of the machine."
    )
    lines += [""]
    lines += _wrapped(
        "Seats come out at their nominal size with no stock on them. A printer misses the zones of "
        "the fits below: what is left of a hole is reamed, of an outside turned; what is too small "
        "by then goes in with retaining compound, or is printed again by an outside_error (or a "
        "hole_error) that leaves stock, see the test coupon. Threads that no insert takes, such "
        "as the bearing nut's, are cut on a lathe and are not in these files."
    )
    for one in parts:
        lines += ["", *_heading(f"{design.file_name}, {one.drawn.name}"), *_part(one)]
    several = len({one.material.material for one in parts}) > 1
    for test in tests:
        lines += ["", *_heading(f"Test coupon of {test.part.material}")]
        lines += _coupon(design, test, several=several)
    if not tests:
        lines += ["", *_heading("Test coupon")]
        lines += _wrapped("No fit of the design is of a size that goes on a coupon.")
    lines += ["", f"Design {design.sha256[:16]}, cqdd-design {__version__}.", ""]
    return "\n".join(lines)


def _heading(text: str) -> list[str]:
    return [text, "-" * len(text)]


def _wrapped(text: str, indent: str = "") -> list[str]:
    plain = ascii_text(text)
    return textwrap.wrap(plain, _WIDTH, initial_indent=indent, subsequent_indent=" " * len(indent))


def _part(one: PrintedPart) -> Iterator[str]:
    part, material, by = one.drawn, one.material, one.by
    yield from _wrapped(f"Quantity {part.count}, {material.material}, {material.process}.", "- ")
    source = "measured" if by.measured else f"nothing measured yet; {material.source}"
    holes, outsides = (0.0 - _UM * error for error in (by.hole_error, by.outside_error))
    yield from _wrapped(
        f"Scaled by {by.scale:.5f} for a shrinkage of {100.0 * by.shrinkage:g} %, holes drawn "
        f"{holes:+.4g} um and outsides {outsides:+.4g} um on the "
        f"diameter ({source}).",
        "- ",
    )
    for threads in one.threads:
        yield from _wrapped(f"Threads {threads}.", "- ")
    wall = one.wall
    if wall is not None:
        thin = wall.thickness < material.least_wall - 1e-9
        least = f"{_MM * material.least_wall:g} mm, the least of the material"
        yield from _wrapped(
            f"Thinnest wall between holes {_MM * wall.thickness:.3g} mm ({wall.between}), "
            + (f"BELOW {least}: it may not be filled." if thin else f"above {least}."),
            "- ",
        )
    hottest = find_material(part.material).service_limit
    told = "no temperature up to which it keeps its shape is known"
    if hottest is not None:
        told = f"it keeps strength and shape up to {hottest:g} degC"
    yield from _wrapped(f"{told[0].upper()}{told[1:]}.", "- ")
    if find_material(part.material).creep_modulus is None:
        yield from _wrapped(
            "How it creeps is not known: hold no torque for long, and tighten screws again.", "- "
        )
    for fit in part.fits:
        yield from _wrapped(f"Fit: {fit_label(fit)}; finished as told above.", "- ")


def _coupon(design: Design, test: Coupon, *, several: bool) -> Iterator[str]:
    material = test.part.material
    sizes = ", ".join(f"{_MM * size:g}" for size in test.sizes)
    yield from _wrapped(
        f"{design.file_name}-{test.label}.step and .3mf hold bores and pins of {sizes} mm, each in "
        "a row: the number at the left is the nominal diameter, those below are by how many "
        "hundredths of a millimetre each is drawn larger. Nothing in it is compensated. Print it "
        f"as the parts of {material} will be, same layers and speed, and let it cool.",
    )
    if test.left_out:
        left = ", ".join(f"{_MM * size:g}" for size in test.left_out)
        yield from _wrapped(f"Not on it, for their size or number: fits of {left} mm.")
    yield from _wrapped(
        f"Measure the plate first, drawn {_MM * test.length:.2f} mm long: shrinkage is 1 less "
        "measured over drawn. It takes its share of bores and pins too, which counts once: of "
        f"bores, drawn {_MM * test.mean_hole:.3f} mm in the mean, and pins, drawn "
        f"{_MM * test.mean_pin:.3f} mm, the errors are the mean of all as measured less "
        "(1 - shrinkage) times that. Or try bearings and pins: where the bore drawn +20 takes what "
        "belongs into it, holes come out 200 um small, and hole_error is shrinkage times the "
        "diameter less 200 um.",
    )
    yield from (
        "",
        "    [printing]",
        *([f'    material = "{material}"'] if several else []),
        '    hole_error = "-120 um"      # measured less drawn and shrunk, on the diameter',
        '    outside_error = "60 um"',
        "    shrinkage = 0.003",
    )
    yield ""
    if several:
        yield from _wrapped(
            "Of each further plastic the same stands in a table [[printing.others]] of its own; "
            "parts of one that is not there are made by the catalogue's shrinkage."
        )
    yield from _wrapped("Then export again: files take it off, and this text says so.")
