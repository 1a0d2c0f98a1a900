"""Contact equilibrium over crank angle: forces, pressures, displacements, energy."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cqdd_design.errors import ContactError, UsageError
from cqdd_design.gearbox.contact import laws
from cqdd_design.gearbox.contact.kernel_values import Contacts, Load, Springs, SweepResult
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.part_errors import GearboxErrors
from cqdd_design.gearbox.contact.states import (
    ErrorStates,
    NominalStates,
    error_states,
    nominal_states,
)
from cqdd_design.gearbox.hertz import line_contact_pressure
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.contours import FloatArray

IntArray = NDArray[np.int64]

ANGLES = 360
"""Default number of crank angles over the period of a perfect gearbox."""

_REACH = 0.25
"""Displacement, in eccentricities, beyond which the nominal pose says nothing any more."""


def perfect_angles(model: ContactModel, count: int = ANGLES) -> FloatArray:
    """Crank angles over the period of a perfect gearbox, its end left out, (count,), rad."""
    period = kinematics.mesh_period(model.lobe_count, model.pin_count)
    return np.asarray(period * np.arange(count) / count)


def output_turn_count(lobe_count: int) -> int:
    """Least number of angles over an output turn that misses no error order, 8 n (n+1)."""
    return 8 * lobe_count * (lobe_count + 1)


def output_turn_angles(model: ContactModel, count: int | None = None) -> FloatArray:
    """Crank angles over one output turn, its end left out, rad; default 8 n (n+1) of them."""
    wanted = output_turn_count(model.lobe_count) if count is None else count
    return np.asarray(kinematics.imperfect_period(model.lobe_count) * np.arange(wanted) / wanted)


@dataclass(frozen=True, eq=False)
class ContactSweep:
    """Contact equilibria at A crank angles, D discs, T = n + 1 ring teeth, P output pins.

    Points, normals and centres are those of the nominal pose, in which every disc balances.

    Attributes
    ----------
    torque : float
        On the carrier, counter-clockwise positive, N m.
    crank_angle : array (A,)
        rad.
    ring_force : array (A, D, T)
        N.
    ring_normal, ring_point : array (A, D, T, 2)
        Unit force on the disc; contact point, m.
    ring_parameter, ring_equivalent_radius : array (A, D, T)
        Place on the disc's profile (rad), R_eq (m).
    pin_force : array (A, D, P)
        N.
    pin_normal, pin_point : array (A, D, P, 2)
    cam_force : array (A, D, 2)
        Force of the cam bearing on the disc, N.
    disc_centre : array (A, D, 2)
        Nominal, m.
    disc_displacement : array (A, D, 3)
        x, y (m) and angle (rad).
    carrier_angle_error : array (A,)
        Ahead of -phi/n positive, rad.
    carrier_displacement : array (A, 2)
        m; zero where the carrier's bearing is rigid.
    energy : array (A,)
        Pi = E - T gamma, J.
    energy_slope : array (A,)
        dPi/dphi at this load, N m; the input torque is T/n plus this.
    stiffness : array (A,)
        Tangent dT/dgamma, N m/rad; zero where nothing touches.
    steps : array (A,)
        Newton steps used.
    """

    model: ContactModel
    torque: float
    crank_angle: FloatArray
    ring_force: FloatArray
    ring_normal: FloatArray
    ring_point: FloatArray
    ring_parameter: FloatArray
    ring_equivalent_radius: FloatArray
    pin_force: FloatArray
    pin_normal: FloatArray
    pin_point: FloatArray
    cam_force: FloatArray
    disc_centre: FloatArray
    disc_displacement: FloatArray
    carrier_angle_error: FloatArray
    carrier_displacement: FloatArray
    energy: FloatArray
    energy_slope: FloatArray
    stiffness: FloatArray
    steps: IntArray

    @property
    def state_vectors(self) -> FloatArray:
        """Carrier and discs as the kernel holds them, angles times the pin circle, (A, 3 + 3 D)."""
        length = self.model.pin_circle_radius
        discs = self.disc_displacement * np.array([1.0, 1.0, length])
        carrier = np.column_stack([self.carrier_displacement, length * self.carrier_angle_error])
        return np.concatenate([carrier, discs.reshape(len(carrier), -1)], axis=1)

    @property
    def ring_pressure(self) -> FloatArray:
        """Peak Hertz pressure at every tooth, (A, D, T), Pa."""
        return line_contact_pressure(
            self.ring_force,
            self.model.contact_length,
            self.ring_equivalent_radius,
            self.model.ring_modulus,
        )

    @property
    def pin_pressure(self) -> FloatArray:
        """Peak Hertz pressure of every pin in its hole, (A, D, P), Pa."""
        return line_contact_pressure(
            self.pin_force,
            self.model.contact_length,
            self.model.pin_equivalent_radius,
            self.model.pin_modulus,
        )

    @property
    def cam_load(self) -> FloatArray:
        """Size of the cam force, (A, D), N."""
        return np.asarray(np.hypot(self.cam_force[..., 0], self.cam_force[..., 1]))

    @property
    def disc_torque(self) -> FloatArray:
        """Torque every disc takes from the carrier, (A, D), N m; they add up to the torque."""
        x, n = self.pin_point, self.pin_normal
        moment = x[..., 0] * n[..., 1] - x[..., 1] * n[..., 0]
        return np.asarray(np.sum(self.pin_force * moment, axis=-1))

    @property
    def uneven_sharing(self) -> float:
        """Torque of the most loaded disc over the mean of the discs, greatest over the angles."""
        share = np.abs(self.disc_torque)
        return float((share.max(axis=1) / share.mean(axis=1)).max())

    @property
    def teeth_in_contact(self) -> IntArray:
        """Loaded ring teeth, (A, D)."""
        return np.asarray(np.sum(self.ring_force > 0.0, axis=-1), dtype=np.int64)

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form (``contact``): the arrays, and their maxima over this sweep."""
        share = np.abs(self.disc_torque).mean(axis=0)
        shown = self.disc_displacement * 1e6
        return {
            "torque_Nm": self.torque,
            "crank_angle_deg": np.degrees(self.crank_angle).tolist(),
            "ring_force_N": self.ring_force.tolist(),
            "ring_normal": self.ring_normal.tolist(),
            "ring_point_mm": (1e3 * self.ring_point).tolist(),
            "ring_pressure_MPa": (self.ring_pressure / 1e6).tolist(),
            "ring_flank_parameter_deg": np.degrees(self.ring_parameter).tolist(),
            "output_pin_force_N": self.pin_force.tolist(),
            "output_pin_normal": self.pin_normal.tolist(),
            "output_pin_point_mm": (1e3 * self.pin_point).tolist(),
            "output_pressure_MPa": (self.pin_pressure / 1e6).tolist(),
            "cam_force_N": self.cam_force.tolist(),
            "disc_torque_Nm": self.disc_torque.tolist(),
            "disc_centre_mm": (1e3 * self.disc_centre).tolist(),
            "disc_displacement_um": shown.tolist(),
            "carrier_angle_error_arcmin": (np.degrees(self.carrier_angle_error) * 60.0).tolist(),
            "teeth_in_contact": self.teeth_in_contact.tolist(),
            "ring_force_max_N": float(self.ring_force.max()),
            "output_pin_force_max_N": float(self.pin_force.max()),
            "cam_bearing_load_max_N": float(self.cam_load.max()),
            "ring_pressure_max_MPa": float(self.ring_pressure.max()) / 1e6,
            "output_pressure_max_MPa": float(self.pin_pressure.max()) / 1e6,
            "disc_torque_share": (share / share.sum()).tolist() if share.sum() > 0.0 else None,
        }


def contact_sweep(
    model: ContactModel,
    torque: float,
    crank_angle: FloatArray | None = None,
    *,
    errors: GearboxErrors | None = None,
    states: NominalStates | None = None,
    changed: ErrorStates | None = None,
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
    changed : ErrorStates, optional
        From :func:`.states.error_states` for the same states and errors, likewise.

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
        the load leaves the force law.
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
    _refuse_outside_law(model, torque, states, result.force)
    return _assemble(model, torque, states, changed, result)


def _refuse_misshapen(model: ContactModel, errors: GearboxErrors | None) -> None:
    """Raise where part errors are those of another gearbox."""
    if errors is None:
        return
    wanted = GearboxErrors.none(model, errors.disc_profile.shape[-1])
    for name in wanted.__dataclass_fields__:
        given, shape = np.shape(getattr(errors, name)), getattr(wanted, name).shape
        if given != shape:
            raise UsageError(f"errors.{name} has the shape {given}; this gearbox needs {shape}.")


def sweep_problem(
    model: ContactModel, torque: float, states: NominalStates, changed: ErrorStates
) -> tuple[Contacts, Springs, Load, FloatArray, SweepResult]:
    """Arguments of :func:`.sweep_kernel.solve_sweep`, the last of them still to be filled."""
    count, discs, each = states.gaps.shape
    contacts = Contacts(
        rows=states.rows,
        gaps=states.gaps + changed.gaps,
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
        cam_stiffness=model.cam.stiffness,
        cam_exponent=model.cam.exponent,
        carrier_stiffness=model.carrier_stiffness or 0.0,
    )


def stiffness_scale(model: ContactModel, torque: float) -> float:
    """Stiffness of a pin under its share of the torque, N/m."""
    load = max(abs(torque) / model.pin_circle_radius / model.disc_count, 1e-9)
    closed = laws.approach(model.pin_law, model.pin_coefficient(), model.pin_series[0], load)
    return load / max(abs(float(closed)), 1e-15)


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
    changed: ErrorStates,
    result: SweepResult,
) -> ContactSweep:
    teeth, length = model.tooth_count, states.length
    state, force, cam_force = result.states, result.force, result.cam_force
    discs = state[:, 3:].reshape(len(state), -1, 3)
    energy = _spring_energy(model, states, force, cam_force)
    carrier = state[:, :2]
    energy += 0.5 * (model.carrier_stiffness or 0.0) * np.sum(carrier**2, axis=-1)
    energy -= torque * state[:, 2] / length
    centre = kinematics.disc_centre(model.eccentricity, states.crank_angle[:, None], model.phases)
    pin_normal = states.rows[:, :, teeth:, :2]
    pin_at = model.pin_circle_radius * np.stack(
        [np.cos(states.pins.pin_angle), np.sin(states.pins.pin_angle)], axis=-1
    )
    touching = np.any(force > 0.0, axis=(1, 2))
    displacement = discs.copy()
    displacement[..., 2] /= length
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
        pin_point=pin_at[:, None] + model.pin_radius * pin_normal,
        cam_force=cam_force,
        disc_centre=centre,
        disc_displacement=displacement,
        carrier_angle_error=state[:, 2] / length,
        carrier_displacement=carrier,
        energy=energy,
        energy_slope=energy_slope(states, changed, state, force, cam_force, teeth),
        stiffness=np.where(touching, np.maximum(result.torsional, 0.0) * length**2, 0.0),
        steps=result.steps,
    )


def energy_slope(
    states: NominalStates,
    changed: ErrorStates,
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


def _spring_energy(
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
    spring = model.cam
    load = np.hypot(cam_force[..., 0], cam_force[..., 1])
    closed = (load / spring.stiffness) ** (1.0 / spring.exponent)
    return np.asarray(stored + np.sum(load * closed / (spring.exponent + 1.0), axis=1))
