"""Kinematics and static forces of the compound (stepped) planetary gear.

Sun in, carrier out, ring held. Every planet carries two gears on one shaft: the first meshes with
the sun, the second with the ring. With both counts equal the planet is ONE gear that meshes with
both, and every formula becomes that of the simple planetary.

::

      ring  Z_r  ======================  (held)
                 |  planet_ring  Z_p2  |
      carrier ---|---------------------|--- pin
                 |  planet_sun   Z_p1  |
      sun   Z_s  ----------------------
"""

from __future__ import annotations

from dataclasses import dataclass

from cqdd_design.errors import GeometryError, UsageError

#: Range of ISO 1328-1:2013, clause 1; outside it no tolerance, hence no ISO rating, is defined.
LEAST_TEETH, MOST_TEETH = 5, 1000


@dataclass(frozen=True)
class PlanetaryTeeth:
    """Tooth counts, all positive: sun, the planet's two gears, ring.

    Attributes
    ----------
    sun, planet_sun, planet_ring, ring : int
        Z_s, Z_p1 (meshes with the sun), Z_p2 (meshes with the ring) and Z_r, 5 to 1000.

    Raises
    ------
    UsageError
        A count is not a whole number from 5 to 1000.
    GeometryError
        The ring is not larger than the planet inside it.

    Examples
    --------
    >>> PlanetaryTeeth(12, 36, 22, 70).stepped
    True
    """

    sun: int
    planet_sun: int
    planet_ring: int
    ring: int

    def __post_init__(self) -> None:
        """Refuse counts no gear can have."""
        for name in ("sun", "planet_sun", "planet_ring", "ring"):
            count = getattr(self, name)
            whole = isinstance(count, int) and not isinstance(count, bool)
            if not whole or not LEAST_TEETH <= count <= MOST_TEETH:
                nearest = LEAST_TEETH
                if isinstance(count, (int, float)) and count == count:
                    nearest = min(max(round(min(count, MOST_TEETH)), LEAST_TEETH), MOST_TEETH)
                raise UsageError(
                    f"teeth: {name.replace('_', ' ')} has {count} teeth; a count is a whole number "
                    f"from {LEAST_TEETH} to {MOST_TEETH}. The nearest is {nearest}."
                )
        if self.ring <= self.planet_ring:
            raise GeometryError(
                f"teeth: a ring of {self.ring} teeth cannot surround a planet of "
                f"{self.planet_ring}; with this sun and planet the ring has "
                f"{self.matching_ring} teeth."
            )

    @property
    def stepped(self) -> bool:
        """Whether the planet is two gears; False for the simple planetary."""
        return self.planet_sun != self.planet_ring

    @property
    def matching_ring(self) -> int:
        """The ring count Z_s + Z_p1 + Z_p2 that gives both meshes one centre distance."""
        return self.sun + self.planet_sun + self.planet_ring

    def __str__(self) -> str:
        """As people write it: ``12/36/22/70``."""
        return f"{self.sun}/{self.planet_sun}/{self.planet_ring}/{self.ring}"


def ratio_ring_fixed(teeth: PlanetaryTeeth) -> float:
    """Speed ratio 1 + Z_p1 Z_r/(Z_s Z_p2), sun in, carrier out, ring held; same sense of rotation.

    Willis 1841; for one module equal to (Z_s + Z_p1)(Z_p1 + Z_p2)/(Z_s Z_p2).

    Examples
    --------
    >>> round(ratio_ring_fixed(PlanetaryTeeth(12, 36, 22, 70)), 6)
    10.545455
    >>> ratio_ring_fixed(PlanetaryTeeth(20, 40, 40, 100))
    6.0
    """
    return 1.0 + teeth.planet_sun * teeth.ring / (teeth.sun * teeth.planet_ring)


def ratio_carrier_fixed(teeth: PlanetaryTeeth) -> float:
    """Speed ratio -Z_p1 Z_r/(Z_s Z_p2), sun in, ring out, carrier held; the ring turns backwards.

    Examples
    --------
    >>> round(ratio_carrier_fixed(PlanetaryTeeth(12, 36, 22, 70)), 6)
    -9.545455
    """
    return 1.0 - ratio_ring_fixed(teeth)


@dataclass(frozen=True)
class PlanetarySpeeds:
    """Speeds in the unit of the sun's speed, positive in the sun's sense.

    Attributes
    ----------
    sun, carrier, planet : float
        Against the housing (the ring stands still).
    sun_to_carrier, planet_to_carrier, ring_to_carrier : float
        Against the carrier: these count tooth contacts and set the pitch-line speed.
    """

    sun: float
    carrier: float
    planet: float
    sun_to_carrier: float
    planet_to_carrier: float
    ring_to_carrier: float


def speeds(teeth: PlanetaryTeeth, sun_speed: float) -> PlanetarySpeeds:
    """All speeds with the ring held (Willis: in the carrier's frame every mesh is a fixed pair).

    Examples
    --------
    AGMA 6123-C16 Annex C, 16/28/74, carrier at 61 rpm:

    >>> found = speeds(PlanetaryTeeth(16, 28, 28, 74), 343.125)
    >>> round(found.carrier, 9), found.sun_to_carrier
    (61.0, 282.125)
    """
    carrier = sun_speed / ratio_ring_fixed(teeth)
    relative = sun_speed - carrier
    planet_relative = -relative * teeth.sun / teeth.planet_sun
    return PlanetarySpeeds(
        sun=sun_speed,
        carrier=carrier,
        planet=planet_relative + carrier,
        sun_to_carrier=relative,
        planet_to_carrier=planet_relative,
        ring_to_carrier=-carrier,
    )


@dataclass(frozen=True)
class PlanetaryTorques:
    """Torques on the members in N*m, loss-free; the three outer ones add to zero.

    Attributes
    ----------
    sun, ring, carrier : float
        Torque each shaft receives from outside. Positive sun torque drives; the load holds the
        carrier back, so `carrier` is negative; the housing holds the ring with `ring`.
    planet : float
        Torque through each planet shaft from its sun-side to its ring-side gear.
    """

    sun: float
    ring: float
    carrier: float
    planet: float


def torques(teeth: PlanetaryTeeth, output_torque: float, planets: int) -> PlanetaryTorques:
    """Torques for `output_torque` delivered by the carrier, shared equally by `planets`.

    Parameters
    ----------
    output_torque : float
        N*m at the carrier.
    planets : int
        1 or more.

    Examples
    --------
    >>> round(torques(PlanetaryTeeth(16, 28, 28, 74), 23500.0, 3).sun, 1)
    4177.8
    """
    sun = output_torque / ratio_ring_fixed(teeth)
    return PlanetaryTorques(
        sun=sun,
        ring=output_torque - sun,
        carrier=-output_torque,
        planet=sun * teeth.planet_sun / (teeth.sun * planets),
    )


def tangential_force(torque: float, teeth: int, module: float) -> float:
    """Nominal tangential force F_t = 2 T/d at the reference cylinder, N (ISO 6336-1, 4.2).

    Parameters
    ----------
    torque : float
        Torque of ONE mesh about that gear's axis, N*m.
    teeth : int
        Teeth of that gear.
    module : float
        Transverse module, m.
    """
    return 2.0 * torque / (teeth * module)
