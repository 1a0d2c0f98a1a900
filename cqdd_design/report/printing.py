"""The report on paper: a browser prints the page, as its reader would."""

from __future__ import annotations

import os
import subprocess
import tempfile
from pathlib import Path

from cqdd_design.environment import find_browser
from cqdd_design.errors import DependencyError

_LONGEST = 180.0
"""Seconds until a browser that prints nothing is given up."""
_FLAGS = (
    "--headless",
    "--disable-gpu",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-pdf-header-footer",
    # Headings become bookmarks.
    "--generate-pdf-document-outline",
)


def printing_browser() -> str:
    """The browser that prints.

    Raises
    ------
    DependencyError
        There is none.
    """
    place = find_browser()
    if place is None:
        raise DependencyError(
            "report --format pdf prints through a browser, and none was found; install one "
            "(on Debian and Ubuntu `apt-get install -y chromium`), or take the HTML file, which "
            "any browser prints."
        )
    return place


def printed_page(page: str, browser: str) -> bytes:
    """A page as PDF on A4, its headings as bookmarks.

    Raises
    ------
    DependencyError
        The browser prints nothing.
    """
    with tempfile.TemporaryDirectory(prefix="cqdd-print-") as folder:
        source, target = Path(folder, "page.html"), Path(folder, "page.pdf")
        source.write_text(page, encoding="utf-8")
        # Nobody but root needs to forgo the sandbox, and root's browser starts in no other way.
        alone = ("--no-sandbox",) if getattr(os, "geteuid", lambda: 1)() == 0 else ()
        places = (f"--user-data-dir={Path(folder, 'profile')}", f"--print-to-pdf={target}")
        try:
            done = subprocess.run(
                [browser, *_FLAGS, *alone, *places, source.as_uri()],
                capture_output=True,
                timeout=_LONGEST,
                check=False,
            )
            said = done.stderr.decode("utf-8", "replace").strip().splitlines()
        except (OSError, subprocess.TimeoutExpired) as error:
            said = [str(error)]
        content = target.read_bytes() if target.exists() else b""
    if not content.startswith(b"%PDF"):
        why = said[-1] if said else "it said nothing"
        raise DependencyError(
            f"the browser {browser} did not print the report ({why}); take the HTML file and print "
            "it yourself."
        )
    return content
