"""A design made concrete once: bearings, motor, layout, parts, masses; all above takes it."""

from cqdd_design.machine.machine import Machine
from cqdd_design.machine.resolve import resolve

__all__ = ["Machine", "resolve"]
