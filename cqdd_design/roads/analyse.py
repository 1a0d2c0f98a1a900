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
from cqdd_design.machine.body_analysis import analyse_bodies, judged_bodies, no_stress
from cqdd_design.machine.contact_analysis import ContactAnalysis, analyse_contact
from cqdd_design.machine.temperatures import MachineTemperatures, judged_temperatures
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
    temperatures : MachineTemperatures or None
        Of the parts, at the duty of the requirements or at the continuous torque.
    heat_checks : tuple of Check
        Of them, and of the clearances they leave.
    heat_warnings : tuple of str
        What they leave out, or why there are none.
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
    temperatures: MachineTemperatures | None = None
    heat_checks: tuple[Check, ...] = ()
    heat_warnings: tuple[str, ...] = ()

    @property
    def checks(self) -> tuple[Check, ...]:
        """Those of the closed forms, of discs and ring, and of heat, where there are any."""
        return (*self.gearbox.checks, *self.body_checks, *self.heat_checks)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What was not checked or cannot be relied on."""
        closed = (*self.gearbox.warnings, *self.machine.too_warm, *self.heat_warnings)
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
        if self.temperatures is not None:
            warm = self.temperatures.to_dict()
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
    # What settles is a matter of the duty, whatever temperature is asked for.
    warm, heat_checks, heat_warnings = judged_temperatures(drawn)
    found = Analysis(
        machine,
        gearbox,
        contact=None,
        missing="",
        temperatures=warm,
        heat_checks=heat_checks,
        heat_warnings=heat_warnings,
    )
    try:
        contact = analyse_contact(
            machine, torque=torque, angles=angles, line_model=line_model, friction=friction
        )
    except ContactError as error:
        return replace(found, missing=error.message)
    stops, unknown = shocks(machine)
    found = replace(found, contact=contact, shocks=stops, shock_missing=unknown)
    try:
        checks, bodies = judged_bodies(machine, line_model, friction)
        if torque is not None:
            bodies = analyse_bodies(
                machine, torque=torque, line_model=line_model, friction=friction
            )
    except (ContactError, GeometryError) as error:
        return replace(found, bodies_missing=error.message)
    return replace(found, bodies=bodies, body_checks=checks)
