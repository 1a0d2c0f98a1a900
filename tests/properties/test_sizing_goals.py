"""What searches make small, by closed forms, beside the models that judge it."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from cqdd_design.design import Design, load_design
from cqdd_design.machine import resolve
from cqdd_design.sizing.goals import Sizes, backlash_angle
from cqdd_design.sizing.spaces import FITS
from cqdd_design.verdict.drawn import drawn_gearboxes

ARCMIN = 180.0 * 60.0 / np.pi
CHANGES: dict[str, dict[str, object]] = {
    "eight pins": {"reducer.output_pins.count": 8},
    "four pins": {"reducer.output_pins.count": 4},
    "wider": {
        "reducer.output_pins.hole_clearance": FITS[3].hole_clearance,
        "reducer.modification.equidistant": FITS[3].equidistant,
    },
    "one disc": {"reducer.disc_count": 1, "reducer.output_pins.count": 4},
}


@pytest.fixture(scope="module")
def designs(paper_design_file) -> dict[str, Design]:
    fit = {
        "reducer.output_pins.hole_clearance": FITS[2].hole_clearance,
        "reducer.modification.equidistant": FITS[2].equidistant,
    }
    base = load_design(paper_design_file)
    return {name: base.replacing(fit | changes) for name, changes in CHANGES.items()}


def closed_form(design: Design) -> float:
    """Arcmin."""
    reducer = design.reducer
    one = [np.array(value) for value in (reducer.eccentricity, 0.0, reducer.output_pins.count)]
    pins = reducer.output_pins
    sizes = Sizes(*one, np.array(pins.circle_radius), np.array(pins.hole_clearance), one[1], one[1])
    frame = SimpleNamespace(
        lobe_count=reducer.ratio,
        disc_count=reducer.disc_count,
        equidistant=reducer.modification.equidistant,
    )
    return ARCMIN * float(backlash_angle(frame, sizes))


def judged(design: Design) -> float:
    """What 95 % of 64 toleranced gearboxes stay below, arcmin."""
    drawn = drawn_gearboxes(resolve(design), 64, sensitivity=False, rigid=True)
    return float(np.quantile(drawn.continuous.columns["backlash_arcmin"], 0.95))


def test_backlash_is_about_that_of_toleranced_gearboxes(designs: dict[str, Design]) -> None:
    told = {name: closed_form(design) for name, design in designs.items()}
    drawn = {name: judged(design) for name, design in designs.items()}
    for name, value in told.items():
        assert value == pytest.approx(drawn[name], rel=0.2), name
    # Few pins turn farther within the same clearances, with part errors most of all.
    order = sorted(told, key=told.__getitem__)
    assert order == sorted(drawn, key=drawn.__getitem__)
    assert told["four pins"] > 1.1 * told["eight pins"]


def test_backlash_by_hand(designs: dict[str, Design]) -> None:
    """2 q/(n e) + (0.72 + 3.4/(N_w D)) c/R_w: 8 pins and two discs share most of the play."""
    reducer = designs["eight pins"].reducer
    teeth = 2.0 * reducer.modification.equidistant / (10 * reducer.eccentricity)
    pins = reducer.output_pins.hole_clearance / reducer.output_pins.circle_radius
    assert closed_form(designs["eight pins"]) == pytest.approx(
        ARCMIN * (teeth + (0.72 + 3.4 / 16.0) * pins)
    )
