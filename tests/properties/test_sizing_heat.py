"""What is refused for heat: what is not looked for then, and the ratio at which it would fit."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from cqdd_design.design import load_design, requirements_from_mapping
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.heat_nodes import NODES
from cqdd_design.machine.temperatures import undisturbed_temperatures
from cqdd_design.sizing import nearest, verified
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.infeasible import SizingInfeasibleError
from cqdd_design.sizing.ratios import cool_ratio, other_ratio
from cqdd_design.sizing.refusals import far_short, short_of
from cqdd_design.sizing.stage_tables import stage_tables

DESIGN = Path(__file__).resolve().parents[2] / "docs" / "gallery" / "plain-10.toml"
HOT = {"requirements.continuous_torque": 14.0}


def line(name: str, margin: float | None, **more: Any) -> Any:
    """A failing line as a verdict has it; its margin is not known where it is None."""
    known = margin is not None
    told = {"title": name, "substituted": "so much", "remedy": "do better", "value": margin}
    return SimpleNamespace(id=name, known=known, margin=margin, **(told | more))


def hunt(**asked: Any) -> Hunt:
    given = {"ratio": 10, "peak_torque": "30 N*m", "continuous_torque": "4 N*m", **asked}
    requirements = requirements_from_mapping(given)
    return Hunt(requirements, None, None, lambda _: None, stage_tables(10), "mass")


@pytest.fixture(scope="module")
def hot() -> Machine:
    return resolve(load_design(DESIGN)).changed(HOT)


def test_less_current_of_the_winding_is_what_a_ratio_brings(hot: Machine) -> None:
    """Solved anew with the winding's heat of that ratio, parts are cool enough, and not of less."""
    found = undisturbed_temperatures(hot.rigid)
    assert found is not None
    assert found.heat_share > 1.1
    own, cool = hot.design.reducer.ratio, cool_ratio(hot)
    assert own + 1 < cool < 2 * own
    winding = NODES.index("winding")

    def share(ratio: int) -> float:
        heat, less = found.duty.heat, np.ones(len(NODES))
        less[winding] = (own / ratio) ** 2
        at = heat._replace(fixed=heat.fixed * less, slope=heat.slope * less)
        duty = replace(found.duty, heat=at)
        return replace(found, duty=duty, steady=found.network.steady(at)).heat_share

    assert share(own) == pytest.approx(found.heat_share, rel=1e-6)
    assert share(cool + 1) < 1.0 < share(cool - 2)


def test_the_ratio_grows_with_the_torque_and_is_none_where_others_heat(hot: Machine) -> None:
    cold = hot.changed({"requirements.continuous_torque": 1.0})
    assert cool_ratio(cold) <= cold.design.reducer.ratio < cool_ratio(hot)
    hotter = hot.changed({"requirements.continuous_torque": 16.0})
    assert cool_ratio(hotter) > cool_ratio(hot)
    # What its drag alone warms too much no current cools.
    fast = hot.changed({"requirements.continuous_speed": math.radians(6.0) * 1200.0})
    assert cool_ratio(fast) == 0


def test_the_ratio_is_that_of_a_design_short_of_heat_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cqdd_design.sizing.refusals.cool_ratio", lambda _: 13)
    machine: Any = None
    assert short_of([line("THERMAL-RISE", 0.8)], machine).cool_ratio == 13
    assert short_of([line("MOTOR-CONTINUOUS", 0.8)], machine).cool_ratio == 13
    assert short_of([line("MOTOR-PEAK", 0.8)], machine).cool_ratio == 0


@pytest.mark.parametrize(
    ("cool", "fits", "told", "tried"),
    [
        (13, {13}, (13, 13, ()), [13]),
        (13, {16}, (16, 13, ()), [13, 16]),
        (13, {17}, (None, 13, ("THERMAL-RISE",)), [13, 16]),
        # Never less, nor as much.
        (9, {11}, (11, 11, ()), [11]),
        (18, {22}, (None, 18, ("THERMAL-RISE",)), [18]),
        (21, {21}, (None, 10, ()), []),
        (0, {11}, (None, 10, ()), []),
    ],
)
def test_ratios_are_tried_from_the_cool_one_on(
    cool: int, fits: set[int], told: tuple[Any, ...], tried: list[int]
) -> None:
    seen: list[int] = []

    def search(ratio: int) -> tuple[bool, tuple[str, ...]]:
        seen.append(ratio)
        return ratio in fits, () if ratio in fits else ("THERMAL-RISE",)

    short = SizingInfeasibleError("no.", binding=("YIELD",), most_torque=None, cool_ratio=cool)
    assert tuple(other_ratio(hunt(), short, search)) == told
    assert seen == tried


def test_no_further_ratio_is_tried_where_one_is_short_of_other_than_heat() -> None:
    short = SizingInfeasibleError("no.", binding=("YIELD",), most_torque=None, cool_ratio=13)
    seen: list[int] = []

    def search(ratio: int) -> tuple[bool, tuple[str, ...]]:
        seen.append(ratio)
        return False, ("YIELD",)

    other_ratio(hunt(), short, search)
    assert seen == [13]


@pytest.mark.parametrize(
    ("lines", "far"),
    [
        ([line("THERMAL-RISE", 0.7), line("YIELD", 0.2)], ["THERMAL-RISE"]),
        ([line("THERMAL-RISE", 0.9)], []),
        ([line("MOTOR-PEAK", 0.5), line("MASS", 0.8)], ["MOTOR-PEAK"]),
        ([line("EFFICIENCY", 0.8), line("PEAK-AT-SPEED", 0.8)], ["EFFICIENCY", "PEAK-AT-SPEED"]),
        ([line("BACKLASH", 0.2)], []),
        # Another goal may be lighter by as much.
        ([line("REFLECTED-INERTIA", 0.5)], []),
        ([line("MOTOR-CONTINUOUS", None)], []),
        # Parts that press on each other are hot for that.
        ([line("THERMAL-RISE", 0.5), line("THERMAL-CLEARANCE", 0.5)], []),
    ],
)
def test_far_short_is_what_neither_space_nor_strength_helps(
    monkeypatch: pytest.MonkeyPatch, lines: list[Any], far: list[str]
) -> None:
    monkeypatch.setattr("cqdd_design.sizing.refusals.cool_ratio", lambda _: 0)
    machine: Any = None
    assert [one.id for one in far_short(short_of(lines, machine))] == far


@pytest.mark.parametrize(("margin", "searches"), [(0.7, 1), (0.9, 2)])
def test_no_design_is_searched_for_that_would_be_as_far_short(
    monkeypatch: pytest.MonkeyPatch, margin: float, searches: int
) -> None:
    monkeypatch.setattr("cqdd_design.sizing.refusals.cool_ratio", lambda _: 0)
    machine: Any = None
    refusal, seen = short_of([line("THERMAL-RISE", margin)], machine), []

    def search(own: Hunt, _: object) -> None:
        seen.append(own.any_will_do)
        own.left = True
        raise refusal

    monkeypatch.setattr(verified, "_searched", search)
    own = hunt()
    with pytest.raises(SizingInfeasibleError) as caught:
        verified.searched(own, own.requirements)
    assert caught.value is refusal
    assert seen == [False, True][:searches]


@pytest.mark.parametrize("less", [False, True], ids=["no torque fits", "less torque fits"])
@pytest.mark.parametrize(("margin", "looks"), [(0.7, False), (0.9, True)])
def test_no_space_is_looked_for_where_heat_is_far_short(
    monkeypatch: pytest.MonkeyPatch, margin: float, looks: bool, less: bool
) -> None:
    """And a ratio at which it would fit is told, on a line below those of the reasons."""
    monkeypatch.setattr("cqdd_design.sizing.refusals.cool_ratio", lambda _: 12)
    machine: Any = None
    rise = line("THERMAL-RISE", margin)
    refusal = short_of([rise, line("YIELD", 0.9)], machine)
    asked: list[int] = []

    def searched(own: Hunt, _: object) -> Any:
        wanted = own.requirements
        asked.append(wanted.ratio)
        if wanted.ratio == 10 and not (less and wanted.derived):
            raise refusal
        if wanted.derived:
            wanted = wanted.unchecked_copy({"peak_torque": 20.0, "continuous_torque": 3.0})
        return SimpleNamespace(sizing=SimpleNamespace(design=SimpleNamespace(requirements=wanted)))

    spaces: list[str] = []

    def least(*given: Any, **_: Any) -> Any:
        spaces.append(given[2])
        return nearest._Need(None)

    monkeypatch.setattr(nearest, "searched", searched)
    monkeypatch.setattr(nearest, "_least", least)
    with pytest.raises(SizingInfeasibleError) as caught:
        nearest.size_or_nearest(hunt().requirements)
    told = caught.value.to_dict()
    assert told["ratio_needed"] == 12
    assert (told["most_peak_torque_Nm"] is not None) is less
    assert (asked[0], asked[-1]) == (10, 12)
    assert bool(spaces) is looks
    reasons = "- thermal-rise: so much (do better)\n- yield: so much (do better)."
    text = f"the nearest falls short of\n{reasons}\nWhat fits, by the whole verdict: "
    assert text in caught.value.message
    assert caught.value.message.endswith("ratio 12.")
