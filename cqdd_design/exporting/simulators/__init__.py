"""The actuator for simulators: MJCF, URDF, BAM, and the card that speaks to all."""
