"""What every writer of files is given."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from cqdd_design.actuator.specimen import AS_DRAWN, Specimen
from cqdd_design.exporting.options import DEFAULTS, ExportOptions

if TYPE_CHECKING:
    from cqdd_design.actuator.parameters import ActuatorParameters
    from cqdd_design.design import Design
    from cqdd_design.machine import Machine
    from cqdd_design.solids.part import Part

Progress = Callable[[str], None]


@dataclass(frozen=True)
class ExportJob:
    """What a writer needs: the design, where its files go, and the parts, built once for all.

    Attributes
    ----------
    machine : Machine
        Of the specimen's motor.
    folder : Path
        Exists; files go here under names that begin with the design's.
    progress : callable
        Told in a few words what is being done.
    options : ExportOptions
        How files are written.
    specimen : Specimen
        Which actuator simulators get.
    """

    machine: Machine
    folder: Path
    progress: Progress
    options: ExportOptions = DEFAULTS
    specimen: Specimen = AS_DRAWN

    @property
    def design(self) -> Design:
        """The design as it was given."""
        return self.machine.given

    def path(self, ending: str, within: str = "") -> Path:
        """File of this design: ``path("-disc.dxf")`` is ``<folder>/<name>-disc.dxf``.

        `within` names a folder below it, which need not exist yet.
        """
        return self.folder / within / f"{self.design.file_name}{ending}"

    @cached_property
    def actuator(self) -> ActuatorParameters:
        """The actuator in time, for the first writer that asks; later ones get the same."""
        from cqdd_design.actuator.build import actuator_parameters

        return actuator_parameters(self.machine, self.specimen)

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """The solids, for the first writer that asks; later ones get the same."""
        self.progress("laying out parts")
        return self.machine.parts
