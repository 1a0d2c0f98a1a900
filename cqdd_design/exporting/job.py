"""What every writer of files is given."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from cqdd_design.exporting.options import DEFAULTS, ExportOptions

if TYPE_CHECKING:
    from cqdd_design.actuator.motor_file import MotorFile
    from cqdd_design.actuator.parameters import ActuatorParameters
    from cqdd_design.design import Design
    from cqdd_design.solids.parts import Part

Progress = Callable[[str], None]


@dataclass(frozen=True)
class ExportJob:
    """What a writer needs: the design, where its files go, and the parts, built once for all.

    Attributes
    ----------
    design : Design
    folder : Path
        Exists; files go here under names that begin with the design's.
    progress : callable
        Told in a few words what is being done.
    options : ExportOptions
        How files are written.
    seed : int, optional
        Of the gearbox that simulators get; default perfect parts.
    calibration : mapping of str to float
        Factors of what the actuator's unknowns were computed as.
    motor : MotorFile, optional
        What a file says of the motor instead of the catalogue.
    """

    design: Design
    folder: Path
    progress: Progress
    options: ExportOptions = DEFAULTS
    seed: int | None = None
    calibration: Mapping[str, float] = field(default_factory=dict)
    motor: MotorFile | None = None

    def path(self, ending: str, within: str = "") -> Path:
        """File of this design: ``path("-disc.dxf")`` is ``<folder>/<name>-disc.dxf``.

        `within` names a folder below it, which need not exist yet.
        """
        return self.folder / within / f"{self.design.name}{ending}"

    @cached_property
    def actuator(self) -> ActuatorParameters:
        """The actuator in time, for the first writer that asks; later ones get the same."""
        from cqdd_design.actuator.bench.unknowns import apply_factors
        from cqdd_design.actuator.build import actuator_parameters

        found = actuator_parameters(self.design, seed=self.seed, own_motor=self.motor)
        return apply_factors(found, self.calibration)

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """The solids, for the first writer that asks; later ones get the same."""
        from cqdd_design.catalog import find_bearing
        from cqdd_design.exporting.edm.flat_parts import with_named_bearing
        from cqdd_design.solids.parts import build_parts

        self.progress("laying out parts")
        resolved = with_named_bearing(self.design)
        return build_parts(resolved, find_bearing(resolved.reducer.cam_bearing.designation))
