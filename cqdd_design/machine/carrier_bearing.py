"""The catalogue's answer to a carrier bearing of "auto" where external loads are stated."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cqdd_design.catalog.bearings import Bearing
from cqdd_design.design import Design
from cqdd_design.errors import CatalogError, ContactError, GeometryError
from cqdd_design.gearbox.bearing_life import basic_rating_life_hours, life_exponent
from cqdd_design.gearbox.cam_bearing import rolling_element
from cqdd_design.gearbox.checks.allowables import STATIC_SAFETY
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
from cqdd_design.gearbox.output_bearing import OutputLoad, dynamic_load, static_safety
from cqdd_design.gearbox.pack_loads import PackLoads
from cqdd_design.machine.machine import Machine
from cqdd_design.machine.output_loads import output_loads
from cqdd_design.solids.proportions import carrier_bearings

_ANGLES = 40
"""Crank angles over the period."""
_SPARE = 1.05
"""Reserve of what is chosen by rigid parts without friction, and judged with both."""


class ForLoads(NamedTuple):
    """A bearing for what an output holds, and whether it bears that."""

    bearing: Bearing
    bears: bool


def bearing_for_loads(machine: Machine) -> ForLoads | None:
    """The bearing, of those that fit, that a layout prefers and that bears the output's loads.

    Forces are those of rigid parts without friction. Where none bears them, the one with the
    most static safety; None where the loads are not known, or no bearing fits.
    """
    design, asked = machine.design, machine.design.requirements
    model = ContactModel.from_design(design)
    try:
        angles = perfect_angles(model, _ANGLES)
        torques = (asked.peak_torque, asked.continuous_torque)
        peak, lasting = (
            output_loads(machine, PackLoads.of([contact_sweep(model, torque, angles)]))
            for torque in torques
        )
        every = carrier_bearings(design, machine.cam)
    except (CatalogError, ContactError, GeometryError):
        return None
    fitting = [one.bearing for one in every if one.bearing.static_rating is not None]
    for row in fitting:
        if static_safety(row, peak) >= _SPARE * STATIC_SAFETY and _lasts(row, lasting, design):
            return ForLoads(row, bears=True)
    most = max(fitting, key=lambda row: static_safety(row, peak), default=None)
    return None if most is None else ForLoads(most, bears=False)


def _lasts(row: Bearing, load: OutputLoad, design: Design) -> bool:
    if row.dynamic_rating is None:
        return False
    exponent = life_exponent(rolling_element(row))
    equal = float(np.mean(dynamic_load(row, load) ** exponent) ** (1.0 / exponent))
    speed = design.requirements.held_speed / design.reducer.ratio
    rated = row.dynamic_rating / _SPARE
    hours = float(basic_rating_life_hours(rated, equal, speed, exponent))
    return hours >= design.requirements.life_hours
