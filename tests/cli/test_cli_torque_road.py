"""From a design to a network that knows its gearbox, by the program itself, one command after
another."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

pytest.importorskip("torch")
pytest.importorskip("onnx")
pytest.importorskip("pyarrow")

from cqdd_design.torque.data.episodes import read_data
from cqdd_design.torque.networks.artefact import read_artefact

DESIGNS = Path(__file__).resolve().parents[2] / "designs"
DESIGN, CALIBRATION = DESIGNS / "cqdd-10.toml", DESIGNS / "cqdd-10-calibration.json"


@pytest.mark.deep
def test_a_network_that_corrects_its_own_actuator(cqdd, tmp_path):
    data = ("--data", "data")
    made = cqdd(
        *("torque", "generate", str(DESIGN), "--calibration", str(CALIBRATION), "--out", "data"),
        *("--episodes", "12", "--seconds", "2", "--unit-gearboxes", "1"),
    )
    assert made.code == 0, made.err
    facts = read_data(tmp_path / "data").facts
    trained = cqdd(
        *("torque", "train", *data, "--model", "physics-phase-gru", "--mode", "streaming"),
        *("--epochs", "2", "--design", str(DESIGN), "--out", "net.npz", "--quiet"),
    )
    assert trained.code == 0, trained.err
    network = read_artefact(tmp_path / "net.npz")
    assert network.inputs[3:] == ("balance", "friction_sign", "ripple")
    assert network.mode == "streaming"
    own = network.facts["actuator"]
    # Drawn and calibrated as the data say, which nobody had to repeat.
    assert own["drive"]["position_gain"] == 60.0
    assert facts["training_gearbox"] == 1
    fitted = json.loads(CALIBRATION.read_text())["unknowns"]["motor_cogging"]["value"]
    assert own["motor"]["cogging_amplitude"] == pytest.approx(fitted)
    # What drags on the input at every load is the motor's own.
    assert own["motor"]["coulomb"] > 0.05
    scored = cqdd(
        *("torque", "evaluate", *data, "--model", "net.npz", "--rollouts", "0", "--draws", "100"),
        *("--set", "trajectory,gearbox", "--json"),
    )
    assert scored.code == 0, scored.err
    results = json.loads(scored.out)["results"]
    told = results["sets"]["trajectory"]["models"]["physics-phase-gru"]
    assert told["rmse_Nm"] > 0.0
    # Its ripple stands at the homed position, so a joint that was not homed is told apart.
    assert told["unknown_phase"]["rmse_Nm"] != told["rmse_Nm"]
    assert {"physics", "current"} <= set(results["sets"]["trajectory"]["models"])
    kinds = "onnx,c" if shutil.which("cc") else "onnx"
    written = cqdd("torque", "export", "net.npz", "--to", kinds, "--out", "files")
    assert written.code == 0, written.err
    refused = cqdd("torque", "export", "net.npz", "--to", "newton", "--out", "more")
    assert refused.code == 2
    assert "actuator's parameters" in refused.err
    assert not (tmp_path / "more").exists()
