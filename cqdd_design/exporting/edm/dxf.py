"""DXF for wire EDM: the nominal contour as one closed polyline of arcs, holes as true circles.

Layers: CUT_OUTER and CUT_INNER hold what is cut, START_HOLE where the wire is threaded, REF the
centre lines and pitch circle, NOTES the text. Units are millimetres, in the header (R12 has none
there) and in a note, because some controls read neither. No kerf offset in these layers: that is
the control's, by its own technology. Files of the EDM package have two more: WIRE_PATH, the path
of the wire's centre, and LEAD_IN, from each start hole onto it.

A file is read back from disk before it gets its name (`readback`); what was measured there stands
in its notes.
"""

from __future__ import annotations

import contextlib
import math
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.catalog import find_material
from cqdd_design.errors import ReadBackError
from cqdd_design.exporting.edm.flat_parts import FlatPart, flat_parts, reach_of
from cqdd_design.exporting.edm.loops import Loop, LoopFit, fit_of
from cqdd_design.exporting.edm.readback import (
    CUT_INNER,
    CUT_OUTER,
    LEAD_IN,
    MILLIMETRES,
    NOTES,
    START_HOLE,
    UNITS_NOTE,
    WIRE_PATH,
    read_back,
)
from cqdd_design.exporting.edm.start_holes import start_holes
from cqdd_design.exporting.options import DEFAULTS, ExportOptions
from cqdd_design.files import WrittenFile, write_with
from cqdd_design.geometry.contours import ArcContour, Circle, Contour, as_complex
from cqdd_design.version import __version__

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.layouts.layout import Modelspace

    from cqdd_design.design import Design
    from cqdd_design.exporting.edm.wire_path import WirePath
    from cqdd_design.exporting.job import ExportJob

REF = "REF"
LAYERS = {CUT_OUTER: 1, CUT_INNER: 5, START_HOLE: 3, REF: 8, NOTES: 7}
WIRE_LAYERS = {WIRE_PATH: 6, LEAD_IN: 4}
"""Layers and their AutoCAD colour numbers."""

_MM = 1e3
_TEXT_HEIGHT, _LINE_PITCH, _NOTE_GAP, _CROSS = 2.0, 3.5, 8.0, 4.0


def export_dxf(job: ExportJob) -> tuple[WrittenFile, ...]:
    """Write one DXF for every flat part of a design: ``<name>-disc.dxf``, ``<name>-ring.dxf``."""
    return tuple(
        write_flat_part(flat, job.design, job.path(f"-{flat.label}.dxf"), job.options)
        for flat in flat_parts(job.machine)
    )


def write_flat_part(
    flat: FlatPart,
    design: Design,
    path: Path,
    options: ExportOptions = DEFAULTS,
    *,
    wire: Sequence[WirePath] = (),
) -> WrittenFile:
    """Write one part, read it back, and put it in place only if it is the part.

    Parameters
    ----------
    path : Path
        Of the file.
    options : ExportOptions, optional
        Dialect and style.
    wire : sequence of WirePath
        Paths of the wire's centre to draw beside the contours.

    Raises
    ------
    ReadBackError
        When the written file does not measure up; no file is left then.
    """
    fit = contour_fit(flat)

    def write(temporary: Path) -> None:
        with reproducible():
            draw(flat, design, fit, options, wire=wire).saveas(temporary)
        back = read_back(temporary, flat, design.edm, options, wire_paths=bool(wire))
        found = back.largest_deviation
        if not math.isclose(found, fit.largest_deviation, rel_tol=1e-6, abs_tol=1e-12):
            raise ReadBackError(
                f"{flat.label}: the file measures {found * 1e6:.4g} um where its notes say "
                f"{fit.largest_deviation * 1e6:.4g} um."
            )

    return write_with(path, "dxf", write)


def contour_fit(flat: FlatPart) -> LoopFit:
    """Measure the contour of a part against its exact curve."""
    joints = as_complex(flat.fitted.points)
    loop = Loop(joints, np.roll(joints, -1), flat.fitted.bulges)
    return fit_of(loop, flat.exact, outer=flat.fitted is flat.shape.outer)


def draw(
    flat: FlatPart,
    design: Design,
    fit: LoopFit,
    options: ExportOptions = DEFAULTS,
    *,
    wire: Sequence[WirePath] = (),
) -> Drawing:
    """Draw a part in a new document; `fit` goes into its notes.

    Raises
    ------
    ReadBackError
        When the document does not pass the library's own audit.
    """
    from ezdxf.filemanagement import new

    drawing = new("R2000", setup=False, units=MILLIMETRES)
    drawing.dxfversion = options.dxf_version
    for name, colour in (LAYERS | (WIRE_LAYERS if wire else {})).items():
        drawing.layers.add(name, color=colour)
    space = drawing.modelspace()
    for number, contour in enumerate(flat.contours):
        _add_contour(space, contour, CUT_INNER if number else CUT_OUTER, options)
    starts = start_holes(flat, design.edm.wire_diameter, options.tab_length)
    for start in starts:
        _add_contour(space, start, START_HOLE, options)
    for path in wire:
        _add_contour(space, path.contour, WIRE_PATH, options)
        begin, end = ((_MM * at.real, _MM * at.imag) for at in (path.start, path.joint))
        space.add_line(begin, end, dxfattribs={"layer": LEAD_IN})
    reach = _MM * reach_of(flat.shape.outer)
    _add_reference(space, flat, reach)
    lines = note_lines(flat, design, fit, starts, wire)
    for number, line in enumerate(lines):
        place = (-reach, -reach - _NOTE_GAP - number * _LINE_PITCH)
        space.add_text(line, height=_TEXT_HEIGHT, dxfattribs={"layer": NOTES, "insert": place})
    bottom = -reach - _NOTE_GAP - len(lines) * _LINE_PITCH
    drawing.header["$EXTMIN"] = (-reach, bottom, 0.0)
    drawing.header["$EXTMAX"] = (reach, reach, 0.0)
    drawing.set_modelspace_vport(1.1 * (reach - bottom), (0.0, 0.5 * (reach + bottom)))
    if options.dxf_version == "R2010":
        add_classes(drawing)
    audit = drawing.audit()
    if audit.errors or audit.fixes:
        message = (audit.errors + audit.fixes)[0].message
        raise ReadBackError(f"{flat.label}: the DXF is not clean: {message}.")
    return drawing


def note_lines(
    flat: FlatPart,
    design: Design,
    fit: LoopFit,
    starts: Sequence[Circle],
    wire: Sequence[WirePath] = (),
) -> list[str]:
    """Return the notes of a file, one line each."""
    edm = design.edm
    rounds = [hole for hole in flat.shape.holes if isinstance(hole, Circle)]
    concave = min([fit.least_concave_radius, *(hole.radius for hole in rounds)])
    hardness = find_material(flat.material).hardness
    sizes = Counter(f"{2.0 * _MM * h.radius:.4f}" for h in rounds)
    holes = ", ".join(f"{count} x dia {size}" for size, count in sizes.items())
    start_sizes = sorted({f"{2.0 * _MM * s.radius:.2f}" for s in starts})
    return [
        f"PART {design.file_name}-{flat.label}",
        UNITS_NOTE,
        f"MATERIAL {flat.material}" + (f" ({hardness})" if hardness else ""),
        f"THICKNESS {_MM * flat.thickness:g}",
        f"QUANTITY {flat.quantity}",
        *flat.remarks,
        ("CUT_OUTER, CUT_INNER: " if wire else "")
        + "NOMINAL FINISHED CONTOUR, NO KERF OFFSET: THE CONTROL OFFSETS THE WIRE",
        *(
            [
                f"{WIRE_PATH}: CENTRE OF THE WIRE ON THE FINISHING CUT, OFFSET "
                f"{_MM * wire[0].offset:g} INTO THE WASTE; NO FURTHER OFFSET; {LEAD_IN} LEADS ON"
            ]
            if wire
            else []
        ),
        f"WIRE DIA {_MM * edm.wire_diameter:g}, SPARK GAP {_MM * edm.spark_gap:g}; "
        f"LEAST CONCAVE RADIUS {_MM * concave:.4f}",
        f"CONTOUR OF {fit.segments} ARCS, PROFILE TOLERANCE OF THIS FILE "
        f"{1e6 * edm.profile_tolerance:g} um",
        f"MEASURED AGAINST THE EXACT CURVE: LARGEST DEVIATION "
        f"{1e6 * fit.largest_deviation:.3f} um, RMS {1e6 * fit.rms_deviation:.3f} um",
        f"CONTOUR PERIMETER {_MM * fit.perimeter:.4f}, AREA {_MM**2 * fit.area:.4f} mm2",
        *([f"HOLES {holes}"] if holes else []),
        f"CUTS RUN COUNTER-CLOCKWISE; START HOLES DIA {', '.join(start_sizes)} ON {START_HOLE}",
        f"DESIGN {design.sha256[:16]}, CQDD-DESIGN {__version__}",
    ]


def _add_contour(space: Modelspace, contour: Contour, layer: str, options: ExportOptions) -> None:
    attributes = {"layer": layer}
    if isinstance(contour, Circle):
        x, y = (float(v) * _MM for v in contour.centre)
        space.add_circle((x, y), contour.radius * _MM, dxfattribs=attributes)
    elif options.dxf_style == "entities":
        _add_segments(space, contour, attributes)
    else:
        rows = [
            (float(x) * _MM, float(y) * _MM, float(bulge))
            for (x, y), bulge in zip(contour.points, contour.bulges, strict=True)
        ]
        if options.dxf_version == "R12":
            space.add_polyline2d(rows, format="xyb", close=True, dxfattribs=attributes)
        else:
            space.add_lwpolyline(rows, format="xyb", close=True, dxfattribs=attributes)


def _add_segments(space: Modelspace, contour: ArcContour, attributes: dict[str, str]) -> None:
    """Lines and arcs end to end; an arc of the format runs counter-clockwise, always."""
    ends = np.roll(contour.points, -1, axis=0)
    arcs = contour.arcs()
    for number, sweep in enumerate(arcs.sweeps):
        if sweep == 0.0:
            start, end = (tuple(float(v) * _MM for v in p[number]) for p in (contour.points, ends))
            space.add_line(start, end, dxfattribs=attributes)
            continue
        centre = tuple(float(v) * _MM for v in arcs.centres[number])
        from_angle = float(arcs.start_angles[number])
        low, high = sorted((from_angle, from_angle + float(sweep)))
        space.add_arc(
            centre,
            float(arcs.radii[number]) * _MM,
            math.degrees(low),
            math.degrees(high),
            dxfattribs=attributes,
        )


def _add_reference(space: Modelspace, flat: FlatPart, reach: float) -> None:
    attributes = {"layer": REF}
    arm = reach + _CROSS
    space.add_line((-arm, 0.0), (arm, 0.0), dxfattribs=attributes)
    space.add_line((0.0, -arm), (0.0, arm), dxfattribs=attributes)
    space.add_circle((0.0, 0.0), flat.reference_radius * _MM, dxfattribs=attributes)


def add_classes(drawing: Drawing) -> None:
    """Name the kinds of objects in a document, sorted, as its dialect wants from R2004.

    Left to itself the library names them in the order of a set, another in every process.
    """
    for kind in sorted(drawing.entitydb.dxf_types_in_use()):
        drawing.classes.add_class(kind)


@contextlib.contextmanager
def reproducible() -> Iterator[None]:
    """Make and write documents with fixed dates and identifiers: the same design, the same bytes.

    A document keeps the moment in which it was made, so it is to be made in here too.
    """
    from ezdxf._options import options

    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = before
