"""Figures of the pages on theory and models, drawn from the code's own results by `build.py`."""
