"""Contact equilibrium: what every tooth, pin and bearing carries, with clearance and error.

Import the modules directly: :mod:`.model` (what is solved), :mod:`.sweep` (solve it over crank
angle), :mod:`.part_errors`. The compiled kernel is loaded only by the modules that solve.
"""
