"""Pages by Jinja2: the templates, and what they may say of text and markup."""

from __future__ import annotations

import html
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cqdd_design.report.ink.mathml import lowered

if TYPE_CHECKING:
    from jinja2 import Environment

Values = dict[str, Any]
"""What a template is given, by the names it uses; one that is missing is an error."""

_TEMPLATES = Path(__file__).parents[1] / "templates"


def environment() -> Environment:
    """The templates of the report; a name that a template does not get is an error."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined
    from markupsafe import Markup

    found = Environment(
        loader=FileSystemLoader(_TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    # Only markup that this package has built and escaped itself goes through `markup`.
    found.filters["markup"] = Markup
    found.filters["prose"] = lambda text: Markup(lowered(text))
    found.filters["symbol"] = lambda text: Markup(symbol_html(text))
    return found


def symbol_html(text: str) -> str:
    """Escaped text with ``Z_r`` and ``N_{np}`` lowered.

    Examples
    --------
    >>> symbol_html("Z_r & Z_np")
    'Z<sub>r</sub> &amp; Z<sub>np</sub>'
    """
    return re.sub(r"_(?:\{(\w+)\}|(\w+))", r"<sub>\1\2</sub>", html.escape(text))
