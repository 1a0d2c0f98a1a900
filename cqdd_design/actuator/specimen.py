"""Which actuator of a design is meant: its motor, its gearbox, what was fitted to it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from cqdd_design.actuator.bench.unknowns import UNKNOWNS
from cqdd_design.actuator.motor_file import MotorFile
from cqdd_design.catalog.motors import find_motor
from cqdd_design.design import Design
from cqdd_design.machine import Machine, resolve


@dataclass(frozen=True)
class Specimen:
    """One actuator among all that a design may become.

    Attributes
    ----------
    motor : MotorFile or None
        What a file says of the motor instead of the catalogue.
    seed : int or None
        Of a gearbox drawn from the tolerances; None for perfect parts.
    factors : mapping of str to float
        Of what the actuator's unknowns were computed as, or their values, from a calibration.
    """

    motor: MotorFile | None = None
    seed: int | None = None
    factors: Mapping[str, float] = field(default_factory=dict)

    @property
    def remarks(self) -> tuple[str, ...]:
        """Sentences on what is not as the design and the catalogue alone would have it."""
        found = []
        if self.motor is not None:
            found.append(
                f"the motor is {self.motor.name} from {self.motor.place}; what the file leaves "
                "out is the catalogue's."
            )
        if self.seed is not None:
            found.append(
                f"the simulated gearbox is drawn from the tolerances with seed {self.seed}."
            )
        if self.factors:
            names = ", ".join(f"{name} {_told(name, f)}" for name, f in self.factors.items())
            found.append(f"the simulated actuator is calibrated: {names}.")
        return tuple(found)

    def machine(self, design: Design) -> Machine:
        """The design made concrete with this motor; see `machine.resolve` for what it raises."""
        if self.motor is None:
            return resolve(design)
        name = design.motor.name
        # Whoever gives a motor's data asks for that motor: it is no longer assumed.
        named = (
            design if "motor.name" not in design.assumed else design.replacing({"motor.name": name})
        )
        return resolve(named, self.motor.row(find_motor(name)))


def _told(name: str, fitted: float) -> str:
    return UNKNOWNS[name].told(fitted) if name in UNKNOWNS else f"{fitted:.4g}"


AS_DRAWN = Specimen()
"""The catalogue's motor, perfect parts, nothing fitted."""
