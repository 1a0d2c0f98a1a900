"""Cycloidal quasi-direct-drive actuators: sizing, checks, solids, files and reports."""

__version__ = "0.1.0"
