"""Fuzz campaign: designs, files, options and logs, valid and invalid, against what is promised."""
