"""A sheet of drawing: what ezdxf's drawing add-on renders, kept as strokes, fills and text.

`Canvas` is a backend of that add-on, so dimensions, line types and hatches are ezdxf's own; only
text is caught before it becomes outlines. Both outputs are written from the same strokes, in
millimetres from the lower left corner.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import escape

from ezdxf.addons.drawing.backend import Backend
from ezdxf.addons.drawing.config import (
    BackgroundPolicy,
    ColorPolicy,
    Configuration,
    HatchPolicy,
    LineweightPolicy,
)
from ezdxf.addons.drawing.frontend import UniversalFrontend
from ezdxf.addons.drawing.pipeline import RenderPipeline2d
from ezdxf.addons.drawing.properties import RenderContext
from ezdxf.addons.drawing.unified_text_renderer import UnifiedTextRenderer
from ezdxf.fonts.font_measurements import FontMeasurements
from ezdxf.path import Command

from cqdd_design.environment import source_date
from cqdd_design.exporting.sheets.lettering import (
    CAP_HEIGHT,
    DESCENDER,
    printable,
    short_number,
    text_width,
)

if TYPE_CHECKING:
    from cqdd_design.exporting.sheets.drawing import SheetDrawing

_POINT = 72.0 / 25.4
"""Points in a millimetre."""
_THIN = 0.18


@dataclass(frozen=True)
class Label:
    """A line of text on a sheet: lower left corner, cap height (mm), and turn (rad)."""

    text: str
    x: float
    y: float
    height: float
    turn: float

    @property
    def width(self) -> float:
        """In mm."""
        return text_width(self.text, self.height)

    @property
    def corners(self) -> tuple[complex, complex, complex, complex]:
        """Of its capitals, mm."""
        along = complex(math.cos(self.turn), math.sin(self.turn))
        begin = complex(self.x, self.y)
        right, up = along * self.width, 1j * along * self.height
        return begin, begin + right, begin + right + up, begin + up


class Canvas(Backend):
    """Strokes by pen width, filled outlines, and labels."""

    def __init__(self, width: float, height: float) -> None:
        super().__init__()
        self.width, self.height = width, height
        self.strokes: dict[float, list[str]] = {}
        self.fills: list[str] = []
        self.labels: list[Label] = []

    def _pen(self, properties: Any) -> list[str]:
        return self.strokes.setdefault(round(max(properties.lineweight, _THIN), 2), [])

    def set_background(self, color: str) -> None:
        """Paper is white."""

    def draw_point(self, pos: Any, properties: Any) -> None:
        """Points of a drawing carry no ink here."""

    def draw_line(self, start: Any, end: Any, properties: Any) -> None:
        """Keep a line."""
        self._pen(properties).append(f"{_at(start)} m {_at(end)} l")

    def draw_path(self, path: Any, properties: Any) -> None:
        """Keep a path of lines and curves."""
        self._pen(properties).append(_steps(path))

    def draw_filled_paths(self, paths: Iterable[Any], properties: Any) -> None:
        """Keep filled outlines."""
        self.fills.append(" ".join(_steps(path) + " h" for path in paths if len(path)))

    def draw_filled_polygon(self, points: Any, properties: Any) -> None:
        """Keep a filled polygon."""
        first, *others = points.vertices()
        steps = [f"{_at(first)} m", *(f"{_at(point)} l" for point in others), "h"]
        self.fills.append(" ".join(steps))

    def draw_image(self, image_data: Any, properties: Any) -> None:
        """Sheets have no pictures."""

    def clear(self) -> None:
        """Start again."""
        self.strokes, self.fills, self.labels = {}, [], []


class _Measured(UnifiedTextRenderer):
    """Tells the add-on how wide and high text will be, whatever fonts are installed."""

    def get_font_measurements(self, font_face: Any, cap_height: float = 1.0) -> FontMeasurements:
        """Of Helvetica."""
        below = DESCENDER / CAP_HEIGHT * cap_height
        return FontMeasurements(0.0, cap_height, 0.728 * cap_height, below)

    def get_text_line_width(self, text: str, font_face: Any, cap_height: float = 1.0) -> float:
        """Of Helvetica."""
        return text_width(text, cap_height)


class _Pipeline(RenderPipeline2d):
    """Catches text before it becomes outlines."""

    text_engine = _Measured()

    def __init__(self, canvas: Canvas) -> None:
        super().__init__(canvas)
        self.canvas = canvas

    def draw_text(
        self, text: str, transform: Any, properties: Any, cap_height: float, dxftype: str = "TEXT"
    ) -> None:
        """Keep a line of text."""
        if not text.strip():
            return
        origin = transform.transform((0.0, 0.0, 0.0))
        along = transform.transform_direction((1.0, 0.0, 0.0))
        up = transform.transform_direction((0.0, 1.0, 0.0))
        turn = math.atan2(along.y, along.x)
        label = Label(printable(text), origin.x, origin.y, cap_height * up.magnitude, turn)
        self.canvas.labels.append(label)


def render(sheet: SheetDrawing) -> Canvas:
    """Render a sheet, drawn in millimetres of paper."""
    canvas = Canvas(sheet.paper.width, sheet.paper.height)
    config = Configuration(
        color_policy=ColorPolicy.BLACK,
        background_policy=BackgroundPolicy.OFF,
        lineweight_policy=LineweightPolicy.ABSOLUTE,
        hatch_policy=HatchPolicy.NORMAL,
    )
    frontend = UniversalFrontend(RenderContext(sheet.drawing), _Pipeline(canvas), config)
    frontend.draw_layout(sheet.drawing.modelspace())
    return canvas


def svg_text(canvas: Canvas, title: str) -> str:
    """Return a sheet as an SVG of its paper's size."""
    width, height = canvas.width, canvas.height
    paths = [
        f'<path d="{_upper_case(steps)}" stroke-width="{pen:g}"/>'
        for pen, steps in sorted(canvas.strokes.items())
    ]
    if canvas.fills:
        paths.append(f'<path d="{_upper_case(canvas.fills)}" fill="#000" stroke="none"/>')
    words = [_svg_label(label, height) for label in canvas.labels]
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}mm" height="{height:g}mm" '
            f'viewBox="0 0 {width:g} {height:g}">',
            f"<title>{escape(title)}</title>",
            f'<rect width="{width:g}" height="{height:g}" fill="#fff"/>',
            f'<g transform="translate(0 {height:g}) scale(1 -1)" fill="none" stroke="#000" '
            'stroke-linecap="round" stroke-linejoin="round">',
            *paths,
            "</g>",
            '<g font-family="Helvetica, Arial, \'Liberation Sans\', sans-serif" fill="#000">',
            *words,
            "</g>",
            "</svg>",
            "",
        ]
    )


def _upper_case(steps: Iterable[str]) -> str:
    """Turn the steps of a PDF into those of an SVG: ``x y m`` into ``Mx y``."""
    parts: list[str] = []
    numbers: list[str] = []
    for word in " ".join(steps).split():
        if word in "mlch":
            letter = "Z" if word == "h" else word.upper()
            parts.append(letter + " ".join(numbers))
            numbers = []
        else:
            numbers.append(word)
    return "".join(parts)


def _svg_label(label: Label, height: float) -> str:
    place = f"translate({_number(label.x)} {_number(height - label.y)})"
    turn = f" rotate({_number(-math.degrees(label.turn))})" if label.turn else ""
    return (
        f'<text transform="{place}{turn}" font-size="{_number(label.height / CAP_HEIGHT)}" '
        f'textLength="{_number(label.width)}" lengthAdjust="spacingAndGlyphs">'
        f"{escape(label.text)}</text>"
    )


def pdf_bytes(canvas: Canvas, title: str) -> bytes:
    """Return a sheet as a PDF of one page; its date is that of the sheet."""
    lines = [f"{_POINT:.6f} 0 0 {_POINT:.6f} 0 0 cm 1 J 1 j"]
    for pen, steps in sorted(canvas.strokes.items()):
        lines += [f"{pen:g} w", *steps, "S"]
    if canvas.fills:
        lines += [*canvas.fills, "f*"]
    lines.append("BT")
    for label in canvas.labels:
        c, s = math.cos(label.turn), math.sin(label.turn)
        lines.append(f"/F1 {_number(label.height / CAP_HEIGHT)} Tf")
        matrix = " ".join(_number(v) for v in (c, s, -s, c, label.x, label.y))
        lines.append(f"{matrix} Tm {_pdf_string(label.text)} Tj")
    lines.append("ET")
    content = "\n".join(lines).encode("cp1252")
    box = f"[0 0 {canvas.width * _POINT:.3f} {canvas.height * _POINT:.3f}]"
    return _pdf_file(
        [
            b"<< /Type /Catalog /Pages 2 0 R >>",
            b"<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
            f"<< /Type /Page /Parent 2 0 R /MediaBox {box} /Contents 4 0 R "
            "/Resources << /Font << /F1 5 0 R >> >> >>".encode("ascii"),
            b"<< /Length %d >>\nstream\n%s\nendstream" % (len(content), content),
            b"<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>",
            f"<< /Title {_pdf_string(title)} /Producer (cqdd-design){_pdf_date()} >>".encode(
                "cp1252"
            ),
        ]
    )


def sheet_date() -> str:
    """Day on which a sheet is issued (ISO 7200): that of SOURCE_DATE_EPOCH, else today's, UTC."""
    return (source_date() or datetime.now(UTC)).strftime("%Y-%m-%d")


def _pdf_date() -> str:
    return f" /CreationDate (D:{sheet_date().replace('-', '')}000000Z)"


def _pdf_string(text: str) -> str:
    safe = text.encode("cp1252", "replace").decode("cp1252")
    return "(" + safe.replace("\\", r"\\").replace("(", r"\(").replace(")", r"\)") + ")"


def _pdf_file(objects: list[bytes]) -> bytes:
    """Put numbered objects, their table and the trailer together; the last is the information."""
    data, places = b"%PDF-1.4\n%\xe2\xe3\xcf\xd3\n", []
    for number, body in enumerate(objects, start=1):
        places.append(len(data))
        data += b"%d 0 obj\n%s\nendobj\n" % (number, body)
    table = b"".join(b"%010d 00000 n \n" % place for place in places)
    name = hashlib.sha256(data).hexdigest()[:32]
    trailer = (
        f"trailer\n<< /Size {len(objects) + 1} /Root 1 0 R /Info {len(objects)} 0 R "
        f"/ID [<{name}> <{name}>] >>\nstartxref\n{len(data)}\n%%EOF\n"
    )
    head = b"xref\n0 %d\n0000000000 65535 f \n" % (len(objects) + 1)
    return data + head + table + trailer.encode("ascii")


def _steps(path: Any) -> str:
    """Steps of a path as in a PDF; quadratic curves as the cubic ones that they are."""
    steps = [f"{_at(path.start)} m"]
    here = path.start
    for command in path.commands():
        end = command.end
        if command.type == Command.CURVE4_TO:
            steps.append(f"{_at(command.ctrl1)} {_at(command.ctrl2)} {_at(end)} c")
        elif command.type == Command.CURVE3_TO:
            one, two = (near + (command.ctrl - near) * (2.0 / 3.0) for near in (here, end))
            steps.append(f"{_at(one)} {_at(two)} {_at(end)} c")
        else:
            steps.append(f"{_at(end)} {'m' if command.type == Command.MOVE_TO else 'l'}")
        here = end
    return " ".join(steps)


def _at(point: Any) -> str:
    return f"{_number(point.x)} {_number(point.y)}"


def _number(value: float) -> str:
    """Micrometres of paper are enough."""
    return short_number(value, 3)
