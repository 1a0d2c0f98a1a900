"""What goes round on the crank's radius with each disc: the disc, its cam bearing, its eccentric.

Closed forms that need no layout, so that the balance of a crank is known before its parts are,
and for a machine whose parts cannot be put together. They are those of the parts as drawn: of all
that turns with the shaft only the eccentrics, and balance weights, are off its axis. Journals,
collars and the shaft's bore are round about it, so an eccentric counts as a full cylinder.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from cqdd_design.catalog.bearings import Bearing, shaft_material
from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.geometry.disc import disc_moments
from cqdd_design.solids.rotating import bearing_envelope
from cqdd_design.solids.selection import ChosenBearing


@dataclass(frozen=True)
class Throw:
    """Masses that stand at the eccentricity for each disc, kg.

    Attributes
    ----------
    disc, cam_bearing, eccentric : float
        Both rings of the bearing stand on the eccentric, so all of it goes round.
    """

    disc: float
    cam_bearing: float
    eccentric: float

    @property
    def mass(self) -> float:
        """All three together, kg."""
        return self.disc + self.cam_bearing + self.eccentric


def throw_of(design: Design, cam: Bearing) -> Throw:
    """Masses on the crank's radius with one disc of a design.

    Parameters
    ----------
    cam : Bearing
        The cam bearing: as wide as the eccentric under it, and as large as the disc's bore.

    Raises
    ------
    GeometryError
        When the disc cannot exist.
    """
    reducer = design.reducer
    section = disc_moments(design, 0, bore_diameter=cam.outer_diameter)
    chosen, bearing = ChosenBearing(cam), cam.mass
    if bearing is None:
        bearing = find_material(chosen.material).density * bearing_envelope(chosen).volume
    eccentric = math.pi / 4.0 * cam.bore_diameter**2 * cam.width
    return Throw(
        disc=find_material(reducer.disc_material).density * section.area * reducer.disc_thickness,
        cam_bearing=bearing,
        eccentric=find_material(shaft_material(cam)).density * eccentric,
    )
