"""Everything a gearbox says about itself at one operating point."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from cqdd_design.actuator.shock import Shock, shocks
from cqdd_design.design import Design
from cqdd_design.errors import ContactError, GeometryError
from cqdd_design.gearbox import GearboxAnalysis
from cqdd_design.gearbox.bodies.strength import BodyStrength
from cqdd_design.gearbox.contact.laws import LineModel
from cqdd_design.gearbox.contact.rubbing import FrictionChoice
from cqdd_design.gearbox.heat.expansion import PartTemperatures
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.body_analysis import analyse_bodies, no_stress
from cqdd_design.machine.contact_analysis import ContactAnalysis, analyse_contact
from cqdd_design.results import Check
from cqdd_design.verdict import Verdict, judge


@dataclass(frozen=True, eq=False)
class Analysis:
    """Closed forms of a gearbox, its contact equilibrium, and the stress in its bodies.

    Attributes
    ----------
    verdict : Verdict
        On the design as drawn, without toleranced gearboxes.
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

    @property
    def checks(self) -> tuple[Check, ...]:
        """Lines of the verdict but that of toleranced gearboxes, which `check` draws."""
        return tuple(line for line in self.verdict.lines if line.id != "YIELD")

    @property
    def warnings(self) -> tuple[str, ...]:
        """What was not checked or cannot be relied on."""
        found = self.verdict.evidence
        warm = found.temperatures.warnings if found.temperatures else (found.heat_missing,)
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
            absent = dict.fromkeys(names)
            return self.gearbox.to_dict() | absent
        bodies = None if self.bodies is None else self.bodies.to_dict()
        shock = {name: one.to_dict() for name, one in self.shocks.items()} or None
        warm: dict[str, object] = dict.fromkeys(("temperatures_degC", "heat"))
        if self.verdict.evidence.temperatures is not None:
            warm = self.verdict.evidence.temperatures.to_dict()
        found = {"bodies": bodies, "shock": shock} | warm
        return self.gearbox.to_dict() | self.contact.to_dict() | found


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
        At the output, N m; see `analyse_contact`.
    speed : float, optional
        Input speed, rad/s; default that of the requirements.
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
        For a temperature outside the range that is worked with.
    """
    asked = design if speed is None else design.turning_at(speed)
    drawn = resolve(asked)
    machine = drawn
    if temperature is not None:
        machine = drawn.at(PartTemperatures.even(temperature))
    gearbox = machine.analyse(torque=torque, angles=angles)
    # What is judged, and what settles, are a matter of the design, whatever is asked for here.
    found = Analysis(machine, gearbox, judge(drawn, samples=0), contact=None, missing="")
    try:
        contact = analyse_contact(
            machine, torque=torque, angles=angles, line_model=line_model, friction=friction
        )
    except ContactError as error:
        return replace(found, missing=error.message)
    stops, unknown = shocks(machine)
    found = replace(found, contact=contact, shocks=stops, shock_missing=unknown)
    try:
        bodies = analyse_bodies(machine, torque=torque, line_model=line_model, friction=friction)
    except (ContactError, GeometryError) as error:
        return replace(found, bodies_missing=error.message)
    return replace(found, bodies=bodies)
