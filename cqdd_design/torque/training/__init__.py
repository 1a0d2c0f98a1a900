"""Training of estimators, from data and split to a file."""
