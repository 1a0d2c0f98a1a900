"""What no drawing tells of an actuator, the measurement that decides it, and its range."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from cqdd_design.actuator.fitted_under import FittedUnder
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.errors import UsageError, did_you_mean


@dataclass(frozen=True)
class Unknown:
    """Something that no drawing tells: a factor on what was computed, or a value of the motor.

    Attributes
    ----------
    part : str
        Of the actuator's parameters.
    names : tuple of str
        Values of that part that one factor multiplies, or the one value that is meant.
    told_by : str
        The measurement that decides it; empty where none does alone: a no-load speed tells the
        motor's constant sooner than its drag.
    least, most : float
        Range of a factor. That of a value is these shares of its scale, see `bounds`.
    unit : str
        Of a value, SI; empty for a factor.
    begin : float or None
        Where a fit begins, as `least` and `most`; None for what was computed.
    """

    part: str
    names: tuple[str, ...]
    told_by: str
    least: float
    most: float
    unit: str = ""
    begin: float | None = None

    @property
    def values(self) -> tuple[str, ...]:
        """Dotted names of what is multiplied or set."""
        return tuple(f"{self.part}.{name}" for name in self.names)

    def bounds(self, parameters: ActuatorParameters) -> tuple[float, float]:
        """Range in which this can lie for an actuator.

        Drag and cogging of a motor are shares of its rated torque, over speed at the speed that
        its supply drives; a rig's stiffness of that of a torque sensor. Friction under load stays
        below what holds the gearbox by itself.
        """
        least, most = self.least, self.most
        if self.unit:
            scale = self._scale(parameters)
            return least * scale, most * scale
        if "load_backward" in self.names:
            friction = parameters.friction
            share = friction.load_backward * (1.0 + friction.load_growth)
            holding = share * (1.0 + friction.stribeck_extra)
            most = max(min(most, _HELD / holding if holding > 0.0 else most), 2.0 * least)
        return least, most

    def _scale(self, parameters: ActuatorParameters) -> float:
        """Of the range of a value."""
        if self.unit == _OVER_ANGLE:
            return parameters.sensor_stiffness
        scale = _torque_scale(parameters)
        if self.unit == _OVER_SPEED:
            scale *= parameters.motor.torque_constant / parameters.drive.supply_voltage
        return scale

    def start(self, parameters: ActuatorParameters) -> float:
        """Where a fit begins: as computed, or within the range where that is outside."""
        if self.begin is not None:
            return self.begin * self._scale(parameters)
        least, most = self.bounds(parameters)
        own = float(getattr(getattr(parameters, self.part), self.names[0])) if self.unit else 1.0
        inside = least * _MARGIN <= own <= most / _MARGIN
        return own if inside else math.sqrt(least * most)

    def change(self, parameters: ActuatorParameters, value: float) -> ActuatorParameters:
        """The actuator with these values multiplied, or with the one that is meant."""
        own = getattr(parameters, self.part)
        given = {name: value * (1.0 if self.unit else getattr(own, name)) for name in self.names}
        changed: Any = {self.part: dataclasses.replace(own, **given)}
        return dataclasses.replace(parameters, **changed)

    def told(self, value: float) -> str:
        """A factor or a value in words."""
        return f"{value:.4g} {self.unit}" if self.unit else f"times {value:.4g}"


def _torque_scale(parameters: ActuatorParameters) -> float:
    """Rated torque of the motor, or what stands for it, N m."""
    motor = parameters.motor
    if math.isfinite(motor.rated_torque):
        return motor.rated_torque
    return motor.torque_constant * parameters.peak_current / 3.0


_OVER_SPEED, _OVER_ANGLE = "N*m*s/rad", "N*m/rad"
RIG = "rig_stiffness"
_HELD = 0.9
"""Of the friction under load that would hold any torque."""
_MARGIN = 1.05
_BOTH_RESISTANCES = ("winding_to_housing", "housing_to_ambient")
_HARMONICS = ("error_cosine", "error_sine", "stiffness_cosine", "stiffness_sine")
_LOAD = ("load_forward", "load_backward")
UNKNOWNS: Mapping[str, Unknown] = MappingProxyType(
    {
        "thermal_resistance": Unknown("thermal", _BOTH_RESISTANCES, "continuous_torque", 0.1, 10.0),
        "motor_cogging": Unknown(
            "motor", ("cogging_amplitude",), "backdrive_static", 5e-5, 0.05, "N*m"
        ),
        "motor_coulomb": Unknown("motor", ("coulomb",), "backdrive_dynamic", 1e-4, 0.1, "N*m"),
        "motor_viscous": Unknown("motor", ("viscous",), "", 1e-4, 0.2, _OVER_SPEED),
        "friction_load": Unknown("friction", _LOAD, "efficiency_peak", 0.1, 3.0),
        "current_loop": Unknown("drive", ("current_bandwidth",), "torque_bandwidth", 0.01, 100.0),
        # After the current loop: where nothing is said of a rig, that is what a bandwidth tells.
        # On a soft one it can be read; on a stiff one coherence ends first, and with it the search.
        RIG: Unknown(
            "rig", ("stiffness",), "torque_bandwidth", 0.005, 10.0, _OVER_ANGLE, begin=0.05
        ),
        "tolerance_scale": Unknown("gear", _HARMONICS, "torque_ripple", 0.05, 20.0),
    }
)
"""What can be fitted, and within which range. Motors of a kind drag with a hundredth to a tenth of
their rated torque and cog with less; greased steel rubs at 0.02 to 0.2. The scale of the tolerances
is that of one drawn gearbox's error and stiffness over angle, to which both are proportional to
first order. Rigs yield as a torque sensor does, a tenth of it at most, or up to two hundred times
as much, as brackets and couplings of printed and turned parts do."""

TELLS: Mapping[str, str] = MappingProxyType(
    {unknown.told_by: name for name, unknown in UNKNOWNS.items() if unknown.told_by}
)
"""Measurement to the unknown it decides."""


def told_unknown(row: str, *, rig_known: bool) -> str:
    """The unknown that a measurement decides: of a bandwidth on a known rig, the current loop."""
    return "current_loop" if rig_known and TELLS[row] == RIG else TELLS[row]


def refuse_unknown(name: str) -> None:
    """Raise a `UsageError` where a name is none of `UNKNOWNS`."""
    if name not in UNKNOWNS:
        raise UsageError(
            f"'{name}' is no unknown{did_you_mean(name, UNKNOWNS) or '.'} "
            f"There are {', '.join(UNKNOWNS)}."
        )


@dataclass(frozen=True)
class Fit(Mapping[str, float]):
    """Factors or values of unknowns, the measurements that they were fitted to, and under what."""

    factors: Mapping[str, float]
    rows: tuple[str, ...]
    under: FittedUnder | None = None

    def fitted_to(self, other: str) -> Fit:
        """The same, of another design in words: its rows are not those of the one at hand."""
        under = self.under
        return (
            self if under is None else dataclasses.replace(self, under=under._replace(other=other))
        )

    def __getitem__(self, name: str) -> float:
        """The factor or value of an unknown."""
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
    """The actuator with unknowns multiplied or set, marked as calibrated in its origins.

    It counts as fitted to the rows of a `Fit`, and to those that tell the unknowns where there are
    factors alone.

    Raises
    ------
    UsageError
        For an unknown that does not exist, or a factor or value that is not above zero.
    """
    found = parameters
    origins = dict(parameters.origins)
    for name, factor in factors.items():
        refuse_unknown(name)
        if not (math.isfinite(factor) and factor > 0.0):
            fix = (
                "its unit is " + UNKNOWNS[name].unit if UNKNOWNS[name].unit else "1 is as computed"
            )
            raise UsageError(f"{name} {factor:g} must be finite and above 0; {fix}.")
        found = UNKNOWNS[name].change(found, factor)
        for value in UNKNOWNS[name].values:
            origins[value] = f"calibrated: {name} {UNKNOWNS[name].told(factor)}"
    told = [UNKNOWNS[name].told_by for name in factors if UNKNOWNS[name].told_by]
    rows = factors.rows if isinstance(factors, Fit) else told
    fitted = tuple(dict.fromkeys((*parameters.fitted, *rows)))
    under = factors.under if isinstance(factors, Fit) else parameters.fitted_under
    return dataclasses.replace(found, origins=origins, fitted=fitted, fitted_under=under)
