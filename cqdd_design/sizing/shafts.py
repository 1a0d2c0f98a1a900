"""What is asked of the next search where a design's shaft, or what it runs in, is too weak.

A cam bearing with a wider bore leaves a thicker shaft and room for larger bearings at its ends, and
takes material from the discs. So does less eccentricity, at the price of more force on what rolls.
Where the peak torque was not stated, less of it may cost less.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import replace

import numpy as np

from cqdd_design.errors import DesignError, GeometryError
from cqdd_design.machine import Machine
from cqdd_design.machine.end_bearing import END_KEY, on_stronger_ends
from cqdd_design.machine.temperatures import undisturbed_temperatures
from cqdd_design.results import Check
from cqdd_design.sizing.able import PEAK
from cqdd_design.sizing.bearable import JUST, bearable, weaker
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.spaces import Found
from cqdd_design.solids.proportions import seat_bearings
from cqdd_design.verdict.bore_line import bore_line
from cqdd_design.verdict.joint_lines import bell_line
from cqdd_design.verdict.retention_lines import shoulder_on_shaft
from cqdd_design.verdict.rotor_lines import rotor_lines
from cqdd_design.verdict.shaft_lines import shaft_lines

_BELL, _CAM = "BELL-JOINT", "CAM-JOINT"
BONDS = frozenset({_BELL, _CAM})
"""Lines of what is bonded on the shaft: the colder, the stronger."""
ENDS = "SUPPORT-STATIC"
AT_PEAK = frozenset({"SHAFT-STRENGTH", ENDS, _CAM})
"""Lines of the shaft that less peak torque helps: the strength and a loose cam's bond about in
proportion, the bearings by less, since what the rotor puts on them stays."""
ROTOR = frozenset({"SHAFT-ROTOR-GAP", "SHAFT-STUB"})
"""Lines of what hangs on the shaft's stub."""
_SHOULDER = "RETENTION-SHOULDER"
ANY_TORQUE = ROTOR | {"BORE", _SHOULDER}
"""Lines that no less torque helps."""
SHAFT = AT_PEAK | ANY_TORQUE | {"SHAFT-FATIGUE", "SUPPORT-LIFE"} | BONDS
"""Lines that a cam bearing with a wider bore helps."""
THICKNESS = frozenset({"SHAFT-STRENGTH", "SHAFT-FATIGUE"})
"""Lines that a thinner shaft does worse."""
_ENDS_ALONE = frozenset({ENDS, "SUPPORT-LIFE"})
_NO_DOUBT = 0.05
"""By which a margin has to differ from 1 by the temperatures of a machine on other bearings."""
_SHORT = frozenset({"fail", "unknown"})
_THROW = "reducer.eccentricity"
_LEAST_THROW, _THROW_STEP = 0.6, 0.005
"""Share of an eccentricity to which it is lowered at most for a thicker shaft, and by which."""
_WIDER, _SAME = 1.001, 0.999
"""Of a bore: the least of the next wider one, and one that is no narrower."""


def weak_lines(machine: Machine) -> tuple[Check, ...]:
    """Lines of `SHAFT` that a machine does not meet, but for the bonds, which hang on heat.

    With rigid discs and ring, whose forces are within a few per cent.
    """
    return tuple(_weak(machine.rigid))


def _weak(rigid: Machine) -> Iterator[Check]:
    """Those lines, what takes longest last."""
    yield from (one for one in shaft_lines(rigid) if one.id in SHAFT and one.status in _SHORT)
    # What is not known of a rotor no shaft tells.
    yield from (one for one in rotor_lines(rigid) if one.status == "fail")
    for line_of in (bore_line, shoulder_on_shaft):
        line = line_of(rigid)
        if line is not None and line.status == "fail":
            yield line


def with_sound_ends(found: Found) -> Found:
    """The design with its weak lines; where its shaft's bearings alone bear too little, on others.

    Those with the largest bore leave the thickest journals, but thin ones bear little: where
    another that fits bears enough on a journal that does, the gearbox stays as it is.
    """
    sized = found.sized
    found = replace(found, weak=weak_lines(sized.machine))
    if not found.weak or not {line.id for line in found.weak} <= _ENDS_ALONE:
        return found
    for other in on_stronger_ends(sized.machine.rigid):
        # A smaller bore leaves the rotor a thinner stub to be bonded on.
        if any(_weak(other)) or _gives_way(other, sized.machine.rigid):
            continue
        named = other.seats[0].bearing.designation
        return replace(found, sized=sized.remade({END_KEY: named}), weak=())
    return found


def _gives_way(machine: Machine, like: Machine) -> bool:
    """Whether the bond of shaft and bell does, as warm as parts get that do not press.

    By those of a machine on other bearings at its shaft's ends, where that leaves no doubt.
    """
    line = bell_line(machine, undisturbed_temperatures(like))
    if line.known and abs(line.margin - 1.0) < _NO_DOUBT:
        line = bell_line(machine, undisturbed_temperatures(machine))
    return line.status == "fail"


def stronger_shaft(hunt: Hunt, found: Found, every: Iterable[Check]) -> None:
    """Have the next search make a stronger shaft, or ask less of it where that leaves more torque.

    Parameters
    ----------
    every : iterable of Check
        Of the design, with lines of `SHAFT` that it does not meet.
    """
    bore = found.sized.machine.cam.bore_diameter
    wider = replace(hunt, least_bore=_WIDER * bore)
    lines = [line for line in every if line.id in SHAFT and line.status in _SHORT]
    hunt.thicker = _thicker_shaft(found.sized.machine, lines)
    if PEAK in hunt.requirements.derived and all(
        line.known and line.id in AT_PEAK for line in lines
    ):
        share = JUST * min(line.margin for line in lines)
        left = hunt.frame(found.space, {}).bearings
        if (
            all(one.bore_diameter < wider.least_bore for one in left)
            or bearable(wider, found).both < share
        ):
            hunt.requirements = weaker(hunt.requirements, share, 1.0)
            # What a shaft as thick as this bears is known.
            hunt.least_bore = _SAME * bore
            return
    hunt.least_bore = wider.least_bore


def _thicker_shaft(machine: Machine, lines: Iterable[Check]) -> tuple[float, float] | None:
    """A cam bearing's bore and the eccentricity at which a shaft in it may do, both m.

    By the bearings at its ends: with the square of their bore goes the bond on the shaft's stub,
    and what they bear with their rating. None for other lines, or where it takes far less
    eccentricity.
    """
    margins = {line.id: line.margin if line.known else 0.0 for line in lines}
    if not margins or not margins.keys() <= {_BELL, ENDS} or min(margins.values()) <= 0.0:
        return None
    now, throw = machine.seats[0].bearing, machine.design.reducer.eccentricity
    bore = now.bore_diameter / math.sqrt(margins[_BELL]) if _BELL in margins else 0.0
    rating = (now.static_rating or math.inf) / margins[ENDS] if ENDS in margins else 0.0
    for share in np.arange(1.0, _LEAST_THROW, -_THROW_STEP):
        less = float(share * throw)
        with suppress(DesignError, GeometryError):
            ends, _ = seat_bearings(machine.changed({_THROW: less}).design, machine.cam)
            able = ends.bearing.static_rating or 0.0
            if ends.bearing.bore_diameter >= bore and able >= rating:
                return machine.cam.bore_diameter, less
    return None


def turn_to_less_throw(hunt: Hunt) -> bool:
    """Whether the next search tries less eccentricity, where no wider cam bearing helped."""
    if hunt.thicker is None:
        return False
    bore, hunt.most_throw = hunt.thicker
    hunt.least_bore, hunt.thicker = _SAME * bore, None
    return True
