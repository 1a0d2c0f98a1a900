"""Sheets of all made parts: PDF, SVG and DXF of each, and of the machine put together.

::

    <out>/sheets/<name>-disc.pdf             cut sheets of discs and ring
                 <name>-eccentric-shaft.pdf  turned parts
                 <name>-assembly.pdf         section with balloons, parts list, order of assembly
                 ... and .svg and .dxf of each
"""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

from cqdd_design.exporting.edm.cut_facts import facts_of
from cqdd_design.exporting.edm.dxf import add_classes, reproducible
from cqdd_design.exporting.edm.flat_parts import flat_parts
from cqdd_design.exporting.sheets.formats import A3, LEAST_SCALE, scale_words
from cqdd_design.files import WrittenFile, file_label, write_atomically

if TYPE_CHECKING:
    from collections.abc import Iterator

    from cqdd_design.exporting.job import ExportJob
    from cqdd_design.exporting.sheets.drawing import SheetDrawing

FOLDER = "sheets"


def export_sheets(job: ExportJob) -> tuple[WrittenFile, ...]:
    """Write the sheets of a machine into ``sheets/``."""
    files: list[WrittenFile] = []
    for number, title, sheet in sheets_of(job):
        if sheet.paper != A3 or sheet.scale < LEAST_SCALE:
            job.progress(f"{number} stands on {sheet.paper.name} at {scale_words(sheet.scale)}")
        files += _written(job, number, title, sheet)
    return tuple(files)


def sheets_of(job: ExportJob) -> Iterator[tuple[str, str, SheetDrawing]]:
    """File name, title and drawing of every sheet, in the order of the parts."""
    from cqdd_design.exporting.sheets.assembly_facts import AssemblyFacts
    from cqdd_design.exporting.sheets.assembly_sheet import draw_assembly
    from cqdd_design.exporting.sheets.cut_sheet import draw_cut_sheet
    from cqdd_design.exporting.sheets.part_facts import PartFacts
    from cqdd_design.exporting.sheets.part_sheet import draw_part

    flat = {one.label: one for one in flat_parts(job.machine)}
    for part in job.parts:
        if part.source != "make":
            continue
        label = file_label(part.name)
        if label in flat:
            facts = facts_of(flat[label], job.machine, job.options)
            yield f"{job.design.file_name}-{label}", "cut sheet", draw_cut_sheet(facts)
        else:
            made = PartFacts(part, job.design)
            yield made.number, "sheet of the part", draw_part(made)
    whole = AssemblyFacts(job.machine)
    yield whole.number, "assembly", draw_assembly(whole)


def twins(sheet: SheetDrawing, named: str) -> dict[str, str | bytes]:
    """The same sheet in every format, by the ending of its file; `named` is its title."""
    from cqdd_design.exporting.sheets.canvas import pdf_bytes, render, svg_text

    with reproducible():
        canvas = render(sheet)
        sheet.name_font()
        add_classes(sheet.drawing)
        text = io.StringIO()
        sheet.drawing.write(text)
    return {
        "pdf": pdf_bytes(canvas, named),
        "svg": svg_text(canvas, named),
        "dxf": text.getvalue(),
    }


def _written(job: ExportJob, number: str, title: str, sheet: SheetDrawing) -> list[WrittenFile]:
    stem = job.folder / FOLDER / number
    return [
        write_atomically(stem.with_name(f"{number}.{ending}"), content, "sheets")
        for ending, content in twins(sheet, f"{number}: {title}").items()
    ]
