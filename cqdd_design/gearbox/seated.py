"""What seats and temperatures leave of a bearing's radial clearance.

A ring with interference delta on the diameter is a thick tube on, or in, another (Lame)::

    p = (delta/2)/(a/E_r ((b^2 + a^2)/(b^2 - a^2) + nu_r) + a/E_h ((a^2 + c^2)/(a^2 - c^2) - nu_h))
    u_b = 2 p a^2 b/(E_r (b^2 - a^2))

of an inner ring from its bore a to its raceway b, on a hub with a hole of radius c; an outer ring
the other way round, in a wall with the outside c. What seats and rings differ in expansion adds to
the interference, and rings of different warmth leave alpha d_p (t_inner - t_outer) less. A seat
that is loose takes nothing.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from cqdd_design.catalog.bearings import BEARING_MATERIAL, Bearing
from cqdd_design.catalog.fits import fit_limits
from cqdd_design.catalog.internal_clearance import Clearance, ring_limits
from cqdd_design.catalog.materials import Material, find_material
from cqdd_design.errors import CatalogError

_DRAWN = 20.0
"""Temperature at which dimensions hold, deg C (ISO 1:2022)."""
_RING_SHARE = 0.3
"""Mean thickness of a ring over the height of the section, that of a thin-section bearing."""


class Wall(NamedTuple):
    """What a ring sits on or in.

    Attributes
    ----------
    zone : str
        ISO 286 zone of the seat.
    other_side : float
        Radius of the hole in it, or of the outside round it, m.
    material : Material
    temperature : float
        Its own, and of the ring, deg C.
    """

    zone: str
    other_side: float
    material: Material
    temperature: float


class Seated(NamedTuple):
    """Clearance of a bearing in its seats, on the diameter, m.

    Attributes
    ----------
    mean, spread : float
        What is left, and to either side of it what limits taken as 3 sigma make likely.
    """

    mean: float
    spread: float

    @property
    def least(self) -> float:
        """The least that is likely; negative where the bearing is preloaded."""
        return self.mean - self.spread


def seated_clearance(bearing: Bearing, clearance: Clearance, on: Wall, within: Wall) -> Seated:
    """What two seats leave of a clearance.

    Raises
    ------
    CatalogError
        Where limits of a seat or of the bearing, or the expansion of a material, are not known.

    Examples
    --------
    A crossed roller of 50 x 66 mm on a plate of steel keeps what it was sold with; on one of
    aluminium it is preloaded at 65 degC, by more than the 8 um of the preloaded class:

    >>> from cqdd_design.catalog.bearings import find_bearing
    >>> from cqdd_design.catalog.internal_clearance import clearances
    >>> row = find_bearing("THK RA5008")
    >>> for name in ("AISI 4140 Q&T 540C", "7075-T6"):
    ...     on = Wall("h5", 12e-3, find_material(name), 65.0)
    ...     within = Wall("H7", 45e-3, find_material("7075-T6"), 65.0)
    ...     found = seated_clearance(row, clearances(row)[0], on, within)
    ...     print(f"{1e6 * found.mean:.0f} +-{1e6 * found.spread:.0f} um")
    7 +-10 um
    -11 +-10 um
    """
    bore, outside = bearing.bore_diameter, bearing.outer_diameter
    limits, steel = ring_limits(bore, outside), find_material(BEARING_MATERIAL)
    if limits is None:
        raise CatalogError(f"limits of the diameters of a {bearing.designation} are not known")
    inner, outer = limits
    shaft, hole = fit_limits(on.zone, bore), fit_limits(within.zone, outside)
    thick = _RING_SHARE * 0.5 * (outside - bore)
    taken, varied = 0.0, [0.5 * (clearance.most - clearance.least)]
    for tight, widths, share in (
        (
            0.5 * (shaft.lower + shaft.upper + inner) + _growth(on, steel, bore),
            (shaft.upper - shaft.lower, inner),
            raceway_share(0.5 * bore, 0.5 * bore + thick, on.other_side, steel, on.material),
        ),
        (
            -0.5 * (hole.lower + hole.upper + outer) - _growth(within, steel, outside),
            (hole.upper - hole.lower, outer),
            raceway_share(
                0.5 * outside, 0.5 * outside - thick, within.other_side, steel, within.material
            ),
        ),
    ):
        if tight > 0.0:
            taken += share * tight
            varied += [0.5 * share * width for width in widths]
    warmer = _expansion(steel) * 0.5 * (bore + outside) * (on.temperature - within.temperature)
    mean = 0.5 * (clearance.least + clearance.most) - taken - warmer
    return Seated(mean, math.hypot(*varied))


def raceway_share(
    seat: float, raceway: float, side: float, ring: Material, wall: Material
) -> float:
    """Share of an interference by which the raceway of a ring moves.

    Parameters
    ----------
    seat, raceway : float
        Radii of the ring, m; the raceway outside its seat, or inside it, as in an outer ring.
    side : float
        Radius of the other side of what it sits on (less than `seat`) or in (more), m.

    Examples
    --------
    Of steel on a solid shaft, that of the seat over that of the raceway:

    >>> steel = find_material("AISI 52100 / 100Cr6 hardened")
    >>> round(raceway_share(8e-3, 10e-3, 0.0, steel, steel), 3)
    0.8
    """
    way = math.copysign(1.0, raceway - seat)
    of_ring = (raceway**2 + seat**2) / abs(raceway**2 - seat**2) + way * ring.poisson_ratio
    of_wall = (side**2 + seat**2) / abs(side**2 - seat**2) - way * wall.poisson_ratio
    moved = 2.0 * seat * raceway / (ring.youngs_modulus * abs(raceway**2 - seat**2))
    return moved / (of_ring / ring.youngs_modulus + of_wall / wall.youngs_modulus)


def _growth(wall: Wall, ring: Material, diameter: float) -> float:
    """By how much a seat grows more than its ring, m."""
    return (_expansion(wall.material) - _expansion(ring)) * diameter * (wall.temperature - _DRAWN)


def _expansion(material: Material) -> float:
    if material.expansion is None:
        raise CatalogError(f"the thermal expansion of '{material.name}' is not known")
    return material.expansion
