"""What clearances cost and save, from small ensembles."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cqdd_design.design import load_design
from cqdd_design.gearbox.life.fatigue import contact_cycle_factor
from cqdd_design.gearbox.tolerance import clearance
from cqdd_design.gearbox.tolerance.clearance import HOLE_SHARES, clearance_study
from cqdd_design.gearbox.tolerance.ensemble import make_ensemble
from cqdd_design.gearbox.tolerance.limits import lasting_hours, lasting_pressure, limits
from cqdd_design.gearbox.tolerance.run import run_ensemble
from cqdd_design.machine import resolve
from cqdd_design.report.gearbox.tolerances import tolerance_view

DESIGNS = Path(__file__).resolve().parents[2] / "designs"


def test_points_are_the_ensembles_of_their_designs() -> None:
    design = resolve(load_design(DESIGNS / "cqdd-10.toml")).design
    points = clearance_study(design, 4, 88)
    (own,) = (point for point in points if point.own)
    found = run_ensemble(make_ensemble(design, angles=88), 4, sensitivity=False)
    told = found.statistics()
    assert (own.equidistant, own.hole_clearance) == (6e-6, 16e-6)
    assert own.backlash == told["backlash_arcmin"]["mean"]
    assert own.stiffness == told["stiffness_Nm_per_arcmin"]["mean"]
    assert own.reserve == pytest.approx(found.pressure_reserve()["p50"])
    assert own.binding == found.beyond()["unloaded_torque_Nm"]
    backlash = np.array([point.backlash for point in points]).reshape(len(HOLE_SHARES), -1)
    # More of either clearance is more backlash, but for next to nothing of what binds; less of them
    # binds more gearboxes.
    assert np.all(np.diff(backlash, axis=0) >= -0.05)
    assert np.all(np.diff(backlash, axis=1) >= -0.05)
    binding = np.array([point.binding for point in points]).reshape(backlash.shape)
    assert np.all(np.diff(binding, axis=0) <= 0.0)
    view = tolerance_view(found, points)
    assert len(view["clearances"]) == len(points)
    assert len(view["clearance_figures"]) == 2
    # The sentence follows the table, whichever way its hours go.
    assert view["longest"] == "", "no hour anywhere"
    rising = [replace(point, hours=10.0 + k) for k, point in enumerate(points)]
    for told, best in ((rising, points[-1]), (rising[::-1], points[-1])):
        longest = tolerance_view(found, told)["longest"]
        assert f"offset of {1e6 * best.equidistant:g}\u202f\u00b5m" in longest
        assert f"hole clearance of {1e6 * best.hole_clearance:g}\u202f\u00b5m" in longest
    even = [replace(point, hours=10.0) for point in points]
    assert tolerance_view(found, even)["longest"] == ""


def test_gearboxes_of_the_own_clearances_are_not_worked_twice(monkeypatch) -> None:
    """The first of those that are known are, to the bit, those that would be drawn."""
    design = resolve(load_design(DESIGNS / "cqdd-10.toml")).design
    known = run_ensemble(make_ensemble(design, angles=44), 6, sensitivity=False)
    alone = clearance_study(design, 3, 44)
    worked = []

    def counted(ensemble, samples, **how):
        worked.append(ensemble.design)
        return run_ensemble(ensemble, samples, **how)

    monkeypatch.setattr(clearance, "run_ensemble", counted)
    assert clearance_study(design, 3, 44, known=known) == alone
    assert len(worked) == len(alone) - 1
    other = run_ensemble(make_ensemble(design, angles=88), 6, sensitivity=False)
    assert clearance_study(design, 3, 44, known=other) == alone
    assert len(worked) == 2 * len(alone) - 1


def test_a_point_without_an_equilibrium_says_so() -> None:
    design = resolve(load_design(DESIGNS / "cqdd-10.toml")).design
    heavy = {"requirements.peak_torque": 5e3, "requirements.continuous_torque": 5e3}
    points = clearance_study(design.replacing(heavy), 2, 44)
    assert all(point.missing for point in points)


def test_limits_are_those_of_the_required_hours() -> None:
    """The reference design: 944 MPa at 1e7 contacts; 1000 h at 1286 rpm are 8.5e7, 899 MPa."""
    design = resolve(load_design(DESIGNS / "reference-s.toml")).design
    pressure = lasting_pressure(design)
    met = 1286.0 * 60.0 * 1000.0 * 11.0 / 10.0
    assert met == pytest.approx(8.5e7, rel=0.01)
    assert pressure == pytest.approx(943.7e6 * float(contact_cycle_factor(met)), rel=1e-3)
    assert pressure == pytest.approx(899e6, rel=2e-3)
    assert lasting_hours(design, pressure) == pytest.approx(1000.0, rel=1e-9)
    assert limits(design)["unloaded_torque_Nm"] == pytest.approx(0.05 * 34.2)
