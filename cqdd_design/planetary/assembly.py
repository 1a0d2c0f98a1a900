"""Does it go together: equal centre distances, identical planets, neighbours, envelope."""

from __future__ import annotations

import math
from dataclasses import dataclass

from cqdd_design.errors import GeometryError, UsageError
from cqdd_design.planetary.kinematics import PlanetaryTeeth

#: Planets beyond this are no gearbox any more; it bounds every search over the number of planets.
MOST_PLANETS = 24


def validate_planets(planets: int) -> int:
    """The number of planets, if it is a whole number from 1 to 24.

    Raises
    ------
    UsageError
        Otherwise, with the nearest number that is.
    """
    whole = isinstance(planets, int) and not isinstance(planets, bool)
    if not whole or not 1 <= planets <= MOST_PLANETS:
        raise UsageError(
            f"planets: {planets} is not a number of planets; give a whole number from 1 to "
            f"{MOST_PLANETS}, usually 3."
        )
    return planets


def assembly_number(teeth: PlanetaryTeeth) -> int:
    """The whole number that a count of equally spaced identical planets must divide.

    Put one planet in, turn the carrier by 2 pi/N with the ring held: the sun turns by i 2 pi/N with
    i = (Z_s Z_p2 + Z_r Z_p1)/(Z_s Z_p2). The next planet drops into the same place if the sun then
    stands as it did, and a planet that may be re-entered k teeth on in the ring lets the sun stand
    at any multiple of 2 pi gcd(Z_p1, Z_p2)/(Z_s Z_p2). Hence N must divide
    (Z_s Z_p2 + Z_r Z_p1)/gcd(Z_p1, Z_p2); for a simple planetary this is Z_s + Z_r.

    Examples
    --------
    >>> assembly_number(PlanetaryTeeth(12, 36, 22, 70))
    1392
    >>> assembly_number(PlanetaryTeeth(20, 40, 40, 100))
    120
    """
    total = teeth.sun * teeth.planet_ring + teeth.ring * teeth.planet_sun
    return total // math.gcd(teeth.planet_sun, teeth.planet_ring)


def assembles(teeth: PlanetaryTeeth, planets: int) -> bool:
    """Whether `planets` identical planets can be spaced equally (:func:`assembly_number`)."""
    return assembly_number(teeth) % planets == 0


def neighbour_gap(centre_distance: float, tip_diameter: float, planets: int) -> float:
    """Clear distance between the tips of neighbouring planets, m; negative when they overlap.

    2 a sin(pi/N) - d_a, with the larger tip diameter of a stepped planet. One planet has no
    neighbour: infinite.

    Examples
    --------
    >>> [round(neighbour_gap(24.0, 38.0, n), 2) for n in (3, 4, 6)]
    [3.57, -4.06, -14.0]
    """
    if planets == 1:
        return math.inf
    return 2.0 * centre_distance * math.sin(math.pi / planets) - tip_diameter


def most_planets_that_fit(centre_distance: float, tip_diameter: float) -> int:
    """The largest number of equally spaced planets whose tips do not touch.

    Examples
    --------
    >>> most_planets_that_fit(24.0, 38.0)
    3
    """
    planets = 1
    while planets < MOST_PLANETS:
        if neighbour_gap(centre_distance, tip_diameter, planets + 1) <= 0.0:
            break
        planets += 1
    return planets


@dataclass(frozen=True)
class PlanetaryEnvelope:
    """Diameters the gear set needs, m.

    Attributes
    ----------
    planet_sweep_diameter : float
        Circle that clears the larger planet gear, 2 a + d_a.
    ring_outer_diameter : float
        Outside of the ring's body: root diameter and the rim on both sides.
    outer_diameter : float
        The larger of the two.
    planet_bore_most : float
        Largest bearing bore that leaves the smaller planet gear the rim 1.2 h_t below which ISO
        6336-3, 9.3 raises the root stress.
    """

    planet_sweep_diameter: float
    ring_outer_diameter: float
    planet_bore_most: float

    @property
    def outer_diameter(self) -> float:
        """The larger of planet sweep and ring body."""
        return max(self.planet_sweep_diameter, self.ring_outer_diameter)

    def fits(self, bore: float) -> bool:
        """Whether the gear set goes into a `bore` (m)."""
        return self.outer_diameter <= bore


def require_one_centre_distance(
    teeth: PlanetaryTeeth, module: float, sun_distance: float, ring_distance: float
) -> None:
    """Refuse teeth and shifts that put both meshes at different centre distances.

    Parameters
    ----------
    module : float
        m, only for the message.
    sun_distance, ring_distance : float
        Working centre distances of the sun's and the ring's mesh, m, positive.

    Raises
    ------
    GeometryError
        They differ by more than a millionth; the message names the ring that makes them equal.
    """
    if abs(sun_distance - ring_distance) <= 1e-6 * sun_distance:
        return
    raise GeometryError(
        f"teeth {teeth} with module {module * 1e3:g} mm: the sun mesh needs a centre distance of "
        f"{sun_distance * 1e3:.5g} mm and the ring mesh {ring_distance * 1e3:.5g} mm, but both "
        f"gears of a planet turn on one pin. With a ring of {teeth.matching_ring} teeth and no sum "
        "of profile shifts both are equal."
    )
