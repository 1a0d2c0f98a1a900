"""Drawings for a shop: cut sheets, front views, and the package that holds them."""
