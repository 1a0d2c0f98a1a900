"""Fit what is not known of an actuator to some of its measured rows; the rest is predicted."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from cqdd_design.actuator.bench.run import VOLTAGE, run_bench
from cqdd_design.actuator.parameters import ActuatorParameters, FloatArray
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


@dataclass(frozen=True)
class Unknown:
    """What a measured row tells.

    Attributes
    ----------
    names : tuple of str
        Dotted names of the values that one factor multiplies.
    change : callable
        Parameters and factor to parameters.
    """

    names: tuple[str, ...]
    change: Change


UNKNOWNS: Mapping[str, Unknown] = MappingProxyType(
    {
        "continuous_torque": Unknown(
            ("thermal.winding_to_housing", "thermal.housing_to_ambient"), _thermal
        ),
        "backdrive_static": Unknown(
            ("friction.motor_coulomb", "friction.output_coulomb"),
            _friction("motor_coulomb", "output_coulomb"),
        ),
        "backdrive_dynamic": Unknown(
            ("friction.motor_viscous", "friction.output_viscous"),
            _friction("motor_viscous", "output_viscous"),
        ),
        "efficiency_peak": Unknown(
            ("friction.load_forward", "friction.load_backward"),
            _friction("load_forward", "load_backward"),
        ),
        "torque_bandwidth": Unknown(("drive.current_bandwidth",), _current_loop),
    }
)
"""Rows that can be fitted, and what each of them decides."""


@dataclass(frozen=True, eq=False)
class Calibration:
    """A fit.

    Attributes
    ----------
    parameters : ActuatorParameters
        With the fitted values, marked so in their origins.
    factors : mapping of str to float
        By how much each unknown was multiplied, by the row that told.
    measured, fitted : mapping of str to float
        The rows as given, and as the fitted actuator gives them.
    """

    parameters: ActuatorParameters
    factors: Mapping[str, float]
    measured: Mapping[str, float]
    fitted: Mapping[str, float]

    @property
    def largest_residual(self) -> float:
        """Of a fitted row over its measured value."""
        return max(abs(self.fitted[name] / value - 1.0) for name, value in self.measured.items())

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form."""
        return {
            "rows": {
                name: {
                    "measured": value,
                    "fitted": self.fitted[name],
                    "unknowns": list(UNKNOWNS[name].names),
                    "factor": self.factors[name],
                }
                for name, value in self.measured.items()
            },
            "largest_residual": self.largest_residual,
        }


def calibrate(
    parameters: ActuatorParameters, measured: Mapping[str, float], *, voltage: float = VOLTAGE
) -> Calibration:
    """Fit one unknown to each measured row.

    Parameters
    ----------
    parameters : ActuatorParameters
    measured : mapping of str to float
        Rows of `UNKNOWNS` in the units of the bench.
    voltage : float
        Supply of the dynamic rows, V.

    Raises
    ------
    UsageError
        For a row that decides no unknown, or a value that is not above zero.
    """
    from scipy.optimize import least_squares

    if not measured:
        raise UsageError(f"nothing to calibrate with; name rows among {', '.join(UNKNOWNS)}.")
    for name, value in measured.items():
        if name not in UNKNOWNS:
            raise UsageError(
                f"'{name}' decides no unknown{did_you_mean(name, UNKNOWNS) or '.'} "
                f"Calibrate with {', '.join(UNKNOWNS)}."
            )
        if not (math.isfinite(value) and value > 0.0):
            raise UsageError(f"{name} {value:g} must be above 0 to calibrate with.")
    names = tuple(measured)
    targets = np.array([measured[name] for name in names])

    def changed(logarithms: FloatArray) -> ActuatorParameters:
        found = parameters
        for name, logarithm in zip(names, logarithms, strict=True):
            found = UNKNOWNS[name].change(found, math.exp(logarithm))
        return found

    def rows(logarithms: FloatArray) -> FloatArray:
        result = run_bench(changed(logarithms), only=names, voltage=voltage)
        values = {metric.name: metric.value for metric in result.metrics}
        return np.array([values[name] for name in names])

    def misses(logarithms: FloatArray) -> FloatArray:
        return np.asarray(np.log(np.maximum(rows(logarithms), 1e-12) / targets))

    reach = math.log(200.0)
    start = np.zeros(len(names))
    # Simulated rows are smooth to a part in a thousand only, so differences take longer steps.
    fit = least_squares(
        misses, start, bounds=(-reach, reach), diff_step=0.02, x_scale=1.0, xtol=1e-5, max_nfev=60
    )
    fitted = changed(fit.x)
    origins = dict(fitted.origins)
    for name in names:
        for unknown in UNKNOWNS[name].names:
            origins[unknown] = f"calibrated: to {name} {measured[name]:g}"
    final = dataclasses.replace(fitted, origins=origins)
    return Calibration(
        parameters=final,
        factors={name: math.exp(x) for name, x in zip(names, fit.x, strict=True)},
        measured=dict(measured),
        fitted=dict(zip(names, rows(fit.x).tolist(), strict=True)),
    )
