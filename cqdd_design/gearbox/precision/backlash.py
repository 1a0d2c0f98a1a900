"""Backlash of rigid parts: the free range of the carrier with crank and ring held."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cqdd_design.errors import ContactError
from cqdd_design.gearbox.contact.errors import GearboxErrors
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.states import NominalStates, error_states, nominal_states
from cqdd_design.gearbox.contact.sweep import output_turn_angles, perfect_angles
from cqdd_design.geometry.meshing import tooth_centres

FloatArray = NDArray[np.float64]

@dataclass(frozen=True, eq=False)
class Backlash:
    """Free range of the carrier at A crank angles, bodies rigid, crank and ring held.

    Attributes
    ----------
    crank_angle : array (A,)
        rad.
    least, greatest : array (A,)
        Ends of the range of the carrier's angle error, rad; the greatest is where a vanishing
        positive torque holds it, so it is the unloaded kinematic error too.
    overlap : array (A,)
        Greatest overlap that no motion removes, m; above `preload_limit` the parts are
        preloaded and have no backlash there.
    preload_limit : float
        m.
    """

    crank_angle: FloatArray
    least: FloatArray
    greatest: FloatArray
    overlap: FloatArray
    preload_limit: float

    @property
    def free(self) -> FloatArray:
        """Backlash at every angle, (A,), rad; zero where parts are preloaded."""
        return np.where(self.overlap > self.preload_limit, 0.0, np.maximum(self.greatest - self.least, 0.0))

    @property
    def mean(self) -> float:
        """Mean over the angles, rad."""
        return float(self.free.mean())

    @property
    def preloaded(self) -> bool:
        """Whether parts overlap at any angle, whatever they do."""
        return bool(np.any(self.overlap > self.preload_limit))


def backlash(
    model: ContactModel,
    crank_angle: FloatArray | None = None,
    *,
    errors: GearboxErrors | None = None,
    states: NominalStates | None = None,
) -> Backlash:
    """Backlash from gaps alone, re-linearised at each solution until it stands still.

    The range of the carrier's angle over all positions of every disc at which no gap to a ring
    tooth, at an output pin or in a cam bearing is negative; the carrier's bearing is rigid. Flanks
    count as their osculating circles where they touch, which is exact to the third order.

    Parameters
    ----------
    model : ContactModel
    crank_angle : array (A,), optional
        rad, rising; default the period of a perfect gearbox, an output turn with errors.
    errors : GearboxErrors, optional
    states : NominalStates, optional
        Of the same model and angles.

    Raises
    ------
    ContactError
        Where the parts are so loose that the teeth pass each other.
    """
    from cqdd_design.gearbox.precision.kernel import OVERLAP, backlash_sweep

    if states is None:
        if crank_angle is None:
            crank_angle = perfect_angles(model) if errors is None else output_turn_angles(model)
        states = nominal_states(model, np.asarray(crank_angle, dtype=float))
    changed = error_states(model, states, errors)
    count = len(states.crank_angle)
    ends, overlap = np.empty((count, 2)), np.empty(count)
    failed = backlash_sweep(
        states.rows,
        states.gaps + changed.gaps,
        states.ring.centre_curvature,
        tooth_centres(model.disc),
        states.crank_angle[:, None] + model.phases,
        states.pins.pin_angle,
        _apart(model, states, errors),
        changed.offset,
        changed.half_play,
        model.eccentricity,
        states.length,
        np.arange(count),
        states.crank_angle,
        ends,
        overlap,
    )
    if failed >= 0:
        raise ContactError(
            "the parts are too loose for a backlash: at crank angle "
            f"{math.degrees(states.crank_angle[failed]):.6g} deg nothing stops the carrier near "
            "its nominal place. Lower reducer.modification, output_pins.hole_clearance or "
            "cam_bearing.radial_clearance."
        )
    return Backlash(states.crank_angle, ends[:, 0], ends[:, 1], overlap, OVERLAP)


def _apart(
    model: ContactModel, states: NominalStates, errors: GearboxErrors | None
) -> FloatArray:
    """Hole off its pin by position errors, turned with the carrier, (A, D, P, 2)."""
    shape = (len(states.crank_angle), model.disc_count, model.pin_count, 2)
    if errors is None:
        return np.zeros(shape)
    apart = errors.hole_position - errors.pin_position
    back = -states.crank_angle / model.lobe_count
    cosine, sine = np.cos(back)[:, None, None], np.sin(back)[:, None, None]
    x, y = apart[..., 0], apart[..., 1]
    return np.stack([cosine * x - sine * y, sine * x + cosine * y], axis=-1)
