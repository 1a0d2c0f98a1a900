"""A sweep of a gearbox as the compiled kernels take it."""

from __future__ import annotations

import numpy as np

from cqdd_design.gearbox.contact import laws
from cqdd_design.gearbox.contact.kernel_values import (
    Contacts,
    Load,
    Springs,
    SweepResult,
    Toleranced,
)
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.states import NominalStates
from cqdd_design.geometry.contours import FloatArray


def sweep_problem(
    model: ContactModel, torque: float, states: NominalStates, changed: Toleranced
) -> tuple[Contacts, Springs, Load, FloatArray, SweepResult]:
    """Arguments of :func:`.sweep_kernel.solve_sweep`, the last of them still to be filled."""
    count, discs, each = states.gaps.shape
    contacts = Contacts(
        rows=states.rows,
        gaps=changed.gaps,
        coefficient=states.coefficient,
        offset=changed.offset,
        half_play=changed.half_play,
    )
    load = Load(torque / states.length, stiffness_scale(model, torque))
    result = SweepResult(
        states=np.empty((count, 3 + 3 * discs)),
        force=np.empty((count, discs, each)),
        cam_force=np.empty((count, discs, 2)),
        torsional=np.empty(count),
        steps=np.zeros(count, dtype=np.int64),
    )
    return contacts, springs_of(model), load, states.turns, result


def springs_of(model: ContactModel) -> Springs:
    """The force laws of a gearbox as the kernels take them."""
    return Springs(
        teeth=model.tooth_count,
        ring_law=model.ring_law.code,
        pin_law=model.pin_law.code,
        ring_logarithm=model.ring_law.logarithm,
        pin_logarithm=model.pin_law.logarithm,
        pin_series=np.ascontiguousarray(model.pin_series),
        cam_stiffness=model.carried_cam.stiffness,
        cam_exponent=model.carried_cam.exponent,
        carrier_stiffness=model.carrier_stiffness or 0.0,
    )


def stiffness_scale(model: ContactModel, torque: float) -> float:
    """Stiffness of a pin under its share of the torque, N/m."""
    load = max(abs(torque) / model.pin_circle_radius / model.disc_count, 1e-9)
    closed = laws.approach(model.pin_law, model.pin_coefficient(), model.pin_series[0], load)
    return load / max(abs(float(closed)), 1e-15)
