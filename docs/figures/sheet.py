"""A figure of the report's ink as a file of its own: on white, in the report's style."""

from __future__ import annotations

import html
import re
from collections.abc import Iterator
from pathlib import Path

import cqdd_design
from cqdd_design.report.ink.svg import Figure, element, fixed

_TEMPLATES = Path(cqdd_design.__file__).parent / "report" / "templates"
_FONT = '"Inter", "Segoe UI", "Helvetica Neue", Arial, "Liberation Sans", sans-serif'
_OWN = """\
.sheet { fill: #fff; }
.construction { fill: none; stroke: #9a6400; stroke-width: 1.4; stroke-dasharray: 6 3; }
.normal { stroke: #8896a3; stroke-width: 0.9; }
.angle { fill: none; stroke: #1f5a86; stroke-width: 1.4; }
.arrow-angle { fill: #1f5a86; }
svg .angle-name { fill: #1f5a86; font-weight: 600; font-size: 14px; }
.block { fill: #eaf1f7; stroke: #1f5a86; stroke-width: 1.2; }
.wire { fill: none; stroke: #1c2733; stroke-width: 1.2; }
svg .block-name { font-weight: 600; font-size: 13px; }
svg .block-text { font-size: 12px; fill: #52606d; }
svg .wire-name { font-size: 12px; fill: #1c2733; }
.bar-outline { fill: none; stroke: #1c2733; stroke-width: 1.2; }
.heat-wire { fill: none; stroke: #b3261e; stroke-width: 1.2; stroke-dasharray: 4 3; }
.heat-arrow { fill: #b3261e; }
.stop { stroke-width: 1; }
.other-dot { fill: #c0561b; stroke: #fff; stroke-width: 1; }
"""
_SHEETS = ("style.css", "bench.css")


def sheet(figure: Figure) -> str:
    """The figure as an SVG file; white behind, so that it reads on a dark page too."""
    width, height = fixed(figure.width), fixed(figure.height)
    body = element("rect", width=width, height=height, class_="sheet") + figure.body
    root = element(
        "svg",
        element("title", html.escape(figure.title)),
        element("desc", html.escape(figure.description)),
        element("style", f"svg {{ font-family: {_FONT}; }}\n{''.join(_style(body))}"),
        body,
        xmlns="http://www.w3.org/2000/svg",
        viewBox=f"0 0 {width} {height}",
        width=width,
        height=height,
        role="img",
    )
    return re.sub(r"(/>|</(?!tspan)\w+>)<(?!tspan)", r"\1\n<", root) + "\n"


def _style(body: str) -> Iterator[str]:
    """The report's rules for what a figure holds, its colours in place of their names."""
    used = {name for names in re.findall(r'class="([^"]*)"', body) for name in names.split()}
    css = "".join((_TEMPLATES / name).read_text(encoding="utf-8") for name in _SHEETS)
    # The first of each name: those of dark looks follow.
    colours = dict(reversed(re.findall(r"(--[\w-]+): (#\w+);", css)))
    for selectors, rule in re.findall(r"([^{}]+)\{([^{}]*)\}", css + _OWN):
        ones = re.sub(r"/\*.*?\*/", "", selectors).strip().split(", ")
        wanted = [one for one in ones if one == "svg text" or _styles(one, used)]
        if wanted:
            told = re.sub(r"var\((--[\w-]+)\)", lambda found: colours[found[1]], rule)
            told = told.replace("font-family: inherit; ", "").strip()
            yield f"{', '.join(wanted)} {{ {told} }}\n"


def _styles(selector: str, used: set[str]) -> bool:
    """Whether a selector is of one element, by classes that a figure has."""
    plain = re.fullmatch(r"(?:svg )?((?:\.[\w-]+)+)", selector)
    return plain is not None and set(plain[1].split(".")[1:]) <= used
