"""Compiled time stepping of actuators; the same in plain numpy stands in `twin/`."""
