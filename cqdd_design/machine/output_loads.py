"""What the bearing between carrier and housing holds."""

from __future__ import annotations

import math

import numpy as np

from cqdd_design.errors import CatalogError, DesignError
from cqdd_design.gearbox.output_bearing import OutputLoad
from cqdd_design.gearbox.pack_loads import PackLoads
from cqdd_design.machine.machine import Machine
from cqdd_design.machine.rotor_overhang import rotor_overhang
from cqdd_design.machine.shaft import disc_heights, knife_edges
from cqdd_design.machine.shaft_strength import carried_shares


def output_loads(machine: Machine, loads: PackLoads, external: float = 1.0) -> OutputLoad:
    """What the bearing between carrier and housing holds, (C, A).

    Of the pins and of the shaft's upper bearing, which sits in the carrier and holds down the end
    of the shaft whose other end carries the rotor; and of the external loads that the requirements
    state. The directions of these and of the pull on the rotor are not known: sizes add up.

    Parameters
    ----------
    external : float
        Share of the external loads that counts.

    Raises
    ------
    GeometryError
        When the machine cannot be laid out.
    """
    layout, asked = machine.layout, machine.design.requirements
    at, edges = disc_heights(layout.pack), knife_edges(layout.shaft)
    carrier, rotor = layout.carrier, rotor_on_carrier(machine)
    middle = carrier.bearing_bottom + 0.5 * carrier.output.bearing.width
    held = loads.on_shaft @ carried_shares(at, edges)[1]
    across = np.abs(loads.on_carrier.sum(axis=2) + held)
    tilting = np.abs(loads.on_carrier @ (at - middle) + held * (edges[1] - middle))
    return OutputLoad(
        radial=across + rotor + external * (asked.external_radial or 0.0),
        axial=np.full(across.shape, external * (asked.external_axial or 0.0)),
        moment=tilting + rotor * abs(edges[1] - middle) + external * (asked.external_moment or 0.0),
    )


def rotor_on_carrier(machine: Machine) -> float:
    """What the rotor puts on the shaft's upper bearing, N; 0 where it is not known."""
    try:
        upper = rotor_overhang(machine).on_bearings[1]
    except (CatalogError, DesignError):
        return 0.0
    return upper if math.isfinite(upper) else 0.0
