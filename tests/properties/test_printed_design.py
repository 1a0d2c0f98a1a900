"""What the printed actuator asks for: drawn cups, an inner ring, a named output bearing."""

from __future__ import annotations

from pathlib import Path

import pytest

from cqdd_design.catalog import find_bearing
from cqdd_design.design import load_design
from cqdd_design.errors import GeometryError
from cqdd_design.gearbox.contact import laws
from cqdd_design.geometry.runners import pin_runner
from cqdd_design.machine import resolve

PRINTED = load_design(Path(__file__).parents[2] / "designs" / "printed-13.toml")


def test_two_drawn_cups_side_by_side_share_the_load() -> None:
    """HK 0509 is 9 mm wide, the disc 25 mm: two of them, each under half of the force."""
    runner = pin_runner(PRINTED)
    assert runner is not None
    assert runner.is_drawn_cup
    assert (runner.rows, runner.length) == (2, pytest.approx(18e-3))
    assert runner.wall == pytest.approx(1e-3)
    cup, force = find_bearing("needle HK0509"), 500.0
    alone = laws.needle_coefficient(cup.needles) * (0.5 * force) ** 0.9
    assert resolve(PRINTED).contact.sleeve_coefficient * force**0.9 == pytest.approx(alone)


def test_drawn_cups_are_parts_of_their_own_without_a_sleeve() -> None:
    named = {part.name: part for part in resolve(PRINTED).parts}
    assert "pin sleeve" not in named
    cup = named["pin needle bearing"]
    assert len(cup.instances) == 2 * 8
    assert cup.designation == "needle HK0509"


def test_a_cup_that_the_catalogue_lacks_is_refused_with_the_nearest() -> None:
    wider = PRINTED.replacing({"reducer.output_pins.sleeve_diameter": "9.5 mm"})
    with pytest.raises(GeometryError, match=r"nearest is 'needle HK0509' of 5 mm x 9 mm x 9 mm"):
        pin_runner(wider)


def test_needles_run_on_the_inner_ring() -> None:
    """A 12 mm shaft under an HK1522 of 15 mm: the needles are those of 15 mm."""
    combined, alone = find_bearing("needle HK1522 on IR12x15x22.5"), find_bearing("needle HK1522")
    assert combined.bore_diameter == pytest.approx(12e-3)
    assert combined.needles == alone.needles
    assert not any("eccentric itself" in told for told in resolve(PRINTED).analysis.warnings)
    bare = PRINTED.replacing({"reducer.cam_bearing.designation": "needle HK1522"})
    assert any("eccentric itself" in told for told in resolve(bare).analysis.warnings)


def test_the_output_bearing_is_the_one_named() -> None:
    assert resolve(PRINTED).seats[1].bearing.designation == "6710"
    auto = PRINTED.replacing({"reducer.carrier_bearing.designation": "auto"})
    assert resolve(auto).seats[1].bearing.designation != "6710"


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("6806", "bore of 30 mm, and the pins in the carrier plate need"),
        ("6820", "the housing has room for"),
        ("needle HK3016", "does not guide a carrier"),
    ],
)
def test_an_output_bearing_that_does_not_fit_is_refused(name: str, words: str) -> None:
    named = PRINTED.replacing({"reducer.carrier_bearing.designation": name})
    with pytest.raises(GeometryError, match=words):
        _ = resolve(named).seats


def test_the_drawn_machine_weighs_what_the_built_one_does() -> None:
    """1.35 kg (the thesis) within 12 %: no driver, cables and second output bearing are drawn."""
    assert resolve(PRINTED).inertia.mass == pytest.approx(1.35, rel=0.12)
