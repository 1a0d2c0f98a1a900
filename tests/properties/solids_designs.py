"""Designs that between them use every part the solids know, and random ones for the layout."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from hypothesis import assume
from hypothesis import strategies as st

from cqdd_design.catalog.bearings import Bearing, bearings
from cqdd_design.catalog.screws import LEAST_COLUMN
from cqdd_design.design import Design, load_design
from cqdd_design.geometry.trochoid import undercut_radius_limit
from cqdd_design.machine import resolve
from cqdd_design.solids.part import Part

PAPER_FILE = Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml"

CHANGES: dict[str, dict[str, object]] = {
    "paper": {},
    # A loose third cam, three discs that are three parts.
    "three discs": {
        "reducer.disc_count": 3,
        "reducer.disc_thickness": 0.006,
        "reducer.cam_bearing.designation": "6802",
    },
    # Separate ring pins, roller sleeves on inch screws, and a register beside any stator.
    "pinwheel": {
        "reducer.ring_type": "pinwheel",
        "reducer.ring.outer_diameter": 0.078,
        "reducer.output_pins.diameter": 0.003175,
        "reducer.output_pins.sleeve_diameter": 0.0045,
    },
    # The second envelope, pins without a cap.
    "conjugate": {
        "reducer.ring_type": "conjugate",
        "reducer.output_pins.support": "cantilever",
        "reducer.modification.equidistant": 0.00001,
    },
    # One disc; a dense circle of pins of no catalogue size becomes dowels.
    "one disc": {
        "reducer.disc_count": 1,
        "reducer.eccentricity": 0.0012,
        "reducer.output_pins.count": 12,
        "reducer.output_pins.diameter": 0.0045,
        "reducer.output_pins.circle_radius": 0.02,
    },
    # Columns thicker than the pins between plate and cap.
    "columns": {
        "reducer.carrier.joint": "columns",
        "reducer.carrier.column_diameter": 0.006,
        "reducer.output_pins.circle_radius": 0.0215,
        "reducer.cam_bearing.designation": "6803",
    },
    # Pins bonded into the cap.
    "clamped": {"reducer.carrier.joint": "clamped"},
}

#: Of the paper's design: so many pockets of pins that tabs and notes have little room between.
MANY_POCKETS = {
    "reducer.ring_type": "pinwheel",
    "reducer.ratio": 40,
    "requirements.ratio": 40,
    "reducer.eccentricity": "0.5 mm",
    "reducer.ring_pin_diameter": "2.5 mm",
    "reducer.ring_pitch_radius": "34 mm",
    "reducer.ring.outer_diameter": "76 mm",
}


@lru_cache(maxsize=16)
def known_design(name: str) -> Design:
    """One of the designs of `CHANGES`."""
    design = load_design(PAPER_FILE)
    return design.replacing(CHANGES[name]) if CHANGES[name] else design


@lru_cache(maxsize=16)
def known_parts(name: str) -> tuple[Part, ...]:
    """Its parts, built once for all tests."""
    design = known_design(name)
    return resolve(design).parts


def part_named(parts: tuple[Part, ...], name: str) -> Part:
    """The part of this name."""
    return next(part for part in parts if part.name == name)


@st.composite
def machines(draw: st.DrawFn) -> tuple[Design, Bearing]:
    """Designs of any size from 15 to 400 mm whose discs and rings exist."""
    n = draw(st.integers(4, 60))
    outside = 10.0 ** draw(st.floats(-1.8, -0.4))
    kind = draw(st.sampled_from(["solid", "conjugate", "pinwheel"]))
    R = outside / 2.0 * draw(st.floats(0.70, 0.82 if kind == "pinwheel" else 0.9))
    e = draw(st.floats(0.3, 0.8)) * R / (n + 1)
    most = min(float(undercut_radius_limit(n, R, e)), R * math.sin(math.pi / (n + 1)))
    r = draw(st.floats(0.4, 0.8)) * most
    thickness = outside * draw(st.floats(0.05, 0.16))
    fitting = [
        row
        for row in bearings().values()
        if row.kind != "crossed roller"
        and row.width <= thickness
        and row.bore_diameter >= 4.0 * e
        and row.outer_diameter < 1.2 * R
    ]
    assume(fitting)
    bearing = fitting[draw(st.integers(0, len(fitting) - 1))]
    diameter = draw(st.sampled_from([2, 3, 3.175, 4, 4.5, 5, 6, 6.35, 8, 10, 12])) * 1e-3
    sleeve = diameter + 1.5e-3 if draw(st.booleans()) else 0.0
    hole = (sleeve or diameter) + 2.0 * e
    least = bearing.outer_diameter / 2.0 + hole / 2.0 + 1e-3
    farthest = R - r - e - hole / 2.0 - 1e-3
    assume(least < farthest)
    circle = least + (farthest - least) * draw(st.floats(0.0, 1.0))
    fits = int(math.pi / math.asin(min(1.0, (hole + 1e-3) / (2.0 * circle))))
    assume(fits >= 3)
    reducer: dict[str, Any] = {
        "ratio": n,
        "ring_pitch_radius": R,
        "eccentricity": e,
        "ring_pin_diameter": 2.0 * r,
        "ring_type": kind,
        "disc_count": draw(st.integers(1, 3)),
        "disc_thickness": thickness,
        "disc_spacing": draw(st.sampled_from([0.0, 0.2e-3, 0.5e-3, 1e-3])),
        "output_pins": {
            "count": draw(st.integers(3, min(fits, 40))),
            "diameter": diameter,
            "circle_radius": circle,
            "sleeve_diameter": sleeve,
            "support": draw(st.sampled_from(["both", "cantilever"])),
        },
        "cam_bearing": {"designation": bearing.designation},
        "ring": {"outer_diameter": outside},
    }
    reducer["carrier"] = draw(carriers(reducer, bearing, farthest + hole / 2.0))
    return Design.from_mapping({"reducer": reducer}, si=True), bearing


@st.composite
def carriers(
    draw: st.DrawFn, reducer: Mapping[str, Any], bearing: Bearing, most_reach: float
) -> dict[str, object]:
    """How plate and cap are joined; columns where their holes have room within `most_reach`."""
    pins, e = reducer["output_pins"], reducer["eccentricity"]
    circle, hole = pins["circle_radius"], (pins["sleeve_diameter"] or pins["diameter"]) + 2.0 * e
    room = min(
        2.0 * (2.0 * circle * math.sin(0.5 * math.pi / pins["count"]) - 0.5 * hole),
        2.0 * (circle - 0.5 * bearing.outer_diameter),
        2.0 * (most_reach - circle),
    )
    most = room - 2.0 * e - 1.5e-3
    joints = ["clamped", "hinged"]
    if most > LEAST_COLUMN and pins["support"] == "both":
        joints.append("columns")
    joint = draw(st.sampled_from(joints))
    if joint != "columns":
        return {"joint": joint}
    share = draw(st.floats(0.0, 1.0))
    diameter = LEAST_COLUMN + share * (min(most, 0.1) - LEAST_COLUMN)
    return {"joint": joint, "column_diameter": diameter}
