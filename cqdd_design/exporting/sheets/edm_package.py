"""The wire-EDM package: DXF with the path of the wire, cut sheets, and a README for the shop.

::

    <out>/edm/<name>-disc.dxf    contours, path of the wire, lead-ins
              <name>-disc.pdf    cut sheet
              <name>-disc.svg    the same
              <name>-ring. ...
              README.txt         files, order of cuts, tolerances, what to mark
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cqdd_design.exporting.edm.cut_facts import CutFacts, facts_of
from cqdd_design.exporting.edm.dxf import reproducible, write_flat_part
from cqdd_design.exporting.edm.flat_parts import flat_parts
from cqdd_design.exporting.edm.gcode import FOLDER
from cqdd_design.exporting.sheets.edm_readme import readme_text
from cqdd_design.files import WrittenFile, write_atomically

if TYPE_CHECKING:
    from cqdd_design.exporting.job import ExportJob

README = "README.txt"


def export_edm(job: ExportJob) -> tuple[WrittenFile, ...]:
    """Write the package of a design into ``edm/``."""
    files: list[WrittenFile] = []
    parts: list[CutFacts] = []
    for flat in flat_parts(job.machine):
        facts = facts_of(flat, job.machine, job.options)
        path = job.path(f"-{flat.label}.dxf", FOLDER)
        files.append(write_flat_part(flat, job.design, path, job.options, wire=facts.paths))
        files += _sheets(job, facts)
        parts.append(facts)
    readme = job.folder / FOLDER / README
    files.append(write_atomically(readme, readme_text(parts, job.options), "edm"))
    return tuple(files)


def _sheets(job: ExportJob, facts: CutFacts) -> list[WrittenFile]:
    """Write the cut sheet of a part as PDF and SVG."""
    from cqdd_design.exporting.sheets.canvas import pdf_bytes, svg_text
    from cqdd_design.exporting.sheets.cut_sheet import draw_sheet

    label = facts.flat.label
    title = f"{job.design.file_name}-{label}: cut sheet"
    with reproducible():
        canvas = draw_sheet(facts)
    return [
        write_atomically(job.path(f"-{label}.pdf", FOLDER), pdf_bytes(canvas, title), "edm"),
        write_atomically(job.path(f"-{label}.svg", FOLDER), svg_text(canvas, title), "edm"),
    ]
