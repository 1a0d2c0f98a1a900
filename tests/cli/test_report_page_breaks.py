"""On paper a heading, the sentence under it and the table that it announces stay on one page."""

from __future__ import annotations

import re
import subprocess
from importlib import resources
from pathlib import Path

import pytest
from report_browser import run_browser

pytestmark = pytest.mark.deep

RULE = "p:has(+ .scroll) { break-after: avoid; }"
FILLED = range(226, 262, 3)
"""Heights above the headings, mm, of pages that hold 264."""


def printed(css: str, folder: Path) -> list[str]:
    """Text of every page of a print of headings that come ever lower."""
    sections = [
        f'<section style="break-before: page"><div style="height: {high}mm"></div>'
        f"<h3>Heading {high}</h3><p>Judged on the loads of {high}.</p>"
        '<div class="scroll"><table><thead><tr><th>Claim</th></tr></thead><tbody>'
        + "".join(f"<tr><td>Row {row} of {high}</td></tr>" for row in range(9))
        + "</tbody></table></div></section>"
        for high in FILLED
    ]
    page, pdf = folder / "page.html", folder / "page.pdf"
    page.write_text(
        f'<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>x</title><style>{css}'
        f'</style></head><body><main class="page">{"".join(sections)}</main></body></html>',
        encoding="utf-8",
    )
    run_browser(folder, "--no-pdf-header-footer", f"--print-to-pdf={pdf}", page=page)
    done = subprocess.run(["pdftotext", pdf, "-"], capture_output=True, text=True, check=True)
    return done.stdout.split("\f")


def parted(pages: list[str]) -> list[int]:
    """Which headings stand on another page than the first two rows of their table."""
    found = []
    for high in FILLED:
        places = [
            next(i for i, text in enumerate(pages) if re.search(rf"{words} {high}\b", text))
            for words in ("Heading", "Row 0 of", "Row 1 of")
        ]
        if len(set(places)) > 1:
            found.append(high)
    return found


def test_a_heading_stays_with_its_table(tmp_path: Path) -> None:
    templates = resources.files("cqdd_design.report") / "templates"
    css = "".join(
        (templates / f"{name}.css").read_text(encoding="utf-8") for name in ("style", "layout")
    )
    assert RULE in css
    assert parted(printed(css, tmp_path)) == []
    assert parted(printed(css.replace(RULE, ""), tmp_path)) != []
