"""The bearings at both ends of the eccentric shaft: what goes there, and what a layout prefers."""

from __future__ import annotations

import math
from typing import NamedTuple

from cqdd_design.catalog.bearings import Bearing, bearings
from cqdd_design.errors import GeometryError
from cqdd_design.solids.features.edges import FACE_SHARE
from cqdd_design.solids.features.making import SHAFT_RIM
from cqdd_design.solids.selection import OR_AUTO, ChosenBearing, made_bearing

_CLEAR = 0.2e-3
"""From the shaft's shoulder to a bearing's outer ring, which turns against it, m."""
_MOST_WIDTH = 0.9
"""Of a bearing over its bore: wider ones leave no lever between the two."""


class ShaftRoom(NamedTuple):
    """What the bearings at the ends of the eccentric shaft have to go onto and into, m.

    Attributes
    ----------
    shoulder : float
        Diameter of the shaft's shoulder.
    least_step : float
        By how much the journal must be below the shoulder, on the diameter; the ring's chamfer may
        need more.
    most_outer_diameter : float
        Room in the carrier plate.
    nested_diameter : float
        Room inside the carrier cap: a bearing within it shortens the machine.
    """

    shoulder: float
    least_step: float
    most_outer_diameter: float
    nested_diameter: float

    @property
    def most_bore(self) -> float:
        """Of a bearing whose chamfer asks for no more, m."""
        return self.shoulder - self.least_step

    def misfit(self, row: Bearing) -> str:
        """Why a ball bearing does not go there, in words; empty where it does."""
        bore, outside = row.bore_diameter, row.outer_diameter
        most = min(self.most_bore, self.shoulder - 2.0 * _least_shoulder(row.largest_chamfer))
        clear = 2.0 * ChosenBearing(row).lip_radius - 2.0 * _CLEAR
        shoulder = f"the shaft's shoulder of {self.shoulder * 1e3:.4g} mm"
        if bore > most + 1e-9:
            return (
                f"has a bore of {bore * 1e3:g} mm, and {shoulder} stands beside its chamfer up to "
                f"{most * 1e3:.4g} mm; choose a smaller bore"
            )
        if self.shoulder > clear + 1e-9:
            return (
                f"has an outer ring from about {clear * 1e3:.4g} mm on, less what has to stay free "
                f"of it, and {shoulder} would rub there; choose a higher section or a larger bore"
            )
        if outside > self.most_outer_diameter + 1e-9:
            return (
                f"is {outside * 1e3:g} mm outside, and the carrier plate has room for "
                f"{self.most_outer_diameter * 1e3:.4g} mm; choose a smaller one"
            )
        if row.width > _MOST_WIDTH * bore + 1e-9:
            return (
                f"is {row.width * 1e3:g} mm wide on a journal of {bore * 1e3:g} mm, more than "
                f"{_MOST_WIDTH:g} of it; choose a narrower one"
            )
        return ""


def fitting_support_bearings(room: ShaftRoom) -> tuple[ChosenBearing, ...]:
    """Ball bearings that carry the ends of the eccentric shaft, what a layout prefers first.

    Those inside the carrier cap, then those with the largest bore, which leave the thickest
    journals; of these, since opposed discs load both ends with a couple, the highest static rating.
    """
    fitting = [
        row
        for row in bearings().values()
        if row.kind == "ball" and row.static_rating is not None and not room.misfit(row)
    ]

    def place(row: Bearing) -> tuple[bool, float, float, str]:
        nested = row.outer_diameter <= room.nested_diameter + 1e-9
        return not nested, -row.bore_diameter, -(row.static_rating or 0.0), row.designation

    return tuple(map(ChosenBearing, sorted(fitting, key=place)))


def support_bearing(room: ShaftRoom) -> ChosenBearing:
    """The bearing at either end of the eccentric shaft, where no load chooses it.

    Returns
    -------
    ChosenBearing
        The first of :func:`fitting_support_bearings`; a bronze bush where no bearing fits.
    """
    fitting = fitting_support_bearings(room)
    if fitting:
        return fitting[0]
    # To tenths of a millimetre, as it is ground.
    bore = round(math.floor(round(room.most_bore / 0.1e-3, 6)) * 0.1e-3, 9)
    outer = min(1.3 * bore + 1e-3, room.most_outer_diameter)
    width = 0.6 * bore
    name = f"bush {bore * 1e3:.3g} x {outer * 1e3:.3g} x {width * 1e3:.3g} mm"
    return made_bearing(name, bore, outer, width, "bush")


def named_support_bearing(row: Bearing, room: ShaftRoom) -> ChosenBearing:
    """The bearing at either end of the eccentric shaft that a design names.

    Parameters
    ----------
    row : Bearing
        Of the catalogue.

    Raises
    ------
    GeometryError
        When it is no ball bearing, or does not go onto the shaft or into the carrier plate.
    """
    key = f"support_bearing.designation '{row.designation}'"
    if row.kind != "ball":
        raise GeometryError(
            f"{key} is a {row.kind} bearing, and the ends of the eccentric shaft are located by "
            f"ball bearings; choose one of these, {OR_AUTO}."
        )
    if misfit := room.misfit(row):
        raise GeometryError(f"{key} {misfit}, {OR_AUTO}.")
    return ChosenBearing(row)


def _least_shoulder(chamfer: float) -> float:
    """Height of a shaft's shoulder that reaches past a chamfer (m) at its limits, m."""
    return (chamfer + 0.5 * SHAFT_RIM) / (1.0 - FACE_SHARE)
