"""What a bench measurement says: value, spread, protocol, trace, and how it compares."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal

from cqdd_design.actuator.parameters import FloatArray
from cqdd_design.catalog import paper
from cqdd_design.errors import UsageError, did_you_mean
from cqdd_design.results import read_only

Relation = Literal["given", "calibrated", "predicted", "not comparable"]

METRICS: Mapping[str, str] = MappingProxyType(
    {
        "continuous_torque": "N*m",
        "peak_torque": "N*m",
        "stall_torque": "N*m",
        "no_load_speed": "rpm",
        "rated_power": "W",
        "output_resolution": "deg",
        "efficiency_peak": "",
        "torque_density": "N*m/kg",
        "actuator_inertia": "kg*m^2",
        "mass": "kg",
        "backlash": "arcmin",
        "backdrive_static": "N*m",
        "backdrive_dynamic": "N*m",
        "torque_ripple": "N*m",
        "torque_bandwidth": "Hz",
        "position_bandwidth_45deg": "Hz",
        "position_bandwidth_5deg": "Hz",
    }
)
"""Names of all measurements and their units."""


def refuse_unmeasured(name: str, place: str = "") -> None:
    """Raise a `UsageError` where a name, read at a place, is none of `METRICS`."""
    if name not in METRICS:
        raise UsageError(
            f"{place}'{name}' is not a measurement{did_you_mean(name, METRICS) or '.'} "
            f"The bench knows {', '.join(METRICS)}."
        )


def refuse_unselected(names: Collection[str] | None) -> None:
    """Raise a `UsageError` for a selection without names, or with one that is not measured.

    None selects all; a list that came out empty would otherwise measure all as well.
    """
    if names is not None and not names:
        raise UsageError(
            "no measurement is selected; leave the selection out for all, or name some of "
            f"{', '.join(METRICS)}."
        )
    for name in names or ():
        refuse_unmeasured(name)


@dataclass(frozen=True, eq=False)
class Metric:
    """One measurement.

    Attributes
    ----------
    name : str
        Of `METRICS`.
    value : float
        In the unit of `METRICS`.
    spread : float or None
        Standard deviation over positions or repetitions; None for a single figure.
    relation : {"given", "calibrated", "predicted", "not comparable"}
        How an agreement with a measured value would have to be read: an input, an identity or what
        follows from clearances that the design assumes; a fit; a prediction; or something measured
        under other conditions.
    protocol : str
        A sentence.
    details : mapping of str to float
        Other figures of the same run, each with its unit in its name.
    trace : mapping of str to array
        Columns, each with its unit in its name.
    remark : str
        What the value counts, or what stands against it: for whoever reads the value alone.
    missing : str
        Why there is no value, which then is not a number; else empty.
    """

    name: str
    value: float
    relation: Relation
    protocol: str
    spread: float | None = None
    details: Mapping[str, float] = field(default_factory=dict)
    trace: Mapping[str, FloatArray] = field(default_factory=dict)
    remark: str = ""
    missing: str = ""

    def __post_init__(self) -> None:
        """Let nobody change a trace that is written and drawn."""
        seen = {name: read_only(values) for name, values in self.trace.items()}
        object.__setattr__(self, "trace", seen)

    @property
    def known(self) -> float | None:
        """The value; None where there is none."""
        return self.value if math.isfinite(self.value) else None

    @property
    def unit(self) -> str:
        """Unit of value and spread."""
        return METRICS[self.name]


@dataclass(frozen=True, eq=False)
class BenchResult:
    """Measurements of one actuator.

    Attributes
    ----------
    name : str
        Of the actuator.
    beside_paper : bool
        Whether it is the paper's own, so that the paper's values stand beside.
    voltage : float
        Of the dynamic rows, V.
    seconds : float
        Time taken.
    required : float
        Peak torque that is asked of the gearbox, N m; infinite where nothing is known of it.
    """

    name: str
    metrics: tuple[Metric, ...]
    beside_paper: bool
    voltage: float
    seconds: float
    warnings: tuple[str, ...] = ()
    required: float = math.inf

    def value(self, name: str) -> float | None:
        """Value of a measurement; None where it was not made, or could not be."""
        return next((metric.known for metric in self.metrics if metric.name == name), None)

    @property
    def counted_peak(self) -> float | None:
        """Peak torque for a torque density: no more than is asked of the gearbox, N m."""
        peak = self.value("peak_torque")
        return None if peak is None else min(peak, self.required)

    def paper(self, name: str) -> float | None:
        """The paper's value of a measurement, beside the paper's own actuator only."""
        return paper.METRICS[name].value if self.beside_paper and name in paper.METRICS else None

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form (``results`` of ``bench``)."""
        return {
            "voltage_V": self.voltage,
            "seconds": self.seconds,
            "metrics": {
                metric.name: {
                    "value": metric.known,
                    "spread": metric.spread,
                    "unit": metric.unit,
                    "paper": self.paper(metric.name),
                    "relation": metric.relation,
                    "protocol": metric.protocol,
                    **({"remark": metric.remark} if metric.remark else {}),
                    **({"missing": metric.missing} if metric.missing else {}),
                    **({"details": dict(metric.details)} if metric.details else {}),
                }
                for metric in self.metrics
            },
        }


NEAR = 0.2
"""Predictions within this share of the measured value count as near."""
NEAR_EFFICIENCY = 0.05
"""The same for efficiencies, as a difference."""


def is_near(unit: str, value: float, measured: float) -> bool:
    """Whether a value of one of the units of `METRICS` is near the measured one."""
    if unit == "":
        return abs(value - measured) <= NEAR_EFFICIENCY
    return abs(value / measured - 1.0) <= NEAR
