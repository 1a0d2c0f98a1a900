"""Half grooves of the ring's dowels and pinwheel pockets, as the wire cuts them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from cqdd_design.catalog.dowels import dowels
from cqdd_design.catalog.fits import fit_limits
from cqdd_design.design import load_design
from cqdd_design.errors import GeometryError, ReadBackError
from cqdd_design.exporting.edm.begin import begun, tab_of
from cqdd_design.exporting.edm.exact_curves import grooved_curve
from cqdd_design.exporting.edm.flat_parts import flat_parts, seats_of
from cqdd_design.exporting.edm.gcode import program
from cqdd_design.exporting.edm.gcode_check import check_program
from cqdd_design.exporting.edm.loops import Loop, fit_of
from cqdd_design.exporting.edm.passes import wire_passes
from cqdd_design.exporting.edm.readback import read_back
from cqdd_design.geometry.contours import as_complex
from cqdd_design.geometry.grooves import edge_radius, groove_half_angle, grooved_circle
from cqdd_design.machine import resolve
from cqdd_design.roads.export import export
from cqdd_design.solids.features import zones
from cqdd_design.solids.features.holes import FittedHole


@pytest.fixture(scope="module")
def paper(paper_design_file):
    return load_design(paper_design_file)


@pytest.fixture(scope="module")
def pinwheel(paper):
    return paper.replacing({"reducer.ring_type": "pinwheel"})


def test_a_dowel_goes_in_wherever_halves_that_are_cut_apart_meet(paper):
    """Two half discs that are shifted along their seam leave room for the circle less the shift."""
    parts = {part.name: part for part in resolve(paper).parts}
    (ring,), (housing,) = (
        [one for one in parts[name].features if isinstance(one, FittedHole) and one.seam]
        for name in ("ring", "housing")
    )
    missed = 0.5 * (ring.position + housing.position)
    sizes = {one.diameter for one in dowels()}
    assert len(sizes) == 11
    for size in sizes:
        groove, dowel = fit_limits(ring.zone, size), fit_limits(zones.DOWEL, size)
        assert groove.lower - dowel.upper >= missed > 0.0, size
    assert housing.zone == ring.zone


@given(st.floats(10e-3, 0.1), st.integers(3, 12), st.floats(0.4e-3, 1.5e-3), st.floats(-3.0, 3.0))
@settings(max_examples=examples(20), deadline=None)
def test_the_contour_is_its_circles_and_tangent_at_every_joint(radius, count, groove, turn):
    angles = [turn + 2.0 * math.pi * k / count for k in range(count)]
    contour = grooved_circle(radius, angles, groove)
    points = as_complex(contour.points)
    loop = Loop(points, np.roll(points, -1), contour.bulges)
    fit = fit_of(loop, grooved_curve(radius, angles, groove), outer=True)
    assert fit.largest_deviation < 1e-12
    assert fit.tangent_break < 1e-9
    assert abs(fit.perimeter_error) < 1e-12
    assert abs(fit.area_error) < 1e-14
    assert fit.least_concave_radius == pytest.approx(groove, rel=1e-9)
    # Less than the circle by half discs and a little of the edges: by the lens of two circles.
    taken = (math.pi * radius**2 - contour.moments().area) / count
    cut = (
        groove**2 * math.acos(0.5 * groove / radius)
        + radius**2 * math.acos(1.0 - 0.5 * (groove / radius) ** 2)
        - 0.5 * groove * math.sqrt(4.0 * radius**2 - groove**2)
    )
    assert cut < taken < cut + edge_radius(groove) ** 2
    # On the bottom of a groove, and on the land beside it.
    bottom = (radius - groove) * np.exp(1j * angles[0])
    assert contour.distances(np.array([[bottom.real, bottom.imag]]))[0] < 1e-12
    land = radius * np.exp(1j * (angles[0] + groove_half_angle(radius, groove)))
    assert np.abs(points - land).min() < 1e-12


def test_too_many_grooves_are_refused_with_what_to_change():
    with pytest.raises(GeometryError, match=r"ring\.outer_diameter"):
        grooved_circle(10e-3, [0.3 * k for k in range(20)], 2e-3)


def test_grooves_stand_where_the_dowels_of_the_machine_are(paper):
    machine = resolve(paper)
    dowels, ring = machine.layout.dowels, flat_parts(machine)[-1]
    seat = next(one for one in seats_of(ring) if one.contour == 0)
    assert len(dowels.angles) == 8
    for angle in dowels.angles:
        centre = 36e-3 * np.exp(1j * angle)
        away = np.abs(as_complex(ring.shape.outer.sample(1e-6)) - centre).min()
        # The wire is shifted by the seat's: what is left is the middle of 1.5 D8.
        assert away - seat.shift == pytest.approx(0.5 * 1.527e-3, abs=2e-7)
    (solid,) = (part for part in machine.parts if part.name == "ring")
    assert all(layer.shape.outer.length() > 2.0 * math.pi * 36e-3 for layer in solid.shape.layers)


@pytest.mark.parametrize("ring_type", ["solid", "pinwheel"])
def test_the_tab_of_the_outside_is_on_a_land(paper, pinwheel, ring_type):
    machine = resolve(paper if ring_type == "solid" else pinwheel)
    ring = flat_parts(machine)[-1]
    first = complex(*begun(ring, 0).points[0])
    middle = np.angle(first) - 0.5 * tab_of(ring.shape.outer) / 36e-3
    away = np.angle(np.exp(1j * (np.array(machine.layout.dowels.angles) - middle)))
    assert 36e-3 * np.abs(away).min() > 0.5 * tab_of(ring.shape.outer) + 1e-3


def test_files_of_a_pinwheel_ring_are_read_back_and_its_pockets_have_a_fit(pinwheel, tmp_path):
    machine = resolve(pinwheel)
    ring = flat_parts(machine)[-1]
    outside, pockets = seats_of(ring)
    assert (str(outside), str(pockets)) == ("72 n6 (+0.039/+0.02)", "7 H7 (+0.015/+0)")
    text = program(ring, pinwheel)
    cuts = check_program(text, ring, pinwheel.edm)
    # Pockets are cut first: their last pass runs by a quarter of H7 nearer to the material.
    passes = wire_passes(ring.contours, pinwheel.edm, 4)
    assert cuts[0].wall[-1].register == 24
    assert "SEAT DIA 7 H7" in text
    assert f"{1e3 * (passes[-1].offset + pockets.shift):.4f}" in text
    assert pockets.shift == pytest.approx(-3.75e-6)
    files = {one.path.name: one.path for one in export(pinwheel, "edm", tmp_path)}
    path = files["cqdd-10-ring.dxf"]
    assert read_back(path, ring, pinwheel.edm, wire_paths=True).segments == 33
    # The same file is not that of a ring whose grooves stand elsewhere.
    other = flat_parts(resolve(pinwheel.replacing({"reducer.ring_type": "solid"})))[-1]
    with pytest.raises(ReadBackError):
        read_back(path, other, pinwheel.edm, wire_paths=True)


def test_rollers_run_in_pockets_without_a_seat(pinwheel):
    rolling = pinwheel.replacing(
        {"reducer.ring_pin_diameter": "5 mm", "reducer.ring.roller_diameter": "7 mm"}
    )
    ring = flat_parts(resolve(rolling))[-1]
    assert [one.contour for one in seats_of(ring)] == [0]
