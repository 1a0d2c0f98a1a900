"""Data of a joint's motion and torque: simulated, imported, split."""
