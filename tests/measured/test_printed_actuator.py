"""Play, stiffness and friction of the printed actuator: read off its records, and predicted."""

from __future__ import annotations

import math
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from cqdd_design.actuator.bench.readings import read_loop
from cqdd_design.errors import UsageError
from cqdd_design.torque.data.log_files import read_columns

PLAY_WITHIN, COMPLIANCE_WITHIN = 0.08, 0.07
"""Of the thesis' own readings: they are worst met by 7 and by 6 %."""


def _told(page: ModuleType) -> list[Any]:
    """Specimens whose readings the thesis prints."""
    return [one for one in page.SPECIMENS if not math.isnan(one.play)]


def test_play_is_read_as_the_thesis_reads_it(page: ModuleType) -> None:
    for one in _told(page):
        found = math.degrees(page.mean(page.loops(one.record, page.SMALL), "play"))
        assert found == pytest.approx(one.play, rel=PLAY_WITHIN), one.title


def test_loaded_branches_are_read_as_the_thesis_reads_them(page: ModuleType) -> None:
    for one in _told(page):
        large = page.loops(one.record, page.LARGE)
        found = math.degrees(page.mean(large, "compliance"))
        assert found == pytest.approx(one.compliance, rel=COMPLIANCE_WITHIN), one.title


def test_loops_go_as_far_as_they_were_asked(page: ModuleType) -> None:
    """To 25 N m with the baseline and 40 with the conic discs, the driver's noise apart."""
    for one in page.SPECIMENS:
        peaks = [each.peak for each in page.loops(one.record, page.LARGE)]
        assert peaks == pytest.approx([40.0 if one.conic else 25.0] * len(peaks), rel=0.04)


def test_a_preload_takes_play_and_costs_friction(page: ModuleType) -> None:
    """What the thesis is about, in its own records."""
    conic = [one for one in page.SPECIMENS if one.conic]
    plays = [page.mean(page.loops(one.record, page.SMALL), "play") for one in conic]
    assert np.all(np.diff(plays) < 0.0)
    assert np.all(np.diff([one.coulomb for one in conic]) > 0.0)


def test_friction_without_load_is_predicted_within_forty_percent(page: ModuleType) -> None:
    """Of PC-CF; nothing is fitted."""
    for one in page.SPECIMENS[:2]:
        found = page.predicted_friction(one.material).coulomb
        assert found == pytest.approx(one.coulomb, rel=0.40), one.title


def test_most_of_that_friction_is_the_motors(page: ModuleType) -> None:
    machine = page.machine_of(page.SPECIMENS[0].material)
    motor = 13.0 * page.motor_of(machine).dry_drag
    assert motor / page.predicted_friction(page.SPECIMENS[0].material).coulomb > 0.9


def test_onyx_rubs_more_than_is_predicted(page: ModuleType) -> None:
    """A known miss: its parts press, which no drawing tells. It must not close unseen."""
    ratio = page.predicted_friction(page.SPECIMENS[2].material).coulomb
    ratio /= page.measured_friction().coulomb
    assert 0.3 < ratio < 0.6


def test_loaded_branches_are_predicted_too_stiff(page: ModuleType) -> None:
    """A known miss, 2.4 times for PC-CF: docs/measured.md has the reasons. The goal was 1.3."""
    for one in page.SPECIMENS[:2]:
        found = page.predicted(one.material)
        measured = 1.0 / page.mean(page.loops(one.record, page.LARGE), "compliance")
        assert 2.0 < found.read(page.largest(found)).stiffness / measured < 2.8, one.title


@pytest.mark.deep
def test_with_the_measured_play_the_moduli_lie_on_either_side(page: ModuleType) -> None:
    """One clearance taken from the play: along the layers too stiff, across them too soft."""
    measured = 1.0 / page.mean(page.loops(page.SPECIMENS[0].record, page.LARGE), "compliance")
    play = page.mean(page.loops(page.SPECIMENS[0].record, page.SMALL), "play")
    base = page.machine_of(page.SPECIMENS[0].material)
    found = [page.solved(base.changed(page.LOOSE | more), 25.0) for more in ({}, page.ACROSS)]
    along, across = (one.read(page.largest(one)).stiffness / measured for one in found)
    assert found[0].read(4.0).play == pytest.approx(play, rel=0.03)
    assert 1.2 < along < 1.6
    assert 0.6 < across < 0.95


def test_the_page_shows_what_the_records_say(page: ModuleType, repository: Path) -> None:
    told = (repository / "docs" / "measured.md").read_text(encoding="utf-8")
    assert page.read_table() in told


def test_a_torn_record_is_refused_with_its_line(page: ModuleType, tmp_path: Path) -> None:
    own = (page.RECORDS / "ramp-baseline-pccf-initial-1.csv").read_text(encoding="utf-8")
    lines = own.splitlines()
    torn = tmp_path / "torn.csv"
    torn.write_text("\n".join([*lines[:40], lines[40][:9]]) + "\n", encoding="utf-8")
    with pytest.raises(UsageError, match="line 41: "):
        read_columns(torn, ("POSITION", "TORQUE"))
    table = read_columns(
        page.RECORDS / "ramp-baseline-pccf-initial-1.csv", ("CONTROL_TORQUE", "TORQUE", "POSITION")
    )
    with pytest.raises(UsageError, match="up to a peak, down to a negative one"):
        read_loop(*(values[:100] for values in table.values()))
