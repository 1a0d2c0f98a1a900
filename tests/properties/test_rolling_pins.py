"""Sleeves on the output pins, plain and on needles: friction, play, give, life, checks, parts."""

from __future__ import annotations

import csv
import io
import math
from functools import lru_cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cqdd_design.catalog.bearings import FRICTION_COEFFICIENT, bearings, find_bearing
from cqdd_design.design import Design
from cqdd_design.errors import DesignError, GeometryError
from cqdd_design.exporting.solids.bom import bill_of_materials, bom_csv
from cqdd_design.gearbox.contact import laws
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.rubbing import ContactFriction
from cqdd_design.gearbox.contact.sweep import contact_sweep
from cqdd_design.gearbox.life import life
from cqdd_design.gearbox.precision.backlash import backlash
from cqdd_design.gearbox.rolling_contacts import hole_friction, sleeve_turn
from cqdd_design.geometry.runners import LEAST_WALL, pin_runner
from cqdd_design.machine import resolve
from cqdd_design.solids.clearances import assembly_motion
from cqdd_design.solids.mesh import DISPLAY

HARD = "AISI 52100 / 100Cr6 hardened"

#: Ratio 11 with room for needles: 4 mm pins, cages K4x7x7, sleeves of 8 mm.
NEEDLES = Design.from_mapping(
    {
        "schema_version": 1,
        "name": "needles",
        "requirements": {
            "ratio": 11,
            "peak_torque": "70 N*m",
            "continuous_torque": "20 N*m",
        },
        "reducer": {
            "ratio": 11,
            "ring_pitch_radius": "36 mm",
            "eccentricity": "1.5 mm",
            "ring_pin_diameter": "6.5 mm",
            "output_pins": {
                "count": 8,
                "diameter": "4 mm",
                "circle_radius": "23.5 mm",
                "sleeve_diameter": "8 mm",
                "sleeve": "needle",
                "hole_clearance": "30 um",
                "material": HARD,
            },
            "cam_bearing": {"designation": "6803"},
            "ring": {"outer_diameter": "82 mm"},
        },
    }
)
SLEEVE = "reducer.output_pins.sleeve"


def pins(**changes: object) -> Design:
    return NEEDLES.replacing({f"reducer.output_pins.{key}": at for key, at in changes.items()})


@lru_cache(maxsize=4)
def model_of(sleeve: str) -> ContactModel:
    return ContactModel.from_design(pins(sleeve=sleeve))


# --- friction -----------------------------------------------------------------------------------


@given(st.floats(1e-4, 1.0), st.sampled_from([8.0, 9.0, 11.0]))
def test_a_sleeve_rolls_where_its_moments_balance(mu: float, outside: float) -> None:
    """t r_sleeve is the moment of the bearing inside, which is never above a bare pin's."""
    friction = {"reducer.friction.pin": mu, "reducer.output_pins.sleeve_diameter": outside * 1e-3}
    load = 1000.0
    plain = hole_friction(NEEDLES.replacing({**friction, SLEEVE: "plain"}))
    needles = hole_friction(NEEDLES.replacing(friction))
    on_pin = mu * load * 0.5 * pin_mean()
    rolling = min(mu, 0.0025) * load * 0.5 * 4e-3  # M = mu F d/2 of needles with a cage, JTEKT
    assert plain * load * 0.5e-3 * outside == pytest.approx(on_pin)
    assert needles * load * 0.5e-3 * outside == pytest.approx(rolling)
    assert max(plain, needles) < mu


def pin_mean() -> float:
    """Of 4 h5: hardened pins under sleeves are ground dowels."""
    return 4e-3 - 2.5e-6


def test_the_rolling_coefficient_is_the_one_of_every_needle_bearing() -> None:
    cage = pin_runner(NEEDLES)
    assert cage is not None
    assert cage.cage is not None
    assert FRICTION_COEFFICIENT[cage.cage.kind] == 0.0025


@pytest.mark.deep
def test_rolling_takes_the_losses_off_the_pins() -> None:
    """Work of pin friction in the equilibrium of bare pins, plain sleeves and needles."""
    work = {}
    for kind in ("bare", "plain", "needle"):
        design = (
            pins(sleeve="plain", sleeve_diameter="0 mm", diameter="8 mm")
            if kind == "bare"
            else pins(sleeve=kind)
        )
        machine = resolve(design)
        found = machine.losses.at(design.requirements.input_speed, 20.0)
        work[kind] = (found.by_source["output_pins"], found.efficiency_forward)
    assert work["bare"][0] > 1.9 * work["plain"][0] > 15.0 * work["needle"][0]
    assert work["bare"][1] < work["plain"][1] - 0.005 < work["needle"][1] - 0.01


# --- play ---------------------------------------------------------------------------------------


def test_play_of_the_sleeves_adds_to_the_gap_of_the_holes() -> None:
    """A pin can leave its hole's wall by clearance and play: as much as by clearance alone."""
    loose = ContactModel.from_design(pins(sleeve_play="20 um"))
    wide = ContactModel.from_design(pins(sleeve_play="0 um", hole_clearance="50 um"))
    tight = ContactModel.from_design(pins(sleeve_play="0 um"))
    assert loose.pin_gap == pytest.approx(tight.pin_gap + 10e-6)
    found = [backlash(model, np.linspace(0.0, 6.0, 7)) for model in (loose, wide, tight)]
    loosest, widest, tightest = (one.mean for one in found)
    assert loosest == pytest.approx(widest, rel=1e-6)
    # 20 um on the diameter at 23.5 mm: 10 um to either side.
    assert loosest - tightest == pytest.approx(20e-6 / 23.5e-3, rel=0.05)
    # The pressure in the hole knows nothing of it.
    assert loose.pin_equivalent_radius == tight.pin_equivalent_radius


def test_a_bare_pin_has_no_play() -> None:
    bare = {"sleeve": "plain", "sleeve_diameter": "0 mm"}
    one, other = (pins(**bare, sleeve_play=play) for play in ("0 um", "40 um"))
    assert ContactModel.from_design(one).pin_gap == ContactModel.from_design(other).pin_gap
    assert ContactModel.from_design(one).sleeve_coefficient == 0.0


# --- compliance ---------------------------------------------------------------------------------


@pytest.mark.parametrize("force", [10.0, 400.0, 3000.0])
def test_the_contact_inside_the_sleeve_gives_in_series(force: float) -> None:
    """Palmgren, N and mm: 3.84e-5 F^0.9/l^0.8 a line of steel; 7.68e-5 Q^0.9/l^0.8 two of them."""
    line = 3.84e-8 * force**0.9 / 8.0**0.8
    needles = 7.68e-8 * (4.08 * force / 6) ** 0.9 / 4.8**0.8
    steel = 206.0 / 210.0  # moduli: Palmgren's, and of the hard pins
    for kind, inside in (("plain", line * steel), ("needle", needles)):
        model = model_of(kind)
        both = laws.approach(model.pin_law, model.pin_coefficient(), 0.0, force)
        own = laws.palmgren_coefficient(8e-3, model.pin_modulus) * force**0.9
        assert float(both) - own == pytest.approx(inside, rel=1e-9)


@pytest.mark.parametrize("law", ["johnson", "linear"])
def test_other_laws_take_the_secant_of_the_contact_inside(law: laws.LineModel) -> None:
    """At 50 N/mm both ways of putting it agree."""
    force = 50e3 * 8e-3
    bare = ContactModel.from_design(pins(sleeve="plain", sleeve_diameter="0 mm"), law)
    needle = ContactModel.from_design(NEEDLES, law)
    more = needle.sleeve_coefficient * force**0.9
    own = needle.pin_coefficient() - more / force
    assert own > 0.0
    if law == "linear":
        assert own == pytest.approx(bare.pin_coefficient(), rel=1e-12)


# --- life ---------------------------------------------------------------------------------------


def test_a_sleeve_turns_as_often_as_its_rim_fits_the_path_of_its_hole() -> None:
    """While the crank goes once round the carrier the hole's wall passes on a circle of 2 e."""
    turns = 2.0 * math.pi * 1.5e-3 / (math.pi * 8e-3)
    assert float(sleeve_turn(11, 1.5e-3, 8e-3)) == pytest.approx(turns * (1.0 + 1.0 / 11.0))


@pytest.mark.parametrize("count", [8, 11])
def test_life_of_the_needles_is_that_of_a_whole_turn_of_every_pin(count: int) -> None:
    """Miner's sum over one turn of the crank against the carrier, every pin followed by itself."""
    design = pins(count=count)
    model = ContactModel.from_design(design)
    (found,) = life(design, model).runners
    assert found.designation == "needle cage K4x7x7"
    turn = 2.0 * math.pi / (1.0 + 1.0 / 11.0)
    angles = turn * np.arange(480) / 480
    friction = ContactFriction.of(model, "drive")
    force = np.linalg.norm(contact_sweep(model, 20.0, angles, friction=friction).pin_load, axis=-1)
    rating = find_bearing("needle cage K4x7x7").dynamic_rating
    speed = NEEDLES.requirements.input_speed * float(sleeve_turn(11, 1.5e-3, 8e-3))
    per_hour = 3600.0 * speed / (2.0 * math.pi)
    damage = per_hour * np.mean((force / rating) ** (10.0 / 3.0), axis=0) / 1e6
    assert found.hours == pytest.approx(1.0 / damage.max(), rel=2e-3)
    together = np.sum(damage ** (9.0 / 8.0)) ** (-8.0 / 9.0)
    assert found.set_hours == pytest.approx(together, rel=2e-3)
    assert found.lasts(1000.0)
    assert not found.lasts(1.01 * found.set_hours)


def test_soft_pins_and_plain_sleeves_have_no_known_life() -> None:
    for design, words in (
        (pins(material="Alloy steel 12.9 (ISO 7379)"), "softer than the 58 HRC"),
        (pins(sleeve="plain"), "p v"),
    ):
        result = life(design, ContactModel.from_design(design))
        (sleeves,) = result.runners
        assert sleeves.set_hours is None
        assert not sleeves.lasts(0.0)
        assert any(words in warning for warning in result.warnings)


def test_plain_sleeves_state_what_they_bear() -> None:
    """P v of the mean force on the projected pin, by hand."""
    design = pins(sleeve="plain")
    model = ContactModel.from_design(design)
    turn = 2.0 * math.pi / (1.0 + 1.0 / 11.0)
    angles = turn * np.arange(240) / 240
    friction = ContactFriction.of(model, "drive")
    force = np.linalg.norm(contact_sweep(model, 20.0, angles, friction=friction).pin_load, axis=-1)
    slides = design.requirements.input_speed * float(sleeve_turn(11, 1.5e-3, 8e-3)) * 2e-3
    by_hand = force.mean(axis=0).max() / (4e-3 * 8e-3) * slides
    (found,) = life(design, model).runners
    assert found.pressure_velocity == pytest.approx(by_hand, rel=1e-3)


# --- checks -------------------------------------------------------------------------------------


def test_checks_of_the_needles() -> None:
    analysis = resolve(NEEDLES).analyse()
    found = {check.id: check for check in analysis.checks}
    force = 1.15 * analysis.rigid_peak.output_pin_force
    assert found["SLEEVE-STATIC"].value == pytest.approx(1382.0 / force)
    speed = 2.0 * 1.5 / 8.0 * (12 / 11) * NEEDLES.requirements.input_speed
    hours = 1e6 * (1891.0 / (force * 20.0 / 70.0)) ** (10.0 / 3.0)
    assert found["SLEEVE-LIFE"].value == pytest.approx(hours * 2.0 * math.pi / speed / 3600.0)
    assert found["SLEEVE-RACEWAY"].status == "pass"
    assert found["GEO-SLEEVE-WALL"].value == pytest.approx(0.5)
    soft = resolve(pins(material="Alloy steel 12.9 (ISO 7379)")).analyse().checks
    assert {check.id: check.status for check in soft}["SLEEVE-RACEWAY"] == "fail"
    plain = {check.id for check in resolve(pins(sleeve="plain")).analyse().checks}
    assert not {name for name in plain if name.startswith("SLEEVE-")}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"sleeve_diameter": "0 mm"}, "needs a sleeve"),
        ({"sleeve_diameter": "3 mm"}, "at least 5 mm"),
        ({"sleeve_diameter": "7.5 mm"}, "raise output_pins.sleeve_diameter to 8 mm"),
        ({"diameter": "5.5 mm", "sleeve_diameter": "9 mm"}, "5 mm or 6 mm"),
        ({"diameter": "60 mm", "sleeve_diameter": "90 mm"}, "make output_pins.diameter 30 mm"),
        ({"sleeve": "ball"}, "'plain', 'needle' or 'drawn cup'"),
        ({"sleeve_play": "-1 um"}, "0 um"),
    ],
)
def test_sleeves_that_cannot_be_are_refused_with_the_nearest_fix(
    changes: dict[str, object], words: str
) -> None:
    with pytest.raises((DesignError, GeometryError), match=words.replace("(", r"\(")):
        ContactModel.from_design(pins(**changes))


def test_a_disc_too_thin_for_the_cage_names_the_thickness() -> None:
    with pytest.raises(GeometryError, match="raise it to 7 mm"):
        ContactModel.from_design(NEEDLES.replacing({"reducer.disc_thickness": "6 mm"}))


def test_the_fix_named_for_a_sleeve_is_enough() -> None:
    """Every cage of the catalogue fits the sleeve and the disc that it asks for, and no less."""
    for cage in bearings().values():
        if cage.kind != "needle cage" or cage.bore_diameter > 10.5e-3:
            continue
        size = {
            "reducer.output_pins.diameter": cage.bore_diameter,
            "reducer.output_pins.sleeve_diameter": cage.outer_diameter + 2.0 * LEAST_WALL,
            "reducer.disc_thickness": cage.width,
        }
        runner = pin_runner(NEEDLES.replacing(size))
        assert runner is not None
        assert runner.cage == cage
        assert runner.wall == pytest.approx(LEAST_WALL)


# --- parts --------------------------------------------------------------------------------------


def test_sleeves_and_cages_are_drawn_weighed_and_listed() -> None:
    machine = resolve(NEEDLES)
    named = {part.name: part for part in machine.parts}
    sleeve, cage = named["pin sleeve"], named["pin needle cage"]
    assert sleeve.count == cage.count == 2 * 8
    steel = 7810.0
    ring = math.pi / 4.0 * (8e-3**2 - 7e-3**2) * 8e-3
    assert sleeve.mass == pytest.approx(steel * ring)
    assert cage.mass == find_bearing("needle cage K4x7x7").mass
    assert (cage.shape.top - cage.shape.bottom, cage.shape.outside_radius) == pytest.approx(
        (7e-3, 3.5e-3)
    )
    # Each cage stands in the middle of its sleeve.
    for one, other in zip(sleeve.instances, cage.instances, strict=True):
        assert other.body == one.body
        np.testing.assert_allclose(
            other.placement[:3, 3] - one.placement[:3, 3], [0.0, 0.0, 0.5e-3], atol=1e-12
        )
    rows = csv.DictReader(io.StringIO(bom_csv(bill_of_materials(machine, machine.parts))))
    listed = {row["part"]: row for row in rows}
    assert listed["pin needle cage"]["make_or_buy"] == "buy"
    assert listed["pin needle cage"]["designation"] == "K4x7x7"
    assert listed["pin sleeve"]["designation"] == "ground sleeve 7 x 8 x 8 mm"


def test_nothing_runs_into_sleeves_on_needles() -> None:
    kinds = (
        "disc",
        "pin sleeve",
        "pin needle cage",
        "dowel pin",
        "shoulder screw",
        "carrier plate",
    )
    parts = tuple(part for part in resolve(NEEDLES).parts if part.name in kinds)
    found = assembly_motion(NEEDLES, parts, np.array([0.4, 2.9, 17.0]), DISPLAY)
    assert found.collisions == ()
