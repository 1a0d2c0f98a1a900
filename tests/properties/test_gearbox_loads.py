"""The rigid load law over the valid space: equilibrium, geometry of contacts, periods, scaling."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from examples import examples
from geometry_designs import discs, tooth_gaps
from hypothesis import given, settings
from hypothesis import strategies as st
from lone_disc import lone_disc

from cqdd_design.gearbox import hertz, output_pins, rigid
from cqdd_design.gearbox.carrier import slender_bending_arm
from cqdd_design.gearbox.disc_forces import disc_forces
from cqdd_design.gearbox.loads import rigid_maxima, rigid_series
from cqdd_design.gearbox.pin_beam import HELD
from cqdd_design.gearbox.stages import Stages
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.cycloid import CycloidDisc

ANGLES = st.floats(0.0, 2.0 * math.pi)
TORQUES = st.floats(0.1, 500.0).flatmap(lambda t: st.sampled_from([t, -t]))
PAPER = Stages(
    lobe_count=10,
    disc_count=2,
    pin_count=5,
    ring_pitch_radius=32e-3,
    eccentricity=1.6e-3,
    tooth_radius=3.5e-3,
    pin_circle_radius=19.5e-3,
    hole_clocking=0.0,
    pin_contact_radius=2e-3,
    hole_radius=3.6e-3,
    contact_length=8e-3,
    ring_modulus=112e9,
    pin_modulus=112e9,
)


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


@st.composite
def stages(draw: st.DrawFn) -> Stages:
    disc = draw(discs(most_lobes=40))
    return Stages(
        lobe_count=disc.lobe_count,
        disc_count=draw(st.integers(1, 3)),
        pin_count=draw(st.integers(3, 16)),
        ring_pitch_radius=disc.ring_pitch_radius,
        eccentricity=disc.eccentricity,
        tooth_radius=disc.tooth_radius,
        pin_circle_radius=draw(st.floats(0.3, 0.8)) * disc.ring_pitch_radius,
        hole_clocking=draw(st.floats(0.0, 6.0)),
        pin_contact_radius=2e-3,
        hole_radius=2e-3 + disc.eccentricity,
        contact_length=draw(st.floats(3e-3, 20e-3)),
        ring_modulus=112e9,
        pin_modulus=112e9,
    )


@given(discs(), ANGLES)
@settings(max_examples=examples(40), deadline=None)
def test_ring_contacts_are_where_the_geometry_room_finds_them(
    disc: CycloidDisc, crank: float
) -> None:
    """Points and normals of the closed form against the nearest points of the real profile."""
    ring = lone_disc(
        disc.lobe_count,
        disc.ring_pitch_radius,
        disc.eccentricity,
        disc.tooth_radius,
        1.0,
        [crank],
    )
    gaps = tooth_gaps(disc, crank)
    size = disc.ring_pitch_radius
    # Away from the flank of a tooth's own contact the projection finds the same point.
    assert np.abs(gaps.gap).max() < 1e-11
    assert np.abs(ring.ring_point[0] - gaps.point[0]).max() < 1e-6 * size
    # The normal of the profile leaves the disc; the force enters it.
    assert np.abs(ring.ring_normal[0] + gaps.normal[0]).max() < 1e-5


@given(stages(), TORQUES, ANGLES, st.sampled_from([0, 1, 2]))
@settings(max_examples=examples(60), deadline=None)
def test_every_disc_is_in_equilibrium(
    given_stages: Stages, torque: float, crank: float, disc: int
) -> None:
    """Forces summed in the ring's frame from points and normals; the cam passes the centre."""
    s = given_stages
    disc %= s.disc_count
    phase = float(s.phases[disc])
    disc_torque = torque / s.disc_count
    forces = disc_forces(s, torque, crank, disc)
    cam = rigid_series(s, torque, np.array([crank])).cam_force[0, disc]
    centre = kinematics.disc_centre(s.eccentricity, crank, phase)
    on_ring = forces.ring_force[:, None] * forces.ring_normal
    on_pins = forces.pin_force[:, None] * forces.pin_direction
    scale = forces.ring_force.sum() + forces.pin_force.sum()
    assert np.abs(on_ring.sum(axis=0) + on_pins.sum(axis=0) + cam).max() < 1e-9 * scale
    about = (
        cross(forces.ring_point - centre, on_ring).sum()
        + cross(forces.pin_point - centre, on_pins).sum()
    )
    assert abs(about) < 1e-9 * abs(torque)
    # The carrier receives the torque about the ring's centre, the input T/n.
    assert -cross(forces.pin_point, on_pins).sum() == pytest.approx(disc_torque, rel=1e-9)
    crank_torque = cross(centre, cam)
    assert crank_torque == pytest.approx(-disc_torque / s.lobe_count, rel=1e-9)


@given(stages(), ANGLES)
@settings(max_examples=examples(40), deadline=None)
def test_forces_repeat_with_the_stated_periods(given_stages: Stages, crank: float) -> None:
    s = given_stages
    n, pins = s.lobe_count, s.pin_count
    mesh = kinematics.mesh_period(n, pins)
    assert mesh / kinematics.ring_period(n) == pytest.approx(n / math.gcd(n, pins))
    assert mesh / kinematics.output_period(n, pins) == pytest.approx(pins / math.gcd(n, pins))

    def pattern(angle: float, shift: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        at = np.array([angle + shift])
        return (
            np.sort(s.ring_forces(1.0, at)[0]),
            np.sort(s.pin_forces(1.0, at, s.hole_clocking)[0]),
            s.cam_loads(1.0, at, s.hole_clocking)[0],
        )

    now, later = pattern(crank, 0.0), pattern(crank, mesh)
    for one, other in zip(now, later, strict=True):
        assert np.abs(one - other).max() < 1e-8 * np.abs(one).max()
    ring = pattern(crank, kinematics.ring_period(n))[0]
    assert np.abs(ring - now[0]).max() < 1e-8 * now[0].max()
    output = pattern(crank, kinematics.output_period(n, pins))[1]
    assert np.abs(output - now[1]).max() < 1e-8 * now[1].max()


@given(stages(), ANGLES, st.integers(1, 2))
@settings(max_examples=examples(40), deadline=None)
def test_a_phased_disc_is_disc_0_clocked_further(
    given_stages: Stages, crank: float, index: int
) -> None:
    """Pins of disc d drawn in the ring's frame from first principles."""
    s = replace(given_stages, disc_count=3)
    phase = float(s.phases[index])
    direction = crank + phase
    carrier = -crank / s.lobe_count
    pin_angle = carrier + s.hole_clocking + 2.0 * np.pi * np.arange(s.pin_count) / s.pin_count
    arm = np.maximum(s.pin_circle_radius * np.sin(direction - pin_angle), 0.0)
    expected = arm / np.sum(arm**2)
    found = s.pin_forces(1.0, np.array([direction]), s.disc_clocking(phase))[0]
    assert np.abs(found - expected).max() < 1e-9 * expected.max()


@given(stages(), ANGLES)
@settings(max_examples=examples(30), deadline=None)
def test_the_other_sense_of_torque_is_the_mirror_image(given_stages: Stages, crank: float) -> None:
    s = given_stages
    one = s.cam_loads(1.0, np.array([crank]), s.hole_clocking)[0]
    other = s.cam_loads(-1.0, np.array([-crank]), -s.hole_clocking)[0]
    assert np.abs(one - other * [1.0, -1.0]).max() < 1e-8 * np.abs(one).max()


@given(stages(), st.floats(1.0, 300.0), st.floats(0.5, 3.0))
@settings(max_examples=examples(15), deadline=None)
def test_scaling_laws(given_stages: Stages, torque: float, size: float) -> None:
    """Forces fall with the size of a similar gearbox, pressures with its power 3/2 by 1/b."""
    s = given_stages
    larger = replace(
        s,
        ring_pitch_radius=size * s.ring_pitch_radius,
        eccentricity=size * s.eccentricity,
        tooth_radius=size * s.tooth_radius,
        pin_circle_radius=size * s.pin_circle_radius,
        pin_contact_radius=size * s.pin_contact_radius,
        hole_radius=size * s.hole_radius,
        contact_length=size * s.contact_length,
    )
    small, big = rigid_maxima(s, torque), rigid_maxima(larger, torque)
    assert big.ring_force * size == pytest.approx(small.ring_force, rel=1e-9)
    assert big.output_pin_force * size == pytest.approx(small.output_pin_force, rel=1e-9)
    assert big.cam_bearing_load * size == pytest.approx(small.cam_bearing_load, rel=1e-9)
    assert big.ring_pressure * size**1.5 == pytest.approx(small.ring_pressure, rel=1e-9)
    doubled = rigid_maxima(s, 2.0 * torque)
    assert doubled.cam_bearing_load == pytest.approx(2.0 * small.cam_bearing_load)
    assert doubled.output_pressure == pytest.approx(math.sqrt(2.0) * small.output_pressure)
    longer = rigid_maxima(replace(s, contact_length=2.0 * s.contact_length), torque)
    assert longer.ring_pressure * math.sqrt(2.0) == pytest.approx(small.ring_pressure)


@given(stages())
@settings(max_examples=examples(10), deadline=None)
def test_maxima_are_those_of_brute_force(given_stages: Stages) -> None:
    """20,000 angles over a whole common period, every disc, both senses; good to 1e-5."""
    s = given_stages
    found = rigid_maxima(s, 10.0)
    angle = np.linspace(0.0, kinematics.mesh_period(s.lobe_count, s.pin_count), 20_001)
    ring = pressure = pins = cam = 0.0
    for phase in s.phases:
        for torque in (10.0 / s.disc_count, -10.0 / s.disc_count):
            forces = s.ring_forces(torque, angle)
            ring = max(ring, forces.max())
            pressure = max(pressure, s.ring_pressures(forces, angle).max())
            clocking = s.disc_clocking(float(phase))
            pins = max(pins, s.pin_forces(torque, angle, clocking).max())
            load = s.cam_loads(torque, angle, clocking)
            cam = max(cam, np.hypot(load[:, 0], load[:, 1]).max())
    assert found.ring_force == pytest.approx(ring, rel=1e-5)
    assert found.ring_pressure == pytest.approx(pressure, rel=1e-5)
    assert found.output_pin_force == pytest.approx(pins, rel=1e-5)
    assert found.cam_bearing_load == pytest.approx(cam, rel=1e-5)


@given(st.integers(3, 40))
@settings(deadline=None)
def test_peak_pin_force_factor(pins: int) -> None:
    """Four for even counts; for odd ones above it at 5, 9, 13 and below it at 3, 7, 11."""
    angle = np.linspace(0.0, kinematics.output_period(10, pins), 20_001)
    peak = rigid.output_pin_forces(10, pins, 1.0, 1.0, angle).max() * pins
    factor = rigid.peak_pin_force_factor(pins)
    assert factor == pytest.approx(peak, rel=1e-7)
    if pins % 2 == 0:
        assert factor == 4.0
    else:
        assert (factor > 4.0) == (pins % 4 == 1)
        assert factor == pytest.approx(4.0, abs=0.26)


def test_many_designs_at_once_are_the_same_as_one_by_one() -> None:
    radius = np.array([[30e-3], [40e-3]])
    throw = np.array([1.2e-3, 1.5e-3, 1.8e-3])
    torque = np.array([[30.0], [-20.0]])
    angle = np.linspace(0.0, 0.6, 7)
    forces = rigid.ring_forces(10, radius, throw, torque, angle)
    radial = rigid.ring_radial_force(10, radius, throw, torque, angle)
    pins = rigid.output_pin_forces(10, 6, radius * 0.6, torque, angle, throw * 100.0)
    cam = rigid.cam_load(10, throw, torque, radial, pins.sum(axis=-1))
    curvature = rigid.ring_contact_curvature(10, radius, throw, angle)
    assert forces.shape == (2, 3, 7, 11)
    assert cam.shape == (2, 3, 7, 2)
    for i in range(2):
        for j in range(3):
            R, e, T = radius[i, 0], throw[j], torque[i, 0]
            one = rigid.ring_forces(10, R, e, T, angle)
            assert np.allclose(forces[i, j], one, rtol=1e-13, atol=0.0)
            alone = rigid.cam_load(
                10,
                e,
                T,
                rigid.ring_radial_force(10, R, e, T, angle),
                rigid.output_pin_forces(10, 6, R * 0.6, T, angle, e * 100.0).sum(axis=-1),
            )
            assert np.allclose(cam[i, j], alone, rtol=1e-12)
            bend = rigid.ring_contact_curvature(10, R, e, angle)
            assert np.allclose(curvature[i, j], bend, rtol=1e-12)


@pytest.mark.parametrize(
    ("field", "factor", "changed"),
    [
        ("ring_pitch_radius", 1.01, {"ring_force", "ring_pressure", "cam_bearing_load"}),
        ("eccentricity", 1.01, {"ring_force", "ring_pressure", "cam_bearing_load"}),
        ("tooth_radius", 1.01, {"ring_pressure"}),
        ("pin_circle_radius", 1.01, {"output_pin_force", "output_pressure", "cam_bearing_load"}),
        ("hole_radius", 1.01, {"output_pressure"}),
        ("pin_contact_radius", 1.01, {"output_pressure"}),
        ("contact_length", 1.01, {"ring_pressure", "output_pressure"}),
        ("ring_modulus", 1.01, {"ring_pressure"}),
        ("pin_modulus", 1.01, {"output_pressure"}),
    ],
)
def test_every_input_moves_what_it_should_and_nothing_else(
    field: str, factor: float, changed: set[str]
) -> None:
    before = rigid_maxima(PAPER, 40.0)
    after = rigid_maxima(replace(PAPER, **{field: factor * getattr(PAPER, field)}), 40.0)
    names = ("ring_force", "ring_pressure", "output_pin_force", "output_pressure")
    moved = {
        name
        for name in (*names, "cam_bearing_load")
        if getattr(after, name) != pytest.approx(getattr(before, name), rel=1e-9)
    }
    assert moved == changed


def test_clocking_moves_only_the_cam_load() -> None:
    one = replace(PAPER, disc_count=1)
    before, after = rigid_maxima(one, 60.0), rigid_maxima(replace(one, hole_clocking=0.1), 60.0)
    assert after.cam_bearing_load != pytest.approx(before.cam_bearing_load, rel=1e-4)
    assert after.ring_force == pytest.approx(before.ring_force)
    assert after.output_pin_force == pytest.approx(before.output_pin_force)


@given(st.floats(1e-3, 20e-3), st.floats(1e-3, 20e-3), st.floats(0.01, 0.99))
def test_equivalent_radii(tooth: float, hole_margin: float, share: float) -> None:
    """Against 1/R = 1/r1 + 1/r2 with the disc's own signed curvature, and a cylinder in a bore."""
    locus = share / tooth
    disc = 1.0 / (1.0 / locus - tooth)
    expected = 1.0 / (1.0 / tooth + disc)
    assert float(hertz.ring_equivalent_radius(tooth, locus)) == pytest.approx(expected, rel=1e-9)
    assert float(hertz.ring_equivalent_radius(tooth, -locus)) > tooth
    in_hole = float(hertz.conformal_equivalent_radius(tooth, tooth + hole_margin))
    assert in_hole == pytest.approx(1.0 / (1.0 / tooth - 1.0 / (tooth + hole_margin)), rel=1e-9)


@given(st.integers(1, 3), st.floats(3e-3, 20e-3), st.floats(0.0, 2e-3), st.floats(10.0, 5e3))
def test_pin_bending_against_a_beam_integrated_numerically(
    count: int, thickness: float, spacing: float, force: float
) -> None:
    """Moment of a simply supported beam under a patch load, from reactions and summed load."""
    span = float(output_pins.pin_span(count, thickness, spacing))
    worst = 0.0
    for at in output_pins.disc_positions(count, thickness, spacing):
        x = np.linspace(0.0, span, 4001)
        patch = (x >= at - thickness / 2.0) & (x <= at + thickness / 2.0)
        pressure = np.where(patch, force / thickness, 0.0)
        step = x[1] - x[0]
        pressure *= force / (pressure.sum() * step)
        left = force * (span - at) / span
        shear = left - np.cumsum(pressure) * step
        moment = np.cumsum(shear) * step
        centre = int(np.argmin(np.abs(x - at)))
        worst = max(worst, moment[centre])
    arm = float(slender_bending_arm(count, thickness, spacing, HELD["both"], 4.0))
    assert force * arm == pytest.approx(worst, rel=5e-3)
    cantilever = float(slender_bending_arm(count, thickness, spacing, HELD["cantilever"], 4.0))
    assert cantilever == pytest.approx(span - spacing - thickness / 2.0)
    assert cantilever > arm
