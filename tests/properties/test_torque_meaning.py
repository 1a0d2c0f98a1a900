"""What a network's torque is: on the load, filtered, in the range of its labels; told in files."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import numpy as np
import pytest
from actuator_samples import paper_actuator
from torque_networks import PV, network
from torque_samples import data_set

from cqdd_design.actuator.scenario import Command, Constant, Load, Scenario
from cqdd_design.actuator.simulate import simulate
from cqdd_design.exporting.estimators.c_header import header_text
from cqdd_design.exporting.estimators.export import export_artefact
from cqdd_design.exporting.estimators.options import metadata
from cqdd_design.torque.data.sensing import Filter, SensorChain
from cqdd_design.torque.networks.artefact import Artefact, read_artefact, write_artefact
from cqdd_design.torque.networks.meaning import label_facts, meaning

NETWORKS = Path(__file__).resolve().parents[2] / "designs" / "cqdd-10-torque"
SIMULATED = {"source": "simulated", "design": "a-joint"}
LABELS = {
    "label_range_Nm": [-142.0, 120.0],
    "speed_range_rad_per_s": [-13.0, 14.0],
    "signals_filter": {"filter_frequency_Hz": 60.0, "filter_damping_ratio": 0.7},
}
ZEROS = {"armature": 0.0, "damping": 0.0, "friction": 0.0}


def told_by(**facts: object) -> Artefact:
    return network("mlp", inputs=PV, facts=facts)


def words(text: str) -> str:
    return " ".join(text.replace("\n *", " ").split())


def test_labels_are_the_torque_on_the_load() -> None:
    """An inertia on the flange is moved by all of it: nothing of the actuator's is left to take."""
    load = Load(inertia=0.2)
    run = simulate(
        paper_actuator(), Scenario(Command("torque", Constant(10.0)), load), 0.2, 2e-5, every=5
    )
    rise = np.gradient(run.output_speed[0], run.time)
    felt = load.inertia * rise
    late = run.time > 0.05
    assert run.output_torque[0][late].mean() == pytest.approx(felt[late].mean(), rel=1e-3)
    assert run.commanded_torque[0][late].mean() > 1.2 * felt[late].mean()


def test_of_simulated_data_the_joint_has_nothing_besides() -> None:
    found = meaning(told_by(data=SIMULATED))
    assert found.joint == ZEROS
    assert "armature, damping and friction of the joint to 0" in found.joint_told
    # Files that do not say passed the filter that all simulated data pass.
    assert found.passed == Filter() == SensorChain().filter
    assert "80 Hz" in found.filter_told
    assert "3.98 ms" in found.filter_told


def test_every_committed_network_says_so() -> None:
    for path in sorted(NETWORKS.rglob("*.npz")):
        found = meaning(read_artefact(path))
        assert found.joint == ZEROS, path
        assert found.passed == Filter(), path


def test_numbers_of_a_file_from_elsewhere_stay_finite() -> None:
    slow = {"filter_frequency_Hz": 1e-310, "filter_damping_ratio": 1.0}
    wide = {name: [-1e308, 1e308] for name in ("label_range_Nm", "speed_range_rad_per_s")}
    told = told_by(data=SIMULATED, signals_filter=slow, **wide)
    assert meaning(told).envelope == {}
    assert json.dumps(metadata(told, "window") | {"facts": {}}, allow_nan=False)


@pytest.mark.parametrize(
    ("data", "on_load", "said"),
    [
        ({"source": "logs", "torque_from": "current"}, False, "needs its armature"),
        ({"source": "logs", "torque_from": "torque"}, None, "If that was between actuator and"),
        ({}, None, "does not say where"),
    ],
)
def test_of_logs_it_is_what_their_owner_measured(
    data: dict[str, str], on_load: bool | None, said: str
) -> None:
    found = meaning(told_by(data=data))
    assert (found.on_load, found.joint, found.passed) == (on_load, None, None)
    assert said in found.joint_told
    assert "as they were" in found.filter_told


def test_the_c_header_says_it_and_has_the_labels_range() -> None:
    text = header_text(told_by(data=SIMULATED, **LABELS), "net")
    head = words(text[: text.index("*/")])
    own = meaning(told_by(data=SIMULATED, **LABELS))
    assert own.joint_told in head
    assert own.filter_told in head
    assert "60 Hz, damping ratio 0.7" in head
    assert "torque -142 to 120 N m, of the training's labels" in head
    assert "#define NET_TORQUE_LEAST (-142.0f)" in text
    assert "#define NET_TORQUE_MOST (120.0f)" in text
    assert all(len(line) <= 100 for line in text[: text.index("*/")].splitlines())
    of_design = {**SIMULATED, "design_sha256": "c0ffee" * 8, "design": "a */ joint"}
    kept = words(header_text(told_by(data=of_design), "net"))
    assert "it was trained on, that of a - joint (sha256 c0ffeec0)" in kept
    old = words(header_text(told_by(data=SIMULATED), "net"))
    assert "torque -90 to 90 N m, limit of the actuator; the labels' own range is not" in old


def test_metadata_say_it() -> None:
    told = metadata(told_by(data=SIMULATED, **LABELS), "window")
    assert told["joint"] == ZEROS
    assert told["torque_range_Nm"] == [-142.0, 120.0]
    assert told["torque_limit_Nm"] == [-90.0, 90.0]
    assert told["filter_frequency_Hz"] == 60.0
    assert told["filter_delay_s"] == pytest.approx(0.7 / (np.pi * 60.0))
    assert json.loads(json.dumps(told, allow_nan=False)) == told
    assert metadata(told_by(), "window")["filter_delay_s"] is None


def test_the_envelope_leaves_labels_alone_at_every_speed_of_the_training() -> None:
    """By the line of Isaac Lab's DCMotor, which mjlab shares."""
    limits = meaning(told_by(**LABELS)).envelope
    top, fastest = limits["saturation_effort"], limits["velocity_limit"]
    assert limits["effort_limit"] == 142.0
    for speed in np.linspace(-14.0, 14.0, 41):
        highest = min(top * (1.0 - speed / fastest), limits["effort_limit"])
        lowest = max(top * (-1.0 - speed / fastest), -limits["effort_limit"])
        assert lowest <= -142.0 + 1e-9
        assert highest >= 142.0 - 1e-9
    assert meaning(told_by()).envelope == {}


def test_clients_configurations_hold_it(tmp_path: Path) -> None:
    pytest.importorskip("torch")
    export_artefact(
        told_by(data=SIMULATED, **LABELS), ["torchscript-isaaclab", "mjlab"], tmp_path, "net"
    )
    for ending, names in (
        ("isaaclab-mlp", ("armature", "friction", "dynamic_friction", "viscous_friction")),
        ("mjlab", ("armature", "frictionloss", "viscous_damping")),
    ):
        told = json.loads((tmp_path / f"net-{ending}.json").read_text())
        own = told["configuration"]
        assert {own[name] for name in names} == {0.0}
        assert own["effort_limit"] == 142.0
        assert "stiffness" not in own
        assert "count twice" in told["torque_is"]
    export_artefact(told_by(), ["mjlab"], tmp_path / "logs", "net")
    bare = json.loads((tmp_path / "logs" / "net-mjlab.json").read_text())["configuration"]
    assert not {"armature", "effort_limit"} & set(bare)


def test_a_training_writes_down_what_is_read(tmp_path: Path) -> None:
    data = data_set()
    sensors = SensorChain(filter=Filter(70.0, 0.9)).to_dict(1000.0, 14, 10.0)
    made = dataclasses.replace(data, facts={"source": "simulated", "sensors": sensors})
    some = data.episodes[:3]
    facts = label_facts(made, some)
    labels = np.concatenate([one.columns["torque"] for one in some])
    assert facts["label_range_Nm"] == [labels.min(), labels.max()]
    path = tmp_path / "net.npz"
    write_artefact(told_by(data=SIMULATED, **facts), path)
    found = meaning(read_artefact(path))
    assert found.passed == Filter(70.0, 0.9)
    assert found.labels == (labels.min(), labels.max())
    logs = {"source": "logs", **Filter(80.0).to_dict(), "filtered_logs": ["a.csv"]}
    filtered = label_facts(dataclasses.replace(data, facts=logs), some)
    assert filtered["signals_filter"] == {"filter_frequency_Hz": 80.0, "filter_damping_ratio": 1.0}
    as_they_were = dataclasses.replace(data, facts=logs | {"filtered_logs": []})
    assert label_facts(as_they_were, some)["signals_filter"] is None
