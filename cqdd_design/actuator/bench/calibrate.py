"""Fit what is not known of an actuator to some of its measured rows; the rest is predicted."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.actuator.bench.fitting import fit
from cqdd_design.actuator.bench.metric import BenchResult, is_near, refuse_unmeasured
from cqdd_design.actuator.bench.run import VOLTAGE, run_bench
from cqdd_design.actuator.bench.unknowns import (
    RIG,
    TELLS,
    UNKNOWNS,
    Fit,
    apply_factors,
    refuse_unknown,
    told_unknown,
)
from cqdd_design.actuator.fitted_under import FittedUnder
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.errors import UsageError, did_you_mean

if TYPE_CHECKING:
    from cqdd_design.machine.carrying import CarriedTorque

_NEAR_END = 0.01
"""Of a range: nearer to an end an unknown was stopped there."""


@dataclass(frozen=True)
class Row:
    """One measurement before and after a calibration, beside its measured value.

    Attributes
    ----------
    measured : float or None
        None where it was not measured.
    before, after : float or None
        None where the bench cannot measure it.
    relation : str
        As of :class:`.Metric`.
    """

    name: str
    unit: str
    measured: float | None
    before: float | None
    after: float | None
    relation: str

    @property
    def off(self) -> float | None:
        """After over measured, less one."""
        if self.measured is None or self.after is None:
            return None
        return self.after / self.measured - 1.0

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
            if row.measured is not None
            and row.after is not None
            and is_near(row.unit, row.after, row.measured)
        )

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form (``results`` of ``calibrate``)."""
        under = self.factors.under
        return {
            "measured_under": None if under is None else under.to_dict(),
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
    rig_stiffness: float | None = None,
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
    rig_stiffness : float, optional
        As for `run_bench`, N m/rad.
    progress : callable, optional
        Told what begins.

    Raises
    ------
    UsageError
        For rows that decide nothing, values not above zero, fewer rows than unknowns, or what
        `fitting.fit` refuses.
    """
    rows, names = chosen(measured, to, unknowns, rig_known=rig_stiffness is not None)
    if "tolerance_scale" in names and not np.any(parameters.gear.error_cosine):
        raise UsageError(
            "perfect parts have no kinematic error to scale; draw a gearbox with --seed, or leave "
            "torque_ripple to prediction."
        )
    tell = progress or (lambda text: None)
    tell(f"fitting {', '.join(names)}")
    targets = {name: measured[name] for name in rows}
    under = FittedUnder(voltage, parameters.thermal.ambient, rig_stiffness, parameters.seed)
    factors = Fit(fit(parameters, targets, names, voltage, rig_stiffness), rows, under)
    final = apply_factors(parameters, factors)
    tell("measuring before")
    before = run_bench(
        parameters,
        rated_current=rated_current,
        voltage=voltage,
        drawn=drawn,
        gearbox=gearbox,
        rig_stiffness=rig_stiffness,
    )
    tell("measuring after")
    after = run_bench(
        final,
        rated_current=rated_current,
        voltage=voltage,
        drawn=[apply_factors(one, factors) for one in drawn],
        gearbox=gearbox,
        rig_stiffness=rig_stiffness,
    )
    old = {metric.name: metric.known for metric in before.metrics}
    return Calibration(
        parameters=final,
        factors=factors,
        rows=tuple(
            Row(
                metric.name,
                metric.unit,
                measured.get(metric.name),
                old.get(metric.name),
                metric.known,
                metric.relation,
            )
            for metric in after.metrics
        ),
        after=after,
        ranges={name: UNKNOWNS[name].bounds(parameters) for name in names},
    )


def chosen(
    measured: Mapping[str, float],
    to: Collection[str] = (),
    unknowns: Collection[str] = (),
    *,
    rig_known: bool = False,
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Rows to fit to and unknowns to fit; what `calibrate` refuses of them is refused here."""
    for name, value in measured.items():
        refuse_unmeasured(name)
        if not (math.isfinite(value) and value > 0.0):
            raise UsageError(f"{name} {value:g} must be above 0 to calibrate with.")
    for name in to:
        refuse_unmeasured(name)
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
    rows = tuple(dict.fromkeys(to)) or tuple(name for name in measured if name in TELLS)
    names = tuple(dict.fromkeys(unknowns)) or tuple(
        told_unknown(name, rig_known=rig_known) for name in rows
    )
    if rig_known and RIG in names:
        raise UsageError(
            f"{RIG} is given (--rig-stiffness) and cannot be fitted; leave out one of the two."
        )
    if not rows:
        raise UsageError(f"nothing to calibrate with; give rows among {', '.join(TELLS)}.")
    if len(rows) < len(names):
        raise UsageError(
            f"{len(rows)} measured rows cannot decide {len(names)} unknowns; give more rows, or "
            "fewer unknowns."
        )
    return rows, names
