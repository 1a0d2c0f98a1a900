"""Numbers of long searches that the disk keeps: what was found, and of nothing else."""

from __future__ import annotations

from pathlib import Path

import pytest

from cqdd_design.design import load_design
from cqdd_design.errors import DesignError
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.temperatures import MachineTemperatures, judged_temperatures
from cqdd_design.verdict.remembered import remembered

DESIGN = Path(__file__).parents[2] / "designs" / "cqdd-10.toml"


Judged = tuple[Machine, MachineTemperatures]


@pytest.fixture
def judged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Judged:
    """A machine and its temperatures; from now on an empty folder of what is kept."""
    machine = resolve(load_design(DESIGN))
    warm, _, _ = judged_temperatures(machine)
    assert warm is not None
    monkeypatch.setenv("CQDD_DESIGN_CACHE", str(tmp_path))
    return machine, warm


def test_a_search_is_not_done_twice_and_another_start_searches_anew(judged: Judged) -> None:
    machine, warm = judged
    asked: list[float] = []

    def find(value: float = 7.123456789012345) -> float:
        asked.append(value)
        return value

    first = remembered("torque", machine, (*warm.steady, 1.5, True), find)
    assert (
        remembered("torque", machine, (*warm.steady, 1.5, True), find) == first == 7.123456789012345
    )
    assert len(asked) == 1
    other = resolve(machine.given.replacing({"drive.thermal_resistance": 1.25}))
    for what, of, given in (
        ("cooling", machine, (*warm.steady, 1.5, True)),
        ("torque", machine, (*warm.steady, 1.5, False)),
        ("torque", machine, (*(warm.steady + 1e-6), 1.5, True)),
        ("torque", other, (*warm.steady, 1.5, True)),
    ):
        before = len(asked)
        assert remembered(what, of, given, lambda: find(2.0)) == 2.0
        assert len(asked) == before + 1


def test_what_raises_is_not_kept(judged: Judged) -> None:
    machine, _ = judged

    def none() -> float:
        raise DesignError("not known")

    with pytest.raises(DesignError):
        remembered("torque", machine, (), none)
    assert remembered("torque", machine, (), lambda: 3.0) == 3.0
