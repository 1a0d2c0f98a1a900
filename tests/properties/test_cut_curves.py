"""Contours of DXF files against curves from published equations: disc, and rings of every kind."""

from __future__ import annotations

import math
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from cut_curves import (
    Points,
    Stage,
    away,
    beyond,
    clearing_fillet,
    flank,
    from_tooth,
    read_contour,
    touched,
)

from cqdd_design.design import Design, load_design
from cqdd_design.roads.export import export

DESIGNS = Path(__file__).resolve().parents[2] / "designs"
UM = 1e-3
"""In mm."""
FIT = 0.5 * UM + 0.06 * UM
"""Of a curve to arcs as the designs ask for it, and of coordinates to 0.1 um."""
EXACT = 0.1 * UM
"""Of what is made of arcs itself."""
NAMES = ("cqdd-10", "reference-s", "printed-13")


def design_of(name: str, **changes: object) -> Design:
    """A design of the repository, fitted to 0.5 um, with a ring that has a wall."""
    design = load_design(DESIGNS / f"{name}.toml")
    outside = design.reducer.ring.outer_diameter + 6e-3
    fine = {"edm.profile_tolerance": "0.5 um", "reducer.ring.outer_diameter": outside}
    return design.replacing({**fine, **changes})


def stage_of(design: Design) -> Stage:
    """Numbers of the design file, mm."""
    reducer = design.reducer
    lengths = reducer.ring_pitch_radius, reducer.eccentricity, 0.5 * reducer.ring_pin_diameter
    return Stage(reducer.ratio, *(1e3 * one for one in lengths))


def cut(design: Design, part: str, layer: str, folder: Path) -> tuple[Points, Points]:
    """The one polyline of a layer, read back."""
    files = export(design, "dxf", folder)
    (path,) = (file.path for file in files if file.path.stem.endswith(part))
    (line,) = (
        one
        for one in ezdxf.readfile(path).modelspace().query("LWPOLYLINE")
        if one.dxf.layer == layer
    )
    return read_contour(line)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("radial", [0.0, 20e-6])
def test_the_disc_is_the_published_cycloid(name: str, radial: float, tmp_path: Path) -> None:
    """Equidistant shift makes its pins thicker, radial shift their circle smaller."""
    design = design_of(name, **{"reducer.modification.radial": radial})
    asked = design.reducer.modification
    assert asked.rotation == 0.0
    assert asked.equidistant > 0.0
    whole = stage_of(design)
    made = whole._replace(r=whole.r + 1e3 * asked.equidistant, R=whole.R - 1e3 * asked.radial)
    label = "disc" if design.reducer.disc_count < 3 else "disc-1"
    points, _ = cut(design, label, "CUT_OUTER", tmp_path)
    curve = flank(made, np.linspace(0.0, 2.0 * math.pi, 200_000, endpoint=False))
    assert away(points, curve).max() < FIT
    assert away(curve[::20], points).max() < FIT
    # Without its shift the curve is another.
    plain = flank(whole, np.linspace(0.0, 2.0 * math.pi, 200_000, endpoint=False))
    assert away(points, plain).max() > 0.9e3 * asked.equidistant


@pytest.mark.parametrize("name", NAMES)
def test_the_conjugate_ring_is_what_the_theorem_of_gearing_makes(name: str, tmp_path: Path) -> None:
    design = design_of(name, **{"reducer.ring_type": "conjugate"})
    stage = stage_of(design)
    points, outward = cut(design, "ring", "CUT_INNER", tmp_path)
    # Counter-clockwise, its right is away from the axis.
    assert np.median((outward * np.conj(points)).real / np.abs(points)) > 0.5
    teeth, between = touched(stage)
    distance, leaning = from_tooth(stage, teeth)
    assert np.abs(distance - stage.r).max() < 1e-6
    assert leaning.max() == pytest.approx(stage.lean, abs=1e-4)
    away_from_teeth, angle = from_tooth(stage, points)
    on_tooth = (np.abs(away_from_teeth - stage.r) < EXACT) & (angle < stage.lean + 1e-4)
    assert away(points[~on_tooth], over(stage, between)).max() < FIT
    # The disc reaches all of it, by the line above; and nothing of the disc goes through.
    outline = flank(stage, np.linspace(0.0, 2.0 * math.pi, 20_000, endpoint=False))
    for crank in np.linspace(0.0, 2.0 * math.pi / stage.teeth, 12):
        disc = stage.e * np.exp(1j * crank) + outline * np.exp(-1j * crank / stage.n)
        assert beyond(disc, points, outward).max() < FIT


def over(stage: Stage, points: Points) -> Points:
    """Points repeated at every tooth."""
    turns = np.exp(2j * math.pi * np.arange(stage.teeth) / stage.teeth)
    return np.concatenate([points * turn for turn in turns])


@pytest.mark.parametrize("name", NAMES)
def test_the_solid_ring_is_teeth_root_and_the_largest_fillet_that_clears(
    name: str, tmp_path: Path
) -> None:
    design = design_of(name, **{"reducer.ring_type": "solid"})
    stage, clearance = stage_of(design), 1e3 * design.reducer.ring.relief_clearance
    points, _ = cut(design, "ring", "CUT_INNER", tmp_path)
    fillet, centre, root = clearing_fillet(stage, clearance)
    centres = over(stage, np.array([centre, np.conj(centre)]))
    to_tooth, leaning = from_tooth(stage, points)
    kinds = {
        "tooth": np.abs(to_tooth - stage.r),
        "root": np.abs(np.abs(points) - root),
        "fillet": np.abs(np.abs(points[:, None] - centres).min(axis=1) - fillet),
    }
    assert np.min(list(kinds.values()), axis=0).max() < UM
    # The part of a tooth that bears is the circle alone, and all of it is there.
    bearing = leaning < stage.lean
    assert kinds["tooth"][bearing & (to_tooth < 1.5 * stage.r)].max() < EXACT
    assert (kinds["root"] < EXACT).any()


@pytest.mark.parametrize("rollers", [False, True])
def test_the_ring_of_pins_is_a_bore_and_round_pockets(rollers: bool, tmp_path: Path) -> None:
    """Pockets of the pins' radius, or clear of the rollers on them."""
    changes = {"reducer.ring_type": "pinwheel"}
    if rollers:
        tooth = load_design(DESIGNS / "cqdd-10.toml").reducer.ring_pin_diameter
        changes |= {"reducer.ring.roller_diameter": tooth, "reducer.ring_pin_diameter": 0.6 * tooth}
    design = design_of("cqdd-10", **changes)
    clearance = 1e3 * design.reducer.ring.relief_clearance
    stage = stage_of(load_design(DESIGNS / "cqdd-10.toml"))
    points, _ = cut(design, "ring", "CUT_INNER", tmp_path)
    pocket = stage.r + clearance if rollers else stage.r
    bore = stage.R + 2.0 * stage.e - stage.r + clearance
    to_pin, _ = from_tooth(stage, points)
    # What is cut out is a round hole and the pockets together: their common outline.
    inside = np.maximum(bore - np.abs(points), pocket - to_pin)
    assert np.abs(inside).max() < EXACT
    for circle in (np.abs(np.abs(points) - bore), np.abs(to_pin - pocket)):
        assert (circle < EXACT).mean() > 0.1
