"""`torque train` as its function with a real output: files, refusals, interruption and resuming."""

from __future__ import annotations

import json
import os
import signal
import subprocess
from pathlib import Path

import numpy as np
import pytest
import typer

pytest.importorskip("torch")
pytest.importorskip("pyarrow")

import sys

sys.path.insert(0, str(Path(__file__).parents[1] / "properties"))

from torque_samples import data_set

from cqdd_design.cli import session, torque_train
from cqdd_design.cli.session import command
from cqdd_design.errors import UsageError
from cqdd_design.torque.data.episodes import write_data
from cqdd_design.torque.networks.artefact import read_artefact
from cqdd_design.torque.training import epochs
from cqdd_design.torque.training.checkpoint import read_checkpoint

app = typer.Typer()
app.command()(command(torque_train.train))


@app.callback()
def _root() -> None:
    pass


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    place = tmp_path_factory.mktemp("torque") / "data"
    write_data(data_set(12), place)
    return place


@pytest.fixture
def run(monkeypatch, folder, tmp_path):
    """Run the command; what it prints on standard output, as text."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments: str) -> str:
        printed: list[str] = []
        monkeypatch.setattr(session, "print_result", printed.append)
        common = ["train", "--data", str(folder), "--epochs", "3", "--stride", "8"]
        common += ["--threads", "1", "--batch", "16", "--device", "cpu"]
        call.code = app([*common, *arguments], standalone_mode=False)
        return "\n".join(printed)

    return call


def test_it_writes_a_network_and_says_how_good_it_is(run, tmp_path, capsys):
    text = run("--model", "mlp-baseline", "--seed", "3", "--out", "n.npz", "--json")
    document = json.loads(text)
    results = document["results"]
    artefact = read_artefact(tmp_path / "n.npz")
    assert results["model"] == artefact.name == "mlp-baseline"
    assert results["validation_rmse_Nm"] == artefact.facts["validation_rmse_Nm"]
    assert artefact.facts["seed"] == 3
    assert artefact.facts["split"]["protocol"] == "trajectory"
    assert document["files"][0]["path"] == "n.npz"
    assert not (tmp_path / "n.checkpoint.npz").exists()
    told = capsys.readouterr().err
    assert "[3/3] epoch 3 of 3: RMSE" in told
    with pytest.raises(UsageError, match="exists already"):
        run("--model", "mlp-baseline", "--out", "n.npz")


def test_interrupted_it_keeps_its_checkpoint_and_resumes_to_the_same_bits(
    run, tmp_path, monkeypatch, capsys
):
    run("--model", "mlp-baseline", "--out", "whole.npz")
    real = epochs.Trainer.run_epoch

    def interrupting(self):
        if self.state.epoch == 1:
            raise KeyboardInterrupt
        return real(self)

    monkeypatch.setattr(epochs.Trainer, "run_epoch", interrupting)
    run("--model", "mlp-baseline", "--out", "n.npz")
    assert run.code == 130
    monkeypatch.setattr(epochs.Trainer, "run_epoch", real)
    assert "add --resume" in capsys.readouterr().err
    assert (tmp_path / "n.checkpoint.npz").exists()
    assert not (tmp_path / "n.npz").exists()
    with pytest.raises(UsageError, match="interrupted training"):
        run("--model", "mlp-baseline", "--out", "n.npz")
    with pytest.raises(UsageError, match="seed is 0 there and 1 here"):
        run("--model", "mlp-baseline", "--out", "n.npz", "--resume", "--seed", "1")
    run("--model", "mlp-baseline", "--out", "n.npz", "--resume")
    whole, resumed = read_artefact(tmp_path / "whole.npz"), read_artefact(tmp_path / "n.npz")
    for name, values in whole.weights.items():
        np.testing.assert_array_equal(values, resumed.weights[name])
    assert not (tmp_path / "n.checkpoint.npz").exists()


def test_hyperparameters_come_from_another_network(run, tmp_path):
    run("--model", "mlp-baseline", "--out", "a.npz")
    run("--model", "mlp", "--out", "b.npz", "--hyperparameters-of", "a.npz")
    found = read_artefact(tmp_path / "b.npz")
    assert found.activation == "softsign"
    assert "search" not in found.facts


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("--model", "pva-gri"), "did you mean 'pva-gru'"),
        (("--split", "trajectry"), "trajectory"),
        (("--mode", "stream"), "no mode 'stream'"),
        (("--learning-rate-reading", "maximum"), "did you mean 'max'"),
        (("--device", "gpu"), "no device 'gpu'"),
        (("--resume",), "no checkpoint"),
        (("--sample-time", "10 ms"), "sampled every 0.005 s, not 0.01 s"),
        (("--model", "physics-gru"), "--design"),
        (("--model", "mlp", "--design", "a.toml"), r"--design does not .* --model mlp"),
        (("--model", "pva-gru", "--orders", "2"), r"--orders does not .* or train phase-gru\."),
        (("--gearbox", "3"), "--gearbox belongs to a design"),
        (("--motor", "CubeMars RO100 KV55"), "--motor belongs to a design"),
        (("--calibration", "c.json"), "--calibration belongs to a design"),
        (("--data", "nowhere"), "holds no data set"),
        (("--split", "mass"), "mass"),
    ],
)
def test_bad_input(run, arguments, told):
    with pytest.raises(UsageError, match=told):
        run(*arguments)


def test_nan_in_the_data_is_named(run, folder, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    pyarrow = pytest.importorskip("pyarrow")
    import shutil

    copy = shutil.copytree(folder, tmp_path / "copy")
    path = copy / "episodes" / "e4.parquet"
    table = parquet.read_table(path)
    values = table.column("velocity").to_numpy().copy()
    values[7] = np.nan
    index = table.column_names.index("velocity")
    parquet.write_table(table.set_column(index, "velocity", pyarrow.array(values)), path)
    with pytest.raises(UsageError, match="episode e4: velocity is not finite at sample 7"):
        run("--data", str(copy))


def test_the_inflated_score_of_random_windows_stands_beside(run, tmp_path):
    run("--model", "mlp-baseline", "--out", "n.npz", "--leaked", "--epochs", "2")
    facts = read_artefact(tmp_path / "n.npz").facts
    # All test windows have their neighbours in training, and the episodes of 160 samples overlap.
    assert 0.0 < facts["leaked_rmse_Nm"] < facts["validation_rmse_Nm"]
    assert facts["split"]["protocol"] == "trajectory"
    strides = ("--model", "mlp-baseline", "--out", "m.npz", "--leaked", "--stride", "16")
    run(*strides, "--epochs", "1")
    assert read_artefact(tmp_path / "m.npz").facts["leaked_rmse_Nm"] > 0.0


def test_ctrl_c_ends_a_real_process_with_130_and_its_checkpoint_knows_its_epochs(folder, tmp_path):
    arguments = [sys.executable, "-m", "cqdd_design", "torque", "train", "--data", str(folder)]
    arguments += ["--model", "mlp-baseline", "--batch", "16", "--out", "n.npz", "--device", "cpu"]
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    process = subprocess.Popen(
        [*arguments, "--epochs", "2000", "--patience", "0"],
        cwd=tmp_path,
        env=environment,
        stderr=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        text=True,
    )
    assert process.stderr is not None
    for line in process.stderr:
        if "epoch 2 of 2000" in line:
            break
    process.send_signal(signal.SIGINT)
    told = process.stderr.read()
    assert process.wait(60) == 130, told
    assert "add --resume" in told
    assert "Traceback" not in told
    kept = read_checkpoint(tmp_path / "n.checkpoint.npz")
    assert kept.identity["epochs"] == 2000
    assert kept.epoch == len(kept.log) >= 2
