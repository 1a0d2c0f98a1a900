"""What the figures of toleranced gearboxes are held against."""

from __future__ import annotations

import math

from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.gearbox.bearing_life import load_for_life
from cqdd_design.gearbox.cam_bearing import cam_bearing
from cqdd_design.gearbox.checks import allowables
from cqdd_design.gearbox.life import cycles
from cqdd_design.gearbox.life.fatigue import contact_cycle_factor

BINDING_SHARE = 0.05
"""Torque that turns a gearbox without load, over the continuous torque, from which it binds."""


def lasting_pressure(design: Design) -> float:
    """Pressure that disc and ring bear for the required hours at the input speed, Pa.

    Every point of a flank is met n + 1 times an output turn. 0 where the catalogue knows no limit.
    """
    reducer, speed = design.reducer, design.requirements.input_speed
    limit = allowables.weaker(
        allowables.contact_limit_fatigue(find_material(reducer.disc_material)),
        allowables.contact_limit_fatigue(find_material(reducer.ring_material)),
    )
    output_turns = 3600.0 * allowables.LIFE_HOURS * speed / (2.0 * math.pi)
    met = output_turns / reducer.ratio * cycles.disc_cycles(reducer.ratio)
    return limit.value * float(contact_cycle_factor(met))


def limits(design: Design) -> dict[str, float]:
    """Limits by output, of those that have one; more is worse for all of them.

    Pressure and cam load are those that last the required hours at the input speed.
    """
    cam = cam_bearing(design, 1.0)
    found = {"unloaded_torque_Nm": BINDING_SHARE * design.requirements.continuous_torque}
    pressure = lasting_pressure(design)
    if pressure > 0.0:
        found["ring_pressure_max_MPa"] = pressure / 1e6
    if cam.bearing.dynamic_rating:
        found["cam_bearing_load_max_N"] = float(
            load_for_life(
                cam.bearing.dynamic_rating, allowables.LIFE_HOURS, cam.speed, cam.exponent
            )
        )
    return found
