"""Edges behind the cut of a flat part, held against a look along parallel lines of sight."""

import numpy as np
import pytest

from cqdd_design.design import load_design
from cqdd_design.exporting.edm.cut_facts import facts_of
from cqdd_design.exporting.edm.flat_parts import flat_parts
from cqdd_design.exporting.edm.wire_path import segmented
from cqdd_design.exporting.sheets.behind import edges_behind
from cqdd_design.exporting.sheets.cut_sheet import SECTION, draw_cut_sheet, sheet_scale
from cqdd_design.exporting.sheets.drawing import SheetDrawing
from cqdd_design.machine import resolve

STEP = 5e-6
JUMP = 0.15e-3


def _depths(contours, across):
    """How far below the axis a line of sight meets a wall, m; 0 where it begins in material."""
    points = [segmented(one).sample(1e-8) for one in contours]
    found = np.full(len(across), np.inf)
    inside = np.zeros(len(across), bool)
    for loop in points:
        one, two = loop, np.roll(loop, -1, axis=0)
        for k in range(len(one)):
            (x0, y0), (x1, y1) = one[k], two[k]
            low, high = sorted((x0, x1))
            first, last = np.searchsorted(across, [low, high])
            if first == last:
                continue
            x = across[first:last]
            y = y0 + (x - x0) * (y1 - y0) / (x1 - x0)
            inside[first:last] ^= y > 0.0
            below = np.where(y <= 0.0, -y, np.inf)
            found[first:last] = np.minimum(found[first:last], below)
    return np.where(inside, 0.0, found)


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("cqdd-10", {}),
        ("cqdd-10", {"reducer.ring_type": "pinwheel"}),
        ("printed-13", {}),
        ("reference-s", {}),
    ],
)
def test_edges_are_where_the_depth_of_what_is_seen_jumps(paper_design_file, name, change):
    design = load_design(paper_design_file.with_name(f"{name}.toml"))
    for flat in flat_parts(resolve(design.replacing(change))):
        edges = np.array(edges_behind(flat.contours))
        reach = np.abs(flat.contours[0].sample(1e-6)).max() + 1e-3
        across = np.arange(-reach, reach, STEP) + 0.37e-7
        depth = _depths(flat.contours, across)
        one, two = depth[:-1], depth[1:]
        with np.errstate(invalid="ignore"):
            jumps = (one > 0.0) & (two > 0.0) & (np.abs(two - one) > JUMP)
            step = np.abs(np.diff(np.where(depth > 0.0, depth, np.nan)))
        # A jump, not the steep begin of a round wall.
        beside = np.fmax(np.append(step[1:], np.nan), np.insert(step[:-1], 0, np.nan))
        jumps &= ~(step < 3.0 * beside) & (np.isfinite(one) | np.isfinite(two))
        places = 0.5 * (across[:-1] + across[1:])[jumps]
        assert len(places), "a look from the side shows some edge of every part"
        for place in places:
            assert np.abs(edges - place).min() < 2.0 * STEP, (flat.label, place)
        # Edges without a jump are corners, which only a pinwheel's lands have.
        ends = across[:-1][np.diff(depth > 0.0)]
        rims = np.concatenate([places, ends, across[:-1][np.isfinite(one) != np.isfinite(two)]])
        lone = [e for e in edges if np.abs(rims - e).min() > 2.0 * STEP]
        hidden = [e for e in lone if depth[np.abs(across - e).argmin()] == 0.0]
        assert not hidden, "nothing is seen where the cut is"
        if not change:
            bent = [e for e in lone if np.isfinite(depth[np.abs(across - e).argmin()])]
            near = [d for d in bent if depth[np.abs(across - d).argmin()] > JUMP]
            assert not near


def test_the_section_of_a_disc_shows_the_lobes_behind_its_valleys(paper_design_file, monkeypatch):
    """Ten lobes are cut through two valleys, at 53.788 mm; the lobes beside reach 57.964."""
    drawn, line = [], SheetDrawing.line

    def noted(sheet, start, end, layer="THIN"):
        drawn.append((start, end, layer))
        line(sheet, start, end, layer)

    monkeypatch.setattr(SheetDrawing, "line", noted)
    machine = resolve(load_design(paper_design_file))
    facts = facts_of(flat_parts(machine)[0], machine)
    draw_cut_sheet(facts)
    factor = 1e3 * sheet_scale(facts)
    half = 0.5 * factor * facts.flat.thickness
    for side in (-1j, 1j):
        edge = SECTION + side * factor * 28.982e-3
        face = SECTION - half + side * factor * 26.894e-3
        for one, two in ((edge - half, edge + half), (face, edge - half)):
            found = [
                layer
                for start, end, layer in drawn
                if abs(start - one) < 0.01 and abs(end - two) < 0.01
            ]
            assert found == ["OUTLINE"]
