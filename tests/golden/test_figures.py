"""Figures of the pages, which `docs/build.py` draws: every page of theory and model has one."""

from __future__ import annotations

import re
import sys
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

PAGES = ("theory.md", "contact-model.md", "actuator-model.md", "measured.md")


@pytest.fixture(scope="module")
def build(repository: Path) -> Iterator[ModuleType]:
    sys.path.insert(0, str(repository / "docs"))
    import build

    yield build
    sys.path.remove(str(repository / "docs"))


@pytest.mark.parametrize("page", PAGES)
def test_a_page_shows_figures_that_the_build_draws(
    page: str, build: ModuleType, repository: Path
) -> None:
    told = (repository / "docs" / page).read_text(encoding="utf-8")
    shown = re.findall(r"!\[[^\]]+\]\((images/[\w-]+\.svg)\)", told)
    assert shown
    assert set(shown) <= set(build.PAGES)
    for name in shown:
        root = ET.fromstring((repository / "docs" / name).read_text(encoding="utf-8"))
        assert root.find("{http://www.w3.org/2000/svg}title") is not None


def test_no_figure_is_left_over(build: ModuleType, repository: Path) -> None:
    drawn = {name for name in build.PAGES if name.startswith("images/")}
    kept = {f"images/{path.name}" for path in (repository / "docs" / "images").glob("*.svg")}
    pages = sorted((repository / "docs").glob("*.md"))
    told = "".join(page.read_text(encoding="utf-8") for page in pages)
    assert drawn == kept
    assert all(name in told for name in drawn)


@pytest.mark.parametrize("name", ["images/theory-profile.svg", "images/theory-forces.svg"])
def test_figures_of_theory_are_current(name: str, build: ModuleType, repository: Path) -> None:
    """The others are compared with all pages, in the deep run."""
    assert build.PAGES[name]() == (repository / "docs" / name).read_text(encoding="utf-8")
