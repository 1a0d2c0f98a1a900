"""What output pins are made as, and that what turns on a pin has the play of its drawn fit."""

from __future__ import annotations

from pathlib import Path

import pytest

from cqdd_design.catalog.fits import fit_limits
from cqdd_design.design import Design, load_design
from cqdd_design.exporting.bill.consumables import consumables
from cqdd_design.geometry.output_pins import mean_pin_diameter, pin_limits, shoulder_screw
from cqdd_design.geometry.runners import Runner, pin_runner, ring_runner
from cqdd_design.machine import resolve
from cqdd_design.solids.features.kinds import Seat

ROOT = Path(__file__).resolve().parents[2]
HARD = "AISI 52100 / 100Cr6 hardened"
PINS = "reducer.output_pins."
PAPER = load_design(ROOT / "designs" / "cqdd-10.toml")
NEEDLES = load_design(ROOT / "docs" / "gallery" / "efficient-10.toml")


def limits(design: Design, name: str, seat: str) -> tuple[float, float]:
    """Least and greatest diameter of a cylinder, as its sheet has it, m."""
    part = next(one for one in resolve(design).parts if one.name == name)
    (found,) = [one for one in part.features if isinstance(one, Seat) and one.name == seat]
    zone = fit_limits(found.zone, found.diameter)
    return found.diameter + zone.lower, found.diameter + zone.upper


def on_the_sheets(design: Design, runner: Runner, pin: tuple[float, float], name: str) -> float:
    """Mean play by the limits of the made parts."""
    needles = 0.0 if runner.cage is None else runner.cage.outer_diameter - runner.pin_diameter
    return 0.5 * (sum(limits(design, name, "bore")) - sum(pin)) - needles


def test_a_sleeve_on_needles_plays_as_its_sheets_say() -> None:
    """They said f9 and H7, 24.5 um in the mean, where 10 were judged: 8.7 arcmin were 11.3."""
    runner = pin_runner(NEEDLES)
    assert runner is not None
    pin = limits(NEEDLES, "dowel pin", "outside")
    assert pin == pytest.approx((2.996e-3, 3.0e-3))
    assert on_the_sheets(NEEDLES, runner, pin, "pin sleeve") == pytest.approx(runner.play)
    assert runner.play == pytest.approx(10e-6)
    # What rolls in the holes is judged at its nominal size.
    assert sum(limits(NEEDLES, "pin sleeve", "outside")) == pytest.approx(2.0 * runner.diameter)


@pytest.mark.parametrize(
    ("material", "pin"), [("Alloy steel 12.9 (ISO 7379)", (3.96, 3.99)), (HARD, (3.995, 4.0))]
)
def test_a_plain_sleeve_plays_as_its_sheets_say(material: str, pin: tuple[float, float]) -> None:
    """On a shoulder screw, whose f9 is bought, as on a dowel that is ground for it."""
    design = PAPER.replacing({PINS + "material": material, PINS + "sleeve_diameter": "6 mm"})
    runner = pin_runner(design)
    assert runner is not None
    real = pin_limits(design.reducer.output_pins)
    assert [1e3 * one for one in real] == pytest.approx(pin)
    assert on_the_sheets(design, runner, real, "pin sleeve") == pytest.approx(runner.play)
    stated = pin_runner(design.replacing({PINS + "sleeve_play": "21 um"}))
    assert stated is not None
    assert stated.play == pytest.approx(21e-6)


def test_a_roller_plays_as_its_sheets_say() -> None:
    ring = {"reducer.ring_type": "pinwheel", "reducer.ring_pin_diameter": "4 mm"}
    bare = PAPER.replacing(ring | {"reducer.eccentricity": "1 mm"})
    assert limits(bare, "ring pin", "outside")[0] == pytest.approx(4e-3 - 8e-6)
    design = bare.replacing({"reducer.ring.roller_diameter": "6 mm"})
    runner = ring_runner(design)
    assert runner is not None
    pin = limits(design, "ring pin", "outside")
    assert on_the_sheets(design, runner, pin, "ring roller") == pytest.approx(runner.play)


def test_no_shoulder_screw_is_ordered_of_a_hardened_steel() -> None:
    """Such screws are sold of 12.9, which is neither as strong nor a raceway."""
    tough = PAPER.replacing({PINS + "material": "Alloy steel 12.9 (ISO 7379)"})
    hard = PAPER.replacing({PINS + "material": HARD})
    screw = shoulder_screw(tough.reducer.output_pins)
    assert screw is not None
    assert screw.thread == "M3"
    assert shoulder_screw(hard.reducer.output_pins) is None
    names = {one.name: one for one in resolve(hard).parts}
    assert "shoulder screw" not in names
    assert names["dowel pin"].source == "make"
    # In plastic, where a retaining compound does not cure, with an epoxy.
    printed = resolve(load_design(ROOT / "designs" / "printed-13.toml"))
    told = {one.name: one.fitting for one in consumables(printed)}
    assert "pins in the plate" in told["epoxy"]
    assert "pins in" not in told["retaining compound"]
    assert "epoxy" not in {one.name for one in consumables(resolve(hard))}
    # Bare, it keeps the zone that holes are cut for.
    assert mean_pin_diameter(hard.reducer.output_pins) == pytest.approx(3.975e-3)
    assert mean_pin_diameter(tough.reducer.output_pins) == pytest.approx(3.975e-3)
