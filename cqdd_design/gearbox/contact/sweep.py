"""Solve the contact equilibrium over crank angle."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from cqdd_design.errors import ContactError, UsageError
from cqdd_design.gearbox.contact import laws
from cqdd_design.gearbox.contact.compliant import (
    compliant_energy,
    compliant_slope,
    compliant_states,
    model_compliance,
)
from cqdd_design.gearbox.contact.energy import energy_slope, spring_energy
from cqdd_design.gearbox.contact.films import MOST_ROUNDS, Felt
from cqdd_design.gearbox.contact.kernel_values import SweepResult, Toleranced
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.part_errors import GearboxErrors
from cqdd_design.gearbox.contact.problem import sweep_problem
from cqdd_design.gearbox.contact.rubbing import ContactFriction, rubbing, slip
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.contact.states import (
    NominalStates,
    error_states,
    nominal_states,
)
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.contours import FloatArray

ANGLES = 360
"""Default number of crank angles over the period of a perfect gearbox."""

_NEXT_TO_NOTHING = (0.0, 1e-6, 1e-5, 1e-4, 1e-3)
"""Shares of a usual torque that are tried for a gearbox without load."""

_REACH = 0.25
"""Displacement, in eccentricities, beyond which the nominal pose says nothing any more."""


def perfect_angles(model: ContactModel, count: int = ANGLES) -> FloatArray:
    """Crank angles over the period of a perfect gearbox, its end left out, (count,), rad."""
    return np.asarray(model.period * np.arange(count) / count)


def output_turn_count(lobe_count: int) -> int:
    """Least number of angles over an output turn that misses no error order, 8 n (n+1)."""
    return 8 * lobe_count * (lobe_count + 1)


def output_turn_angles(model: ContactModel, count: int | None = None) -> FloatArray:
    """Crank angles over one output turn, its end left out, rad; default 8 n (n+1) of them."""
    wanted = output_turn_count(model.lobe_count) if count is None else count
    return np.asarray(kinematics.imperfect_period(model.lobe_count) * np.arange(wanted) / wanted)


def contact_sweep(
    model: ContactModel,
    torque: float,
    crank_angle: FloatArray | None = None,
    *,
    errors: GearboxErrors | None = None,
    states: NominalStates | None = None,
    changed: Toleranced | None = None,
    friction: ContactFriction | None = None,
) -> ContactSweep:
    """Solve the contact equilibrium over crank angle.

    Parameters
    ----------
    torque : float
        On the carrier, counter-clockwise positive, N m; any finite number, zero included.
    crank_angle : array (A,), optional
        rad, best in rising order, because each state starts from its neighbours; default
        :func:`perfect_angles`, and :func:`output_turn_angles` with errors.
    errors : GearboxErrors, optional
        Default a perfect gearbox.
    states : NominalStates, optional
        From :func:`.states.nominal_states` for the same model and angles, where many sweeps share
        them.
    changed : Toleranced, optional
        From :func:`.states.error_states` for the same states and errors, likewise.
    friction : ContactFriction, optional
        Friction at teeth and pins; default none. Coefficients that follow from films are found
        with the forces, to :data:`.films.SETTLED`.

    Returns
    -------
    ContactSweep
        Every state balanced to 1e-9 of its load.

    Raises
    ------
    UsageError
        Without finite crank angles, or with errors of another gearbox.
    ContactError
        When a state has no equilibrium within reach of the nominal pose, naming its angle; when
        the load leaves the force law; when friction jams the gearbox.
    """
    from cqdd_design.gearbox.contact.sweep_kernel import solve_sweep

    if not math.isfinite(torque):
        raise ContactError(f"a torque of {torque} N*m has no equilibrium; give a finite one.")
    if states is None:
        if crank_angle is None:
            crank_angle = perfect_angles(model) if errors is None else output_turn_angles(model)
        angle = np.atleast_1d(np.asarray(crank_angle, dtype=float))
        if angle.ndim != 1 or not angle.size or not np.all(np.isfinite(angle)):
            raise UsageError("a contact sweep needs a list of finite crank angles, one or more.")
        states = nominal_states(model, angle)
    _refuse_misshapen(model, errors)
    if changed is None:
        changed = error_states(model, states, errors)
    problem = sweep_problem(model, torque, states, changed)
    result = problem[-1]
    solve: Any = solve_sweep
    failed = solve(*problem)
    if failed >= 0:
        raise ContactError(
            f"no contact equilibrium was found at crank angle "
            f"{math.degrees(states.crank_angle[failed]):.6g} deg and {torque:g} N*m; check the "
            "clearances in reducer.modification, output_pins.hole_clearance and cam_bearing."
        )
    _refuse_out_of_reach(model, torque, states, result.states)
    if friction is not None:
        result, friction = _with_friction(model, torque, states, changed, friction, result)
        _refuse_out_of_reach(model, torque, states, result.states)
    found = _joined(model, torque, states, changed, friction, result)
    _refuse_outside_law(model, torque, states, found.result.force)
    return _assemble(model, torque, states, found)


def idle_sweep(
    model: ContactModel,
    torque: float,
    states: NominalStates,
    friction: ContactFriction | None = None,
) -> ContactSweep:
    """Equilibria without load; where that leaves parts without a place, under next to none.

    Parts whose clearances warmth or a tight fit has nearly used up hang between contacts that
    just touch, and with friction then have no equilibrium under no load at all.

    Parameters
    ----------
    torque : float
        A usual one, N m, of which the load is up to a thousandth.
    states : NominalStates
    friction : ContactFriction, optional

    Raises
    ------
    ContactError
        As :func:`contact_sweep`, where neither has one.
    """
    for share in _NEXT_TO_NOTHING[:-1]:
        try:
            found = contact_sweep(model, share * torque, states=states, friction=friction)
        except ContactError:
            continue
        return replace(found, torque=0.0)
    last = _NEXT_TO_NOTHING[-1] * torque
    return replace(contact_sweep(model, last, states=states, friction=friction), torque=0.0)


class _Found(NamedTuple):
    """Equilibria with what belongs to them: the cap's turn (A,), rad, energy and its slope (A,)."""

    result: SweepResult
    cap_angle: FloatArray | None
    energy: FloatArray
    contact_slope: FloatArray
    friction: ContactFriction | None


def _with_friction(
    model: ContactModel,
    torque: float,
    states: NominalStates,
    changed: Toleranced,
    friction: ContactFriction,
    smooth: SweepResult,
) -> tuple[SweepResult, ContactFriction]:
    """Equilibria with friction, from those without it, and the friction they have settled on."""
    from cqdd_design.gearbox.contact.friction_sweep_kernel import rub_sweep

    contacts, springs, load, turns, result = sweep_problem(model, torque, states, changed)
    solve: Any = rub_sweep
    felt = friction.under(model, states, smooth.force)
    for _ in range(MOST_ROUNDS):
        rubs = rubbing(model, states, felt, torque)
        failed = solve(contacts, springs, load, rubs, turns, smooth, result)
        if failed >= 0:
            raise _jammed(torque, states.crank_angle[failed], friction)
        # Where plate and cap turn apart these forces are only a start.
        if model.pin is not None:
            return result, felt
        under = friction.under(model, states, result.force)
        if felt.agrees(under, result.force):
            return result, felt
        felt = under
    raise _unsettled(torque)


def _jammed(torque: float, crank_angle: float, friction: ContactFriction) -> ContactError:
    return ContactError(
        f"at crank angle {math.degrees(crank_angle):.6g} deg and {torque:g} N*m "
        f"friction of {friction.tooth:g} at the teeth and {friction.pin:g} at the pins jams "
        "the gearbox: no forces carry the load while the contacts slide. Lower "
        "reducer.friction.tooth and reducer.friction.pin."
    )


def _unsettled(torque: float) -> ContactError:
    return ContactError(
        f"at {torque:g} N*m forces and the friction of their films do not settle; state "
        "reducer.friction.tooth and reducer.friction.pin as coefficients."
    )


def _held(
    model: ContactModel,
    torque: float,
    states: NominalStates,
    changed: Toleranced,
    friction: ContactFriction | None,
    result: SweepResult,
) -> _Found:
    """Equilibria of plates that are one body."""
    state, force, cam_force = result.states, result.force, result.cam_force
    energy = spring_energy(model, states, force, cam_force)
    energy += 0.5 * (model.carrier_stiffness or 0.0) * np.sum(state[:, :2] ** 2, axis=-1)
    energy -= torque * state[:, 2] / states.length
    slope = energy_slope(states, changed, state, force, cam_force, model.tooth_count)
    return _Found(result, None, energy, slope, friction)


def _joined(
    model: ContactModel,
    torque: float,
    states: NominalStates,
    changed: Toleranced,
    friction: ContactFriction | None,
    start: SweepResult,
) -> _Found:
    """Equilibria of plates that turn apart as the carrier is built, from those of one body."""
    if model.pin is None:
        return _held(model, torque, states, changed, friction, start)
    count = len(states.crank_angle)
    each = count if model.bodies is None else states.compliances_at_once
    if count <= each:
        return _joined_some(model, torque, states, changed, friction, start)
    # A compliance of bodies takes memory by the square of the contacts: a part of them at a time.
    parts = []
    for first in range(0, count, each):
        some = slice(first, first + each)
        of_errors = Toleranced(
            gaps=changed.gaps[some],
            gap_rates=changed.gap_rates[some],
            offset=changed.offset[some],
            offset_rates=changed.offset_rates[some],
            half_play=changed.half_play,
        )
        near = SweepResult._make(array[some] for array in start)
        parts.append(_joined_some(model, torque, states.some(some), of_errors, friction, near))
    result = SweepResult._make(
        np.concatenate(arrays) for arrays in zip(*(part.result for part in parts), strict=True)
    )
    caps = [part.cap_angle for part in parts if part.cap_angle is not None]
    felt = [
        part.friction.felt.coefficient
        for part in parts
        if part.friction is not None and part.friction.felt is not None
    ]
    if friction is not None and felt:
        friction = replace(friction, felt=Felt(np.concatenate(felt)))
    return _Found(
        result,
        np.concatenate(caps) if caps else None,
        np.concatenate([part.energy for part in parts]),
        np.concatenate([part.contact_slope for part in parts]),
        friction,
    )


def _joined_some(
    model: ContactModel,
    torque: float,
    states: NominalStates,
    changed: Toleranced,
    friction: ContactFriction | None,
    start: SweepResult,
) -> _Found:
    """Equilibria of :func:`_joined` at so many angles that their compliance fits into memory."""
    felt = None if friction is None else friction.under(model, states, start.force)
    bodies = None
    if model.bodies is not None:
        # What bodies yield hardly knows the tangential force, and not the rounds between films.
        share = None if felt is None else rubbing(model, states, felt, torque).share
        bodies = model.bodies.compliance(model, states, torque, share)
    compliance = model_compliance(model, bodies)
    for _ in range(MOST_ROUNDS):
        found = compliant_states(model, torque, states, changed, start, compliance, felt)
        if felt is None:
            break
        under = felt.under(model, states, found.force)
        if felt.agrees(under, found.force):
            break
        felt = under
    else:
        raise _unsettled(torque)
    result = SweepResult(
        states=np.delete(found.states, 3, axis=1),
        force=found.force,
        cam_force=found.cam_force,
        torsional=found.torsional,
        steps=start.steps + found.steps,
    )
    _refuse_out_of_reach(model, torque, states, found.states)
    return _Found(
        result,
        found.states[:, 3] / states.length if np.any(compliance.at_cap) else None,
        compliant_energy(model, torque, states, compliance, found),
        compliant_slope(model, states, changed, compliance, found),
        felt,
    )


def _refuse_misshapen(model: ContactModel, errors: GearboxErrors | None) -> None:
    """Raise where part errors are those of another gearbox."""
    if errors is None:
        return
    wanted = GearboxErrors.none(model, errors.disc_profile.shape[-1])
    for name, given, right in zip(errors._fields, errors, wanted, strict=True):
        if np.shape(given) != right.shape:
            raise UsageError(
                f"errors.{name} has the shape {np.shape(given)}; this gearbox needs {right.shape}."
            )


def _refuse_out_of_reach(
    model: ContactModel, torque: float, states: NominalStates, state: FloatArray
) -> None:
    """Raise where a part has moved so far that the nominal pose no longer describes it."""
    most = np.abs(state).max(axis=1)
    at = int(most.argmax())
    limit = _REACH * model.eccentricity
    if most[at] <= limit:
        return
    raise ContactError(
        f"at crank angle {math.degrees(states.crank_angle[at]):.6g} deg and {torque:g} N*m the "
        f"parts would have to move by {most[at] * 1e3:.3g} mm to carry the load, more than "
        f"{limit * 1e3:.3g} mm (a quarter of the eccentricity): the teeth do not reach or the "
        "torque is beyond this gearbox. Lower reducer.modification or "
        "output_pins.hole_clearance, or the torque."
    )


def _refuse_outside_law(
    model: ContactModel, torque: float, states: NominalStates, force: FloatArray
) -> None:
    teeth = model.tooth_count
    for law, part in ((model.ring_law, slice(None, teeth)), (model.pin_law, slice(teeth, None))):
        limit = laws.force_limit(law, states.coefficient[..., part])
        if np.any(force[..., part] > limit):
            raise ContactError(
                f"at {torque:g} N*m a contact carries {force[..., part].max():.4g} N, where "
                "Johnson's law of approach turns back (the contact is as wide as the body is "
                "deep); lower the torque or use the Palmgren law."
            )


def _assemble(
    model: ContactModel,
    torque: float,
    states: NominalStates,
    found: _Found,
) -> ContactSweep:
    friction = found.friction
    result, teeth, length = found.result, model.tooth_count, states.length
    state, force = result.states, result.force
    displacement = state[:, 3:].reshape(len(state), -1, 3).copy()
    displacement[..., 2] /= length
    tangential = np.zeros_like(force)
    if friction is not None:
        tangential = rubbing(model, states, friction, torque).share * force
    work = np.sum(np.abs(tangential * slip(model, states)), axis=(1, 2))
    centre = kinematics.disc_centre(model.eccentricity, states.crank_angle[:, None], model.phases)
    pin_normal = states.rows[:, :, teeth:, :2]
    pin_at = model.pin_circle_radius * np.stack(
        [np.cos(states.pin_angle), np.sin(states.pin_angle)], axis=-1
    )
    touching = np.any(force > 0.0, axis=(1, 2))
    return ContactSweep(
        model=model,
        torque=torque,
        crank_angle=states.crank_angle,
        ring_force=force[:, :, :teeth],
        ring_normal=states.rows[:, :, :teeth, :2],
        ring_point=states.ring.point,
        ring_parameter=states.ring.parameter,
        ring_equivalent_radius=states.ring.equivalent_radius,
        pin_force=force[:, :, teeth:],
        pin_normal=pin_normal,
        pin_point=pin_at[:, None] + model.pin_contact_radius * pin_normal,
        ring_tangential=tangential[:, :, :teeth],
        pin_tangential=tangential[:, :, teeth:],
        friction=friction,
        friction_work=work,
        cam_force=result.cam_force,
        disc_centre=centre,
        disc_displacement=displacement,
        carrier_angle_error=state[:, 2] / length,
        cap_angle_error=found.cap_angle,
        carrier_displacement=state[:, :2],
        energy=found.energy,
        contact_slope=found.contact_slope,
        stiffness=np.where(touching, np.maximum(result.torsional, 0.0) * length**2, 0.0),
        steps=result.steps,
    )
