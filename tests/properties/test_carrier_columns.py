"""Columns of the carrier: which there may be, where they stand, clear of the discs, how stiff."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from cqdd_design.catalog.screws import LEAST_COLUMN, column_screw
from cqdd_design.design import Design, load_design
from cqdd_design.errors import CatalogError, DesignError, GeometryError
from cqdd_design.gearbox.cam_bearing import largest_outer_diameter
from cqdd_design.gearbox.carrier_columns import column_stiffness, feet_compliance, join_stiffness
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.columns import (
    RUNNING_CLEARANCE,
    column_clearance,
    column_hole_diameter,
    column_offsets,
)
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.disc import (
    column_hole_centres,
    disc_contour,
    disc_moments,
    hole_centres,
    hole_diameter,
    ligaments,
)
from cqdd_design.geometry.validate import validate_geometry
from cqdd_design.machine import resolve
from cqdd_design.roads.tolerance import tolerance
from cqdd_design.solids.clocking import disc_groups
from cqdd_design.solids.selection import cap_screw

DESIGNS = Path(__file__).resolve().parents[2] / "designs"
PAPER = load_design(DESIGNS / "cqdd-10.toml").replacing({"reducer.carrier.joint": "clamped"})
REFERENCE_S = load_design(DESIGNS / "reference-s.toml")
BORE = 28e-3
UNIT = np.array([1.0, 1.0j])


def with_columns(design: Design, diameter: str = "4 mm", **more: object) -> Design:
    """The design with columns, and other keys of its reducer changed (dots as two underlines)."""
    changes = {
        "reducer.carrier.joint": "columns",
        "reducer.carrier.column_diameter": diameter,
        **{f"reducer.{key.replace('__', '.')}": value for key, value in more.items()},
    }
    return design.replacing(changes)


def test_one_column_stands_between_every_two_pins_unless_told_otherwise() -> None:
    design = with_columns(PAPER)
    assert design.reducer.carrier.column_count == 5
    assert "reducer.carrier.column_count" in design.assumed
    assert PAPER.reducer.carrier.column_count == 0
    fewer = with_columns(PAPER, output_pins__count=12, carrier__column_count=4)
    assert fewer.reducer.carrier.column_count == 4


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"carrier.joint": "columns"}, "column_diameter 0 mm must be from 3 to 100 mm"),
        (
            {"carrier.joint": "columns", "carrier.column_diameter": "2.9 mm"},
            "the nearest allowed is 3 mm",
        ),
        ({"carrier.column_diameter": "5 mm"}, 'not to joint = "clamped"; leave them out'),
        ({"carrier.joint": "hinged", "carrier.column_count": 5}, 'not to joint = "hinged"'),
        (
            {
                "carrier.joint": "columns",
                "carrier.column_diameter": "5 mm",
                "output_pins.support": "cantilever",
            },
            'set support = "both", or leave joint',
        ),
        (
            {
                "carrier.joint": "columns",
                "carrier.column_diameter": "5 mm",
                "carrier.column_count": 4,
            },
            "column_count 4 must be a divisor of output_pins.count 5, 3 or more, so that columns "
            "stand evenly midway between pins; the nearest is 5",
        ),
        (
            {
                "carrier.joint": "columns",
                "carrier.column_diameter": "5 mm",
                "output_pins.count": 8,
                "carrier.column_count": 2,
            },
            "the nearest is 4",
        ),
        ({"carrier.joint": "welded"}, "must be 'clamped', 'hinged' or 'columns'"),
    ],
)
def test_columns_that_cannot_be_are_refused_with_the_nearest_that_can(
    changes: dict[str, object], said: str
) -> None:
    with pytest.raises(DesignError) as refused:
        PAPER.replacing({f"reducer.{key}": value for key, value in changes.items()})
    assert said in str(refused.value)


@pytest.mark.parametrize(
    ("diameter", "circle", "bore", "said"),
    [
        ("9 mm", "19.5 mm", BORE, "break out into the bore; lower it to 7.28 mm"),
        ("9 mm", "22 mm", 20e-3, "break out into the lobed profile; lower it to"),
        ("20 mm", "21 mm", 12e-3, "in the discs run into the output holes beside them; lower it"),
    ],
)
def test_columns_that_break_out_of_the_disc_are_refused_with_a_diameter_that_does_not(
    diameter: str, circle: str, bore: float, said: str
) -> None:
    narrow = 9 if "output holes" in said else 5
    more = {"output_pins__circle_radius": circle, "output_pins__count": narrow}
    design = with_columns(PAPER, diameter, **more)
    with pytest.raises(GeometryError) as refused:
        validate_geometry(design, bore_diameter=bore)
    assert said in str(refused.value)
    named = str(refused.value).rpartition("lower it to ")[2].removesuffix(".")
    validate_geometry(with_columns(PAPER, named, **more), bore_diameter=bore)


def test_no_gearboxes_are_drawn_whose_discs_cannot_be_cut() -> None:
    """Holes for columns that run into output holes, and output holes that run into the bore."""
    with pytest.raises(GeometryError, match="run into the output holes beside them"):
        tolerance(with_columns(REFERENCE_S, "6 mm"), samples=1)
    with pytest.raises(GeometryError, match="bore"):
        tolerance(REFERENCE_S.replacing({"reducer.output_pins.circle_radius": "21 mm"}), samples=1)


def test_where_no_column_fits_the_remedy_is_no_smaller_column() -> None:
    design = with_columns(REFERENCE_S, "4 mm")
    with pytest.raises(GeometryError, match=r"no room there: use fewer"):
        validate_geometry(
            design.replacing({"reducer.output_pins.count": 14, "reducer.carrier.column_count": 14}),
            bore_diameter=35e-3,
        )


def test_a_column_never_touches_its_holes_at_any_crank_angle() -> None:
    """Carrier and discs posed by their kinematics; what stands between column and hole's wall."""
    design = with_columns(PAPER, "4.2 mm", disc_count=3, output_pins__hole_clearance="40 um")
    disc, reducer = CycloidDisc.from_design(design), design.reducer
    crank = np.linspace(0.0, 2.0 * math.pi * reducer.ratio, 997)
    first = reducer.output_pins.hole_clocking + column_offsets(reducer)
    turned = kinematics.carrier_angle(reducer.ratio, crank)[:, None] + first
    columns = reducer.output_pins.circle_radius * np.exp(1j * turned)
    for index in range(3):
        turn, shift = kinematics.disc_pose(disc, crank + 2.0 * math.pi * index / 3.0)
        holes = turn[:, None] * (column_hole_centres(design, index) @ UNIT) + shift[:, None]
        wall = 0.5 * column_hole_diameter(reducer) - 2.1e-3 - np.abs(holes - columns)
        assert wall.min() == pytest.approx(0.5 * column_clearance(reducer), abs=1e-12)
        assert wall.max() == pytest.approx(wall.min(), abs=1e-12)
    # The disc may go aside by its holes' clearance, and the column by the play of its screw.
    screw = column_screw(4.2e-3)
    left = column_clearance(reducer) - 40e-6 - (screw.bore - screw.thread)
    assert left == pytest.approx(RUNNING_CLEARANCE)
    assert column_clearance(reducer) > RUNNING_CLEARANCE


def test_holes_for_columns_are_holes_like_the_others() -> None:
    plain, design = PAPER, with_columns(PAPER)
    hole = column_hole_diameter(design.reducer)
    assert hole == pytest.approx(4e-3 + 3.2e-3 + 16e-6 + 0.2e-3 + 0.2e-3)
    before = disc_contour(plain, 1, bore_diameter=BORE)
    after = disc_contour(design, 1, bore_diameter=BORE)
    assert len(after.holes) == len(before.holes) + 5
    assert [one.radius for one in after.holes[-5:]] == pytest.approx([0.5 * hole] * 5)
    moments = [disc_moments(one, 1, bore_diameter=BORE) for one in (plain, design)]
    assert moments[0].area - moments[1].area == pytest.approx(5 * math.pi / 4.0 * hole**2)
    assert moments[1].area == pytest.approx(after.moments().area, rel=1e-5)
    # Even on their circle: the disc stays balanced.
    assert abs(moments[1].x) + abs(moments[1].y) < 1e-15


@settings(max_examples=examples(40))
@given(diameter=st.floats(3e-3, 8e-3), circle=st.floats(17e-3, 24e-3), pins=st.integers(4, 9))
def test_ligaments_beside_columns_are_the_distances_of_the_edges(
    diameter: float, circle: float, pins: int
) -> None:
    design = with_columns(
        PAPER,
        f"{diameter * 1e3} mm",
        output_pins__circle_radius=circle,
        output_pins__count=pins,
    )
    found = {one.kind: one.thickness for one in ligaments(design, bore_diameter=BORE)}
    hole = 0.5 * column_hole_diameter(design.reducer)
    columns = column_hole_centres(design, 0) @ UNIT
    others = hole_centres(design, 0) @ UNIT
    apart = np.abs(columns[:, None] - others).min() - hole - 0.5 * hole_diameter(design)
    assert found["column to hole"] == pytest.approx(apart, abs=1e-12)
    assert found["column to bore"] == pytest.approx(circle - hole - 0.5 * BORE, abs=1e-12)
    disc = CycloidDisc.from_design(design)
    outline = disc.flank(np.linspace(0.0, 2.0 * math.pi, 40000)) @ UNIT
    nearest = min(
        np.abs((column_hole_centres(design, d) @ UNIT)[:, None] - outline).min() for d in (0, 1)
    )
    if nearest > hole:
        assert found["column to profile"] == pytest.approx(nearest - hole, abs=2e-6)


@settings(max_examples=examples(60))
@given(lobes=st.integers(6, 24), pins=st.integers(3, 14), least=st.integers(3, 14))
def test_two_discs_stay_one_part_where_a_column_stands_between_every_two_pins(
    lobes: int, pins: int, least: int
) -> None:
    even = [n for n in range(3, pins + 1) if pins % n == 0]
    for count in {pins, even[least % len(even)]}:
        mapping = {
            "name": "one part",
            "reducer": {
                "ratio": lobes,
                "ring_pitch_radius": "32 mm",
                "eccentricity": f"{0.55 * 32.0 / (lobes + 1)} mm",
                "ring_pin_diameter": "1 mm",
                "carrier": {
                    "joint": "columns",
                    "column_count": count,
                    "column_diameter": "3 mm",
                },
                "output_pins": {"count": pins, "circle_radius": "19.5 mm"},
            },
        }
        design = Design.from_mapping(mapping)
        groups = disc_groups(design)
        if count == pins:
            assert len(groups) == 1
        # Whatever was grouped: the drawn disc, placed, has the holes of the disc it stands for.
        for group in groups:
            for one in group.placements:
                drawn = column_hole_centres(design, group.placements[0].disc) @ UNIT
                drawn = np.conj(drawn) if one.turned_over else drawn
                placed = drawn * np.exp(1j * one.angle)
                wanted = column_hole_centres(design, one.disc) @ UNIT
                assert np.abs(placed[:, None] - wanted).min(axis=1).max() < 1e-8


def test_a_slender_column_is_a_beam_between_clamps_and_a_stubby_one_a_block_in_shear() -> None:
    modulus, poisson = 205e9, 0.29
    inertia = math.pi / 64.0 * (6e-3**4 - 3e-3**4)
    slender = column_stiffness(2.0, 6e-3, 3e-3, modulus, poisson)
    assert slender == pytest.approx(12.0 * modulus * inertia / 8.0, rel=1e-3)
    # A solid round section's shear coefficient is 6(1+nu)/(7+6nu).
    shear = modulus / 2.0 / (1.0 + poisson) * math.pi / 4.0 * 6e-3**2
    stubby = column_stiffness(1e-5, 6e-3, 0.0, modulus, poisson)
    share = 6.0 * (1.0 + poisson) / (7.0 + 6.0 * poisson)
    assert stubby == pytest.approx(share * shear / 1e-5, rel=1e-4)
    # A thin tube's is near a half.
    thin = column_stiffness(1e-5, 6e-3, 5.999e-3, modulus, poisson)
    area = math.pi / 4.0 * (6e-3**2 - 5.999e-3**2)
    assert thin / (shear / (math.pi / 4.0 * 6e-3**2) * area / 1e-5) == pytest.approx(
        2.0 * (1.0 + poisson) / (4.0 + 3.0 * poisson), rel=1e-3
    )


def test_the_stiffness_of_a_column_is_what_its_shooting_says() -> None:
    """Timoshenko's four equations integrated along the column, against the closed form."""
    length, modulus, poisson, diameter, bore = 17.5e-3, 205e9, 0.29, 6e-3, 3.2e-3
    inertia = math.pi / 64.0 * (diameter**4 - bore**4)
    area = math.pi / 4.0 * (diameter**2 - bore**2)
    m2 = (bore / diameter) ** 2
    kappa = 6 * (1 + poisson) * (1 + m2) ** 2
    kappa /= (7 + 6 * poisson) * (1 + m2) ** 2 + (20 + 12 * poisson) * m2
    rigidity = kappa * area * modulus / (2.0 * (1.0 + poisson))

    def far(force: float, moment: float) -> tuple[float, float]:
        motion = slope = at = 0.0
        steps = 20000
        step = length / steps
        for _ in range(steps):
            middle = slope + 0.5 * step * (moment - force * at) / (modulus * inertia)
            motion += step * (middle + force / rigidity)
            slope += step * (moment - force * (at + 0.5 * step)) / (modulus * inertia)
            at += step
        return motion, slope

    by_force, by_moment = far(1.0, 0.0), far(0.0, 1.0)
    moment = -by_force[1] / by_moment[1]
    stiffness = 1.0 / (by_force[0] + moment * by_moment[0])
    found = column_stiffness(length, diameter, bore, modulus, poisson)
    assert found == pytest.approx(stiffness, rel=1e-6)


def test_columns_join_cap_and_plate_as_springs_on_their_circle() -> None:
    assert join_stiffness(PAPER) == 0.0
    assert join_stiffness(PAPER.replacing({"reducer.carrier.joint": "hinged"})) == 0.0
    design = with_columns(PAPER, "5 mm")
    own = column_stiffness(17.5e-3, 5e-3, column_screw(5e-3).bore, 205e9, 0.29)
    feet = feet_compliance(17.5e-3, 5e-3, 71.7e9, 0.33)
    each = 1.0 / (1.0 / own + feet)
    assert 0.4 * own < each < 0.6 * own
    assert join_stiffness(design) == pytest.approx(5 * each * 19.5e-3**2, rel=0.01)
    wider = design.replacing({"reducer.output_pins.circle_radius": "39 mm"})
    assert join_stiffness(wider) == pytest.approx(4.0 * join_stiffness(design))


def test_feet_of_columns_against_a_rigid_body_on_springs() -> None:
    """A stiff column between two plates: it rocks on both feet, the plates kept parallel.

    Statics: a force F across it needs the moment F L/2 at each foot. Aluminium, 6 mm, 17.5 mm.
    """
    shear, radius, length = 71.7e9 / 2.66, 3e-3, 17.5e-3
    turns, slides = 8.0 * shear * radius**3 / (3.0 * 0.67), 8.0 * shear * radius / 1.67
    force = 100.0
    tilt = 0.5 * force * length / turns
    moved = 2.0 * force / slides + tilt * length
    assert feet_compliance(length, 6e-3, 71.7e9, 0.33) == pytest.approx(moved / force, rel=1e-12)


@given(diameter=st.floats(LEAST_COLUMN, 0.1))
def test_a_screw_leaves_its_column_a_wall(diameter: float) -> None:
    screw = column_screw(diameter)
    assert screw.thread < screw.bore <= 0.6 * diameter + 1e-12
    assert cap_screw(screw.thread, 0.0).thread == screw.thread


def test_no_screw_goes_through_a_needle() -> None:
    with pytest.raises(CatalogError, match=r"the least is 3 mm"):
        column_screw(2.9e-3)


def test_a_cam_bearing_leaves_material_to_the_holes_for_columns() -> None:
    design = with_columns(PAPER, "7 mm")
    hole = column_hole_diameter(design.reducer)
    assert hole > hole_diameter(design)
    most = largest_outer_diameter(design, hole_diameter(design), valley_distance=1.0)
    assert most == pytest.approx(2.0 * (19.5e-3 - 0.5 * hole - 1.5e-3))
    plain = largest_outer_diameter(PAPER, hole_diameter(PAPER), valley_distance=1.0)
    assert plain == pytest.approx(2.0 * (19.5e-3 - 0.5 * hole_diameter(PAPER) - 1.5e-3))


def test_the_thread_of_a_columns_screw_is_deeper_than_the_longest_reaches() -> None:
    """A 25 mm screw may be 0.42 mm longer (ISO 4762), and what lies under its head 0.3 thinner."""
    machine = resolve(with_columns(PAPER, "6 mm"))
    columns = machine.layout.carrier.columns
    assert columns is not None
    (plate,) = (part for part in machine.parts if part.name == "carrier plate")
    (thread,) = (one for one in plate.features if one.name == "threads of the columns' screws")
    engaged = columns.thread_top - machine.layout.carrier.plate_bottom
    assert thread.thread_depth - engaged == pytest.approx(2.0 * thread.pitch)
    assert thread.thread_depth - engaged > 0.72e-3
    assert thread.through or thread.drill_depth > thread.thread_depth
