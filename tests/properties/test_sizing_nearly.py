"""What is tried beside a design that is nearly sound, where no other bears what part errors ask."""

from dataclasses import replace

import pytest

from cqdd_design.design import requirements_from_mapping
from cqdd_design.sizing.agreement import agreed
from cqdd_design.sizing.finish import torque_reserve
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.nearly import _most_reserve, nearly_again, note_nearly
from cqdd_design.sizing.search import Search
from cqdd_design.sizing.spaces import FITS, MATERIALS, Found, Space
from cqdd_design.sizing.stage_tables import stage_tables

ASKED = requirements_from_mapping(
    {"ratio": 10, "peak_torque": "40 N*m", "continuous_torque": "6 N*m", "length": "20 mm"}
)
RING = "CONTACT-RING-PEAK"


def nothing() -> None:
    return None


@pytest.fixture(scope="module")
def light() -> Found:
    """The lightest of perfect parts."""
    space = Space(2, MATERIALS[1], MATERIALS[1], FITS[0], cam="6803")
    found = agreed(new_hunt(), space, None)
    assert found is not None
    return found


def new_hunt() -> Hunt:
    return Hunt(ASKED, None, None, lambda _: None, stage_tables(10), "mass", usual={})


def short(light: Found, share: float) -> Hunt:
    """A hunt that has just looked at it, of whose gearboxes enough bear a share of the torques."""
    hunt = new_hunt()
    hunt.borne, hunt.had = (share, 1.0), {RING: reserve(hunt, light)}
    hunt.ask_extra(light.cam, {RING: reserve(hunt, light) / share})
    note_nearly(hunt, light)
    return hunt


def reserve(hunt: Hunt, found: Found) -> float:
    """Of the ring's teeth at the peak."""
    machine = replace(found.sized.machine, stiff=True)
    (line,) = [one for one in hunt.held_against(machine)[1] if one.id == RING]
    return torque_reserve(line, machine.design)


def test_the_strongest_are_tried_once_with_less_clearance_and_as_many_pins(light: Found) -> None:
    hunt = short(light, 0.9)
    hunt.fit = FITS[1]
    first = nearly_again(hunt, nothing)
    assert first is not None
    assert hunt.sturdy
    assert hunt.fit == first.space.fit == FITS[0]
    assert reserve(hunt, first) > 1.1 * hunt.extra_of[light.cam][RING]
    others = len(hunt.sturdy)
    # One that is short itself is not begun at again.
    hunt.borne = 0.99, 1.0
    note_nearly(hunt, first)
    every = [first, *(nearly_again(hunt, nothing) for _ in range(others))]
    assert len({one.cam for one in every}) == len(every) == others + 1
    assert nearly_again(hunt, nothing) is None
    assert hunt.nearly[light.cam].had == {RING: reserve(hunt, light)}


def test_of_designs_as_strong_the_one_with_most_pins_is_taken() -> None:
    asked = requirements_from_mapping({"ratio": 20, "peak_torque": "20 N*m"})
    hunt = Hunt(asked, None, None, lambda _: None, stage_tables(20), "mass", usual={RING: 3.0})
    space = Space(2, MATERIALS[1], MATERIALS[1], FITS[2], cam="6802")
    search = Search.of(hunt.frame(space, {}), hunt.tables)
    few = search.most_reserve()
    assert few is not None
    many = _most_reserve(search, few)
    assert many is not None
    assert many.pin_count[0] > few.pin_count[0]
    assert 0.97 * few.reserve[0] <= many.reserve[0] < few.reserve[0]


def test_part_of_what_it_lacks_is_asked_for_and_all_of_it_where_that_finds_nothing(
    light: Found,
) -> None:
    hunt = short(light, 0.8)
    hunt.sturdy = []
    had, lacked = hunt.had[RING], hunt.extra_of[light.cam][RING]
    asked: list[float] = []
    found = iter([None, light])

    def search() -> Found | None:
        asked.append(hunt.extra_of[light.cam][RING])
        return next(found, None)

    assert nearly_again(hunt, search) is light
    assert had < asked[1] < asked[0] < lacked
    assert nearly_again(hunt, nothing) is None
    assert hunt.extra_of[light.cam][RING] == asked[1]


@pytest.mark.parametrize("share", [0.6, 0.0])
def test_what_is_far_from_sound_is_left(light: Found, share: float) -> None:
    hunt = new_hunt()
    hunt.borne = (share, 1.0) if share else None
    note_nearly(hunt, light)
    assert not hunt.nearly
    assert nearly_again(hunt, lambda: light) is None


def test_torques_that_nobody_stated_are_lowered_instead(light: Found) -> None:
    hunt = short(light, 0.9)
    hunt.requirements = hunt.requirements.deriving("peak_torque")
    assert nearly_again(hunt, lambda: light) is None
