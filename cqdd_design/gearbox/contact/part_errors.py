"""Part errors of a gearbox, and of many at once.

All zero is the perfect gearbox. The frames are those of the parts: ring errors in the ring's
frame, hole errors in the disc's frame (its x axis on +x at crank angle zero), pin errors in the
carrier's, cam errors along and across the crank direction of the disc.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.geometry.contours import FloatArray


@dataclass(frozen=True, eq=False)
class GearboxErrors:
    """Part errors of one gearbox.

    Attributes
    ----------
    tooth_position : array (n+1, 2)
        Displacement of every ring tooth's centre, m.
    tooth_radius : array (n+1,)
        Material added to every tooth's radius, m.
    disc_profile : array (D, 2, M)
        Cosine and sine coefficients of the harmonics 1 to M round the disc of material added
        along the normal, as a function of the profile parameter, m.
    hole_position : array (D, N_w, 2)
        m.
    hole_radius : array (D, N_w)
        Added to every hole's radius, m.
    pin_position : array (N_w, 2)
        m.
    pin_radius : array (N_w,)
        Added to every pin's radius, m.
    cam_centre : array (D, 2)
        Displacement of every cam's centre along and across its crank, m: the errors of
        eccentricity and of phase.
    cam_play : array (D,)
        Added to the total play of every cam bearing, m.
    """

    tooth_position: FloatArray
    tooth_radius: FloatArray
    disc_profile: FloatArray
    hole_position: FloatArray
    hole_radius: FloatArray
    pin_position: FloatArray
    pin_radius: FloatArray
    cam_centre: FloatArray
    cam_play: FloatArray

    @classmethod
    def none(cls, model: ContactModel, harmonics: int = 0) -> GearboxErrors:
        """Return the perfect gearbox of a model."""
        return ErrorBatch.none(model, 1, harmonics).one(0)


@dataclass(frozen=True, eq=False)
class ErrorBatch:
    """Part errors of S gearboxes: the fields of :class:`GearboxErrors` with a leading axis S."""

    tooth_position: FloatArray
    tooth_radius: FloatArray
    disc_profile: FloatArray
    hole_position: FloatArray
    hole_radius: FloatArray
    pin_position: FloatArray
    pin_radius: FloatArray
    cam_centre: FloatArray
    cam_play: FloatArray

    @classmethod
    def none(cls, model: ContactModel, count: int, harmonics: int = 0) -> ErrorBatch:
        """Return `count` perfect gearboxes of a model."""
        teeth, discs, pins = model.lobe_count + 1, model.disc_count, model.pin_count
        return cls(
            tooth_position=np.zeros((count, teeth, 2)),
            tooth_radius=np.zeros((count, teeth)),
            disc_profile=np.zeros((count, discs, 2, harmonics)),
            hole_position=np.zeros((count, discs, pins, 2)),
            hole_radius=np.zeros((count, discs, pins)),
            pin_position=np.zeros((count, pins, 2)),
            pin_radius=np.zeros((count, pins)),
            cam_centre=np.zeros((count, discs, 2)),
            cam_play=np.zeros((count, discs)),
        )

    @classmethod
    def of(cls, errors: GearboxErrors) -> ErrorBatch:
        """Return a batch of one."""
        return cls(**{name: getattr(errors, name)[None] for name in cls.__dataclass_fields__})

    def __len__(self) -> int:
        """Return the number of gearboxes."""
        return len(self.tooth_radius)

    def one(self, index: int) -> GearboxErrors:
        """Return the errors of one gearbox."""
        return GearboxErrors(
            **{name: getattr(self, name)[index] for name in self.__dataclass_fields__}
        )
