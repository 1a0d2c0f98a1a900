"""What a design is clearly short of is told before a gearbox of it is drawn, and no more than that.

Searches for more than a gearbox's friction leaves spent minutes on part errors of designs that no
clearance would have helped.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from cqdd_design.design import Design, load_design, requirements_from_mapping
from cqdd_design.design.duty_file import read_duty
from cqdd_design.gearbox.heat.expansion import PartTemperatures
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.heat_nodes import NODES
from cqdd_design.machine.settling import STILL, hottest_part, settle
from cqdd_design.machine.temperatures import (
    machine_temperatures,
    rise_line,
    undisturbed_temperatures,
)
from cqdd_design.results import Check
from cqdd_design.sizing import shafts, verified
from cqdd_design.sizing.foreseen import foreseen
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.stage_tables import stage_tables
from cqdd_design.verdict import judge
from cqdd_design.verdict.headline import efficiency

GALLERY = Path(__file__).resolve().parents[2] / "docs" / "gallery"


@pytest.fixture(scope="module")
def plain() -> Design:
    return load_design(GALLERY / "plain-10.toml")


def told(design: Design) -> list[str]:
    """What is foreseen of a design whose torques were stated."""
    requirements = design.requirements
    hunt = Hunt(requirements, None, None, print, stage_tables(requirements.ratio), "mass")
    found: Any = SimpleNamespace(sized=SimpleNamespace(machine=resolve(design)))
    short = foreseen(hunt, found)
    return [] if short is None else [line.id for line in short.lines]


def test_what_a_verdict_passes_is_not_foreseen(plain: Design) -> None:
    assert told(plain) == []


def test_an_efficiency_is_foreseen_where_it_is_clearly_missed(plain: Design) -> None:
    reached = efficiency(resolve(plain).rigid).value
    assert reached is not None
    for share, short in ((0.97, []), (1.0, []), (1.01, []), (1.03, ["EFFICIENCY"])):
        design = plain.replacing({"requirements.efficiency": share * reached})
        assert told(design) == short
    lines = judge(resolve(design), samples=0).lines
    assert next(line for line in lines if line.id == "EFFICIENCY").status == "fail"
    # Where a torque may be lowered that nobody stated, that comes first.
    hunt = Hunt(
        requirements_from_mapping({"ratio": 10}), None, None, print, stage_tables(10), "mass"
    )
    assert hunt.requirements.derived
    found: Any = SimpleNamespace(sized=SimpleNamespace(machine=resolve(design)))
    assert foreseen(hunt, found) is None


def test_a_search_leaves_such_a_design_before_it_looks_at_part_errors(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    requirements = load_design(GALLERY / "plain-10.toml").requirements
    hunt = Hunt(requirements, None, None, print, stage_tables(10), "mass")

    def design(name: str) -> Any:
        sized = SimpleNamespace(
            objective=SimpleNamespace(goal="mass", score=0.4, mass=0.4),
            machine=name,
            design=SimpleNamespace(name=name),
        )
        known = {"weak": (), "rated": True, "cam": "6803", "worth": (False, 0.4)}
        return SimpleNamespace(**known, sized=sized, name=name)

    first, other = design("first"), design("other")
    short = SimpleNamespace(lines=())
    learnt: list[str] = []

    def learn(_: Hunt, found: Any) -> bool:
        learnt.append(found.name)
        return False

    answers: dict[str, Any] = {
        "promising": first,
        "motor_far_short": (),
        "finer": other,
        "lightest": other,
        "with_sound_plate": other,
        "look": (None, None),
        "last_look": None,
        "eased": None,
        "judge": SimpleNamespace(meets="yes"),
        "result_of": "with alternatives",
        "verified": "a design",
    }
    for name, answer in answers.items():
        monkeypatch.setattr(verified, name, lambda *_, answer=answer, **__: answer)
    monkeypatch.setattr(verified, "drawing_ahead", lambda _: nullcontext())
    monkeypatch.setattr(verified, "learn", learn)
    monkeypatch.setattr(verified, "foreseen", lambda _, one: short if one is first else None)
    monkeypatch.setattr(verified, "with_another_bearing", lambda *_: other)
    assert verified._searched(hunt, requirements) == "a design"
    assert set(learnt) == {"other"}
    assert hunt.left
    # Where no other way leads on either, it is looked at and judged as it is.
    monkeypatch.setattr(verified, "with_another_bearing", lambda *_: None)
    monkeypatch.setattr(verified, "turned", lambda *_: False)
    learnt.clear()
    assert verified._searched(hunt, requirements) == "a design"
    assert learnt[0] == "first"


@pytest.fixture(scope="module")
def three() -> Machine:
    return resolve(load_design(GALLERY / "three-discs-9.toml"))


def test_the_rigid_twin_is_one_and_drawn_once(three: Machine) -> None:
    _ = three.parts, three.inertia
    assert three.rigid is three.rigid
    assert three.rigid.rigid is three.rigid
    assert three.rigid.stiff
    assert three.rigid.design == three.design
    assert three.rigid.parts is three.parts
    warm = three.at(PartTemperatures.even(60.0))
    assert warm.parts is three.parts
    # Contacts are those of rigid bodies, and of warm parts.
    assert three.rigid.contact.bodies is None
    assert warm.contact is not three.contact


@pytest.fixture(scope="module")
def logged(tmp_path_factory: pytest.TempPathFactory) -> Machine:
    path = tmp_path_factory.mktemp("duty") / "steps.csv"
    path.write_text("t [s],torque [N*m],speed [rad/s]\n0,8,2\n4,2,3\n8,8,2\n")
    design = load_design(GALLERY / "plain-10.toml")
    stated = design.replacing({"requirements.duty_file": "steps.csv"})
    return resolve(stated.with_duty_log(read_duty(path)))


def test_parts_that_go_on_losing_what_they_do_as_drawn_need_no_settling(
    three: Machine, logged: Machine
) -> None:
    for machine in (three.rigid, logged.rigid):
        short, whole = undisturbed_temperatures(machine), machine_temperatures(machine).undisturbed
        assert short is not None
        assert [short.hottest(node) for node in NODES] == [whole.hottest(node) for node in NODES]
        assert rise_line(short).value == rise_line(whole).value


def test_a_look_stops_where_parts_are_too_hot_to_come_back(three: Machine) -> None:
    """A verdict tells how hot; a search asks only whether."""
    looks: dict[bool, list[float]] = {True: [], False: []}
    network = machine_temperatures(three.rigid).network
    as_drawn = machine_temperatures(three.rigid).as_drawn

    def lost(machine: Machine, _: float) -> Any:
        # Ten times as much for every hundred kelvin: heat runs away.
        assert machine.temperatures is not None
        warm = 10.0 ** ((machine.temperatures.disc - network.ambient) / 100.0)
        looks[machine.stiff].append(machine.temperatures.disc)
        heat = as_drawn.heat
        return replace(as_drawn, heat=heat._replace(fixed=8.0 * warm * heat.fixed))

    for machine in (three.rigid, three):
        _, steady = settle(machine, network, lost, STILL)
        assert hottest_part(steady) > 200.0
    assert len(looks[True]) < len(looks[False])
    assert np.all(np.diff(looks[True]) > 0.0)


def failing(line: Check, share: float) -> Check:
    assert line.limit is not None
    return replace(line, value=share * line.limit)


def test_the_bond_decides_with_its_own_temperatures_where_it_is_in_doubt(
    three: Machine, monkeypatch: pytest.MonkeyPatch
) -> None:
    line = shafts.bell_line(three, None)
    asked: list[str] = []

    def temperatures(machine: str) -> None:
        asked.append(machine)

    monkeypatch.setattr(shafts, "undisturbed_temperatures", temperatures)
    shares: Iterator[float]
    for given, gives_way, looks in (
        ((2.0,), True, ["like"]),
        ((0.5,), False, ["like"]),
        ((0.98, 1.02), True, ["like", "own"]),
        ((1.02, 0.98), False, ["like", "own"]),
    ):
        shares = iter(given)
        monkeypatch.setattr(shafts, "bell_line", lambda *_, s=shares: failing(line, next(s)))
        asked.clear()
        assert shafts._gives_way("own", "like") is gives_way  # type: ignore[arg-type]
        assert asked == looks
