"""What a verdict rests on: every model that has something to say, asked once."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import TypeVar

from cqdd_design.actuator import operating
from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.demands import demands
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.actuator.specimen import Specimen
from cqdd_design.errors import ContactError, CqddError, DesignError, GeometryError, UsageError
from cqdd_design.gearbox.bodies.strength import BodyStrength
from cqdd_design.gearbox.checks.heat import cooling_remedy
from cqdd_design.machine import Machine
from cqdd_design.machine.body_analysis import judged_or_told
from cqdd_design.machine.cooling import cooled_network
from cqdd_design.machine.enough_cooling import enough_cooling
from cqdd_design.machine.lasting import lasting_torque, margin_of
from cqdd_design.machine.temperatures import MachineTemperatures, judged_temperatures
from cqdd_design.results import Check
from cqdd_design.verdict.drawn import Drawn, drawn_gearboxes
from cqdd_design.verdict.motor import lasting_speed_of
from cqdd_design.verdict.remembered import remembered

Progress = Callable[[str], None]
_Then = TypeVar("_Then")
_HeatTold = tuple[MachineTemperatures | None, tuple[Check, ...], tuple[str, ...]]
"""Temperatures with their checks, and why there are none."""


@dataclass(frozen=True, eq=False)
class Evidence:
    """Results that lines are made of; what could not be had is None, with the reason.

    Attributes
    ----------
    machine : Machine
    stress : BodyStrength or None
        Of discs and ring, at the torques of the requirements.
    stress_checks : tuple of Check
        Of that stress.
    temperatures : MachineTemperatures or None
        At the duty, or at the continuous torque.
    heat_checks : tuple of Check
        Of them, and of the clearances they leave.
    actuator : ActuatorParameters or None
        As it is simulated, of perfect parts.
    drawn : Drawn or None
        Toleranced gearboxes at the continuous and at the peak torque.
    lasting_torque : float or None
        The greatest that all parts stand for ever at the speed it is told at, N m, as far as
        winding and drive hold it; None where that is not known.
    stress_missing, heat_missing, actuator_missing, drawn_missing : str
        Why there are none.
    """

    machine: Machine
    stress: BodyStrength | None
    stress_checks: tuple[Check, ...]
    stress_missing: str
    temperatures: MachineTemperatures | None
    heat_checks: tuple[Check, ...]
    heat_missing: str
    actuator: ActuatorParameters | None
    actuator_missing: str
    drawn: Drawn | None
    drawn_missing: str
    lasting_torque: float | None = None


def gather(
    machine: Machine,
    specimen: Specimen,
    then: Callable[[Evidence], _Then],
    *,
    samples: int,
    sensitivity: bool = False,
    progress: Progress = lambda _: None,
) -> tuple[Evidence, _Then]:
    """Ask every model about a machine.

    Parameters
    ----------
    then : callable
        What is made of all evidence but drawn gearboxes, while these are drawn.
    samples : int
        Toleranced gearboxes; 0 draws none.
    sensitivity : bool
        Whether to rank the tolerances too.
    progress : callable
        Told in a few words what begins, twice.

    Raises
    ------
    GeometryError
        When disc, ring or holes cannot exist.
    """
    # What cannot exist is refused before anything is told.
    _ = machine.analysis
    progress("judging loads, stress and life")
    # Gearboxes are drawn in compiled code, beside which all else has another core.
    with ThreadPoolExecutor(1) as beside:
        beside.submit(_unloaded, machine)
        # All that follows asks for them.
        _ = machine.bodies
        strained = beside.submit(judged_or_told, machine)
        heat = beside.submit(_heat, machine)
        motor = beside.submit(_actuator, machine, specimen)
        held = beside.submit(lambda: _lasting(machine, heat.result(), motor.result()[0]))

        def told() -> Evidence:
            stress, stress_checks, unstressed = strained.result()
            warm, heat_checks, cold = heat.result()
            actuator, no_actuator = motor.result()
            return Evidence(
                machine=machine,
                stress=stress,
                stress_checks=stress_checks,
                stress_missing="" if stress else " ".join(unstressed),
                temperatures=warm,
                heat_checks=heat_checks,
                heat_missing="" if warm else " ".join(cold),
                actuator=actuator,
                actuator_missing=no_actuator,
                drawn=None,
                drawn_missing="",
                lasting_torque=held.result(),
            )

        made = beside.submit(lambda: then(told()))
        progress("drawing toleranced gearboxes, and judging heat and motor")
        try:
            drawn, undrawn = _drawn(machine, samples, sensitivity, lambda: heat.result()[0])
        except BaseException:
            # Ctrl-C: what has not begun is not waited for.
            for one in (heat, motor, held, made):
                one.cancel()
            raise
        return replace(told(), drawn=drawn, drawn_missing=undrawn), made.result()


def _unloaded(machine: Machine) -> None:
    """Make what a machine keeps and needs no loads; its lines tell where that cannot be made."""
    with suppress(CqddError):
        _ = machine.inertia, machine.retention, machine.told_stacks, machine.tool_access
        cooled_network(machine)


def _actuator(machine: Machine, specimen: Specimen) -> tuple[ActuatorParameters | None, str]:
    try:
        return actuator_parameters(machine, specimen), ""
    except CqddError as error:
        return None, f"the actuator cannot be simulated: {error.message}"


def _heat(machine: Machine) -> _HeatTold:
    """Temperatures with their checks, and the cooling that is enough where parts get too warm."""
    warm, checks, told = judged_temperatures(machine)
    if warm is None or machine.stiff or checks[0].status != "fail":
        return warm, checks, told
    duty = bool(machine.design.requirements.load_cases)
    enough = remembered("cooling", machine, (*warm.steady,), lambda: enough_cooling(warm))
    remedy = cooling_remedy(enough, duty=duty)
    return warm, (replace(checks[0], remedy=remedy), *checks[1:]), told


def _lasting(
    machine: Machine, heat: _HeatTold, actuator: ActuatorParameters | None
) -> float | None:
    """The torque that all parts stand for ever, N m, as far as winding and drive hold it."""
    warm, checks, _ = heat
    if machine.stiff or actuator is None or warm is None:
        return None
    asked = machine.design.requirements
    holds = all(line.known and line.status == "pass" for line in checks)
    steady = not asked.load_cases
    if steady:
        speed, most = asked.held_speed, demands(actuator, asked)[1].found.most
        if holds and most <= asked.continuous_torque:
            return most
    else:
        speed = lasting_speed_of(asked)
        most = operating.lasting_torque(actuator, speed / asked.ratio)
    if most <= 0.0:
        return most
    # Where clearances are not known, temperatures alone decide.
    ways = (True, False) if checks[1].known else (False,)

    def find() -> float:
        for free in ways:
            told = {asked.continuous_torque: margin_of(warm, free=free)} if steady else {}
            found = lasting_torque(machine, most, speed, told, free=free)
            # Parts that press under any torque do so for other reasons.
            if found > 0.0:
                return found
        return 0.0

    try:
        return remembered("lasting torque", machine, (most, speed, *ways, *warm.steady), find)
    except (ContactError, DesignError, GeometryError):
        return None


def _drawn(
    machine: Machine,
    samples: int,
    sensitivity: bool,
    warm: Callable[[], MachineTemperatures | None],
) -> tuple[Drawn | None, str]:
    if not samples:
        return None, "no toleranced gearboxes were drawn here; `check` draws them"
    try:
        return drawn_gearboxes(machine, samples, sensitivity=sensitivity, warm=warm), ""
    except (ContactError, UsageError) as error:
        return None, f"no gearboxes could be drawn: {error.message}"
