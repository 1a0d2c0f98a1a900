"""Lines of what requirements ask for beyond torque, speed and life; none of what they leave out."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial

from cqdd_design.actuator.operating import judge
from cqdd_design.actuator.shock import peak_current, simulated_torque
from cqdd_design.errors import ContactError, GeometryError
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.gearbox.precision.precision import precision
from cqdd_design.geometry.limits import rounded_down, rounded_up
from cqdd_design.machine import Machine
from cqdd_design.machine.carrying import carried_torque
from cqdd_design.machine.cures import ROUGHLY, torques_that_hold
from cqdd_design.machine.heat_nodes import Node
from cqdd_design.results import Check
from cqdd_design.solids.motor_rules import light_rotor
from cqdd_design.verdict.bore_line import bore_line
from cqdd_design.verdict.evidence import Evidence
from cqdd_design.verdict.headline import Figure, backlash, efficiency, mass
from cqdd_design.verdict.motor import GIVE
from cqdd_design.verdict.reached import PEAK_LINES, standing_torque

_ARCMIN = math.degrees(1.0) * 60.0
_ANGLES = 96
_OUTSIDE: tuple[Node, ...] = ("housing", "cover")


def asked_lines(evidence: Evidence, others: Sequence[Check] = ()) -> tuple[Check, ...]:
    """One line for each requirement of this chapter that is stated, in the order of the keys.

    Parameters
    ----------
    others : sequence of Check
        The verdict's other lines: what else gives way under the torque of a stop.
    """
    chapters: tuple[Callable[[Evidence], Iterator[Check]], ...] = (
        _speed_at_peak,
        partial(_shock, others=others),
        _bore,
        _mass,
        _inertia,
        _backlash,
        _lost_motion,
        _stiffness,
        _efficiency,
        _surface,
    )
    return tuple(line for chapter in chapters for line in chapter(evidence))


def _speed_at_peak(evidence: Evidence) -> Iterator[Check]:
    asked, actuator = evidence.machine.design.requirements, evidence.actuator
    if asked.speed_at_peak is None:
        return
    name, torque = "PEAK-AT-SPEED", asked.peak_torque
    if actuator is None:
        yield build_check(name, None, torque, evidence.actuator_missing, "see why there is none")
        return
    found = judge(actuator, torque, asked.speed_at_peak, lasting=False, hot=False)
    binding = ", ".join(found.binding) or "nothing"
    motor = evidence.machine.motor
    hot = judge(actuator, torque, asked.speed_at_peak, lasting=False, hot=True)
    told = (
        f"{found.most:.4g} N*m at {asked.speed_at_peak:.4g} rad/s of the output, motor cold; "
        f"{hot.most:.4g} N*m with magnets and winding at {actuator.thermal.most:g} degC; "
    )
    if motor.peak_torque is None and found.most >= torque:
        why = f"{told}the motor's own peak torque is not known"
        yield build_check(name, None, torque, why, "give it in the motor's data")
        return
    yield build_check(
        name,
        found.most,
        torque,
        f"{told}binding: {binding}",
        "lower requirements.speed_at_peak, raise motor.voltage where voltage binds, or take a "
        "stronger motor",
    )


def _shock(evidence: Evidence, others: Sequence[Check] = ()) -> Iterator[Check]:
    machine, actuator = evidence.machine, evidence.actuator
    speed = machine.design.requirements.shock_speed
    if speed <= 0.0:
        return
    limit, gives_way, unknown = _stands(evidence, others)
    if actuator is None or limit is None or unknown:
        why = evidence.actuator_missing or f"not known: limits of {', '.join(unknown)}"
        yield build_check("SHOCK-STOP", None, limit, why, "see what is not known")
        return
    torque = simulated_torque(actuator, speed)
    driven = simulated_torque(actuator, speed, peak_current(actuator))
    told = (
        f"{torque:.4g} N*m from {speed:.4g} rad/s with the motor off, {driven:.4g} N*m where it "
        f"drives on with its peak current; first to give way: {gives_way}"
    )
    more = "take a gearbox that carries more"
    line = build_check("SHOCK-STOP", torque, limit, told, more)
    if line.status == "fail" and not machine.stiff:
        # Backlash, friction and the motor's side take their part: not in proportion to the speed.
        held = torques_that_hold(
            lambda slower: (replace(line, value=simulated_torque(actuator, slower)),),
            speed,
            (line,),
            near=ROUGHLY,
        )
        if slower := held[line.id]:
            stay = f"stay below {rounded_down(slower):g} rad/s where the output may be stopped"
            line = replace(line, remedy=f"{stay}, or {more}")
    yield line


def _stands(
    evidence: Evidence, others: Sequence[Check]
) -> tuple[float | None, str, tuple[str, ...]]:
    """The torque that the gearbox stands, N m, what gives way there, and what is not known."""
    carried = carried_torque(evidence.machine)
    unknown = (
        *carried.unknown,
        *(line.id for line in others if line.id in PEAK_LINES and not line.known),
    )
    if not carried.limits:
        return None, "", unknown
    limit, gives_way = carried.limits[0].torque, carried.limits[0].words
    stood = standing_torque(evidence, others, limit)
    if stood is not None and stood[0] < limit:
        limit, gives_way = stood
    return limit, gives_way, unknown


def _bore(evidence: Evidence) -> Iterator[Check]:
    line = bore_line(evidence.machine)
    if line is not None:
        yield line


def _mass(evidence: Evidence) -> Iterator[Check]:
    wanted = evidence.machine.design.requirements.mass
    if wanted is not None:
        cure = "ask for less torque, or take a lighter motor or housing.material"
        if evidence.machine.motor.mass is None:
            cure = GIVE
        yield _of_figure("MASS", mass(evidence.machine), wanted, cure)


def _inertia(evidence: Evidence) -> Iterator[Check]:
    machine = evidence.machine
    wanted, name = machine.design.requirements.reflected_inertia, "REFLECTED-INERTIA"
    if wanted is None:
        return
    try:
        found = machine.inertia
    except GeometryError as error:
        yield build_check(name, None, wanted, error.message, "see why nothing is drawn")
        return
    known = found.rotor_inertia is not None
    rotor = f"of '{machine.motor.name}' no rotor inertia is known"
    light = light_rotor(machine.motor)
    yield build_check(
        name,
        found.reflected_output if known else None,
        wanted,
        f"{found.ratio}^2 x {found.reflected_input:.4g} kg*m^2 at the crank"
        + (f"; {light}" if light else "")
        if known
        else rotor,
        "lower the ratio, or take a motor with a lighter rotor"
        if known
        else "give it in the motor's data",
    )


def _backlash(evidence: Evidence) -> Iterator[Check]:
    wanted = evidence.machine.design.requirements.backlash
    if wanted is not None:
        found = backlash(evidence)
        cure = "make modification.equidistant and hole_clearance smaller, with closer [tolerances]"
        yield _of_figure("BACKLASH", found, wanted * _ARCMIN, cure, evidence.drawn_missing)


def _lost_motion(evidence: Evidence) -> Iterator[Check]:
    machine = evidence.machine
    asked = machine.design.requirements
    if asked.lost_motion is None:
        return
    limit, name = asked.lost_motion * _ARCMIN, "LOST-MOTION"
    try:
        found = precision(machine.contact, asked.continuous_torque, angles=_ANGLES)
    except ContactError as error:
        yield build_check(name, None, limit, error.message, "see CONTACT-REACH")
        return
    # Clearances of drawn gearboxes may be larger than those of perfect ones: whichever moves more.
    free, drawn, parts = found.free.mean * _ARCMIN, backlash(evidence).value, "perfect parts"
    wound = found.lost_motion * _ARCMIN - free
    if drawn is not None and drawn > free:
        free, parts = drawn, "95 % of the gearboxes"
    value = free + wound
    yield build_check(
        name,
        value,
        limit,
        f"{value:.3g} arcmin, of which {free:.3g} are backlash, of {parts}",
        "make clearances smaller, or teeth and pins stiffer (more and thicker pins)",
    )


def _stiffness(evidence: Evidence) -> Iterator[Check]:
    wanted = evidence.machine.design.requirements.stiffness
    drawn = evidence.drawn and evidence.drawn.continuous
    if wanted is None:
        return
    limit = wanted / _ARCMIN
    if drawn is None or not len(drawn.values):
        why = evidence.drawn_missing or "no gearbox could be solved"
        yield build_check("STIFFNESS", None, limit, why, "see why none could be drawn")
        return
    found = drawn.statistics()["stiffness_Nm_per_arcmin"]
    value, warm = float(found["p5"]), ""
    if evidence.drawn is not None and evidence.drawn.warm is not None:
        softest = float(evidence.drawn.warm.statistics()["stiffness_Nm_per_arcmin"]["p5"])
        value, warm = min(value, softest), f"; {softest:.4g} at least clearance"
    yield build_check(
        "STIFFNESS",
        value,
        limit,
        f"{found['p5']:.4g} N*m/arcmin, {found['mean']:.4g} in the mean, at "
        f"{drawn.ensemble.torque:g} N*m{warm}",
        "take more or thicker output_pins where they have room, or size it for more peak_torque: a "
        "stronger gearbox is stiffer",
    )


def _efficiency(evidence: Evidence) -> Iterator[Check]:
    line = efficiency_line(evidence.machine)
    if line is not None:
        yield line


def efficiency_line(machine: Machine) -> Check | None:
    """The line EFFICIENCY; None where none is asked for."""
    wanted = machine.design.requirements.efficiency
    if wanted is None:
        return None
    found = efficiency(machine)
    cure = 'put the output pins on needles (sleeve = "needle"), or lower friction'
    if found.value is not None:
        cure += f"; or ask for an efficiency of {rounded_down(found.value, 3):g}"
    return _of_figure("EFFICIENCY", found, wanted, cure)


def _surface(evidence: Evidence) -> Iterator[Check]:
    limit, warm = evidence.machine.design.requirements.surface_temperature, evidence.temperatures
    if limit is None:
        return
    name = "SURFACE-TEMPERATURE"
    if warm is None:
        yield build_check(name, None, limit, evidence.heat_missing, "see why there is none")
        return
    found = {part: warm.hottest(part) for part in _OUTSIDE}
    part = max(found, key=lambda one: found[one])
    yield build_check(
        name,
        found[part],
        limit,
        f"{part} {found[part]:.4g} degC in air of {warm.network.ambient:g} degC",
        "ask for less torque or speed, lower friction, or cool it (drive.thermal_resistance states "
        f"how well); or allow a surface_temperature of {rounded_up(found[part]):g} degC",
    )


def _of_figure(check_id: str, figure: Figure, limit: float, cure: str, why: str = "") -> Check:
    """The line of a figure of the first screen, so that both say the same."""
    told = why or figure.basis
    if figure.value is not None:
        told = f"{figure.value:.4g} {figure.unit}".strip()
    return build_check(check_id, figure.value, limit, told, cure, model=figure.basis)
