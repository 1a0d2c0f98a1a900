"""Reference design S with warm parts, against a second implementation that shares no code.

Its figures (backlash at the drawing's 20 deg C, and with all parts 40 K and 60 K above, carrier of
7075 and the rest of steel) are those of the reference design in ``docs/contact-model.md``.
"""

from __future__ import annotations

import math

import pytest
from reference_design import DESIGN_S

from cqdd_design.design import load_design
from cqdd_design.gearbox.heat.expansion import PartTemperatures
from cqdd_design.gearbox.precision.backlash import Backlash, backlash
from cqdd_design.machine import Machine, resolve

WITHIN = 0.15
ARCMIN = 60.0 * math.degrees(1.0)
STEEL = "AISI 4140 Q&T 540C"


@pytest.fixture(scope="module")
def machine() -> Machine:
    return resolve(load_design(DESIGN_S))


def warm(machine: Machine, temperatures: PartTemperatures) -> Backlash:
    return backlash(machine.at(temperatures).contact)


def test_forty_kelvin_take_half_of_the_backlash(machine: Machine) -> None:
    assert backlash(machine.contact).mean * ARCMIN == pytest.approx(5.62, abs=0.01)
    assert warm(machine, PartTemperatures.even(60.0)).mean * ARCMIN == pytest.approx(
        2.8, abs=WITHIN
    )


def test_sixty_kelvin_press_the_pins_and_leave_the_teeth_a_fifth(machine: Machine) -> None:
    """The second implementation calls a gearbox whose parts overlap one without backlash."""
    found = warm(machine, PartTemperatures.even(80.0))
    assert found.preloaded
    assert found.mean * ARCMIN == pytest.approx(1.07, abs=0.02)
    assert found.overlap.max() * 1e6 == pytest.approx(2.9, abs=0.15)
    assert warm(machine, PartTemperatures.even(95.0)).mean == 0.0


def test_discs_twenty_kelvin_above_their_ring_press_the_teeth(machine: Machine) -> None:
    """And leave the pins their play."""
    found = warm(machine, PartTemperatures(disc=40.0))
    assert found.preloaded
    assert found.mean * ARCMIN == pytest.approx(3.54, abs=0.02)


@pytest.mark.parametrize("temperature", [-10.0, 60.0, 80.0])
def test_a_stack_of_steel_does_not_move(machine: Machine, temperature: float) -> None:
    steel = machine.changed({"housing.material": STEEL})
    drawn = backlash(steel.contact).mean
    found = warm(steel, PartTemperatures.even(temperature)).mean
    assert found * ARCMIN == pytest.approx(drawn * ARCMIN, abs=WITHIN)
