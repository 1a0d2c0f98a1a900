"""Columns between the carrier's plate and cap, and the holes of the discs that they pass through.

A column is a tube over its screw. It stands on the circle of the output pins, midway between two of
them, where the disc has as much room to bore and profile as beside a pin::

        o  pin       first column at clocking + pi/N_w, the next 2 pi/N_c further
       (C) column    hole in the disc: column + 2 e + running clearance
        o  pin

There is no room for columns outside the discs: lobes and ring mesh all around, so that whatever
stands off the lobes on one side meets ring teeth on the other.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.catalog.screws import column_screw
from cqdd_design.geometry.contours import FloatArray

if TYPE_CHECKING:
    from cqdd_design.design.reducer import Reducer

COLUMN_MATERIAL = "AISI 4140 Q&T 540C"
RUNNING_CLEARANCE = 0.2e-3
"""Of column in hole on the diameter beyond what the parts' own play asks for, m.

For tapped holes and cuts that stand a few hundredths off, and for pins, sleeves and seats that
yield under load.
"""


def has_columns(reducer: Reducer) -> bool:
    """Whether columns tie the cap to the plate."""
    return reducer.carrier.joint == "columns"


def column_offsets(reducer: Reducer) -> FloatArray:
    """Angles (N_c,) of the columns from the first output pin, rad; none without columns."""
    if not has_columns(reducer):
        return np.zeros(0)
    count = reducer.carrier.column_count
    between = np.pi / reducer.output_pins.count
    return np.asarray(between + 2.0 * np.pi * np.arange(count) / count)


def column_clearance(reducer: Reducer) -> float:
    """Clearance of column in hole on the diameter, m: it never touches.

    The disc may go aside by the clearance of the output holes, and the column on its screw by the
    play of its bore; `RUNNING_CLEARANCE` is left then.
    """
    screw = column_screw(reducer.carrier.column_diameter)
    play = screw.bore - screw.thread
    return max(reducer.output_pins.hole_clearance, 0.0) + play + RUNNING_CLEARANCE


def column_hole_diameter(reducer: Reducer) -> float:
    """Diameter of the discs' holes for columns: column + 2 e + clearance, m; 0 without columns."""
    if not has_columns(reducer):
        return 0.0
    swept = reducer.carrier.column_diameter + 2.0 * reducer.eccentricity
    return swept + column_clearance(reducer)
