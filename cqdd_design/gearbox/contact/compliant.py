"""Contact equilibria whose carrier turns as it is built, and whose bodies yield.

The plate carries the output torque; the cap hangs on the pins, which hand it their share of every
force and bring it back to the plate, so that the net torque on it is zero. Both turn about one
axis: neither tilts, and the cap does not move sideways against the plate.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cqdd_design.errors import ContactError, UsageError
from cqdd_design.gearbox.contact import laws
from cqdd_design.gearbox.contact.kernel_values import (
    Compliance,
    Rubbing,
    SweepResult,
    Toleranced,
    YieldingResult,
)
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.problem import sweep_problem
from cqdd_design.gearbox.contact.rubbing import ContactFriction, rubbing
from cqdd_design.gearbox.contact.states import NominalStates
from cqdd_design.gearbox.pin_beam import PinBeam
from cqdd_design.geometry.contours import FloatArray

_NO_BODIES = np.empty((0, 0, 0, 0))


def carrier_compliance(
    pin_count: int, beam: PinBeam, tie: float = 0.0, bodies: FloatArray | None = None
) -> Compliance:
    """What yields behind the contacts of a gearbox whose cap hangs on its pins.

    Parameters
    ----------
    pin_count : int
        N_w; together they hold the cap by N_w joint R_w^2 against the plate.
    beam : PinBeam
        Of every pin. A cantilever's cap bears nothing and is as good as none.
    tie : float
        What else holds it, over R_w^2, N/m.
    bodies : array (A, D, C, C), optional
        Closing that every contact of a disc (last axis but one) loses by a unit force of another
        (last axis), friction with it, m/N; default rigid.
    """
    return Compliance(
        pins=np.ascontiguousarray(beam.influence),
        at_cap=np.ascontiguousarray(beam.at_cap),
        # Where no pin reaches a cap, any spring holds it: nothing moves it against the plate.
        join=pin_count * beam.joint + tie or 1.0,
        bodies=np.ascontiguousarray(_NO_BODIES if bodies is None else bodies.swapaxes(-1, -2)),
    )


def model_compliance(model: ContactModel, bodies: FloatArray | None = None) -> Compliance:
    """That of a gearbox whose plate and cap turn apart, :attr:`.ContactModel.pin`.

    Parameters
    ----------
    bodies : array (A, D, C, C), optional
        As in :func:`carrier_compliance`.

    Raises
    ------
    UsageError
        Where they are one body.
    """
    if model.pin is None:
        raise UsageError("a carrier whose plates are one body has no compliance of its own.")
    tie = model.tie / model.pin_circle_radius**2
    return carrier_compliance(model.pin_count, model.pin, tie, bodies)


def new_result(count: int, discs: int, contacts: int) -> YieldingResult:
    """Room for the equilibria of A angles, D discs and C contacts each."""
    return YieldingResult(
        states=np.empty((count, 4 + 3 * discs)),
        approach=np.empty((count, discs, contacts)),
        force=np.empty((count, discs, contacts)),
        cam_force=np.empty((count, discs, 2)),
        torsional=np.empty(count),
        steps=np.zeros(count, dtype=np.int64),
    )


def compliant_states(
    model: ContactModel,
    torque: float,
    states: NominalStates,
    changed: Toleranced,
    start: SweepResult,
    compliance: Compliance,
    friction: ContactFriction | None = None,
) -> YieldingResult:
    """Equilibria with compliance, from those of held plates and rigid bodies.

    Parameters
    ----------
    torque : float
        On the plate, N m.
    states, changed
        From :func:`.states.nominal_states` and :func:`.states.error_states`.
    start : SweepResult
        Equilibria without compliance, best with the same friction: from
        :func:`.sweep_kernel.solve_sweep` or :func:`.friction_sweep_kernel.rub_sweep`.

    Raises
    ------
    ContactError
        Where no forces carry the load, naming the angle.
    """
    from cqdd_design.gearbox.contact.compliant_sweep_kernel import yield_sweep

    contacts, springs, load, turns, _ = sweep_problem(model, torque, states, changed)
    none = ContactFriction("drive", 0.0, 0.0)
    rubs: Rubbing = rubbing(model, states, friction or none, torque)
    result = new_result(*states.gaps.shape)
    solve: Any = yield_sweep
    failed = solve(contacts, springs, load, rubs, compliance, turns, start.states, result)
    if failed >= 0:
        why = "with the carrier's cap on its pins"
        if friction is not None:
            why += f" and friction of {friction.tooth:g} at teeth and {friction.pin:g} at pins"
        raise ContactError(
            f"at crank angle {math.degrees(states.crank_angle[failed]):.6g} deg and {torque:g} N*m "
            f"no forces carry the load {why}; lower the torque or the friction."
        )
    return result


def compliant_energy(
    model: ContactModel,
    torque: float,
    states: NominalStates,
    compliance: Compliance,
    found: YieldingResult,
) -> FloatArray:
    """Pi = E - T gamma of equilibria with compliance, gamma the plate's turn, (A,), J.

    Without friction every one of them is the least of its angle, and the crank's torque is T/n
    and the derivative of Pi over the crank angle (:func:`compliant_slope`).
    """
    teeth, force = model.tooth_count, found.force
    stored = np.zeros(len(force))
    for law, part in ((model.ring_law, slice(None, teeth)), (model.pin_law, slice(teeth, None))):
        coefficient = states.coefficient[..., part]
        stored += laws.stored_energy(law, coefficient, 0.0, force[..., part]).sum(axis=(1, 2))
    pushed = force[:, :, teeth:, None] * states.rows[:, :, teeth:, :2]
    stored += 0.5 * np.einsum("adpx,de,aepx->a", pushed, compliance.pins, pushed)
    if compliance.bodies.size:
        stored += 0.5 * np.einsum("ade,adec,adc->a", force, compliance.bodies, force)
    load = np.hypot(found.cam_force[..., 0], found.cam_force[..., 1])
    cam = model.carried_cam
    closed = (load / cam.stiffness) ** (1.0 / cam.exponent)
    stored += np.sum(load * closed / (cam.exponent + 1.0), axis=1)
    motion = found.states
    stored += 0.5 * compliance.join * (motion[:, 2] - motion[:, 3]) ** 2
    stored += 0.5 * (model.carrier_stiffness or 0.0) * np.sum(motion[:, :2] ** 2, axis=1)
    return np.asarray(stored - torque * motion[:, 2] / states.length)


def compliant_slope(
    model: ContactModel,
    states: NominalStates,
    changed: Toleranced,
    compliance: Compliance,
    found: YieldingResult,
    bodies_rate: FloatArray | None = None,
) -> FloatArray:
    """Work of the contacts per radian of the crank at held motions, (A,), N m.

    Forces times the rates at which their contacts close, as :func:`.energy.energy_slope` has it for
    held plates. A pin's own deflection turns with the crank directions of the discs that push it,
    which stay at the same angles to each other, so that what pins store does not change by itself.

    Parameters
    ----------
    bodies_rate : array (A, D, C, C), optional
        Derivative of the bodies' compliance over the crank angle, m/(N rad).
    """
    teeth, force, motion = model.tooth_count, found.force, found.states
    discs = motion[:, 4:].reshape(len(motion), -1, 1, 3)
    against = np.repeat(discs, force.shape[2], axis=2)
    turned = motion[:, 2:3] + compliance.at_cap * (motion[:, 3:4] - motion[:, 2:3])
    against[:, :, teeth:, :2] -= motion[:, None, None, :2]
    against[:, :, teeth:, 2] -= turned[..., None]
    spin, arm_rate, gap_rate, softening = np.moveaxis(states.rates, -1, 0)
    nx, ny = states.rows[..., 0], states.rows[..., 1]
    across = nx * against[..., 1] - ny * against[..., 0]
    closing = -(spin * across + arm_rate * against[..., 2]) - gap_rate - changed.gap_rates
    slope = np.sum(force * closing - 0.5 * force**2 * softening, axis=(1, 2))
    if bodies_rate is not None:
        slope -= 0.5 * np.einsum("ade,adec,adc->a", force, bodies_rate, force)
    return np.asarray(slope + np.sum(found.cam_force * changed.offset_rates, axis=(1, 2)))
