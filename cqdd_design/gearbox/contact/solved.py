"""Contact equilibria over crank angle: forces, pressures, displacements, energy."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from cqdd_design.errors import UsageError
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.rubbing import ContactFriction
from cqdd_design.gearbox.contact.states import nominal_states
from cqdd_design.gearbox.hertz import line_contact_pressure
from cqdd_design.gearbox.output_pins import bending_modulus
from cqdd_design.geometry.contours import ComplexArray, FloatArray

IntArray = NDArray[np.int64]

_STEP = 1e-3
"""Half of the turn of the crank over which the change of a compliance is taken, rad."""


def _load(force: FloatArray, tangential: FloatArray, normal: FloatArray) -> FloatArray:
    across = np.stack([-normal[..., 1], normal[..., 0]], axis=-1)
    return np.asarray(force[..., None] * normal + tangential[..., None] * across)


def _mean_coefficient(tangential: FloatArray, force: FloatArray) -> float:
    """Friction of all contacts over their normal forces; 0 where nothing touches."""
    pressed = float(force.sum())
    return float(np.abs(tangential).sum()) / pressed if pressed > 0.0 else 0.0


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
    ring_tangential, pin_tangential : array (A, D, T) and (A, D, P)
        Friction on the disc along the normal turned a quarter turn counter-clockwise, N.
    friction : ContactFriction or None
        None without it.
    friction_work : array (A,)
        Of teeth and pins per radian of the crank, N m; not negative.
    cam_force : array (A, D, 2)
        Force of the cam bearing on the disc, N.
    disc_centre : array (A, D, 2)
        Nominal, m.
    disc_displacement : array (A, D, 3)
        x, y (m) and angle (rad).
    carrier_angle_error : array (A,)
        Of the plate, ahead of -phi/n positive, rad.
    cap_angle_error : array (A,) or None
        Of the cap, likewise; None where it is one body with the plate, and where there is none.
    carrier_displacement : array (A, 2)
        m; zero where the carrier's bearing is rigid.
    energy : array (A,)
        Pi = E - T gamma, J.
    contact_slope : array (A,)
        Work of the contacts per radian of the crank at a held state, with bodies as they are, N m.
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
    ring_tangential: FloatArray
    pin_tangential: FloatArray
    friction: ContactFriction | None
    friction_work: FloatArray
    cam_force: FloatArray
    disc_centre: FloatArray
    disc_displacement: FloatArray
    carrier_angle_error: FloatArray
    cap_angle_error: FloatArray | None
    carrier_displacement: FloatArray
    energy: FloatArray
    contact_slope: FloatArray
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
    def plate_angles(self) -> FloatArray:
        """Angle errors of the carrier's plates, its own and the cap's, (A, 2) or (A, 1), rad."""
        both = (self.carrier_angle_error, self.cap_angle_error)
        return np.column_stack([angle for angle in both if angle is not None])

    @cached_property
    def energy_slope(self) -> FloatArray:
        """Work of contacts and bodies per radian of the crank at a held state, (A,), N m.

        Without friction dPi/dphi, and the input torque is T/n plus this. What bodies yield changes
        with where they are pushed; friction is left out of that.
        """
        model, force = self.model, np.concatenate([self.ring_force, self.pin_force], axis=2)
        if model.bodies is None or model.pin is None:
            return self.contact_slope
        slope = self.contact_slope.copy()
        beside = [nominal_states(model, self.crank_angle + step) for step in (_STEP, -_STEP)]
        each = beside[0].compliances_at_once
        for some in (slice(first, first + each) for first in range(0, len(slope), each)):
            ahead, behind = (
                model.bodies.compliance(model, states.some(some), self.torque) for states in beside
            )
            rate = (ahead - behind) / (2.0 * _STEP)
            slope[some] -= 0.5 * np.einsum("adc,adce,ade->a", force[some], rate, force[some])
        return slope

    @property
    def ring_load(self) -> FloatArray:
        """Force of every ring tooth on a disc, friction included, (A, D, T, 2), N."""
        return _load(self.ring_force, self.ring_tangential, self.ring_normal)

    @property
    def pin_load(self) -> FloatArray:
        """Force of every pin on a disc, likewise, (A, D, P, 2), N."""
        return _load(self.pin_force, self.pin_tangential, self.pin_normal)

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
    def pin_moment(self) -> ComplexArray:
        """Bending moment in every pin at the sections of :class:`.PinBeam`, (A, D + 2, P), N m.

        Complex in the pin's own axes, outward and along the circle, as the force that bends it.
        """
        pin = self.model.pin
        if pin is None:
            raise UsageError("pins of plates that are one body have no known moments.")
        middle = self.pin_point - self.model.pin_contact_radius * self.pin_normal
        outward = middle[..., 0] + 1j * middle[..., 1]
        load = self.pin_load[..., 0] + 1j * self.pin_load[..., 1]
        force = -load * np.conj(outward) / np.abs(outward)
        moment = np.einsum("sd,adp->asp", pin.disc_moment, force)
        if self.cap_angle_error is not None:
            sway = self.model.pin_circle_radius * (self.cap_angle_error - self.carrier_angle_error)
            moment += 1j * (sway[:, None] * pin.sway_moment)[..., None]
        return np.asarray(moment)

    @property
    def pin_bending(self) -> FloatArray:
        """Greatest bending stress of every section of every pin, (A, D + 2, P), Pa."""
        return np.abs(self.pin_moment) / bending_modulus(self.model.pin_diameter)

    @property
    def cam_load(self) -> FloatArray:
        """Size of the cam force, (A, D), N."""
        return np.asarray(np.hypot(self.cam_force[..., 0], self.cam_force[..., 1]))

    @property
    def disc_torque(self) -> FloatArray:
        """Torque every disc takes from the carrier, (A, D), N m; they add up to the torque."""
        x, n = self.pin_point, self.pin_normal
        moment = x[..., 0] * n[..., 1] - x[..., 1] * n[..., 0]
        rubbed = self.pin_tangential * np.sum(x * n, axis=-1)
        return np.asarray(np.sum(self.pin_force * moment + rubbed, axis=-1))

    @property
    def crank_torque(self) -> FloatArray:
        """Torque on the crank that holds the cam forces at the nominal centres, (A,), N m.

        T/n where conjugate flanks touch without friction; more while the crank drives, less while
        it is driven, and against the crank's turning where friction locks the gearbox.
        """
        at, force = self.disc_centre, self.cam_force
        moment = at[..., 0] * force[..., 1] - at[..., 1] * force[..., 0]
        return np.asarray(np.sum(moment, axis=-1))

    @property
    def crank_ripple(self) -> FloatArray:
        """Crank torque that holds the load, less its mean, (A,), N m.

        By virtual work at held displacements: the rate of closing of the contacts under their
        forces, and in the sense that the crank turns the work of friction.
        """
        if self.friction is None:
            return self.energy_slope
        rubbed = self.friction_work - self.friction_work.mean()
        return np.asarray(self.energy_slope + self.friction.crank_sense(self.torque) * rubbed)

    @property
    def efficiency(self) -> float | None:
        """Efficiency of teeth and pins, from the mean of their work; None without load.

        Zero where friction locks the gearbox: the carrier alone does not turn the crank.
        """
        ideal = abs(self.torque) / self.model.lobe_count
        if ideal == 0.0:
            return None
        lost = float(self.friction_work.mean()) / ideal
        backward = self.friction is not None and self.friction.sense == "backdrive"
        return max(1.0 - lost, 0.0) if backward else 1.0 / (1.0 + lost)

    @property
    def mean_friction(self) -> tuple[float, float]:
        """Coefficients of teeth and of pins, by films the mean by force; 0 without friction."""
        if self.friction is None:
            return 0.0, 0.0
        if self.friction.felt is None:
            return self.friction.tooth, self.friction.pin
        return (
            _mean_coefficient(self.ring_tangential, self.ring_force),
            _mean_coefficient(self.pin_tangential, self.pin_force),
        )

    @property
    def uneven_sharing(self) -> float:
        """Torque of the most loaded disc over the mean of the discs, greatest over the angles."""
        share = np.abs(self.disc_torque)
        return float((share.max(axis=1) / share.mean(axis=1)).max())

    @property
    def teeth_in_contact(self) -> IntArray:
        """Loaded ring teeth, (A, D)."""
        return np.asarray(np.sum(self.ring_force > 0.0, axis=-1), dtype=np.int64)

    @property
    def maxima(self) -> dict[str, float]:
        """Greatest forces and pressures over this sweep, by their JSON keys."""
        found = {
            "ring_force_max_N": float(self.ring_force.max()),
            "output_pin_force_max_N": float(self.pin_force.max()),
            "cam_bearing_load_max_N": float(self.cam_load.max()),
            "ring_pressure_max_MPa": float(self.ring_pressure.max()) / 1e6,
            "output_pressure_max_MPa": float(self.pin_pressure.max()) / 1e6,
        }
        if self.model.pin is not None:
            found["output_pin_bending_max_MPa"] = float(self.pin_bending.max()) / 1e6
        return found

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
            "plate_angle_arcmin": (np.degrees(self.plate_angles) * 60.0).tolist(),
            "teeth_in_contact": self.teeth_in_contact.tolist(),
            "friction": "off" if self.friction is None else self.friction.sense,
            "friction_tooth": self.mean_friction[0],
            "friction_pin": self.mean_friction[1],
            "ring_tangential_N": self.ring_tangential.tolist(),
            "output_pin_tangential_N": self.pin_tangential.tolist(),
            "crank_torque_Nm": self.crank_torque.tolist(),
            "efficiency": self.efficiency,
            **self.maxima,
            "disc_torque_share": (share / share.sum()).tolist() if share.sum() > 0.0 else None,
        }
