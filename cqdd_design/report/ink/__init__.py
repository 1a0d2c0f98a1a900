"""What figures and tables are drawn with: SVG, axes, charts, formulas, numbers."""
