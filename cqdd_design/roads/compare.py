"""The loads of a design on a compound planetary."""

from __future__ import annotations

from typing import Any

from cqdd_design.design import Design
from cqdd_design.machine import resolve
from cqdd_design.planetary.compare import PlanetaryComparison
from cqdd_design.sizing.comparison import compare_with_planetary


def compare(design: Design, **asked: Any) -> PlanetaryComparison:
    """A compound planetary for the loads of a design, asked as `compare_with_planetary` is."""
    return compare_with_planetary(resolve(design), **asked)
