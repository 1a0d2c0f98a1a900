"""Estimators scored on episodes they never saw, with intervals."""
