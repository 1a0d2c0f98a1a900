"""What gives way up to a torque, without a search of all that gives way beyond."""

from __future__ import annotations

from pathlib import Path

import pytest

from cqdd_design.design import load_design
from cqdd_design.machine import resolve
from cqdd_design.machine.carrying import carried_torque, carried_up_to

DESIGNS = Path(__file__).resolve().parents[2] / "designs"


def test_it_is_what_a_search_of_every_limit_says_and_no_more() -> None:
    machine = resolve(load_design(DESIGNS / "reference-s.toml"))
    every = carried_torque(machine)
    first, second, *_ = every.limits
    assert carried_up_to(machine, 0.9 * first.torque).limits == ()
    between = 0.5 * (first.torque + second.torque)
    assert carried_up_to(machine, between).limits == (first,)
    assert first.torque < 0.97 * second.torque
    beyond = carried_up_to(machine, 1e5)
    assert [one.check for one in beyond.limits] == [one.check for one in every.limits]
    assert [one.torque for one in beyond.limits] == pytest.approx(
        [one.torque for one in every.limits]
    )
    assert beyond.unknown == every.unknown
