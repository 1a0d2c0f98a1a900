"""Drawings of the gearbox: front view, section, turning mesh, wire EDM."""
