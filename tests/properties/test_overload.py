"""What a gearbox does not carry of what its actuator gives, told wherever it is let."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from actuator_samples import paper_actuator

from cqdd_design.design import Design, load_design
from cqdd_design.exporting.simulators.actuator_card import actuator_card, card_markdown, card_yaml
from cqdd_design.exporting.simulators.bam import bam_document
from cqdd_design.exporting.simulators.mjcf import fragment_text, model_text
from cqdd_design.exporting.simulators.mjcf_classes import MjcfActuator
from cqdd_design.exporting.simulators.stated import overload_remark
from cqdd_design.exporting.simulators.urdf import urdf_text
from cqdd_design.library.simulating import simulate
from cqdd_design.machine import resolve
from cqdd_design.machine.carrying import carried_torque
from cqdd_design.machine.overload import Overload, overload
from cqdd_design.roads.export import export, left_out
from cqdd_design.torque.data.generate import Request, generate

PAPER = load_design(Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml")
BEYOND = Overload(80.0, 35.6, "the gearbox does not carry it: static rating from 35.6 N*m")


def words(text: str) -> str:
    return " ".join(text.split())


def test_it_is_where_the_first_part_gives_way() -> None:
    machine = resolve(PAPER)
    first = carried_torque(machine).limits[0]
    found = overload(machine, 3.0 * first.torque)
    assert found is not None
    assert found.carried == pytest.approx(first.torque)
    assert first.words in found.told
    assert overload(machine, 0.9 * first.torque) is None


def test_every_file_of_a_simulator_says_so() -> None:
    p, told = paper_actuator(), overload_remark(BEYOND)
    assert "80 N*m" in told
    assert "35.6 N*m" in told
    model = MjcfActuator(p, "paper", beyond=BEYOND)
    texts = [
        urdf_text(p, "paper", beyond=BEYOND),
        model_text(model),
        fragment_text(model),
        card_markdown(actuator_card(p, "paper", beyond=BEYOND)),
        card_yaml(actuator_card(p, "paper", beyond=BEYOND)),
    ]
    assert all(told in words(text) for text in texts)
    assert "carried_Nm: 35.6" in texts[-1]
    document: dict[str, Any] = json.loads(json.dumps(bam_document(p, "paper", beyond=BEYOND)))
    assert told in document["_notes"]
    assert document["_limits"]["gearbox_carries_Nm"] == 35.6
    assert overload_remark(None) == ""
    assert "does not carry" not in urdf_text(p, "paper")


def test_files_and_console_say_the_same(tmp_path: Path) -> None:
    (told,) = left_out(PAPER, "urdf")
    sentence = told.partition(": motor")[2]
    assert "does not carry it" in sentence
    export(PAPER, "urdf", tmp_path)
    assert f"Motor{sentence}" in words((tmp_path / "cqdd-10.urdf").read_text())


def test_a_gearbox_that_carries_all_is_not_warned_of(tmp_path: Path) -> None:
    weak = PAPER.replacing({"motor": {"current_limit": "1 A"}})
    assert isinstance(weak, Design)
    assert left_out(weak, "urdf") == ()
    export(weak, "urdf", tmp_path)
    assert "does not carry" not in (tmp_path / "cqdd-10.urdf").read_text()


def test_a_simulation_beyond_it_is_told() -> None:
    hard = simulate(PAPER, load="locked", amplitude="30 N*m", duration="0.1 s")
    (told,) = [one for one in hard.warnings if "torque in the gearbox" in one]
    assert "pins in their holes from 3.13 N*m" in told
    soft = simulate(PAPER, load="locked", amplitude="1 N*m", duration="0.1 s")
    assert not [one for one in soft.warnings if "torque in the gearbox" in one]


def test_data_beyond_it_are_told_and_say_so() -> None:
    request = Request(episodes=1, seconds=0.5, unit_gearboxes=0, held_mass=None)
    data, warnings = generate(resolve(PAPER), request)
    (told,) = [one for one in warnings if "torque on the load reaches" in one]
    beyond = data.facts["beyond_gearbox"]
    assert beyond["carried_Nm"] == pytest.approx(3.13, abs=0.01)
    assert beyond["told"] in told
    assert json.dumps(data.facts["beyond_gearbox"])
