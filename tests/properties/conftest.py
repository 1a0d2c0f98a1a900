"""Lets the tests here import the random designs and oracles they share (importlib collection)."""

import sys
from pathlib import Path

for folder in (Path(__file__).parent, Path(__file__).parents[1] / "oracles"):
    sys.path.insert(0, str(folder))
