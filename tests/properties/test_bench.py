"""The virtual bench against closed forms of the very actuator it measures."""

from __future__ import annotations

import dataclasses
import json
import math
import re
from pathlib import Path

import numpy as np
import pytest

from cqdd_design.actuator.bench import METRICS, run_bench
from cqdd_design.actuator.bench.bandwidth import crossing, saturation_limits, sensor
from cqdd_design.actuator.bench.gear import order_spectrum
from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.joint_side import joint_side
from cqdd_design.actuator.motor import torque_constant_at
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.actuator.specimen import Specimen
from cqdd_design.design import load_design
from cqdd_design.errors import UsageError
from cqdd_design.machine import resolve
from cqdd_design.report.actuator.bench_figures import bench_figures

PAPER = Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml"
RPM = 30.0 / math.pi


@pytest.fixture(scope="module")
def actuator() -> ActuatorParameters:
    """The paper's gearbox with a motor that turns freely, and friction as without any motor."""
    machine = resolve(load_design(PAPER))
    free = dataclasses.replace(
        machine.motor, coulomb=None, viscous=None, cogging_amplitude=None, cogging_order=1
    )
    return actuator_parameters(resolve(load_design(PAPER), free))


@pytest.mark.parametrize("air", [-20.0, 60.0])
def test_the_inertia_is_the_same_in_any_air(actuator: ActuatorParameters, air: float) -> None:
    """By the magnets' constant at 25 degC it was 4 % more in warm air, and less in cold."""
    there = changed(actuator, thermal={"ambient": air})
    (found,) = run_bench(there, only=("actuator_inertia",)).metrics
    assert found.value == pytest.approx(found.details["from_solids_kgm2"], rel=0.005)


@pytest.mark.parametrize("air", [-20.0, 60.0])
def test_peak_torque_and_card_count_the_same_magnets(
    actuator: ActuatorParameters, air: float
) -> None:
    there = changed(actuator, thermal={"ambient": air})
    found = {
        one.name: one for one in run_bench(there, only=("peak_torque", "stall_torque")).metrics
    }
    assert found["peak_torque"].value == pytest.approx(joint_side(there).peak_torque)
    assert found["stall_torque"].value < found["peak_torque"].value
    warm = float(torque_constant_at(there.motor, air)) / there.motor.torque_constant
    driver = there.torque_limit * warm
    assert found["peak_torque"].details["driver_limited_Nm"] == pytest.approx(driver)


def test_an_output_that_winds_up_a_motor_which_sticks_is_no_steady_point() -> None:
    """Turned from the output against friction, a printed gearbox was told to bear 8900 N m."""
    printed = resolve(load_design(PAPER.with_name("printed-13.toml")))
    (found,) = run_bench(actuator_parameters(printed), only=("efficiency_peak",)).metrics
    torque = found.trace["torque [N m]"]
    assert len(torque) > 80
    assert np.abs(torque).max() < 250.0


def changed(actuator: ActuatorParameters, **parts: dict[str, float]) -> ActuatorParameters:
    """The actuator with fields of its parts replaced: ``friction={"load_forward": 0.0}``."""
    new = {
        part: dataclasses.replace(getattr(actuator, part), **fields)
        for part, fields in parts.items()
    }
    return dataclasses.replace(actuator, **new)


def smooth(actuator: ActuatorParameters) -> ActuatorParameters:
    """The same without friction, backlash and kinematic error."""
    gear = actuator.gear
    zero = np.zeros_like(gear.error_cosine)
    free = dataclasses.replace(
        gear,
        error_cosine=zero,
        error_sine=zero,
        stiffness_cosine=zero,
        stiffness_sine=zero,
        stiffening=1.0,
        backlash=0.0,
    )
    none = dict.fromkeys(
        (
            "motor_coulomb",
            "output_coulomb",
            "motor_viscous",
            "output_viscous",
            "stribeck_extra",
            "load_forward",
            "load_backward",
        ),
        0.0,
    )
    found = changed(actuator, friction=none)
    return dataclasses.replace(found, gear=free)


def measured(actuator: ActuatorParameters, name: str, **options: object):  # type: ignore[no-untyped-def]
    (metric,) = run_bench(actuator, only=[name], **options).metrics  # type: ignore[arg-type]
    assert metric.name == name
    return metric


def test_resolution_is_a_count_through_the_ratio(actuator: ActuatorParameters) -> None:
    assert measured(actuator, "output_resolution").value == pytest.approx(360.0 / 2**14 / 10.0)
    coarse = changed(actuator, drive={"encoder_bits": 10})
    assert measured(coarse, "output_resolution").value == pytest.approx(360.0 / 2**10 / 10.0)


@pytest.mark.parametrize("voltage", [12.0, 24.0, 36.0])
def test_no_load_speed_is_that_of_the_circuit_and_the_drag(
    actuator: ActuatorParameters, voltage: float
) -> None:
    actuator = changed(actuator, motor={"coulomb": 0.1, "viscous": 8e-4, "hysteresis": 0.02})
    motor, friction, n = actuator.motor, actuator.friction, abs(actuator.gear.ratio)
    drag = friction.motor_coulomb + friction.output_coulomb / n + 0.12
    viscous = friction.motor_viscous + friction.output_viscous / n**2 + 8e-4
    speed = (motor.torque_constant * voltage / motor.resistance - drag) / (
        motor.torque_constant**2 / motor.resistance + viscous
    )
    found = measured(actuator, "no_load_speed", voltage=voltage).value
    assert found == pytest.approx(speed / n * RPM, rel=5e-3)


def test_inertia_is_that_of_the_parameters(actuator: ActuatorParameters) -> None:
    computed = actuator.motor_side_inertia + actuator.gear.output_inertia / actuator.gear.ratio**2
    assert measured(actuator, "actuator_inertia").value == pytest.approx(computed, rel=0.01)
    heavier = changed(actuator, motor={"rotor_inertia": 3.0 * actuator.motor.rotor_inertia})
    more = (
        measured(heavier, "actuator_inertia").value - measured(actuator, "actuator_inertia").value
    )
    assert more == pytest.approx(2.0 * actuator.motor.rotor_inertia, rel=0.02)


@pytest.mark.parametrize("arcmin", [2.0, 7.0, 15.0])
def test_gebler_finds_the_dead_zone(actuator: ActuatorParameters, arcmin: float) -> None:
    loose = changed(actuator, gear={"backlash": math.radians(arcmin / 60.0)})
    found = measured(loose, "backlash")
    assert found.value == pytest.approx(arcmin, abs=0.2 + 0.02 * arcmin)
    # It says how large the clearances of the design are, which nobody measured.
    assert found.relation == "given"


def test_breakaway_is_the_friction_seen_from_the_output(actuator: ActuatorParameters) -> None:
    plain = changed(smooth(actuator), friction={"motor_coulomb": 0.05, "output_coulomb": 0.2})
    found = measured(plain, "backdrive_static")
    assert found.value == pytest.approx(0.05 * 10.0 + 0.2, rel=0.03)
    extra = changed(plain, friction={"stribeck_extra": 0.5})
    assert measured(extra, "backdrive_static").value == pytest.approx(1.5 * 0.7, rel=0.03)


def test_running_torque_is_the_drag_seen_from_the_output(actuator: ActuatorParameters) -> None:
    plain = changed(
        smooth(actuator),
        friction={"motor_coulomb": 0.05, "output_coulomb": 0.2, "motor_viscous": 1e-3},
    )
    # At 1 rad/s of the output the motor turns at 10.
    wanted = (0.05 + 1e-3 * 10.0) * 10.0 + 0.2
    assert measured(plain, "backdrive_dynamic").value == pytest.approx(wanted, rel=0.01)


def test_stall_torque_without_losses_is_the_peak(actuator: ActuatorParameters) -> None:
    found = measured(smooth(actuator), "peak_torque")
    ideal = actuator.motor.torque_constant * actuator.drive.current_limit * 10.0
    assert found.value == pytest.approx(ideal)
    assert found.relation == "given"
    stall = measured(smooth(actuator), "stall_torque")
    assert stall.value == pytest.approx(ideal, rel=2e-3)
    density = measured(smooth(actuator), "torque_density").value
    assert density == pytest.approx(found.value / actuator.mass)


def test_friction_under_load_holds_back_the_stall_torque(actuator: ActuatorParameters) -> None:
    only = changed(smooth(actuator), friction={"load_forward": 0.25, "load_backward": 0.25})
    ideal = actuator.motor.torque_constant * actuator.drive.current_limit * 10.0
    assert measured(only, "stall_torque").value == pytest.approx(ideal / 1.25, rel=0.01)


def test_weak_motor_limits_the_peak(actuator: ActuatorParameters) -> None:
    weak = changed(actuator, motor={"peak_torque": 5.0})
    assert measured(weak, "peak_torque").value == pytest.approx(50.0)
    assert measured(weak, "stall_torque").value < 50.0


@pytest.mark.parametrize(("bandwidth", "rig"), [(15.0, None), (1000.0, None), (1000.0, 4e3)])
def test_torque_bandwidth_is_that_of_the_linear_machine(
    actuator: ActuatorParameters, bandwidth: float, rig: float | None
) -> None:
    """Current loop, motor on the gearbox's spring, output on the sensor's, in closed form."""
    linear = changed(
        smooth(actuator),
        drive={"current_bandwidth": bandwidth, "delay": 0.0, "control_rate": 20e3},
        gear={"damping": 20.0},
    )
    found = measured(linear, "torque_bandwidth", rig_stiffness=rig)
    held = sensor(linear, rig)
    assert rig is None or held.sensor_stiffness == rig
    s = 2j * math.pi * np.linspace(0.5, 150.0, 30_000)
    gear, n = linear.gear, linear.gear.ratio
    spring = gear.stiffness + gear.damping * s
    rest = gear.output_inertia * s**2 + held.sensor_stiffness + held.sensor_damping * s
    series = spring * rest / (spring + rest)
    at_sensor = series / (series + n**2 * linear.motor_side_inertia * s**2)
    at_sensor *= (held.sensor_stiffness + held.sensor_damping * s) / rest
    gain = np.abs(at_sensor / (1.0 + s / (2.0 * math.pi * bandwidth)))
    frequency = s.imag / (2.0 * math.pi)
    low = float(np.interp(np.geomspace(1.0, 4.0, 25), frequency, gain).mean())
    assert found.value == pytest.approx(crossing(frequency, gain / low, 10.0**-0.15), rel=0.01)
    assert found.details["low_frequency_gain"] == pytest.approx(low, abs=0.003)
    assert found.trace["coherence"].min() > 0.9


def test_a_bandwidth_beyond_coherence_is_none(actuator: ActuatorParameters) -> None:
    """Play and drag: from near the resonance on the torque is more than the chirp makes of it."""
    rough = changed(actuator, friction={"motor_coulomb": 0.02}, gear={"backlash": 2e-3})
    result = run_bench(rough, only=["torque_bandwidth"])
    found = result.metrics[0]
    details = found.details
    assert details["coherence_falls_below_0.8_Hz"] < details["gain_falls_by_3_dB_Hz"]
    assert math.isnan(found.value)
    assert found.known is result.value("torque_bandwidth") is None
    assert result.to_dict()["metrics"]["torque_bandwidth"]["value"] is None  # type: ignore[index]
    assert result.warnings == (f"torque bandwidth: {found.missing}.",)
    assert "coherence" in found.missing


def test_a_motor_that_friction_holds_has_no_torque_bandwidth(actuator: ActuatorParameters) -> None:
    """At ratio 26 the drag of a large motor is more than the chirp: nothing over nothing."""
    stiff = changed(actuator, friction={"motor_coulomb": 0.6})
    result = run_bench(stiff, only=["torque_bandwidth"])
    (found,) = result.metrics
    assert math.isnan(found.value)
    assert found.missing == (
        "friction holds motor and gearbox: of a chirp of 5 N*m no torque reaches the output"
    )
    assert bench_figures(stiff, result, 10) == ()
    assert all(math.isfinite(value) for value in found.details.values())
    # A little less of it, and there is something to read, or a reason of its own.
    (loose,) = run_bench(
        changed(actuator, friction={"motor_coulomb": 0.3}), only=["torque_bandwidth"]
    ).metrics
    assert loose.details["low_frequency_gain"] > 0.0


@pytest.mark.parametrize(
    "name",
    [
        pytest.param("position_bandwidth_45deg", marks=pytest.mark.deep),
        "position_bandwidth_5deg",
    ],
)
def test_position_bandwidth_stays_below_what_saturation_allows(
    actuator: ActuatorParameters, name: str
) -> None:
    quick = changed(actuator, drive={"position_gain": 4000.0, "velocity_gain": 60.0})
    found = measured(quick, name)
    limits = (found.details["limit_by_speed_Hz"], found.details["limit_by_torque_Hz"])
    assert found.value <= 1.05 * min(limits)
    assert found.relation == "not comparable"
    assert "60 N*m*s/rad at 24 V" in found.protocol


def test_a_joint_that_friction_holds_has_no_position_bandwidth() -> None:
    """Its gain of nothing over nothing was told as the last frequency, and drawn."""
    soft = changed(actuator_parameters(resolve(load_design(PAPER))), drive={"position_gain": 10.0})
    result = run_bench(soft, only=["position_bandwidth_5deg"])
    (found,) = result.metrics
    assert math.isnan(found.value)
    assert "friction holds the output: of 5 deg asked at 0.5 Hz it follows 0 deg" in found.missing
    assert found.missing.endswith("raise drive.position_gain")
    assert bench_figures(soft, result, 10) == ()


def test_efficiency_without_friction_is_the_motors(actuator: ActuatorParameters) -> None:
    found = measured(smooth(actuator), "efficiency_peak")
    speed = found.details["speed_rpm"] / RPM * 10.0
    motor = actuator.motor
    current = found.details["torque_Nm"] / 10.0 / motor.torque_constant
    emf = motor.torque_constant * speed
    assert found.value == pytest.approx(emf / (emf + motor.resistance * current), rel=0.01)


@pytest.mark.parametrize("voltage", [12.0, 24.0])
def test_efficiency_is_that_on_its_voltage_and_beside_no_better_point(
    actuator: ActuatorParameters, voltage: float
) -> None:
    """Of a DC machine with a constant drag: 1/(1 + drag/T)(1 - R T/(K V)), its best in closed form.

    On a supply V the winding drives T at speed with K w = V - R T/K; the drag takes its part of T.
    """
    drag = 0.1
    dry = changed(smooth(actuator), friction={"motor_coulomb": drag, "load_forward": 0.0})
    found = measured(dry, "efficiency_peak", voltage=voltage)
    motor = dry.motor
    torque = np.linspace(drag, 10.0, 20_000)
    emf = np.minimum(voltage - motor.resistance * torque / motor.torque_constant, 0.95 * voltage)
    drawn = emf + motor.resistance * torque / motor.torque_constant
    best = ((1.0 - drag / torque) * emf / drawn).max()
    assert found.details["voltage_V"] == voltage
    assert found.value == pytest.approx(best, abs=0.004)
    assert found.value < best + 1e-3
    assert found.details["speed_rpm"] * 10.0 / RPM * motor.torque_constant <= 0.951 * voltage


def test_no_efficiency_where_friction_holds_what_the_supply_drives() -> None:
    machine = resolve(load_design(PAPER))
    found = measured(actuator_parameters(machine), "efficiency_peak", voltage=0.1)
    assert found.known is None
    assert not found.trace
    assert re.search(r"on 0\.1 V friction holds .* raise the voltage", found.missing)
    assert measured(actuator_parameters(machine), "efficiency_peak", voltage=5.0).known


def test_a_best_efficiency_on_the_edge_is_said(actuator: ActuatorParameters) -> None:
    """Without any friction the best is at the greatest speed and the least current."""
    found = measured(smooth(actuator), "efficiency_peak")
    assert "the greatest speed" in found.remark
    assert "the least current" in found.remark
    heavy = changed(smooth(actuator), friction={"motor_viscous": 5e-3, "load_forward": 0.0})
    assert "edge" not in measured(heavy, "efficiency_peak").remark


def test_backlash_of_drawn_gearboxes_is_their_mean(actuator: ActuatorParameters) -> None:
    drawn = [
        changed(actuator, gear={"backlash": math.radians(arcmin / 60.0)})
        for arcmin in (1.0, 2.0, 6.0)
    ]
    found = measured(actuator, "backlash", drawn=drawn)
    assert found.value == pytest.approx(3.0, abs=0.2)
    assert found.spread == pytest.approx(np.std([1.0, 2.0, 6.0], ddof=1), rel=0.05)
    assert found.details["perfect_parts_arcmin"] == pytest.approx(
        measured(actuator, "backlash").value
    )
    assert "3 gearboxes drawn from the tolerances" in found.protocol


def test_order_spectrum_finds_what_is_there() -> None:
    angle = np.linspace(0.0, 2.0 * math.pi, 20_001)
    torque = 3.0 + 0.4 * np.cos(110 * angle + 0.3) + 0.1 * np.sin(10 * angle)
    orders, amplitudes = order_spectrum(angle, torque)
    assert amplitudes[orders == 110][0] == pytest.approx(0.4, rel=0.03)
    assert amplitudes[orders == 10][0] == pytest.approx(0.1, rel=0.03)
    assert np.sort(amplitudes)[-3] < 0.01


def test_crossing_is_between_the_points() -> None:
    assert crossing(np.array([1.0, 2.0, 3.0]), np.array([1.0, 0.8, 0.4]), 0.6) == pytest.approx(2.5)
    assert crossing(np.array([1.0, 2.0]), np.array([1.0, 0.9]), 0.5) == 2.0


def test_winding_ends_at_its_limit_under_the_continuous_current(
    actuator: ActuatorParameters,
) -> None:
    trace = measured(actuator, "continuous_torque").trace
    assert trace["winding [deg C]"][0] == pytest.approx(actuator.thermal.ambient)
    assert np.all(np.diff(trace["winding [deg C]"]) > -1e-9)
    assert trace["winding [deg C]"][-1] == pytest.approx(actuator.thermal.most, abs=0.5)
    limited = changed(actuator, drive={"current_limit": 5.0})
    cool = measured(limited, "continuous_torque")
    assert cool.details["current_A"] == 5.0
    assert cool.trace["winding [deg C]"][-1] < 0.5 * actuator.thermal.most


def test_every_measurement_of_the_papers_actuator(actuator: ActuatorParameters) -> None:
    told: list[str] = []
    result = run_bench(actuator, rated_current=20.0, beside_paper=True, progress=told.append)
    assert [metric.name for metric in result.metrics] == list(METRICS)
    assert len(told) == len(METRICS)
    document = json.loads(json.dumps(result.to_dict(), allow_nan=False))
    for name, unit in METRICS.items():
        row = document["metrics"][name]
        assert row["unit"] == unit
        assert row["protocol"].endswith(".")
        assert row["paper"] > 0.0
    without = {metric.name for metric in result.metrics if not metric.trace}
    # Identities, sums, and what other rows' traces show.
    assert without == {
        "peak_torque", "rated_power", "output_resolution", "torque_density", "mass"
    }  # fmt: skip
    assert run_bench(actuator, only=["mass"]).to_dict()["metrics"]["mass"]["paper"] is None  # type: ignore[index]


def test_bad_requests(actuator: ActuatorParameters) -> None:
    with pytest.raises(UsageError, match="did you mean 'backlash'"):
        run_bench(actuator, only=["backlsh"])
    with pytest.raises(UsageError, match=r"no measurement is selected; .* torque_ripple"):
        run_bench(actuator, only=())
    with pytest.raises(UsageError, match="above 0"):
        run_bench(actuator, voltage=0.0)
    with pytest.raises(UsageError, match="--rig-stiffness -1"):
        run_bench(actuator, only=["torque_bandwidth"], rig_stiffness=-1.0)


def test_peak_efficiency_falls_with_friction_under_load(actuator: ActuatorParameters) -> None:
    free = changed(smooth(actuator), friction={"load_forward": 0.0})
    rubbing = changed(smooth(actuator), friction={"load_forward": 0.25, "load_backward": 0.25})
    share = measured(rubbing, "efficiency_peak").value / measured(free, "efficiency_peak").value
    assert share == pytest.approx(1.0 / 1.25, rel=0.01)


def test_generating_is_the_inverse_and_kept_apart(actuator: ActuatorParameters) -> None:
    rubbing = changed(smooth(actuator), friction={"load_forward": 0.2, "load_backward": 0.2})
    found = measured(rubbing, "efficiency_peak")
    torque, speed = found.trace["torque [N m]"], found.trace["speed [rpm]"]
    efficiency = found.trace["efficiency"]
    assert np.all((efficiency >= 0.0) & (efficiency < 1.0))
    assert np.all(speed > 0.0)
    # The supply drives the greatest currents against the greatest speeds no more.
    assert (torque < 0.0).sum() >= (torque > 0.0).sum() > 0
    # Turned from outside, the gearbox passes on 1 - mu, and the winding takes its part.
    best = found.details["generating_peak"]
    assert 0.7 < best < 0.8
    # At the lowest speed and the greatest current the winding eats all that comes in.
    assert efficiency[(torque < 0.0) & (speed < 1.01 * speed.min())].min() == 0.0


def test_ripple_of_drawn_gearboxes_is_their_mean(actuator: ActuatorParameters) -> None:
    design = load_design(PAPER)
    drawn = [actuator_parameters(resolve(design), Specimen(seed=seed)) for seed in (0, 1)]
    each = [measured(one, "torque_ripple").value for one in drawn]
    found = measured(actuator, "torque_ripple", drawn=drawn)
    assert found.value == pytest.approx(np.mean(each))
    assert found.details["perfect_parts_Nm"] == pytest.approx(
        measured(actuator, "torque_ripple").value
    )
    assert found.value > 3.0 * found.details["perfect_parts_Nm"]


def test_ripple_is_not_said_to_be_at_a_torque_that_the_driver_cannot_give(
    actuator: ActuatorParameters,
) -> None:
    assert "A in the motor for about 40 N*m" in measured(actuator, "torque_ripple").protocol
    drive = dataclasses.replace(actuator.drive, current_limit=10.0)
    weak = measured(dataclasses.replace(actuator, drive=drive), "torque_ripple").protocol
    assert "10 A in the motor, the most its driver gives and too little for 40 N*m:" in weak


def test_saturation_limits_of_the_paper() -> None:
    """4.9 Hz at 45 degrees by speed, 30.6 Hz at 5 degrees by torque, from the paper's own rows."""
    speed, torque, inertia = 128.6 / RPM, 89.9, 5.01e-2
    assert saturation_limits(speed, torque, inertia, math.radians(45.0))[0] == pytest.approx(
        4.9, abs=0.05
    )
    assert saturation_limits(speed, torque, inertia, math.radians(5.0))[1] == pytest.approx(
        30.6, abs=0.05
    )


def test_a_motor_without_drag_data_is_told(actuator: ActuatorParameters) -> None:
    """Where a measurement hangs on it, and only there."""
    assert actuator.origins["motor.coulomb"] == "assumed: 0, the catalogue gives none"
    (told,) = run_bench(actuator, only=["backdrive_dynamic", "mass"]).warnings
    assert "0 is assumed: backdrive torque, running is that" in told
    assert run_bench(actuator, only=["mass"]).warnings == ()
    known = changed(actuator, motor={"viscous": 1e-4})
    assert run_bench(known, only=["backdrive_dynamic"]).warnings == ()
