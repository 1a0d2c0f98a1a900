"""Heat that a warm surface gives to still air and to walls as warm as the air.

Properties of air at the film temperature: dry, 1 bar, fitted within 2 % from -50 to 250 deg C
(Sutherland's law for viscosity and conductivity; Incropera et al. 2007, table A.4).
"""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

GRAVITY = 9.80665
STEFAN_BOLTZMANN = 5.670374419e-8
KELVIN = 273.15
PRANDTL = 0.71
_PRESSURE, _GAS = 101325.0, 287.05
_LEAST_RISE = 1e-3
"""Below it air is taken as this much colder, K: nothing then flows but what the limit gives."""


class Surface(NamedTuple):
    """A surface in still air.

    Attributes
    ----------
    node : int
        Of the network, whose temperature it has.
    shape : {"cylinder", "plate"}
        A lying cylinder's side, or an upright plane face.
    length : float
        The cylinder's diameter, or the height of the face, m.
    area : float
        m^2.
    emissivity : float
    """

    node: int
    shape: Literal["cylinder", "plate"]
    length: float
    area: float
    emissivity: float


def air(temperature: float) -> tuple[float, float]:
    """Conductivity, W/(m K), and kinematic viscosity, m^2/s, of air at a temperature, deg C."""
    kelvin = temperature + KELVIN
    viscosity = 1.716e-5 * (kelvin / 273.15) ** 1.5 * (273.15 + 110.4) / (kelvin + 110.4)
    conductivity = 0.0241 * (kelvin / 273.15) ** 1.5 * (273.15 + 194.0) / (kelvin + 194.0)
    return conductivity, viscosity * _GAS * kelvin / _PRESSURE


def rayleigh(rise: float, length: float, film: float) -> float:
    """Rayleigh number of air at a film temperature (deg C) for a rise (K) over a length (m)."""
    viscosity = air(film)[1]
    expansion = 1.0 / (film + KELVIN)
    return GRAVITY * expansion * abs(rise) * length**3 * PRANDTL / viscosity**2


def nusselt_cylinder(number: float, prandtl: float = PRANDTL) -> float:
    """Mean Nusselt number of a lying cylinder by its diameter.

    Churchill and Chu 1975, Int. J. Heat Mass Transfer 18, 1049-1053, eq. 9; Rayleigh numbers up to
    1e12.

    Examples
    --------
    Incropera et al. 2007, example 9.4: Ra 5.073e6, Pr 0.697 give 23.3 with rounded powers.

    >>> print(round(nusselt_cylinder(5.073e6, 0.697)))
    23
    """
    factor = (1.0 + (0.559 / prandtl) ** (9.0 / 16.0)) ** (8.0 / 27.0)
    return float((0.60 + 0.387 * number ** (1.0 / 6.0) / factor) ** 2)


def nusselt_plate(number: float, prandtl: float = PRANDTL) -> float:
    """Mean Nusselt number of an upright plate by its height.

    Churchill and Chu 1975, Int. J. Heat Mass Transfer 18, 1323-1329, eq. 9; any Rayleigh number.

    Examples
    --------
    Incropera et al. 2007, example 9.2: Ra 1.813e9, Pr 0.690 give 147.

    >>> print(round(nusselt_plate(1.813e9, 0.690)))
    147
    """
    factor = (1.0 + (0.492 / prandtl) ** (9.0 / 16.0)) ** (8.0 / 27.0)
    return float((0.825 + 0.387 * number ** (1.0 / 6.0) / factor) ** 2)


def outside_conductance(surface: Surface, temperature: float, ambient: float) -> float:
    """Heat that a surface gives off over its rise above the air, W/K: convection and radiation."""
    rise = max(abs(temperature - ambient), _LEAST_RISE)
    film = 0.5 * (temperature + ambient)
    number = rayleigh(rise, surface.length, film)
    law = nusselt_cylinder if surface.shape == "cylinder" else nusselt_plate
    convection = law(number) * air(film)[0] / surface.length
    warm, cold = temperature + KELVIN, ambient + KELVIN
    radiation = surface.emissivity * STEFAN_BOLTZMANN * (warm + cold) * (warm**2 + cold**2)
    return surface.area * (convection + radiation)


def annulus_conductance(conductivity: float, inner: float, outer: float, length: float) -> float:
    """Of a ring from its inner to its outer radius, W/K."""
    return 2.0 * math.pi * conductivity * length / math.log(outer / inner)
