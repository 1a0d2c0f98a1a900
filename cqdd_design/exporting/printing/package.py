"""Files of printed and moulded parts: STEP, STL and 3MF as they are made, and a test coupon.

::

    <out>/print/<name>-disc.step   .stl   .3mf     of every part of plastic, compensated
                <name>-coupon.step .3mf            to be measured, not compensated; of several
                                                   plastics one each, coupon-abs
                README.txt                         what was done to the parts, and what is left
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from cqdd_design.catalog.printing import printed_materials
from cqdd_design.errors import DesignError
from cqdd_design.exporting.printing.compensate import compensated, compensation
from cqdd_design.exporting.printing.coupon import Coupon, coupon
from cqdd_design.exporting.printing.printed_part import PrintedPart
from cqdd_design.exporting.printing.readme import readme_text
from cqdd_design.exporting.printing.threads import with_inserts
from cqdd_design.exporting.solids.meshes import write_3mf, write_stl
from cqdd_design.exporting.solids.step import write_part_step
from cqdd_design.files import WrittenFile, file_label, write_atomically
from cqdd_design.solids.part import on_axis
from cqdd_design.solids.poses import HOUSING
from cqdd_design.solids.walls import least_walls

if TYPE_CHECKING:
    from cqdd_design.design import Design
    from cqdd_design.design.printing import PrintedErrors
    from cqdd_design.exporting.job import ExportJob
    from cqdd_design.machine import Machine
    from cqdd_design.solids.part import Part

FOLDER = "print"


def export_print(job: ExportJob) -> tuple[WrittenFile, ...]:
    """Write the package of a design into ``print/``.

    Raises
    ------
    DesignError
        When nothing is made of a plastic whose printing or moulding is known.
    """
    every = printed_parts(job.machine, job.parts)
    if not every:
        raise _no_plastic(job.design)
    files: list[WrittenFile] = []
    for one in every:
        piece = replace(one.made, instances=on_axis(one.made.name, HOUSING))
        files += _files(job, piece, file_label(piece.name), stl=True)
    tests = coupons_of(every)
    for test in tests:
        files += _files(job, test.part, test.label, stl=False)
    readme = job.folder / FOLDER / "README.txt"
    text = readme_text(job.design, every, tests)
    return (*files, write_atomically(readme, text, "print"))


def refuse_metal(machine: Machine) -> None:
    """Raise the DesignError of :func:`export_print` where the design names no such plastic."""
    reducer = machine.design.reducer
    named = {
        reducer.disc_material,
        reducer.ring_material,
        reducer.output_pins.material,
        machine.design.housing.material,
    }
    if named.isdisjoint(printed_materials()):
        raise _no_plastic(machine.given)


def _no_plastic(design: Design) -> DesignError:
    known = ", ".join(f"'{name}'" for name in list(printed_materials())[:4])
    return DesignError(
        f"{design.file_name}: no part is of a plastic to be printed or moulded; set "
        f"reducer.disc_material, reducer.ring_material or housing.material to one, such as "
        f"{known}."
    )


def printed_parts(machine: Machine, parts: Iterable[Part]) -> tuple[PrintedPart, ...]:
    """Those of the parts of a machine that are of a plastic to be printed or moulded.

    Raises
    ------
    DesignError
        When [printing] names a plastic that none of them is of, or one twice.
    """
    plastics, found = printed_materials(), []
    printed = [part for part in parts if part.material in plastics and part.source == "make"]
    measured = _measured(machine.design, [part.material for part in printed])
    for part in printed:
        material = plastics[part.material]
        by = compensation(material, measured.get(part.material))
        bored, threads = with_inserts(part, material.least_wall)
        # Threads are as wide as they will be; an insert's hole is wider.
        walls = least_walls([replace(bored, stated=part.stated)])
        found.append(
            PrintedPart(
                part, compensated(bored, by), by, material, threads, walls[0] if walls else None
            )
        )
    return tuple(found)


def _measured(design: Design, names: Sequence[str]) -> dict[str, PrintedErrors]:
    """What was measured, by the plastic it was measured of, of parts of plastics `names`."""
    printing = design.printing
    if printing is None or not names:
        return {}
    usual = max(names, key=names.count)
    found: dict[str, PrintedErrors] = {printing.material or usual: printing}
    for one in printing.others:
        if one.material in found:
            raise DesignError(
                f"{design.file_name}: [printing] has '{one.material}' twice; each plastic stands "
                "there once, the one without a name being the plastic that most parts are of."
            )
        found[one.material] = one
    for name in found:
        if name not in names:
            raise DesignError(
                f"{design.file_name}: [printing] names '{name}', and no printed part is of that; "
                f"they are of {', '.join(sorted(set(names)))}."
            )
    return found


def coupons_of(every: Sequence[PrintedPart]) -> tuple[Coupon, ...]:
    """A coupon of every plastic that has a fit for one, that of most parts first."""
    names = [one.material.material for one in every]
    tests = []
    for name in sorted(set(names), key=lambda name: (-names.count(name), names.index(name))):
        parts = [one.drawn for one in every if one.material.material == name]
        label = f"coupon-{file_label(name)}" if len(parts) < len(names) else "coupon"
        tests.append(coupon(parts, name, label))
    return tuple(one for one in tests if one is not None)


def _files(job: ExportJob, part: Part, label: str, *, stl: bool) -> list[WrittenFile]:
    def path(ending: str) -> Path:
        return job.path(f"-{label}{ending}", FOLDER)

    files = [
        write_part_step(job.design, part, path(".step"), job.options.step_schema),
        write_3mf(job.design, [part], path(".3mf")),
    ]
    return [*files, write_stl(part, path(".stl"))] if stl else files
