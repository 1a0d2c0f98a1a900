"""What the figures of toleranced gearboxes are held against."""

from __future__ import annotations

import functools
import math

import numpy as np

from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.errors import ContactError
from cqdd_design.gearbox.bearing_life import load_for_life
from cqdd_design.gearbox.cam_bearing import cam_bearing
from cqdd_design.gearbox.checks import allowables
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.states import nominal_states
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
from cqdd_design.gearbox.life import cycles
from cqdd_design.gearbox.life.fatigue import contact_cycle_factor, contact_cycles
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.contours import FloatArray


def lasting_pressure(design: Design) -> float:
    """Pressure that disc and ring bear for the required hours, Pa.

    Every point of a flank is met n + 1 times an output turn. Under a duty it is that at the torque
    which stands for it; those at its other torques are as much more as of perfect parts. 0 where
    the catalogue knows no limit, or nothing turns under load.
    """
    limit = _pressure_limit(design)
    hours, (met, shares) = design.requirements.life_hours, _duty(design)
    if limit <= 0.0 or not met.any():
        return 0.0
    if len(met) == 1:
        return limit * float(contact_cycle_factor(hours * met[0]))
    from scipy.optimize import brentq

    def lacking(log: float) -> float:
        return math.log(hours * _worn_per_hour(limit, limit * math.exp(log), met, shares))

    return limit * math.exp(brentq(lacking, *_PRESSURES))


def lasting_hours(design: Design, pressure: float) -> float | None:
    """Hours that disc and ring bear a pressure (Pa), which is as in `lasting_pressure`.

    None where that is not known, or nothing turns under load.
    """
    limit, (met, shares) = _pressure_limit(design), _duty(design)
    if limit <= 0.0 or not met.any():
        return None
    return 1.0 / _worn_per_hour(limit, pressure, met, shares)


_PRESSURES = math.log(0.02), math.log(50.0)
"""Logarithms of shares of the limit between which a lasting pressure is looked for."""


def _worn_per_hour(limit: float, pressure: float, met: FloatArray, shares: FloatArray) -> float:
    """Share of the life that goes in an hour (Palmgren and Miner)."""
    return float(np.sum(met / contact_cycles(pressure * shares, limit)))


@functools.lru_cache(maxsize=4)
def _duty(design: Design) -> tuple[FloatArray, FloatArray]:
    """How often every flank is met in an hour of each load case, and its pressure as a share."""
    asked, n = design.requirements, design.reducer.ratio
    met_in_turns = 3600.0 / (2.0 * math.pi) * cycles.disc_cycles(n)
    if not asked.load_cases:
        return np.array([met_in_turns * asked.held_speed / n]), np.ones(1)
    cases = [one for one in asked.load_cases if one.torque and one.speed and one.share]
    met = met_in_turns * np.array([one.share * abs(one.speed) for one in cases])
    return met, _pressures(design, np.abs([one.torque for one in cases]))


def _pressures(design: Design, torques: FloatArray) -> FloatArray:
    """Greatest pressures of perfect parts at torques (N m) over that at what stands for the duty.

    Swept with rigid discs and ring at a few torques: in between a power of the torque.
    """
    if not torques.size:
        return torques
    model, stands = ContactModel.from_design(design), design.requirements.equal_torque
    few = np.unique([*np.geomspace(torques.min(), torques.max(), _SWEPT), stands])
    states = nominal_states(model, perfect_angles(model, _ANGLES))
    try:
        found = [contact_sweep(model, one, states=states).ring_pressure.max() for one in few]
    except ContactError:
        # What carries no such torque is told elsewhere: pressures of one contact.
        return np.sqrt(torques / stands)
    logs = np.interp(np.log(torques), np.log(few), np.log(found))
    return np.asarray(np.exp(logs) / found[int(np.searchsorted(few, stands))])


_SWEPT, _ANGLES = 6, 24
"""Torques of a duty at which perfect parts are swept, and crank angles of each sweep."""


def _pressure_limit(design: Design) -> float:
    """Contact fatigue limit of the weaker of disc and ring, Pa."""
    disc, ring = design.reducer.disc_material, design.reducer.ring_material
    of = allowables.contact_limit_fatigue
    return allowables.weaker(of(find_material(disc)), of(find_material(ring))).value


def limits(design: Design) -> dict[str, float]:
    """Limits by output, of those that have one; more is worse for all of them.

    Pressure and cam load are those that last the required hours at the mean speed; a duty that only
    stands has none.
    """
    asked = design.requirements
    found = {"unloaded_torque_Nm": allowables.BINDING_SHARE * asked.continuous_torque}
    pressure = lasting_pressure(design)
    if pressure > 0.0:
        found["ring_pressure_max_MPa"] = pressure / 1e6
    cam, n = cam_bearing(design, 1.0), design.reducer.ratio
    speed = float(kinematics.cam_bearing_speed_ring_fixed(n, asked.equal_speed))
    if cam.bearing.dynamic_rating and speed > 0.0:
        found["cam_bearing_load_max_N"] = float(
            load_for_life(cam.bearing.dynamic_rating, asked.life_hours, speed, cam.exponent)
        )
    return found
