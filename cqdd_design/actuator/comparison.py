"""The paper's table of actuators, recomputed, with further actuators and the present design beside.

Torque density is computed from peak torque and mass and kept beside the printed one. Geared
actuators of the motor catalogue that have both join by name.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from cqdd_design.catalog import paper
from cqdd_design.catalog.motors import find_motor
from cqdd_design.errors import CatalogError

_ROUNDING = 0.5
"""Of the last printed digit."""


@dataclass(frozen=True)
class ComparedActuator:
    """One column of the table.

    Attributes
    ----------
    peak_torque, mass : float
        N m at the output, kg.
    torque_density_printed : float or None
        As the source prints it, N m/kg.
    printed_digits : int
        Its decimals.
    efficiency : float or None
        0 to 1.
    """

    name: str
    gearing: str
    source: str
    ratio: float | None
    peak_torque: float
    mass: float
    torque_density_printed: float | None = None
    printed_digits: int = 0
    efficiency: float | None = None

    @property
    def torque_density(self) -> float:
        """Peak torque over mass, N m/kg."""
        return self.peak_torque / self.mass

    @property
    def remark(self) -> str:
        """What the printed torque density should have been; empty where it is right."""
        printed, digits = self.torque_density_printed, self.printed_digits
        if printed is None or abs(printed - self.torque_density) <= _ROUNDING * 10.0**-digits:
            return ""
        return (
            f"{self.name}: {self.peak_torque:g} N*m / {self.mass:g} kg is "
            f"{self.torque_density:.2f} N*m/kg, printed {printed:g} N*m/kg"
        )

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form."""
        return {
            "name": self.name,
            "gearing": self.gearing,
            "ratio": self.ratio,
            "peak_torque_Nm": self.peak_torque,
            "mass_kg": self.mass,
            "torque_density_Nm_per_kg": self.torque_density,
            "torque_density_printed_Nm_per_kg": self.torque_density_printed,
            "efficiency": self.efficiency,
            "remark": self.remark,
            "source": self.source,
        }


def published_actuators() -> tuple[ComparedActuator, ...]:
    """The columns of the paper's table, in its order."""
    return tuple(
        ComparedActuator(
            source="Zhu et al., arXiv:2410.16591, comparison table",
            torque_density_printed=float(row.torque_density),
            printed_digits=len(row.torque_density.partition(".")[2]),
            **{key: value for key, value in row._asdict().items() if key != "torque_density"},
        )
        for row in paper.COMPARISON
    )


def catalogue_actuator(name: str) -> ComparedActuator:
    """A geared actuator of the motor catalogue.

    Raises
    ------
    CatalogError
        Where the catalogue has no such row, or one without peak torque and mass at an output.
    """
    row = find_motor(name)
    if row.torque_at != "output" or not row.peak_torque or not row.mass:
        raise CatalogError(
            f"{row.name} has no peak torque at a gearbox's output and mass to compare; choose a "
            "geared actuator such as 'CubeMars AK10-9 V2 KV60'."
        )
    kind = row.kind.removesuffix(" actuator")
    return ComparedActuator(row.name, kind, row.source, row.gear_ratio, row.peak_torque, row.mass)


def present_actuator(
    name: str, ratio: float, peak_torque: float, mass: float, efficiency: float | None
) -> ComparedActuator:
    """The column of a design, with what the virtual test bench measured of it."""
    return ComparedActuator(
        name=f"{name} (this design)",
        gearing="cycloid",
        source="virtual test bench: peak torque that motor and driver give, no more than is "
        "required of the gearbox; mass of the solids, and of a motor that is not drawn",
        ratio=abs(ratio),
        peak_torque=peak_torque,
        mass=mass,
        efficiency=efficiency,
    )


def compare_actuators(
    own: ComparedActuator | None = None, more: Sequence[str] = ()
) -> tuple[ComparedActuator, ...]:
    """The paper's columns, then the present design, then geared actuators of the catalogue."""
    present = () if own is None else (own,)
    return (*published_actuators(), *present, *(catalogue_actuator(name) for name in more))
