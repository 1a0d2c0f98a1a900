"""What an output pin is: a shoulder screw that is bought, or a ground dowel; its limits of size.

Shoulder screws are sold of tough steels that are no raceways: a hardened pin is a dowel. One that a
sleeve turns on is ground to h5, in a bore of G6, as makers of needle cages ask for.
"""

from __future__ import annotations

from cqdd_design.catalog.fits import fit_limits
from cqdd_design.catalog.materials import find_material
from cqdd_design.catalog.screws import ShoulderScrew, find_shoulder_screw, pin_diameter_limits
from cqdd_design.design.reducer import OutputPins
from cqdd_design.errors import CatalogError

BARE, RACEWAY = "f9", "h5"
"""Zones of a pin as shoulder screws have it, and of one that something turns on."""
RUNNER_BORE = "G6"
"""Of what turns on a pin, or runs round the needles on it."""


def shoulder_screw(pins: OutputPins) -> ShoulderScrew | None:
    """The shoulder screw that output pins are; None where they are ground dowels."""
    if find_material(pins.material).is_hardened:
        return None
    try:
        return find_shoulder_screw(pins.diameter)
    except CatalogError:
        return None


def pin_zone(pins: OutputPins) -> str:
    """The tolerance zone of output pins (ISO 286)."""
    return RACEWAY if pins.sleeve_diameter and shoulder_screw(pins) is None else BARE


def pin_limits(pins: OutputPins) -> tuple[float, float]:
    """Least and greatest real diameter of output pins, m.

    Raises
    ------
    CatalogError
        When the table of their zone does not know the size.
    """
    if shoulder_screw(pins) is not None:
        return pin_diameter_limits(pins.diameter)
    zone = fit_limits(pin_zone(pins), pins.diameter)
    return pins.diameter + zone.lower, pins.diameter + zone.upper


def mean_pin_diameter(pins: OutputPins) -> float:
    """Mean of the limits of output pins, to which hole clearances count, m."""
    least, greatest = pin_limits(pins)
    return 0.5 * (least + greatest)
