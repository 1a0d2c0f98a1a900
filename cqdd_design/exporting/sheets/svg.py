"""Front views as SVG, true to scale: every flat part, and the mechanism put together.

The drawing plane is the ring's frame seen from the output, y up, 1 user unit = 1 mm. The mechanism
stands at crank angle 0, the eccentric of disc 1 on +x; discs behind it are drawn first.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape

import numpy as np

from cqdd_design.catalog.screws import column_screw
from cqdd_design.exporting.edm.flat_parts import (
    FlatPart,
    disc_shape,
    flat_parts,
    pin_diameter,
    reach_of,
)
from cqdd_design.exporting.sheets.lettering import short_number
from cqdd_design.files import WrittenFile, write_atomically
from cqdd_design.geometry.columns import column_offsets
from cqdd_design.geometry.contours import Circle, Contour, PlanarPart, as_points
from cqdd_design.geometry.disc import crank_phase
from cqdd_design.geometry.ring import ring_contour, ring_pins

if TYPE_CHECKING:
    from cqdd_design.design import Design
    from cqdd_design.exporting.job import ExportJob
    from cqdd_design.machine import Machine

STYLE = """\
.part { fill-rule: evenodd; stroke: #22303c; stroke-width: 0.25; }
.ring { fill: #c9d3dc; }
.disc { fill: #e8b25a; fill-opacity: 0.85; }
.behind { fill: #b98a3e; }
.pin { fill: #f4f4f4; }
.bearing { fill: #dfe7ee; }
.cam { fill: #8fa3b3; }
.axis { stroke: #b03030; stroke-width: 0.2; stroke-dasharray: 4 1 0.8 1; fill: none; }
text { font: 3px sans-serif; fill: #22303c; }"""

_MM = 1e3
_MARGIN, _LINE = 4.0, 4.0


def export_svg(job: ExportJob) -> tuple[WrittenFile, ...]:
    """Write a front view of every flat part and ``<name>-front.svg`` of the mechanism."""
    views = [
        (job.path(f"-{flat.label}.svg"), part_view(flat, job.design))
        for flat in flat_parts(job.machine)
    ]
    views.append((job.path("-front.svg"), front_view(job.machine)))
    return tuple(write_atomically(path, text, "svg") for path, text in views)


def part_view(flat: FlatPart, design: Design) -> str:
    """Front view of one flat part, as SVG text."""
    kind = "ring" if flat.label == "ring" else "disc"
    shapes = [_part(flat.shape, kind), _axes(0j, reach_of(flat.shape.outer))]
    caption = (
        f"{design.file_name} {flat.label}, {flat.quantity} off",
        f"{flat.material}, {_MM * flat.thickness:g} mm thick",
    )
    return _document(shapes, reach_of(flat.shape.outer), caption)


def front_view(machine: Machine) -> str:
    """Front view of ring, discs, output pins and cam bearings, as SVG text."""
    design, bearing = machine.design, machine.cam
    reducer = design.reducer
    ring = ring_contour(design)
    shapes = [_part(ring, "ring")]
    shapes += [_part(PlanarPart("ring pin", pin), "pin") for pin in ring_pins(design)]
    for disc in reversed(range(reducer.disc_count)):
        phase = crank_phase(design, disc)
        centre = reducer.eccentricity * np.array([math.cos(phase), math.sin(phase)])
        placed = disc_shape(machine, disc).transformed(-phase / reducer.ratio, centre)
        shapes.append(_part(placed, "disc" if disc == 0 else "disc behind"))
        inside = (Circle(centre, bearing.bore_diameter / 2.0),)
        ball = PlanarPart("cam bearing", Circle(centre, bearing.outer_diameter / 2.0), inside)
        shapes += [_part(ball, "bearing"), _part(PlanarPart("cam", inside[0]), "cam")]
    shapes += [_part(PlanarPart("output pin", pin), "pin") for pin in _output_pins(design)]
    shapes += [_part(column, "pin") for column in _columns(design)]
    reach = reach_of(ring.outer)
    shapes += [_axes(0j, reach), _axes(complex(reducer.eccentricity), reach / 4.0)]
    caption = (
        f"{design.file_name}: {reducer.ratio} lobes in {reducer.ring_tooth_count} teeth",
        f"eccentricity {_MM * reducer.eccentricity:g} mm, "
        f"ring {_MM * reducer.ring.outer_diameter:g} mm outside",
    )
    return _document(shapes, reach, caption)


def _output_pins(design: Design) -> list[Circle]:
    """Output pins, each inside its sleeve where there are sleeves, at carrier angle 0."""
    pins = design.reducer.output_pins
    turns = pins.hole_clocking + 2.0 * math.pi * np.arange(pins.count) / pins.count
    centres = pins.circle_radius * np.stack([np.cos(turns), np.sin(turns)], axis=-1)
    sizes = [s for s in (pins.sleeve_diameter, pin_diameter(design)) if s > 0.0]
    return [Circle(centre, size / 2.0) for centre in centres for size in sizes]


def _columns(design: Design) -> list[PlanarPart]:
    """Columns over their screws, at carrier angle 0."""
    reducer = design.reducer
    diameter = reducer.carrier.column_diameter
    turns = reducer.output_pins.hole_clocking + column_offsets(reducer)
    centres = as_points(reducer.output_pins.circle_radius * np.exp(1j * turns))
    return [
        PlanarPart(
            "column",
            Circle(centre, diameter / 2.0),
            (Circle(centre, column_screw(diameter).bore / 2.0),),
        )
        for centre in centres
    ]


def _part(shape: PlanarPart, kind: str) -> str:
    outline = " ".join(path_data(contour) for contour in (shape.outer, *shape.holes))
    return f'<path class="part {kind}" d="{outline}"><title>{escape(shape.name)}</title></path>'


def path_data(contour: Contour) -> str:
    """SVG path of a contour in mm, y up: true arcs, closed."""
    if isinstance(contour, Circle):
        x, y = (_MM * float(v) for v in contour.centre)
        r = _MM * contour.radius
        half = f"A{_number(r)} {_number(r)} 0 0 1"
        return (
            f"M{_number(x + r)} {_number(y)}{half} {_number(x - r)} {_number(y)}"
            f"{half} {_number(x + r)} {_number(y)}Z"
        )
    points = _MM * contour.points
    steps = [f"M{_number(points[0, 0])} {_number(points[0, 1])}"]
    arcs = contour.arcs()
    ends = np.roll(points, -1, axis=0)
    for (x, y), radius, sweep in zip(ends, _MM * arcs.radii, arcs.sweeps, strict=True):
        target = f"{_number(x)} {_number(y)}"
        if sweep == 0.0:
            steps.append(f"L{target}")
        else:
            flags = f"{int(abs(sweep) > math.pi)} {int(sweep > 0.0)}"
            steps.append(f"A{_number(radius)} {_number(radius)} 0 {flags} {target}")
    return "".join([*steps, "Z"])


def _number(value: float) -> str:
    """Nanometres are enough for a picture."""
    return short_number(value, 6)


def _axes(centre: complex, reach: float) -> str:
    x, y, arm = _MM * centre.real, _MM * centre.imag, _MM * reach + _MARGIN / 2.0
    return (
        f'<path class="axis" d="M{_number(x - arm)} {_number(y)}H{_number(x + arm)}'
        f'M{_number(x)} {_number(y - arm)}V{_number(y + arm)}"/>'
    )


def _document(shapes: Iterable[str], reach: float, caption: tuple[str, str]) -> str:
    half = _MM * reach + _MARGIN
    width, height = 2.0 * half, 2.0 * half + 2.5 * _LINE
    body = "\n".join(shapes)
    lines = "\n".join(
        f'<text x="{_number(-half + _MARGIN)}" y="{_number(half + row * _LINE)}">'
        f"{escape(line)}</text>"
        for row, line in enumerate(caption, start=1)
    )
    return f"""\
<svg xmlns="http://www.w3.org/2000/svg" width="{_number(width)}mm" height="{_number(height)}mm" \
viewBox="{_number(-half)} {_number(-half)} {_number(width)} {_number(height)}">
<title>{escape(", ".join(caption))}</title>
<style>
{STYLE}
</style>
<g transform="scale(1 -1)">
{body}
</g>
{lines}
</svg>
"""
