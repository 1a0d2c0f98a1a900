"""The seven figures a designer looks at first."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from cqdd_design.actuator.operating import lasting_torque
from cqdd_design.errors import ContactError, GeometryError
from cqdd_design.gearbox.checks.equilibrium import DUTY_MODEL, ENDLESS
from cqdd_design.gearbox.checks.heat import BURNT
from cqdd_design.machine import Machine
from cqdd_design.machine.carrying import carried_torque, carried_up_to
from cqdd_design.results import Check, Status
from cqdd_design.terms import life_text
from cqdd_design.verdict.drawn import drawn_cam_hours
from cqdd_design.verdict.evidence import Evidence
from cqdd_design.verdict.motor import ALL_PARTS, lasting_speed_of
from cqdd_design.verdict.motor import MODEL as OPERATING
from cqdd_design.verdict.reached import PEAK_LINES, standing_torque

_RPM = 30.0 / math.pi
_LIFE_LINES = (
    "CONTACT-RING-CONTINUOUS",
    "CONTACT-PIN-CONTINUOUS",
    "PIN-BENDING-CONTINUOUS",
    "BEARING-LIFE",
    "SLEEVE-LIFE",
    "ROLLER-LIFE",
    "SUPPORT-LIFE",
    "OUTPUT-LIFE",
)


@dataclass(frozen=True)
class Figure:
    """One figure with what is asked of it.

    Attributes
    ----------
    value, required : float or None
        In `unit`; None where not known, and where nothing is asked.
    basis : str
        The model it comes from, and what it counts; where it is not known and that has a reason of
        its own, the reason.
    missing : str
        That reason.
    """

    id: str
    title: str
    value: float | None
    unit: str
    required: float | None
    status: Status
    basis: str
    missing: str = ""

    @property
    def told(self) -> str:
        """In a line: ``pass  mass: 0.82 kg, 1 asked``."""
        value = f"not known ({self.missing})" if self.missing else "not known"
        if self.value is not None:
            life = self.unit == "h"
            value = life_text(self.value) if life else f"{self.value:.4g} {self.unit}".rstrip()
        asked = "" if self.required is None else f", {self.required:.4g} asked"
        return f"{self.status:7}  {self.title}: {value}{asked}"

    def to_dict(self) -> dict[str, object]:
        """The JSON form."""
        return {key: value for key, value in vars(self).items() if key != "missing" or value}


def headline(evidence: Evidence, lines: Sequence[Check], peak: Figure) -> tuple[Figure, ...]:
    """Peak and continuous torque, life, backlash, efficiency, temperature and mass.

    Parameters
    ----------
    peak : Figure
        Of `peak_torque`, which takes longest and asks for no drawn gearboxes.
    """
    by_id = {line.id: line for line in lines}
    machine = evidence.machine
    return (
        peak,
        _continuous(evidence, by_id),
        _life(evidence, by_id, lines),
        _asked(backlash(evidence), by_id.get("BACKLASH")),
        _asked(efficiency(machine), by_id.get("EFFICIENCY")),
        _temperature(by_id["THERMAL-RISE"]),
        _asked(mass(machine), by_id.get("MASS")),
    )


def _asked(figure: Figure, line: Check | None) -> Figure:
    """A figure with what its line asks, where one does."""
    return figure if line is None else replace(figure, required=line.limit, status=line.status)


def _of_line(name: str, title: str, line: Check) -> Figure:
    return Figure(name, title, line.value, line.unit, line.limit, line.status, line.basis)


def _temperature(line: Check) -> Figure:
    title = "temperature"
    if line.value is not None and line.value > BURNT:
        title += " (no part stands it: too much heat)"
    return _of_line("temperature", title, line)


def _continuous(evidence: Evidence, by_id: dict[str, Check]) -> Figure:
    """What is held for ever.

    Under a duty nothing is asked of it, and the duty's heat decides.
    """
    asked = evidence.machine.design.requirements
    speed = lasting_speed_of(asked)
    name, title = "continuous_torque", f"continuous torque at {speed * _RPM:.0f} rpm"
    line = by_id.get("MOTOR-CONTINUOUS")
    if line is not None:
        return _of_line(name, title, line)
    heat, whose = by_id["THERMAL-RISE"], "this speed of the motor"
    if asked.continuous_speed is None:
        whose = "the duty's mean speed of the motor"
    value, alone, lasting, known = None, "", evidence.lasting_torque, OPERATING
    if evidence.actuator is not None:
        value = lasting_torque(evidence.actuator, speed / asked.ratio)
        alone = "" if value > 0.0 else ": friction alone heats the winding too much there"
        if lasting is not None and lasting < value:
            value, known = lasting, ALL_PARTS
            alone = "" if value > 0.0 else ": drag alone makes parts too warm or press there"
    basis = (
        f"{known}, for ever at {whose}{alone}; not asked for, the duty's heat decides, see the "
        "temperature"
    )
    # Nobody asked for any; what heat forbids is told by the temperature.
    status: Status = "unknown" if value is None or heat.status == "unknown" else "pass"
    return Figure(name, title, value, "N*m", None, status, basis)


def peak_torque(evidence: Evidence, lines: Sequence[Check]) -> Figure:
    """What motor and gearbox both reach; `lines` are those of perfect parts."""
    machine = evidence.machine
    (motor,) = (line for line in lines if line.id == "MOTOR-PEAK")
    required = machine.design.requirements.peak_torque
    title, name = "peak torque at standstill, motor cold", "peak_torque"
    ways = [] if motor.value is None else [(motor.value, motor.basis)]
    # What gives way beyond that is not looked for.
    carried = carried_up_to(machine, ways[0][0]) if ways else carried_torque(machine)
    ways += [(one.torque, f"{one.words}: {one.model}") for one in carried.limits[:1]]
    stood = standing_torque(evidence, lines, min(ways)[0] if ways else required)
    ways += [] if stood is None else [stood]
    value, basis = min(ways, default=(None, motor.basis))
    unknown = ["MOTOR-PEAK"] if motor.value is None else []
    unknown += carried.unknown
    unknown += [line.id for line in lines if line.id in PEAK_LINES and not line.known]
    status: Status = "pass"
    if value is not None and value < required * (1.0 - 1e-9):
        status = "fail"
    elif unknown:
        # What is known reaches it, but something is not known.
        held = "" if value is None else f"; all else holds to {value:.4g} N*m ({basis})"
        basis = f"not known of {', '.join(unknown)}{held}"
        value, status = None, "unknown"
    return Figure(name, title, value, "N*m", required, status, basis)


def _life(evidence: Evidence, by_id: dict[str, Check], every: Sequence[Check]) -> Figure:
    """Of what gives way first under the duty: cam bearings in all but the worst gearboxes."""
    machine = evidence.machine
    lines = [by_id[one] for one in _LIFE_LINES if one in by_id]
    status: Status = "unknown" if any(not line.known for line in lines) else "pass"
    try:
        life = machine.life
    except ContactError:
        return Figure("life", "life", None, "h", None, "unknown", DUTY_MODEL)
    hours = {part.part: part.hours for part in life.parts}
    hours["cam bearings together"] = life.cam.set_hours
    hours |= {one.name: one.set_hours for one in life.runners}
    for name, words in (("SUPPORT-LIFE", "shaft bearings"), ("OUTPUT-LIFE", "output bearing")):
        hours[words] = by_id[name].value
    drawn, told = drawn_cam_hours(machine, evidence.drawn, every), "of perfect parts"
    cams = {part for part in hours if "cam bearing" in part}
    if drawn is not None:
        told = f"of {100.0 * machine.design.requirements.yield_share:g} % of the gearboxes"
        worst = f"cam bearings, under the greatest load over the turn {told}, drawn from tolerances"
        hours = {part: value for part, value in hours.items() if part not in cams}
        hours[worst] = drawn
        cams = {worst}
    ended = {part: value for part, value in hours.items() if value is not None}
    first = min(ended, key=lambda part: ended[part], default="")
    value = ended.get(first, ENDLESS)
    if value < life.required_hours * (1.0 - 1e-9):
        status = "fail"
    basis = f"{first}: {DUTY_MODEL}" if first else DUTY_MODEL
    if drawn is not None and first in cams:
        basis = first
    # Other parts are perfect ones.
    title = f"life {told}" if first in cams else "life"
    shown = None if status == "unknown" else value
    return Figure("life", title, shown, "h", life.required_hours, status, basis)


def backlash(evidence: Evidence) -> Figure:
    """Of the drawn gearboxes."""
    drawn = evidence.drawn and evidence.drawn.continuous
    title, basis = "backlash of 95 % of the gearboxes", "gearboxes drawn from the tolerances"
    if drawn is None or not len(drawn.values):
        why = evidence.drawn_missing or "no gearbox could be solved"
        return Figure("backlash_p95", title, None, "arcmin", None, "unknown", why, why)
    value = float(drawn.statistics()["backlash_arcmin"]["p95"])
    return Figure("backlash_p95", title, value, "arcmin", None, "pass", basis)


def efficiency(machine: Machine) -> Figure:
    """Work out over work in while the motor drives, over the duty."""
    name, title, basis = "efficiency", "efficiency of the gearbox", "losses by the equilibrium"
    try:
        cases = machine.life.duty
        ratio, given, taken = machine.design.reducer.ratio, 0.0, 0.0
        for case in cases:
            if case.driven or case.speed == 0.0 or case.torque == 0.0 or case.share == 0.0:
                continue
            losses = machine.losses.at(ratio * case.speed, abs(case.torque))
            power = case.share * abs(case.torque) * case.speed
            given += power
            taken += power + case.share * losses.total
    except ContactError:
        return Figure(name, title, None, "", None, "unknown", basis)
    if taken <= 0.0:
        return Figure(name, title, None, "", None, "unknown", f"{basis}: the motor never drives")
    return Figure(name, title, given / taken, "", None, "pass", f"{basis}, over the duty")


def mass(machine: Machine) -> Figure:
    """Of the actuator, as far as it is known."""
    try:
        inertia = machine.inertia
    except GeometryError as error:
        return Figure("mass", "mass", None, "kg", None, "unknown", error.message)
    whole = inertia.whole_mass
    return Figure(
        "mass",
        "mass",
        whole,
        "kg",
        None,
        "unknown" if whole is None else "pass",
        inertia.mass_scope,
    )
