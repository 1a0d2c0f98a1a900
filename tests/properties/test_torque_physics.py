"""The physical estimate against its own balance, and the fitted friction against what made it."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from torque_samples import (
    COULOMB,
    DT,
    INERTIA,
    POSITION_GAIN,
    VELOCITY_GAIN,
    VISCOUS,
    actuator,
    data_set,
    episode,
)

from cqdd_design.actuator.scenario import Command, Constant, Load, Scenario, Start
from cqdd_design.actuator.simulate import simulate
from cqdd_design.errors import UsageError
from cqdd_design.torque.data.episodes import DataSet, Episode
from cqdd_design.torque.evaluation.baselines import TERMS, current_estimate, fit_friction, pd_law
from cqdd_design.torque.features.acceleration import acceleration, savitzky_golay
from cqdd_design.torque.features.matrix import feature_matrix
from cqdd_design.torque.features.physics import (
    actuator_from_dict,
    actuator_to_dict,
    dry_friction,
    friction_sign,
    gear_ripple,
    motion_balance,
    physical_estimate,
    with_gains_of,
)

SLOPE = savitzky_golay(DT)


def steady(speed: float, error: float, samples: int = 20) -> Episode:
    """A joint at constant speed behind its target by a constant angle."""
    position = speed * DT * np.arange(samples)
    columns = {
        "position": position,
        "target": position + error,
        "velocity": np.full(samples, speed),
        "torque": np.zeros(samples),
    }
    return Episode("steady", {}, DT, columns)


def recorded(one: Episode) -> DataSet:
    """An episode's data set, of a controller that can ask for anything."""
    return DataSet((one,), POSITION_GAIN, VELOCITY_GAIN, (-1e9, 1e9))


def without_friction():
    parameters = actuator()
    names = ("motor_coulomb", "output_coulomb", "motor_viscous", "output_viscous")
    loads = ("load_forward", "load_backward")
    friction = dataclasses.replace(parameters.friction, **dict.fromkeys((*names, *loads), 0.0))
    motor = dataclasses.replace(parameters.motor, iron_loss=0.0, hysteresis=0.0)
    return dataclasses.replace(parameters, friction=friction, motor=motor)


def test_without_friction_it_is_the_law_less_the_reflected_inertia():
    parameters, one = without_friction(), episode("e", 0.6, 0.3)
    law = pd_law(recorded(one), one)
    rate = acceleration(one.columns["velocity"], SLOPE)
    wanted = law - parameters.reflected_inertia * rate
    np.testing.assert_allclose(physical_estimate(parameters, one, SLOPE), wanted, rtol=1e-9)


@pytest.mark.parametrize("forward", [True, False])
def test_efficiency_has_the_direction_of_power(forward):
    bare = without_friction()
    friction = dataclasses.replace(bare.friction, load_forward=0.1, load_backward=0.12)
    parameters = dataclasses.replace(bare, friction=friction)
    parameters = dataclasses.replace(
        parameters, friction=dataclasses.replace(parameters.friction, stribeck_extra=0.0)
    )
    one = steady(1.0, 0.2 if forward else -0.2)
    asked = float(pd_law(recorded(one), one)[-1])
    found = float(physical_estimate(parameters, one, SLOPE)[-1])
    wanted = asked / 1.1 if forward else asked / (1.0 - 0.12)
    assert found == pytest.approx(wanted, rel=1e-9)


def test_friction_opposes_motion_and_the_estimate_is_odd():
    parameters = actuator()
    one = episode("e", 0.6, 0.3)
    mirrored = dataclasses.replace(one, columns={k: -v for k, v in one.columns.items()})
    found = physical_estimate(parameters, one, SLOPE)
    np.testing.assert_allclose(physical_estimate(parameters, mirrored, SLOPE), -found, rtol=1e-12)
    free = physical_estimate(without_friction(), steady(1.0, 0.2), SLOPE)[-1]
    assert physical_estimate(parameters, steady(1.0, 0.2), SLOPE)[-1] < free
    back = physical_estimate(without_friction(), steady(-1.0, 0.2), SLOPE)[-1]
    assert physical_estimate(parameters, steady(-1.0, 0.2), SLOPE)[-1] > back


def test_current_and_voltage_bind():
    parameters = without_friction()
    ratio, motor, drive = 10.0, parameters.motor, parameters.drive
    stalled = physical_estimate(parameters, steady(0.0, 50.0), SLOPE)[-1]
    assert stalled == pytest.approx(drive.current_limit * motor.torque_constant * ratio)
    fast = 25.0
    left = drive.supply_voltage - motor.torque_constant * ratio * fast
    found = physical_estimate(parameters, steady(fast, 50.0), SLOPE)[-1]
    assert found == pytest.approx(left / motor.resistance * motor.torque_constant * ratio)


def test_the_balance_is_the_estimate_without_dry_friction():
    parameters, one = actuator(), episode("e", 0.6, 0.3)
    dry = ("motor_coulomb", "output_coulomb", "load_forward", "load_backward")
    friction = dataclasses.replace(parameters.friction, **dict.fromkeys(dry, 0.0))
    motor = dataclasses.replace(parameters.motor, hysteresis=0.0)
    wanted = physical_estimate(
        dataclasses.replace(parameters, friction=friction, motor=motor), one, SLOPE
    )
    np.testing.assert_allclose(motion_balance(parameters, one, SLOPE), wanted, rtol=1e-9)


def test_the_sign_of_friction_is_smooth_odd_and_of_the_motors_stribeck_speed():
    parameters = actuator()
    slow = 0.25 * parameters.friction.stribeck_speed / 10.0
    found = friction_sign(parameters, np.array([-1.0, -slow, 0.0, slow, 1.0]))
    np.testing.assert_allclose(found, [-1.0, -np.tanh(1.0), 0.0, np.tanh(1.0), 1.0], atol=1e-12)


@pytest.mark.parametrize("ratio", [-10.0, 10.0])
@pytest.mark.parametrize("torque", [30.0, -12.0])
def test_the_ripple_is_that_of_the_simulated_gearbox(ratio, torque):
    """Slowly turned against a constant current: what comes out varies by the gearbox alone."""
    bare = without_friction()
    gear = dataclasses.replace(bare.gear, ratio=ratio)
    friction = dataclasses.replace(bare.friction, stribeck_extra=0.0)
    parameters = dataclasses.replace(bare, gear=gear, friction=friction)
    current = torque / (ratio * parameters.motor.torque_constant)
    speed, seconds = 0.2, 5.0
    scene = Scenario(
        Command("current", Constant(current)),
        Load.driven(Constant(speed)),
        Start(output_speed=speed),
    )
    run = simulate(parameters, scene, seconds, 2e-5, every=50)
    late = run.time > 2.0
    position = run.motor_angle[0][late] / ratio
    # The motor heats up and loses a little of its magnets' strength.
    carried = ratio * parameters.motor.torque_constant * run.current[0][late]
    slow = np.polyval(np.polyfit(position, run.output_torque[0][late] - carried, 1), position)
    wanted = run.output_torque[0][late] - carried - slow
    found = gear_ripple(parameters, position, np.full(len(position), torque))
    found = found - np.polyval(np.polyfit(position, found, 1), position)
    assert np.std(wanted) > 1e-3 * abs(torque)
    assert np.std(found - wanted) < 0.02 * np.std(wanted)


def test_gains_become_those_of_the_data_and_numbers_survive_json():
    data = dataclasses.replace(data_set(2), position_gain=33.0)
    assert with_gains_of(actuator(), data).drive.position_gain == 33.0
    one = episode("e", 0.6, 0.3)
    back = actuator_from_dict(actuator_to_dict(actuator()))
    np.testing.assert_array_equal(
        physical_estimate(back, one, SLOPE), physical_estimate(actuator(), one, SLOPE)
    )
    broken = actuator_to_dict(actuator())
    broken["motor"]["colour"] = 1.0
    with pytest.raises(UsageError, match="colour"):
        actuator_from_dict(broken)


def test_friction_is_fitted_on_the_named_episodes_alone():
    data = data_set(6, 400)
    names = ("e0", "e1", "e2", "e3")
    fit = fit_friction(data, names, SLOPE)
    told = dict(zip(TERMS, fit.coefficients, strict=True))
    assert told["inertia"] == pytest.approx(INERTIA, rel=0.2)
    assert told["viscous"] == pytest.approx(VISCOUS, abs=0.15)
    assert told["base"] == pytest.approx(COULOMB, rel=0.2)
    other = data.named(("e5",))[0]
    error = fit.estimate(other) - other.columns["torque"]
    law = pd_law(data, other)
    assert np.sqrt(np.mean(error**2)) < 0.4 * np.sqrt(np.mean((law - other.columns["torque"]) ** 2))
    # An episode that is not named may hold anything.
    spoiled = dataclasses.replace(other, columns={k: 100.0 * v for k, v in other.columns.items()})
    changed = dataclasses.replace(data, episodes=(*data.episodes[:5], spoiled))
    assert fit_friction(changed, names, SLOPE).coefficients == fit.coefficients
    with pytest.raises(UsageError, match="training episodes"):
        fit_friction(data, (), SLOPE)


def test_current_gives_torque_by_constant_ratio_and_efficiency():
    one, parameters = episode("e", 0.6, 0.3), actuator()
    friction = dataclasses.replace(parameters.friction, load_forward=0.0)
    lossless = dataclasses.replace(parameters, friction=friction)
    np.testing.assert_allclose(current_estimate(lossless, one), one.columns["torque"], rtol=1e-12)
    np.testing.assert_allclose(
        current_estimate(parameters, one), one.columns["torque"] / 1.1, rtol=1e-12
    )
    columns = {k: v for k, v in one.columns.items() if k != "current"}
    with pytest.raises(UsageError, match="has no current"):
        current_estimate(parameters, dataclasses.replace(one, columns=columns))


@pytest.mark.parametrize("error", [0.5, -0.5])
def test_every_friction_has_its_place_in_the_balance(error):
    """At a constant speed, term by term at the motor and at the joint (see the module)."""
    parameters, speed, ratio = actuator(), 0.15, 10.0
    motor, friction = parameters.motor, parameters.friction
    motor = dataclasses.replace(motor, hysteresis=0.02, iron_loss=3e-4)
    parameters = dataclasses.replace(parameters, motor=motor)
    one = steady(speed, error)
    driven = 60.0 * error - 2.0 * speed
    turning = ratio * speed
    rise = 1.0 + friction.stribeck_extra * np.exp(-((turning / friction.stribeck_speed) ** 2))
    assert rise > 1.1
    sign = np.tanh(turning / (0.25 * friction.stribeck_speed))
    taken = (friction.motor_viscous + motor.iron_loss) * turning
    taken += sign * (friction.motor_coulomb * rise + motor.hysteresis)
    left = driven - ratio * taken
    if left * speed > 0.0:
        through = left / (1.0 + friction.load_forward * rise * sign)
    else:
        through = left / (1.0 - friction.load_backward * rise * sign)
    wanted = through - sign * friction.output_coulomb * rise - friction.output_viscous * speed
    found = physical_estimate(parameters, one, SLOPE)[-1]
    assert found == pytest.approx(wanted, rel=1e-9)
    assert dry_friction(parameters) == pytest.approx(ratio * (friction.motor_coulomb + 0.02))


def test_the_ripple_feature_is_that_of_the_balance_less_dry_friction():
    parameters, one = actuator(), episode("e", 0.6, 0.3)
    inputs = ("ripple", "balance", "friction_sign")
    found = feature_matrix(one, inputs, differentiator=SLOPE, physics=parameters)
    given = found[:, 1] - 10.0 * parameters.friction.motor_coulomb * found[:, 2]
    wanted = gear_ripple(parameters, one.columns["position"], given)
    np.testing.assert_allclose(found[:, 0], wanted, rtol=1e-12, atol=1e-15)


def test_load_friction_is_fitted_by_the_direction_of_power():
    """What pushes the joint on is lessened, what holds it back is raised: one coefficient each."""
    data = data_set(6, 400)
    law = [pd_law(data, one) for one in data.episodes]
    with_load = []
    for one, asked in zip(data.episodes, law, strict=True):
        driving = asked * one.columns["velocity"] > 0.0
        share = np.where(driving, 0.12, 0.3) * np.tanh(one.columns["velocity"] / 0.03)
        torque = asked - share * np.abs(asked)
        with_load.append(dataclasses.replace(one, columns={**one.columns, "torque": torque}))
    data = dataclasses.replace(data, episodes=tuple(with_load))
    fit = fit_friction(data, ("e0", "e1", "e2", "e3"), SLOPE)
    told = dict(zip(TERMS, fit.coefficients, strict=True))
    assert fit.sign_speed == 0.03
    assert told["load_forward"] == pytest.approx(0.12, abs=1e-6)
    assert told["load_backward"] == pytest.approx(0.3, abs=1e-6)
    assert fit.training_rmse < 1e-6
