"""Catalogue values against their sources.

Sources: ISO 281:2007 (rating formula and table 7), ISO 76:2006 (static rating of radial rollers),
KOYO CAT. B2001 for deep-groove bearings, ISO 7379 f9 shoulders, efunda.com for AISI 4140.
"""

import math
import re

import pytest
from needle_ratings import dynamic_rating, static_rating

from cqdd_design.catalog import (
    bearings,
    find_bearing,
    find_material,
    find_motor,
    find_shoulder_screw,
    fit_limits,
    fit_zones,
    materials,
    motors,
    shoulder_screws,
)
from cqdd_design.catalog.needles import needle_set
from cqdd_design.exporting.edm.seats import seat
from cqdd_design.gearbox.contact.laws import ball_complement, cam_spring
from cqdd_design.gearbox.losses.rolling import DRAG_FACTOR


def test_every_row_names_its_source():
    for table in (materials(), bearings(), motors(), shoulder_screws()):
        assert table
        assert all(row.source for row in table.values())


def test_koyo_6902():
    bearing = find_bearing("6902")
    sizes = (bearing.bore_diameter, bearing.outer_diameter, bearing.width)
    assert sizes == pytest.approx((0.015, 0.028, 0.007))
    assert (bearing.dynamic_rating, bearing.static_rating) == (4300.0, 2250.0)


def test_f9_shoulder_of_4_mm():
    screw = find_shoulder_screw(4e-3)
    assert screw.mean_diameter == pytest.approx(3.975e-3)
    limits = fit_limits("f9", 4e-3)
    assert (limits.lower, limits.upper) == pytest.approx((-40e-6, -10e-6))
    assert 4e-3 + limits.lower == pytest.approx(screw.shoulder_diameter_min)
    assert 4e-3 + limits.upper == pytest.approx(screw.shoulder_diameter_max)


@pytest.mark.parametrize(
    ("temper", "strength", "hardness"), [("425C", 1138e6, 397.0), ("540C", 834e6, 335.0)]
)
def test_4140_by_temper(temper, strength, hardness):
    material = find_material(f"AISI 4140 Q&T {temper}")
    assert material.yield_strength == pytest.approx(strength)
    assert material.brinell_hardness == hardness


def test_motor_torque_constant_follows_from_kv():
    motor = find_motor("CubeMars RO100 KV55")
    assert motor.torque_constant == pytest.approx(9.5493 / 55.0, rel=1e-4)


def test_the_ro100_drags_as_measured_and_is_sold_in_two_variants():
    """J. V., MSc thesis, Twente (the motor alone); the maker's page of Standard and Lite."""
    standard, lite = find_motor("CubeMars RO100 KV55"), find_motor("CubeMars RO100 Lite KV55")
    for motor in (standard, lite):
        assert motor.coulomb == 0.0999
        # 0.00534 N m per revolution a second.
        assert 2.0 * math.pi * motor.viscous == pytest.approx(0.00534, rel=1e-5)
        assert motor.hysteresis == motor.iron_loss == 0.0  # in the measured values
        assert (motor.cogging_amplitude, motor.cogging_order) == (0.055, 252)
        assert "University of Twente" in motor.drag_source
        assert "amplitude" in motor.cogging_source
        assert "bell" in motor.scope
    sizes = ("mass", "rotor_inertia", "outer_diameter", "length", "bore_diameter")
    assert [getattr(standard, name) for name in sizes] == pytest.approx(
        [0.710, 8.7e-4, 0.1135, 0.0362, 0.074]
    )
    assert [getattr(lite, name) for name in sizes] == pytest.approx(
        [0.525, 5.29e-4, 0.1083, 0.028, 0.074]
    )
    # What the Lite's own row does not know it says.
    for name in ("coulomb", "line_resistance", "bore_diameter"):
        assert lite.told_by(name).endswith("taken over from CubeMars RO100 KV55")
    assert lite.told_by("mass") == lite.name


def test_rows_of_motors_hold_together():
    """Order of cogging, what is taken over, and inertias that the mass can have."""
    for motor in motors().values():
        if motor.slots and motor.pole_pairs and motor.cogging_order:
            assert motor.cogging_order == math.lcm(motor.slots, 2 * motor.pole_pairs), motor.name
        for name in motor.taken_over.split():
            assert getattr(motor, name) == getattr(find_motor(motor.taken_from), name), name
        for name in ("coulomb", "viscous", "hysteresis", "iron_loss", "cogging_amplitude"):
            value = getattr(motor, name)
            assert value is None or 0.0 <= value < 1.0, (motor.name, name)
            source = motor.cogging_source if name == "cogging_amplitude" else motor.drag_source
            assert value is None or source, (motor.name, name)
        if motor.torque_at == "motor" and motor.mass and motor.outer_diameter:
            reach = motor.mass * (0.5 * motor.outer_diameter) ** 2
            assert (motor.rotor_inertia or 0.0) < reach, motor.name
        if motor.bore_diameter and motor.outer_diameter:
            assert motor.bore_diameter < motor.outer_diameter
        # A bare motor that lacks nothing can be simulated and drawn.
        assert not (motor.torque_at != "motor" and motor.missing)


@pytest.mark.parametrize(
    ("name", "voltage", "rpm"),
    [
        # Printed no-load speeds against the constant in its convention.
        ("TQ ILM115x25 (star serial)", 48.0, 1400.0),
        ("TQ ILM-E85x30 (star serial)", 48.0, 1290.0),
        ("maxon EC frameless HT 90 M", 48.0, 2490.0),
        ("CubeMars RO80 KV105", 48.0, 5040.0),
    ],
)
def test_torque_constants_give_the_printed_no_load_speed(name, voltage, rpm):
    constant = find_motor(name).torque_constant
    assert voltage / constant * 30.0 / math.pi == pytest.approx(rpm, rel=0.03)


def test_a_constant_per_unknown_ampere_is_none():
    assert find_motor("Dephy ActPack motor (T-Motor U8 class)").torque_constant is None
    assert "torque constant" in find_motor("Dephy ActPack motor (T-Motor U8 class)").missing


def test_bearing_without_ratings_is_not_given_any():
    assert find_bearing("6710").static_rating is None


def _computed():
    return [b for b in bearings().values() if b.source.startswith("computed")]


@pytest.mark.parametrize("bearing", _computed(), ids=lambda b: b.designation)
def test_computed_rows_are_the_iso_formulas(bearing):
    needles = bearing.needles
    assert bearing.dynamic_rating == pytest.approx(dynamic_rating(needles), rel=2e-3)
    assert bearing.static_rating == pytest.approx(static_rating(needles), rel=2e-3)
    stated = re.search(r"from (\d+) needles", bearing.source)
    assert stated is not None
    assert int(stated.group(1)) == needles.count


def test_computed_rows_span_3_to_30_mm():
    bores = {round(b.bore_diameter * 1e3) for b in _computed()}
    assert min(bores) == 3
    assert max(bores) == 30


def test_needle_formulas_bracket_a_catalogue_bearing():
    """HK1010 is catalogued at 4.4 and 5.1 kN; the cautious needle pitch must not exceed it much."""
    bearing = find_bearing("needle HK1010")
    needles = needle_set(0.010, 0.014, 0.010, drawn_cup=True)
    assert bearing.dynamic_rating is not None
    assert 0.6 < dynamic_rating(needles) / bearing.dynamic_rating < 1.15


@pytest.mark.parametrize(
    ("size", "drawn_cup", "expected"),
    [
        # bore, outside, width -> needle diameter, length and pitch circle, mm; count: by hand
        ((20, 26, 17), True, (2.0, 13.8, 22.0, 18)),
        ((25, 32, 20), True, (2.5, 16.8, 27.5, 18)),
        ((20, 26, 17), False, (3.0, 14.8, 23.0, 12)),
    ],
)
def test_needles_fill_the_space_between_the_rings(size, drawn_cup, expected):
    """Half the difference of the rings, less 1 mm of drawn cup; a needle every 1.9 diameters."""
    bore, outer, width = (1e-3 * value for value in size)
    found = needle_set(bore, outer, width, drawn_cup=drawn_cup)
    lengths = (found.diameter, found.length, found.pitch_diameter)
    assert [1e3 * value for value in lengths] == pytest.approx(expected[:3])
    assert found.count == expected[3]


def test_a_size_on_the_step_belongs_to_the_range_below():
    """ISO 286: over 3 up to and including 6 mm."""
    assert fit_limits("f9", 3e-3).up_to == pytest.approx(3e-3)
    assert fit_limits("f9", 6e-3).up_to == pytest.approx(6e-3)


_SHAFTS = {
    "d": lambda d: -16.0 * d**0.44,
    "e": lambda d: -11.0 * d**0.41,
    "f": lambda d: -5.5 * d**0.41,
    "g": lambda d: -2.5 * d**0.34,
    "k": lambda d: 0.6 * d ** (1.0 / 3.0),
    "n": lambda d: 5.0 * d**0.34,
}
"""Fundamental deviations of ISO 286-1, um, of the mean size of a range, mm."""
_UNITS = {5: 7.0, 6: 10.0, 7: 16.0, 8: 25.0, 9: 40.0, 11: 100.0}


@pytest.mark.parametrize("ends", [(80, 120), (120, 180), (180, 250), (250, 315), (315, 400)])
def test_zones_of_large_sizes_follow_the_formulas_of_iso_286(ends):
    """Grades of so many i, i = 0.45 D^(1/3) + 0.001 D; deviations of shafts; holes with the rule
    of delta = IT7 - IT6; all within what the standard rounds."""
    mean, size = math.sqrt(ends[0] * ends[1]), 1e-3 * ends[1]
    unit = 0.45 * mean ** (1.0 / 3.0) + 0.001 * mean
    for code, zones in fit_zones().items():
        letter = code.rstrip("0123456789")
        grade = int(code.removeprefix(letter))
        if zones[-1].up_to < size:
            assert code in ("r6", "s6")
            continue
        limits = fit_limits(code, size)
        lower, upper = 1e6 * limits.lower, 1e6 * limits.upper
        assert upper - lower == pytest.approx(_UNITS[grade] * unit, rel=0.02, abs=0.6), code
        if letter in _SHAFTS:
            near = lower if letter in "kn" else upper
            assert near == pytest.approx(_SHAFTS[letter](mean), rel=0.025, abs=1.0), code
        if letter.lower() in _SHAFTS and letter in "DFG":
            assert lower == pytest.approx(-_SHAFTS[letter.lower()](mean), rel=0.025, abs=1.0), code
        if letter in "HJS":
            assert lower == pytest.approx(0.0 if letter == "H" else -upper)
        if letter == "h":
            assert upper == 0.0
    delta = fit_limits("H7", size).upper - fit_limits("H6", size).upper
    for hole, shaft in (("K7", "k6"), ("M7", "m6"), ("N7", "n6"), ("P7", "p6")):
        deviation = delta - fit_limits(shaft, size).lower
        assert fit_limits(hole, size).upper == pytest.approx(deviation, abs=0.1e-6), hole
    assert fit_limits("m6", size).lower == pytest.approx(delta, abs=0.1e-6)
    beyond = 1e6 * (fit_limits("p6", size).lower - fit_limits("H7", size).upper)
    assert 0.0 <= beyond <= 5.0 + 1e-9


def test_the_seat_of_a_large_ring_is_cut_to_its_zone():
    """150 n6 is +27 to +52 um: the wire goes half of the middle out, where h7 would be loose."""
    found = seat(0, 0.15, "n6")
    assert found is not None
    assert found.middle == pytest.approx(150.0395e-3, abs=1e-9)
    assert found.shift == pytest.approx(19.75e-6)


def test_rolling_elements_of_the_cam_bearing():
    """Balls of 0.3 (D - d), counted from C0; needles: 7.68e-5 Q^0.9/l^0.8 with Q = 4.08 F/Z."""
    count, diameter = ball_complement(find_bearing("6902"))
    assert (count, diameter) == (12, pytest.approx(0.3 * 13e-3))
    cage = find_bearing("needle cage K20x24x13")
    needles = needle_set(0.020, 0.024, 0.013, drawn_cup=False)
    spring = cam_spring(cage, 0.0)
    force = 2000.0
    approach = 7.68e-8 * (4.08 * force / needles.count) ** 0.9 / (1e3 * needles.length) ** 0.8
    assert spring.stiffness * approach**spring.exponent == pytest.approx(force)
    assert DRAG_FACTOR["needle"] == DRAG_FACTOR["needle cage"] == 12.0
