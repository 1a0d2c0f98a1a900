"""Toleranced gearboxes: draws, the compiled ensemble, distributions and sensitivity."""
