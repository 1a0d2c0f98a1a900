"""Friction of one kind of contact over load and speed, from its film."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.gearbox.film.mixed import mixed_friction
from cqdd_design.gearbox.film.thickness import minimum_film
from cqdd_design.geometry.contours import FloatArray

_LEAST_LOAD = 1e-3
"""Of the mean, at which a film is taken that nothing presses: it would be without bounds."""


class Film(NamedTuple):
    """A film and its friction, arrays of one shape: thickness (m), lambda, and mu as it is felt."""

    thickness: FloatArray
    ratio: FloatArray
    friction: FloatArray


@dataclass(frozen=True)
class FilmLaw:
    """Film and friction of line contacts of one kind.

    Attributes
    ----------
    viscosity : float
        Dynamic, at the film's temperature, Pa s.
    pressure_coefficient : float
        alpha there, 1/Pa.
    modulus : float
        E* of the pair, Pa.
    length : float
        Of the contact, m.
    roughness : float
        Composite, m.
    boundary, film : float
        Coefficients of friction without a film, and with a full one.
    share : float
        What is felt of it where the disc is touched: below 1 where a plain sleeve or roller takes
        the sliding to a smaller radius.
    most : float
        Thickness that the parts leave room for, m.
    """

    viscosity: float
    pressure_coefficient: float
    modulus: float
    length: float
    roughness: float
    boundary: float
    film: float
    share: float = 1.0
    most: float = np.inf

    @property
    def at_rest(self) -> float:
        """The coefficient as it is felt where nothing moves."""
        return self.boundary * self.share

    def at(self, force: ArrayLike, entrainment: ArrayLike, radius: ArrayLike) -> Film:
        """Film of contacts.

        Parameters
        ----------
        force : array_like
            N, not negative; one that carries nothing has the film of a thousandth of the mean.
        entrainment : array_like
            m/s, not negative.
        radius : array_like
            Of the equivalent cylinder, m.
        """
        load = np.asarray(force, dtype=float)
        loaded = load[load > 0.0]
        least = _LEAST_LOAD * (float(loaded.mean()) if loaded.size else 1.0)
        thickness = minimum_film(
            np.maximum(load, least) / self.length,
            entrainment,
            radius,
            viscosity=self.viscosity,
            pressure_coefficient=self.pressure_coefficient,
            modulus=self.modulus,
        )
        thickness = np.minimum(thickness, self.most)
        ratio = thickness / self.roughness
        return Film(thickness, ratio, self.share * mixed_friction(self.boundary, self.film, ratio))
