"""Lets the tests here import the outputs they share (importlib collection)."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "oracles"))
