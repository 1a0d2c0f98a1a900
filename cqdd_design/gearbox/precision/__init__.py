"""Precision: backlash, lost motion, stiffness, transmission error, torque ripple, orders."""
