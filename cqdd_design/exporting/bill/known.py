"""Every designation that a price list may name: what any machine may have, whatever this one uses.

A workshop keeps one list for all of its machines: made parts by their names, what the catalogues
have, and bought parts that are ordered to a size. A row that names none of them is a slip of the
pen.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Iterable

from cqdd_design.catalog.adhesives import EPOXY, RING_COMPOUND, ROTOR_COMPOUND
from cqdd_design.catalog.bearings import bearings
from cqdd_design.catalog.dowels import dowels
from cqdd_design.catalog.encoders import encoder_magnets, encoder_sensors
from cqdd_design.catalog.lubricants import lubricants
from cqdd_design.catalog.motors import motors
from cqdd_design.catalog.printing import inserts
from cqdd_design.catalog.screws import shoulder_screws
from cqdd_design.catalog.shims import shim_rings
from cqdd_design.exporting.bill.substitutes import ordered_as
from cqdd_design.solids.counterweights import NAMES as WEIGHTS
from cqdd_design.solids.motor_parts import ENCODER_MAGNET_MATERIAL
from cqdd_design.solids.selection import cap_screw, cap_screw_lengths, thread_sizes

MADE_PARTS = frozenset(
    (
        *("disc", "disc 1", "disc 2", "disc 3", "ring", "ring pin", "ring roller"),
        *("eccentric shaft", "eccentric cam", "cam bearing", "shaft bearing", "output bearing"),
        *("carrier plate", "carrier cap", "carrier column", "bearing nut"),
        *("dowel pin", "pin sleeve", "housing", "ring clamp", "output cover"),
        *("rotor bell", "rotor hub", "motor cover", *WEIGHTS),
    )
)
"""Names of the parts that are made, in any machine; of bearings where they are bushes."""
_SIZE = r"\d+(\.\d+)?"
_MAGNET = re.escape(ENCODER_MAGNET_MATERIAL.lower())
_TO_SIZE = (
    rf"shim rings {_SIZE} x {_SIZE}, cut from strip",
    rf"diametric magnet {_MAGNET} {_SIZE} x {_SIZE} mm",
    rf"ring magnet {_MAGNET}, magnetised across, {_SIZE} x {_SIZE} x {_SIZE} mm",
    r"magnetic encoder, \d+ bits",
)
"""What is ordered to a size, beside screws."""


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
            RING_COMPOUND,
            EPOXY,
        )
    )


def is_to_size(key: str) -> bool:
    """Whether a designation is one of a bought part that is ordered to a size.

    Screws are, where a standard's lengths do not reach: of a size that the catalogues have, with
    any length.

    Parameters
    ----------
    key : str
        In lower case, blanks single.

    Examples
    --------
    >>> is_to_size("shoulder screw 4 f9 x 41.5 m3"), is_to_size("shoulder screw 4 f9 x 41.5 m33")
    (True, False)
    """
    return _patterns().fullmatch(key) is not None


@functools.lru_cache(maxsize=1)
def _patterns() -> re.Pattern[str]:
    screws = (cap_screw(thread, _ANY).designation for thread in thread_sizes())
    shoulders = (row.designation(_ANY) for row in shoulder_screws().values())
    return re.compile("|".join((*_TO_SIZE, *_of_any_length((*screws, *shoulders)))))


_ANY, _ANY_TOLD = 7.775, "7775"
"""A length that no size has, m, and how a designation tells it in mm."""


def _of_any_length(designations: Iterable[str]) -> list[str]:
    return [re.escape(one.lower()).replace(_ANY_TOLD, _SIZE) for one in designations]
