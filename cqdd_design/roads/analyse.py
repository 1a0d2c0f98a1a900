"""Everything a gearbox says about itself at one operating point."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from cqdd_design.actuator.duty_points import duty_points
from cqdd_design.actuator.shock import Shock, shocks
from cqdd_design.design import Design
from cqdd_design.design.requirements import LEAST_TORQUE, MOST_TORQUE
from cqdd_design.errors import ContactError, GeometryError, UsageError
from cqdd_design.gearbox import GearboxAnalysis
from cqdd_design.gearbox.bodies.strength import BodyStrength
from cqdd_design.gearbox.checks.allowables import YIELD_SAMPLES
from cqdd_design.gearbox.contact.laws import LineModel
from cqdd_design.gearbox.contact.rubbing import FrictionChoice
from cqdd_design.gearbox.heat.expansion import PartTemperatures
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.body_analysis import analyse_bodies, no_stress
from cqdd_design.machine.contact_analysis import ContactAnalysis, analyse_contact
from cqdd_design.machine.temperatures import MachineTemperatures, judged_temperatures
from cqdd_design.results import Check
from cqdd_design.verdict import Verdict, judge

ASKED, UNLOADED = "torque asked for", "no torque"
_AT = {
    "rigid": "peak torque",
    "rigid_continuous": "continuous torque",
    "rigid_series": "peak torque",
    "output_pins": "peak and continuous torque",
    "bearings": "peak and continuous torque",
    "contact": "peak torque",
    "precision": "continuous torque",
    "losses": "continuous torque",
    "film": "continuous torque",
    "wear": "duty",
    "life": "duty",
    "bending": "peak torque",
    "bodies": "peak and continuous torque",
    "temperatures_degC": "duty",
    "heat": "duty",
}
"""What sections stand for where no torque is asked for."""
_UNLOADED = ("geometry", "balance", "shock")
"""Sections of dimensions and speeds alone."""


@dataclass(frozen=True, eq=False)
class Analysis:
    """Closed forms of a gearbox, its contact equilibrium, and the stress in its bodies.

    Attributes
    ----------
    verdict : Verdict
        On the design as drawn; with toleranced gearboxes where lines of them are asked for.
    contact : ContactAnalysis or None
        None for a gearbox that cannot carry the torque.
    missing : str
        Why there is none.
    bodies : BodyStrength or None
        Stress in discs and ring under the forces of the equilibrium.
    bodies_missing : str
        Why there is none.
    shocks : mapping of str to Shock
        Stops of the output from the rated speed, and from a given one.
    shock_missing : str
        Why there are none.
    asked_torque : float or None
        What all loads are at, N m; None: those of the requirements.
    asked_speed : float or None
        Of the input, rad/s, in all but the verdict; None: that of the requirements.
    temperatures : MachineTemperatures or None
        At the duty, at the continuous torque, or at the one asked for.
    heat_missing : str
        Why there are none.
    """

    machine: Machine
    gearbox: GearboxAnalysis
    verdict: Verdict
    contact: ContactAnalysis | None
    missing: str
    bodies: BodyStrength | None = None
    bodies_missing: str = ""
    shocks: Mapping[str, Shock] = field(default_factory=dict)
    shock_missing: str = ""
    asked_torque: float | None = None
    asked_speed: float | None = None
    temperatures: MachineTemperatures | None = None
    heat_missing: str = ""

    @property
    def at(self) -> dict[str, str]:
        """What every section stands for: a torque, the duty, a speed, or dimensions alone."""
        asked = self.verdict.evidence.machine.design.requirements
        if self.asked_torque is not None:
            told = dict.fromkeys(_AT, ASKED) | dict.fromkeys(_UNLOADED, UNLOADED)
        else:
            duty = "duty" if asked.load_cases else "continuous torque"
            told = {name: duty if load == "duty" else load for name, load in _AT.items()}
            told |= dict.fromkeys(_UNLOADED, UNLOADED)
        over_time = {} if asked.duty_log is None else {"duty": "requirements"}
        return told | over_time | {"checks": "requirements"}

    @property
    def toleranced(self) -> bool:
        """Whether toleranced gearboxes were drawn for the verdict, and it is the whole one."""
        return asks_of_gearboxes(self.verdict.evidence.machine.design)

    @property
    def checks(self) -> tuple[Check, ...]:
        """Lines of the verdict, but `YIELD` where it is left to `check` to draw gearboxes."""
        lines = self.verdict.lines
        return lines if self.toleranced else tuple(one for one in lines if one.id != "YIELD")

    @property
    def warnings(self) -> tuple[str, ...]:
        """What was not checked or cannot be relied on."""
        warm = self.temperatures.warnings if self.temperatures else (self.heat_missing,)
        closed = (*self.gearbox.warnings, *self.machine.too_warm, *warm)
        if self.contact is None:
            return (*closed, f"no contact analysis: {self.missing}")
        told = () if self.bodies else (no_stress(self.machine, self.bodies_missing),)
        no_stop = (self.shock_missing,) if self.shock_missing else ()
        return (*closed, *self.contact.warnings, *told, *no_stop)

    def to_dict(self) -> dict[str, object]:
        """The JSON form (``results`` of ``analyse``)."""
        if self.contact is None:
            names = (
                *("contact", "precision", "losses", "film", "wear"),
                *("life", "bending", "bodies", "shock", "temperatures_degC", "heat"),
            )
            return self._head() | dict.fromkeys(names)
        bodies = None if self.bodies is None else self.bodies.to_dict()
        shock = {name: one.to_dict() for name, one in self.shocks.items()} or None
        warm: dict[str, object] = dict.fromkeys(("temperatures_degC", "heat"))
        if self.temperatures is not None:
            warm = self.temperatures.to_dict()
        found = {"bodies": bodies, "shock": shock} | warm
        return self._head() | self.contact.to_dict() | found

    def _head(self) -> dict[str, object]:
        """What there is without an equilibrium, and what all sections stand for."""
        rpm = None if self.asked_speed is None else self.asked_speed * 30.0 / math.pi
        at = {"torque_Nm": self.asked_torque, "speed_rpm": rpm, "sections": self.at}
        return {"at": at, "duty": self._duty()} | self.gearbox.to_dict()

    def _duty(self) -> dict[str, object] | None:
        """What the requirements' duty over time comes to, where there is one."""
        evidence = self.verdict.evidence
        asked = evidence.machine.design.requirements
        log = asked.duty_log
        if log is None:
            return None
        followed = {}
        if evidence.actuator is not None:
            followed = duty_points(evidence.actuator, log, asked.peak_torque).to_dict()
        return {"file": log.source} | log.figures.to_dict() | followed


def analyse(
    design: Design,
    *,
    torque: float | None = None,
    speed: float | None = None,
    angles: int,
    line_model: LineModel = "palmgren",
    friction: FrictionChoice = "drive",
    temperature: float | None = None,
) -> Analysis:
    """Analyse a design; one that cannot carry the torque as far as closed forms go.

    Parameters
    ----------
    torque : float, optional
        At the output, N m, instead of peak and continuous torque and of the duty, for ever; only
        the verdict stays that of the requirements.
    speed : float, optional
        Of the input, rad/s, in all but the verdict; default that of the requirements.
    angles : int
        Crank angles over a period.
    line_model : {"palmgren", "johnson", "linear"}
        Approach of teeth and pins.
    friction : {"drive", "backdrive", "off"}
        Of contact forces and precision; see `analyse_contact`.
    temperature : float, optional
        Of all parts of the gearbox, deg C; default 20, at which dimensions hold. Closed forms and
        checks are as drawn.

    Raises
    ------
    GeometryError
        When disc, ring or holes cannot exist.
    DesignError
        When the thermal expansion of a part is not known.
    UsageError
        For a torque or temperature outside the range that is worked with.
    """
    if torque is not None and not LEAST_TORQUE <= torque <= MOST_TORQUE:
        nearest = LEAST_TORQUE if torque < LEAST_TORQUE else MOST_TORQUE
        raise UsageError(
            f"--torque: {torque:.10g} N*m is outside {LEAST_TORQUE:g} to {MOST_TORQUE:g} N*m; the "
            f"nearest is {nearest:g} N*m."
        )
    drawn = loaded = resolve(design)
    if speed is not None:
        loaded = replace(loaded, design=loaded.design.turning_at(speed))
    if torque is not None:
        loaded = replace(loaded, design=loaded.design.under_torque(torque))
    machine = loaded
    if temperature is not None:
        machine = loaded.at(PartTemperatures.even(temperature))
    # What is judged is a matter of the design, whatever is asked for here.
    verdict = judge(drawn, samples=YIELD_SAMPLES if asks_of_gearboxes(design) else 0)
    warm, cold = verdict.evidence.temperatures, verdict.evidence.heat_missing
    if loaded is not drawn:
        warm, _, told = judged_temperatures(loaded)
        cold = "" if warm else " ".join(told)
    found = Analysis(
        machine,
        machine.analyse(angles=angles),
        verdict,
        contact=None,
        missing="",
        asked_torque=torque,
        asked_speed=speed,
        temperatures=warm,
        heat_missing=cold,
    )
    try:
        contact = analyse_contact(machine, angles=angles, line_model=line_model, friction=friction)
    except ContactError as error:
        return replace(found, missing=error.message)
    stops, unknown = shocks(machine)
    found = replace(found, contact=contact, shocks=stops, shock_missing=unknown)
    try:
        bodies = analyse_bodies(machine, line_model=line_model, friction=friction)
    except (ContactError, GeometryError) as error:
        return replace(found, bodies_missing=error.message)
    return replace(found, bodies=bodies)


def asks_of_gearboxes(design: Design) -> bool:
    """Whether a line of its verdict is of toleranced gearboxes, beside their share that passes."""
    asked = design.requirements
    return asked.backlash is not None or asked.stiffness is not None
