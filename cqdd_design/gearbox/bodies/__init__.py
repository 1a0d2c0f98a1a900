"""Discs and ring as elastic bodies: influence matrices and stresses from finite elements."""
