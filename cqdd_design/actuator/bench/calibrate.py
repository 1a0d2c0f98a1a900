"""Fit what is not known of an actuator to some of its measured rows; the rest is predicted."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.actuator.bench.metric import BenchResult, is_near, refuse_unmeasured
from cqdd_design.actuator.bench.run import VOLTAGE, run_bench
from cqdd_design.actuator.bench.unknowns import (
    TELLS,
    UNKNOWNS,
    Fit,
    apply_factors,
    refuse_unknown,
)
from cqdd_design.actuator.parameters import ActuatorParameters, FloatArray
from cqdd_design.errors import UsageError, did_you_mean

if TYPE_CHECKING:
    from cqdd_design.machine.carrying import CarriedTorque

_NEAR_END = 0.01
"""Of a range: nearer to an end an unknown was stopped there."""
_MOST_MISS = 0.05
"""Of a fitted row, where an unknown is at an end of its range."""


@dataclass(frozen=True)
class Row:
    """One measurement before and after a calibration, beside its measured value.

    Attributes
    ----------
    measured : float or None
        None where it was not measured.
    relation : str
        As of :class:`.Metric`.
    """

    name: str
    unit: str
    measured: float | None
    before: float
    after: float
    relation: str

    @property
    def off(self) -> float | None:
        """After over measured, less one."""
        return None if self.measured is None else self.after / self.measured - 1.0

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form."""
        return {
            "unit": self.unit,
            "measured": self.measured,
            "before": self.before,
            "after": self.after,
            "off_percent": None if self.off is None else 100.0 * self.off,
            "relation": self.relation,
        }


@dataclass(frozen=True, eq=False)
class Calibration:
    """A fit, and what it predicts.

    Attributes
    ----------
    parameters : ActuatorParameters
        With the fitted values, marked so in their origins.
    factors : Fit
        By how much each unknown was multiplied, or its value.
    rows : tuple of Row
        Every measurement of the bench.
    after : BenchResult
        Of the fitted actuator.
    ranges : mapping of str to (float, float)
        In which each unknown was sought.
    """

    parameters: ActuatorParameters
    factors: Fit
    rows: tuple[Row, ...]
    after: BenchResult
    ranges: Mapping[str, tuple[float, float]]

    @property
    def at_an_end(self) -> tuple[str, ...]:
        """Unknowns that lie at an end of their range."""
        return tuple(
            name for name, value in self.factors.items() if _ends(value, self.ranges[name])
        )

    @property
    def largest_residual(self) -> float:
        """Of a calibrated row over its measured value."""
        found = [abs(row.off) for row in self.rows if row.relation == "calibrated" and row.off]
        return max(found, default=0.0)

    @property
    def predicted(self) -> tuple[Row, ...]:
        """Rows that were measured and neither fitted nor given."""
        return tuple(
            row for row in self.rows if row.relation == "predicted" and row.measured is not None
        )

    @property
    def within(self) -> tuple[Row, ...]:
        """Those of the predicted rows that are near what was measured; see `metric.is_near`."""
        return tuple(
            row
            for row in self.predicted
            if row.measured is not None and is_near(row.unit, row.after, row.measured)
        )

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form (``results`` of ``calibrate``)."""
        return {
            "unknowns": {
                name: {
                    **_stated(name, factor),
                    "range": list(self.ranges[name]),
                    "values": {
                        value: _value(self.parameters, value)
                        for value in UNKNOWNS[name].values
                        if isinstance(_value(self.parameters, value), float)
                    },
                }
                for name, factor in self.factors.items()
            },
            "rows": {row.name: row.to_dict() for row in self.rows},
            "largest_residual": self.largest_residual,
            "predicted": [row.name for row in self.predicted],
            "predicted_within_20_percent": [row.name for row in self.within],
        }


def _ends(value: float, limits: tuple[float, float]) -> bool:
    """Whether a value lies at an end of its range, by its logarithm."""
    least, most = limits
    share = math.log(value / least) / math.log(most / least)
    return not _NEAR_END < share < 1.0 - _NEAR_END


def _stated(name: str, fitted: float) -> dict[str, object]:
    """A fitted unknown in a file: a factor, or a value with its unit."""
    unit = UNKNOWNS[name].unit
    return {"value": fitted, "unit": unit} if unit else {"factor": fitted}


def _value(parameters: ActuatorParameters, dotted: str) -> object:
    part, _, name = dotted.partition(".")
    return getattr(getattr(parameters, part), name)


def calibrate(
    parameters: ActuatorParameters,
    measured: Mapping[str, float],
    *,
    to: Collection[str] = (),
    unknowns: Collection[str] = (),
    voltage: float = VOLTAGE,
    rated_current: float | None = None,
    drawn: Collection[ActuatorParameters] = (),
    gearbox: CarriedTorque | None = None,
    progress: Callable[[str], None] | None = None,
) -> Calibration:
    """Fit unknowns to some measured rows and predict the others.

    Parameters
    ----------
    measured : mapping of str to float
        Measurements of the bench in its units.
    to : collection of str
        Rows to fit to; default all measured ones that decide an unknown.
    unknowns : collection of str
        Names of `UNKNOWNS`; default those that the rows decide. With more rows than unknowns the
        fit is the best in relative squares.
    voltage : float
        Supply of the dynamic rows, V.
    rated_current : float, optional
        A, for the rated power.
    drawn : collection of ActuatorParameters
        As for `run_bench`.
    gearbox : CarriedTorque, optional
        As for `run_bench`.
    progress : callable, optional
        Told what begins.

    Raises
    ------
    UsageError
        For rows that decide nothing, values not above zero, fewer rows than unknowns, or a fit
        that does not come within reach.
    """
    for name, value in measured.items():
        refuse_unmeasured(name)
        if not (math.isfinite(value) and value > 0.0):
            raise UsageError(f"{name} {value:g} must be above 0 to calibrate with.")
    rows, names = _chosen(measured, to, unknowns)
    if "tolerance_scale" in names and not np.any(parameters.gear.error_cosine):
        raise UsageError(
            "perfect parts have no kinematic error to scale; draw a gearbox with --seed, or leave "
            "torque_ripple to prediction."
        )
    tell = progress or (lambda text: None)
    tell(f"fitting {', '.join(names)}")
    factors = Fit(_fit(parameters, {name: measured[name] for name in rows}, names, voltage), rows)
    final = apply_factors(parameters, factors)
    tell("measuring before")
    before = run_bench(
        parameters, rated_current=rated_current, voltage=voltage, drawn=drawn, gearbox=gearbox
    )
    tell("measuring after")
    after = run_bench(
        final,
        rated_current=rated_current,
        voltage=voltage,
        drawn=[apply_factors(one, factors) for one in drawn],
        gearbox=gearbox,
    )
    old = {metric.name: metric.value for metric in before.metrics}
    return Calibration(
        parameters=final,
        factors=factors,
        rows=tuple(
            Row(
                metric.name,
                metric.unit,
                measured.get(metric.name),
                old[metric.name],
                metric.value,
                metric.relation,
            )
            for metric in after.metrics
            if metric.name in old
        ),
        after=after,
        ranges={name: UNKNOWNS[name].bounds(parameters) for name in names},
    )


def _chosen(
    measured: Mapping[str, float], to: Collection[str], unknowns: Collection[str]
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Rows to fit to and unknowns to fit."""
    for name in to:
        if name not in measured:
            raise UsageError(
                f"there is no measured value of '{name}'{did_you_mean(name, measured) or '.'} "
                f"Measured are {', '.join(measured) or 'none'}."
            )
        if not unknowns and name not in TELLS:
            raise UsageError(
                f"'{name}' decides no unknown of its own; calibrate to {', '.join(TELLS)}, or name "
                "the unknowns to fit."
            )
    for name in unknowns:
        refuse_unknown(name)
    rows = tuple(to) or tuple(name for name in measured if name in TELLS)
    names = tuple(unknowns) or tuple(TELLS[name] for name in rows)
    if not rows:
        raise UsageError(f"nothing to calibrate with; give rows among {', '.join(TELLS)}.")
    if len(rows) < len(names):
        raise UsageError(
            f"{len(rows)} measured rows cannot decide {len(names)} unknowns; give more rows, or "
            "fewer unknowns."
        )
    return rows, names


def _fit(
    parameters: ActuatorParameters,
    targets: Mapping[str, float],
    names: tuple[str, ...],
    voltage: float,
) -> dict[str, float]:
    """Factors and values of the unknowns, in their ranges: least squares of the relative misses."""
    from scipy.optimize import least_squares

    wanted = np.array(list(targets.values()))
    own = [UNKNOWNS[name] for name in names]

    def changed(logarithms: FloatArray) -> ActuatorParameters:
        found = parameters
        for unknown, logarithm in zip(own, logarithms, strict=True):
            found = unknown.change(found, math.exp(logarithm))
        return found

    def misses(logarithms: FloatArray) -> FloatArray:
        result = run_bench(changed(logarithms), only=tuple(targets), voltage=voltage)
        values = {metric.name: metric.value for metric in result.metrics}
        if not targets.keys() <= values.keys():
            raise UsageError(f"cannot calibrate to what cannot be measured: {result.warnings[0]}")
        found = np.array([values[name] for name in targets])
        return np.asarray(np.log(np.maximum(found, 1e-12) / wanted))

    ranges = [unknown.bounds(parameters) for unknown in own]
    least, most = np.log(np.array(ranges)).T
    # Simulated rows are smooth to a part in a thousand only, so differences take longer steps.
    fit = least_squares(
        misses,
        np.log([unknown.start(parameters) for unknown in own]),
        bounds=(least, most),
        diff_step=0.02,
        x_scale=1.0,
        xtol=1e-5,
        max_nfev=60,
    )
    missed = float(np.max(np.abs(fit.fun))) > _MOST_MISS
    for name, value, limits in zip(names, np.exp(fit.x), ranges, strict=True):
        if missed and _ends(float(value), limits):
            unit = UNKNOWNS[name].unit or "times the computed one"
            raise UsageError(
                f"no {name} from {limits[0]:.3g} to {limits[1]:.3g} {unit} gives "
                f"{', '.join(f'{row} {value:g}' for row, value in targets.items())}; check the "
                "measured values and their units, or leave this row to prediction."
            )
    return {name: math.exp(value) for name, value in zip(names, fit.x, strict=True)}
