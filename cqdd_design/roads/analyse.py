"""Everything a gearbox says about itself at one operating point."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from cqdd_design.actuator.shock import Shock, shocks
from cqdd_design.design import Design
from cqdd_design.errors import ContactError, GeometryError
from cqdd_design.gearbox import GearboxAnalysis
from cqdd_design.gearbox.bodies.strength import BodyStrength
from cqdd_design.gearbox.contact.laws import LineModel
from cqdd_design.gearbox.contact.rubbing import FrictionChoice
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.body_analysis import analyse_bodies, judged_bodies, no_stress
from cqdd_design.machine.contact_analysis import ContactAnalysis, analyse_contact
from cqdd_design.results import Check


@dataclass(frozen=True, eq=False)
class Analysis:
    """Closed forms of a gearbox, its contact equilibrium, and the stress in its bodies.

    Attributes
    ----------
    contact : ContactAnalysis or None
        None for a gearbox that cannot carry the torque.
    missing : str
        Why there is none.
    bodies : BodyStrength or None
        Stress in discs and ring under the forces of the equilibrium.
    bodies_missing : str
        Why there is none.
    body_checks : tuple of Check
        Of that stress, at the torques of the requirements.
    shocks : mapping of str to Shock
        Stops of the output from the rated speed, and from a given one.
    shock_missing : str
        Why there are none.
    """

    machine: Machine
    gearbox: GearboxAnalysis
    contact: ContactAnalysis | None
    missing: str
    bodies: BodyStrength | None = None
    bodies_missing: str = ""
    body_checks: tuple[Check, ...] = ()
    shocks: Mapping[str, Shock] = field(default_factory=dict)
    shock_missing: str = ""

    @property
    def checks(self) -> tuple[Check, ...]:
        """Those of the closed forms, and those of discs and ring where there are any."""
        return (*self.gearbox.checks, *self.body_checks)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What was not checked or cannot be relied on."""
        if self.contact is None:
            return (*self.gearbox.warnings, f"no contact analysis: {self.missing}")
        told = () if self.bodies else (no_stress(self.machine, self.bodies_missing),)
        no_stop = (self.shock_missing,) if self.shock_missing else ()
        return (*self.gearbox.warnings, *self.contact.warnings, *told, *no_stop)

    def to_dict(self) -> dict[str, object]:
        """The JSON form (``results`` of ``analyse``)."""
        if self.contact is None:
            names = ("contact", "precision", "losses", "life", "bending", "bodies", "shock")
            absent = dict.fromkeys(names)
            return self.gearbox.to_dict() | absent
        bodies = None if self.bodies is None else self.bodies.to_dict()
        shock = {name: one.to_dict() for name, one in self.shocks.items()} or None
        found = {"bodies": bodies, "shock": shock}
        return self.gearbox.to_dict() | self.contact.to_dict() | found


def analyse(
    design: Design,
    *,
    torque: float | None = None,
    speed: float | None = None,
    angles: int,
    line_model: LineModel = "palmgren",
    friction: FrictionChoice = "drive",
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

    Raises
    ------
    GeometryError
        When disc, ring or holes cannot exist.
    """
    asked = design if speed is None else design.replacing({"requirements.input_speed": speed})
    machine = resolve(asked)
    gearbox = machine.analyse(torque=torque, angles=angles)
    try:
        contact = analyse_contact(
            machine, torque=torque, angles=angles, line_model=line_model, friction=friction
        )
    except ContactError as error:
        return Analysis(machine, gearbox, None, error.message)
    stops, unknown = shocks(machine)
    try:
        checks, bodies = judged_bodies(machine, line_model, friction)
        if torque is not None:
            bodies = analyse_bodies(
                machine, torque=torque, line_model=line_model, friction=friction
            )
    except (ContactError, GeometryError) as error:
        return Analysis(machine, gearbox, contact, "", None, error.message, (), stops, unknown)
    return Analysis(machine, gearbox, contact, "", bodies, "", checks, stops, unknown)
