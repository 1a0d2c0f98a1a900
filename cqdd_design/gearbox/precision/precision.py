"""Precision of a gearbox: backlash, lost motion, stiffness, transmission error, torque ripple."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cqdd_design.errors import ContactError, UsageError
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.part_errors import GearboxErrors
from cqdd_design.gearbox.contact.rubbing import ContactFriction, FrictionChoice
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.contact.states import nominal_states
from cqdd_design.gearbox.contact.sweep import contact_sweep, output_turn_angles, perfect_angles
from cqdd_design.gearbox.precision.backlash import Backlash, backlash
from cqdd_design.gearbox.precision.orders import Order, order_spectrum
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.contours import FloatArray

LOST_MOTION_SHARE = 0.03
"""Lost motion is read between plus and minus 3 % of the torque, as makers' data sheets do."""

_ARCMIN = math.degrees(1.0) * 60.0
_PART_LOADS, _OVERLOADS = (0.125, 0.25, 0.5, 0.75), (2.0, 3.0)
"""Shares of the torque at which transmission error and windup are listed."""


@dataclass(frozen=True)
class LoadPoint:
    """Mean windup and transmission error at one torque.

    Attributes
    ----------
    torque : float
        N m.
    windup : float
        Mean of the carrier's angle error, rad.
    transmission_error : float
        Its peak to peak over the period, rad.
    ripple : float
        Peak-to-peak torque ripple at the output, N m.
    """

    torque: float
    windup: float
    transmission_error: float
    ripple: float


@dataclass(frozen=True, eq=False)
class Precision:
    """Precision at one torque over the true period.

    Attributes
    ----------
    torque : float
        N m; the continuous torque unless asked otherwise.
    friction : {"drive", "backdrive", "off"}
        Which way power goes through teeth and pins that rub, but for `free` and `lost_motion`.
    free : Backlash
        Of rigid parts at every angle.
    lost_motion : float
        Mean range of the carrier between -3 % and +3 % of the torque, rad.
    stiffness : float
        Mean secant between half of the torque and it, N m/rad.
    loaded, unloaded : array (A,)
        Carrier's angle error under the torque, and of rigid parts under a vanishing one, rad.
    ripple : array (A,)
        n times that of the crank torque which holds the load, N m.
    curve : tuple of LoadPoint
        Over torque.
    orders : tuple of Order
        Of the loaded error, amplitudes in rad, strongest first.
    ripple_orders : tuple of Order
        Of the ripple, amplitudes in N m.
    """

    torque: float
    friction: FrictionChoice
    free: Backlash
    lost_motion: float
    stiffness: float
    loaded: FloatArray
    unloaded: FloatArray
    ripple: FloatArray
    curve: tuple[LoadPoint, ...]
    orders: tuple[Order, ...]
    ripple_orders: tuple[Order, ...]

    @property
    def transmission_error(self) -> float:
        """Peak to peak of the loaded error, rad."""
        return float(np.ptp(self.loaded))

    @property
    def ripple_pp(self) -> float:
        """Peak to peak of the output torque's ripple, N m."""
        return float(np.ptp(self.ripple))

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the figures mean where they are not the usual."""
        if not self.free.preloaded:
            return ()
        tight = float(np.mean(self.free.overlap > self.free.preload_limit))
        most = self.free.overlap.max() * 1e6
        return (
            f"parts overlap by up to {most:.3g} um whatever they do, at {100.0 * tight:.0f} % of "
            "the crank angles: the gearbox is preloaded there, and its backlash is that of joints "
            "which are not pressed.",
        )

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form (``precision``)."""
        free = self.free.free * _ARCMIN
        return {
            "torque_Nm": self.torque,
            "friction": self.friction,
            "backlash_arcmin": float(free.mean()),
            "backlash_min_arcmin": float(free.min()),
            "backlash_max_arcmin": float(free.max()),
            "preload_overlap_um": (
                float(self.free.overlap.max()) * 1e6 if self.free.preloaded else 0.0
            ),
            "lost_motion_arcmin": self.lost_motion * _ARCMIN,
            "lost_motion_torque_Nm": LOST_MOTION_SHARE * abs(self.torque),
            "stiffness_Nm_per_arcmin": self.stiffness / _ARCMIN,
            "stiffness_Nm_per_rad": self.stiffness,
            "transmission_error_pp_arcmin": self.transmission_error * _ARCMIN,
            "transmission_error_unloaded_pp_arcmin": float(np.ptp(self.unloaded)) * _ARCMIN,
            "torque_ripple_pp_Nm": self.ripple_pp,
            "loaded_curve": [
                {
                    "torque_Nm": point.torque,
                    "windup_arcmin": point.windup * _ARCMIN,
                    "transmission_error_pp_arcmin": point.transmission_error * _ARCMIN,
                    "torque_ripple_pp_Nm": point.ripple,
                }
                for point in self.curve
            ],
            "orders": [_order_dict(o, "amplitude_arcmin", _ARCMIN) for o in self.orders],
            "ripple_orders": [_order_dict(o, "amplitude_Nm", 1.0) for o in self.ripple_orders],
        }


def _order_dict(order: Order, key: str, scale: float) -> dict[str, object]:
    return {
        "order_per_output_turn": order.per_output_turn,
        "order_per_crank_turn": order.per_crank_turn,
        "name": order.name,
        key: order.amplitude * scale,
    }


def precision(
    model: ContactModel,
    torque: float,
    *,
    angles: int = 360,
    errors: GearboxErrors | None = None,
    friction: FrictionChoice = "off",
) -> Precision:
    """Precision of a gearbox at one torque.

    Parameters
    ----------
    torque : float
        N m, not zero; its sign is the sense.
    angles : int
        Crank angles over the period of a perfect gearbox; with errors, 8 n (n+1) over an output
        turn are used.
    errors : GearboxErrors, optional
        Default a perfect gearbox.
    friction : {"drive", "backdrive", "off"}
        Which way power goes through teeth and pins that rub.

    Raises
    ------
    UsageError
        At zero torque.
    ContactError
        When the gearbox has no equilibrium at the torque.

    Notes
    -----
    Stiffness is the secant between 50 % and 100 % of the torque, beyond the take-up of the
    clearances, as makers of cycloidal reducers state it; carrier, shaft and housing are rigid.
    The ripple is n times that of the crank torque which holds the load; without friction it is
    that of the energy, n dPi/dphi with Pi(phi, T) = min(E - T gamma). Backlash and lost motion are
    those of a crank that stands still, whose friction has no known sense, and leave it out.
    """
    if torque == 0.0:
        raise UsageError("precision is stated at a torque; give one that is not zero.")
    n, pins = model.lobe_count, model.pin_count
    perfect = errors is None
    angle = perfect_angles(model, angles) if perfect else output_turn_angles(model)
    span = model.period if perfect else kinematics.imperfect_period(n)
    states = nominal_states(model, angle)

    def solve(load: float, rubbed: ContactFriction | None = None) -> ContactSweep:
        return contact_sweep(model, load, errors=errors, states=states, friction=rubbed)

    free = backlash(model, errors=errors, states=states)
    rubbing = ContactFriction.of(model, friction)
    full = solve(torque, rubbing)
    small = LOST_MOTION_SHARE * torque
    lost = solve(small).carrier_angle_error - solve(-small).carrier_angle_error
    sweeps = {share: solve(share * torque, rubbing) for share in _PART_LOADS} | {1.0: full}
    for share in _OVERLOADS:
        try:
            sweeps[share] = solve(share * torque, rubbing)
        except ContactError:
            # The curve ends where the gearbox does.
            break
    windup = {share: float(s.carrier_angle_error.mean()) for share, s in sweeps.items()}
    ripple = n * full.crank_ripple
    return Precision(
        torque=torque,
        friction=friction,
        free=free,
        lost_motion=abs(float(lost.mean())),
        stiffness=0.5 * torque / (windup[1.0] - windup[0.5]),
        loaded=full.carrier_angle_error,
        unloaded=free.greatest,
        ripple=ripple,
        curve=tuple(
            LoadPoint(
                torque=share * torque,
                windup=windup[share],
                transmission_error=float(np.ptp(s.carrier_angle_error)),
                ripple=n * float(np.ptp(s.crank_ripple)),
            )
            for share, s in sweeps.items()
        ),
        orders=order_spectrum(full.carrier_angle_error, span, n, pins),
        ripple_orders=order_spectrum(ripple, span, n, pins),
    )
