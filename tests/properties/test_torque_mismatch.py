"""Networks keep the actuator that they were trained on, and pay where it is another one."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("pyarrow")

from cqdd_design.design import load_design
from cqdd_design.torque.evaluation.carried import (
    DesignVersion,
    actuator_of,
    carried,
    moved_on,
    trained_on_design,
)
from cqdd_design.torque.evaluation.estimator import network_estimator
from cqdd_design.torque.networks.artefact import read_artefact

REPOSITORY = Path(__file__).resolve().parents[2]
NETWORKS = REPOSITORY / "designs" / "cqdd-10-torque"


@pytest.fixture(scope="module")
def script() -> Any:
    """`benchmarks/torque_mismatch.py` as a module."""
    place = REPOSITORY / "benchmarks" / "torque_mismatch.py"
    spec = importlib.util.spec_from_file_location("torque_mismatch", place)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["torque_mismatch"] = module
    spec.loader.exec_module(module)
    return module


def test_errors_are_of_thirty_per_cent_in_every_sign(script: Any) -> None:
    own = actuator_of([read_artefact(NETWORKS / "physics-gru-0.npz")])
    assert own is not None
    found = dict(script.specimens(own))
    assert [len(found[told]) for told in found] == [1, 2, 2, 2, 8]
    assert found["as carried"] == [own]
    inertia = {one.motor_side_inertia / own.motor_side_inertia for one in found["inertia ±30 %"]}
    assert sorted(inertia) == pytest.approx([0.7, 1.3])
    pairs = {
        (
            round(one.friction.motor_coulomb / own.friction.motor_coulomb, 6),
            round(one.reflected_inertia / own.reflected_inertia, 6),
            round(one.friction.load_forward / own.friction.load_forward, 6),
        )
        for one in found["all three ±30 %"]
    }
    assert len(pairs) == 8
    assert all(part in (0.7, 1.3) for pair in pairs for part in pair)
    assert all(
        one.motor.torque_constant == own.motor.torque_constant for one in found["all three ±30 %"]
    )


def test_a_network_tells_which_actuator_it_keeps(script: Any) -> None:
    network = read_artefact(NETWORKS / "physics-gru-0.npz")
    own = actuator_of([network])
    assert own is not None
    then = trained_on_design(network)
    assert then is not None
    assert moved_on({"a": network}, then, own) == moved_on({"a": network}, None) == ()
    assert f"that of cqdd-10 (sha256 {then.sha256[:8]})" in carried(network)
    heavier = script.changed(own, inertia=1.3)
    (told,) = moved_on({"a": network}, then, heavier)
    assert told.startswith("a keeps the actuator that it was trained on")
    assert "not the one of this design" in told
    assert "motor.rotor_inertia" in told
    assert "friction" not in told.partition(":")[2]
    assert moved_on({"a": read_artefact(NETWORKS / "pva-gru-0.npz")}, then, heavier) == ()


def test_every_committed_network_tells_that_the_design_has_moved_on() -> None:
    """By the digest of the design, which those without an actuator's parameters hold as well."""
    now = load_design(REPOSITORY / "designs" / "cqdd-10.toml")
    version = DesignVersion(now.name, now.sha256)
    networks = {path.stem: read_artefact(path) for path in NETWORKS.rglob("*.npz")}
    (told,) = moved_on(networks, version)
    assert all(name in told for name in networks)
    assert "keep the actuator that they were trained on, that of cqdd-10 (sha256 a87b425d)" in told
    assert f"not of cqdd-10 (sha256 {now.sha256[:8]}): the design has moved on." in told
    assert all("a87b425d" in carried(one) for one in networks.values())


@pytest.mark.deep
def test_errors_of_the_actuator_level_the_networks(script: Any) -> None:
    """Trained alike, the network with physics leads on its own actuator and hardly on others."""
    names = ("streaming/pva-gru-0", "physics-gru-0")
    artefacts = [read_artefact(NETWORKS / f"{name}.npz") for name in names]
    own = actuator_of(artefacts)
    assert own is not None
    plain, physics = (network_estimator(one) for one in artefacts)
    found = dict(script.specimens(own))
    share = {}
    for told in ("as carried", "all three ±30 %"):
        sets = [script.recorded(one, 8) for one in found[told]]
        share[told] = script.rmse(physics, sets)[1] / script.rmse(plain, sets)[1]
    assert share["as carried"] < 0.8
    assert 0.85 < share["all three ±30 %"] < 1.05
