"""Life in the report."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from cqdd_design.report.ink.numbers import significant, with_unit

if TYPE_CHECKING:
    from cqdd_design.gearbox.life import LifeResult, PartLife


@dataclass(frozen=True)
class LifeView:
    """What the section shows.

    Attributes
    ----------
    duty : tuple of (torque, speed, share)
    assumed : bool
    required : str
    rows : tuple of (part, worst place, stress, limit, life, reserve, holds)
    bearings : tuple of (name, load, life, holds)
    """

    duty: tuple[tuple[str, str, str], ...]
    assumed: bool
    required: str
    rows: tuple[tuple[str, str, str, str, str, str, bool], ...]
    bearings: tuple[tuple[str, str, str, bool], ...]


def life_view(result: LifeResult) -> LifeView:
    """Values of the section."""
    required = result.required_hours
    cam = result.cam
    bearings = []
    for disc, load in enumerate(cam.equivalent_load):
        hours = None if cam.hours is None else cam.hours[disc]
        bearings.append(_bearing(f"{cam.designation}, disc {disc + 1}", load, hours, required))
    if len(cam.equivalent_load) > 1 and cam.set_hours is not None:
        bearings.append(_bearing("all of them", None, cam.set_hours, required))
    return LifeView(
        duty=tuple(
            (
                with_unit(case.torque, "N*m"),
                f"{significant(case.speed * 30.0 / math.pi)} rpm",
                f"{significant(100.0 * case.share)}\u202f%",
            )
            for case in result.duty
        ),
        assumed=result.assumed,
        required=f"{significant(required)}\u202fh",
        rows=tuple(_row(part, required) for part in result.parts),
        bearings=tuple(bearings),
    )


def _hours(hours: float | None) -> str:
    if hours is None:
        return "no end"
    if hours < 1.0:
        return "under an hour"
    return f"{significant(hours, 3)}\u202fh"


def _row(part: PartLife, required: float) -> tuple[str, str, str, str, str, str, bool]:
    known = part.limit > 0.0
    reserve = "\u2013" if part.reserve is None else significant(min(part.reserve, 1e3), 3)
    return (
        part.part,
        part.place,
        with_unit(part.stress / 1e6, "MPa"),
        with_unit(part.limit / 1e6, "MPa") if known else "unknown",
        _hours(part.hours) if known else "unknown",
        reserve,
        known and (part.hours is None or part.hours >= required),
    )


def _bearing(
    name: str, load: float | None, hours: float | None, required: float
) -> tuple[str, str, str, bool]:
    shown = "" if load is None else with_unit(load, "N")
    if hours is None:
        return name, shown, "unknown", False
    return name, shown, f"{significant(hours, 3)}\u202fh", hours >= required
