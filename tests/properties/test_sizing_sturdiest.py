"""The strongest gearboxes, judged where a search finds none and some were nearly sound."""

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace

import pytest

from cqdd_design.design import requirements_from_mapping
from cqdd_design.machine import Machine
from cqdd_design.sizing import sturdiest
from cqdd_design.sizing.agreement import agreed
from cqdd_design.sizing.finish import torque_reserve
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.search import Search
from cqdd_design.sizing.spaces import FITS, MATERIALS, Found, Space
from cqdd_design.sizing.stage_tables import stage_tables

ASKED = requirements_from_mapping(
    {
        "ratio": 10,
        "peak_torque": "40 N*m",
        "continuous_torque": "6 N*m",
        "length": "20 mm",
        "disc_count": 2,
    }
)
RING = "CONTACT-RING-PEAK"


@pytest.fixture(scope="module")
def light() -> Found:
    """The lightest of perfect parts."""
    space = Space(2, MATERIALS[1], MATERIALS[1], FITS[0], cam="6803")
    found = agreed(new_hunt(), space, None)
    assert found is not None
    return found


def new_hunt() -> Hunt:
    return Hunt(ASKED, None, None, lambda _: None, stage_tables(10), "mass", usual={})


def reserve(hunt: Hunt, machine: Machine) -> float:
    """Of the ring's teeth at the peak."""
    rigid = replace(machine, stiff=True)
    (line,) = [one for one in hunt.held_against(rigid)[1] if one.id == RING]
    return torque_reserve(line, machine.design)


def short(light: Found, share: float) -> Hunt:
    """A hunt that knows that enough of its gearboxes bear a share of the torques."""
    hunt = new_hunt()
    hunt.nearly[light.cam] = share
    hunt.ask_extra(light.cam, {RING: reserve(hunt, light.sized.machine) / share})
    return hunt


def judging(
    monkeypatch: pytest.MonkeyPatch, meets: Callable[[Machine], str], step: float = 0.0
) -> list[Machine]:
    """Machines that are judged, what the verdict says of them, and the clearance they ask for."""
    seen: list[Machine] = []

    def judge(machine: Machine) -> object:
        seen.append(machine)
        evidence = SimpleNamespace(temperatures=None, machine=machine, drawn=())
        return SimpleNamespace(meets=meets(machine), lines=(), evidence=evidence)

    every = sturdiest.strong_kinds
    monkeypatch.setattr(sturdiest, "strong_kinds", lambda *space: every(*space)[:2])
    monkeypatch.setattr(sturdiest, "judge", judge)
    monkeypatch.setattr(sturdiest, "look", lambda hunt, machine: (None, None))
    monkeypatch.setattr(sturdiest, "last_look", lambda hunt, machine: None)
    monkeypatch.setattr(sturdiest, "read_spread", lambda *_: step)
    return seen


def clearance(machine: Machine) -> float:
    return machine.design.reducer.output_pins.hole_clearance


@pytest.mark.deep
def test_the_strongest_are_judged_with_less_clearance_first(
    light: Found, monkeypatch: pytest.MonkeyPatch
) -> None:
    hunt = short(light, 0.9)
    # A narrower bearing may have a shaft that is strong enough for all that.
    hunt.fit, hunt.least_bore = FITS[1], 1.0
    seen = judging(monkeypatch, lambda _: "no")
    assert sturdiest.strong_and_sound(hunt) is None
    bearings = [one.design.reducer.cam_bearing.designation for one in seen]
    assert bearings[::2] == bearings[1::2]
    assert len(set(bearings)) == len(bearings) // 2 > 1
    both = [one.hole_clearance for one in FITS[:2]]
    assert [clearance(one) for one in seen] == both * (len(seen) // 2)
    asked = hunt.extra_of[light.cam][RING]
    reserves = [reserve(hunt, one) for one in seen]
    assert reserves[0] == max(reserves) > 1.1 * asked
    assert min(reserves) > 0.89 * asked
    assert hunt.fit == FITS[1]


@pytest.mark.deep
def test_what_looks_at_one_ask_for_does_not_count_for_the_next(
    light: Found, monkeypatch: pytest.MonkeyPatch
) -> None:
    hunt = short(light, 0.9)
    hunt.fit = FITS[1]
    seen = judging(monkeypatch, lambda _: "no")

    def last_look(hunt: Hunt, machine: Machine) -> None:
        hunt.ask_extra(machine.design.reducer.cam_bearing.designation, {RING: 100.0})

    monkeypatch.setattr(sturdiest, "last_look", last_look)
    before = {cam: dict(asked) for cam, asked in hunt.extra_of.items()}
    assert sturdiest.strong_and_sound(hunt) is None
    assert hunt.extra_of == before
    assert [clearance(one) for one in seen[:2]] == [one.hole_clearance for one in FITS[:2]]


def test_the_first_that_is_sound_is_taken(light: Found, monkeypatch: pytest.MonkeyPatch) -> None:
    seen = judging(monkeypatch, lambda _: "yes" if len(seen) == 2 else "no")
    answer = sturdiest.strong_and_sound(short(light, 0.9))
    assert answer is not None
    assert answer[0].sized.machine.design == seen[1].design
    assert len(seen) == 2


def test_a_bearing_of_which_no_reserve_is_known_is_nearly_sound_too(
    light: Found, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Hunts that learn apart share what was nearly sound: size at ratio 7, yield 0.99, crashed."""
    hunt = short(light, 0.9)
    hunt.nearly["needle cage K8x11x8"] = 0.95
    seen = judging(monkeypatch, lambda _: "yes")
    assert sturdiest.strong_and_sound(hunt) is not None
    assert len(seen) == 1


@pytest.mark.deep
def test_one_that_jams_is_judged_again_with_more_clearance(
    light: Found, monkeypatch: pytest.MonkeyPatch
) -> None:
    def meets(machine: Machine) -> str:
        return "yes" if clearance(machine) > FITS[0].hole_clearance else "no"

    hunt = short(light, 0.9)
    seen = judging(monkeypatch, meets, step=1e-6)
    answer = sturdiest.strong_and_sound(hunt)
    assert answer is not None
    assert [clearance(one) for one in seen] == [one.hole_clearance for one in FITS[:2]]
    assert hunt.fit == FITS[0]


def test_what_rigid_parts_ask_for_is_given_before_bodies_are_meshed(
    light: Found, monkeypatch: pytest.MonkeyPatch
) -> None:
    hunt = short(light, 0.9)
    seen = judging(monkeypatch, lambda _: "yes")
    looked: list[tuple[float, bool]] = []

    def look(_: Hunt, machine: Machine) -> tuple[None, float | None]:
        looked.append((clearance(machine), machine.stiff))
        return None, 1e-6 if clearance(machine) == FITS[0].hole_clearance else None

    monkeypatch.setattr(sturdiest, "look", look)
    assert sturdiest.strong_and_sound(hunt) is not None
    roomier = FITS[1].hole_clearance
    assert looked == [(FITS[0].hole_clearance, True), (roomier, True), (roomier, False)]
    assert [clearance(one) for one in seen] == [roomier]


@pytest.mark.parametrize(("borne", "asked"), [(0.85, False), (0.95, True)])
def test_few_gearboxes_turn_away_what_is_far_from_sound_alone(
    light: Found, monkeypatch: pytest.MonkeyPatch, borne: float, asked: bool
) -> None:
    def last_look(hunt: Hunt, machine: Machine) -> float:
        hunt.borne = (1.0, borne)
        return 0.0

    seen = judging(monkeypatch, lambda _: "no")
    monkeypatch.setattr(sturdiest, "last_look", last_look)
    assert sturdiest.strong_and_sound(short(light, 0.9)) is None
    assert bool(seen) is asked


@pytest.mark.parametrize("share", [0.6, None])
def test_where_none_was_nearly_sound_none_is_judged(
    light: Found, monkeypatch: pytest.MonkeyPatch, share: float | None
) -> None:
    judging(monkeypatch, lambda _: "yes")
    hunt = new_hunt() if share is None else short(light, share)
    assert sturdiest.strong_and_sound(hunt) is None


def test_torques_that_nobody_stated_are_lowered_instead(
    light: Found, monkeypatch: pytest.MonkeyPatch
) -> None:
    judging(monkeypatch, lambda _: "yes")
    hunt = short(light, 0.9)
    hunt.requirements = hunt.requirements.deriving("peak_torque")
    assert sturdiest.strong_and_sound(hunt) is None


def test_closed_forms_learn_what_they_lack_at_the_strongest() -> None:
    asked = {"peak_torque": "6.5 N*m", "continuous_torque": "1.1 N*m"}
    space = {"outer_diameter": "47 mm", "length": "11 mm"}
    takes = {RING: 5.1, "CONTACT-RING-CONTINUOUS": 5.8, "BEARING-LIFE": 3.1, "BEARING-STATIC": 2.1}
    wanted = requirements_from_mapping({"ratio": 29, **asked, **space})
    hunt = Hunt(wanted, None, None, lambda _: None, stage_tables(29), "mass", usual=takes)
    tried = sturdiest.stronger(hunt, Space(2, MATERIALS[1], MATERIALS[1], FITS[3], cam="6801"))
    reserves = [one.reserve(hunt) for one in tried]
    assert reserves[-1] > 1.3 * reserves[0]
    assert reserves[-1] >= 0.98 * max(reserves)


def test_of_designs_as_strong_the_one_with_most_pins_is_taken() -> None:
    asked = requirements_from_mapping({"ratio": 20, "peak_torque": "20 N*m"})
    hunt = Hunt(asked, None, None, lambda _: None, stage_tables(20), "mass", usual={RING: 3.0})
    space = Space(2, MATERIALS[1], MATERIALS[1], FITS[2], cam="6802")
    search = Search.of(hunt.frame(space, {}), hunt.tables)
    few = search.most_reserve()
    assert few is not None
    many = sturdiest.most_reserve(search, few)
    assert many is not None
    assert many.pin_count[0] > few.pin_count[0]
    assert 0.97 * few.reserve[0] <= many.reserve[0] < few.reserve[0]
