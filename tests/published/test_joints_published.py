"""Joints: dowels, the bond of hubs, and screws.

* ASME B18.8.2-2000, hardened ground machine dowel pins: single shear loads by diameter.
* ASME B18.8.5M, the same in metric sizes, which are held to more.
* ISO 8734:1997, table 1: lengths and chamfers.
* Wittel and others 2017, Roloff/Matek Maschinenelemente, section 9.3: p = 4 T/(D d l);
  section 5.1: T = pi/2 d^2 b tau/S of a bonded hub.
* VDI 2230 part 1, table A1: preload and tightening torque of screws at 0.9 of their yield strength.
* ISO 898-1: stress areas. ISO 4014, ISO 273: faces under heads.
"""

from __future__ import annotations

import math

import pytest

from cqdd_design.catalog.adhesives import ROTOR_COMPOUND, joint_shear, length_needed
from cqdd_design.catalog.dowels import SHEAR_STRENGTH, along_a_seam, dowels_within
from cqdd_design.catalog.materials import find_material
from cqdd_design.catalog.threads import coarse_thread
from cqdd_design.catalog.tightening import (
    preload_at_yield,
    stripping_force,
    substitution_area,
    tightening_torque,
)


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


def test_a_bonded_hub() -> None:
    """T = pi/2 d^2 b tau/S: 20 mm, 25 mm long, 10 MPa over a safety of 2 hold 78.5 N m."""
    torque = 0.5 * math.pi * 20e-3**2 * 25e-3 * 10e6 / 2.0
    assert torque == pytest.approx(78.54, rel=1e-3)
    assert joint_shear(torque, 20e-3, 25e-3) == pytest.approx(5e6)
    assert length_needed(torque, 20e-3, 5e6) == pytest.approx(25e-3)


def test_a_compound_is_weaker_on_aluminium_and_when_hot() -> None:
    steel, light = find_material("AISI 4140 Q&T 540C"), find_material("7075-T6")
    assert ROTOR_COMPOUND.share_on(steel) == 1.0
    assert 0.0 < ROTOR_COMPOUND.share_on(light) < 1.0
    assert ROTOR_COMPOUND.share_on(find_material("PLA")) == 0.0
    shares = [ROTOR_COMPOUND.share_at(one) for one in (-20.0, 22.0, 60.0, 120.0, 150.0, 200.0)]
    assert shares[:2] == [1.0, 1.0]
    assert shares == sorted(shares, reverse=True)
    assert shares[-1] == 0.0


@pytest.mark.parametrize(
    ("size", "yields", "friction", "preload", "torque"),
    [
        # M, MPa, mu, kN, N m
        (8, 640, 0.12, 18.6, 24.6),
        (8, 640, 0.08, 19.5, 18.5),
        (10, 640, 0.12, 29.6, 48.0),
        (10, 640, 0.14, 28.8, 53.0),
        (10, 940, 0.12, 43.4, 71.0),
        (12, 640, 0.12, 43.0, 84.0),
        (12, 640, 0.14, 41.9, 93.0),
    ],
)
def test_preloads_and_torques_of_vdi_2230(
    size: int, yields: int, friction: float, preload: float, torque: float
) -> None:
    thread = coarse_thread(size * 1e-3)
    found = preload_at_yield(thread, 0.9 * yields * 1e6, friction)
    assert found == pytest.approx(preload * 1e3, rel=5e-3)
    # Hexagon screws bear from the clearance hole to the washer face.
    face = {8: (11.6, 9.0), 10: (14.6, 11.0), 12: (16.6, 13.5)}[size]
    mean = 0.5e-3 * sum(face)
    assert tightening_torque(found, thread, mean, friction) == pytest.approx(torque, rel=0.02)


@pytest.mark.parametrize(("size", "area"), [(3, 5.03), (4, 8.78), (5, 14.2), (6, 20.1), (16, 157)])
def test_stress_areas_of_iso_898(size: int, area: float) -> None:
    assert coarse_thread(size * 1e-3).stress_area == pytest.approx(area * 1e-6, rel=5e-3)


def test_a_nut_strips_by_the_area_at_its_threads_major_diameter() -> None:
    """M10 over 10 mm less 0.8 turns: 7/8 of pi d m shears, at D_2 as the nut's inner flank."""
    found = stripping_force(coarse_thread(10e-3), 10e-3, 200e6)
    assert found == pytest.approx(200e6 * 0.875 * math.pi * 10e-3 * (10e-3 - 1.2e-3), rel=1e-4)


def test_the_cylinder_of_clamped_plates() -> None:
    """M10, head 14.6 mm, hole 11 mm, 30 mm: between the head's ring and a solid cylinder."""
    head, hole, grip = 14.6e-3, 11e-3, 30e-3
    area = substitution_area(head, hole, grip)
    ring = 0.25 * math.pi * (head**2 - hole**2)
    assert ring < area < 0.25 * math.pi * ((head + grip) ** 2 - hole**2)
    spread = (grip * head / (head + grip) ** 2) ** (1 / 3)
    by_hand = ring + math.pi / 8 * head * grip * ((spread + 1) ** 2 - 1)
    assert area == pytest.approx(by_hand)
