"""Profile shifts: what undercut asks for, and the default that keeps the centre distance."""

from __future__ import annotations

import math
from dataclasses import dataclass

from cqdd_design.planetary.cutting_tools import ISO_53_A, BasicRack
from cqdd_design.planetary.kinematics import PlanetaryTeeth

#: Shifts are drawn in steps of this many modules.
SHIFT_STEP = 0.05


def least_shift_without_undercut(teeth: float, rack: BasicRack = ISO_53_A) -> float:
    """Smallest profile shift x at which a rack does not undercut an external gear.

    x_min = h_fP* - rho_fP* (1 - sin(alpha)) - z sin^2(alpha)/2: the straight flank of the rack ends
    h_fP* - rho_fP* (1 - sin(alpha)) below its reference line and must end above the base tangent
    point (ISO 21771:2007, 7.7). Spur gears; for helical ones insert the virtual teeth.

    Examples
    --------
    >>> round(least_shift_without_undercut(12), 3)
    0.298
    """
    sine = math.sin(rack.pressure_angle)
    return rack.straight_depth - 0.5 * teeth * sine * sine


@dataclass(frozen=True)
class ProfileShifts:
    """Profile shift coefficients; `ring` in the sign convention of ISO 21771 (negative teeth)."""

    sun: float
    planet_sun: float
    planet_ring: float
    ring: float


def default_shifts(teeth: PlanetaryTeeth) -> ProfileShifts:
    """Least shifts that avoid undercut and add to zero in each mesh, so both centre distances stay.

    The sun takes the smallest shift, in steps of 0.05, that leaves neither it nor its planet
    undercut, the planet the opposite; likewise planet and ring. When sun and planet together have
    too few teeth for that, the shift halfway between their needs is taken and both stay a little
    undercut. A ring is cut by a pinion from inside and has no undercut of this kind. The one planet
    gear of a simple planetary has one shift in both meshes.

    Examples
    --------
    >>> default_shifts(PlanetaryTeeth(12, 36, 22, 70))
    ProfileShifts(sun=0.3, planet_sun=-0.3, planet_ring=0.0, ring=0.0)
    """
    sun = _nearest_to_zero(
        least_shift_without_undercut(teeth.sun),
        -least_shift_without_undercut(teeth.planet_sun),
    )
    if not teeth.stepped:
        return ProfileShifts(sun, 0.0 - sun, 0.0 - sun, sun)
    planet = _nearest_to_zero(least_shift_without_undercut(teeth.planet_ring), math.inf)
    return ProfileShifts(sun, 0.0 - sun, planet, 0.0 - planet)


def _nearest_to_zero(least: float, most: float) -> float:
    """The number of [least, most] nearest zero, on the 0.05 grid where the interval allows."""
    if least > most:
        return 0.5 * (least + most)
    if least <= 0.0 <= most:
        return 0.0
    if least > 0.0:
        on_grid = round(math.ceil(least / SHIFT_STEP - 1e-9) * SHIFT_STEP, 2)
        return on_grid if on_grid <= most else least
    on_grid = round(math.floor(most / SHIFT_STEP + 1e-9) * SHIFT_STEP, 2)
    return on_grid if on_grid >= least else most
