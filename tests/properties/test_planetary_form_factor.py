"""Tooth roots of ISO 6336-3 against teeth generated from their tools: no formula is shared."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from planetary_teeth import RACK, rack_fillet, ring_fillet

from cqdd_design.planetary.cutting_tools import BasicRack, PinionCutter
from cqdd_design.planetary.iso6336.form_factor import (
    load_diameter,
    pair_tooth_forms,
    root_section,
    tooth_form,
)
from cqdd_design.planetary.profile_shift import least_shift_without_undercut
from cqdd_design.planetary.tooth_geometry import GearPair


def section_at(points, normals, centre_line, degrees):
    """Chord, distance along the centre line and fillet radius where the tangent makes `degrees`."""
    tangents = np.stack([-normals[:, 1], normals[:, 0]], axis=1)
    angles = np.degrees(np.arccos(np.clip(np.abs(tangents @ centre_line), 0.0, 1.0)))
    across = np.array([-centre_line[1], centre_line[0]])
    crossings = np.nonzero((angles[:-1] - degrees) * (angles[1:] - degrees) <= 0.0)[0]
    assert len(crossings), "the fillet never reaches the critical tangent"
    found = []
    for i in crossings:
        share = (degrees - angles[i]) / (angles[i + 1] - angles[i])
        point = points[i] + share * (points[i + 1] - points[i])
        step = np.linalg.norm(points[i + 1] - points[i])
        (ax, ay), (bx, by) = normals[i], normals[i + 1]
        turned = math.asin(ax * by - ay * bx)
        found.append(
            (2.0 * abs(float(point @ across)), float(point @ centre_line), step / abs(turned))
        )
    # The other crossing, if any, belongs to the neighbouring tooth across the space: further off.
    return min(found)


@given(st.integers(17, 200), st.floats(-0.2, 0.5))
def test_external_root_is_the_one_a_rack_cuts(teeth, extra):
    shift = max(extra, least_shift_without_undercut(teeth))
    points, normals = rack_fillet(teeth, shift)
    tooth = np.array([math.cos(math.pi / teeth), math.sin(math.pi / teeth)])
    chord, distance, radius = section_at(points, normals, tooth, 30.0)
    section = root_section(float(teeth), shift, RACK)
    assert section.chord == pytest.approx(chord, abs=2e-6)
    assert section.height == pytest.approx(2.0 * distance, abs=2e-6)
    assert section.fillet_radius == pytest.approx(radius, rel=1e-3)


@pytest.mark.parametrize(
    ("ring", "cutter", "radius"),
    [(70, 20, 0.34), (70, 20, 0.25), (70, 25, 0.30), (120, 30, 0.30), (70, 35, 0.38)],
)
def test_internal_root_is_near_the_one_a_pinion_cutter_cuts(ring, cutter, radius):
    """Eq. 11 is a fit; the module's docstring states how far off it is."""
    rack = BasicRack(fillet_radius=radius)
    tooth = np.array([math.cos(math.pi / ring), math.sin(math.pi / ring)])
    chord, distance, fillet = section_at(*ring_fillet(ring, cutter, rack), tooth, 60.0)
    section = root_section(-float(ring), 0.0, BasicRack(), PinionCutter(cutter, radius))
    assert 0.90 < section.chord / chord < 0.96
    assert 1.0 < section.fillet_radius / fillet < 1.04
    assert -section.height / 2.0 == pytest.approx(distance, abs=0.01)


@pytest.mark.parametrize("index", [0, 1])
def test_moment_arm_is_the_distance_from_chord_to_load_line(index):
    """The load line, tangent to the base circle, crosses the centre line h_Fe from the chord."""
    pair = GearPair(22, -70, 1.0e-3, 12e-3)
    form = pair_tooth_forms(pair)[index]
    teeth = (22, -70)[index]
    tip = pair.tip_diameters[index]
    point = abs(load_diameter(teeth, teeth, tip, pair.transverse_contact_ratio, pair)) / 2.0
    base = abs(teeth) / 2.0 * math.cos(RACK.pressure_angle)
    # Half the tooth's angular thickness at the load circle; a ring's teeth grow thicker outward.
    angle = math.acos(base / point)
    involute = math.tan(RACK.pressure_angle) - RACK.pressure_angle - (math.tan(angle) - angle)
    half = math.pi / 2.0 / abs(teeth) + math.copysign(1.0, teeth) * involute
    where = np.array([point * math.cos(half), point * math.sin(half)])
    # The load acts along the tangent to the base circle that crosses the tooth (external), or that
    # leaves it (ring, whose teeth point at the base circle).
    foot_angle = half - math.copysign(1.0, teeth) * angle
    foot = base * np.array([math.cos(foot_angle), math.sin(foot_angle)])
    slope = where - foot
    crossing = where[0] - where[1] * slope[0] / slope[1]
    section = root_section(float(teeth), 0.0, RACK, pair.ring_cutter)
    arm = abs(crossing - abs(section.height) / 2.0)
    assert form.moment_arm == pytest.approx(arm, rel=1e-9)


@given(st.integers(14, 300), st.floats(0.0, 0.3))
def test_load_nearer_the_tip_bends_more(teeth, down):
    shift = max(0.0, least_shift_without_undercut(teeth))
    tip = teeth + 2.0 * (1.0 + shift)
    lower = tooth_form(float(teeth), shift, RACK, tip - 2.0 * down - 0.02)
    assert lower.form_factor < tooth_form(float(teeth), shift, RACK, tip).form_factor


@given(st.integers(20, 300))
def test_rack_is_the_limit_of_both_kinds(teeth):
    """Y_F of large external gears grows toward one limit as teeth are added."""
    forms = [
        tooth_form(float(z), 0.0, RACK, z + 2.0).form_factor for z in (teeth, 2 * teeth, 10**6)
    ]
    assert forms[0] > forms[1] > forms[2]
