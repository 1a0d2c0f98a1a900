"""The search behind `calibrate`: it ends with bounded values or a sentence, whatever the rows."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cqdd_design.actuator.bench.calibrate import calibrate, chosen
from cqdd_design.actuator.bench.fitting import CLOSE, _searched, fit
from cqdd_design.actuator.bench.run import VOLTAGE, run_bench
from cqdd_design.actuator.bench.unknowns import TELLS, UNKNOWNS, Fit, apply_factors
from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.catalog.paper import METRICS
from cqdd_design.design import Design, load_design
from cqdd_design.errors import UsageError
from cqdd_design.machine import resolve
from cqdd_design.roads import calibrate as road

PAPER = Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml"
MEASURED = {name: METRICS[name].value for name in TELLS if name != "torque_ripple"}
TRIPLES = sorted(itertools.combinations(MEASURED, 3))
CHEAP = [("continuous_torque", "backdrive_static", "backdrive_dynamic")]


class Made:
    """Misses in closed form, of which a part of the range cannot be measured."""

    def __init__(self, matrix: np.ndarray, root: np.ndarray, wall: float) -> None:
        self.matrix, self.root, self.wall = matrix, root, wall

    def at(self, logarithms: np.ndarray) -> np.ndarray:
        if logarithms[0] > self.wall:
            return np.full(len(self.matrix), math.log(200.0))
        off = logarithms - self.root
        return self.matrix @ (off + 0.1 * np.tanh(off))

    def slopes(self, logarithms: np.ndarray, most: np.ndarray) -> np.ndarray:
        steps = 0.02 * np.eye(len(logarithms))
        here = self.at(logarithms)
        return np.array([(self.at(logarithms - one) - here) / -0.02 for one in steps]).T


@settings(max_examples=30, deadline=None)
@given(
    st.lists(st.floats(-3.0, 3.0), min_size=3, max_size=3),
    st.lists(st.floats(-0.25, 0.25), min_size=9, max_size=9),
)
def test_the_search_finds_what_is_there_and_stays_in_its_range(
    root: list[float], mixed: list[float]
) -> None:
    matrix = np.eye(3) + np.array(mixed).reshape(3, 3)
    made: Any = Made(matrix, np.array(root), max(root[0] + 0.3, 0.1))
    found = _searched(made, np.zeros(3), np.full(3, -4.0), np.full(3, 4.0))
    assert np.abs(made.at(found)).max() < CLOSE
    short = _searched(made, np.zeros(3), np.full(3, -1.0), np.full(3, 1.0))
    assert np.all(np.abs(short) <= 1.0)


@pytest.fixture(scope="module")
def actuator() -> ActuatorParameters:
    return actuator_parameters(resolve(load_design(PAPER)))


@pytest.mark.parametrize(
    "rows",
    [
        *CHEAP,
        *(pytest.param(one, marks=pytest.mark.deep) for one in TRIPLES if one not in CHEAP),
    ],
    ids=",".join,
)
def test_any_three_rows_end_bounded_or_with_a_sentence(
    actuator: ActuatorParameters, rows: tuple[str, ...]
) -> None:
    targets = {row: MEASURED[row] for row in rows}
    names = tuple(TELLS[row] for row in rows)
    found: dict[str, float] = {}
    said = ""
    try:
        found = fit(actuator, targets, names, VOLTAGE)
    except UsageError as error:
        said = error.message
    if not found:
        assert any(name in said for name in (*names, *rows))
        assert said.endswith(".")
        return
    for name, value in found.items():
        least, most = UNKNOWNS[name].bounds(actuator)
        assert least * (1.0 - 1e-9) <= value <= most * (1.0 + 1e-9)
    changed = apply_factors(actuator, Fit(found, rows))
    friction = changed.friction
    held = friction.load_backward * (1.0 + friction.stribeck_extra)
    assert held < 1.0 or not {"backdrive_static", "backdrive_dynamic"} & set(rows)
    result = run_bench(changed, only=rows)
    for metric in result.metrics:
        assert metric.value == pytest.approx(MEASURED[metric.name], rel=CLOSE)
        assert metric.relation == "calibrated"


def test_what_cannot_be_measured_is_a_sentence(actuator: ActuatorParameters) -> None:
    """A ripple that nothing changes, because the parts are perfect and stay so."""
    with pytest.raises(UsageError, match=r"cannot calibrate to what cannot be measured: .*coher"):
        fit(actuator, {"torque_bandwidth": 300.0}, ("thermal_resistance",), VOLTAGE)


def test_what_is_far_out_of_reach_is_told_with_what_is_nearest(
    actuator: ActuatorParameters,
) -> None:
    """Past two hundred times the nearest too."""
    said = []
    for wanted in (1e3, 1e6):
        with pytest.raises(UsageError, match="nearest that was found is") as caught:
            fit(actuator, {"continuous_torque": wanted}, ("thermal_resistance",), VOLTAGE)
        said.append(caught.value.message.partition("nearest")[2])
    assert len(set(said)) == 1
    with pytest.raises(UsageError, match=r"no thermal_resistance from .* gives continuous_torque"):
        fit(actuator, {"continuous_torque": 1e-6}, ("thermal_resistance",), VOLTAGE)


def test_wrong_rows_are_refused_before_anything_is_built(monkeypatch: pytest.MonkeyPatch) -> None:
    def built(*_: object, **__: object) -> None:
        raise AssertionError("a machine was built")

    monkeypatch.setattr("cqdd_design.actuator.specimen.resolve", built)
    design: Design = load_design(PAPER)
    for rows, says in (
        (("backdrive_statc",), "did you mean 'backdrive_static'"),
        (("mass",), "decides no unknown of its own"),
    ):
        with pytest.raises(UsageError, match=says):
            road.calibrate(design, to=rows)
    with pytest.raises(UsageError, match="is no unknown"):
        road.calibrate(design, to=("mass",), unknowns=("frction_load",))
    with pytest.raises(UsageError, match="cannot decide 2"):
        chosen({"mass": 1.0}, ["mass", "mass"], ["friction_load", "thermal_resistance"])


@pytest.mark.deep
def test_rows_without_a_value_are_none_in_the_calibration(actuator: ActuatorParameters) -> None:
    """The bench reads no torque bandwidth of this actuator: neither number nor agreement."""
    found = calibrate(
        actuator, {"continuous_torque": 30.0, "torque_bandwidth": 34.3}, to=["continuous_torque"]
    )
    row = {row.name: row for row in found.rows}["torque_bandwidth"]
    assert row.before is row.after is row.off is None
    assert row in found.predicted
    assert row not in found.within
