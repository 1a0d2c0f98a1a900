"""The actuator in the report: envelope, parameters, test bench."""
