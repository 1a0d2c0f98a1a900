"""Rows of a data sheet that are steady: torques, speed, efficiency, inertia."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cqdd_design.actuator.bench.metric import Metric
from cqdd_design.actuator.density import density_torque, torques_of_drive
from cqdd_design.actuator.motor import torque_constant_at
from cqdd_design.actuator.packing import safe_step
from cqdd_design.actuator.parameters import ActuatorParameters, FloatArray
from cqdd_design.actuator.scenario import Command, Constant, Load, Sampled, Scenario, Start
from cqdd_design.actuator.simulate import Simulation, simulate
from cqdd_design.actuator.thermal import continuous_current, response

if TYPE_CHECKING:
    from cqdd_design.machine.carrying import CarriedTorque

RPM = 30.0 / math.pi
_PLACES = 13
"""Of a motor turn, for the held output: prime, or cogging would be met in one phase at all."""
_HIGHEST_SPEED = 0.95
"""Of an efficiency's grid, over the speed whose back-EMF is the supply."""
_FINER = 4
"""Steps of the finer grid in one of the grid."""


def with_voltage(parameters: ActuatorParameters, voltage: float) -> ActuatorParameters:
    """The same actuator at another supply."""
    drive = dataclasses.replace(parameters.drive, supply_voltage=voltage)
    return dataclasses.replace(parameters, drive=drive)


def cold(parameters: ActuatorParameters) -> ActuatorParameters:
    """The same actuator, so large a heat capacity in it that nothing warms during a test."""
    thermal = dataclasses.replace(parameters.thermal, winding_capacity=1e9, housing_capacity=1e9)
    return dataclasses.replace(parameters, thermal=thermal)


def run_cold(
    parameters: ActuatorParameters,
    scenes: Scenario | Sequence[Scenario],
    duration: float,
    spacing: float = 0.0,
) -> Simulation:
    """Simulate scenes at their safe step, nothing warming, with records about `spacing` s apart."""
    step = safe_step(parameters, *([scenes] if isinstance(scenes, Scenario) else scenes))
    every = max(1, round(spacing / step))
    return simulate(cold(parameters), scenes, duration, step, every=every)


def output_resolution(parameters: ActuatorParameters) -> Metric:
    """One count of the motor's encoder at the output."""
    counts = 2.0**parameters.drive.encoder_bits * abs(parameters.gear.ratio)
    return Metric(
        "output_resolution",
        360.0 / counts,
        "given",
        "One count of the encoder on the motor's shaft, through the ratio.",
    )


def rated_power(parameters: ActuatorParameters, rated_current: float | None) -> Metric | None:
    """Supply voltage times the motor's rated current; None where the catalogue gives none."""
    if rated_current is None:
        return None
    return Metric(
        "rated_power",
        parameters.drive.supply_voltage * rated_current,
        "given",
        "Supply voltage times the rated current of the motor's catalogue.",
    )


def _locked_torque(
    parameters: ActuatorParameters, current: float
) -> tuple[FloatArray, dict[str, FloatArray]]:
    """Torque of the locked output at a steady current, at even places of one motor turn, N m.

    The current rises slowly, as on a bench, and friction holds back what it can. The trace of the
    first place goes with it.
    """
    turn = 2.0 * math.pi / abs(parameters.gear.ratio)
    rise, hold = 0.3, 0.3
    slowly = Sampled(np.array([0.0, rise]), np.array([0.0, current]))
    scenes = [
        Scenario(
            Command("current", slowly),
            Load.driven(Constant(0.0)),
            Start(output_angle=turn * place / _PLACES),
        )
        for place in range(_PLACES)
    ]
    run = run_cold(parameters, scenes, rise + hold, 5e-4)
    settled = run.output_torque[:, run.time > rise + 0.5 * hold]
    trace = _columns(run, "current", "output_torque")
    return np.asarray(np.abs(settled.mean(axis=1))), trace


def peak_torque(parameters: ActuatorParameters, gearbox: CarriedTorque | None = None) -> Metric:
    """Torque constant times current times ratio, at the driver's limit or the motor's peak."""
    details = torques_of_drive(
        parameters.motor,
        parameters.drive,
        abs(parameters.gear.ratio),
        parameters.thermal.ambient,
    )
    peak = min(details.values())
    return Metric(
        "peak_torque",
        peak,
        "given",
        "Torque constant times the driver's current limit times the ratio, or the motor's peak "
        "torque by its catalogue times the ratio, whichever is less; losses left out, so that a "
        "measured peak is compared with stall_torque. Magnets at "
        f"{parameters.thermal.ambient:g} degC.",
        details=details | _first_limit(gearbox),
        remark="" if gearbox is None else gearbox.told(peak),
    )


def _first_limit(gearbox: CarriedTorque | None) -> dict[str, float]:
    if gearbox is None or not gearbox.limits:
        return {}
    return {"gearbox_limited_Nm": gearbox.limits[0].torque}


def stall_torque(parameters: ActuatorParameters, gearbox: CarriedTorque | None = None) -> Metric:
    """Locked output, current ramped to the driver's limit, or to the motor's peak torque."""
    limit = parameters.peak_current
    torques, trace = _locked_torque(parameters, limit)
    return Metric(
        "stall_torque",
        float(torques.mean()),
        "predicted",
        f"Output held still, current ramped to {limit:.3g} A in 0.3 s and held, at {_PLACES} "
        "places of a motor turn: what friction leaves of the peak torque while it rises.",
        spread=float(torques.std(ddof=1)),
        details={"current_A": limit} | _first_limit(gearbox),
        trace=trace,
        remark="" if gearbox is None else gearbox.told(float(torques.mean())),
    )


def continuous_torque(parameters: ActuatorParameters) -> Metric:
    """Locked output at the current that the thermal network carries for ever."""
    thermal = parameters.thermal
    current = min(continuous_current(parameters.motor, thermal), parameters.drive.current_limit)
    hot = float(
        torque_constant_at(parameters.motor, thermal.most) / parameters.motor.torque_constant
    )
    torques = hot * _locked_torque(parameters, current)[0]
    slowest = (thermal.winding_to_housing + thermal.housing_to_ambient) * (
        thermal.winding_capacity + thermal.housing_capacity
    )
    times = np.linspace(0.0, 10.0 * slowest, 501)
    warming = response(parameters.motor, thermal, current, times)
    return Metric(
        "continuous_torque",
        float(torques.mean()),
        "predicted",
        "Output held still at the current whose heat the two-node network carries off at the "
        f"winding's limit of {thermal.most:g} degC in {thermal.ambient:g} degC, magnets as warm; "
        "what other parts stand is not in it, MOTOR-CONTINUOUS counts them while it turns.",
        spread=float(torques.std(ddof=1)),
        details={"current_A": current},
        trace={
            "time [s]": times,
            "winding [deg C]": warming[:, 0],
            "housing [deg C]": warming[:, 1],
        },
    )


def no_load_speed(parameters: ActuatorParameters, voltage: float) -> Metric:
    """Free output at a steady voltage, mean over whole turns of the output."""
    scene = Scenario(Command("voltage", Constant(voltage)), Load.free())
    run = run_cold(with_voltage(parameters, voltage), scene, 4.0, 5e-4)
    speed = np.abs(run.output_speed[0])
    late = run.time > 2.0
    return Metric(
        "no_load_speed",
        float(speed[late].mean()) * RPM,
        "predicted",
        f"Output free, {voltage:g} V on the motor, mean speed from 2 s to 4 s.",
        spread=float(speed[late].std()) * RPM,
        details={"current_A": float(run.current[0][late].mean())},
        trace=_columns(run, "output_speed", "current"),
    )


def _columns(run: Simulation, *names: str, index: int = 0) -> dict[str, FloatArray]:
    every = run.columns(index)
    return {key: value for key, value in every.items() if key.split(" ")[0] in ("time", *names)}


class _Powers(NamedTuple):
    """Steady points (P,): output speed, rad/s, torque, N m, and efficiency, 0 where it is none.

    `reached` where the supply drives the current that was asked for, and the motor goes along.
    """

    speed: FloatArray
    torque: FloatArray
    efficiency: FloatArray
    driving: NDArray[np.bool_]
    reached: NDArray[np.bool_]

    @property
    def best(self) -> int:
        """The most efficient point of those at which the motor drives."""
        return int(np.where(self.driving, self.efficiency, 0.0).argmax())


def _powers(parameters: ActuatorParameters, speed: FloatArray, current: FloatArray) -> _Powers:
    """Run the output at steady speeds (P,), rad/s, with currents (P,), A."""
    ratio = parameters.gear.ratio
    scenes = []
    for at, through in zip(speed, current, strict=True):
        # A positive current turns the motor forwards, and the output by the ratio's sign.
        turning = math.copysign(float(at), ratio)
        scenes.append(
            Scenario(
                Command("current", Constant(float(through))),
                Load.driven(Constant(turning)),
                Start(output_speed=turning, current=float(through)),
            )
        )
    run = run_cold(parameters, scenes, 0.6, 2e-4)
    late = run.time > 0.2
    electrical = (run.voltage * run.current)[:, late].mean(axis=1)
    mechanical = (run.output_torque * run.output_speed)[:, late].mean(axis=1)
    # A motor that sticks while its output is turned winds the gearbox up: no steady point.
    turning, wanted = run.motor_speed[:, late].mean(axis=1), abs(ratio) * speed
    along = np.abs(turning - wanted) < 0.02 * wanted
    driving = (electrical > 0.0) & (mechanical > 0.0) & along
    generating = (electrical < 0.0) & (mechanical < 0.0) & along
    efficiency = np.zeros(len(scenes))
    efficiency[driving] = (mechanical / electrical)[driving]
    efficiency[generating] = (electrical / mechanical)[generating]
    driven = np.abs(run.current[:, late].mean(axis=1) - current) < 0.02 * np.abs(current)
    return _Powers(speed, mechanical / speed, efficiency, driving, driven & along)


def efficiency_peak(
    parameters: ActuatorParameters, voltage: float | None = None, points: int = 8
) -> Metric:
    """Steady grid of speed and torque, driving and generating; the peak is of driving.

    Around the best point of the grid a finer one is asked, down to no current at all where the best
    lies there; beyond the greatest speed and current nothing is, and a best point at them is said
    to lie on the edge. Where friction holds all of the grid there is no value.

    Parameters
    ----------
    voltage : float, optional
        Supply, V; default the actuator's own.
    """
    motor, ratio = parameters.motor, parameters.gear.ratio
    supply = parameters.drive.supply_voltage if voltage is None else voltage
    supplied = with_voltage(parameters, supply)
    # At the speed of the voltage itself no current can be driven.
    top = _HIGHEST_SPEED * supply / motor.torque_constant / abs(ratio)
    rated = motor.rated_torque if math.isfinite(motor.rated_torque) else 0.3 * motor.peak_torque
    most = 2.0 * rated / motor.torque_constant if math.isfinite(rated) else math.inf
    most = min(most, parameters.drive.current_limit, supply / motor.resistance)
    part = (np.arange(points) + 1.0) / points
    # A gearbox that holds itself cannot be turned from the output.
    shares = part if parameters.friction.load_backward >= 1.0 else np.r_[-part[::-1], part]
    speed, current = (grid.ravel() for grid in np.meshgrid(top * part, most * shares))
    grid = _powers(supplied, speed, current)
    protocol = (
        f"On {supply:g} V, steady grid of {points} speeds up to {top * RPM:.0f} rpm and {points} "
        f"currents up to {most:.3g} A in both senses, as far as the supply drives them, and finer "
        "around the best: mean mechanical over mean electrical power at the motor's terminals, the "
        f"inverse where it generates; winding at {parameters.thermal.ambient:g} degC."
    )
    if not grid.driving.any():
        return Metric(
            "efficiency_peak",
            math.nan,
            "predicted",
            protocol,
            missing=f"on {supply:g} V friction holds all that up to {most:.3g} A drive, so the "
            "output gets no power; raise the voltage",
        )
    best = grid.best
    finer = np.arange(1 - _FINER, _FINER) / (_FINER * points)
    near_speed = top * _within(speed[best] / top + finer)
    near_current = most * _within(current[best] / most + finer)
    near = _powers(supplied, *(one.ravel() for one in np.meshgrid(near_speed, near_current)))
    peak = near.best
    column, row = peak % len(near_speed), peak // len(near_speed)
    edges = []
    if near_speed[column] == top:
        edges.append(f"the greatest speed, {top * RPM:.3g} rpm")
    if near_current[row] == most:
        edges.append(f"the greatest current, {most:.3g} A")
    if row == 0 and near_current[0] < most / points:
        edges.append(f"the least current, {near_current[0]:.3g} A")
    details = {
        "speed_rpm": float(near.speed[peak]) * RPM,
        "torque_Nm": float(near.torque[peak]),
        "voltage_V": supply,
    }
    back = int(np.where(grid.driving, 0.0, grid.efficiency).argmax())
    if grid.efficiency[back] > 0.0 and not grid.driving[back]:
        details |= {
            "generating_peak": float(grid.efficiency[back]),
            "generating_speed_rpm": float(grid.speed[back]) * RPM,
            "generating_torque_Nm": float(grid.torque[back]),
        }
    return Metric(
        "efficiency_peak",
        float(near.efficiency[peak]),
        "predicted",
        protocol,
        details=details,
        trace={
            "speed [rpm]": grid.speed[grid.reached] * RPM,
            "torque [N m]": grid.torque[grid.reached],
            "efficiency": grid.efficiency[grid.reached],
        },
        remark=f"the best point lies on the edge of the grid: {' and '.join(edges)}"
        if edges
        else "",
    )


def _within(shares: FloatArray) -> FloatArray:
    """Shares of a grid's greatest value that lie within it, the one at its end kept."""
    kept = np.unique(np.minimum(shares, 1.0))
    return np.asarray(kept[kept > 1e-9])


def actuator_inertia(parameters: ActuatorParameters) -> Metric:
    """Spin-up of the free output at two currents: friction cancels in their difference.

    Both are read between the same two speeds, so that drag over speed cancels too.
    """
    motor = parameters.motor
    currents = (0.25, 0.5)
    scenes = [
        Scenario(Command("current", Constant(share * parameters.drive.current_limit)), Load.free())
        for share in currents
    ]
    run = run_cold(parameters, scenes, 0.06)
    slow = np.abs(run.motor_speed[0])
    between = np.interp((0.01, 0.03), run.time, slow)
    rises, mean = [], []
    for speed, current in zip(np.abs(run.motor_speed), run.current, strict=True):
        first, last = np.searchsorted(np.maximum.accumulate(speed), between)
        rises.append((speed[last] - speed[first]) / (run.time[last] - run.time[first]))
        mean.append(float(current[first:last].mean()))
    # Magnets are as warm as the air in so short a run.
    constant = float(torque_constant_at(motor, parameters.thermal.ambient))
    value = constant * (mean[1] - mean[0]) / (rises[1] - rises[0])
    computed = (
        parameters.motor_side_inertia + parameters.gear.output_inertia / parameters.gear.ratio**2
    )
    return Metric(
        "actuator_inertia",
        float(value),
        "predicted",
        "Spin-up of the free output at a quarter and at half of the current limit: difference of "
        "torques over difference of accelerations between the same speeds, at the motor.",
        details={"from_solids_kgm2": computed},
        trace=_columns(run, "motor_speed", "current", index=1),
        remark=_origins(parameters, rotor="motor.rotor_inertia", gearbox="gear.input_inertia"),
    )


def mass(parameters: ActuatorParameters) -> Metric:
    """Of all parts."""
    protocol = "Sum of all parts drawn, and the motor where it is not drawn."
    return Metric(
        "mass", parameters.mass, "predicted", protocol, remark=parameters.origins.get("mass", "")
    )


def torque_density(
    parameters: ActuatorParameters, peak: float, required: float = math.inf
) -> Metric:
    """Peak torque (N m) over mass, no more of it than is asked of the gearbox."""
    counted, scope = density_torque(peak, required)
    return Metric(
        "torque_density",
        counted / parameters.mass,
        "given",
        "Peak torque over mass: what motor and driver give, but no more than the peak torque "
        "required of the gearbox.",
        details={"torque_Nm": counted, "mass_kg": parameters.mass},
        remark=f"{scope} over {parameters.mass:.4g} kg: {parameters.origins.get('mass', '')}",
    )


def _origins(parameters: ActuatorParameters, **names: str) -> str:
    """Where some values come from, under what they are of."""
    found = parameters.origins
    return "; ".join(f"{of}: {found[name]}" for of, name in names.items() if name in found)
