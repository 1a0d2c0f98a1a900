"""Life in the report."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cqdd_design.report.ink.numbers import NONE, RPM, per_cent, significant, with_unit
from cqdd_design.report.ink.page import Values
from cqdd_design.report.judgement.duty import held_speed_text

if TYPE_CHECKING:
    from cqdd_design.design import Requirements
    from cqdd_design.gearbox.life import DutyCase, LifeResult, PartLife

_MOST_CASES = 12
Judged = tuple[str, bool]
"""A value as shown, and whether it is long enough."""


def life_view(result: LifeResult, asked: Requirements) -> Values:
    """Duty as (torque, speed, share), and the life of every part and bearing."""
    required, cam = result.required_hours, result.cam
    loads = cam.equivalent_load
    hours = cam.hours or (None,) * len(loads)
    bearings = [
        (f"{cam.designation}, disc {disc}", with_unit(load, "N"), _bearing(found, required))
        for disc, (load, found) in enumerate(zip(loads, hours, strict=True), 1)
    ]
    if len(loads) > 1 and cam.set_hours is not None:
        bearings.append(("all of them", "", _bearing(cam.set_hours, required)))
    for runner in result.runners:
        together = runner.set_hours
        lasts = _hours(together)
        bearings.append(
            (
                f"{runner.designation or 'plain'}, all {runner.name}",
                with_unit(runner.equivalent_load, "N"),
                ("unknown" if runner.unknown else lasts, runner.lasts(required)),
            )
        )
    return {
        "duty": _cases(result.duty),
        "assumed": result.assumed,
        "held_speed": held_speed_text(asked),
        "required": with_unit(required, "h"),
        "rows": tuple(_row(part, required) for part in result.parts),
        "seat": ", ".join(["Cam bearing", *(one.name for one in result.runners)]),
        "bearings": tuple(bearings),
    }


def _cases(duty: tuple[DutyCase, ...]) -> tuple[tuple[str, str, str], ...]:
    """Load cases, of many those of the largest torques."""
    shown = duty
    if len(duty) > _MOST_CASES:
        shown = tuple(sorted(duty, key=lambda case: -abs(case.torque))[: _MOST_CASES - 1])
    rows = [
        (
            with_unit(case.torque, "N*m"),
            f"{significant(case.speed * RPM)} rpm",
            per_cent(case.share),
        )
        for case in shown
    ]
    if left := len(duty) - len(shown):
        rest = sum(case.share for case in duty) - sum(case.share for case in shown)
        rows.append((f"{left} of less torque", NONE, per_cent(rest)))
    return tuple(rows)


def _bearing(hours: float | None, required: float) -> Judged:
    return ("unknown", False) if hours is None else (with_unit(hours, "h", 3), hours >= required)


def _hours(hours: float | None) -> str:
    return "no end" if hours is None else with_unit(hours, "h", 3)


def _row(part: PartLife, required: float) -> tuple[str, str, str, str, Judged, str]:
    known = part.limit > 0.0
    return (
        part.part,
        part.place,
        with_unit(part.stress / 1e6, "MPa"),
        with_unit(part.limit / 1e6, "MPa") if known else "unknown",
        (_hours(part.hours) if known else "unknown", part.lasts(required)),
        NONE if part.reserve is None else significant(min(part.reserve, 1e3), 3),
    )
