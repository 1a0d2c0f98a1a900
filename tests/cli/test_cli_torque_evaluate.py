"""``torque evaluate`` as a command: table, JSON, page, and every wrong input."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
import typer

from cqdd_design.cli import main, session, torque_evaluate
from cqdd_design.torque.data.episodes import DataSet, Episode, write_data
from cqdd_design.torque.data.splits import split
from cqdd_design.torque.networks.artefact import Artefact, Validity, write_artefact

pytest.importorskip("pyarrow")

DT = 0.005
FEW = ("--draws", "200", "--rollouts", "1")


@dataclass(frozen=True)
class Done:
    """A command that has ended, without a process of its own."""

    code: int
    out: str
    err: str


@pytest.fixture
def evaluate(monkeypatch, capsys, tmp_path):
    """The command in an empty folder: exit code, and what it told."""
    app = typer.Typer()
    app.command("evaluate")(session.command(torque_evaluate.evaluate))
    app.callback()(lambda: None)
    printed: list[str] = []
    monkeypatch.setattr(main, "app", app)
    monkeypatch.setattr(session, "print_result", printed.append)
    monkeypatch.chdir(tmp_path)

    def run(*arguments: str | Path) -> Done:
        printed.clear()
        code = main.run(["evaluate", *map(str, arguments)])
        return Done(code, "\n".join(printed), capsys.readouterr().err)

    return run


def episode(k: int) -> Episode:
    rng = np.random.default_rng(k)
    t = DT * np.arange(700)
    pulse, reach, mass = 2.0 * np.pi * rng.uniform(0.5, 1.4), rng.uniform(0.6, 1.4), 1.0 + k % 3
    position, velocity = reach * np.sin(pulse * t), reach * pulse * np.cos(pulse * t)
    torque = -(0.2 * mass * pulse**2 + 4.0 * mass) * np.sin(position)
    torque += 0.4 * np.sin(11.0 * position) + 0.05 * rng.normal(size=len(t))
    columns = {
        "position": position,
        "target": position + (torque + 2.8 * velocity) / 60.0,
        "velocity": velocity,
        "torque": torque,
        "wall": (position > 0.9).astype(float),
        "saturated": (np.abs(torque) > 12.0).astype(float),
    }
    return Episode(f"e{k:02}", {"mass": mass, "arm": 0.4, "wall": 0, "number": k}, DT, columns)


@pytest.fixture(scope="module")
def data() -> DataSet:
    facts = {
        "design": "a-joint",
        "held_mass_kg": 3.0,
        "pendulum": {
            "hanging_angle": 3.141592653589793,
            "gravity": 9.80665,
            "viscous": 0.0,
            "bar_inertia": 0.05,
            "bar_gravity_moment": 0.0,
        },
    }
    found = DataSet(tuple(episode(k) for k in range(18)), 60.0, 2.0, (-90.0, 90.0), facts)
    return found


@pytest.fixture(scope="module")
def place(data, tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("torque")
    write_data(data, folder / "data")
    honest = {"split": split(data, "trajectory", 0).to_dict(), "seed": 0}
    for name, seed in (("pva-gru", 1), ("mlp", 2)):
        own = network(name, seed)
        write_artefact(replace(own, facts=honest), folder / f"{name}.npz")
    return folder


def network(name: str, seed: int, **changes) -> Artefact:
    """A small MLP with drawn weights."""
    rng = np.random.default_rng(seed)
    inputs, history, hidden = ("position_error", "velocity"), 3, 8
    weights = {
        "weight_0": rng.normal(size=(hidden, len(inputs) * history)),
        "bias_0": np.zeros(hidden),
        "weight_1": rng.normal(size=(1, hidden)),
        "bias_1": np.zeros(1),
    }
    fields = {
        "name": name,
        "family": "mlp",
        "inputs": inputs,
        "history": history,
        "mode": "window",
        "layers": 1,
        "hidden": hidden,
        "activation": "tanh",
        "input_mean": (0.0, 0.0),
        "input_std": (1.0, 1.0),
        "torque_mean": 0.0,
        "torque_std": 5.0,
        "residual": False,
        "validity": Validity(DT, 60.0, 2.0, (-90.0, 90.0)),
        "differentiator": None,
        "weights": {key: value.astype(np.float32) for key, value in weights.items()},
    }
    return Artefact(**(fields | changes))


def test_table_json_page_and_markdown(evaluate, place, tmp_path):
    files = ("--model", place / "pva-gru.npz", "--model", place / "mlp.npz")
    written = ("--report", "page.html", "--markdown", "tables.md", "--set", "trajectory,mass")
    done = evaluate("--data", place / "data", *files, *written, *FEW, "--json")
    assert done.code == 0, done.err
    document = json.loads(done.out)
    assert [file["kind"] for file in document["files"]] == ["report", "markdown"]
    results = document["results"]
    assert results["headline_set"] == "trajectory"
    assert list(results["sets"]) == ["trajectory", "mass"]
    assert results["files_of_models"]["mlp"].endswith("mlp.npz")
    assert {"pva-gru", "mlp", "pd-law", "friction-fit"} <= set(results["models"])
    for own in results["models"].values():
        low, high = own["intervals_95"]["rmse_Nm"]
        assert low <= own["rmse_Nm"] <= high
        square = own["bias_Nm"] ** 2 + own["variance_N2m2"]
        assert own["rmse_Nm"] ** 2 == pytest.approx(square, rel=1e-9)
        assert set(own["regimes"]) == {"swing", "wall", "saturation", "reversal"}
        for key in ("ripple_amplitude_error_Nm", "ripple_frequency_Hz", "ripple_phase_deg"):
            assert key in own
    times = results["models"]["mlp"]["latency_us"]
    assert 0.0 < times["streaming_p50"] <= times["streaming_p99"]
    assert results["models"]["mlp"]["parameters"] == network("mlp", 2).parameters
    assert results["models"]["friction-fit"]["rmse_Nm"] < results["models"]["pd-law"]["rmse_Nm"]
    assert results["models"]["pd-law"]["rollout"]["ran_away"] == 0
    assert {"paper_hardware", "data", "bootstrap"} <= set(results)
    assert any("no actuator is known" in sentence for sentence in document["warnings"])
    page = (tmp_path / "page.html").read_text("utf-8")
    assert "a-joint" in page
    assert page.count("<svg") >= 8
    assert "Paper (hardware)" in (tmp_path / "tables.md").read_text("utf-8")


def test_the_terminal_shows_both_and_keeps_them_apart(evaluate, place, tmp_path):
    done = evaluate("--data", place / "data", "--model", place / "mlp.npz", *FEW)
    assert done.code == 0, done.err
    ours, paper = done.out.split("paper (hardware)")
    assert "set trajectory" in ours
    assert "pd-law" in ours
    assert "1.71" in paper
    assert "not to be read against ours" in paper


def test_baselines_alone_can_be_scored(evaluate, place):
    done = evaluate("--data", place / "data", *FEW, "--rollouts", "0", "--quiet")
    assert done == Done(0, "", "")


def test_the_score_on_random_windows_that_train_stored_is_shown(evaluate, place, tmp_path):
    """As `torque train --leaked` leaves it in the network's own file."""
    write_artefact(network("mlp", 2, facts={"leaked_rmse_Nm": 0.321}), tmp_path / "told.npz")
    files = ("--data", place / "data", "--model", tmp_path / "told.npz", "--report", "page.html")
    done = evaluate(*files, *FEW, "--json")
    assert done.code == 0, done.err
    assert json.loads(done.out)["results"]["models"]["mlp"]["leaked_rmse_Nm"] == 0.321
    assert "0.321" in (tmp_path / "page.html").read_text("utf-8")


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"validity": Validity(0.01, 60.0, 2.0, (-9.0, 9.0))}, "sample time of 0.01 s, not 0.005"),
        ({"validity": Validity(DT, 40.0, 2.0, (-9.0, 9.0))}, "position gain of 40"),
        ({"validity": Validity(DT, 60.0, 1.0, (-9.0, 9.0))}, "velocity gain of 1"),
    ],
)
def test_networks_of_other_gains_or_times_are_refused(evaluate, place, changes, told):
    write_artefact(network("mlp", 2, **changes), Path("other.npz"))
    done = evaluate("--data", place / "data", "--model", "other.npz", *FEW)
    assert done.code == 2
    assert told in done.err


def test_bad_input_is_told(evaluate, place, tmp_path):
    folder = place / "data"
    (tmp_path / "net.npz").write_bytes(b"\x80\x04\x95 a pickle")
    (tmp_path / "page.html").write_text("mine")
    for arguments, told in (
        (("--data", tmp_path), "no manifest.json"),
        (("--data", folder, "--model", tmp_path / "none.npz"), "there is no"),
        (("--data", folder, "--set", "trajektory"), "did you mean 'trajectory'"),
        (("--data", folder, "--set", "gearbox"), "gearbox"),
        (("--data", folder, "--calibration", "c.json"), "--design"),
        (("--data", folder, *(("--model", place / "mlp.npz") * 2)), "give each file once"),
        (("--data", folder, "--model", "net.npz"), "never read"),
        (("--data", folder, "--report", "page.html"), "--force"),
        (("--data", folder, "--draws", "5"), "--draws"),
    ):
        done = evaluate(*arguments)
        assert done.code == 2, (arguments, done.err)
        assert told in done.err
    assert (tmp_path / "page.html").read_text() == "mine"


def test_what_was_trained_on_is_not_scored(evaluate, place, data, tmp_path):
    everything = [one.name for one in data.episodes]
    told = {"protocol": "trajectory", "seed": 0, "train": everything, "validation": []}
    write_artefact(network("mlp", 2, facts={"split": told}), tmp_path / "greedy.npz")
    done = evaluate("--data", place / "data", "--model", tmp_path / "greedy.npz", *FEW, "--json")
    assert done.code == 0, done.err
    document = json.loads(done.out)
    assert any("mlp was trained on" in sentence for sentence in document["warnings"])
    assert "rmse_Nm" not in document["results"]["models"]["mlp"]
    assert "rmse_Nm" in document["results"]["models"]["pd-law"]


def test_a_network_of_another_version_of_the_design_is_told(evaluate, data, tmp_path):
    """Without --design: by the digests that data and network hold."""
    told = {"design": "a-joint", "design_sha256": "1" * 64}
    write_data(replace(data, facts={**data.facts, **told}), tmp_path / "data")
    for digest, there in (("1" * 64, False), ("2" * 64, True)):
        facts = {"data": {**told, "design_sha256": digest}}
        write_artefact(network("mlp", 2, facts=facts), Path("net.npz"))
        done = evaluate("--data", "data", "--model", "net.npz", "--draws", "100", "--rollouts", "0")
        assert done.code == 0, done.err
        said = " ".join(done.err.split())
        assert ("(sha256 22222222) and not of a-joint (sha256 11111111)" in said) is there


def test_a_network_of_other_data_is_scored_though_names_agree(evaluate, place, data):
    """Two data sets name their episodes alike; only the hash tells whether they are the same."""
    everything = [one.name for one in data.episodes]
    told = {"protocol": "trajectory", "seed": 0, "train": everything, "validation": []}
    other, seen = "trained on other data than these", "was trained on 2 of the 2 episodes"
    for sha256, right, wrong in (("0" * 64, other, seen), (data.sha256, seen, other)):
        facts = {"split": told, "data_sha256": sha256}
        write_artefact(network("mlp", 2, facts=facts), Path("net.npz"))
        files = ("--data", place / "data", "--model", "net.npz")
        done = evaluate(*files, "--draws", "100", "--rollouts", "0")
        assert done.code == 0, done.err
        assert right in done.err
        assert wrong not in done.err
