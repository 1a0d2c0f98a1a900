"""Compiled shape limits of ring stages against their plain numpy twins."""

import math
from dataclasses import replace

import numpy as np
import pytest
import shape_plain as plain

from cqdd_design.design import Requirements
from cqdd_design.sizing import shape_limits as shapes
from cqdd_design.sizing.frame import search_frame

RATIOS = [4, 10, 24, 60]


def some_rings(ratio, count=400):
    """Ring stages within the limits of the search, some just within, and their frame."""
    frame, dice = search_frame(Requirements(ratio=ratio)), np.random.default_rng(ratio)
    radius = dice.uniform(0.012, 0.1, count)
    throw = dice.uniform(0.25, 0.95, count) * radius / (ratio + 1)
    tooth = dice.uniform(0.1, 0.9, count) * radius * math.sin(math.pi / (ratio + 1))
    rings = shapes.RingSizes(radius, throw, tooth)
    met = shapes.profile_checks(frame, rings)
    return frame, rings.rows(np.logical_and.reduce(list(met.values()))), dice


@pytest.mark.parametrize("ratio", RATIOS)
def test_pin_circles_are_those_of_the_plain_way(ratio):
    """Holes that nothing of the profile reaches included."""
    frame, rings, dice = some_rings(ratio)
    hole = rings.eccentricity[:, None, None] + np.array([1e-4, 2e-3, 6e-3])
    offset = np.linspace(0.0, math.pi / ratio, 5)[None, :, None]
    found = shapes.largest_pin_circle(frame, rings, hole, offset)
    assert found.shape == (rings.eccentricity.size, 5, 3)
    assert found == pytest.approx(plain.largest_pin_circle(frame, rings, hole, offset), abs=1e-12)
    one = dice.uniform(0.0, math.pi / ratio, rings.eccentricity.size)
    own = shapes.largest_pin_circle(frame, rings, hole[:, 0, 1], one)
    assert own == pytest.approx(
        plain.largest_pin_circle(frame, rings, hole[:, 0, 1], one), abs=1e-12
    )


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("wire", [0.05e-3, 0.15e-3, 0.5e-3])
def test_the_wire_passes_where_the_plain_way_says_so(ratio, wire):
    frame, rings, _ = some_rings(ratio)
    frame = replace(frame, wire_radius=wire)
    found = shapes.relief_passes_wire(frame, rings)
    assert found.dtype == bool
    assert (found == plain.relief_passes_wire(frame, rings)).all()


@pytest.mark.parametrize("ratio", RATIOS)
def test_areas_are_those_of_the_plain_way(ratio):
    frame, rings, _ = some_rings(ratio)
    found, wanted = (way.profile_integrals(frame, rings) for way in (shapes, plain))
    for one, other in zip(found, wanted, strict=True):
        assert one == pytest.approx(other, rel=1e-12)


def test_no_rings_have_no_limits():
    frame, rings, _ = some_rings(10)
    none = rings.rows(np.zeros(0, dtype=int))
    assert shapes.relief_passes_wire(frame, none).shape == (0,)
    assert shapes.largest_pin_circle(frame, none, np.zeros((0, 2)), np.zeros((0, 2))).shape == (
        0,
        2,
    )
