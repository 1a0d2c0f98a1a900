"""From a design to a machine: what was left to the catalogue gets a name."""

from __future__ import annotations

from cqdd_design.catalog.bearings import AUTO, find_bearing
from cqdd_design.catalog.motors import Motor
from cqdd_design.design import Design
from cqdd_design.machine.machine import Machine


def resolve(design: Design, motor: Motor | None = None) -> Machine:
    """Make a design concrete.

    Parameters
    ----------
    motor : Motor, optional
        Default what the design says of its motor, over the catalogue's row.

    Raises
    ------
    GeometryError
        When the disc or its holes cannot exist and the cam bearing is "auto".
    InfeasibleError
        When "auto" finds no bearing that fits.
    """
    named = design
    if design.reducer.cam_bearing.designation == AUTO:
        # Only a choice needs the loads, and the rooms that find them take long to import.
        from cqdd_design.machine.cam import named_bearing

        named = named_bearing(design)
    machine = Machine(
        given=design,
        design=named,
        cam=find_bearing(named.reducer.cam_bearing.designation),
        motor=motor or design.motor_row,
    )
    asked, carrier = design.requirements, "reducer.carrier_bearing.designation"
    hangs = asked.external_moment or asked.external_axial or asked.external_radial
    if hangs and design.reducer.carrier_bearing.designation == AUTO:
        from cqdd_design.machine.carrier_bearing import bearing_for_loads

        chosen = bearing_for_loads(machine)
        if chosen is not None:
            return machine.changed({carrier: chosen.bearing.designation})
    return machine
