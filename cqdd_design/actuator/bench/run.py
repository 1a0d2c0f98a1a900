"""The whole bench in one call."""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Callable, Collection, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

from cqdd_design.actuator.bench import bandwidth, gear, steady
from cqdd_design.actuator.bench.metric import BenchResult, Metric, refuse_unselected
from cqdd_design.actuator.fitted_under import AT_VOLTAGE, FittedUnder
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.catalog import paper
from cqdd_design.errors import UsageError
from cqdd_design.terms import measurement

if TYPE_CHECKING:
    from cqdd_design.machine.carrying import CarriedTorque

VOLTAGE = paper.SUPPLY_VOLTAGE
"""Of the dynamic rows, V: what the paper measured at."""

_HOLDS = "the output does not turn the motor at any torque; the gearbox holds itself"
_ABSENT: Mapping[str, str] = MappingProxyType(
    {
        "rated_power": "the motor's catalogue gives no rated current",
        "backdrive_static": _HOLDS,
        "backdrive_dynamic": _HOLDS,
    }
)
"""Why a measurement may be missing."""

_OF_DRAG = ("no_load_speed", "efficiency_peak", "backdrive_static", "backdrive_dynamic")
"""Measurements that the motor's own drag is a large part of."""

Progress = Callable[[str], None]


def run_bench(
    parameters: ActuatorParameters,
    *,
    rated_current: float | None = None,
    voltage: float = VOLTAGE,
    only: Collection[str] | None = None,
    beside_paper: bool = False,
    drawn: Collection[ActuatorParameters] = (),
    gearbox: CarriedTorque | None = None,
    rig_stiffness: float | None = None,
    progress: Progress | None = None,
) -> BenchResult:
    """Measure an actuator.

    Parameters
    ----------
    rated_current : float, optional
        Of the motor by its catalogue, A.
    voltage : float
        Supply of the no-load speed, of the efficiency and of the position bandwidths, V.
    only : collection of str
        Names of `METRICS`; default all.
    beside_paper : bool
        Whether the paper's values stand beside.
    drawn : collection of ActuatorParameters
        The same actuator with gearboxes drawn from the tolerances with seeds 0 and up, whose mean
        backlash and ripple are its own; default those of the actuator itself.
    gearbox : CarriedTorque, optional
        What is asked of the gearbox and what it carries, told beside the torques.
    rig_stiffness : float, optional
        Of what holds the output while the torque bandwidth is measured, N m/rad; default that of a
        torque sensor rated for the driver's limit.
    progress : callable, optional
        Told the name of each measurement before it begins.

    Raises
    ------
    UsageError
        For an unknown name, no name at all, or a voltage or stiffness that is not above zero.
    """
    refuse_unselected(only)
    if not voltage > 0.0:
        raise UsageError(f"--voltage {voltage:g} V must be above 0; the paper's is {VOLTAGE:g} V.")
    if rig_stiffness is not None and not 0.0 < rig_stiffness < math.inf:
        raise UsageError(f"--rig-stiffness {rig_stiffness:g} N*m/rad must be above 0.")
    began = time.perf_counter()
    required = math.inf if gearbox is None else gearbox.required
    measures: dict[str, Callable[[], Metric | None]] = {
        "continuous_torque": lambda: steady.continuous_torque(parameters),
        "peak_torque": lambda: steady.peak_torque(parameters, gearbox),
        "stall_torque": lambda: steady.stall_torque(parameters, gearbox),
        "no_load_speed": lambda: steady.no_load_speed(parameters, voltage),
        "rated_power": lambda: steady.rated_power(parameters, rated_current),
        "output_resolution": lambda: steady.output_resolution(parameters),
        "efficiency_peak": lambda: steady.efficiency_peak(parameters, voltage),
        "torque_density": lambda: steady.torque_density(
            parameters, steady.peak_torque(parameters).value, required
        ),
        "actuator_inertia": lambda: steady.actuator_inertia(parameters),
        "mass": lambda: steady.mass(parameters),
        "backlash": lambda: gear.backlash(parameters, drawn),
        "backdrive_static": lambda: gear.backdrive_static(parameters),
        "backdrive_dynamic": lambda: gear.backdrive_dynamic(parameters),
        "torque_ripple": lambda: gear.torque_ripple(parameters, drawn),
        "torque_bandwidth": lambda: bandwidth.torque_bandwidth(
            parameters, rig_stiffness=rig_stiffness
        ),
        "position_bandwidth_45deg": lambda: bandwidth.position_bandwidth(parameters, 45.0, voltage),
        "position_bandwidth_5deg": lambda: bandwidth.position_bandwidth(parameters, 5.0, voltage),
    }
    here = FittedUnder(voltage, parameters.thermal.ambient, rig_stiffness, parameters.seed)
    found, warnings = [], []
    for name, measure in measures.items():
        if only is not None and name not in only:
            continue
        if progress is not None:
            progress(measurement(name))
        metric = measure()
        if metric is None:
            warnings.append(f"{measurement(name)}: {_ABSENT[name]}.")
        else:
            related = _related(metric, parameters, here)
            found.append(_beside(related, voltage) if beside_paper else related)
            if metric.missing:
                warnings.append(f"{measurement(name)}: {metric.missing}.")
    hanging = [measurement(metric.name) for metric in found if metric.name in _OF_DRAG]
    if hanging and not (parameters.motor.dry_drag or parameters.motor.drag_slope):
        warnings.append(
            f"nothing is known of the motor's own drag, and 0 is assumed: {'; '.join(hanging)} "
            f"{'is that' if len(hanging) == 1 else 'are those'} of a motor that turns freely. "
            "Measure it, and give coulomb and viscous in a motor file."
        )
    return BenchResult(
        name=parameters.name,
        metrics=tuple(found),
        beside_paper=beside_paper,
        voltage=voltage,
        seconds=time.perf_counter() - began,
        warnings=tuple(warnings),
        required=required,
    )


def _related(metric: Metric, parameters: ActuatorParameters, here: FittedUnder) -> Metric:
    """A measurement that something was fitted to, called so; not where that was elsewise."""
    if metric.name not in parameters.fitted:
        return metric
    under = parameters.fitted_under
    other = "" if under is None else under.differs(metric.name, here)
    if not other:
        return dataclasses.replace(metric, relation="calibrated")
    remark = f"{metric.remark}; {other}" if metric.remark else other
    return dataclasses.replace(metric, relation="not comparable", remark=remark)


def _beside(metric: Metric, voltage: float) -> Metric:
    """A measurement beside the paper's, which were made at its own supply."""
    if metric.name not in AT_VOLTAGE or voltage == VOLTAGE:
        return metric
    other = f"the paper measured at {VOLTAGE:g} V"
    remark = f"{metric.remark}; {other}" if metric.remark else other
    return dataclasses.replace(metric, relation="not comparable", remark=remark)
