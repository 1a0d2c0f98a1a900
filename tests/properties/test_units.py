"""Unit strings: every spelling agrees with pint, every dimension refuses its look-alikes."""

import math
import time

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import cqdd_design.units as units
from cqdd_design.errors import CqddError, DesignError
from cqdd_design.units import Dimension, format_quantity, parse_quantity
from cqdd_design.units.expression import LONGEST, parse_expression
from cqdd_design.units.quantities import _factor_by_pint

DIMENSIONS = [value for value in vars(units).values() if isinstance(value, Dimension)]


@pytest.mark.parametrize(
    "dimension", [d for d in DIMENSIONS if not d.zeros], ids=lambda d: f"{d.name} {d.unit}"
)
def test_common_spellings_agree_with_pint(dimension):
    for spelling, factor in dimension.common:
        assert _factor_by_pint(spelling, dimension) == pytest.approx(factor, rel=1e-15)


@pytest.mark.parametrize("unit", ["degC", "K", "degF"])
def test_scales_that_start_elsewhere_agree_with_pint(unit):
    import pint

    for number in (-40.0, 0.0, 60.0, 333.15):
        theirs = pint.UnitRegistry().Quantity(number, unit).to("degC").magnitude
        assert parse_quantity(f"{number} {unit}", units.TEMPERATURE) == pytest.approx(theirs)


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
        ("4 " + "x" * 5000, units.LENGTH, "too long for a unit"),
        ("4" * 400 + " mm", units.LENGTH, "too long for a quantity"),
        ("0.1 m^1.4", units.LENGTH, "a power is a whole number"),
        ("0.1 m^10", units.LENGTH, "past 9"),
        ("1 N*m*kg^0.4", units.TORQUE, "a power is a whole number"),
        ("1 m^", units.LENGTH, "a power is a whole number"),
        ("1 m**m", units.LENGTH, "a power is a whole number"),
        ("1 (m", units.LENGTH, "not closed"),
        ("1 m*", units.LENGTH, "a unit is missing"),
        ("1 2*m", units.LENGTH, "out of place"),
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
        ("1.2 °C/W", units.THERMAL_RESISTANCE, 1.2),
        ("1e-3 m", units.LENGTH, 1e-3),
        ("  1_000   mm ", units.LENGTH, 1.0),
        ("2 N*m/(rad/s)", units.DAMPING_GAIN, 2.0),
        ("2 kg m²", units.INERTIA, 2.0),
        ("2 g*cm**2", units.INERTIA, 2e-7),
        ("2 rad s^-1", units.SPEED, 2.0),
        ("2 newton*meter", units.TORQUE, 2.0),
    ],
)
def test_usual_spellings(text, dimension, value):
    if value is None:
        with pytest.raises(DesignError):
            parse_quantity(text, dimension)
    else:
        assert parse_quantity(text, dimension) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(
    "text",
    [
        "1 9**9**9**9*N*m",
        "1 N*m**9**9**9**9",
        "1 x" + 300_000 * " ",
        "1 x" + 300_000 * " " + "y",
        300_000 * "1" + " N*m",
        "1" + 300_000 * "_1" + " N*m",
        "1 " + 300_000 * "(",
        "1 " + 19 * "(m" + 19 * ")",
        "1 ((((((((m^9)^9)^9)^9)^9)^9)^9)^9)",
    ],
    ids=lambda text: text[:20].strip(),
)
def test_no_text_takes_long(text):
    before = time.process_time()
    with pytest.raises(DesignError) as caught:
        parse_quantity(text, units.TORQUE)
    assert len(caught.value.message) < 200
    assert time.process_time() - before < 5.0  # the import of pint included


@given(st.text(alphabet="Nmrads*/^()12 -²·", max_size=LONGEST + 5))
@example("m^2*" * 9 + "m")
def test_an_expression_has_names_and_small_whole_powers_or_is_refused(text):
    try:
        powers = parse_expression(text)
    except ValueError:
        return
    assert all(name.isidentifier() and abs(power) <= 40 for name, power in powers.items())
    again = "*".join(f"{name}^{power}" for name, power in powers.items())
    if max(map(abs, powers.values()), default=0) <= 9 and len(again) <= LONGEST:
        assert parse_expression(again or "1") == powers


@given(st.text(max_size=40), st.sampled_from(DIMENSIONS))
def test_no_text_raises_anything_but_our_own(text, dimension):
    try:
        value = parse_quantity(text, dimension)
    except CqddError:
        return
    assert math.isfinite(value)
