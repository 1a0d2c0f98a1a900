"""Plane geometry in closed form: disc, ring, holes, arcs and area integrals. numpy only."""
