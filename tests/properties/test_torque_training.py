"""Training: sizes, determinism, resuming to the last bit, learning, and what is refused."""

from __future__ import annotations

import dataclasses
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from torque_samples import DT, actuator, data_set

torch = pytest.importorskip("torch")

from cqdd_design.errors import UsageError  # noqa: E402
from cqdd_design.torque.data.episodes import write_data  # noqa: E402
from cqdd_design.torque.data.splits import Split  # noqa: E402
from cqdd_design.torque.features.matrix import feature_matrix  # noqa: E402
from cqdd_design.torque.features.physics import actuator_to_dict  # noqa: E402
from cqdd_design.torque.networks.artefact import read_artefact, write_artefact  # noqa: E402
from cqdd_design.torque.networks.modules import MODELS, Network, find_model, network_of  # noqa: E402
from cqdd_design.torque.networks.wavefront import last_state  # noqa: E402
from cqdd_design.torque.training.recipe import Choice, Order, Recipe  # noqa: E402
from cqdd_design.torque.training.schedule import OneCycle, peak_rate  # noqa: E402
from cqdd_design.torque.training.tensors import Prepared, raw, scaling  # noqa: E402
from cqdd_design.torque.training.train import train  # noqa: E402

DATA = data_set()
SPLIT = Split(("e0", "e1", "e2", "e3", "e4"), ("e5", "e6"), ("e7",), "trajectory", 0)
QUICK = Recipe(epochs=3, batch=16, stride=8, threads=1)
MLP = Choice("tanh", 5e-3)


ORDERED = {"recipe", "actuator", "choice", "device"}


def quick(model="mlp-baseline", seed=0, **more):
    """Train on the small data; what belongs to the order, and what to its running."""
    chosen = {"recipe": QUICK, "device": "cpu"} | more
    order = Order(model, seed, **{name: chosen[name] for name in ORDERED & chosen.keys()})
    return train(DATA, SPLIT, order, **{k: v for k, v in more.items() if k not in ORDERED})


def test_the_range_of_the_training_is_written_down():
    facts = quick().facts
    labels, speeds = (
        np.concatenate([one.columns[name] for one in DATA.named(SPLIT.train)])
        for name in ("torque", "velocity")
    )
    assert facts["label_range_Nm"] == [labels.min(), labels.max()]
    assert facts["speed_range_rad_per_s"] == [speeds.min(), speeds.max()]
    assert facts["signals_filter"] is None


def test_sizes_are_those_of_the_paper():
    counts = {
        name: sum(t.numel() for t in Network(model, len(model.inputs), 0).tensors.values())
        for name, model in MODELS.items()
    }
    assert counts["pv-gru"] == 22_497
    assert counts["pva-gru"] == 22_593
    assert counts["mlp-baseline"] == 6 * 32 + 32 + 2 * (32 * 32 + 32) + 33
    assert counts["mlp"] == 48 * 32 + 32 + 2 * (32 * 32 + 32) + 33
    assert MODELS["mlp-baseline"].activation == "softsign"
    assert MODELS["mlp"].inputs == ("position_error", "velocity")


def test_diagonals_and_their_gradient_are_torchs():
    torch.manual_seed(0)
    for layers, samples, features in ((1, 5, 2), (2, 1, 3), (4, 7, 3), (5, 3, 1)):
        gru = torch.nn.GRU(features, 6, layers, batch_first=True).double()
        x = torch.randn(3, samples, features, dtype=torch.float64)
        wanted = gru(x)[0][:, -1]
        weight = torch.randn_like(wanted)
        (wanted * weight).sum().backward()
        gradients = [p.grad.clone() for p in gru.parameters()]
        gru.zero_grad()
        found = last_state(x, list(gru.parameters()))
        torch.testing.assert_close(found, wanted, rtol=1e-12, atol=1e-12)
        (found * weight).sum().backward()
        for parameter, gradient in zip(gru.parameters(), gradients, strict=True):
            torch.testing.assert_close(parameter.grad, gradient, rtol=1e-10, atol=1e-12)


@pytest.mark.parametrize("steps", [10, 97, 1000])
def test_the_cycle_is_torchs(steps):
    parameter = torch.nn.Parameter(torch.zeros(1))
    optimiser = torch.optim.Adam([parameter], lr=1.0)
    theirs = torch.optim.lr_scheduler.OneCycleLR(optimiser, max_lr=2.5e-3, total_steps=steps)
    ours = OneCycle(2.5e-3, steps)
    for step in range(steps):
        group = optimiser.param_groups[0]
        assert ours.at(step) == pytest.approx((group["lr"], group["betas"][0]), rel=1e-9)
        optimiser.step()
        if step < steps - 1:
            theirs.step()


def test_both_readings_of_the_learning_rate():
    assert peak_rate("max") == pytest.approx(1e-4)
    assert OneCycle(peak_rate("initial"), 100).at(0)[0] == pytest.approx(1e-4)
    with pytest.raises(UsageError, match="did you mean 'initial'"):
        peak_rate("inital")
    slow, fast = (
        quick(recipe=dataclasses.replace(QUICK, reading=reading)) for reading in ("max", "initial")
    )
    assert fast.facts["validation_rmse_Nm"] < slow.facts["validation_rmse_Nm"]


@pytest.mark.parametrize("name", ["pv-gru", "mlp-baseline"])
def test_weights_go_to_an_artefact_and_back_exactly(name, tmp_path):
    artefact = quick(name)
    write_artefact(artefact, tmp_path / "n.npz")
    read = read_artefact(tmp_path / "n.npz")
    network = network_of(read)
    for key, values in network.weights().items():
        np.testing.assert_array_equal(values, artefact.weights[key])
    with pytest.raises(UsageError, match="not those of"):
        network.load({**artefact.weights, "weight_9": np.zeros((1, 1), np.float32)})


def test_the_same_seed_gives_the_same_bits_and_another_does_not():
    first, second, other = quick(), quick(), quick(seed=1)
    for name, values in first.weights.items():
        np.testing.assert_array_equal(values, second.weights[name])
    assert any(np.any(v != other.weights[k]) for k, v in first.weights.items())
    assert (
        first.facts["log"][0]["validation_rmse_Nm"]
        == (second.facts["log"][0]["validation_rmse_Nm"])
    )


@pytest.mark.parametrize(
    ("model", "mode"), [("mlp-baseline", "window"), ("pva-gru", "window"), ("pv-gru", "streaming")]
)
def test_interrupted_and_resumed_is_bit_by_bit_uninterrupted(model, mode, tmp_path):
    recipe = dataclasses.replace(QUICK, mode=mode, stride=16)
    whole = quick(model, recipe=recipe)
    place = tmp_path / "c.npz"

    def interrupt(result):
        if result.epoch == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        quick(model, recipe=recipe, checkpoint=place, progress=interrupt)
    seen = []
    resumed = quick(model, recipe=recipe, checkpoint=place, resume=True, progress=seen.append)
    assert [result.epoch for result in seen] == [3]
    for name, values in whole.weights.items():
        np.testing.assert_array_equal(values, resumed.weights[name])
    rows = [[row["validation_rmse_Nm"] for row in one.facts["log"]] for one in (whole, resumed)]
    assert rows[0] == rows[1]


def test_an_interruption_within_an_epoch_is_resumed_from_its_start(tmp_path, monkeypatch):
    whole, place = quick(), tmp_path / "c.npz"
    steps = [0]
    real = OneCycle.at

    def failing(self, step):
        steps[0] += 1
        if steps[0] == 15:
            raise KeyboardInterrupt
        return real(self, step)

    monkeypatch.setattr(OneCycle, "at", failing)
    with pytest.raises(KeyboardInterrupt):
        quick(checkpoint=place)
    monkeypatch.undo()
    resumed = quick(checkpoint=place, resume=True)
    for name, values in whole.weights.items():
        np.testing.assert_array_equal(values, resumed.weights[name])


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"model": "mlp-baseline", "seed": 1}, "seed is 0"),
        ({"model": "pv-gru"}, "model is mlp-baseline"),
        ({"recipe": dataclasses.replace(QUICK, stride=4)}, "stride is 8"),
    ],
)
def test_a_checkpoint_of_another_training_is_refused(change, told, tmp_path):
    place = tmp_path / "c.npz"
    quick(checkpoint=place)
    with pytest.raises(UsageError, match=told):
        quick(**change, checkpoint=place, resume=True)


def test_a_checkpoint_of_other_data_or_version_or_none_is_refused(tmp_path):
    place = tmp_path / "c.npz"
    quick(checkpoint=place)
    other = data_set(8, 161)
    with pytest.raises(UsageError, match="data is"):
        train(other, SPLIT, Order("mlp-baseline", 0, QUICK), checkpoint=place, resume=True)
    with np.load(place) as found:
        arrays = {name: found[name] for name in found.files}
    content = json.loads(str(arrays["metadata"]))
    content["format"] = "cqdd-design torque checkpoint 0"
    with place.open("wb") as stream:
        np.savez(stream, **{**arrays, "metadata": np.array(json.dumps(content))})
    with pytest.raises(UsageError, match="checkpoint 0"):
        quick(checkpoint=place, resume=True)
    place.write_bytes(b"\x80\x04\x95cqdd")
    with pytest.raises(UsageError, match="never read"):
        quick(checkpoint=place, resume=True)
    with pytest.raises(UsageError, match="no checkpoint"):
        quick(checkpoint=tmp_path / "none.npz", resume=True)


def test_windows_end_at_every_stride_th_sample_and_lie_within_one_episode():
    inputs = ("position_error", "velocity")
    taken = raw(DATA.episodes[:2], inputs, None, None, residual=False)
    prepared = Prepared(taken, scaling(taken, inputs), "cpu")
    ends = prepared.ends(30, 40, 3)
    # Of 160 samples each; (160 - 30 + 1) // 40 = 3 windows an episode, whatever the offset.
    assert ends.tolist() == [32, 72, 112, 192, 232, 272]
    x, y = prepared.windows(torch.from_numpy(ends), 30)
    first = DATA.episodes[1].columns
    scale = scaling(taken, inputs)
    newest = (first["velocity"][32] - scale.input_mean[1]) / scale.input_std[1]
    oldest = (first["velocity"][3] - scale.input_mean[1]) / scale.input_std[1]
    assert float(x[3, -1, 1]) == pytest.approx(newest, rel=1e-5)
    assert float(x[3, 0, 1]) == pytest.approx(oldest, rel=1e-5)
    torque = (first["torque"][32] - scale.torque_mean) / scale.torque_std
    assert float(y[3]) == pytest.approx(torque, rel=1e-5)


def test_it_learns_and_keeps_the_best_epoch():
    recipe = Recipe(epochs=25, stride=2, batch=32, threads=1)
    artefact = quick("mlp-baseline", recipe=recipe)
    torque = np.concatenate([e.columns["torque"] for e in DATA.named(SPLIT.validation)])
    assert artefact.facts["validation_rmse_Nm"] < 0.2 * np.std(torque)
    rows = [row["validation_rmse_Nm"] for row in artefact.facts["log"]]
    assert artefact.facts["validation_rmse_Nm"] == min(rows)
    assert artefact.facts["best_epoch"] == 1 + rows.index(min(rows))


def test_the_told_validation_error_is_that_of_the_weights():
    artefact = quick("pva-gru", recipe=dataclasses.replace(QUICK, stride=1, epochs=1))
    network, squares = network_of(artefact), []
    for episode in DATA.named(SPLIT.validation):
        matrix = feature_matrix(episode, artefact.inputs, differentiator=artefact.differentiator)
        scaled = (matrix - artefact.input_mean) / artefact.input_std
        rows = np.lib.stride_tricks.sliding_window_view(scaled, 30, axis=0).transpose(0, 2, 1)
        with torch.no_grad():
            found = network.last(torch.from_numpy(rows.astype(np.float32))).numpy()
        torque = found * artefact.torque_std + artefact.torque_mean
        squares.append((torque - episode.columns["torque"][29:]) ** 2)
    rmse = np.sqrt(np.mean(np.concatenate(squares)))
    assert artefact.facts["validation_rmse_Nm"] == pytest.approx(rmse, rel=1e-5)


def test_a_residual_learns_what_physics_leaves_and_phases_come_from_the_gearbox():
    parameters = actuator()
    residual = quick(
        "physics-gru", recipe=dataclasses.replace(QUICK, stride=16), actuator=parameters
    )
    assert residual.residual
    assert residual.inputs[-2:] == ("balance", "friction_sign")
    torque = np.concatenate([e.columns["torque"] for e in DATA.named(SPLIT.train)])
    assert residual.torque_std < 0.5 * np.std(torque)
    assert residual.facts["actuator"]["friction"]["load_forward"] == 0.1
    recipe = dataclasses.replace(QUICK, stride=16, orders=2)
    phase = quick("phase-gru", recipe=recipe, actuator=parameters)
    assert phase.inputs[3:] == ("sin_10", "cos_10", "sin_11", "cos_11")
    for model in ("physics-gru", "phase-gru"):
        with pytest.raises(UsageError, match="--design"):
            quick(model)


def test_patience_stops_and_the_searched_mlp_records_its_trials(monkeypatch):
    recipe = dataclasses.replace(QUICK, epochs=40, patience=1, reading="initial")
    assert quick(recipe=recipe).facts["epochs"] <= 40
    from cqdd_design.torque.training import search

    monkeypatch.setattr(search, "RATES", (1e-3, 6e-3))
    monkeypatch.setattr(search, "DECAYS", (0.0,))
    artefact = quick("mlp", recipe=dataclasses.replace(QUICK, stride=2, batch=16))
    told = artefact.facts["search"]
    assert len(told["trials"]) == 4 * 2 + search.FINALISTS
    finals = told["trials"][8:]
    best = min(finals, key=lambda row: row["validation_rmse_Nm"])
    assert told["choice"]["activation"] == best["activation"] == artefact.activation
    assert "search" not in quick("mlp", choice=MLP).facts


def test_facts_say_how_it_was_made():
    facts = quick(command="cqdd-design torque train").facts
    assert facts["command"] == "cqdd-design torque train"
    assert facts["data_sha256"] == DATA.sha256
    assert facts["split"]["test"] == ["e7"]
    assert "differentiator" not in facts
    told = quick("mlp-acceleration", choice=MLP).facts["differentiator"]
    assert told["frequency"] == 17.0
    assert 0.0 < told["delay"] < DT
    assert facts["versions"]["torch"] == str(torch.__version__)
    json.dumps(dict(facts), allow_nan=False)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"dt": 0.01}, "sampled every 0.005 s, not 0.01"),
        ({"device": "tpu"}, "no device"),
        ({"seed": -1}, "seed -1"),
        ({"resume": True}, "nothing to resume"),
        ({"recipe": dataclasses.replace(QUICK, mode="streaming")}, "keeps no state"),
    ],
)
def test_what_cannot_be_trained(change, told):
    with pytest.raises(UsageError, match=told):
        quick(**change)


def test_unknown_models_short_and_still_data_are_refused():
    with pytest.raises(UsageError, match="did you mean 'pva-gru'"):
        find_model("pva-gr")
    with pytest.raises(UsageError, match="no episode to validation"):
        train(DATA, dataclasses.replace(SPLIT, validation=()), Order("pv-gru"))
    with pytest.raises(UsageError, match="longest episode"):
        train(data_set(8, 20), SPLIT, Order("pv-gru"))
    still = [
        dataclasses.replace(e, columns={**e.columns, "velocity": np.zeros(len(e))})
        for e in DATA.episodes
    ]
    with pytest.raises(UsageError, match="velocity does not move"):
        train(dataclasses.replace(DATA, episodes=tuple(still)), SPLIT, Order("pv-gru"))
    with pytest.raises(UsageError, match="epochs 0"):
        Recipe(epochs=0)
    assert DATA.dt == DT


def test_a_machine_without_the_design_tools_can_train(tmp_path):
    pytest.importorskip("pyarrow")
    write_data(DATA, tmp_path / "data")
    (tmp_path / "actuator.json").write_text(json.dumps(actuator_to_dict(actuator())))
    program = """
import sys
from importlib.abc import MetaPathFinder

class Missing(MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in {"cadquery", "numba", "pint", "pydantic", "typer"}:
            raise ModuleNotFoundError(name)

sys.meta_path.insert(0, Missing())
import json
from pathlib import Path
from cqdd_design.torque.data.episodes import read_data
from cqdd_design.torque.data.splits import split
from cqdd_design.torque.features.physics import actuator_from_dict
from cqdd_design.torque.training.recipe import Order, Recipe
from cqdd_design.torque.training.train import train
place = Path(sys.argv[1])
data = read_data(place / "data")
actuator = actuator_from_dict(json.loads((place / "actuator.json").read_text()))
parts, recipe = split(data, "trajectory"), Recipe(epochs=2, stride=16, batch=16)
print(train(data, parts, Order("physics-gru", 0, recipe, actuator)).name)
"""
    done = subprocess.run(
        [sys.executable, "-c", program, str(tmp_path)],
        env={**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stdout.strip() == "physics-gru", done.stderr
