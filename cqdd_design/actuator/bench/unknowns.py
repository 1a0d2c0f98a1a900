"""What no drawing tells of an actuator, the measurement that decides it, and factors on it."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.errors import UsageError, did_you_mean

Change = Callable[[ActuatorParameters, float], ActuatorParameters]


def _friction(*names: str) -> Change:
    def change(parameters: ActuatorParameters, factor: float) -> ActuatorParameters:
        own = parameters.friction
        scaled = {name: factor * getattr(own, name) for name in names}
        return dataclasses.replace(parameters, friction=dataclasses.replace(own, **scaled))

    return change


def _thermal(parameters: ActuatorParameters, factor: float) -> ActuatorParameters:
    own = parameters.thermal
    scaled = dataclasses.replace(
        own,
        winding_to_housing=factor * own.winding_to_housing,
        housing_to_ambient=factor * own.housing_to_ambient,
    )
    return dataclasses.replace(parameters, thermal=scaled)


def _current_loop(parameters: ActuatorParameters, factor: float) -> ActuatorParameters:
    own = parameters.drive
    slower = dataclasses.replace(own, current_bandwidth=factor * own.current_bandwidth)
    return dataclasses.replace(parameters, drive=slower)


def _tolerances(parameters: ActuatorParameters, factor: float) -> ActuatorParameters:
    own = parameters.gear
    names = ("error_cosine", "error_sine", "stiffness_cosine", "stiffness_sine")
    scaled = {name: factor * getattr(own, name) for name in names}
    return dataclasses.replace(parameters, gear=dataclasses.replace(own, **scaled))


@dataclass(frozen=True)
class Unknown:
    """Something that no drawing tells.

    Attributes
    ----------
    values : tuple of str
        Dotted names of the values that one factor multiplies.
    told_by : str
        The measurement that decides it.
    change : callable
        Parameters and factor to parameters.
    """

    values: tuple[str, ...]
    told_by: str
    change: Change


UNKNOWNS: Mapping[str, Unknown] = MappingProxyType(
    {
        "thermal_resistance": Unknown(
            ("thermal.winding_to_housing", "thermal.housing_to_ambient"),
            "continuous_torque",
            _thermal,
        ),
        "friction_level": Unknown(
            ("friction.motor_coulomb", "friction.output_coulomb"),
            "backdrive_static",
            _friction("motor_coulomb", "output_coulomb"),
        ),
        "friction_viscous": Unknown(
            ("friction.motor_viscous", "friction.output_viscous"),
            "backdrive_dynamic",
            _friction("motor_viscous", "output_viscous"),
        ),
        "friction_load": Unknown(
            ("friction.load_forward", "friction.load_backward"),
            "efficiency_peak",
            _friction("load_forward", "load_backward"),
        ),
        "current_loop": Unknown(("drive.current_bandwidth",), "torque_bandwidth", _current_loop),
        "tolerance_scale": Unknown(
            (
                "gear.error_cosine",
                "gear.error_sine",
                "gear.stiffness_cosine",
                "gear.stiffness_sine",
            ),
            "torque_ripple",
            _tolerances,
        ),
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
