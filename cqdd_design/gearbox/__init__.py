"""Mechanics and checks of the cycloidal gearbox.

`analyse_gearbox` is the one call from a design to everything closed forms say about it; the
modules below it are pure functions over arrays, shared by single designs and by the screen of
hundreds of thousands.
"""

from cqdd_design.gearbox.analysis import GearboxAnalysis, analyse_gearbox
from cqdd_design.gearbox.checks.guide import CHECK_GUIDE, check_guide
from cqdd_design.gearbox.checks.guide_row import CheckGuide

__all__ = [
    "CHECK_GUIDE",
    "CheckGuide",
    "GearboxAnalysis",
    "analyse_gearbox",
    "check_guide",
]
