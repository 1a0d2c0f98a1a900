"""What no drawing tells of an actuator, the measurement that decides it, and factors on it."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.errors import UsageError, did_you_mean


@dataclass(frozen=True)
class Unknown:
    """Something that no drawing tells.

    Attributes
    ----------
    part : str
        Of the actuator's parameters.
    names : tuple of str
        Values of that part that one factor multiplies.
    told_by : str
        The measurement that decides it.
    unit : str
        Of a value; empty for a factor.
    """

    part: str
    names: tuple[str, ...]
    told_by: str
    unit: str = ""

    def bounds(self, parameters: ActuatorParameters) -> tuple[float, float]:
        """Range in which this can lie for an actuator."""
        return 1.0 / _MOST_FACTOR, _MOST_FACTOR

    def start(self, parameters: ActuatorParameters) -> float:
        """Where a fit begins."""
        return 1.0

    @property
    def values(self) -> tuple[str, ...]:
        """Dotted names of what is multiplied."""
        return tuple(f"{self.part}.{name}" for name in self.names)

    def change(self, parameters: ActuatorParameters, factor: float) -> ActuatorParameters:
        """The actuator with these values multiplied."""
        own = getattr(parameters, self.part)
        scaled = {name: factor * getattr(own, name) for name in self.names}
        changed: Any = {self.part: dataclasses.replace(own, **scaled)}
        return dataclasses.replace(parameters, **changed)


_MOST_FACTOR = 200.0
_BOTH_RESISTANCES = ("winding_to_housing", "housing_to_ambient")
_COULOMB, _VISCOUS = ("motor_coulomb", "output_coulomb"), ("motor_viscous", "output_viscous")
_HARMONICS = ("error_cosine", "error_sine", "stiffness_cosine", "stiffness_sine")
UNKNOWNS: Mapping[str, Unknown] = MappingProxyType(
    {
        name: Unknown(part, names, told_by)
        for name, part, names, told_by in (
            ("thermal_resistance", "thermal", _BOTH_RESISTANCES, "continuous_torque"),
            ("friction_level", "friction", _COULOMB, "backdrive_static"),
            ("friction_viscous", "friction", _VISCOUS, "backdrive_dynamic"),
            ("friction_load", "friction", ("load_forward", "load_backward"), "efficiency_peak"),
            ("current_loop", "drive", ("current_bandwidth",), "torque_bandwidth"),
            ("tolerance_scale", "gear", _HARMONICS, "torque_ripple"),
        )
    }
)
"""What can be fitted. The scale of the tolerances is that of one drawn gearbox's error and
stiffness over angle, to which both are proportional to first order."""

TELLS: Mapping[str, str] = MappingProxyType(
    {unknown.told_by: name for name, unknown in UNKNOWNS.items()}
)
"""Measurement to the unknown it decides."""


def refuse_unknown(name: str) -> None:
    """Raise a `UsageError` where a name is none of `UNKNOWNS`."""
    if name not in UNKNOWNS:
        raise UsageError(
            f"'{name}' is no unknown{did_you_mean(name, UNKNOWNS) or '.'} "
            f"There are {', '.join(UNKNOWNS)}."
        )


@dataclass(frozen=True)
class Fit(Mapping[str, float]):
    """Factors of unknowns, and the measurements that they were fitted to."""

    factors: Mapping[str, float]
    rows: tuple[str, ...]

    def __getitem__(self, name: str) -> float:
        """The factor of an unknown."""
        return self.factors[name]

    def __iter__(self) -> Iterator[str]:
        """Names of the unknowns."""
        return iter(self.factors)

    def __len__(self) -> int:
        """How many there are."""
        return len(self.factors)


def apply_factors(
    parameters: ActuatorParameters, factors: Mapping[str, float]
) -> ActuatorParameters:
    """The actuator with unknowns multiplied, marked as calibrated in its origins.

    It counts as fitted to the rows of a `Fit`, and to those that tell the unknowns where there are
    factors alone.

    Raises
    ------
    UsageError
        For an unknown that does not exist, or a factor that is not above zero.
    """
    found = parameters
    origins = dict(parameters.origins)
    for name, factor in factors.items():
        refuse_unknown(name)
        if not (math.isfinite(factor) and factor > 0.0):
            raise UsageError(f"the factor {factor:g} of {name} must be above 0; 1 leaves it alone.")
        found = UNKNOWNS[name].change(found, factor)
        for value in UNKNOWNS[name].values:
            origins[value] = f"calibrated: {name} times {factor:.4g}"
    told = (UNKNOWNS[name].told_by for name in factors)
    rows = factors.rows if isinstance(factors, Fit) else told
    fitted = tuple(dict.fromkeys((*parameters.fitted, *rows)))
    return dataclasses.replace(found, origins=origins, fitted=fitted)
