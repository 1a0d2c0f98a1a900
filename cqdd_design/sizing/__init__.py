"""Sizing: requirements to a checked design, by an exhaustive screen and a local refinement."""

from cqdd_design.sizing.infeasible import SizingInfeasibleError
from cqdd_design.sizing.result import Objective, SizedDesign, SizingResult
from cqdd_design.sizing.size import size

__all__ = ["Objective", "SizedDesign", "SizingInfeasibleError", "SizingResult", "size"]
