"""Rollers on the pins of a pinwheel ring: meshing, friction, play, give, life, checks, parts."""

from __future__ import annotations

import csv
import io
import math
from pathlib import Path

import numpy as np
import pytest

from cqdd_design.catalog.bearings import find_bearing
from cqdd_design.design import Design, load_design
from cqdd_design.errors import DesignError, GeometryError
from cqdd_design.exporting.edm.exact_curves import ring_curve
from cqdd_design.exporting.solids.bom import bill_of_materials, bom_csv
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.rubbing import ContactFriction
from cqdd_design.gearbox.contact.states import nominal_states
from cqdd_design.gearbox.contact.sweep import contact_sweep
from cqdd_design.gearbox.life import life
from cqdd_design.gearbox.precision.backlash import backlash
from cqdd_design.gearbox.rolling_contacts import greatest_roller_turn, tooth_friction
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.ring import ring_contour, ring_min_concave_radius, ring_root_radius
from cqdd_design.machine import resolve
from cqdd_design.solids.clearances import assembly_motion
from cqdd_design.solids.features.rotating import RING_PIN_PLAY
from cqdd_design.solids.mesh import DISPLAY

PAPER = Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml"
HARD = "AISI 52100 / 100Cr6 hardened"

#: The paper's gearbox in a pinwheel ring: 4 mm pins, cages K4x7x7, rollers of 8 mm.
ROLLERS = load_design(PAPER).replacing(
    {
        "reducer.ring_type": "pinwheel",
        "reducer.ring_pin_diameter": "4 mm",
        "reducer.ring_material": HARD,
        "reducer.disc_material": HARD,
        "reducer.output_pins.material": HARD,
        "reducer.ring.roller_diameter": "8 mm",
        "reducer.ring.roller": "needle",
        "reducer.ring.roller_play": "0 um",
        "reducer.ring.outer_diameter": "80 mm",
    }
)
#: The same with teeth of the rollers' size in one piece with the ring.
SOLID = ROLLERS.replacing(
    {
        "reducer.ring.roller": "plain",
        "reducer.ring.roller_diameter": "0 mm",
        "reducer.ring_type": "solid",
        "reducer.ring_pin_diameter": "8 mm",
    }
)


def ring(**changes: object) -> Design:
    return ROLLERS.replacing({f"reducer.ring.{key}": at for key, at in changes.items()})


# --- what meshes --------------------------------------------------------------------------------


def test_the_disc_is_made_for_the_rollers() -> None:
    assert CycloidDisc.from_design(ROLLERS) == CycloidDisc.from_design(SOLID)
    angles = np.linspace(0.0, 3.0, 7)
    rolling, solid = (
        nominal_states(ContactModel.from_design(one), angles) for one in (ROLLERS, SOLID)
    )
    np.testing.assert_array_equal(rolling.gaps, solid.gaps)
    np.testing.assert_array_equal(rolling.ring.equivalent_radius, solid.ring.equivalent_radius)


def test_pockets_clear_the_rollers() -> None:
    """Every point of the ring stands off every roller by the relief clearance, and no less."""
    contour = ring_contour(ROLLERS).holes[0]
    curve = ring_curve(ROLLERS)
    assert ring_root_radius(ROLLERS) == pytest.approx(32e-3 + 4.1e-3)
    assert ring_min_concave_radius(ROLLERS) == pytest.approx(4.1e-3)
    at = np.linspace(0.0, 2.0 * math.pi, 4001)
    points = curve.point(at)
    centres = 32e-3 * np.exp(2j * math.pi * np.arange(11) / 11)
    stands = np.abs(points[:, None] - centres).min(axis=1)
    assert stands.min() == pytest.approx(4.1e-3, rel=1e-9)
    # Of the bore, too: it clears the disc as before.
    reach = CycloidDisc.from_design(ROLLERS).unmodified.tip_distance + 1.6e-3
    assert np.abs(points).min() == pytest.approx(reach + 0.1e-3, rel=1e-9)
    assert contour.moments().area == pytest.approx(curve.area, rel=1e-9)


# --- friction -----------------------------------------------------------------------------------


@pytest.mark.parametrize("mu", [0.001, 0.08, 0.5])
def test_rollers_roll_where_their_moments_balance(mu: float) -> None:
    bare = ROLLERS.replacing(
        {
            "reducer.friction.tooth": mu,
            "reducer.ring.roller": "plain",
            "reducer.ring.roller_diameter": "0 mm",
        }
    )
    plain, needle = (
        ring(roller=kind).replacing({"reducer.friction.tooth": mu}) for kind in ("plain", "needle")
    )
    load = 700.0
    assert tooth_friction(bare) == mu
    assert tooth_friction(plain) * load * 4e-3 == pytest.approx(mu * load * 2e-3)
    assert tooth_friction(needle) * load * 4e-3 == pytest.approx(min(mu, 0.0025) * load * 2e-3)


def test_a_rolling_gearbox_reaches_what_bought_ones_do() -> None:
    """Bought reducers that roll at rings and pins are given with about 0.9; sliding ones less."""
    found = {}
    for kind, design in (
        ("sliding", SOLID),
        ("plain", ring(roller="plain")),
        ("needle", ROLLERS),
    ):
        losses = resolve(design).losses.at(design.requirements.input_speed, 40.0)
        found[kind] = losses.efficiency_forward
    assert found["sliding"] == pytest.approx(0.735, abs=0.01)
    assert found["sliding"] + 0.08 < found["plain"] < found["needle"] - 0.06
    assert found["needle"] == pytest.approx(0.905, abs=0.01)


def test_needles_drag_without_load() -> None:
    """Palmgren's drag of every cage at its turn: f0 12, 1e-7 f0 (nu n)^(2/3) d_m^3, by hand."""
    needle, plain = (resolve(ring(roller=kind)).friction for kind in ("needle", "plain"))
    speed = 150.0
    turn = greatest_roller_turn(10, 32e-3, 1.6e-3, 8e-3)
    product = needle.lubricant.viscosity * 1e6 * speed * turn * 30.0 / math.pi
    torque = 1e-7 * 12.0 * product ** (2.0 / 3.0) * 5.5**3 * 1e-3
    assert float(needle.drag(speed)["ring_teeth"]) == pytest.approx(22 * turn * torque)
    assert float(plain.drag(speed)["ring_teeth"]) == 0.0


# --- play and compliance ------------------------------------------------------------------------


def test_play_of_the_rollers_opens_every_tooth() -> None:
    """As much as an equidistant of half of it, but for what that does to the flank's shape."""
    angles = np.linspace(0.0, 6.0, 7)
    loose = ContactModel.from_design(ring(roller_play="20 um"))
    tight = ContactModel.from_design(ROLLERS)
    more = nominal_states(loose, angles).gaps - nominal_states(tight, angles).gaps
    np.testing.assert_allclose(more[:, :, :11], 10e-6, rtol=1e-9)
    np.testing.assert_array_equal(more[:, :, 11:], 0.0)
    wider = ContactModel.from_design(
        ROLLERS.replacing({"reducer.modification.equidistant": "16 um"})
    )
    free = [backlash(model, angles).mean for model in (loose, wider, tight)]
    assert free[0] - free[2] == pytest.approx(free[1] - free[2], rel=0.02)
    assert free[0] > free[2] + 1e-4


def test_pin_and_needles_give_behind_the_contact() -> None:
    """At 50 N/mm: Palmgren's line, his needles, and a beam on two supports, by hand."""
    model = ContactModel.from_design(ROLLERS)
    force, length = 400.0, 8.0
    line = 3.84e-8 * force**0.9 / length**0.8 * (206.0 / 210.0)
    needles = 7.68e-8 * (4.08 * force / 6) ** 0.9 / 4.8**0.8
    span, near = 17.5e-3, 4.5e-3
    far, bend = span - near, 210e9 * math.pi / 64.0 * 4e-3**4
    shear = 210e9 / 2.6 * math.pi / 4.0 * 4e-3**2 * 6.0 * 1.3 / (7.0 + 6.0 * 0.3)
    seat = 1.0 / (4e-3 * 71.7e9) + 1.0 / (4e-3 * 210e9)
    beam = near**2 * far**2 / (3.0 * bend * span) + near * far / (span * shear)
    beam += seat * ((far / span) ** 2 + (near / span) ** 2)
    coefficient = model.ring_coefficient(np.full((1, 2, 11), 3e-3))
    assert coefficient.shape == (1, 2, 11)
    assert coefficient[0, 0, 0] * force == pytest.approx(line + needles + beam * force, rel=2e-3)
    # The pin is what gives most: a straight line is nearer to the truth than a power of 0.9.
    assert beam * force > 2.0 * (line + needles)
    assert model.ring_law.model == "linear"
    assert ContactModel.from_design(SOLID).ring_law.model == "palmgren"


def test_pressure_and_balance_of_a_rolling_ring() -> None:
    model = ContactModel.from_design(ROLLERS)
    friction = ContactFriction.of(model, "drive")
    sweep = contact_sweep(model, 40.0, np.linspace(0.0, 0.5, 6), friction=friction)
    # Tangential forces are the rolling share of the normal ones.
    assert friction is not None
    assert np.abs(sweep.ring_tangential).max() == pytest.approx(
        friction.tooth * sweep.ring_force.max(), rel=1e-9
    )
    total = sweep.ring_load.sum(axis=2) + sweep.pin_load.sum(axis=2) + sweep.cam_force
    assert np.abs(total).max() < 1e-9 * sweep.ring_force.max()


# --- life ---------------------------------------------------------------------------------------


def test_the_fastest_roller_is_the_one_farthest_from_the_pitch_point() -> None:
    """Against the speed of the disc's flank at a roller by its turn about the pitch point."""
    model = ContactModel.from_design(SOLID)
    sweep = contact_sweep(model, 40.0, np.linspace(0.0, 2.0, 400))
    pitch = 11.0 * np.asarray(sweep.disc_centre)[:, :, None, :]
    speed = np.linalg.norm(sweep.ring_point - pitch, axis=-1) / 10.0 / 4e-3
    assert speed.max() <= greatest_roller_turn(10, 32e-3, 1.6e-3, 8e-3) * (1.0 + 1e-3)
    assert speed.max() == pytest.approx(greatest_roller_turn(10, 32e-3, 1.6e-3, 8e-3), rel=0.02)


def test_life_of_the_needles_is_that_of_one_roller_over_an_output_turn() -> None:
    """Miner's sum at single rollers, each followed by itself through a whole turn of the output."""
    design = ROLLERS.replacing({"requirements.continuous_torque": "20 N*m"})
    model = ContactModel.from_design(design)
    found = {one.name: one for one in life(design, model).runners}["rollers"]
    angles = 2.0 * math.pi * 10.0 * np.arange(3300) / 3300
    sweep = contact_sweep(model, 20.0, angles, friction=ContactFriction.of(model, "drive"))
    force = np.linalg.norm(sweep.ring_load, axis=-1)
    pitch = 11.0 * np.asarray(sweep.disc_centre)[:, :, None, :]
    surface = np.linalg.norm(sweep.ring_point - pitch, axis=-1) / 10.0
    turns = surface * design.requirements.input_speed / (2.0 * math.pi * 4e-3)
    rating = find_bearing("needle cage K4x7x7").dynamic_rating
    damage = 3600.0 * np.mean(turns * (force / rating) ** (10.0 / 3.0), axis=0) / 1e6
    assert found.hours == pytest.approx(1.0 / damage.max(), rel=0.02)
    assert found.set_hours == pytest.approx(np.sum(damage ** (9 / 8)) ** (-8 / 9), rel=0.02)
    assert found.designation == "needle cage K4x7x7"


def test_soft_rings_and_plain_rollers_have_no_known_life() -> None:
    soft = ROLLERS.replacing({"reducer.ring_material": "AISI 4140 Q&T 540C"})
    for design, words in ((soft, "softer than the 58 HRC"), (ring(roller="plain"), "p v")):
        result = life(design, ContactModel.from_design(design))
        (rollers,) = result.runners
        assert rollers.set_hours is None
        assert not rollers.lasts(0.0)
        assert any(words in warning and "rollers" in warning for warning in result.warnings)
    assert rollers.pressure_velocity > 0.0
    assert life(SOLID, ContactModel.from_design(SOLID)).runners == ()


# --- checks and refusals ------------------------------------------------------------------------


def test_checks_of_rollers_and_their_pins() -> None:
    analysis = resolve(ROLLERS).analyse()
    found = {check.id: check for check in analysis.checks}
    force = 1.15 * analysis.rigid_peak.ring_force
    assert found["ROLLER-STATIC"].value == pytest.approx(1382.0 / force)
    moment = force * (4.5 * 13.0 / 17.5 - 1.0) * 1e-3
    assert found["RING-PIN-BENDING-PEAK"].value == pytest.approx(
        32.0 * moment / (math.pi * 4e-3**3) / 1e6
    )
    assert found["GEO-ROLLER-WALL"].value == pytest.approx(0.5)
    assert found["ROLLER-RACEWAY"].status == "pass"
    assert not {one.id for one in resolve(SOLID).analyse().checks} & {
        "RING-PIN-BENDING-PEAK",
        "GEO-ROLLER-WALL",
        "ROLLER-LIFE",
    }


def test_a_thicker_ring_pin_named_by_the_remedy_passes() -> None:
    weak = ROLLERS.replacing(
        {
            "requirements.peak_torque": "200 N*m",
            "reducer.ring.roller": "plain",
            "reducer.ring_pin_diameter": "2.5 mm",
        }
    )
    check = {one.id: one for one in resolve(weak).analyse().checks}["RING-PIN-BENDING-PEAK"]
    assert check.status == "fail"
    named = check.remedy.split("ring_pin_diameter to ")[1].split(" mm")[0]
    thick = weak.replacing({"reducer.ring_pin_diameter": f"{named} mm"})
    again = {one.id: one for one in resolve(thick).analyse().checks}["RING-PIN-BENDING-PEAK"]
    assert again.status == "pass"


def test_remedies_of_the_profile_name_the_rollers() -> None:
    wide = ring(roller_diameter="15.6 mm", outer_diameter="90 mm")
    wide = wide.replacing({"reducer.output_pins.circle_radius": "18 mm"})
    checks = {one.id: one for one in resolve(wide).analyse().checks}
    assert "lower ring.roller_diameter to" in checks["GEO-TOOTH-OVERLAP"].remedy


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"reducer.ring_type": "solid"}, 'make ring_type "pinwheel"'),
        ({"reducer.ring.roller_diameter": "0 mm"}, "needs a roller"),
        ({"reducer.ring.roller_diameter": "3.5 mm"}, "at least 5 mm"),
        ({"reducer.ring.roller_diameter": "7.5 mm"}, "raise ring.roller_diameter to 8 mm"),
        ({"reducer.ring_pin_diameter": "4.5 mm"}, "make ring_pin_diameter 4 mm or 5 mm"),
        ({"reducer.ring.roller": "ball"}, "'plain', 'needle' or 'drawn cup'"),
        ({"reducer.ring.roller_diameter": "40 mm"}, "ring.roller_diameter 40 mm"),
        ({"reducer.disc_thickness": "6 mm"}, "raise it to 7 mm"),
    ],
)
def test_rollers_that_cannot_be_are_refused_with_the_nearest_fix(
    changes: dict[str, object], words: str
) -> None:
    with pytest.raises((DesignError, GeometryError)) as caught:
        ContactModel.from_design(ROLLERS.replacing(changes))
    assert words in str(caught.value)


def test_pockets_that_meet_are_refused() -> None:
    wide = ring(roller_diameter="17.9 mm", outer_diameter="110 mm")
    with pytest.raises(GeometryError, match="leaves no ring between the pockets"):
        ring_contour(wide)


# --- parts --------------------------------------------------------------------------------------


def test_rollers_and_pins_are_drawn_weighed_and_listed() -> None:
    machine = resolve(ROLLERS)
    named = {part.name: part for part in machine.parts}
    roller, cage, pin = named["ring roller"], named["ring needle cage"], named["ring pin"]
    assert (roller.count, cage.count, pin.count) == (22, 22, 11)
    assert roller.mass == pytest.approx(7810.0 * math.pi / 4.0 * (8e-3**2 - 7e-3**2) * 8e-3)
    # Pins span the discs and the gaps beyond them, which is what they are taken to bend over, but
    # for the play at their ends.
    assert pin.shape.top - pin.shape.bottom == pytest.approx(17.5e-3 + 2.0 * (2e-3 - RING_PIN_PLAY))
    assert pin.shape.outside_radius == pytest.approx(2e-3)
    rows = csv.DictReader(io.StringIO(bom_csv(bill_of_materials(machine, machine.parts))))
    listed = {row["part"]: (row["make_or_buy"], row["designation"]) for row in rows}
    assert listed["ring needle cage"] == ("buy", "K4x7x7")
    assert listed["ring roller"] == ("make", "ground roller 7 x 8 x 8 mm")
    assert listed["ring pin"] == ("make", "ground pin 4 x 21.4 mm")


@pytest.mark.deep
@pytest.mark.parametrize("kind", ["plain", "needle"])
def test_nothing_runs_into_rollers_or_the_lands_that_hold_their_pins(kind: str) -> None:
    design = ring(roller=kind)
    bought = ("motor", "rotor", "stator", "screw", "encoder", "magnet")
    parts = tuple(
        part
        for part in resolve(design).parts
        if not any(word in part.name for word in bought) or part.name == "shoulder screw"
    )
    assert {"housing", "ring clamp", "ring roller", "ring pin", "ring"} <= {p.name for p in parts}
    assert assembly_motion(design, parts, np.array([0.4]), DISPLAY).collisions == ()
    running = tuple(part for part in parts if part.name.startswith(("disc", "ring")))
    assert assembly_motion(design, running, np.array([3.1, 17.0]), DISPLAY).collisions == ()


def test_pins_are_held_at_both_ends() -> None:
    """A pin a hundredth thicker runs into housing and clamp, and into nothing along the discs."""
    import dataclasses

    from cqdd_design.solids import rotating

    parts = {part.name: part for part in resolve(ring(roller="plain")).parts}
    pin = parts["ring pin"]
    thick = dataclasses.replace(
        pin, shape=rotating.plain_pin(4.4e-3, pin.shape.bottom, pin.shape.top)
    )
    met = (thick, parts["housing"], parts["ring clamp"], parts["ring"])
    found = assembly_motion(ring(roller="plain"), met, np.array([0.0]), DISPLAY).collisions
    touched = {one.first for one in found} | {one.second for one in found}
    assert {"housing", "ring clamp"} <= touched
    assert "ring" not in touched
