"""What the figures of toleranced gearboxes are held against."""

from __future__ import annotations

import math

from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.gearbox.bearing_life import load_for_life
from cqdd_design.gearbox.cam_bearing import cam_bearing
from cqdd_design.gearbox.checks import allowables
from cqdd_design.gearbox.life import cycles
from cqdd_design.gearbox.life.fatigue import contact_cycle_factor, contact_cycles


def lasting_pressure(design: Design) -> float:
    """Pressure that disc and ring bear for the required hours at the continuous torque, Pa.

    Every point of a flank is met n + 1 times an output turn. 0 where the catalogue knows no limit.
    """
    met = design.requirements.life_hours * _met_per_hour(design)
    return _pressure_limit(design) * float(contact_cycle_factor(met))


def lasting_hours(design: Design, pressure: float) -> float | None:
    """Hours that disc and ring bear a pressure (Pa) at the input speed; None where not known."""
    limit = _pressure_limit(design)
    if limit <= 0.0:
        return None
    return float(contact_cycles(pressure, limit)) / _met_per_hour(design)


def _met_per_hour(design: Design) -> float:
    turns = 3600.0 * design.requirements.held_speed / (2.0 * math.pi) / design.reducer.ratio
    return turns * cycles.disc_cycles(design.reducer.ratio)


def _pressure_limit(design: Design) -> float:
    """Contact fatigue limit of the weaker of disc and ring, Pa."""
    disc, ring = design.reducer.disc_material, design.reducer.ring_material
    of = allowables.contact_limit_fatigue
    return allowables.weaker(of(find_material(disc)), of(find_material(ring))).value


def limits(design: Design) -> dict[str, float]:
    """Limits by output, of those that have one; more is worse for all of them.

    Pressure and cam load are those that last the required hours at the input speed.
    """
    cam = cam_bearing(design, 1.0)
    found = {"unloaded_torque_Nm": allowables.BINDING_SHARE * design.requirements.continuous_torque}
    pressure = lasting_pressure(design)
    if pressure > 0.0:
        found["ring_pressure_max_MPa"] = pressure / 1e6
    if cam.bearing.dynamic_rating:
        found["cam_bearing_load_max_N"] = float(
            load_for_life(
                cam.bearing.dynamic_rating,
                design.requirements.life_hours,
                cam.speed,
                cam.exponent,
            )
        )
    return found
