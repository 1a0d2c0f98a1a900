"""Planetary kinematics against published gear sets.

Groups of `data/published_examples.csv`, computed from the inputs that a row itself gives:

- planetary ratio: the mjbots qdd100, the compound planetary of Zhu et al. 2024 (arXiv:2410.16591),
  and gear sets of COMPAct (arXiv:2510.07197).
- planetary kinematics: ANSI/AGMA 6123-C16 Annex C, as transcribed in the tests of r3kste/pydome:
  speeds, torque, and the profile shifts that give its planetary the centre distance of 139 mm.
"""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from published_rows import Row, label, published_rows

from cqdd_design.planetary.kinematics import PlanetaryTeeth, ratio_ring_fixed, speeds, torques
from cqdd_design.planetary.tooth_geometry import GearPair

Compared = Callable[..., None]
RATIOS = published_rows("planetary ratio")
ANNEX_C = published_rows("planetary kinematics")
DISTANCES = published_rows("planetary kinematics", "centre distance")
MOTIONS = [row for row in ANNEX_C if row not in DISTANCES]


def teeth_of(inputs: str) -> PlanetaryTeeth:
    """Tooth counts written `18/49/29/96` or, of a simple planetary, `16/28/74`."""
    counts = re.search(r"\d+(?:/\d+)+", inputs).group().split("/")
    sun, *planets, ring = map(int, counts)
    return PlanetaryTeeth(sun, planets[0], planets[-1], ring)


def test_the_file_has_these_rows():
    assert len(RATIOS) == 6
    assert len(MOTIONS) == 4
    assert len(DISTANCES) == 2


@pytest.mark.parametrize("row", RATIOS, ids=label)
def test_ratio(row: Row, compared: Compared):
    compared(row, lambda: ratio_ring_fixed(teeth_of(row["inputs"])), ratio_ring_fixed)


@pytest.mark.parametrize("row", MOTIONS, ids=label)
def test_agma_6123_annex_c(row: Row, compared: Compared):
    inputs = row["inputs"]
    teeth = teeth_of(inputs)
    planets = int(re.search(r"(\d+) planets", inputs).group(1))
    carrier_knm = float(re.search(r"rpm ([\d.]+) kNm", inputs).group(1))

    answers: dict[str, tuple[Callable[[], float], Callable[..., object]]] = {
        "ratio": (lambda: ratio_ring_fixed(teeth), ratio_ring_fixed),
        "speed of the carrier, sun at 343.125 rpm": (
            lambda: speeds(teeth, 343.125).carrier,
            speeds,
        ),
        "speed of the sun against the carrier": (
            lambda: speeds(teeth, 343.125).sun_to_carrier,
            speeds,
        ),
        "torque of the sun": (lambda: torques(teeth, carrier_knm, planets).sun, torques),
    }
    ours, used = answers[row["quantity"]]
    compared(row, ours, used)


@pytest.mark.parametrize("row", DISTANCES, ids=label)
def test_shifts_of_annex_c_give_its_centre_distance(row: Row, compared: Compared):
    """The sign convention of internal gears: with x_ring = -0.799 both meshes run at 139 mm."""
    inputs = row["inputs"]
    teeth = teeth_of(inputs)
    shifts = [float(x) for x in re.search(r"x([-.\d/]+)", inputs).group(1).split("/")]
    module = float(re.search(r";m(\d+)", inputs).group(1)) * 1e-3
    counts = (teeth.sun, teeth.planet_sun, -teeth.ring)
    pinion = 1 if row["quantity"].endswith("ring") else 0
    wheel = pinion + 1

    def ours() -> float:
        pair = GearPair(counts[pinion], counts[wheel], module, 0.1, shifts[pinion], shifts[wheel])
        return 1e3 * abs(pair.working_centre_distance)

    compared(row, ours, GearPair.working_centre_distance, GearPair.working_pressure_angle)
