"""Other ways to a design: the better one by what the whole verdict says is taken."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from cqdd_design.design import requirements_from_mapping
from cqdd_design.errors import InfeasibleError
from cqdd_design.sizing import rivals
from cqdd_design.sizing.looks import loosened
from cqdd_design.sizing.no_nearer import size_or_refuse
from cqdd_design.sizing.rivals import _figure, _ways, or_better
from cqdd_design.sizing.verified import _too_heavy, new_hunt, searched

ROAD = "cqdd_design.sizing.verified."

ASKED = {
    "ratio": 10,
    "peak_torque": "46 N*m",
    "continuous_torque": "7.9 N*m",
    "input_speed": "300 rpm",
}


def verdict(*, meets: str = "yes", **figures: float) -> Any:
    return SimpleNamespace(
        meets=meets, headline=[SimpleNamespace(id=key, value=one) for key, one in figures.items()]
    )


def design(mass: float, goal: str = "mass", derived: frozenset[str] = frozenset()) -> Any:
    objective = SimpleNamespace(mass=mass, goal=goal)
    made = SimpleNamespace(
        reducer=SimpleNamespace(ring=SimpleNamespace(outer_diameter=0.1 * mass), pack_length=0.016),
        requirements=SimpleNamespace(continuous_torque=6.5),
    )
    inertia = SimpleNamespace(gearbox_reflected=1e-5 * mass)
    sized = SimpleNamespace(
        objective=objective, design=made, machine=SimpleNamespace(inertia=inertia)
    )
    found = SimpleNamespace(sized=sized, space=SimpleNamespace(fit="close"), weak=())
    return SimpleNamespace(
        sizing=SimpleNamespace(objective=objective, seconds=20.0, design=made),
        found=found,
        derived=derived,
        verdict=verdict(mass=1.0 + mass, efficiency=0.8 - mass, backlash_p95=10.0 * mass),
    )


def hunt_that_hoped(for_mass: float) -> Any:
    hunt = new_hunt(requirements_from_mapping(ASKED), lambda _: None, None, None, "mass")
    hunt.hoped = for_mass
    return hunt


@pytest.fixture
def searches(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Hunts that were searched; the first ends without a design, the second with 0.31 kg."""
    done: list[Any] = []

    def searched(hunt: Any, _: object) -> Any:
        done.append(hunt)
        if len(done) == 1:
            raise InfeasibleError("nothing")
        return design(0.31)

    monkeypatch.setattr(rivals, "searched", searched)
    monkeypatch.setattr(rivals, "given", lambda _, one: one)
    monkeypatch.setattr(rivals, "with_sound_plate", lambda one: one)
    monkeypatch.setattr(rivals, "judge", lambda _: pytest.fail("is judged twice"))
    monkeypatch.setattr(rivals, "result_of", lambda *_: "result")
    monkeypatch.setattr(
        rivals, "verified", lambda _, found, sizing, judged, __: (found, sizing, judged)
    )
    return done


def test_what_ends_near_what_it_began_with_is_left_alone(searches: list[Any]) -> None:
    requirements = requirements_from_mapping(ASKED)
    for first in (design(0.3), design(0.3, derived=frozenset({"peak_torque"}))):
        assert or_better(hunt_that_hoped(0.25), first, requirements, "mass") is first
    # Each search would end with a torque of its own.
    free = design(0.5, derived=frozenset({"peak_torque"}))
    assert or_better(hunt_that_hoped(0.25), free, requirements, "mass") is free
    assert not searches


def test_what_ends_far_from_it_is_held_against_others(searches: list[Any]) -> None:
    requirements = requirements_from_mapping(ASKED)
    found: Any = or_better(hunt_that_hoped(0.25), design(0.45), requirements, "mass")
    assert found[0].sized.objective.mass == 0.31
    assert [one.goal for one in searches] == ["backlash", "mass"]
    # Each is for any design, and for none as heavy as the one that there is.
    assert all(one.any_will_do and one.best_alone for one in searches)
    assert [one.lighter_than for one in searches] == [0.45, 0.45]


def test_a_search_for_a_lighter_design_ends_where_it_finds_none(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Before anything is looked at that costs time."""
    hunt = hunt_that_hoped(0.25)
    assert not _too_heavy(hunt, design(0.3).found)
    hunt.lighter_than = 0.3
    assert _too_heavy(hunt, design(0.3).found)
    assert not _too_heavy(hunt, design(0.29).found)
    hunt.any_will_do = hunt.best_alone = True
    monkeypatch.setattr(ROAD + "promising", lambda _: first)
    monkeypatch.setattr(ROAD + "motor_far_short", lambda *_: ())
    monkeypatch.setattr(ROAD + "learn", lambda *_: pytest.fail("is looked at"))
    first = design(0.3).found
    first.rated, first.weak = True, ()
    first.sized.machine = None
    first.space = SimpleNamespace(fit=None)
    first.sized.design = SimpleNamespace(requirements=hunt.requirements)
    with pytest.raises(InfeasibleError):
        searched(hunt, hunt.requirements)


def test_what_is_no_better_does_not_take_its_place(searches: list[Any]) -> None:
    first = design(0.3105, goal="efficiency")
    found = or_better(hunt_that_hoped(0.25), first, requirements_from_mapping(ASKED), "mass")
    assert len(searches) == 2
    assert found is first


def test_what_changes_on_the_way_is_judged_anew(
    searches: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rivals, "given", lambda *_: design(0.3).found)
    requirements, first = requirements_from_mapping(ASKED), design(0.45)
    for meets, mass in (("no", 0.45), ("yes", 0.3)):
        searches.clear()
        monkeypatch.setattr(rivals, "judge", lambda _, meets=meets: verdict(mass=1.3, meets=meets))
        found: Any = or_better(hunt_that_hoped(0.25), first, requirements, "mass")
        sized = found.found.sized if found is first else found[0].sized
        assert sized.objective.mass == mass


def test_a_gearbox_that_has_no_room_or_a_weak_shaft_is_no_rival(
    searches: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    weak = design(0.3).found
    weak.weak = (object(),)
    for one in (None, weak):
        searches.clear()
        monkeypatch.setattr(rivals, "given", lambda *_, one=one: one)
        first = design(0.45)
        found = or_better(hunt_that_hoped(0.25), first, requirements_from_mapping(ASKED), "mass")
        assert found is first


def test_a_rival_holds_as_much_for_ever(searches: list[Any]) -> None:
    stated = {key: one for key, one in ASKED.items() if key != "continuous_torque"}
    first = design(0.45, derived=frozenset({"continuous_torque"}))
    or_better(hunt_that_hoped(0.25), first, requirements_from_mapping(stated), "mass")
    assert [one.requirements.continuous_torque for one in searches] == [6.5, 6.5]


def test_other_goals_always_have_rivals() -> None:
    ways = {
        goal: _ways(hunt_that_hoped(0.25), design(0.25, goal=goal), goal)
        for goal in ("mass", "inertia", "backlash", "efficiency", "size")
    }
    assert ways == {
        "mass": (),
        "inertia": ("backlash", "size"),
        "backlash": ("size",),
        "efficiency": ("backlash", "size"),
        "size": ("backlash",),
    }


def test_where_narrow_bearings_were_left_out_they_are_looked_for_without_the_loose_one(
    searches: list[Any],
) -> None:
    """A cooler gearbox may hold its bell on as thin a shaft."""
    hunt, requirements = hunt_that_hoped(0.3), requirements_from_mapping(ASKED)
    first = design(0.33)
    assert or_better(hunt, first, requirements, "mass") is first
    assert not searches
    hunt.loose.add("6902")
    assert _ways(hunt, design(0.31), "mass") == ()
    or_better(hunt, first, requirements, "mass")
    assert [(one.goal, one.too_warm) for one in searches] == [("mass", {"6902"})]


def test_a_bearing_in_which_a_bell_came_loose_is_noted(monkeypatch: pytest.MonkeyPatch) -> None:
    looks = "cqdd_design.sizing.looks."
    monkeypatch.setattr(looks + "judged_temperatures", lambda _: (None, (), None))
    monkeypatch.setattr(looks + "stronger_shaft", lambda *_: None)
    hunt, found = hunt_that_hoped(0.3), SimpleNamespace(cam="6902")
    for status, noted in (("pass", set()), ("fail", {"6902"})):
        line = SimpleNamespace(status=status)
        monkeypatch.setattr(looks + "bell_line", lambda *_, line=line: line)
        assert loosened(hunt, found, SimpleNamespace()) == bool(noted)  # type: ignore[arg-type]
        assert hunt.loose == noted


def test_less_of_every_figure_is_better() -> None:
    light, heavy = design(0.3), design(0.4)
    for goal in ("mass", "inertia", "backlash", "efficiency", "size"):
        small, large = (_figure(one.found, one.verdict, goal) for one in (light, heavy))
        assert 0.0 < small < large, goal


@pytest.mark.deep
def test_a_search_that_went_astray_is_mended_by_a_rival() -> None:
    """0.45 kg of discs, ring and bearings were found for 46 N m, where 0.34 bear 48."""
    found = size_or_refuse(requirements_from_mapping(ASKED))
    assert found.verdict.meets == "yes"
    assert found.sizing.objective.goal == "mass"
    assert found.sizing.objective.mass < 0.32
    assert found.sizing.design.requirements.peak_torque == 46.0
    inertia = found.sizing.machine.inertia
    assert inertia.whole_mass is not None
    assert inertia.whole_mass < 1.78
