"""How parts at other temperatures than 20 deg C move the contacts, every part by its own material.

A part grows evenly: its lengths go with one factor, 1 + alpha (t - 20). Ring teeth go outward with
the ring, and a disc keeps the shape of its profile; the crank's throw goes with the shaft, the
circle of the pins with the carrier and that of the holes with the disc, so that pins and holes part
along the radius. What the housing does to the ring by squeezing it is left out, and so are what
100 K take off a modulus (3 to 4 % of steel) and what they add to a disc's thickness.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from typing import NamedTuple

from cqdd_design.catalog.bearings import BEARING_MATERIAL, find_bearing, shaft_material
from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.errors import DesignError, UsageError
from cqdd_design.gearbox.contact.laws import CamSpring
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.geometry.cycloid import CycloidDisc

REFERENCE = 20.0
"""Temperature at which dimensions hold, deg C (ISO 1:2022)."""

COLDEST, HOTTEST = -60.0, 200.0
"""Range of part temperatures, deg C. Mean coefficients of expansion are told from about room
temperature to 100 deg C, and no bearing or grease of the catalogue works beyond."""


@dataclass(frozen=True)
class PartTemperatures:
    """Temperatures of a gearbox's parts, deg C.

    A cam bearing's inner ring is as warm as the shaft, its outer ring as the disc, and what rolls
    between them halfway.
    """

    ring: float = REFERENCE
    disc: float = REFERENCE
    carrier: float = REFERENCE
    pin: float = REFERENCE
    shaft: float = REFERENCE

    def __post_init__(self) -> None:
        """Refuse temperatures at which nothing here holds."""
        for part, value in vars(self).items():
            if not (math.isfinite(value) and COLDEST <= value <= HOTTEST):
                raise UsageError(
                    f"{value:.6g} degC of the {part} is outside {COLDEST:g} to {HOTTEST:g} degC, "
                    "where coefficients of expansion hold and greased bearings work."
                )

    @classmethod
    def even(cls, temperature: float) -> PartTemperatures:
        """All parts at one temperature, deg C.

        Raises
        ------
        UsageError
            Outside -60 to 200 deg C.
        """
        return cls(*[temperature] * len(fields(cls)))

    @property
    def as_drawn(self) -> bool:
        """Whether all parts have the temperature at which their dimensions hold."""
        return all(value == REFERENCE for value in vars(self).values())

    def beyond(self, design: Design) -> tuple[str, ...]:
        """Sentences on parts that are warmer than their material keeps its strength."""
        told = []
        for part, name in part_materials(design).items():
            here, most = getattr(self, part), find_material(name).service_limit
            if most is not None and here > most:
                told.append(
                    f"the {part} at {here:.4g} degC is above the {most:g} degC up to which "
                    f"'{name}' keeps its strength and shape."
                )
        return tuple(told)


AS_DRAWN = PartTemperatures()


class Growth(NamedTuple):
    """What heat adds to lengths of the parts, as a share, and to a cam bearing's play, m."""

    ring: float
    disc: float
    carrier: float
    pin: float
    shaft: float
    play: float


def part_materials(design: Design) -> dict[str, str]:
    """Catalogue names of what the parts are made of."""
    reducer = design.reducer
    return {
        "ring": reducer.ring_material,
        "disc": reducer.disc_material,
        "carrier": design.carrier_material,
        "pin": reducer.output_pins.material,
        "shaft": shaft_material(find_bearing(reducer.cam_bearing.designation)),
    }


def growth_of(design: Design, temperatures: PartTemperatures) -> Growth:
    """How parts of a design that names its cam bearing grow.

    Raises
    ------
    DesignError
        For a part that is not at 20 deg C and whose material's expansion is not in the catalogue.

    Notes
    -----
    Between rings of one steel the play grows by alpha d_m (t_outer - t_inner), d_m the mean of the
    raceways' diameters, where what rolls is halfway (Harris and Kotzalas 2006, Essential Concepts
    of Bearing Technology, ch. 3). Seats without play or interference as drawn: what a disc grows
    beyond the outer ring, and a shaft less than the inner ring, is play too.
    """
    shares = {}
    for part, name in part_materials(design).items():
        rise, alpha = getattr(temperatures, part) - REFERENCE, find_material(name).expansion
        if alpha is None and rise:
            raise DesignError(
                f"the catalogue has no thermal expansion of '{name}', of which the {part} is made, "
                f"so nothing can be said at {rise + REFERENCE:.4g} degC; name a material that has "
                "one (see `cqdd-design catalog materials`)."
            )
        shares[part] = 0.0 if alpha is None else alpha * rise
    bearing = find_bearing(design.reducer.cam_bearing.designation)
    steel = find_material(BEARING_MATERIAL).expansion or 0.0
    inner, outer = (steel * (t - REFERENCE) for t in (temperatures.shaft, temperatures.disc))
    mean = 0.5 * (bearing.bore_diameter + bearing.outer_diameter)
    play = (
        (outer - inner) * mean
        + (shares["disc"] - outer) * bearing.outer_diameter
        - (shares["shaft"] - inner) * bearing.bore_diameter
    )
    return Growth(**shares, play=play)


def heated(model: ContactModel, design: Design, temperatures: PartTemperatures) -> ContactModel:
    """The gearbox with its parts at other temperatures than 20 deg C.

    Parameters
    ----------
    model : ContactModel
        Of the design, as drawn.

    Raises
    ------
    DesignError
        As :func:`growth_of`.
    GeometryError
        When a disc of these sizes cannot exist.
    """
    if temperatures.as_drawn:
        return model
    share = growth_of(design, temperatures)
    ring, disc, carrier, pin, shaft = (1.0 + one for one in share[:5])
    pitch, tooth = ring * model.ring_pitch_radius, ring * model.tooth_radius
    eccentricity, made = shaft * model.eccentricity, model.disc.generated
    return replace(
        model,
        disc=CycloidDisc(
            model.lobe_count,
            pitch,
            eccentricity,
            tooth,
            equidistant=disc * made.tooth_radius - tooth,
            radial=pitch - disc * made.pitch_radius,
            rotation=model.disc.rotation,
            throw=disc * made.eccentricity - eccentricity,
        ),
        ring_pitch_radius=pitch,
        tooth_radius=tooth,
        eccentricity=eccentricity,
        pin_circle_radius=carrier * model.pin_circle_radius,
        pin_reach=(share.carrier - share.disc) * model.pin_circle_radius,
        pin_contact_radius=pin * model.pin_contact_radius,
        hole_radius=disc * model.hole_radius,
        # Rings that press on what rolls have no play left; how hard they press is not counted.
        cam=CamSpring(
            model.cam.stiffness, model.cam.exponent, max(model.cam.play + share.play, 0.0)
        ),
    )
