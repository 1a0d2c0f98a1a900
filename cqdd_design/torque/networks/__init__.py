"""Estimators: their file, their torch modules, and the compiled runtime without torch."""
