"""Checks of a gearbox: their limits, their words, and one module a chapter."""
