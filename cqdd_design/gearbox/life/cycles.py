"""How often each place of the gearbox is loaded in one turn of the output.

The ring stands still, so the load zone passes every tooth once a crank turn: n times. Disc, holes
and pins turn backwards with the output, so it passes them n + 1 times. A point of a flank meets
every tooth once, always at the same angle of the crank against it, and therefore always under the
same pressure when the parts are perfect: the most loaded point is loaded n + 1 times.
"""

from __future__ import annotations


def ring_tooth_cycles(lobe_count: int) -> int:
    """Load cycles of a ring tooth, in the zone of one disc, per output turn: n."""
    return lobe_count


def disc_cycles(lobe_count: int) -> int:
    """Load cycles of a point of a flank, of a hole and of a pin per output turn: n + 1."""
    return lobe_count + 1
