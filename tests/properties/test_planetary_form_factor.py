"""Tooth roots of ISO 6336-3 against teeth generated from their tools: no formula is shared."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cqdd_design.planetary.iso6336.form_factor import (
    load_diameter,
    pair_tooth_forms,
    root_section,
    tooth_form,
)
from cqdd_design.planetary.profile_shift import least_shift_without_undercut
from cqdd_design.planetary.tooth_geometry import BasicRack, GearPair

RACK = BasicRack()


def envelope(
    centres: np.ndarray, pitch: float, rho: float, turns: np.ndarray, outward: bool
) -> tuple[np.ndarray, np.ndarray]:
    """Points and unit normals (k, 2), in the gear's frame, that a rolling tool's rounding cuts.

    `centres` (k, 2) are the rounding's centre in the fixed frame, the gear's centre at the origin
    and the pitch point on +x; the gear has then turned by `turns` (k,). The common normal passes
    through the pitch point, so the fillet is the centre's path offset along it: outward into a
    ring, inward into an external gear.
    """
    toward = centres - np.array([pitch, 0.0])
    units = toward / np.linalg.norm(toward, axis=1, keepdims=True)
    radial = np.sum(units * centres, axis=1)
    units = np.where(((radial > 0.0) == outward)[:, None], units, -units)
    cosines, sines = np.cos(-turns), np.sin(-turns)
    rotations = np.moveaxis(np.array([[cosines, -sines], [sines, cosines]]), -1, 0)
    points = np.einsum("kij,kj->ki", rotations, centres + rho * units)
    return points, np.einsum("kij,kj->ki", rotations, units)


def rack_fillet(teeth: int, shift: float) -> tuple[np.ndarray, np.ndarray]:
    """Fillet that a rack's rounded tip cuts into an external gear, module 1, a SPACE on +x.

    A rack tooth is pi/2 wide on its reference line; its rounding is tangent to flank and tip line.
    The rack moves along y by pi/2 m z times the gear's turn.
    """
    alpha, rho = RACK.pressure_angle, RACK.fillet_radius
    depth = RACK.dedendum - rho
    centre_y = math.pi / 4 - depth * math.tan(alpha) - rho / math.cos(alpha)
    rolls = np.linspace(-6.0, 2.0, 16001)
    centres = np.stack([np.full_like(rolls, teeth / 2.0 + shift - depth), centre_y + rolls], axis=1)
    return envelope(centres, teeth / 2.0, rho, rolls / (teeth / 2.0), outward=False)


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


def cutter_fillet(ring: int, cutter: int, rack: BasicRack) -> tuple[np.ndarray, np.ndarray]:
    """Fillet that a pinion cutter's rounded tip cuts into an unshifted ring, a SPACE on +x.

    The rounding is tangent to the cutter's involute and tip circle, so its centre lies on a tangent
    of the base circle, one rounding radius nearer the base than the involute.
    """
    alpha, rho = rack.pressure_angle, rack.fillet_radius
    distance = (ring - cutter) / 2.0
    base = cutter / 2.0 * math.cos(alpha)
    centre_radius = ring / 2.0 + rack.dedendum - distance - rho
    along = math.sqrt(centre_radius**2 - base**2)
    half_base = math.pi / 2.0 / cutter + math.tan(alpha) - alpha
    # The tangent's foot stands as far round as the string is long: (along + rho)/base.
    foot = half_base - (along + rho) / base
    turns = np.linspace(-1.0, 0.6, 40001)
    angles = turns + foot + math.atan2(along, base)
    centres = np.stack(
        [distance + centre_radius * np.cos(angles), centre_radius * np.sin(angles)], axis=1
    )
    return envelope(centres, ring / 2.0, rho, turns * cutter / ring, outward=True)


@pytest.mark.parametrize(
    ("ring", "cutter", "radius"),
    [(70, 20, 0.38), (70, 20, 0.25), (70, 25, 0.30), (120, 30, 0.30), (70, 35, 0.38)],
)
def test_internal_root_is_near_the_one_a_pinion_cutter_cuts(ring, cutter, radius):
    """Eq. 11 is a fit; the module's docstring states how far off it is."""
    rack = BasicRack(fillet_radius=radius)
    tooth = np.array([math.cos(math.pi / ring), math.sin(math.pi / ring)])
    chord, distance, fillet = section_at(*cutter_fillet(ring, cutter, rack), tooth, 60.0)
    section = root_section(-float(ring), 0.0, rack, cutter)
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
    section = root_section(float(teeth), 0.0, RACK)
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
