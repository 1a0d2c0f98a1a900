"""A small SVG writer: elements, text, arrows, and figures with a title for screen readers.

Everything is a string, so a figure is data like any other and the same design always gives the
same bytes. Lengths are in px of the figure's own view box; the page scales the whole figure.
"""

from __future__ import annotations

import html
import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.geometry.contours import Circle, Contour, FloatArray, PlanarPart

Point = tuple[float, float]


def fixed(value: float, decimals: int = 2) -> str:
    """A coordinate without trailing zeros: ``12.5``, ``3``, never ``-0``."""
    text = f"{value:.{decimals}f}"
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def element(name: str, *children: str, **attributes: str | float | None) -> str:
    """One element.

    Parameters
    ----------
    name : str
        Tag.
    *children : str
        Markup inside, already escaped.
    **attributes
        ``stroke_width`` becomes ``stroke-width``, ``class_`` becomes ``class``; None is left out.

    Examples
    --------
    >>> element("line", x1=0.0, x2=4.5, class_="thin")
    '<line x1="0" x2="4.5" class="thin"/>'
    """
    parts = []
    for key, value in attributes.items():
        if value is None:
            continue
        shown = fixed(value) if isinstance(value, float) else str(value)
        label = key.rstrip("_").replace("_", "-")
        parts.append(f' {label}="{html.escape(shown, quote=True)}"')
    head = f"<{name}{''.join(parts)}"
    return f"{head}>{''.join(children)}</{name}>" if children else f"{head}/>"


def group(children: Iterable[str], **attributes: str | float | None) -> str:
    """A ``<g>`` around some elements."""
    return element("g", "".join(children) or " ", **attributes)


def line(start: Point, end: Point, class_: str) -> str:
    """A straight line."""
    return element("line", x1=start[0], y1=start[1], x2=end[0], y2=end[1], class_=class_)


def circle(centre: Point, radius: float, class_: str) -> str:
    """A circle."""
    return element("circle", cx=centre[0], cy=centre[1], r=radius, class_=class_)


def rectangle(x: float, y: float, width: float, height: float, class_: str) -> str:
    """An upright rectangle."""
    return element("rect", x=x, y=y, width=width, height=height, class_=class_)


def thinned(points: FloatArray, fine: float) -> FloatArray:
    """A chain (k, 2) without the points that lie within `fine` of the line through the others.

    The algorithm of Douglas and Peucker, 1973.
    """
    # Number by number: chains are short, and numpy takes longer to begin than to end.
    x, y = np.asarray(points, dtype=float).T.tolist()
    keep = [0, len(x) - 1]
    spans = [(0, len(x) - 1)]
    while spans:
        first, last = spans.pop()
        x0, y0 = x[first], y[first]
        along, across = x[last] - x0, y[last] - y0
        length = math.hypot(along, across)
        most, worst = -1.0, first
        for k in range(first + 1, last):
            if length < fine:
                away = math.hypot(x[k] - x0, y[k] - y0)
            else:
                away = abs((x[k] - x0) * across - (y[k] - y0) * along) / length
            if away > most:
                most, worst = away, k
        if most > fine:
            keep.append(worst)
            spans += [(first, worst), (worst, last)]
    return points[sorted(set(keep))]


def polyline(points: Iterable[Point], class_: str, *, closed: bool = False) -> str:
    """A chain of straight lines."""
    joined = "L".join(f"{fixed(x)} {fixed(y)}" for x, y in points)
    return element("path", d=f"M{joined}{'Z' if closed else ''}", class_=class_)


def text(
    place: Point, content: str, class_: str = "", anchor: str = "start", turn: float = 0.0
) -> str:
    """Text whose baseline starts, is centred, or ends (`anchor`) at `place`.

    `content` is plain text, with ``_x`` or ``_{xy}`` for a subscript: ``Z_r`` or ``R_{eq}``.
    `turn` is in degrees, clockwise on the page.
    """
    rotation = f"rotate({fixed(turn)} {fixed(place[0])} {fixed(place[1])})" if turn else None
    return element(
        "text",
        subscripted(content),
        x=place[0],
        y=place[1],
        class_=class_ or None,
        text_anchor=None if anchor == "start" else anchor,
        transform=rotation,
    )


def subscripted(content: str) -> str:
    """Escaped text in which ``Z_r`` and ``R_{eq}`` have lowered tspans."""
    pieces, position = [], 0
    while (at := content.find("_", position)) >= 0:
        pieces.append(html.escape(content[position:at]))
        if content[at + 1 : at + 2] == "{":
            end = content.index("}", at)
            lowered, position = content[at + 2 : end], end + 1
        else:
            lowered, position = content[at + 1 : at + 2], at + 2
        pieces.append(f'<tspan class="sub" dy="3">{html.escape(lowered)}</tspan>')
        pieces.append('<tspan dy="-3">\u200b</tspan>')
    pieces.append(html.escape(content[position:]))
    return "".join(pieces)


def arrow_head(tip: Point, direction: Point, class_: str = "arrow", size: float = 8.0) -> str:
    """A filled slender arrow head whose point is at `tip` and that flies along `direction`."""
    length = math.hypot(*direction)
    ux, uy = direction[0] / length, direction[1] / length
    back = (tip[0] - size * ux, tip[1] - size * uy)
    half = 0.19 * size
    corners = [tip, (back[0] - half * uy, back[1] + half * ux)]
    corners.append((back[0] + half * uy, back[1] - half * ux))
    return polyline(corners, class_, closed=True)


@dataclass(frozen=True)
class View:
    """The map from the machine (m, y up) to a figure (px, y down).

    Attributes
    ----------
    scale : float
        px per m.
    origin : (float, float)
        Where the machine's origin lies in the figure, px.
    """

    scale: float
    origin: Point

    def point(self, place: ArrayLike) -> Point:
        """A point (2,) in m as px."""
        x, y = np.asarray(place, dtype=float)
        return (self.origin[0] + self.scale * float(x), self.origin[1] - self.scale * float(y))

    def polar(self, radius: float, angle: float, centre: Point = (0.0, 0.0)) -> Point:
        """The point at `radius` (m) and `angle` (rad) from a centre in the machine (m), px."""
        x, y = centre
        return self.point((x + radius * math.cos(angle), y + radius * math.sin(angle)))

    def length(self, metres: float) -> float:
        """A length in px."""
        return self.scale * metres


def contour_path(contour: Contour, view: View) -> str:
    """Path data of one closed contour: true SVG arcs, crisp at any size."""
    if isinstance(contour, Circle):
        x, y = view.point(contour.centre)
        r = fixed(view.length(contour.radius), 3)
        left, right = fixed(x - view.length(contour.radius), 3), fixed(2.0 * float(r), 3)
        return f"M{left} {fixed(y, 3)}a{r} {r} 0 1 0 {right} 0a{r} {r} 0 1 0 -{right} 0Z"
    arcs = contour.arcs()
    places = [view.point(p) for p in contour.points]
    pieces = [f"M{fixed(places[0][0], 3)} {fixed(places[0][1], 3)}"]
    for i in range(len(places)):
        x, y = places[(i + 1) % len(places)]
        end = f"{fixed(x, 3)} {fixed(y, 3)}"
        if contour.bulges[i] == 0.0:
            pieces.append(f"L{end}")
            continue
        r = fixed(view.length(float(arcs.radii[i])), 3)
        large = int(abs(float(arcs.sweeps[i])) > math.pi)
        # The page's y axis points down, so a counter-clockwise arc has sweep flag 0.
        pieces.append(f"A{r} {r} 0 {large} {int(arcs.sweeps[i] < 0.0)} {end}")
    return "".join(pieces) + "Z"


def contour_shape(contour: Contour, view: View, class_: str) -> str:
    """A closed contour."""
    return element("path", d=contour_path(contour, view), class_=class_)


def part_shape(part: PlanarPart, view: View, class_: str) -> str:
    """A part with its holes; its class fills by the even-odd rule."""
    data = "".join(contour_path(c, view) for c in (part.outer, *part.holes))
    return element("path", d=data, class_=class_)


@dataclass(frozen=True)
class Figure:
    """A finished figure.

    Attributes
    ----------
    id : str
        Anchor, unique in the page.
    title, description : str
        Read out by screen readers; `title` is also the caption's heading.
    width, height : float
        View box, px.
    body : str
        Elements.
    caption : str
        Text under the figure.
    """

    id: str
    title: str
    description: str
    width: float
    height: float
    body: str
    caption: str = ""

    def render(self) -> str:
        """The inline ``<svg>``, labelled by its own title and description."""
        labels = f"{self.id}-title {self.id}-description"
        return element(
            "svg",
            element("title", html.escape(self.title), id=f"{self.id}-title"),
            element("desc", html.escape(self.description), id=f"{self.id}-description"),
            self.body,
            viewBox=f"0 0 {fixed(self.width)} {fixed(self.height)}",
            role="img",
            aria_labelledby=labels,
            id=f"{self.id}-svg",
            style=f"--wide:{fixed(self.width)}px",
        )


class Words(NamedTuple):
    """What a figure says beside its picture, as :class:`Figure` holds it."""

    id: str
    title: str
    description: str
    caption: str = ""

    def figure(self, width: float, height: float, body: Iterable[str]) -> Figure:
        """The figure of some elements in a box of so many px."""
        head = (self.id, self.title, self.description)
        return Figure(*head, width, height, "".join(body), self.caption)


def points_of(xs: FloatArray, ys: FloatArray) -> list[Point]:
    """Two arrays as a list of px points."""
    return [(float(x), float(y)) for x, y in zip(xs, ys, strict=True)]
