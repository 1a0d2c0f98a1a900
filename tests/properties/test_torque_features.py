"""Features: nothing of the future, the differentiator's delay, the gearbox's orders."""

from __future__ import annotations

import dataclasses
import json
import math

import numpy as np
import pytest
from torque_samples import DT, actuator, episode

from cqdd_design.errors import UsageError
from cqdd_design.torque.features.acceleration import (
    acceleration,
    differentiator_error,
    savitzky_golay,
)
from cqdd_design.torque.features.matrix import (
    PHYSICAL,
    feature_matrix,
    phase_inputs,
    strongest_orders,
)
from cqdd_design.torque.features.physics import actuator_from_dict, actuator_to_dict

ALL = ("position_error", "velocity", "acceleration", "sin_10", "cos_11", *PHYSICAL)


def test_no_feature_changes_with_later_samples():
    slope, parameters = savitzky_golay(DT), actuator()
    whole = episode("e", 0.9, 0.8)
    for moment in (0, 1, 40, 100):
        columns = {name: values.copy() for name, values in whole.columns.items()}
        for values in columns.values():
            values[moment + 1 :] += 3.0
        struck = dataclasses.replace(whole, columns=columns)
        own, other = (
            feature_matrix(one, ALL, differentiator=slope, physics=parameters)
            for one in (whole, struck)
        )
        np.testing.assert_array_equal(own[: moment + 1], other[: moment + 1])
        assert np.all(np.any(own[moment + 1 :] != other[moment + 1 :], axis=0))


def test_an_impulse_is_answered_by_the_taps_and_not_before():
    slope = savitzky_golay(DT, 6, 2)
    impulse = np.zeros(40)
    impulse[20] = 1.0
    answer = acceleration(impulse, slope)
    assert not np.any(answer[:20])
    np.testing.assert_allclose(answer[20:26], slope.taps, rtol=1e-12)
    assert not np.any(answer[26:])


@pytest.mark.parametrize(("points", "order"), [(2, 1), (5, 2), (7, 3)])
def test_polynomials_up_to_the_order_are_differentiated_exactly(points, order):
    time = DT * np.arange(50)
    slope = savitzky_golay(DT, points, order)
    velocity = 1.0 + 3.0 * time**order
    found = acceleration(velocity, slope)[points:]
    lag = slope.delay if order == 1 else 0.0
    wanted = 3.0 * order * (time - lag)[points:] ** (order - 1)
    np.testing.assert_allclose(found, wanted, rtol=1e-9)


def test_the_delay_of_order_one_is_half_of_its_span_and_of_order_two_none():
    for points in (2, 5, 9):
        assert savitzky_golay(DT, points, 1).delay == pytest.approx(0.5 * (points - 1) * DT)
    assert savitzky_golay(DT).delay == 0.0


def test_phase_at_17_hz_is_that_of_a_sine():
    slope = savitzky_golay(DT)
    told = differentiator_error(slope, DT, 17.0)
    time = DT * np.arange(4000)
    pulse = 2.0 * math.pi * 17.0
    found = acceleration(np.sin(pulse * time), slope)[10:]
    wave = np.exp(-1j * pulse * time[10:])
    true = pulse * np.cos(pulse * time)[10:]
    ratio = np.mean(found * wave) / np.mean(true * wave)
    assert told["gain"] == pytest.approx(abs(ratio), rel=1e-3)
    assert told["phase"] == pytest.approx(np.angle(ratio), abs=1e-3)
    assert told["delay"] == pytest.approx(-told["phase"] / pulse)


def test_noise_is_the_root_of_the_taps_squares():
    slope = savitzky_golay(DT)
    noise = np.random.default_rng(0).normal(0.0, 1e-3, 200_000)
    told = differentiator_error(slope, DT, 17.0)["noise"]
    assert np.std(acceleration(noise, slope)) == pytest.approx(1e-3 * told, rel=0.02)


def test_strongest_orders_weigh_error_by_order():
    gear = actuator().gear
    assert strongest_orders(gear, 2) == (10, 11)
    assert strongest_orders(gear, 99) == (1, 10, 11, 20)
    assert phase_inputs((10, 11)) == ("sin_10", "cos_10", "sin_11", "cos_11")
    # By T d/((p + 1) k T): 40 N m wind 2e4 N m/rad by 2 mrad, so a harmonic of 0.01 of the
    # stiffness weighs as an error of 0.01 * 2e-3/2.2 = 9.1 urad of its order.
    flat = dict.fromkeys(("error_sine", "stiffness_sine"), np.zeros(4))
    for error, best in ((8.9e-6, 10), (9.3e-6, 11)):
        told = {"error_cosine": np.array([0, 0, error * 10 / 11, 0])}
        told["stiffness_cosine"] = np.array([0.0, 0.01, 0.0, 0.0])
        assert strongest_orders(dataclasses.replace(gear, **flat, **told), 1) == (best,)
    still = dataclasses.replace(
        gear,
        **dict.fromkeys(
            ("error_cosine", "error_sine", "stiffness_cosine", "stiffness_sine"), np.zeros(4)
        ),
    )
    with pytest.raises(UsageError, match="no phase is worth"):
        strongest_orders(still)


def test_phases_are_those_of_the_homed_position():
    one = episode("e", 0.7, 0.6)
    found = feature_matrix(one, ("sin_10", "cos_10"))
    np.testing.assert_allclose(found[:, 0], np.sin(10.0 * one.columns["position"]))
    np.testing.assert_allclose(np.hypot(*found.T), 1.0)


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("velocty", "did you mean 'velocity'"),
        ("sin_0", "no feature"),
        ("acceleration", "needs a differentiator"),
        ("balance", "needs a differentiator"),
        ("ripple", "needs a differentiator"),
        ("friction_sign", "actuator's parameters"),
    ],
)
def test_features_that_cannot_be(name, told):
    with pytest.raises(UsageError, match=told):
        feature_matrix(episode("e", 0.7, 0.6), (name,))


@pytest.mark.parametrize("bad", [(0.0, 5, 2), (DT, 1, 1), (DT, 5, 5), (math.nan, 5, 2)])
def test_differentiators_that_cannot_be(bad):
    with pytest.raises(UsageError, match="differentiator"):
        savitzky_golay(*bad)


def test_an_actuator_kept_in_a_network_is_the_same():
    parameters = actuator()
    back = actuator_from_dict(json.loads(json.dumps(actuator_to_dict(parameters))))
    np.testing.assert_array_equal(back.gear.error_orders, parameters.gear.error_orders)
    assert back.friction == parameters.friction
    assert math.isnan(back.motor.peak_torque)
