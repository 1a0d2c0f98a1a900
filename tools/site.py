"""Build the site of `docs/` and check it.

    python tools/site.py [FOLDER]      needs the extra `docs`; FOLDER is build/site unless given

Sphinx runs with every reference checked and warnings as errors. Then every page is read as a
browser would: each link and picture within the site has to be there, each anchor too, and nothing
may be loaded from elsewhere. Files of the gallery are exported first. Any failure is exit code 1.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

TOP = Path(__file__).resolve().parents[1]
DOCS = TOP / "docs"
LOADED = {("link", "href"), ("script", "src"), ("img", "src"), ("source", "src"), ("iframe", "src")}


class Page(HTMLParser):
    """Anchors, links and what is loaded of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.anchors: set[str] = set()
        self.links: list[str] = []
        self.loads: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Collect what an element names or points to."""
        for name, value in attrs:
            if value and name in ("id", "name"):
                self.anchors.add(value)
            if value and tag == "a" and name == "href":
                self.links.append(value)
            if value and (tag, name) in LOADED:
                self.loads.append(value)


def anchors(page: Page | None) -> set[str]:
    """What a link may lead to; of a file that is no page, nothing."""
    return page.anchors if page else set()


def export_gallery() -> None:
    """The files of the gallery's designs, into a folder that git ignores."""
    sys.path.insert(0, str(DOCS))
    from gallery import DESIGNS, FILES, KINDS

    import cqdd_design as cq

    shutil.rmtree(FILES, ignore_errors=True)
    for design in DESIGNS:
        cq.export(design.path, KINDS, out=FILES / design.name)


def build(folder: Path) -> None:
    """Run Sphinx; leave with its words where it warns."""
    command = [sys.executable, "-m", "sphinx", "-q", "-E", "-n", "-W", "--keep-going"]
    done = subprocess.run(
        [*command, "-b", "html", str(DOCS), str(folder)],
        env={**os.environ, "PYTHONUTF8": "1"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    if done.returncode:
        sys.exit(f"Sphinx is not content:\n{done.stdout}")


def faults(folder: Path) -> Iterator[str]:
    """Links and anchors that lead nowhere, and what is asked of other hosts."""
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in folder.rglob("*.html")}
    for path, page in pages.items():
        name = path.relative_to(folder).as_posix()
        for target in page.loads:
            if urlsplit(target).netloc:
                yield f"{name} loads {target}"
        for target in {*page.links, *page.loads}:
            parts = urlsplit(target)
            if parts.scheme or parts.netloc:
                continue
            place = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if not place.is_file():
                yield f"{name}: {target} is not there"
            elif parts.fragment and unquote(parts.fragment) not in anchors(pages.get(place)):
                yield f"{name}: {target} has no such anchor"
    for sheet in folder.rglob("*.css"):
        for target in re.findall(r"url\(\s*['\"]?(\w+:)?//", sheet.read_text(encoding="utf-8")):
            yield f"{sheet.relative_to(folder).as_posix()} loads from elsewhere: {target}"


def main() -> None:
    """Export, build, check."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("folder", nargs="?", type=Path, default=TOP / "build" / "site")
    folder = parser.parse_args().folder.resolve()
    shutil.rmtree(folder, ignore_errors=True)
    export_gallery()
    build(folder)
    found = sorted(faults(folder))
    if found:
        sys.exit("\n".join(found))
    print(f"built and checked: {len(list(folder.rglob('*.html')))} pages in {folder}")


if __name__ == "__main__":
    main()
