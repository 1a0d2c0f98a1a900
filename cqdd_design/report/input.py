"""What a report is made from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from cqdd_design.design import Design
from cqdd_design.files import WrittenFile
from cqdd_design.gearbox import GearboxAnalysis
from cqdd_design.machine import Machine
from cqdd_design.machine.weighing import Bodies
from cqdd_design.planetary.compare import PlanetaryComparison
from cqdd_design.planetary.cycloid import CycloidLimit
from cqdd_design.results import Check, Provenance

if TYPE_CHECKING:
    from cqdd_design.actuator.bench import BenchResult
    from cqdd_design.actuator.parameters import ActuatorParameters
    from cqdd_design.actuator.shock import Shock
    from cqdd_design.gearbox.tolerance.clearance import ClearancePoint
    from cqdd_design.machine.contact_analysis import ContactAnalysis
    from cqdd_design.report.machine_view.model import ViewerData
    from cqdd_design.report.machine_view.stills import MachineViews
    from cqdd_design.sizing.result import SizingResult
    from cqdd_design.verdict import Verdict
    from cqdd_design.verdict.evidence import Evidence


@dataclass(frozen=True)
class ReportInput:
    """Results that one report shows; sections without results are left out.

    Attributes
    ----------
    machine : Machine
        The design, as given and made concrete.
    gearbox : GearboxAnalysis
        At the torques of the requirements.
    planetary : PlanetaryComparison or None
        For the same loads, where the design is the paper's actuator.
    limits : tuple of CycloidLimit
        Torques at which parts of the gearbox reach their limits.
    comments : mapping
        Dotted key to the remark in the design file, from :func:`.origins.read_comments`.
    bodies : Bodies or None
        Parts, mass properties and balance, from :func:`.weighing.weigh`.
    notes : tuple of str
        Sentences on what could not be computed.
    sizing : SizingResult or None
        Where the design has been found by a search in the same run.
    costs : tuple of str
        What more would cost, where a search told.
    files : tuple of WrittenFile
        Written in the same run.
    target : Path or None
        Where the page will stand, for links to these files.
    contact : ContactAnalysis or None
        At the torques of the requirements: contact, precision, losses and life.
    verdict : Verdict
        With the evidence that several chapters show.
    clearances : tuple of ClearancePoint
        What other clearances would make of it.
    pictures : (MachineViews, ViewerData) or None
        Pictures of the solids, and their model in three dimensions.
    bench : (ActuatorParameters, BenchResult) or None
        The simulated actuator, and what the virtual test bench measured on it.
    bench_missing : str
        A sentence on why there is none; empty where nobody asked for it.
    shocks : mapping of str to Shock
        Stops of the output, by which speed.
    """

    machine: Machine
    gearbox: GearboxAnalysis
    provenance: Provenance
    verdict: Verdict
    planetary: PlanetaryComparison | None = None
    limits: tuple[CycloidLimit, ...] = ()
    comments: Mapping[str, str] = field(default_factory=dict)
    bodies: Bodies | None = None
    notes: tuple[str, ...] = ()
    sizing: SizingResult | None = None
    costs: tuple[str, ...] = ()
    files: tuple[WrittenFile, ...] = ()
    target: Path | None = None
    contact: ContactAnalysis | None = None
    clearances: tuple[ClearancePoint, ...] = ()
    pictures: tuple[MachineViews, ViewerData] | None = None
    bench: tuple[ActuatorParameters, BenchResult] | None = None
    bench_missing: str = ""
    shocks: Mapping[str, Shock] = field(default_factory=dict)

    @property
    def evidence(self) -> Evidence:
        """What the verdict rests on."""
        return self.verdict.evidence

    @property
    def checks(self) -> tuple[Check, ...]:
        """Lines of the verdict."""
        return self.verdict.lines

    @property
    def design(self) -> Design:
        """The design as given, so that its assumed values are known as such."""
        return self.machine.given
