"""The gearbox in the report: loads, contact, precision, losses, life, tolerances, masses."""
