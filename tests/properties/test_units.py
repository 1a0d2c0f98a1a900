"""Unit strings: every spelling agrees with pint, every dimension refuses its look-alikes."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

import cqdd_design.units as units
from cqdd_design.errors import CqddError, DesignError
from cqdd_design.units import Dimension, format_quantity, parse_quantity

DIMENSIONS = [value for value in vars(units).values() if isinstance(value, Dimension)]


@pytest.mark.parametrize("dimension", DIMENSIONS, ids=lambda d: f"{d.name} {d.unit}")
def test_common_spellings_agree_with_pint(dimension):
    for spelling, factor in dimension.common:
        assert units._factor_by_pint(spelling, dimension) == pytest.approx(factor, rel=1e-15)


@pytest.mark.parametrize("dimension", DIMENSIONS, ids=lambda d: f"{d.name} {d.unit}")
def test_own_unit_is_common_and_consistent(dimension):
    assert dict(dimension.common)[dimension.unit] == pytest.approx(dimension.si_factor, rel=1e-15)


@given(st.sampled_from(DIMENSIONS), st.floats(-1e9, 1e9, allow_nan=False))
def test_round_trip(dimension, number):
    value = number * dimension.si_factor
    again = parse_quantity(format_quantity(value, dimension), dimension)
    assert again == pytest.approx(value, rel=1e-11, abs=1e-300)


@pytest.mark.parametrize(
    ("text", "dimension", "says"),
    [
        ("120 J", units.TORQUE, "energy"),
        ("3 W*s", units.TORQUE, "torque"),
        ("50 Hz", units.SPEED, "rpm or rad/s"),
        ("3 1/s", units.SPEED, "speed"),
        ("3 rpm", units.FREQUENCY, "Hz"),
        ("5 %", units.ANGLE, "angle"),
        ("5 N*m", units.STIFFNESS_GAIN, "N*m/rad"),
        ("3 mmm", units.LENGTH, "did you mean 'mm'"),
        ("3", units.LENGTH, '"3 mm"'),
        ("mm", units.LENGTH, "no number"),
        ("nan mm", units.LENGTH, "no number"),
        ("1e999 mm", units.LENGTH, "finite"),
        ("4 " + "x" * 5000, units.LENGTH, "no unit"),
        ("1 __class__", units.LENGTH, "not a unit"),
    ],
)
def test_wrong_units_are_refused_with_the_right_form(text, dimension, says):
    with pytest.raises(DesignError, match=says.replace("*", r"\*")):
        parse_quantity(text, dimension)


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("120 Nm", units.TORQUE, 120.0),
        ("10 lbf*in", units.TORQUE, 1.1298482902761668),
        ("1286 rpm", units.SPEED, 1286 * math.tau / 60),
        ("2 rev/s", units.SPEED, 2 * math.tau),
        ("90°", units.ANGLE, math.pi / 2),
        ("6 µm", units.SMALL_LENGTH, 6e-6),
        ('3/8"', units.LENGTH, None),
        ("0.5 in", units.LENGTH, 0.0127),
        ("1.2 degC/W", units.THERMAL_RESISTANCE, 1.2),
    ],
)
def test_usual_spellings(text, dimension, value):
    if value is None:
        with pytest.raises(DesignError):
            parse_quantity(text, dimension)
    else:
        assert parse_quantity(text, dimension) == pytest.approx(value, rel=1e-12)


@given(st.text(max_size=40), st.sampled_from(DIMENSIONS))
def test_no_text_raises_anything_but_our_own(text, dimension):
    try:
        value = parse_quantity(text, dimension)
    except CqddError:
        return
    assert math.isfinite(value)
