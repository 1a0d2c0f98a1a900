"""Torque estimation: pendulum data, networks, training, evaluation, fast runtime."""
