"""Part errors of a gearbox, and of many at once.

All zero is the perfect gearbox. The frames are those of the parts: ring errors in the ring's
frame, hole errors in the disc's frame (its x axis on +x at crank angle zero), pin errors in the
carrier's, cam errors along and across the crank direction of the disc. Where the carrier's axis
stands is a place in the ring's frame: it turns with neither carrier nor crank.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from cqdd_design.geometry.contours import FloatArray

SHAFT_SHARE = 0.5
"""How far the shaft stands off at the discs, over how far the carrier does: one of its bearings is
in the housing and one in the carrier, and the discs are between them."""

if TYPE_CHECKING:
    from cqdd_design.gearbox.contact.model import ContactModel


class GearboxErrors(NamedTuple):
    """Part errors of one gearbox; of many, every field with a leading axis S."""

    tooth_position: FloatArray
    """(n+1, 2) Displacement of every ring tooth's centre, m."""
    tooth_radius: FloatArray
    """(n+1,) Material added to every tooth's radius, m."""
    disc_profile: FloatArray
    """(D, 2, M) Cosine and sine coefficients of the harmonics 1 to M round the disc of material
    added along the normal, as a function of the profile parameter, m."""
    hole_position: FloatArray
    """(D, N_w, 2) m."""
    hole_radius: FloatArray
    """(D, N_w) Added to every hole's radius, m."""
    pin_position: FloatArray
    """(N_w, 2) m."""
    pin_radius: FloatArray
    """(N_w,) Added to every pin's radius, m."""
    cam_centre: FloatArray
    """(D, 2) Displacement of every cam's centre along and across its crank, m: the errors of
    eccentricity and of phase."""
    cam_play: FloatArray
    """(D,) Added to the total play of every cam bearing, m."""
    output_axis: FloatArray
    """(2,) Displacement of the carrier's axis from the ring's, in the ring's frame, m; the shaft is
    displaced by :data:`SHAFT_SHARE` of it."""

    @classmethod
    def none(cls, model: ContactModel, harmonics: int = 0) -> GearboxErrors:
        """Return the perfect gearbox of a model."""
        teeth, discs, pins = model.lobe_count + 1, model.disc_count, model.pin_count
        return cls(
            tooth_position=np.zeros((teeth, 2)),
            tooth_radius=np.zeros(teeth),
            disc_profile=np.zeros((discs, 2, harmonics)),
            hole_position=np.zeros((discs, pins, 2)),
            hole_radius=np.zeros((discs, pins)),
            pin_position=np.zeros((pins, 2)),
            pin_radius=np.zeros(pins),
            cam_centre=np.zeros((discs, 2)),
            cam_play=np.zeros(discs),
            output_axis=np.zeros(2),
        )

    def one(self, index: int) -> GearboxErrors:
        """Return one gearbox of many."""
        return GearboxErrors(*(field[index] for field in self))
