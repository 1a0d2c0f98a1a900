"""An analysis in words: what each section says, in which unit, and how it stands to the limits.

A line that the verdict judges carries the verdict's status word and the limit. Below the figures of
a section stand its other limits that are not met, or not known, and of those that are met the
closest; `check` tells all of them.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from cqdd_design.actuator.shock import METHODS, Shock
from cqdd_design.cli.tables import folded, number, table, told
from cqdd_design.results import Check
from cqdd_design.roads.analyse import ASKED, UNLOADED, Analysis
from cqdd_design.terms import hardly, term

_SAME = 1e-9
"""Relative difference of one number on two ways to a page."""
_LONGEST = 16
"""Of words in the column of values; longer ones follow their name."""


class _Section(NamedTuple):
    """A part of the results: its key, what it is, ids of its limits, and words of its own."""

    key: str
    title: str
    limits: tuple[str, ...] = ()
    words: Mapping[str, str] = {}


_SECTIONS = (
    _Section(
        "geometry",
        "geometry of disc and ring",
        ("GEO-", "FIT-", "EDM-", "SPACE-", "BEARING-WIDTH", "BEARING-CORE", "RETENTION-", "BORE"),
    ),
    _Section("rigid", "loads by the rigid law"),
    _Section(
        "output_pins",
        "strength of the output pins by the rigid law",
        ("PIN-", "SLEEVE-"),
    ),
    _Section("bearings", "cam bearing by the rigid law", ("BEARING-STATIC", "BEARING-RACEWAY")),
    _Section("balance", "balance of the crank", ("BALANCE-", "DISC-COUNT")),
    _Section("duty", "duty over time, at the output and at the motor", ("DUTY-",)),
    _Section(
        "contact",
        "contact equilibrium of perfect parts",
        ("CONTACT-", "PIN-BENDING-PEAK", "RING-PIN-BENDING-PEAK", "ROLLER-", "GEO-ROLLER-"),
    ),
    _Section("precision", "precision", ("BACKLASH", "LOST-MOTION", "STIFFNESS")),
    _Section("losses", "losses and efficiency", ("EFFICIENCY",)),
    _Section(
        "film",
        "lubricant films at the ring teeth and output pins",
        words={"friction": "friction coefficient"},
    ),
    _Section("wear", "wear over the required life"),
    _Section(
        "life",
        "life",
        (
            *("BEARING-LIFE", "SUPPORT-LIFE", "OUTPUT-LIFE", "SLEEVE-LIFE", "ROLLER-LIFE"),
            *("CONTACT-RING-CONTINUOUS", "CONTACT-PIN-CONTINUOUS", "PIN-BENDING-CONTINUOUS"),
            "RING-PIN-BENDING-CONTINUOUS",
        ),
    ),
    _Section(
        "bending",
        "shaft and tilt, bounded",
        ("SHAFT-", "SUPPORT-STATIC", "OUTPUT-STATIC"),
    ),
    _Section(
        "bodies",
        "stress of discs and ring under these forces",
        ("LIGAMENT-", "ROOT-", "RING-STRESS", "RING-FATIGUE"),
    ),
    _Section(
        "temperatures_degC",
        "temperatures at which parts settle",
        ("THERMAL-RISE", "SURFACE-TEMPERATURE"),
    ),
    _Section("heat", "heat, and clearances at these temperatures", ("THERMAL-CLEARANCE",)),
)
_ELSEWHERE = "motor, joints and all else that is judged"
"""Limits of no section, and those of a section that there is not."""

_JUDGED = {
    ("output_pins", "paper_torque_total_Nm"): "PIN-PAPER",
    ("output_pins", "shared_torque_capacity_Nm"): "PIN-SHARED",
    ("contact", "ring_pressure_max_MPa"): "CONTACT-RING-PEAK",
    ("contact", "output_pressure_max_MPa"): "CONTACT-PIN-PEAK",
    ("contact", "output_pin_bending_max_MPa"): "PIN-BENDING-PEAK",
    ("precision", "lost_motion_arcmin"): "LOST-MOTION",
    ("precision", "stiffness_Nm_per_arcmin"): "STIFFNESS",
    ("losses", "efficiency_forward"): "EFFICIENCY",
    ("life", "cam_bearings.set_L10h"): "BEARING-LIFE",
    ("bodies", "ligament_stress_max_MPa"): "LIGAMENT-STRESS",
    ("bodies", "root_stress_max_MPa"): "ROOT-STRESS",
    ("bodies", "ring_stress_max_MPa"): "RING-STRESS",
    ("temperatures_degC", "winding"): "THERMAL-RISE",
}
"""Figures that a limit is set to, where the verdict stands at the same torque and temperature."""


def analysis_lines(found: Analysis) -> list[str]:
    """Every section in words, then stops, and the limits that belong to no section."""
    results = found.to_dict()
    lines: list[str] = []
    left = {check.id: check for check in found.checks}
    for section in _SECTIONS:
        values = results[section.key]
        if values is None:
            continue
        assert isinstance(values, dict)
        limits = {name: left.pop(name) for name in list(left) if section_of(name) == section.key}
        flat = values["cam"] if section.key == "bearings" else values
        rows = _rows(section, _single(flat), limits)
        lines += [*_titled(section.title + _at(found, section.key), rows), ""]
    lines += _titled(_ELSEWHERE, _limit_rows(left.values()))
    asked = {"torque": found.asked_torque, "speed": found.asked_speed}
    if named := [name for name, value in asked.items() if value is not None]:
        words = " and ".join(named)
        lines += folded(f"Limits are judged at the requirements, not at the {words} asked for.")
    return [*lines, *_shock_lines(found.shocks)]


def section_of(check: str) -> str:
    """The section that a limit is told in, by the longest beginning of its id; else ""."""
    fitting = [
        (len(start), section.key)
        for section in _SECTIONS
        for start in section.limits
        if check.startswith(start)
    ]
    return max(fitting)[1] if fitting else ""


def _titled(title: str, rows: Sequence[Sequence[str]]) -> list[str]:
    lines = folded(title)
    width = max(len(line) for line in lines)
    return [*lines, "-" * width, table(rows, right=(2,))]


def _at(found: Analysis, section: str) -> str:
    """What a section stands for, behind its title."""
    load, told = found.at.get(section, UNLOADED), ""
    if load == ASKED:
        told = f", at {number(found.asked_torque or 0.0)} N*m (--torque)"
    elif load not in (UNLOADED, "requirements"):
        told = f", over the {load}" if load == "duty" else f", at the {load}"
    if found.asked_speed is None or section == "geometry":
        return told
    rpm = found.asked_speed * 30.0 / math.pi
    return f"{told}{' and' if told else ', at'} {number(rpm)} rpm (--speed)"


def _rows(
    section: _Section, values: Mapping[str, object], limits: Mapping[str, Check]
) -> list[list[str]]:
    """Figures with their unit, judged where the verdict has the very same; then other limits."""
    rows, open_limits = [], dict(limits)
    of_all = term(section.key).unit
    for path, value in values.items():
        *groups, key = path.split(".")
        words, unit = term(key)
        named = [*(term(group).words for group in groups), section.words.get(key, words)]
        unit = (unit or of_all) if isinstance(value, float | int) else unit
        status = limit = ""
        check = open_limits.get(_JUDGED.get((section.key, path), ""))
        if check is not None and _is_of(check, value):
            status, limit = _status(check), _limit(check)
            del open_limits[check.id]
        name, shown = ", ".join(named), _shown(value, unit)
        if isinstance(value, str) and len(shown) > _LONGEST:
            name, shown = f"{name}: {shown}", ""
        rows.append([status, name, shown, unit, limit])
    return rows + _limit_rows(open_limits.values())


def _is_of(check: Check, value: object) -> bool:
    return (
        isinstance(value, float)
        and check.value is not None
        and math.isclose(check.value, value, rel_tol=_SAME)
    )


def _limit_rows(checks: Iterable[Check]) -> list[list[str]]:
    """Limits that are not met or not known, and the closest that is met."""
    every = list(checks)
    short = [check for check in every if check.status != "pass"]
    met = [check for check in every if check.status == "pass"]
    shown = short + sorted(met, key=lambda check: check.margin)[:1]
    return [
        [
            _status(check),
            check.title,
            "?" if check.value is None else hardly(check.value, check.unit) or number(check.value),
            check.unit,
            _limit(check),
        ]
        for check in shown
    ]


def _status(check: Check) -> str:
    return "pass" if check.status == "pass" else check.status.upper()


def _limit(check: Check) -> str:
    most = "at most" if check.sense == "max" else "at least"
    return f"{most} {'?' if check.limit is None else number(check.limit)}"


def _shock_lines(shocks: Mapping[str, Shock]) -> list[str]:
    lines = []
    for name, one in shocks.items():
        head = (
            f"into a rigid stop from {number(one.speed)} rad/s ({name} speed), "
            f"{number(one.energy)} J"
        )
        stops = told([(METHODS[key], stop.told) for key, stop in one.stops.items()])
        lines += ["", head, "-" * len(head), stops]
    return lines


def _single(values: Mapping[str, object]) -> dict[str, object]:
    """What fits on one line each: curves and tables are in the JSON and in the report."""
    found: dict[str, object] = {}
    for name, value in values.items():
        if isinstance(value, dict):
            found |= {f"{name}.{inner}": v for inner, v in _single(value).items()}
        elif not isinstance(value, list):
            found[name] = value
        elif value and len(value) <= 3 and all(isinstance(item, float) for item in value):
            found[name] = ", ".join(number(item) for item in value)
    return found


def _shown(value: object, unit: str = "") -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return hardly(value, unit) or number(value)
    return "-" if value is None else str(value)
