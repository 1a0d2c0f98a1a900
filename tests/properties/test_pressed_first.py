"""Bearings are pressed where no force runs through their balls, and sit where they do not creep."""

from __future__ import annotations

from pathlib import Path

import pytest

from cqdd_design.design import load_design
from cqdd_design.exporting.bill.consumables import bonds
from cqdd_design.exporting.bill.fitting import fitting_notes
from cqdd_design.machine import Machine, resolve
from cqdd_design.solids.apart import taken_apart

TOP = Path(__file__).resolve().parents[2]
ROOT = Path(__file__).resolve().parents[2]
DESIGNS = ("designs/cqdd-10", "designs/printed-13", "docs/gallery/three-discs-9")


@pytest.fixture(scope="module", params=DESIGNS)
def machine(request: pytest.FixtureRequest) -> Machine:
    return resolve(load_design(TOP / f"{request.param}.toml"))


def test_a_cam_bearing_is_in_its_disc_before_it_is_on_its_lobe(machine: Machine) -> None:
    steps, whole = taken_apart(machine.design, machine.parts)
    assert whole
    order = [(one.name, step.unit) for step in reversed(steps) for one in step.moved]
    shaft = next(place for place, (name, _) in enumerate(order) if name == "eccentric shaft")
    for disc in range(1, machine.design.reducer.disc_count + 1):
        places = [k for k, (name, _) in enumerate(order) if name == f"cam bearing {disc}"]
        first, unit = places[0], order[places[0]][1]
        # On the bench with its disc, or with it before there is a shaft.
        together = {order[first - 1][0], order[first + 1][0]}
        assert f"disc {disc}" in together
        assert unit == f"unit of the disc {disc}" or first < shaft


def test_outer_rings_that_the_load_turns_in_are_held(machine: Machine) -> None:
    support = machine.layout.shaft.support.bearing
    (bond,) = (one for one in bonds(machine) if one.place == "outer rings of the shaft bearings")
    assert (bond.diameter, bond.length, bond.count) == (support.outer_diameter, support.width, 2)
    assert "keeps the outer rings from creeping" in fitting_notes(machine)["shaft bearing"]


def test_an_inrunner_cover_goes_on_when_its_hub_has_been_set() -> None:
    """Its height is measured from the face that the cover closes, with the shaft in it."""
    design = load_design(TOP / "docs" / "gallery" / "efficient-10.toml")
    own = {"name": "CubeMars RI80 V2.0 KV75", "slot_depth": "9 mm"}
    machine = resolve(design.replacing({f"motor.{key}": value for key, value in own.items()}))
    steps, whole = taken_apart(machine.design, machine.parts)
    assert whole
    gone = [station.part.name for step in steps if not step.unit for station in step.moved]
    for name in ("rotor hub", "encoder magnet", "eccentric shaft", "housing"):
        assert gone.index("motor cover") < gone.index(name)


@pytest.mark.parametrize("name", ["docs/gallery/efficient-10", "docs/gallery/plain-10"])
def test_the_motor_cover_goes_on_when_bell_and_magnet_have_been_set(name: str) -> None:
    """From the face that it closes, by a height gauge, while the bonds cure."""
    design = load_design(ROOT / f"{name}.toml")
    machine = resolve(design)
    steps, whole = taken_apart(design, machine.parts)
    assert whole
    gone = [station.part.name for step in steps if not step.unit for station in step.moved]
    assert "motor cover" in gone
    for name in ("rotor bell", "encoder magnet", "eccentric shaft", "housing"):
        assert gone.index("motor cover") < gone.index(name)
