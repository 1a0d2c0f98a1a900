"""The committed networks: what their files say, and that they score what the page says.

Regenerate with the commands of docs/torque-estimation.md.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from cqdd_design.torque.networks.artefact import Artefact, read_artefact

REPOSITORY = Path(__file__).resolve().parents[2]
NETWORKS = REPOSITORY / "designs" / "cqdd-10-torque"
MODELS = (
    "mlp",
    "mlp-acceleration",
    "mlp-baseline",
    "phase-gru",
    "physics-gru",
    "physics-phase-gru",
    "pv-gru",
    "pva-gru",
)
SCORES = {"physics-phase-gru-0": 6.84, "physics-gru-0": 6.89, "pva-gru-0": 6.78, "mlp-0": 6.78}
"""RMSE on held-out trajectories of today's twin, which is another actuator than theirs, N m."""


def networks() -> dict[str, Artefact]:
    return {path.stem: read_artefact(path) for path in sorted(NETWORKS.glob("*.npz"))}


def test_every_file_says_how_it_was_made():
    found = networks()
    assert sorted(found) == sorted(f"{model}-{seed}" for model in MODELS for seed in (0, 1, 2))
    found["streaming"] = read_artefact(NETWORKS / "streaming" / "pva-gru-0.npz")
    for name, network in found.items():
        facts = network.facts
        assert facts["command"].startswith("cqdd-design torque train --data exports/"), name
        assert not re.search(r"(?<![\w.])/\w", facts["command"]), name
        assert facts["data_sha256"] == found["mlp-0"].facts["data_sha256"]
        assert facts["split"] == found["mlp-0"].facts["split"]
        assert facts["log"][facts["best_epoch"] - 1]["validation_rmse_Nm"] == pytest.approx(
            facts["validation_rmse_Nm"]
        )
        assert network.validity.dt == 0.005
        if name != "streaming":
            assert name == f"{network.name}-{facts['seed']}"
        streams = name.startswith("physics") or name == "streaming"
        assert network.mode == ("streaming" if streams else "window")


@pytest.mark.deep
def test_they_score_what_the_page_says(cqdd, tmp_path):
    pytest.importorskip("pyarrow")
    from cqdd_design.torque.data.episodes import read_data
    from cqdd_design.torque.evaluation.estimator import network_estimator

    designs = REPOSITORY / "designs"
    made = cqdd(
        *("torque", "generate", designs / "cqdd-10.toml", "--out", "data"),
        *("--calibration", designs / "cqdd-10-calibration.json"),
    )
    assert made.code == 0, made.err
    data = read_data(tmp_path / "data")
    found = networks()
    test = data.named(found["mlp-0"].facts["split"]["test"])
    assert len(test) == 64
    for name, wanted in SCORES.items():
        run = network_estimator(found[name])
        errors = [(run.estimate(one) - one.columns["torque"])[29:] for one in test]
        rmse = np.sqrt(np.mean(np.concatenate(errors) ** 2))
        assert rmse == pytest.approx(wanted, rel=0.01), name
