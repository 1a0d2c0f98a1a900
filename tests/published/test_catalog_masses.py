"""Masses of bought parts: what the machine counts is what their catalogues print."""

from __future__ import annotations

from pathlib import Path

import pytest

from cqdd_design.catalog.bearings import find_bearing
from cqdd_design.catalog.cap_screws import cap_screw_mass, cap_screw_masses
from cqdd_design.design import load_design
from cqdd_design.machine import Machine, resolve
from cqdd_design.solids.carrier import cap_screw_shape
from cqdd_design.solids.selection import cap_screw

DESIGNS = Path(__file__).resolve().parents[2] / "designs"


@pytest.fixture(scope="module")
def machine() -> Machine:
    return resolve(load_design(DESIGNS / "cqdd-10.toml"))


@pytest.mark.parametrize(
    ("thread", "length", "grams"),
    [(2, 5, 0.195), (3, 8, 0.8), (3, 10, 0.9), (4, 16, 2.3), (6, 20, 6.5), (8, 30, 16.9)],
)
def test_cap_screws_weigh_what_the_chart_prints(thread: int, length: int, grams: float) -> None:
    """Weight chart of DIN 912 of a dealer (fullerkr.com), in kg for 1000."""
    assert 1e3 * (cap_screw_mass(1e-3 * thread, 1e-3 * length) or 0.0) == pytest.approx(grams)


def test_screws_as_drawn_weigh_more_by_their_threads_and_edges() -> None:
    """A shank at its thread's diameter, a head without chamfers: 9 to 30 %, of M2 half as much."""
    for row in cap_screw_masses():
        drawn = 7850.0 * cap_screw_shape(cap_screw(row.thread, row.length)).volume
        assert 1.05 < drawn / row.mass < (1.32 if row.thread > 2.1e-3 else 1.55), row


def test_bearings_screws_and_motor_count_as_their_catalogues_say(machine: Machine) -> None:
    parts = {part.name: part for part in machine.parts}
    for name in ("cam bearing", "output bearing"):
        row = find_bearing(parts[name].designation)
        assert parts[name].mass == pytest.approx(row.mass, rel=1e-12)
    assert parts["cover screw"].mass == pytest.approx(0.9e-3, rel=1e-12)
    motor = sum(parts[name].mass for name in ("motor stator", "motor rotor", "rotor bell"))
    assert motor == pytest.approx(0.525, rel=1e-9)
    every = sum(part.mass * part.count for part in machine.parts)
    assert machine.inertia.total.mass == pytest.approx(every, rel=1e-9)
    assert machine.inertia.mass == pytest.approx(every, rel=1e-9)
