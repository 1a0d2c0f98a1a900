"""Views of stacks in closed form, and how what is stacked comes apart."""

from __future__ import annotations

import math

import numpy as np
import pytest

from cqdd_design.design import load_design
from cqdd_design.solids.apart import taken_apart
from cqdd_design.solids.axial_view import cut_rectangles, lines_behind
from cqdd_design.solids.end_view import visible_edges
from cqdd_design.solids.layers import Annulus, Drilling, on_circle, turned
from cqdd_design.solids.part import Part, on_axis
from cqdd_design.solids.poses import HOUSING
from cqdd_design.solids.slabs import stack_slabs

CUP = turned([Annulus(0.0, 2e-3, 0.0, 10e-3), Annulus(2e-3, 8e-3, 6e-3, 10e-3)])


@pytest.fixture(scope="module")
def design(paper_design_file):
    return load_design(paper_design_file)


def as_mm(lines):
    return sorted(
        tuple(round(1e3 * v, 6) for p in line for v in (p.real, p.imag)) for line in lines
    )


def test_a_section_of_a_cup_has_its_walls_and_the_edges_of_its_bore():
    found = [
        (r.bottom, r.top, r.inner, r.outer) for r in cut_rectangles(stack_slabs(CUP), math.pi / 7)
    ]
    assert np.allclose(found, [(0.0, 2e-3, 0.0, 10e-3), (2e-3, 8e-3, 6e-3, 10e-3)])
    behind = lines_behind(CUP.layers, math.pi / 7, upper=True)
    # The bore's far wall ends at the mouth; at the floor the cut face itself is the edge.
    assert as_mm(behind) == [(8.0, 0.0, 8.0, 6.0)]
    assert as_mm(lines_behind(CUP.layers, math.pi / 7, upper=False)) == [(8.0, -6.0, 8.0, 0.0)]


def test_a_hole_beside_the_plane_shows_only_where_a_bore_lets_it_be_seen():
    # A ring with an axial hole at 90 deg: behind a section along 0 deg it is within the material.
    hole = Drilling(on_circle(1, 8e-3, math.pi / 2), 1e-3, 0.0, 5e-3)
    ring = turned([Annulus(0.0, 5e-3, 6e-3, 10e-3)], [hole])
    plain = turned([Annulus(0.0, 5e-3, 6e-3, 10e-3)])
    for upper in (True, False):
        one = lines_behind(ring.layers, 0.0, upper=upper)
        assert as_mm(one) == as_mm(lines_behind(plain.layers, 0.0, upper=upper))
    along = cut_rectangles(stack_slabs(ring), math.pi / 2)
    assert np.allclose([(r.inner, r.outer) for r in along], [(6e-3, 7e-3), (9e-3, 10e-3)])


def test_along_the_axis_only_the_edges_on_the_near_side_are_seen():
    blind = Drilling(on_circle(4, 8e-3, 0.0), 1e-3, 5e-3, 8e-3)
    cup = turned([Annulus(0.0, 2e-3, 0.0, 10e-3), Annulus(2e-3, 8e-3, 6e-3, 10e-3)], [blind])
    above = sorted(round(1e3 * e.radius, 6) for e in visible_edges(cup.layers, from_above=True))
    below = sorted(round(1e3 * e.radius, 6) for e in visible_edges(cup.layers, from_above=False))
    assert above == [1.0, 1.0, 1.0, 1.0, 6.0, 10.0]
    assert below == [10.0]


def test_an_edge_that_is_partly_covered_is_cut_where_it_goes_under():
    # A bridge of radius 5 mm about (6 mm, 0) lies over a disc of 8 mm.
    low = turned([Annulus(0.0, 1e-3, 0.0, 8e-3)])
    over = turned([Annulus(1e-3, 2e-3, 0.0, 5e-3)]).layers[0]
    moved = type(over)(over.shape.transformed(shift=(6e-3, 0.0)), over.bottom, over.top)
    pieces = [
        e
        for e in visible_edges([*low.layers, moved], from_above=True)
        if abs(e.radius - 8e-3) < 1e-9
    ]
    # The circles meet where x = (64 + 36 - 25)/12 mm.
    covered = 2.0 * math.acos((64.0 + 36.0 - 25.0) / 12.0 / 8.0)
    seen = sum(abs(e.sweep) for e in pieces)
    assert math.isclose(seen, 2.0 * math.pi - covered, abs_tol=2e-3)


def part(name, shape):
    return Part(name, shape, "7075-T6", (0.5, 0.5, 0.5), "buy", name, on_axis(name, HOUSING))


def ways(design, *parts):
    steps, whole = taken_apart(design, parts)
    return [(step.moved[0].name, step.way) for step in steps if not step.is_unit], whole


def test_what_stands_in_a_cup_leaves_at_its_mouth(design):
    core = part("core", turned([Annulus(2e-3, 12e-3, 0.0, 6e-3)]))
    steps, whole = ways(design, part("cup", CUP), core)
    assert whole
    assert steps[0] in [("core", "up"), ("cup", "down")]


def test_what_is_shut_in_is_not_said_to_leave(design):
    lid = turned([Annulus(0.0, 2e-3, 0.0, 10e-3), Annulus(2e-3, 8e-3, 6e-3, 10e-3),
                  Annulus(8e-3, 9e-3, 3e-3, 10e-3)])  # fmt: skip
    core = part("core", turned([Annulus(2e-3, 7e-3, 0.0, 5e-3)]))
    steps, whole = ways(design, part("jar", lid), core)
    assert not whole
    assert steps == []
