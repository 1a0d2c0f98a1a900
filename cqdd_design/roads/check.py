"""Judge a design by its verdict; where asked, turn its solids through a revolution too."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from cqdd_design.actuator.specimen import AS_DRAWN, Specimen
from cqdd_design.design import Design
from cqdd_design.errors import DesignError
from cqdd_design.gearbox.checks.guide import check_guide
from cqdd_design.machine.centring import centring
from cqdd_design.machine.motor_standing import motor_standing
from cqdd_design.machine.sealing import sealing
from cqdd_design.results import Check
from cqdd_design.roads.sized_file import kept_costs
from cqdd_design.roads.telling import Progress, silent
from cqdd_design.verdict import Verdict, judge
from cqdd_design.verdict.judge import Meets, meets

if TYPE_CHECKING:
    from cqdd_design.machine import Machine
    from cqdd_design.solids.clearances import AssemblyMotion

#: How often `check` tells what begins.
CHECK_STAGES = 2


@dataclass(frozen=True)
class Judgement:
    """What a design is judged to be.

    Attributes
    ----------
    verdict : Verdict
    lines : tuple of Check
        Of the verdict, and of the solids where they were turned.
    motion : AssemblyMotion or None
        What a revolution of the output showed, where it was asked for.
    costs : tuple of str
        What more would cost, where `size` noted it in the design's file.
    """

    verdict: Verdict
    lines: tuple[Check, ...]
    motion: AssemblyMotion | None = None
    costs: tuple[str, ...] = ()

    @property
    def meets(self) -> Meets:
        """The answer with what the solids showed."""
        return meets(self.lines)

    def to_dict(self) -> dict[str, object]:
        """The JSON form (``results`` of ``check``)."""
        told = self.verdict.to_dict() | {"meets": self.meets}
        seen = {} if self.motion is None else {"assembly": self.motion.to_dict()}
        return {
            "verdict": told,
            "retention": self._retention,
            "costs": list(self.costs),
            "axial_play": self._axial_play,
            "sealing": self._told(sealing),
            "centring": self._told(centring),
            "motor_standing": self._told(motor_standing),
            **seen,
        }

    @property
    def _retention(self) -> list[dict[str, object]]:
        """What holds every part; empty where nothing can be laid out."""
        try:
            table = self.verdict.evidence.machine.retention
        except DesignError:
            return []
        return [row.to_dict() for row in table]

    def _told(self, what: Callable[[Machine], str]) -> str | None:
        """A sentence on the machine as drawn; None where nothing can be laid out."""
        try:
            return what(self.verdict.evidence.machine)
        except DesignError:
            return None

    @property
    def _axial_play(self) -> list[dict[str, object]]:
        """The stacks of axial play; empty where nothing can be laid out."""
        try:
            stacks = self.verdict.evidence.machine.told_stacks
        except DesignError:
            return []
        return [one.to_dict() for one in stacks]


def check(
    design: Design,
    specimen: Specimen = AS_DRAWN,
    *,
    source: Path | None = None,
    assembly_angles: int | None = None,
    told: Progress = silent,
    progress: Callable[[int, int], None] | None = None,
) -> Judgement:
    """Judge a design against its requirements; see `verdict.judge`.

    Parameters
    ----------
    specimen : Specimen
        Whose motor is judged.
    source : Path, optional
        The design's file, in which `size` may have noted what more would cost.
    assembly_angles : int, optional
        Crank angles at which all solids are looked at for collisions; default not at all.
    told : callable
        Told in a few words what begins, `CHECK_STAGES` times.
    progress : callable, optional
        Told how many of these angles are done, and of how many.

    Raises
    ------
    GeometryError
        When disc, ring or holes cannot exist, or, looked at as solids, the parts.
    """
    machine = specimen.machine(design)
    verdict = judge(machine, specimen, progress=told)
    told_costs = () if source is None else kept_costs(source, design)
    if assembly_angles is None:
        return Judgement(verdict, verdict.lines, costs=told_costs)
    from cqdd_design.solids.clearances import assembly_motion, output_revolution

    motion = assembly_motion(
        machine.design,
        machine.parts,
        output_revolution(machine.design, assembly_angles),
        progress=progress,
    )
    lines = (*verdict.lines, assembly_check(motion))
    return Judgement(verdict, lines, motion, told_costs)


def assembly_check(motion: AssemblyMotion) -> Check:
    """The check ``ASSEMBLY-CLEAR`` of what a revolution showed."""
    guide = check_guide("ASSEMBLY-CLEAR")
    remedy, found = "", f"{motion.pairs} pairs of solids at {motion.angles} crank angles"
    if motion.collisions:
        worst = motion.collisions[0]
        found = (
            f"{worst.first} and {worst.second} share {worst.volume * 1e9:.3g} mm^3 at "
            f"{math.degrees(worst.crank_angle):.4g} deg"
        )
        remedy = f"Give {worst.first} and {worst.second} {worst.thickness * 1e6:.3g} um more room."
    return Check(
        id=guide.id,
        title=guide.title,
        value=float(len({(one.first, one.second) for one in motion.collisions})),
        limit=0.0,
        unit=guide.unit,
        sense=guide.sense,
        formula=guide.formula,
        substituted=found,
        why=guide.why,
        remedy=remedy,
        source=guide.source,
        basis=guide.basis,
    )
