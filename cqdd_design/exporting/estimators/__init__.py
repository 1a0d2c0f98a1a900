"""Torque estimators for simulators, onnxruntime and C."""
