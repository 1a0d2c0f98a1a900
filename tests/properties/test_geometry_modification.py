"""Every modification by the gap it leaves at every tooth: size and sign."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from examples import examples
from geometry_designs import PAPER, discs, tooth_gaps
from hypothesis import given, settings
from hypothesis import strategies as st

from cqdd_design.errors import GeometryError
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.meshing import project

PHI = np.linspace(0.0, 2.0 * math.pi, 61)
UNIT = np.array([1.0, 1j])


def _parameters(disc: CycloidDisc) -> np.ndarray:
    """Parameter at which each tooth would touch the unmodified disc, at angles `PHI`."""
    teeth = 2.0 * math.pi * np.arange(disc.ring_tooth_count) / disc.ring_tooth_count
    return teeth + PHI[:, None] / disc.lobe_count


def _arm(disc: CycloidDisc) -> np.ndarray:
    """Lever arm of each contact normal about the disc's centre, m, unmodified disc."""
    point, normal = disc.flank(_parameters(disc)) @ UNIT, disc.normal(_parameters(disc)) @ UNIT
    return np.abs((np.conj(point) * normal).imag)


@settings(max_examples=examples(25), deadline=None)
@given(discs(), st.floats(-1e-4, 1e-4))
def test_equidistant_leaves_exactly_its_gap_at_every_tooth(disc: CycloidDisc, c: float) -> None:
    c *= 100.0 * min(1e-2, 0.05 * disc.tooth_radius)
    finished = replace(disc, equidistant=c)
    assert np.abs(tooth_gaps(finished, PHI).gap - c).max() < 1e-9


@settings(max_examples=examples(25), deadline=None)
@given(discs(), st.floats(0.05, 1.0))
def test_radial_leaves_its_projection_on_the_normal(disc: CycloidDisc, share: float) -> None:
    """gap = dR cos(beta), cos(beta) = (1 - K1 cos nt) / D: positive at every tooth."""
    dR = share * 1e-3 * disc.tooth_radius
    gap = tooth_gaps(replace(disc, radial=dR), PHI).gap
    t, K = _parameters(disc), disc.shortening_coefficient
    D = np.abs(1.0 - K * np.exp(1j * disc.lobe_count * t))
    lean = (1.0 - K * np.cos(disc.lobe_count * t)) / D
    # Second order: the shift squared over the closest curvatures, at tips and valleys.
    sharp = 1.0 / disc.min_convex_radius + 1.0 / (disc.min_concave_radius - disc.tooth_radius)
    assert np.abs(gap - dR * lean).max() < dR**2 * sharp + 1e-10
    assert gap.min() > 0.0


def test_negative_modification_cuts_interference() -> None:
    for change in ({"equidistant": -5e-6}, {"radial": -5e-6}):
        assert tooth_gaps(replace(PAPER, **change), PHI).gap.max() < -1e-6


def test_published_initial_gap_of_a_modified_pair() -> None:
    """CN105404737A: gap after turning the disc until its first tooth touches.

    drr (1 - sin a/S) - dR (1 - K1 cos a - sqrt(1 - K1^2) sin a) / S, S = |1 - K1 e^{ia}|, with drr
    their growth of the tooth and dR their growth of the pitch circle, opposite to ours.
    """
    drr, dR = 8e-6, 12e-6
    finished = replace(PAPER, equidistant=drr, radial=dR)
    n, K = PAPER.lobe_count, PAPER.shortening_coefficient
    a = np.linspace(0.05, math.pi - 0.05, 40)
    S = np.abs(1.0 - K * np.exp(1j * a))
    turned = math.acos(K)
    angle, phi = np.append(a, turned) / n, np.append(a, turned)
    # Tooth 0 touches at t = phi / n: one crank angle for every parameter.
    gap = tooth_gaps(finished, phi).gap[:, 0]
    assert angle[-1] == pytest.approx(turned / n)
    measured = gap[:-1] - np.sin(a) / S * gap[-1]
    published = (
        drr * (1.0 - np.sin(a) / S)
        + dR * (1.0 - K * np.cos(a) - math.sqrt(1.0 - K * K) * np.sin(a)) / S
    )
    assert np.abs(measured - published).max() < 5e-8
    assert published.max() > 5e-6


@settings(max_examples=examples(25), deadline=None)
@given(discs(), st.floats(0.05, 1.0))
def test_rotation_gap_grows_with_the_lever_arm(disc: CycloidDisc, share: float) -> None:
    delta = share * 1e-4
    finished = replace(disc, rotation=delta)
    found = tooth_gaps(finished, PHI)
    gap = found.gap
    assert gap.min() > -1e-12
    # On the turned flanks, not on the blended tip and valley, the gap is delta times the arm.
    pitch = 2.0 * disc.half_pitch
    inner = disc.half_pitch - np.abs(np.mod(found.parameter, pitch) - disc.half_pitch)
    on_flank = (inner > finished.breaks[1]) & (inner < finished.breaks[2])
    arm = _arm(disc)
    # Second order: the lateral shift squared over the closest curvatures, at tips and valleys.
    sharp = 1.0 / disc.min_convex_radius + 1.0 / (disc.min_concave_radius - disc.tooth_radius)
    second = (delta * disc.ring_pitch_radius) ** 2 * sharp
    assert np.abs(gap - delta * arm)[on_flank].max() < second + 1e-10
    assert np.corrcoef(gap[on_flank], arm[on_flank])[0, 1] > 0.9


@settings(max_examples=examples(25), deadline=None)
@given(discs(), st.floats(0.05, 1.0))
def test_rotated_profile_stays_inside_both_turned_profiles(disc: CycloidDisc, share: float) -> None:
    delta = share * 0.2 * math.pi / (8 * disc.lobe_count)
    finished = replace(disc, rotation=delta)
    points = finished.flank(np.linspace(0.0, 2.0 * disc.half_pitch, 801)) @ UNIT
    for sign in (1.0, -1.0):
        turned = points * np.exp(sign * 1j * delta)
        depth = project(disc, np.stack([turned.real, turned.imag], axis=-1)).distance
        assert depth.max() < 1e-11
    assert finished.tip_arc.radius > 0.0


def test_rotation_leaves_a_round_tip_of_about_three_quarters_of_the_lobe_radius() -> None:
    """Three quarters on a straight row of lobes; bent round the disc it is 3 / (4/rho - 1/a)."""
    bend = float(PAPER.curvature(PAPER.half_pitch))
    finished = replace(PAPER, rotation=math.radians(1.0 / 60.0))
    expected = 3.0 / (4.0 * bend - 1.0 / PAPER.tip_distance)
    assert finished.tip_arc.radius == pytest.approx(expected, rel=1e-4)
    assert 0.7 < finished.tip_arc.radius * bend < 0.85


def test_too_much_rotation_is_refused_with_its_limit() -> None:
    with pytest.raises(
        GeometryError, match=r"modification.rotation 180 arcmin is outside 0 to 134"
    ):
        replace(PAPER, rotation=math.radians(3.0))
