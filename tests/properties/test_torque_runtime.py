"""Running an estimator: kernels against numpy and torch, windows against streaming, bad input."""

from __future__ import annotations

import math

import numpy as np
import pytest
from torque_networks import PV, PVA, motion, network

from cqdd_design.errors import UsageError
from cqdd_design.torque.networks import gru_kernel
from cqdd_design.torque.networks.predict import Streaming, predict, predict_windows

CASES = {
    "pva-gru, streaming": network(),
    "pva-gru, window": network(mode="window"),
    "pv-gru": network(inputs=PV, seed=3),
    "odd sizes": network(inputs=("velocity",), layers=1, hidden=10, history=7, mode="window"),
    "phase": network(inputs=(*PVA, "sin_11", "cos_11"), mode="window"),
    "residual": network(inputs=(*PVA, "balance"), residual=True),
    "residual, window": network(inputs=(*PVA, "balance"), residual=True, mode="window"),
    "softsign": network("mlp", inputs=PV),
    "relu": network("mlp", inputs=PV, activation="relu", history=3, hidden=20),
    "tanh": network("mlp", inputs=PV, activation="tanh", history=24),
    "elu": network("mlp", activation="elu", layers=2),
}
TOLERANCE = 1e-5


@pytest.fixture(params=list(CASES))
def artefact(request):
    return CASES[request.param]


def test_the_kernel_computes_what_numpy_does_in_double_precision(artefact):
    raw = motion(artefact, 400)
    compiled = predict(artefact, raw)
    plain = predict(artefact, raw, engine="plain")
    assert plain[artefact.history :].std() > 0.3
    np.testing.assert_allclose(compiled, plain, atol=TOLERANCE, rtol=0.0)


def test_both_compute_what_torch_does(artefact):
    torch = pytest.importorskip("torch")
    from torque_networks import torch_torque

    torch.set_num_threads(1)
    raw = motion(artefact, 400)
    wanted = torch_torque(artefact, raw, artefact.mode)
    np.testing.assert_allclose(predict(artefact, raw), wanted, atol=TOLERANCE, rtol=0.0)


def test_one_sample_at_a_time_is_the_whole_episode(artefact):
    raw = motion(artefact, 80)
    wanted = predict(artefact, raw)
    one = Streaming(artefact)
    found = np.array([one.step(row) for row in raw])
    np.testing.assert_allclose(found, wanted, atol=2e-6, rtol=0.0)
    fresh = Streaming(artefact)
    again = np.array([fresh.step(list(row)) for row in raw])
    np.testing.assert_array_equal(again, found)


def test_windows_are_nan_until_they_are_full(artefact):
    raw = motion(artefact, 50)
    found = predict(artefact, raw, mode="window")
    assert np.isnan(found[: artefact.history - 1]).all()
    assert np.isfinite(found[artefact.history - 1 :]).all()
    short = predict(artefact, raw[: artefact.history - 1], mode="window")
    assert np.isnan(short).all()


def test_no_estimate_knows_the_future(artefact):
    raw = motion(artefact, 60)
    changed = raw.copy()
    changed[45:] += 1.0
    before, after = predict(artefact, raw), predict(artefact, changed)
    np.testing.assert_array_equal(before[:45], after[:45])
    assert before[45] != after[45]


def test_a_window_starts_from_a_zero_state_and_a_stream_does_not():
    artefact = CASES["pva-gru, streaming"]
    raw = motion(artefact, 200)
    streamed, windowed = predict(artefact, raw), predict(artefact, raw, mode="window")
    first = artefact.history - 1
    assert streamed[first] == pytest.approx(windowed[first], abs=1e-5)
    assert np.abs(streamed - windowed)[first + 1 :].max() > 1e-5


def test_a_residual_adds_the_physical_estimate_once():
    artefact = CASES["residual"]
    raw = motion(artefact, 40)
    bare = network(inputs=artefact.inputs, residual=False)
    added = predict(artefact, raw) - predict(bare, raw)
    np.testing.assert_allclose(added, raw[:, artefact.inputs.index("balance")], atol=1e-5)


def test_any_number_of_windows_gives_the_same_torque():
    artefact = CASES["pva-gru, window"]
    rng = np.random.default_rng(5)
    windows = rng.standard_normal((2 * gru_kernel.LANES + 5, artefact.history, 3))
    whole = predict_windows(artefact, windows)
    for place in (0, gru_kernel.LANES - 1, gru_kernel.LANES, len(windows) - 1):
        alone = predict_windows(artefact, windows[place : place + 1])
        np.testing.assert_array_equal(alone, whole[place : place + 1])


def test_the_tangent_is_as_good_as_single_precision():
    grid = np.linspace(-12.0, 12.0, 48_001).astype(np.float32)
    found = np.array([gru_kernel.tanh32(value) for value in grid], float)
    assert np.abs(found - np.tanh(grid.astype(float))).max() < 1e-6
    assert math.isnan(gru_kernel.tanh32(np.float32("nan")))


def test_a_hundred_thousand_steps_stay_finite():
    artefact = CASES["pva-gru, streaming"]
    found = predict(artefact, motion(artefact, 100_000))
    assert np.isfinite(found).all()
    assert np.abs(found).max() < 200.0


def test_wrong_features_are_refused():
    artefact = CASES["pva-gru, streaming"]
    raw = motion(artefact, 50)
    with pytest.raises(UsageError, match="position_error, velocity, acceleration"):
        predict(artefact, raw[:, :2])
    raw[7, 1] = np.nan
    with pytest.raises(UsageError, match="velocity is nan at sample 7"):
        predict(artefact, raw)
    with pytest.raises(UsageError, match="keeps no state"):
        predict(CASES["relu"], motion(CASES["relu"], 9), mode="streaming")
    with pytest.raises(UsageError, match="windows"):
        predict_windows(artefact, np.zeros((4, 5, 3)))


def test_other_gains_or_sample_times_are_refused():
    artefact = CASES["pva-gru, streaming"]
    artefact.require(0.005, 60.0, 2.0)
    with pytest.raises(UsageError, match="sample time"):
        artefact.require(0.004, 60.0, 2.0)
