"""Calls that judge a design: `check` and `analyse`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Literal, cast, get_args

from cqdd_design.library.calls import one_of, road, si_value, whole
from cqdd_design.library.inputs import DesignLike, design_of, source_of
from cqdd_design.library.results import Result, Row, check_rows

if TYPE_CHECKING:
    from cqdd_design.report.notebook import Section
    from cqdd_design.results import Check
    from cqdd_design.roads.analyse import Analysis
    from cqdd_design.roads.check import Judgement
    from cqdd_design.units import Quantity
    from cqdd_design.verdict import Verdict
    from cqdd_design.verdict.judge import Meets


ContactLaw = Literal["palmgren", "johnson", "linear"]
Friction = Literal["drive", "backdrive", "off"]


@dataclass(frozen=True, eq=False, repr=False)
class Checked(Result):
    """What `check` returns; `to_pandas` has a row a check.

    Attributes
    ----------
    found : Judgement
        The verdict, its lines, and what the solids showed where they were turned.
    """

    command: ClassVar[str] = "check"

    found: Judgement

    @property
    def verdict(self) -> Verdict:
        """With its evidence."""
        return self.found.verdict

    @property
    def checks(self) -> tuple[Check, ...]:
        """Every requirement and check."""
        return self.found.lines

    @property
    def meets(self) -> Meets:
        """``"yes"``, ``"no"``, or ``"unknown"`` where nothing fails and something is not known."""
        return self.found.meets

    def _results(self) -> Mapping[str, Any]:
        return self.found.to_dict()

    def _rows(self) -> Sequence[Row]:
        return check_rows(self.checks)


@road
def check(
    design: DesignLike,
    *,
    assembly: bool = False,
    angles: int = 72,
    progress: Callable[[str], None] | None = None,
) -> Checked:
    """Judge a design against its requirements, every line by the best model there is.

    Parameters
    ----------
    design : Design or path
        A path is that of a design file; a bare name may be an example's.
    assembly : bool
        Also turn all solids through a revolution of the output, and look for collisions.
    angles : int
        Crank angles of `assembly`, 1 to 100,000.
    progress : callable, optional
        Told in a few words what begins.

    Returns
    -------
    Checked
        `meets`, `verdict` with its seven figures (`verdict.headline`) and what binds
        (`verdict.limits`), and `checks`: each a value and a limit in its own unit.

    Raises
    ------
    UsageError
        No such file or example; angles out of range.
    DesignError
        The file is no valid design.
    GeometryError
        Disc, ring or holes cannot exist.

    Notes
    -----
    What a line rests on stands in its `basis` and `source`; docs/assumptions.md lists the limits.

    Examples
    --------
    >>> import cqdd_design as cq
    >>> judged = cq.check("cqdd-10")
    >>> judged.meets
    'no'
    >>> [figure.id for figure in judged.verdict.headline][:3]
    ['peak_torque', 'continuous_torque', 'life']
    """
    from cqdd_design.roads.check import check as judge
    from cqdd_design.roads.telling import silent

    count = whole("angles", angles, 1, 100_000)
    loaded = design_of(design)
    found = judge(
        loaded,
        source=source_of(design),
        assembly_angles=count if assembly else None,
        told=progress or silent,
    )
    return Checked(loaded, found.verdict.warnings, found)


@dataclass(frozen=True, eq=False, repr=False)
class Analysed(Result):
    """What `analyse` returns; `to_pandas` has a row a contact at each crank angle.

    Attributes
    ----------
    found : Analysis
        Closed forms (`gearbox`), equilibrium (`contact`), bodies, shocks and temperatures.
    """

    command: ClassVar[str] = "analyse"

    found: Analysis

    @property
    def verdict(self) -> Verdict:
        """On the design as drawn.

        Without toleranced gearboxes, and so never a yes, unless the requirements ask for their
        backlash or stiffness.
        """
        return self.found.verdict

    @property
    def checks(self) -> tuple[Check, ...]:
        """Lines of the verdict; without `YIELD` where no toleranced gearboxes were drawn."""
        return self.found.checks

    def _told(self) -> str:
        more = "" if self.found.toleranced else " (`check` draws toleranced ones too)"
        return f"{self._answer(self.checks)}{more}"

    def _results(self) -> Mapping[str, Any]:
        return self.found.to_dict()

    def _rows(self) -> Sequence[Row]:
        contact = self.to_dict()["results"]["contact"]
        if contact is None:
            return []
        return [
            {
                "crank_angle_deg": angle,
                "disc": disc + 1,
                "contact": contact_name,
                "number": number + 1,
                "force_N": force,
            }
            for key, contact_name in (("ring_force_N", "tooth"), ("output_pin_force_N", "pin"))
            for angle, discs in zip(contact["crank_angle_deg"], contact[key], strict=True)
            for disc, forces in enumerate(discs)
            for number, force in enumerate(forces)
        ]

    def _sections(self) -> Sequence[Section]:
        from cqdd_design.report.gearbox.contact import contact_view
        from cqdd_design.report.notebook import Section, outlines_of

        if self.found.contact is None:
            return ()
        gearbox = self.found.gearbox
        outlines = outlines_of(self.found.machine)
        view = contact_view(self.found.contact, outlines, gearbox.rigid)
        return (Section("contact.html", {"contact": view}),)


@road
def analyse(
    design: DesignLike,
    *,
    torque: Quantity | None = None,
    angles: int = 360,
    speed: Quantity | None = None,
    contact_law: ContactLaw = "palmgren",
    friction: Friction = "drive",
    temperature: Quantity | None = None,
) -> Analysed:
    """Loads, contact equilibrium, precision, losses, life, stress, temperatures and shock.

    Parameters
    ----------
    design : Design or path
        A path is that of a design file; a bare name may be an example's.
    torque : quantity, optional
        At the output, 0.001 to 100,000 N m, for ever, instead of the requirements' torques and
        duty; the verdict stays theirs.
    angles : int
        Crank angles of the curves, 8 to 100,000.
    speed : quantity, optional
        Of the input, above zero; default that of the requirements, whose verdict stays.
    contact_law : {"palmgren", "johnson", "linear"}
        How line contacts yield to force.
    friction : {"drive", "backdrive", "off"}
        Which way power goes through contacts that rub, if they do.
    temperature : quantity, optional
        Of all parts of the gearbox; default 20 deg C, at which dimensions hold.

    Returns
    -------
    Analysed
        `to_dict()["results"]` has the shapes: forces [angle][disc][tooth or pin] in N, points in
        mm, precision in arcmin, N m/arcmin and N m, losses in W.

    Raises
    ------
    UsageError
        A quantity without its unit, of another kind or out of range; no such law or friction.
    DesignError, GeometryError
        No valid design, or a shape that cannot exist.

    Notes
    -----
    The model is docs/contact-model.md, with its sources; closed forms are docs/theory.md.

    Examples
    --------
    >>> import cqdd_design as cq
    >>> found = cq.analyse("cqdd-10", torque="40 N*m", angles=24)
    >>> contact = found.to_dict()["results"]["contact"]
    >>> len(contact["ring_force_N"]), len(contact["ring_force_N"][0])
    (24, 2)
    """
    from cqdd_design.roads.analyse import analyse as solve
    from cqdd_design.units import SPEED, TEMPERATURE, TORQUE

    law = cast("ContactLaw", one_of("contact_law", contact_law, get_args(ContactLaw)))
    rubbing = cast("Friction", one_of("friction", friction, get_args(Friction)))
    found = solve(
        design_of(design),
        torque=si_value("torque", torque, TORQUE),
        speed=si_value("speed", speed, SPEED, positive=True),
        angles=whole("angles", angles, 8, 100_000),
        line_model=law,
        friction=rubbing,
        temperature=si_value("temperature", temperature, TEMPERATURE),
    )
    return Analysed(found.machine.given, found.warnings, found)
