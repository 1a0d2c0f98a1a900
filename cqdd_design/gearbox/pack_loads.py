"""Forces of the discs on eccentric shaft and carrier."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.geometry.contours import ComplexArray, FloatArray


@dataclass(frozen=True, eq=False)
class PackLoads:
    """What C load cases put on both at A crank angles, D discs counted from the carrier plate.

    Attributes
    ----------
    on_shaft, on_carrier : complex array (C, A, D)
        Force of a disc on its eccentric, and on the carrier's pins together, x + i y in the ring's
        frame, N.
    centre : complex array (A, D)
        Of the eccentrics, m.
    """

    on_shaft: ComplexArray
    on_carrier: ComplexArray
    centre: ComplexArray

    @classmethod
    def of(cls, sweeps: Sequence[ContactSweep]) -> PackLoads:
        """Of sweeps over the same crank angles."""
        return cls(
            on_shaft=np.stack([-_complex(one.cam_force) for one in sweeps]),
            on_carrier=np.stack([-_complex(one.pin_load.sum(axis=2)) for one in sweeps]),
            centre=_complex(sweeps[0].disc_centre),
        )

    @property
    def torque(self) -> FloatArray:
        """Of every disc on the shaft about its axis, (C, A, D), N m."""
        return np.asarray(np.imag(np.conj(self.centre) * self.on_shaft))

    @property
    def turning(self) -> ComplexArray:
        """Forces as the shaft meets them, the first disc's eccentric on its x axis, (C, A, D), N.

        What turns with the crank stands still here: the shaft bends to and fro only by as much as
        these forces change over the period and with the sense of the torque.
        """
        toward = np.conj(self.centre[:, 0]) / np.abs(self.centre[:, 0])
        return np.asarray(self.on_shaft * toward[:, None])


def _complex(vectors: FloatArray) -> ComplexArray:
    return np.asarray(vectors[..., 0] + 1j * vectors[..., 1])
