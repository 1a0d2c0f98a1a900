"""Energy of an equilibrium of plates that are one body, and how it changes with the crank."""

from __future__ import annotations

import numpy as np

from cqdd_design.gearbox.contact import laws
from cqdd_design.gearbox.contact.kernel_values import Toleranced
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.states import NominalStates
from cqdd_design.geometry.contours import FloatArray


def energy_slope(
    states: NominalStates,
    changed: Toleranced,
    state: FloatArray,
    force: FloatArray,
    cam_force: FloatArray,
    teeth: int,
) -> FloatArray:
    """dPi/dphi by the envelope theorem: forces times the rates of closing at a held state, N m."""
    discs = state[:, 3:].reshape(len(state), -1, 1, 3)
    against = np.repeat(discs, force.shape[2], axis=2)
    against[:, :, teeth:] -= state[:, None, None, :3]
    spin, arm_rate, gap_rate, softening = np.moveaxis(states.rates, -1, 0)
    nx, ny = states.rows[..., 0], states.rows[..., 1]
    across = nx * against[..., 1] - ny * against[..., 0]
    closing = -(spin * across + arm_rate * against[..., 2]) - gap_rate - changed.gap_rates
    # At a held closing a softer contact stores less: dU/dc = -F^2/2 of a law F c + ...
    slope = np.sum(force * closing - 0.5 * force**2 * softening, axis=(1, 2))
    return np.asarray(slope + np.sum(cam_force * changed.offset_rates, axis=(1, 2)))


def spring_energy(
    model: ContactModel, states: NominalStates, force: FloatArray, cam_force: FloatArray
) -> FloatArray:
    """Energy in all contacts and cam bearings, (A,), J, from their forces."""
    teeth = model.tooth_count
    stored = np.zeros(len(force))
    for law, part, series in (
        (model.ring_law, slice(None, teeth), np.zeros((model.disc_count, 1))),
        (model.pin_law, slice(teeth, None), model.pin_series[:, None]),
    ):
        load = force[..., part]
        local = laws.stored_energy(law, states.coefficient[..., part], series, load)
        stored += local.sum(axis=(1, 2))
    spring = model.carried_cam
    load = np.hypot(cam_force[..., 0], cam_force[..., 1])
    closed = (load / spring.stiffness) ** (1.0 / spring.exponent)
    return np.asarray(stored + np.sum(load * closed / (spring.exponent + 1.0), axis=1))
