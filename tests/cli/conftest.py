"""What the tests here share: the browser, costly outputs, and a design whose wire does not fit.

Tests are collected by importlib, so that the folder is no place to import from by itself.
"""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

for folder in (Path(__file__).parent, Path(__file__).parents[1] / "oracles"):
    sys.path.insert(0, str(folder))


_SHARP = {
    "ratio = 10": "ratio = 40",
    'ring_pin_diameter = "7 mm"': 'ring_pin_diameter = "4 mm"',
    'eccentricity = "1.6 mm"': 'eccentricity = "0.55 mm"',
    'wire_diameter = "0.25 mm"': 'wire_diameter = "0.5 mm"',
    'spark_gap = "12 um"': 'spark_gap = "200 um"',
}


@pytest.fixture
def sharp_design_file(paper_design_file: Path, tmp_path: Path) -> Path:
    """The paper's design with valleys too narrow for its wire."""
    text = paper_design_file.read_text(encoding="utf-8")
    for old, new in _SHARP.items():
        assert old in text
        text = text.replace(old, new)
    path = tmp_path / "sharp.toml"
    path.write_text(text, encoding="utf-8")
    return path
