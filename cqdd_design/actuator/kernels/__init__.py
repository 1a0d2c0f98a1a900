"""Compiled time stepping of actuators; the same in plain numpy stands with the tests."""
