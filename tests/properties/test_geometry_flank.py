"""The flank against its definition, its derivatives, and known wrong forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from examples import examples
from geometry_designs import CYCLOIDGEN, PAPER, discs, tooth_gaps
from hypothesis import given, settings
from hypothesis import strategies as st

from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.trochoid import locus_curvature, undercut_radius_limit

EXACT = 1e-12
UNIT = np.array([1.0, 1j])


@settings(max_examples=examples(40), deadline=None)
@given(discs())
def test_flank_is_the_parallel_of_the_locus(disc: CycloidDisc) -> None:
    t = np.linspace(0.0, 2.0 * math.pi / disc.lobe_count, 101)
    flank, locus = disc.flank(t) @ UNIT, disc.locus(t) @ UNIT
    # Exactly one tooth radius away from its own point of the locus ...
    assert np.abs(np.abs(flank - locus) - disc.tooth_radius).max() < EXACT
    # ... along the common normal ...
    step = 1e-6
    slope = (disc.locus(t + step) - disc.locus(t - step)) @ UNIT
    assert np.abs(((flank - locus) * np.conj(slope)).real / np.abs(slope)).max() < 1e-9
    # ... and no other point of the locus is nearer.
    around = np.linspace(-0.5, 1.5, 1201) * 2.0 * math.pi / disc.lobe_count
    others = np.abs(flank[:, None] - disc.locus(around) @ UNIT).min(axis=1)
    assert others.min() >= disc.tooth_radius - EXACT


@settings(max_examples=examples(40), deadline=None)
@given(discs(modified=True))
def test_tangent_speed_and_curvature_are_derivatives(disc: CycloidDisc) -> None:
    for begin, end in zip(disc.breaks[:-1], disc.breaks[1:], strict=True):
        inside = begin + (end - begin) * np.linspace(0.05, 0.95, 41)
        step = 1e-4 * (end - begin)
        ahead, behind = disc.flank(inside + step) @ UNIT, disc.flank(inside - step) @ UNIT
        slope = (ahead - behind) / (2.0 * step)
        speed = disc.speed(inside)
        assert np.allclose(slope, speed * (disc.tangent(inside) @ UNIT), atol=2e-5 * speed.max())
        turn = (disc.tangent(inside + step) @ UNIT) / (disc.tangent(inside - step) @ UNIT)
        bend = np.angle(turn) / (2.0 * step) / speed
        assert np.allclose(bend, disc.curvature(inside), atol=1e-5 * np.abs(bend).max() + 1e-4)
    t = np.linspace(0.0, 2.0 * math.pi, 91)
    assert np.allclose(disc.tangent(t) @ UNIT, 1j * (disc.normal(t) @ UNIT), atol=1e-15)


@settings(max_examples=examples(40), deadline=None)
@given(discs(modified=True))
def test_finished_profile_is_smooth_symmetric_and_star_shaped(disc: CycloidDisc) -> None:
    pitch = 2.0 * math.pi / disc.lobe_count
    for at in disc.breaks:
        before, after = disc.flank(at - 1e-12) @ UNIT, disc.flank(at + 1e-12) @ UNIT
        assert abs(before - after) < 1e-11
        assert abs(disc.tangent(at - 1e-12) @ UNIT - disc.tangent(at + 1e-12) @ UNIT) < 1e-8
    t = np.linspace(0.0, pitch, 257)
    profile = disc.flank(t) @ UNIT
    assert (
        np.abs(profile - np.exp(1j * pitch) * np.conj(disc.flank(pitch - t) @ UNIT)).max() < EXACT
    )
    assert np.abs(disc.flank(t + 2.0 * pitch) @ UNIT - np.exp(2j * pitch) * profile).max() < EXACT
    assert np.all(np.diff(np.unwrap(np.angle(profile))) > 0.0)
    assert np.abs(profile).max() == pytest.approx(disc.tip_distance, rel=1e-12)
    assert np.abs(profile).min() == pytest.approx(disc.valley_distance, rel=1e-12)


@settings(max_examples=examples(60), deadline=None)
@given(discs(modified=True))
def test_least_radii_are_those_of_the_finished_profile(disc: CycloidDisc) -> None:
    bend = disc.curvature(np.linspace(0.0, disc.half_pitch, 20_001))
    assert 1.0 / bend.max() == pytest.approx(disc.min_convex_radius, rel=1e-4)
    if disc.rotation > 0.0:
        bend = disc.curvature(disc.rotation + np.linspace(0.0, disc.half_pitch / 2.0, 20_001))
    if disc.min_concave_radius < 10.0:
        assert -1.0 / bend.min() == pytest.approx(disc.min_concave_radius, rel=1e-4)
    else:
        assert bend.min() > -0.11


@given(st.integers(3, 119), st.floats(0.01, 0.2), st.floats(0.05, 0.98))
def test_undercut_limit_is_the_least_convex_radius(n: int, R: float, K: float) -> None:
    e = K * R / (n + 1)
    bend = locus_curvature(n, R, e, np.linspace(0.0, math.pi / n, 20_001))
    assert float(undercut_radius_limit(n, R, e)) == pytest.approx(1.0 / bend.max(), rel=1e-5)


@given(discs(modified=True), st.floats(0.3, 30.0))
def test_profile_scales(disc: CycloidDisc, factor: float) -> None:
    larger = CycloidDisc(
        disc.lobe_count,
        *(
            factor * value
            for value in (
                disc.ring_pitch_radius,
                disc.eccentricity,
                disc.tooth_radius,
                disc.equidistant,
                disc.radial,
            )
        ),
        disc.rotation,
    )
    t = np.linspace(0.0, 2.0 * math.pi, 61)
    assert np.allclose(larger.flank(t), factor * disc.flank(t), rtol=0, atol=1e-10 * factor)


def test_psi_form_agrees_with_a_minus_and_misses_by_millimetres_with_a_plus() -> None:
    """The form with psi found in many tutorials, with both signs."""
    n, R, e, r = 10, 0.032, 0.0016, 0.0035
    t = np.linspace(0.0, 2.0 * math.pi, 2001)
    angle = np.arctan2(np.sin(n * t), R / (e * (n + 1)) - np.cos(n * t))

    def profile(psi: np.ndarray) -> np.ndarray:
        return R * np.exp(1j * t) - r * np.exp(1j * (t + psi)) - e * np.exp(1j * (n + 1) * t)

    right = PAPER.flank(t) @ UNIT
    assert np.abs(profile(-angle) - right).max() < EXACT
    assert np.abs(profile(angle) - right).max() > 1e-3


@pytest.mark.parametrize(("R", "r", "e", "n"), CYCLOIDGEN)
def test_full_revolution_meshes_and_wrong_lobe_counts_jam(
    R: float, r: float, e: float, n: int
) -> None:
    phi = np.linspace(0.0, 2.0 * math.pi * n, 36 * n, endpoint=False)
    gap = tooth_gaps(CycloidDisc(n, R, e, r), phi).gap
    assert np.abs(gap).max() < 1e-9
    for wrong in (n - 1, n + 1):
        # The same ring of n + 1 teeth, a disc with one lobe too few or too many, same ratio.
        disc = CycloidDisc(wrong, R, e, r)
        assert _worst_interference(disc, n, phi[:: n // 3]) > 1e-4


def _worst_interference(disc: CycloidDisc, n: int, phi: np.ndarray) -> float:
    from cqdd_design.geometry.meshing import project

    teeth = disc.ring_pitch_radius * np.exp(2j * math.pi * np.arange(n + 1) / (n + 1))
    moved = (teeth - disc.eccentricity * np.exp(1j * phi[:, None])) * np.exp(1j * phi[:, None] / n)
    distance = project(disc, np.stack([moved.real, moved.imag], axis=-1)).distance
    return float(disc.tooth_radius - distance.min())


@settings(max_examples=examples(25), deadline=None)
@given(discs(), st.floats(0.0, 100.0))
def test_every_tooth_touches_where_the_closed_form_says(disc: CycloidDisc, phi: float) -> None:
    found = tooth_gaps(disc, phi)
    assert np.abs(found.gap).max() < 1e-9
    z, n = disc.ring_tooth_count, disc.lobe_count
    t = 2.0 * math.pi * np.arange(z) / z + phi / n
    expected = (disc.flank(t) @ UNIT) * np.exp(-1j * phi / n) + disc.eccentricity * np.exp(1j * phi)
    assert np.abs(found.point[0] @ UNIT - expected).max() < 1e-7
    # Every contact normal passes through the pitch point (n + 1) e along the crank.
    pitch = z * disc.eccentricity * np.exp(1j * phi)
    normal = found.normal[0] @ UNIT
    arm = ((found.point[0] @ UNIT - pitch) * np.conj(normal)).imag
    assert np.abs(arm).max() < 1e-7
