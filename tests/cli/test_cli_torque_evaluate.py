"""``torque evaluate`` as a process: table, JSON, page, and every wrong input."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import typer

from cqdd_design.cli import main, session, torque_evaluate
from cqdd_design.torque.data.episodes import DataSet, Episode, write_data
from cqdd_design.torque.data.splits import random_window_split, split
from cqdd_design.torque.networks.artefact import Artefact, Validity, write_artefact

pytest.importorskip("pyarrow")

DT = 0.005
RUN = """
import sys, typer
from cqdd_design.cli import main
from cqdd_design.cli.session import command
from cqdd_design.cli.torque_evaluate import evaluate
main.app = typer.Typer()
main.app.command("evaluate")(command(evaluate))
main.app.callback()(lambda: None)
sys.exit(main.run(["evaluate", *sys.argv[1:]]))
"""
FEW = ("--draws", "200", "--rollouts", "1")


class Done:
    def __init__(self, done: subprocess.CompletedProcess[str]):
        self.code, self.out, self.err = done.returncode, done.stdout, done.stderr


def evaluate(folder: Path, *arguments: str | Path) -> Done:
    done = subprocess.run(
        [sys.executable, "-c", RUN, *map(str, arguments)],
        cwd=folder,
        env=environment(),
        capture_output=True,
        encoding="utf-8",
        timeout=120.0,
        check=False,
    )
    assert "Traceback" not in done.stderr, done.stderr
    return Done(done)


@pytest.fixture
def inside(monkeypatch, capsys, tmp_path):
    """The command without a process of its own: exit code and what it told on stderr."""
    app = typer.Typer()
    app.command("evaluate")(session.command(torque_evaluate.evaluate))
    app.callback()(lambda: None)
    monkeypatch.setattr(main, "app", app)
    monkeypatch.chdir(tmp_path)

    def run(*arguments: str | Path) -> tuple[int, str]:
        code = main.run(["evaluate", *map(str, arguments)])
        return code, capsys.readouterr().err

    return run


def environment() -> dict[str, str]:
    import os

    import cqdd_design

    package = str(Path(cqdd_design.__file__).resolve().parents[1])
    return {**os.environ, "PYTHONPATH": package, "PYTHONIOENCODING": "utf-8"}


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


def test_table_json_page_and_markdown(place, tmp_path):
    files = ("--model", place / "pva-gru.npz", "--model", place / "mlp.npz")
    written = ("--report", "page.html", "--markdown", "tables.md", "--set", "trajectory,mass")
    done = evaluate(tmp_path, "--data", place / "data", *files, *written, *FEW, "--json")
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


def test_the_terminal_shows_both_and_keeps_them_apart(place, tmp_path):
    done = evaluate(tmp_path, "--data", place / "data", "--model", place / "mlp.npz", *FEW)
    assert done.code == 0, done.err
    ours, paper = done.out.split("paper (hardware)")
    assert "set trajectory" in ours
    assert "pd-law" in ours
    assert "1.71" in paper
    assert "not to be read against ours" in paper


def test_baselines_alone_can_be_scored(place, inside):
    assert inside("--data", place / "data", *FEW, "--rollouts", "0", "--quiet") == (0, "")


def test_random_windows_show_what_a_leak_is_worth(place, data, tmp_path):
    drawn, windows = random_window_split(data, 0)
    facts = {"split": windows.to_dict(), "data_sha256": drawn.sha256, "seed": 0}
    write_artefact(network("mlp", 2, facts=facts), tmp_path / "leaky.npz")
    both = ("--model", place / "mlp.npz", "--model", tmp_path / "leaky.npz")
    done = evaluate(tmp_path, "--data", place / "data", *both, *FEW, "--json")
    assert done.code == 0, done.err
    models = json.loads(done.out)["results"]["models"]
    assert models["mlp"]["leaked_rmse_Nm"] == pytest.approx(models["mlp"]["rmse_Nm"], rel=0.5)
    assert "mlp (random windows)" not in models
    other = network("mlp", 2, facts=facts | {"data_sha256": "0" * 64})
    write_artefact(other, tmp_path / "other.npz")
    both = ("--model", place / "mlp.npz", "--model", tmp_path / "other.npz")
    done = evaluate(tmp_path, "--data", place / "data", *both, *FEW)
    assert done.code == 2
    assert "random windows of other data" in done.err


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"validity": Validity(0.01, 60.0, 2.0, (-9.0, 9.0))}, "sample time of 0.01 s, not 0.005"),
        ({"validity": Validity(DT, 40.0, 2.0, (-9.0, 9.0))}, "position gain of 40"),
        ({"validity": Validity(DT, 60.0, 1.0, (-9.0, 9.0))}, "velocity gain of 1"),
    ],
)
def test_networks_of_other_gains_or_times_are_refused(place, inside, changes, told):
    write_artefact(network("mlp", 2, **changes), Path("other.npz"))
    code, err = inside("--data", place / "data", "--model", "other.npz", *FEW)
    assert code == 2
    assert told in err


def test_bad_input_is_told(place, inside, tmp_path):
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
        code, err = inside(*arguments)
        assert code == 2, (arguments, err)
        assert told in err
    assert (tmp_path / "page.html").read_text() == "mine"


def test_what_was_trained_on_is_not_scored(place, data, tmp_path):
    everything = [one.name for one in data.episodes]
    told = {"protocol": "trajectory", "seed": 0, "train": everything, "validation": []}
    write_artefact(network("mlp", 2, facts={"split": told}), tmp_path / "greedy.npz")
    done = evaluate(
        tmp_path, "--data", place / "data", "--model", tmp_path / "greedy.npz", *FEW, "--json"
    )
    assert done.code == 0, done.err
    document = json.loads(done.out)
    assert any("mlp was trained on" in sentence for sentence in document["warnings"])
    assert "rmse_Nm" not in document["results"]["models"]["mlp"]
    assert "rmse_Nm" in document["results"]["models"]["pd-law"]


def test_a_network_of_other_data_is_scored_though_names_agree(place, data, inside):
    """Two data sets name their episodes alike; only the hash tells whether they are the same."""
    everything = [one.name for one in data.episodes]
    told = {"protocol": "trajectory", "seed": 0, "train": everything, "validation": []}
    other, seen = "trained on other data than these", "was trained on 4 of the 4 episodes"
    for sha256, right, wrong in (("0" * 64, other, seen), (data.sha256, seen, other)):
        facts = {"split": told, "data_sha256": sha256}
        write_artefact(network("mlp", 2, facts=facts), Path("net.npz"))
        files = ("--data", place / "data", "--model", "net.npz")
        code, err = inside(*files, "--draws", "100", "--rollouts", "0")
        assert code == 0, err
        assert right in err
        assert wrong not in err
