"""Planetary kinematics against published gear sets.

Every row of the groups ratio and gear_planetary of `data/published_examples.csv` is computed from
the inputs the row itself gives and compared within the row's own tolerance. Sources, per row: the
COMPAct actuators (arXiv:2510.07197) and mjbots for the ratios; ANSI/AGMA 6123-C16 Annex C, as
transcribed in the tests of r3kste/pydome, for speeds, torque and the profile shifts that give its
planetary the centre distance of 139 mm.
"""

from __future__ import annotations

import csv
import re
from pathlib import Path

import pytest

from cqdd_design.planetary.kinematics import PlanetaryTeeth, ratio_ring_fixed, speeds, torques
from cqdd_design.planetary.tooth_geometry import GearPair

ROWS = list(
    csv.DictReader(
        (Path(__file__).parent / "data" / "published_examples.csv").open(encoding="utf-8")
    )
)
RATIOS = [row for row in ROWS if row["group"] == "ratio"]
ANNEX_C = [row for row in ROWS if row["group"] == "gear_planetary"]


def teeth_of(inputs: str) -> PlanetaryTeeth:
    """Tooth counts written `18/49/29/96` or `Ns12;Np1 36;Np2 22;Nr70`."""
    named = re.findall(r"(?:Ns|Np1|Np2|Nr)\s*(\d+)", inputs)
    counts = named or re.search(r"\d+(?:/\d+)+", inputs).group().split("/")
    sun, *planets, ring = map(int, counts)
    return PlanetaryTeeth(sun, planets[0], planets[-1], ring)


def test_the_file_has_these_rows():
    assert len(RATIOS) == 6
    assert len(ANNEX_C) == 4


@pytest.mark.parametrize("row", RATIOS, ids=lambda row: row["inputs"])
def test_ratio(row):
    found = ratio_ring_fixed(teeth_of(row["inputs"]))
    assert found == pytest.approx(float(row["value"]), abs=float(row["tol"]))


@pytest.mark.parametrize("row", ANNEX_C, ids=lambda row: row["quantity"])
def test_agma_6123_annex_c(row):
    inputs = row["inputs"]
    teeth = teeth_of(inputs)
    planets = int(re.search(r"(\d+) planets", inputs).group(1))
    carrier_rpm, carrier_knm = map(
        float, re.search(r"carrier ([\d.]+) rpm ([\d.]+) kNm", inputs).groups()
    )
    ratio = ratio_ring_fixed(teeth)
    moving = speeds(teeth, carrier_rpm * ratio)
    found = {
        "ratio": ratio,
        "n_sun": moving.sun,
        "n_rel": moving.sun_to_carrier,
        "T_sun": torques(teeth, carrier_knm, planets).sun,
    }[row["quantity"]]
    assert found == pytest.approx(float(row["value"]), abs=float(row["tol"]))
    assert moving.carrier == pytest.approx(carrier_rpm, rel=1e-12)


@pytest.mark.parametrize(("pinion", "wheel"), [(0, 1), (1, 2)])
def test_shifts_of_annex_c_give_its_centre_distance(pinion, wheel):
    """The sign convention of internal gears: with x_ring = -0.799 both meshes run at 139 mm."""
    inputs = ANNEX_C[0]["inputs"]
    teeth = teeth_of(inputs)
    shifts = [float(x) for x in re.search(r"x([-.\d/]+)", inputs).group(1).split("/")]
    module = float(re.search(r";m(\d+)", inputs).group(1)) * 1e-3
    distance = float(re.match(r"a(\d+)", inputs).group(1)) * 1e-3
    counts = (teeth.sun, teeth.planet_sun, -teeth.ring)
    pair = GearPair(counts[pinion], counts[wheel], module, 0.1, shifts[pinion], shifts[wheel])
    # Shifts are printed to a thousandth of a module, 6 um.
    assert abs(pair.working_centre_distance) == pytest.approx(distance, abs=10e-6)
