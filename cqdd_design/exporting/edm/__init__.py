"""Wire EDM: flat parts, their contours as DXF, wire paths and programs, each read back."""
