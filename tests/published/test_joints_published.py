"""Joints: dowels.

* ASME B18.8.2-2000, hardened ground machine dowel pins: single shear loads by diameter.
* ASME B18.8.5M, the same in metric sizes, which are held to more.
* ISO 8734:1997, table 1: lengths and chamfers.
* Wittel and others 2017, Roloff/Matek Maschinenelemente, section 9.3: p = 4 T/(D d l).
"""

from __future__ import annotations

import math

import pytest

from cqdd_design.catalog.dowels import SHEAR_STRENGTH, along_a_seam, dowels_within


@pytest.mark.parametrize(
    ("inches", "pounds"), [(0.125, 1600), (0.25, 6400), (0.375, 14350), (0.5, 25500), (1.0, 102000)]
)
def test_hardened_pins_break_at_their_table_of_loads(inches: float, pounds: float) -> None:
    area = 0.25 * math.pi * (inches * 25.4e-3) ** 2
    assert pytest.approx(pounds * 4.44822 / area, rel=5e-3) == SHEAR_STRENGTH


@pytest.mark.parametrize(("mm", "kilonewtons"), [(3, 7.4), (4, 13.2), (6, 29.7), (10, 82.5)])
def test_metric_pins_bear_more_than_that(mm: float, kilonewtons: float) -> None:
    strength = kilonewtons * 1e3 / (0.25 * math.pi * (mm * 1e-3) ** 2)
    assert 1.1 * SHEAR_STRENGTH < strength < 1.2 * SHEAR_STRENGTH


def test_sizes_of_iso_8734() -> None:
    """2 mm from 5 to 20, 6 mm from 14 to 60 mm; chamfers of 0.35 and 1.2 mm."""
    assert dowels_within(2e-3, 4.9e-3)[0].diameter == 1.5e-3
    assert [one.length for one in dowels_within(6e-3, 1.0)][:1] == [60e-3]
    two = next(one for one in dowels_within(6e-3, 15.9e-3) if one.diameter == 2e-3)
    assert two.length == pytest.approx(14e-3)
    assert two.bearing_length == pytest.approx(14e-3 - 2 * 0.35e-3)
    assert dowels_within(0.9e-3, 1.0) == ()


def test_a_pin_along_the_seam_of_shaft_and_hub() -> None:
    """Roloff/Matek: p = 4 T/(D d l), and half of that in shear, D the seam's diameter."""
    found = along_a_seam(80.0, 1, 0.5 * 25e-3, 5e-3, 28e-3)
    assert found.pressure == pytest.approx(4.0 * 80.0 / (25e-3 * 5e-3 * 28e-3))
    assert found.shear == pytest.approx(0.5 * found.pressure)
