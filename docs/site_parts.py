"""What the site needs of Sphinx beyond its own.

* Equations as MathML, which browsers draw without a script, screen readers read, and the report has
  too. The converter is docutils' own, so that no package more is needed.
* Indices and powers of running text set as such: ``R_w`` and ``F^0.9``, as Markdown has them.
* Keys in tables that may be broken; options, powers of ten, and numbers with their units, that
  may not.
* Pages that docstrings name as files, as links.
* Pages whose text stands elsewhere in the repository, and links that lead out of `docs/`.
* Contents whose captions have a level.
* Files of the gallery's designs, where `tools/site.py` has exported them.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml
from pygments.lexers.special import TextLexer

if TYPE_CHECKING:
    from sphinx.application import Sphinx
    from sphinx.writers.html5 import HTML5Translator

DOCS = Path(__file__).resolve().parent
ELSEWHERE = {
    "changelog": "CHANGELOG.md",
    "contributing": "CONTRIBUTING.md",
    "notebooks": "examples/README.md",
}
"""Pages to the file of the repository that has their text."""
EXPORTED = DOCS / "gallery" / "files"

_SUNK = re.compile(
    r"(?<![\w.])(?P<base>(?:[^\W\d_]|alpha|delta|mu|rho|sigma)['*]?)"
    r"_(?P<low>[^\W_²³¹⁰-⁹]+(?:,(?:max|mean|min)\b)?)(?![^\W²³¹⁰-⁹]|\.\w)"
    r"|\^(?:\((?P<share>-?[\w./]+)\)|(?P<high>-?\w+(?:\.\d+)?))"
)
_PIECES = re.compile(r"(?<=\w[._])(?=\w)")
"""Where a key may be broken."""
_WHOLE = re.compile(r"(<[^>]*>)|(?<![\w-])(--[a-z][a-z0-9-]*)|(?<![\w.])(\d+(?:\.\d+)?e-\d+)\b")
"""Tags, which are left alone, options, and numbers such as 1e-11."""
_QUANTITY = re.compile(
    r"(?<![\w.])(\d[\d.,]* (?:%|°C|(?:[kMGmµ]?(?:Hz|Pa|N|W|V|A|m|s|g)|rpm|arcmin|rad|K|h)"
    r"[²³]?(?:·m+²?)?(?:/[a-zµ]+²?)?)(?![\w·]))"
)
"""A number with its unit."""
_FILE = re.compile(r"\bdocs/([\w-]+)\.md\b")
_AS_IT_IS = (nodes.literal, nodes.FixedTextElement, nodes.math, nodes.raw, nodes.title)
_LINK = re.compile(r"\]\((?!https?://|#)([^)#\s]+)(#[^)\s]*)?\)")


def inline(writer: HTML5Translator, node: nodes.math) -> None:
    """A formula within a line."""
    writer.body.append(str(tex2mathml(node.astext())))
    raise nodes.SkipNode


def block(writer: HTML5Translator, node: nodes.math_block) -> None:
    """A formula of its own, in a box that scrolls where the screen is narrower."""
    drawn = tex2mathml(node.astext(), as_block=True)
    writer.body.append(f'<div class="equation">{drawn}</div>\n')
    raise nodes.SkipNode


def _left(_: HTML5Translator, __: nodes.Element) -> None:
    """Never reached: entering has written the whole formula."""


def set_symbols(app: Sphinx, tree: nodes.document) -> None:
    """Indices below and powers above the line, in text that is no code."""
    if app.env.docname != "api":
        _replace_words(tree, _SUNK, symbols)


def _replace_words(
    tree: nodes.document, pattern: re.Pattern[str], made: Callable[[str], list[nodes.Node]]
) -> None:
    """Put nodes in place of every text in which a pattern stands and that is no code."""
    for text in list(tree.findall(nodes.Text)):
        place: Any = text
        while place is not None and not isinstance(place, _AS_IT_IS):
            place = place.parent
        if place is None and pattern.search(text):
            text.parent.replace(text, made(text))


def symbols(text: str) -> list[nodes.Node]:
    """Text with its indices and powers as nodes of their own."""
    found: list[nodes.Node] = []
    at = 0
    for one in _SUNK.finditer(text):
        found.append(nodes.Text(text[at : one.start()] + (one["base"] or "")))
        kind = nodes.subscript if one["low"] else nodes.superscript
        words = one["low"] or one["share"] or one["high"]
        found.append(kind(words, words.replace("-", "\u2212")))
        at = one.end()
    return [*found, nodes.Text(text[at:])]


def breakable(_: Sphinx, tree: nodes.document) -> None:
    """Keys in tables may be broken behind a dot or an underscore: words beside have room."""
    for cell in tree.findall(nodes.entry):
        for code in cell.findall(nodes.literal):
            pieces = [one for one in _PIECES.split(code.astext()) if one]
            code.children.clear()
            for piece in pieces:
                if code.children:
                    code += nodes.raw("", "<wbr>", format="html")
                code += nodes.Text(piece)


def kept_together(_: Sphinx, tree: nodes.document) -> None:
    """A number and its unit stand on one line, but where a table has no room."""
    _replace_words(tree, _QUANTITY, quantities)


def quantities(text: str) -> list[nodes.Node]:
    """Text with its numbers and their units as nodes of their own."""
    return [
        nodes.inline(one, one, classes=["quantity"]) if k % 2 else nodes.Text(one)
        for k, one in enumerate(_QUANTITY.split(text))
    ]


def link_pages(_: Sphinx, __: str, ___: str, ____: object, _____: object, lines: list[str]) -> None:
    """Pages that a docstring names as files of `docs/` are links here."""
    lines[:] = [_FILE.sub(r":doc:`\g<0> <\1>`", line) for line in lines]


def page_source(_: Sphinx, name: str, text: list[str]) -> None:
    """The text of a page as the site has it."""
    top = DOCS.parent
    place = ELSEWHERE.get(name)
    if place:
        text[0] = (top / place).read_text(encoding="utf-8")
    home = (top / place).parent if place else DOCS
    pages = {(top / file).resolve(): f"{page}.md" for page, file in ELSEWHERE.items()}

    def led(found: re.Match[str]) -> str:
        """Target as seen from `docs/`; a text that has a page of its own is that page."""
        target = (home / found[1]).resolve()
        seen = pages.get(target) or PurePosixPath(os.path.relpath(target, DOCS)).as_posix()
        return f"]({seen}{found[2] or ''})"

    text[0] = _LINK.sub(led, text[0])
    if name == "gallery":
        text[0] = re.sub(r"\[design file\]\([./\w]+/([\w-]+)\.toml\)", _with_files, text[0])


def _with_files(found: re.Match[str]) -> str:
    """A link to a design file, and links to what was exported of it."""
    files = sorted((EXPORTED / found[1]).glob("*"))
    links = [f"[{one.name}](gallery/files/{found[1]}/{one.name})" for one in files]
    return ", ".join([found[0], *links])


def whole_words(_: Sphinx, __: str, ___: str, context: dict[str, Any], ____: object) -> None:
    """Options and powers of ten stay on one line: browsers break behind each of their hyphens."""
    if "body" in context:
        context["body"] = _WHOLE.sub(
            lambda found: found[1] or f'<span class="whole">{found[2] or found[3]}</span>',
            context["body"],
        )


def captions(_: Sphinx, __: str, ___: str, context: dict[str, Any], ____: object) -> None:
    """Captions of the contents are headings for a screen reader, which asks of which level."""
    tree = context.get("furo_navigation_tree", "")
    context["furo_navigation_tree"] = tree.replace(
        'role="heading"', 'role="heading" aria-level="2"'
    )


def setup(app: Sphinx) -> dict[str, bool]:
    """Register with Sphinx."""
    app.add_html_math_renderer("mathml", (inline, _left), (block, _left))
    app.add_lexer("csv", TextLexer)
    app.connect("source-read", page_source)
    app.connect("doctree-read", set_symbols)
    app.connect("doctree-read", breakable)
    app.connect("doctree-read", kept_together)
    app.connect("autodoc-process-docstring", link_pages)
    app.connect("html-page-context", whole_words)
    # After the theme has drawn its tree.
    app.connect("html-page-context", captions, priority=900)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
