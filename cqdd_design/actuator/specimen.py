"""Which actuator of a design is meant: its gearbox, and what was fitted to it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from cqdd_design.actuator.bench.unknowns import UNKNOWNS
from cqdd_design.design import Design
from cqdd_design.machine import Machine, resolve


@dataclass(frozen=True)
class Specimen:
    """One actuator among all that a design may become.

    Attributes
    ----------
    seed : int or None
        Of a gearbox drawn from the tolerances; None for perfect parts.
    factors : mapping of str to float
        Of what the actuator's unknowns were computed as, or their values, from a calibration.
    """

    seed: int | None = None
    factors: Mapping[str, float] = field(default_factory=dict)

    @property
    def remarks(self) -> tuple[str, ...]:
        """Sentences on what is not as the design alone would have it."""
        found = []
        if self.seed is not None:
            found.append(
                f"the simulated gearbox is drawn from the tolerances with seed {self.seed}."
            )
        if self.factors:
            names = ", ".join(f"{name} {_told(name, f)}" for name, f in self.factors.items())
            found.append(f"the simulated actuator is calibrated: {names}.")
        return tuple(found)

    def machine(self, design: Design) -> Machine:
        """The design made concrete; see `machine.resolve` for what it raises."""
        return resolve(design)


def _told(name: str, fitted: float) -> str:
    return UNKNOWNS[name].told(fitted) if name in UNKNOWNS else f"{fitted:.4g}"


AS_DRAWN = Specimen()
"""Perfect parts, nothing fitted."""
