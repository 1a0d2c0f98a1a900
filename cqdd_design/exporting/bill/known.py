"""Every designation that a price list may name: what the catalogues have, whatever a machine uses.

A workshop keeps one list for all of its machines. A row that no catalogue and no part of the
machine knows is a slip of the pen.
"""

from __future__ import annotations

import functools

from cqdd_design.catalog.adhesives import ROTOR_COMPOUND
from cqdd_design.catalog.bearings import bearings
from cqdd_design.catalog.dowels import dowels
from cqdd_design.catalog.encoders import encoder_magnets, encoder_sensors
from cqdd_design.catalog.lubricants import lubricants
from cqdd_design.catalog.motors import motors
from cqdd_design.catalog.printing import inserts
from cqdd_design.catalog.screws import shoulder_screws
from cqdd_design.catalog.shims import shim_rings
from cqdd_design.exporting.bill.substitutes import ordered_as
from cqdd_design.solids.selection import cap_screw, cap_screw_lengths, thread_sizes


@functools.lru_cache(maxsize=1)
def catalogue_designations() -> frozenset[str]:
    """All of them."""
    screws = (
        cap_screw(thread, length).designation
        for thread in thread_sizes()
        for length in cap_screw_lengths(thread)
    )
    shoulders = (
        row.designation(length) for row in shoulder_screws().values() for length in row.lengths
    )
    return frozenset(
        (
            *screws,
            *shoulders,
            *(one.designation for one in dowels()),
            *(ordered_as(row) for row in bearings().values()),
            *(one.designation for one in shim_rings()),
            *motors(),
            *lubricants(),
            *(one.name for one in encoder_sensors()),
            *(one.name for one in encoder_magnets()),
            *(one.name for one in inserts()),
            ROTOR_COMPOUND.name,
        )
    )
