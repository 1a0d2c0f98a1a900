"""Friction and losses: sliding speeds, energy, statics, limits, and an effect of every input."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from examples import examples
from geometry_designs import discs
from hypothesis import given, settings
from hypothesis import strategies as st
from lone_disc import lone_disc
from solids_designs import machines

from cqdd_design.catalog.lubricants import find_lubricant
from cqdd_design.design import Design, load_design
from cqdd_design.errors import CatalogError, ContactError, DesignError, UsageError
from cqdd_design.gearbox import rigid
from cqdd_design.gearbox.contact.laws import CamSpring
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.rubbing import ContactFriction, FrictionChoice
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
from cqdd_design.gearbox.disc_forces import DiscForces, disc_forces
from cqdd_design.gearbox.losses import LossModel, loss_model
from cqdd_design.gearbox.losses.backdrive import balance_torque
from cqdd_design.gearbox.losses.machine import SOURCES, total
from cqdd_design.gearbox.losses.model import SENSES
from cqdd_design.gearbox.losses.rolling import drag_torque
from cqdd_design.gearbox.losses.shaft import equivalent_load, support_reactions
from cqdd_design.gearbox.losses.sliding import friction_work, pin_sliding, ring_sliding
from cqdd_design.gearbox.losses.swept import SWEEP_ANGLES
from cqdd_design.gearbox.rolling_contacts import most_breakaway
from cqdd_design.gearbox.stages import Stages
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.machine import resolve
from cqdd_design.machine.machine import _ROUGH_SHARES

DESIGNS = Path(__file__).resolve().parents[2] / "designs"
GALLERY = DESIGNS.parent / "docs" / "gallery"
PAPER = load_design(DESIGNS / "cqdd-10.toml")
SPEED = 1286.0 * math.pi / 30.0
STEP = 1e-5


@lru_cache(maxsize=32)
def model_of(changes: tuple[tuple[str, object], ...] = ()) -> LossModel:
    design = PAPER.replacing(dict(changes)) if changes else PAPER
    return resolve(design).losses


@lru_cache(maxsize=32)
def rigid_model_of(changes: tuple[tuple[str, object], ...] = ()) -> LossModel:
    """The same with rigid bodies: finite elements of every other shape would tell no more here."""
    design = PAPER.replacing(dict(changes)) if changes else PAPER
    peak = design.requirements.peak_torque
    return loss_model(ContactModel.from_design(design), resolve(design).friction, peak)


@lru_cache(maxsize=8)
def paper_sweep(torque: float, sense: FrictionChoice = "drive") -> ContactSweep:
    model = resolve(PAPER).contact
    return contact_sweep(model, torque, friction=ContactFriction.of(model, sense))


@dataclass(frozen=True, eq=False)
class RigidForces:
    """A sweep by the rigid law, all discs alike: quick, and independent of the equilibrium."""

    torque: float
    ring_force: np.ndarray
    ring_point: np.ndarray
    ring_normal: np.ndarray
    pin_force: np.ndarray
    pin_normal: np.ndarray
    cam_force: np.ndarray
    disc_centre: np.ndarray
    friction: None = None

    @property
    def pin_load(self) -> np.ndarray:
        """Forces of the pins on the discs: nothing rubs here."""
        return self.pin_force[..., None] * self.pin_normal


def rigid_forces(stages: Stages, torque: float, count: int = 64) -> RigidForces:
    angle = kinematics.mesh_period(stages.lobe_count, stages.pin_count) / count * np.arange(count)
    found = [disc_forces(stages, torque, angle, disc) for disc in range(stages.disc_count)]
    force = np.stack([one.ring_force for one in found], axis=1)
    normal = np.stack([one.ring_normal for one in found], axis=1)
    pin_force = np.stack([one.pin_force for one in found], axis=1)
    pin_normal = np.stack(
        [np.repeat(one.pin_direction[:, None], stages.pin_count, axis=1) for one in found], axis=1
    )
    total = (force[..., None] * normal).sum(axis=2) + (pin_force[..., None] * pin_normal).sum(2)
    return RigidForces(
        torque=torque,
        ring_force=force,
        ring_point=np.stack([one.ring_point for one in found], axis=1),
        ring_normal=normal,
        pin_force=pin_force,
        pin_normal=pin_normal,
        cam_force=-total,
        disc_centre=np.stack([one.centre for one in found], axis=1),
    )


def turned(angle: np.ndarray | float, points: np.ndarray) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    x, y = points[..., 0], points[..., 1]
    return np.stack([c * x - s * y, s * x + c * y], axis=-1)


# --- sliding speeds by finite differences of material points ----------------------------------


@given(discs(), st.floats(0.0, 6.0))
@settings(max_examples=examples(40), deadline=None)
def test_sliding_at_teeth_is_the_speed_of_the_discs_material(disc: CycloidDisc, phi: float) -> None:
    n, R, e = disc.lobe_count, disc.ring_pitch_radius, disc.eccentricity
    stage = lone_disc(n, R, e, disc.tooth_radius, 1.0, [phi])
    point, normal = stage.ring_point[0], stage.ring_normal[0]
    # The disc's material that touches at phi, carried along with the disc.
    own = turned(phi / n, point - kinematics.disc_centre(e, phi))

    def at(angle: float) -> np.ndarray:
        return turned(-angle / n, own) + kinematics.disc_centre(e, angle)

    velocity = (at(phi + STEP) - at(phi - STEP)) / (2.0 * STEP)
    ours = ring_sliding(n, point, normal, kinematics.pitch_point(n, e, phi))
    np.testing.assert_allclose(np.hypot(*velocity.T), ours, rtol=1e-6, atol=1e-9 * R)
    # No part of it is along the normal: pure sliding.
    np.testing.assert_allclose((velocity * normal).sum(axis=-1), 0.0, atol=1e-7 * R)


@given(discs(), st.floats(0.0, 6.0), st.floats(0.01, 0.05), st.floats(1.2, 3.0))
@settings(max_examples=examples(40), deadline=None)
def test_sliding_at_pins_and_under_sleeves(
    disc: CycloidDisc, phi: float, circle: float, ratio: float
) -> None:
    n, e = disc.lobe_count, disc.eccentricity
    pin_radius = 2e-3
    for reach in (pin_radius, pin_radius * ratio):
        # Hole material that touches pin or sleeve at phi (on the side of +u), in the disc's frame.
        touch = circle * np.array([1.0, 0.3]) + reach * turned(phi, np.array([1.0, 0.0]))

        def in_carrier(angle: float, touch: np.ndarray = touch) -> np.ndarray:
            own = turned(phi / n, touch - kinematics.disc_centre(e, phi))
            world = turned(-angle / n, own) + kinematics.disc_centre(e, angle)
            return turned(angle / n, world)

        velocity = (in_carrier(phi + STEP) - in_carrier(phi - STEP)) / (2.0 * STEP)
        hole_speed = float(np.hypot(*velocity))
        sliding = float(pin_sliding(n, e))
        assert hole_speed == pytest.approx(sliding, rel=1e-6)
        # A sleeve that rolls in the hole turns at v/r_s and rubs on the pin at that times r_p.
        assert hole_speed / reach * pin_radius == pytest.approx(
            sliding * pin_radius / reach, rel=1e-6
        )


def test_sleeves_lower_pin_losses_by_the_ratio_of_diameters() -> None:
    design = PAPER.replacing({"reducer.output_pins.sleeve_diameter": 0.006})
    forces = rigid_forces(Stages.from_design(PAPER), 40.0)
    plain = resolve(PAPER).friction.coulomb_work(forces)["output_pins"]
    sleeved = resolve(design).friction.coulomb_work(forces)["output_pins"]
    assert sleeved / plain == pytest.approx(3.975 / 6.0, rel=1e-9)


# --- energy ---------------------------------------------------------------------------------


@given(discs(most_lobes=30), st.floats(1.0, 200.0))
@settings(max_examples=examples(25), deadline=None)
def test_work_at_teeth_equals_the_integral_of_path_differences(
    disc: CycloidDisc, torque: float
) -> None:
    """Integral over a period of mu F |d s_flank - d s_tooth|, from the two curves alone."""
    n, R, e, r = disc.lobe_count, disc.ring_pitch_radius, disc.eccentricity, disc.tooth_radius
    period = kinematics.ring_period(n)
    phi = period / 600 * (np.arange(600) + 0.5)

    def ring(angle: np.ndarray) -> DiscForces:
        return lone_disc(n, R, e, r, torque, angle)

    now, after, before = ring(phi), ring(phi + STEP), ring(phi - STEP)
    along_tooth = (after.ring_point - before.ring_point) / (2.0 * STEP)
    t = rigid.ring_flank_parameters(n, phi)
    along_flank = (disc.flank(t + STEP / n) - disc.flank(t - STEP / n)) / (2.0 * STEP)
    along_flank = turned(-phi[:, None] / n, along_flank)
    slip = np.linalg.norm(along_tooth - along_flank, axis=-1)
    integral = float((0.08 * now.ring_force * slip).sum(axis=-1).mean())
    pitch = kinematics.pitch_point(n, e, phi)[:, None]
    path = ring_sliding(n, now.ring_point, now.ring_normal, pitch)
    ours = float(friction_work(0.08, now.ring_force, path).mean())
    assert ours == pytest.approx(integral, rel=1e-6)


def test_friction_power_at_contact_teeth_is_what_virtual_work_gives() -> None:
    """Friction forces on the discs of the real equilibrium against their material velocities."""
    sweep, machine = paper_sweep(40.0), resolve(PAPER).friction
    n, spin = 10, -0.1
    centre = sweep.disc_centre[:, :, None]
    arm = sweep.ring_point - centre
    own_rate = np.stack([-sweep.disc_centre[..., 1], sweep.disc_centre[..., 0]], -1)[:, :, None]
    velocity = own_rate + spin * np.stack([-arm[..., 1], arm[..., 0]], -1)
    tangent = np.stack([-sweep.ring_normal[..., 1], sweep.ring_normal[..., 0]], -1)
    slip = (velocity * tangent).sum(-1)
    drag = -PAPER.reducer.friction.tooth * sweep.ring_force * np.sign(slip)
    taken = -(drag[..., None] * tangent * velocity).sum(axis=(1, 2, 3)).mean()
    assert machine.coulomb_work(sweep)["ring_teeth"] == pytest.approx(float(taken), rel=1e-9)
    # The distance from the pitch point itself, without the projection on the flank.
    pitch = (n + 1) * sweep.disc_centre[:, :, None]
    distance = np.linalg.norm(sweep.ring_point - pitch, axis=-1) / n
    plain = 0.08 * (sweep.ring_force * distance).sum(axis=(1, 2)).mean()
    assert plain == pytest.approx(float(taken), rel=1e-4)


@pytest.mark.parametrize("torque", [2.0, 40.0, 120.0])
def test_efficiencies_close_the_energy_balance(torque: float) -> None:
    found = model_of().at(SPEED, torque)
    out = torque * SPEED / 10
    assert found.total == pytest.approx(sum(found.by_source.values()))
    assert found.backdrives is True
    assert found.efficiency_forward == pytest.approx(out / (out + found.total), rel=1e-12)
    machine = resolve(PAPER).friction
    driven = sum(machine.coulomb_work(paper_sweep(torque, "backdrive")).values())
    back = 10.0 * (driven + float(total(machine.drag(SPEED))))
    assert found.efficiency_backward == pytest.approx(1.0 - back / torque, rel=2e-3)
    assert found.loss_torque * found.output_speed == pytest.approx(found.total, rel=1e-12)


@pytest.mark.parametrize("name", ["cqdd-10", "reference-s", "printed-13"])
def test_a_look_with_few_torques_loses_what_many_say(name: str) -> None:
    """To 3 %, as the searches that take it for a look count on."""
    machine = replace(resolve(load_design(DESIGNS / f"{name}.toml")), stiff=True)
    asked = machine.design.requirements
    every = loss_model(machine.contact, machine.friction, asked.peak_torque)
    assert len(machine.losses.torque) < 0.4 * len(every.torque)
    torque = asked.peak_torque * np.geomspace(2e-3, 1.0, 40)
    speed = np.full(torque.shape, asked.input_speed)
    for sense in ("drive", "backdrive"):
        few, many = (
            one.crank_torque(speed, torque, sense).sum(axis=-1) for one in (machine.losses, every)
        )
        assert few == pytest.approx(many, rel=0.03)


def test_small_torques_without_an_equilibrium_leave_the_others(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of few torques nothing but the one at rest was left without films: an IndexError."""
    machine = replace(resolve(load_design(GALLERY / "plain-10.toml")), stiff=True)
    asked, whole, solved = machine.design.requirements, machine.losses, contact_sweep
    peak, speed = asked.peak_torque, np.array([asked.input_speed])
    assert whole.film is not None

    def jammed(model: ContactModel, torque: float, **how: Any) -> ContactSweep:
        share, still = abs(torque) / peak, how["friction"].film_speed == 0.0
        if 5e-4 < share < 2e-3 or (5e-4 < share < 0.01 and still):
            raise ContactError("nothing moves")
        return solved(model, torque, **how)

    monkeypatch.setattr("cqdd_design.gearbox.contact.sweep.contact_sweep", jammed)
    few = loss_model(machine.contact, machine.friction, peak, _ROUGH_SHARES)
    assert len(few.torque) == len(whole.torque) - 1
    for torque in (0.03 * peak, 0.5 * peak, peak):
        for slow in (0.0, 0.1, 1.0):
            mine, all_of_it = (
                float(one.crank_torque(slow * speed, np.array([torque]), "drive").sum())
                for one in (few, whole)
            )
            assert mine == pytest.approx(all_of_it, rel=0.06)


def test_rigid_limit_of_the_contact_equilibrium_is_the_closed_form() -> None:
    """Equal linear springs, no gaps, a rigid cam: 4 mu (R - r)/(pi n e) of the output power."""
    design = PAPER.replacing(
        {
            "reducer.disc_count": 1,
            "reducer.modification.equidistant": 0.0,
            "reducer.output_pins.hole_clearance": 0.0,
            "reducer.cam_bearing.radial_clearance": 0.0,
        }
    )
    linear = ContactModel.from_design(design, "linear")
    model = replace(linear, cam=CamSpring(1e13, 1.0, 0.0))
    work = resolve(design).friction.coulomb_work(contact_sweep(model, 40.0))
    closed = 4.0 * 0.08 * (32.0 - 3.5) / (math.pi * 10.0 * 1.6)
    assert 10.0 * work["ring_teeth"] / 40.0 == pytest.approx(closed, rel=3e-4)


# --- statics of the seats ---------------------------------------------------------------------

VECTORS = st.lists(
    st.tuples(st.floats(-5e3, 5e3), st.floats(-5e3, 5e3), st.floats(-0.05, 0.05)),
    min_size=1,
    max_size=4,
)


@given(VECTORS, st.floats(-0.1, 0.0), st.floats(0.02, 0.2))
def test_support_reactions_balance_force_and_moment(
    loads: list[tuple[float, float, float]], first: float, span: float
) -> None:
    table = np.array(loads)
    force, height, second = table[:, :2], table[:, 2], first + span
    reaction = support_reactions(force, height, first, second)
    np.testing.assert_allclose(force.sum(0) + reaction.sum(0), 0.0, atol=1e-6)
    moment = (force * height[:, None]).sum(0) + reaction[0] * first + reaction[1] * second
    np.testing.assert_allclose(moment, 0.0, atol=1e-6)


def test_equivalent_load_adds_the_tilting_moment() -> None:
    pair = [[100.0, 0.0], [-100.0, 0.0]]
    assert float(equivalent_load(pair, [0.0, 0.01], 0.5, 0.05)) == pytest.approx(40.0)
    assert float(equivalent_load([[0.0, 7.0]], [0.02], 0.02, 0.05)) == pytest.approx(7.0)


# --- bearings and lubricant --------------------------------------------------------------------


@given(st.floats(0.5, 20.0), st.floats(5e-6, 1e-3), st.floats(0.0, 2e3), st.floats(0.005, 0.2))
def test_drag_scales_as_palmgren_says(f0: float, nu: float, speed: float, mean: float) -> None:
    torque = float(drag_torque(f0, nu, speed, mean))
    assert torque == float(drag_torque(f0, nu, -speed, mean)) > 0.0
    assert float(drag_torque(2.0 * f0, nu, speed, mean)) == pytest.approx(2.0 * torque)
    assert float(drag_torque(f0, nu, speed, 2.0 * mean)) == pytest.approx(8.0 * torque)
    product = nu * speed * 1e6 * 30.0 / math.pi
    if product >= 2000.0:
        assert float(drag_torque(f0, nu, 8.0 * speed, mean)) == pytest.approx(4.0 * torque)
    else:
        assert torque == float(drag_torque(f0, nu, 0.0, mean))


def test_bearing_work_is_load_times_turn() -> None:
    """Every seat by hand: mu F d/2 times its turn per radian of crank."""
    sweep, machine = paper_sweep(40.0), resolve(PAPER).friction
    work = machine.coulomb_work(sweep)
    cam = 0.0015 * 0.0075 * 1.1 * sweep.cam_load.sum(axis=1).mean()
    assert work["cam_bearings"] == pytest.approx(float(cam), rel=1e-12)
    # Heights from the first plate: discs at 4.5 and 13 mm, bearings 6 mm wide at -3 and 20.5 mm.
    pushed = -sweep.cam_force
    second = -(pushed[:, 0] * 7.5 + pushed[:, 1] * 16.0) / 23.5
    first = -pushed.sum(axis=1) - second
    loads = np.linalg.norm(first, axis=-1) + 1.1 * np.linalg.norm(second, axis=-1)
    assert work["support_bearings"] == pytest.approx(0.0015 * 0.005 * float(loads.mean()))
    # On the carrier: pins and the second support, tilting about the output bearing at 23.5 mm.
    across = np.stack([-sweep.pin_normal[..., 1], sweep.pin_normal[..., 0]], axis=-1)
    pins = -(sweep.pin_force[..., None] * sweep.pin_normal).sum(axis=2)
    pins -= (sweep.pin_tangential[..., None] * across).sum(axis=2)
    net = np.linalg.norm(pins.sum(axis=1) - second, axis=-1)
    tilt = pins[:, 0] * 19.0 + pins[:, 1] * 10.5 - second * 3.0
    output = net + 2.0 * np.linalg.norm(tilt, axis=-1) / 58.0
    expected = 0.0025 * 0.025 * float(output.mean()) / 10.0
    assert work["output_bearing"] == pytest.approx(expected)


def test_drag_of_every_seat_and_of_the_grease() -> None:
    """By hand at the speeds of the seats; the power at the crank is the sum of torque x speed."""
    machine = resolve(PAPER).friction
    drag, nu = machine.drag(SPEED), 110e-6
    around = {
        "cam_bearings": 2.0 * 1.1 * float(drag_torque(1.4, nu, 1.1 * SPEED, 0.0215)),
        "support_bearings": float(drag_torque(1.4, nu, SPEED, 0.016))
        + 1.1 * float(drag_torque(1.4, nu, 1.1 * SPEED, 0.016)),
        "output_bearing": float(drag_torque(6.0, nu, 0.1 * SPEED, 0.058)) / 10.0,
    }
    for name, expected in around.items():
        assert float(drag[name]) == pytest.approx(expected, rel=1e-12)
    # Two discs pass at 2 e w, each plate and its disc at 1.1 e w, 0.5 mm apart.
    power = 0.0
    for speed in 1.6e-3 * SPEED * np.array([2.0, 1.1, 1.1]):
        stress = machine.lubricant.yield_stress + 900.0 * nu * speed / 0.5e-3
        power += stress * machine.face_area * speed
    assert float(drag["grease"]) * SPEED == pytest.approx(power, rel=1e-12)
    assert float(machine.grease_torque(0.0)) > 0.0


def test_drag_branches_meet() -> None:
    at = 2000.0 / (100.0 * 30.0 / math.pi)
    below, above = drag_torque(1.0, 1e-4, [at * 0.9999, at * 1.0001], 0.02)
    assert above / below == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize("name", ["moon dust", "", "NLGI 7 grease", "ISO VG 1 oil"])
def test_an_unknown_lubricant_is_refused(name: str) -> None:
    with pytest.raises(CatalogError, match=f"no lubricant '{name}'"):
        find_lubricant(name)
    with pytest.raises(DesignError, match=r"friction\.lubricant = .*to .ISO VG 3200 oil"):
        model_of((("reducer.friction.lubricant", name),))


@pytest.mark.parametrize(
    ("spelling", "name"),
    [("nlgi 2", "NLGI 2 grease"), ("skf  LGLT 2", "SKF LGLT 2"), ("ISO VG 130", "ISO VG 130 oil")],
)
def test_a_lubricant_is_called_as_the_catalogue_calls_it(spelling: str, name: str) -> None:
    assert find_lubricant(spelling).name == name
    design = PAPER.replacing({"reducer.friction.lubricant": spelling})
    assert design.reducer.friction.lubricant == name


def test_stiffer_grease_and_thicker_oil_drag_more() -> None:
    stresses = [find_lubricant(f"NLGI {g} grease").yield_stress for g in ("00", "0", "1", "2")]
    assert all(a < b for a, b in pairwise(stresses))
    oils = [model_of((("reducer.friction.lubricant", f"ISO VG {g} oil"),)) for g in (32, 100, 460)]
    drags = [m.at(SPEED, 0.0).total for m in oils]
    assert drags[0] < drags[1] < drags[2]


# --- limits: zero speed, zero torque, preload, self-locking ---------------------------------------


@pytest.mark.parametrize("speed", [0.0, 1e-9, -SPEED, SPEED, 1e5])
@pytest.mark.parametrize("torque", [0.0, 1e-9, -40.0, 40.0, 1e4])
def test_every_operating_point_has_finite_numbers(speed: float, torque: float) -> None:
    found = model_of().at(speed, torque)
    text = json.dumps(found.to_dict(), allow_nan=False)
    assert json.loads(text)["total_W"] >= 0.0
    assert (found.efficiency_forward is None) == (torque == 0.0)
    assert (found.efficiency_backward is None) == (torque == 0.0)
    if torque == 0.0:
        assert found.backdrives is None
        assert any("zero torque" in line for line in found.warnings)
    if speed == 0.0:
        assert found.total == 0.0
    if abs(torque) == 1e4:
        assert any("extrapolated" in line for line in found.warnings)
    mirrored = model_of().at(-speed, -torque)
    assert mirrored.total == found.total


def test_zero_speed_is_the_limit_of_slow_motion() -> None:
    still, slow = model_of().at(0.0, 40.0), model_of().at(1e-6, 40.0)
    assert still.efficiency_forward == pytest.approx(slow.efficiency_forward, rel=1e-12)
    assert any("zero speed" in line for line in still.warnings)


def test_a_gearbox_that_holds_any_torque_says_so() -> None:
    rough = model_of((("reducer.friction.tooth", 0.4), ("reducer.friction.pin", 0.4)))
    found = rough.at(SPEED, 40.0)
    assert found.efficiency_backward == 0.0
    assert found.backdrives is False
    assert any("does not backdrive" in line for line in found.warnings)
    assert 0.0 < (found.efficiency_forward or 0.0) < 0.5
    assert found.to_dict()["backdrive_static_Nm"] is None


@pytest.mark.parametrize("mu", [0.05, 0.15, 0.25, 0.3, 0.35])
def test_it_gives_power_back_exactly_where_it_does_not_lock(mu: float) -> None:
    """Beside what its forces leave at the crank: a locked one cannot turn it against any drag."""
    coefficients = (("reducer.friction.tooth", mu), ("reducer.friction.pin", mu))
    model = rigid_model_of(coefficients)
    found = model.at(SPEED, 40.0)
    assert ((found.efficiency_backward or 0.0) > 0.0) is found.backdrives
    contact = ContactModel.from_design(PAPER.replacing(dict(coefficients)))
    sweep = contact_sweep(contact, 40.0, friction=ContactFriction("backdrive", mu, mu))
    left = float(sweep.crank_torque.mean())
    assert (sweep.efficiency > 0.0) == (left > 0.0)
    if left <= 0.0:
        assert found.backdrives is False
    if found.backdrives:
        assert left > 0.0
        assert (found.efficiency_backward or 0.0) < sweep.efficiency


def test_the_torque_that_just_backdrives_is_the_border() -> None:
    border = model_of().backdrive().dynamic_torque or 0.0
    assert model_of().at(0.0, 1.01 * border).backdrives is True
    assert model_of().at(0.0, 0.99 * border).backdrives is False
    assert model_of().at(0.0, 0.99 * border).efficiency_backward == 0.0


def test_preload_makes_friction_without_torque() -> None:
    tight = model_of((("reducer.output_pins.hole_clearance", -8e-6),))
    assert tight.coulomb_work(0.0).sum() > 0.0
    assert model_of().coulomb_work(0.0).sum() == 0.0
    assert (tight.backdrive().static_torque or 0.0) > (model_of().backdrive().static_torque or 0.0)
    assert tight.at(SPEED, 0.0).total > model_of().at(SPEED, 0.0).total


# --- backdrive torque ---------------------------------------------------------------------------


@given(
    st.floats(0.0, 5.0),
    st.lists(st.tuples(st.floats(0.1, 20.0), st.floats(0.0, 1.5)), min_size=1, max_size=6),
)
def test_balance_torque_is_the_first_that_carries_its_own_loss(
    start: float, stretches: list[tuple[float, float]]
) -> None:
    torque = np.concatenate([[0.0], np.cumsum([s[0] for s in stretches])])
    loss = start + np.concatenate([[0.0], np.cumsum([a * b for a, b in stretches])])
    found = balance_torque(torque, loss)
    if found is None:
        assert stretches[-1][1] >= 1.0
        assert np.all(loss >= torque - 1e-9)
        return
    extended = np.append(torque, torque[-1] + 1e6)
    beyond = np.append(loss, loss[-1] + 1e6 * stretches[-1][1])
    assert np.interp(found, extended, beyond) == pytest.approx(found, rel=1e-6, abs=1e-6)
    smaller = np.linspace(0.0, found, 50, endpoint=False)
    assert np.all(np.interp(smaller, extended, beyond) >= smaller - 1e-6)


def test_backdrive_torques_balance_friction() -> None:
    model = model_of()
    found = model.backdrive(static_ratio=1.7, output_speed=0.5)
    dynamic, static = found.dynamic_torque, found.static_torque
    assert dynamic is not None
    assert static is not None
    assert model.at(5.0, dynamic).loss_torque_backward == pytest.approx(dynamic, rel=1e-9)
    assert dynamic == pytest.approx(found.load_independent / (1.0 - found.load_share), rel=1e-3)
    # At rest: bearings 1.7 times as high, teeth and pins from 0.08 to a boundary layer with 0.10,
    # the yield stress of the grease as it is.
    work = dict(zip(SOURCES, model.coulomb_work(static, "backdrive"), strict=True))
    rubbing = work.pop("ring_teeth") + work.pop("output_pins")
    grease = float(model.machine.grease_torque(0.0))
    bearings = sum(work.values()) + total(model.machine.drag(0.0)) - grease
    at_rest = 10.0 * (1.25 * rubbing + 1.7 * bearings + grease)
    assert at_rest == pytest.approx(static, rel=1e-9)
    slow = model.backdrive(static_ratio=1.0)
    assert slow.static_torque == pytest.approx(slow.dynamic_torque, rel=1e-12)
    ordered = [model.backdrive(static_ratio=k).static_torque or 0.0 for k in (1.0, 1.5, 2.0)]
    assert ordered[0] < ordered[1] < ordered[2]
    assert (model.backdrive(output_speed=10.0).dynamic_torque or 0.0) > (slow.dynamic_torque or 0.0)


@pytest.mark.parametrize(
    ("changes", "most"),
    [
        ({}, (1.25, 1.25)),
        ({"reducer.friction.tooth": 0.03, "reducer.friction.pin": 0.15}, (10.0 / 3.0, 1.0)),
        ({"reducer.friction.tooth": "film", "reducer.friction.pin": 0.0}, (1.0, math.inf)),
        ({"reducer.ring_material": "PC-CF FDM along layers"}, (math.inf, 1.25)),
    ],
)
def test_what_rubs_breaks_away_with_a_boundary_layer_at_most(
    changes: dict[str, object], most: tuple[float, float]
) -> None:
    """Metals; of plastics no boundary layer is known, and none rubs on needles."""
    assert most_breakaway(PAPER.replacing(changes)) == pytest.approx(most)


def test_needles_break_away_as_bearings_do() -> None:
    printed = load_design(DESIGNS / "printed-13.toml")
    assert most_breakaway(printed)[1] == math.inf


# --- map over speed and torque ------------------------------------------------------------------


def test_map_holds_the_single_points() -> None:
    speeds, torques = np.array([0.0, 20.0, SPEED]), np.array([0.0, 3.0, 40.0, 120.0])
    grid = model_of().efficiency_map(speeds, torques)
    for i, speed in enumerate(speeds):
        for j, torque in enumerate(torques):
            found = model_of().at(float(speed), float(torque))
            assert grid.power[i, j] == pytest.approx(found.total, rel=1e-12)
            assert grid.forward[i, j] == pytest.approx(found.efficiency_forward or 0.0, rel=1e-12)
            assert grid.backward[i, j] == pytest.approx(found.efficiency_backward or 0.0)
    assert np.all(np.diff(grid.power, axis=0) > 0.0)
    shown = json.loads(json.dumps(grid.to_dict(), allow_nan=False))
    assert [row[0] for row in shown["efficiency_forward"]] == [None] * 3


@given(st.floats(0.2, 120.0))
@settings(max_examples=examples(25), deadline=None)
def test_torques_between_the_sweeps_are_good_to_three_per_mille(torque: float) -> None:
    contacts = resolve(PAPER).contact
    for sense in SENSES:
        sweep = contact_sweep(contacts, torque, friction=ContactFriction.of(contacts, sense))
        exact = sum(model_of().machine.coulomb_work(sweep).values())
        found = float(model_of().coulomb_work(torque, sense).sum())
        assert found == pytest.approx(exact, rel=3e-3)


def test_the_motor_rubs_harder_than_the_output() -> None:
    """Friction raises the forces while the motor drives, and lowers them while it is driven."""
    driving, driven = model_of().work[:, -1].sum(axis=-1)
    sweep = contact_sweep(ContactModel.from_design(PAPER), PAPER.requirements.peak_torque)
    laid_over = sum(model_of().machine.coulomb_work(sweep).values())
    assert driven < 0.97 * laid_over < 0.94 * driving


def test_work_is_nearly_but_not_quite_proportional_to_torque() -> None:
    model = model_of()
    share = model.work[:, 1:].sum(axis=2) / model.torque[1:]
    assert np.all(np.diff(share) > 0.0)
    assert np.all((share[:, -1] / share[:, 0] > 1.3) & (share[:, -1] / share[:, 0] < 1.6))


def test_both_senses_of_torque_lose_alike() -> None:
    machine = resolve(PAPER).friction
    ahead, back = (sum(machine.coulomb_work(paper_sweep(t)).values()) for t in (40.0, -40.0))
    # The stack is its own mirror image, but for the plate that stands at one of its ends.
    assert back == pytest.approx(ahead, rel=3e-3)


def from_sweeps(*torques: float) -> LossModel:
    driving, driven = ([paper_sweep(one, sense) for one in torques] for sense in SENSES)
    return LossModel.from_sweeps(resolve(PAPER).friction, driving, driven)


def test_losses_from_existing_sweeps() -> None:
    found = from_sweeps(40.0).at(SPEED, 40.0)
    assert found.torque == 40.0
    assert found.total == pytest.approx(model_of().at(SPEED, 40.0).total, rel=3e-3)
    half = from_sweeps(40.0).at(SPEED, 20.0)
    assert half.by_source["ring_teeth"] == pytest.approx(
        0.5 * found.by_source["ring_teeth"], rel=1e-12
    )
    beyond = from_sweeps(40.0).at(SPEED, 80.0)
    assert beyond.by_source["output_pins"] == pytest.approx(
        2.0 * found.by_source["output_pins"], rel=1e-12
    )
    lone = from_sweeps(0.0).at(SPEED, 0.0)
    assert lone.efficiency_forward is None
    assert lone.by_source["ring_teeth"] == 0.0 < lone.total


@pytest.mark.parametrize(
    "call",
    [
        lambda: from_sweeps(),
        lambda: from_sweeps(40.0, -40.0),
        lambda: from_sweeps(40.0, 40.0),
        lambda: LossModel.from_sweeps(resolve(PAPER).friction, [paper_sweep(40.0)], []),
        lambda: model_of().at(math.nan, 1.0),
        lambda: model_of().at(1.0, math.inf),
        lambda: model_of().backdrive(static_ratio=0.5),
        lambda: model_of().backdrive(static_ratio=math.nan),
        lambda: model_of().backdrive(output_speed=math.inf),
    ],
)
def test_wrong_calls_are_refused(call: object) -> None:
    with pytest.raises(UsageError):
        call()  # type: ignore[operator]


# --- every input has an effect ----------------------------------------------------------------

ALL = set(SOURCES)
LOADED = ALL - {"grease"}
EFFECTS: dict[str, tuple[object, set[str]]] = {
    "reducer.friction.tooth": (0.05, {"ring_teeth"}),
    "reducer.friction.pin": (0.05, {"output_pins"}),
    "reducer.friction.lubricant": ("ISO VG 460 oil", ALL - {"ring_teeth", "output_pins"}),
    "reducer.output_pins.sleeve_diameter": (0.006, {"output_pins"}),
    "reducer.output_pins.circle_radius": (0.0198, LOADED),
    "reducer.output_pins.hole_clearance": (40e-6, LOADED),
    "reducer.output_pins.count": (4, LOADED),
    "reducer.cam_bearing.designation": ("6802", LOADED),
    "reducer.cam_bearing.radial_clearance": (20e-6, LOADED - {"output_bearing"}),
    "reducer.modification.equidistant": (12e-6, LOADED - {"output_bearing"}),
    "reducer.disc_spacing": (0.001, {"support_bearings", "output_bearing", "grease"}),
    "reducer.disc_thickness": (0.009, LOADED),
    "reducer.disc_count": (1, ALL),
    "reducer.eccentricity": (0.0015, ALL),
    "reducer.ring_pin_diameter": (0.0066, {"ring_teeth"}),
    "reducer.ring_pitch_radius": (0.0325, {"ring_teeth", "cam_bearings"}),
    "reducer.ratio": (9, ALL),
}


@pytest.mark.parametrize("key", EFFECTS)
def test_every_input_of_the_design_has_an_effect(key: str) -> None:
    value, sources = EFFECTS[key]
    before = rigid_model_of().at(SPEED, 40.0).by_source
    changes = [(key, value)]
    if key == "reducer.ratio":
        changes.append(("requirements.ratio", value))
    after = rigid_model_of(tuple(changes)).at(SPEED, 40.0).by_source
    changed = {name for name in SOURCES if abs(after[name] / before[name] - 1.0) > 1e-6}
    assert sources <= changed
    if key == "reducer.friction.lubricant":
        assert changed == sources
    elif key.startswith("reducer.friction"):
        assert changed == LOADED  # friction of one kind changes the forces on all


def test_friction_coefficients_act_in_proportion() -> None:
    forces = rigid_forces(Stages.from_design(PAPER), 40.0)
    machine = resolve(PAPER).friction
    base = machine.coulomb_work(forces)
    for field, source in (("tooth_coefficient", "ring_teeth"), ("pin_coefficient", "output_pins")):
        doubled = replace(machine, **{field: 2.0 * getattr(machine, field)}).coulomb_work(forces)
        assert doubled[source] == pytest.approx(2.0 * base[source], rel=1e-12)
        assert {n for n in SOURCES if doubled[n] != base[n]} == {source}


# --- over the design space --------------------------------------------------------------------


@given(machines(), st.floats(0.1, 100.0))
@settings(max_examples=examples(25), deadline=None)
def test_random_machines_have_sound_losses(machine: tuple[Design, object], torque: float) -> None:
    design, _ = machine
    friction = resolve(design).friction
    forces = rigid_forces(Stages.from_design(design), torque, 48)
    model = LossModel.from_sweeps(friction, [forces], [forces])
    found = model.at(100.0, torque)
    json.dumps(found.to_dict(), allow_nan=False)
    assert all(power >= 0.0 for power in found.by_source.values())
    assert 0.0 < (found.efficiency_forward or 0.0) < 1.0
    # For rigid forces the mean loss at the teeth has the closed form 4 mu (R - r)/(pi n e).
    reducer = design.reducer
    mu = friction.tooth_coefficient
    closed = 4.0 * mu * (reducer.ring_pitch_radius - friction_radius(design))
    closed *= torque / (math.pi * reducer.ratio * reducer.eccentricity)
    assert reducer.ratio * found.by_source["ring_teeth"] / 100.0 == pytest.approx(closed, rel=0.02)
    assert (found.efficiency_backward or 0.0) <= (found.efficiency_forward or 0.0)


def friction_radius(design: Design) -> float:
    return 0.5 * design.reducer.ring_pin_diameter


def test_angles_of_the_sweeps_are_enough() -> None:
    model = ContactModel.from_design(PAPER)
    machine = resolve(PAPER).friction
    coarse, fine = (
        sum(machine.coulomb_work(contact_sweep(model, 40.0, perfect_angles(model, k))).values())
        for k in (SWEEP_ANGLES, 960)
    )
    assert coarse == pytest.approx(fine, rel=5e-5)


def test_reading_the_package_does_not_load_heavy_libraries() -> None:
    code = (
        "import sys, cqdd_design.gearbox.losses;"
        "print([m for m in ('numba', 'scipy', 'cadquery', 'pint') if m in sys.modules])"
    )
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert shown.stdout.strip() == "[]"
