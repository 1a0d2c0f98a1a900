"""The evaluation of torque estimators as a page of its own."""
