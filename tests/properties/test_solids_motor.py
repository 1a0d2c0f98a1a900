"""Motor, bell, cover and encoder, ring dowels and balance weights: sizes, masses, balance."""

from __future__ import annotations

import math

import numpy as np
import pytest
from examples import examples
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from solids_designs import known_design, known_parts, part_named

from cqdd_design.catalog import find_bearing, find_material, find_motor
from cqdd_design.design import Design
from cqdd_design.errors import GeometryError
from cqdd_design.geometry.contours import Circle
from cqdd_design.machine import resolve
from cqdd_design.solids.clearances import assembly_motion
from cqdd_design.solids.counterweights import crank_moments
from cqdd_design.solids.features.motor import board_circle
from cqdd_design.solids.layers import Annulus, circle, reshaped, scalloped_circle, turned
from cqdd_design.solids.mesh import DISPLAY
from cqdd_design.solids.motor_rules import lay_out_motor
from cqdd_design.solids.part import Part
from cqdd_design.solids.selection import ChosenBearing

BEARING = find_bearing("6902")
MOTOR = ("motor stator", "motor rotor", "rotor bell", "motor cover", "encoder magnet")


def built(changes: dict[str, object]) -> tuple[Design, tuple[Part, ...]]:
    design = known_design("paper").replacing(changes)
    return design, resolve(design).parts


# ------------------------------------------------------------------ outlines


@given(
    st.floats(5e-3, 0.2),
    st.integers(1, 9),
    st.floats(0.9, 1.1),
    st.floats(0.02, 0.12),
)
@settings(
    max_examples=examples(60), deadline=None, suppress_health_check=[HealthCheck.filter_too_much]
)
def test_scallops_add_their_lunes(radius: float, count: int, far: float, share: float) -> None:
    """Area by the closed form of two circles' lens; a circle cut by small ones and rebuilt."""
    distance, small = far * radius, share * radius
    if abs(distance - radius) > 0.9 * small or small > 0.8 * radius * math.sin(math.pi / count):
        return
    angles = 0.3 + 2.0 * math.pi * np.arange(count) / count
    outline = scalloped_circle(radius, angles, distance, small)
    one = math.acos((distance**2 + radius**2 - small**2) / (2.0 * distance * radius))
    two = math.acos((distance**2 + small**2 - radius**2) / (2.0 * distance * small))
    lens = radius**2 * (one - 0.5 * math.sin(2.0 * one)) + small**2 * (
        two - 0.5 * math.sin(2.0 * two)
    )
    changed = math.pi * small**2 - lens
    assert outline.moments().area == pytest.approx(math.pi * radius**2 + count * changed, rel=1e-9)


def test_reshaped_changes_only_between_the_heights() -> None:
    plain = turned([Annulus(0.0, 10e-3, 5e-3, 10e-3)])
    wide = reshaped(
        plain, 4e-3, 6e-3, lambda shape: type(shape)(shape.name, circle(12e-3), shape.holes)
    )
    assert [layer.bottom for layer in wide.layers] == [0.0, 4e-3, 6e-3]
    extra = math.pi * (12e-3**2 - 10e-3**2) * 2e-3
    assert wide.volume == pytest.approx(plain.volume + extra, rel=1e-12)


# ------------------------------------------------------------------ the motor


def test_the_motor_is_the_catalogues() -> None:
    """Stator, magnets and the bell that carries them stand for it together, and nothing twice."""
    parts, row = known_parts("paper"), find_motor("CubeMars RO100 Lite KV55")
    stator, rotor = part_named(parts, "motor stator"), part_named(parts, "motor rotor")
    bell = part_named(parts, "rotor bell")
    assert stator.mass + rotor.mass + bell.mass == pytest.approx(row.mass)
    turning = sum(part.exact_properties.inertia[2, 2] for part in (rotor, bell))
    assert turning == pytest.approx(row.rotor_inertia, rel=1e-12)
    assert bell.shape.outside_radius == pytest.approx(0.5 * row.outer_diameter)
    # The bell weighs what is drawn of it.
    assert bell.mass == pytest.approx(bell.volume * 2810.0, rel=1e-3)
    assert stator.shape.inside_radius == pytest.approx(0.5 * row.bore_diameter)
    # Half the gap's width on either side of its diameter.
    gap = rotor.shape.inside_radius - stator.shape.outside_radius
    assert gap == pytest.approx(0.5e-3)
    assert 2.0 * (stator.shape.outside_radius + 0.5 * gap) == pytest.approx(row.gap_diameter)
    # Densities of such envelopes lie between aluminium's and steel's.
    for part in (stator, rotor):
        assert 2700.0 < part.density < 7850.0, part.name


def test_the_magnet_is_flush_and_the_sensor_near_it() -> None:
    design = known_design("paper")
    layout = resolve(design).layout
    motor = layout.motor
    assert motor is not None
    assert motor.magnet_bottom == pytest.approx(layout.shaft.bottom)
    assert motor.magnet_bottom - motor.sensor_top == pytest.approx(1e-3)
    shaft = part_named(known_parts("paper"), "eccentric shaft")
    lowest = min(shaft.shape.layers, key=lambda layer: layer.bottom)
    pocket = lowest.shape.holes[0]
    assert isinstance(pocket, Circle)
    assert pocket.radius == pytest.approx(motor.magnet_radius)


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        (
            {"motor.name": "CubeMars R100 KV90"},
            "of CubeMars R100 KV90 are not known (state bore_diameter, outer_diameter, gap_",
        ),
        (
            {
                "reducer.ring.outer_diameter": 76e-3,
                "motor": {"name": "CubeMars RO100 Lite KV55", "bore_diameter": "20 mm"},
            },
            "or a shaft of at most 5.64 mm",
        ),
    ],
)
def test_a_motor_that_cannot_be_drawn_is_left_out_and_told(
    changes: dict[str, object], why: str
) -> None:
    design, parts = built(changes)
    assert not {part.name for part in parts} & set(MOTOR)
    assert why in resolve(design).layout.motor_missing


@pytest.mark.parametrize(("outside", "size"), [("72 mm", 1.5), ("80 mm", 2.0), ("120 mm", 3.0)])
def test_dowels_are_of_the_sizes_of_iso_8734(outside: str, size: float) -> None:
    """A larger ring takes the next size, if the flange is as deep as the shortest of it is long."""
    design = known_design("paper").replacing({"reducer.ring.outer_diameter": outside})
    assert resolve(design).layout.dowels.radius == pytest.approx(0.5e-3 * size, rel=1e-12)


@pytest.mark.parametrize("support", ["6800", "6802", "6805", "6808"])
def test_screws_of_the_board_stand_beside_the_shafts_end(support: str) -> None:
    """Their heads reach higher than the end of a thick shaft, which once turned into them."""
    layout, row = resolve(known_design("paper")).layout, find_bearing(support)
    motor = lay_out_motor(
        layout.motor_row,
        layout.pack,
        layout.housing,
        ChosenBearing(row),
        layout.unit,
        8.0,
        weights=False,
        metal=find_material("7075-T6"),
    )
    heads = board_circle(motor).radius - 0.5 * motor.board_screw.head_diameter
    assert heads > 0.5 * row.bore_diameter + 0.3e-3


def test_dowels_lie_half_in_ring_and_half_in_housing() -> None:
    parts, layout = (
        known_parts("paper"),
        resolve(known_design("paper")).layout,
    )
    dowel, dowels = part_named(parts, "ring dowel"), layout.dowels
    hole = math.pi * dowels.radius**2 * (layout.pack.top - dowels.bottom) * dowel.count
    plain = known_design("paper")
    ring = part_named(parts, "ring")
    missing = (
        math.pi * layout.pack.ring_radius**2 - ring.shape.layers[-1].shape.outer.moments().area
    )
    per_hole = missing / dowel.count / (math.pi * dowels.radius**2)
    # Nearly half, because the ring's edge is curved, and its rounded edges.
    assert 0.48 < per_hole < 0.52
    assert hole > 0.0
    assert dowel.shape.top <= layout.pack.top - dowels.bottom
    assert plain.reducer.ring_tooth_count == 11
    turns = np.array(dowels.angles) / (2.0 * math.pi / 11)
    assert np.abs(turns - turns.round()).max() < 1e-12  # behind teeth


# ------------------------------------------------------------------ balance weights


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"reducer.disc_count": 1},
        {"reducer.disc_count": 1, "reducer.disc_material": "7075-T6"},
    ],
    ids=["two discs", "one disc", "one light disc"],
)
def test_weights_balance_everything_that_turns(changes: dict[str, object]) -> None:
    design, parts = built({**changes, "reducer.balance.counterweights": True})
    _, without = built(changes)
    before, after = crank_moments(design, without), crank_moments(design, parts)
    assert abs(before[0]) + abs(before[1]) / 10e-3 > 1e-5
    assert abs(after[0]) < 1e-12
    assert abs(after[1]) < 1e-12
    names = [part.name for part in parts if part.name.startswith("balance weight")]
    assert names == ["balance weight, shaft end", "balance weight, output end"]


def test_weights_run_clear() -> None:
    design, parts = built({"reducer.disc_count": 1, "reducer.balance.counterweights": True})
    near = tuple(
        part
        for part in parts
        if part.name.startswith("balance") or part.name in (*MOTOR, "housing")
    )
    assert assembly_motion(design, near, np.array([0.7]), DISPLAY).collisions == ()


def test_weights_without_a_motor_are_refused() -> None:
    with pytest.raises(GeometryError, match="choose another motor"):
        built({"motor.name": "CubeMars R100 KV90", "reducer.balance.counterweights": True})


def test_weights_too_heavy_for_the_bell_are_refused() -> None:
    changes = {
        "reducer.disc_count": 1,
        "reducer.disc_thickness": 60e-3,
        "reducer.balance.counterweights": True,
    }
    with pytest.raises(GeometryError, match="use two discs"):
        built(changes)
