"""Report sections of the contact engine: what the figures show is what was computed."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from cqdd_design.catalog import find_bearing
from cqdd_design.design import Design, load_design
from cqdd_design.gearbox.tolerance.ensemble import make_ensemble
from cqdd_design.gearbox.tolerance.run import ToleranceResult, run_ensemble
from cqdd_design.machine import resolve
from cqdd_design.machine.contact_analysis import ContactAnalysis, analyse_contact
from cqdd_design.report.drawings.outlines import Outlines
from cqdd_design.report.gearbox.contact import contact_view, force_picture
from cqdd_design.report.gearbox.life import life_view
from cqdd_design.report.gearbox.losses import losses_view
from cqdd_design.report.gearbox.precision import precision_view
from cqdd_design.report.gearbox.tolerances import tolerance_view
from cqdd_design.report.ink.axes import Axis
from cqdd_design.report.ink.bars import bar_chart, histogram
from cqdd_design.report.ink.heat import SHADES, heat_map, labelled_map, shade
from cqdd_design.report.ink.svg import Figure, Words

PAPER = Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml"
WORDS = Words("id", "title", "description", "caption")


@pytest.fixture(scope="module")
def design() -> Design:
    return load_design(PAPER)


@pytest.fixture(scope="module")
def found(design: Design) -> ContactAnalysis:
    return analyse_contact(resolve(design), angles=120)


@pytest.fixture(scope="module")
def outlines(design: Design) -> Outlines:
    return Outlines.from_design(design, find_bearing("6902"))


@pytest.fixture(scope="module")
def ensemble(design: Design) -> ToleranceResult:
    return run_ensemble(make_ensemble(design, angles=44), 160)


def test_loads_and_speeds_of_the_analysis(design: Design, found: ContactAnalysis) -> None:
    """Windup from an eighth to three times the torque; the map in eighths up to speed and peak."""
    steady, asked = found.precision.torque, design.requirements
    shares = [point.torque / steady for point in found.precision.curve]
    assert shares == pytest.approx([0.125, 0.25, 0.5, 0.75, 1.0, 2.0, 3.0])
    eighths = np.arange(1, 9) / 8
    np.testing.assert_allclose(found.map.input_speed, eighths * asked.input_speed)
    np.testing.assert_allclose(found.map.torque, eighths * asked.peak_torque)


def tree(figure: Figure) -> ElementTree.Element:
    return ElementTree.fromstring(figure.render())


def classed(figure: Figure, tag: str, words: str) -> list[ElementTree.Element]:
    return [e for e in tree(figure).iter(tag) if words in e.get("class", "").split()]


def number(element: ElementTree.Element, name: str) -> float:
    return float(element.get(name, "nan"))


# ------------------------------------------------------------------ building blocks


def test_shades_rise_with_the_value() -> None:
    values = np.linspace(0.0, 7.0, 200)
    shades = [shade(float(v), 7.0) for v in values]
    assert shades == sorted(shades)
    assert shades[0] == 0
    assert set(shades[1:]) == set(range(1, SHADES + 1))
    assert shade(1.0, 0.0) == 0


def test_the_heat_map_covers_each_loaded_cell_with_its_shade() -> None:
    rng = np.random.default_rng(3)
    values = np.maximum(rng.normal(size=(4, 30)), 0.0)
    figure = heat_map(WORDS, values, list("abcd"), "r", Axis(0.0, 30.0, (0.0, 30.0), "x"), "N")
    frame = classed(figure, "rect", "frame")[0]
    left, top, width = (number(frame, name) for name in ("x", "y", "width"))
    cells = [
        e for e in tree(figure).iter("rect")
        if e.get("class", "").startswith("heat-") and number(e, "y") >= top - 1e-6
    ]  # fmt: skip
    covered = np.zeros(values.shape, dtype=int)
    for cell in cells:
        row = round((number(cell, "y") - top) / 15.0)
        begin = round((number(cell, "x") - left) / width * 30)
        end = round((number(cell, "x") + number(cell, "width") - left) / width * 30)
        covered[row, begin:end] = int(cell.get("class", "").removeprefix("heat-"))
    expected = [[shade(float(v), float(values.max())) for v in row] for row in values]
    assert np.array_equal(covered, expected)


def test_bars_are_in_proportion_and_marks_stand_at_their_values() -> None:
    figure = bar_chart(WORDS, ["a", "b", "c"], [4.0, 2.0, 1.0], ["4", "2", "1"], [1.0, 2.0, 0.5])
    widths = [number(e, "width") for e in classed(figure, "rect", "share-bar")]
    assert widths[0] / widths[1] == pytest.approx(2.0, rel=1e-3)
    assert widths[0] / widths[2] == pytest.approx(4.0, rel=1e-3)
    left = number(classed(figure, "rect", "share-bar")[0], "x")
    ticks = [number(e, "x1") - left for e in classed(figure, "line", "bar-one")]
    assert ticks[1] == pytest.approx(widths[1], abs=0.02)
    assert ticks[0] == pytest.approx(widths[0] / 4.0, abs=0.02)


def test_the_histogram_counts_every_value() -> None:
    values = np.random.default_rng(1).normal(5.0, 1.0, 400)
    figure = histogram(WORDS, values, [("p50", float(np.median(values)))], "x")
    heights = [number(e, "height") for e in classed(figure, "rect", "share-bar")]
    most = int(next(e.text for e in tree(figure).iter("text") if (e.text or "").isdigit()) or 0)
    tallest = [int(e.text) for e in tree(figure).iter("text") if (e.text or "").isdigit()]
    assert most > 0
    counted = sum(h / max(heights) * max(tallest) for h in heights)
    assert counted == pytest.approx(400, abs=2)
    mark = classed(figure, "line", "percentile")[0]
    bars = classed(figure, "rect", "share-bar")
    below = sum(
        number(b, "height")
        for b in bars
        if number(b, "x") + number(b, "width") < number(mark, "x1")
    )
    assert below / sum(heights) == pytest.approx(0.5, abs=0.12)


def test_a_single_value_makes_a_histogram_too() -> None:
    figure = histogram(WORDS, np.zeros(5), [("p50", 0.0)], "x")
    assert len(classed(figure, "rect", "share-bar")) == 1


def test_the_labelled_map_writes_its_values_in_per_cent() -> None:
    figure = labelled_map(
        WORDS, np.array([[0.5, 0.75], [0.6, 0.9]]), ["a", "b"], ["1", "2"], ("r", "c")
    )
    shown = [e.text for e in classed(figure, "text", "cell-text")]
    assert shown == ["50.0", "75.0", "60.0", "90.0"]
    shades = [
        int(re.search(r"heat-(\d)", e.get("class", ""))[1]) for e in classed(figure, "rect", "cell")
    ]
    assert shades[3] == SHADES
    assert shades == [1, shade(0.25, 0.4), shade(0.1, 0.4), SHADES]


# ------------------------------------------------------------------ sections


def test_the_darkest_cell_is_the_most_loaded_tooth(
    found: ContactAnalysis, outlines: Outlines, design: Design
) -> None:
    view = contact_view(found, outlines, resolve(design).analysis.rigid)
    assert len(view["heat_maps"]) == 2
    turn = found.crank_turn
    for disc, figure in enumerate(view["heat_maps"]):
        force = turn.ring_force[:, disc, :]
        angle, tooth = np.unravel_index(int(force.argmax()), force.shape)
        frame = classed(figure, "rect", "frame")[0]
        at_x = number(frame, "x") + number(frame, "width") * (angle + 0.5) / len(force)
        at_y = number(frame, "y") + 15.0 * (tooth + 0.5)
        inside = [
            e for e in classed(figure, "rect", f"heat-{SHADES}")
            if number(e, "x") <= at_x <= number(e, "x") + number(e, "width")
            and number(e, "y") <= at_y <= number(e, "y") + 15.0
        ]  # fmt: skip
        assert inside
    rows = {name: (law, here) for name, law, here in view["rows"]}
    law, here = rows["greatest cam bearing load"]
    assert "5003" in law
    assert f"{found.sweep.cam_load.max():.0f}"[:3] in here.replace("\u202f", "")


def test_what_the_plane_problem_leaves_out_is_a_sentence(
    found: ContactAnalysis, outlines: Outlines, design: Design
) -> None:
    law = resolve(design).analysis.rigid
    told = contact_view(found, outlines, law)["bending"]
    assert found.bending is not None
    closing = found.bending.edge_closing
    assert closing is not None
    for value in (found.bending.deflection, closing, found.bending.ring_approach):
        assert f"{1e6 * value:.3g}\u202f\u00b5m" in told
    assert f"{found.bending.carrier_moment:.3g}\u202fN" in told
    bushed = replace(found.bending, support_deflection=None, support_slope=None, edge_closing=None)
    assert (
        "bearings let" not in contact_view(replace(found, bending=bushed), outlines, law)["bending"]
    )
    level = replace(found.bending, edge_closing=2.6e-21)
    told = contact_view(replace(found, bending=level), outlines, law)["bending"]
    assert "the teeth would close by 0\u202f\u00b5m" in told
    missing = replace(found, bending=None, bending_missing="nothing fits")
    assert contact_view(missing, outlines, law)["bending"].endswith("tilt: nothing fits")


def test_arrows_point_where_the_forces_do(found: ContactAnalysis, outlines: Outlines) -> None:
    turn = found.crank_turn
    figure = force_picture(turn, outlines)
    at, disc, _ = np.unravel_index(int(turn.ring_force.argmax()), turn.ring_force.shape)
    shafts = classed(figure, "line", "force-ring-line")
    loaded = np.flatnonzero(turn.ring_force[at, disc] > 0.0)
    assert len(shafts) == len(loaded)
    for shaft, tooth in zip(shafts, loaded, strict=True):
        dx = number(shaft, "x2") - number(shaft, "x1")
        dy = number(shaft, "y1") - number(shaft, "y2")
        # Friction turns a force off its normal by 0.08 rad, one way or the other.
        pressed, rubbed = turn.ring_force[at, disc, tooth], turn.ring_tangential[at, disc, tooth]
        assert abs(rubbed) == pytest.approx(0.08 * pressed, rel=1e-9)
        nx, ny = turn.ring_normal[at, disc, tooth]
        along = math.atan2(ny, nx) + math.atan2(rubbed, pressed)
        if math.hypot(dx, dy) > 8.0:
            assert math.remainder(math.atan2(dy, dx) - along, math.tau) == pytest.approx(
                0, abs=0.02
            )
    labels = [e.text for e in classed(figure, "text", "force-label")]
    greatest = f"{turn.ring_force[at, disc].max() * math.hypot(1.0, 0.08):.0f}"
    assert greatest in [(text or "").replace("\u202f", "") for text in labels]


def test_precision_stands_beside_the_paper_only_for_its_design(
    found: ContactAnalysis, design: Design
) -> None:
    paper = precision_view(found, design)
    other = precision_view(found, design.replacing({"reducer.ring_pin_diameter": 6.9e-3}))
    assert paper["measured"]
    assert not other["measured"]
    assert [row[2] for row in paper["rows"] if row[2]] == [
        "7.03 \u00b1 1.3 arcmin",
        "3 N\u00b7m (\u00b11.5 N\u00b7m)",
    ]
    assert other["rows"] == tuple((row[0], row[1], row[3]) for row in paper["rows"])
    bars = classed(paper["figures"][1], "rect", "share-bar")
    sizes = [o.amplitude for o in found.precision.orders[: len(bars)]]
    widths = [number(b, "width") for b in bars]
    assert widths[1] / widths[0] == pytest.approx(sizes[1] / sizes[0], rel=0.02)


def test_losses_add_up(found: ContactAnalysis) -> None:
    view = losses_view(found)
    widths = [number(b, "width") for b in classed(view["figures"][0], "rect", "share-bar")]
    power = list(found.losses.by_source.values())
    assert widths[1] / widths[0] == pytest.approx(power[1] / power[0], rel=0.01)
    shown = [float(e.text or "nan") for e in classed(view["figures"][1], "text", "cell-text")]
    grid = found.map
    assert shown[0] == pytest.approx(100.0 * grid.forward[0, -1], abs=0.05)
    assert shown[-1] == pytest.approx(100.0 * grid.forward[-1, 0], abs=0.05)


def test_life_tells_what_does_not_last(found: ContactAnalysis, design: Design) -> None:
    view = life_view(found.life, design.requirements)
    assert view["assumed"]
    assert view["held_speed"] == "the input speed of 1286\u202frpm"
    slower = design.requirements.model_copy(update={"continuous_speed": 20.0 * math.pi})
    told = life_view(found.life, slower)["held_speed"]
    assert told == "the continuous speed of 600\u202frpm"
    holds = {row[0]: row[4][1] for row in view["rows"]}
    for part in found.life.parts:
        lasts = part.hours is None or part.hours >= 1000.0
        assert holds[part.part] is (lasts and part.limit > 0.0)


@pytest.mark.deep
def test_tolerances_show_the_ensemble(ensemble: ToleranceResult) -> None:
    view = tolerance_view(ensemble)
    assert "160 gearboxes" in view["lead"]
    assert len(view["figures"]) == 6
    ranked = ensemble.ranking("backlash_arcmin")
    (figure,) = (one for one in view["figures"] if one.id == "ranking-backlash")
    names = [e.text for e in classed(figure, "text", "name-dark")]
    assert names == [group.replace("_", " ") for group, _, _ in ranked]
    # The uncertainty of the first bar's share stands beside it.
    indices = ensemble.sensitivity["backlash_arcmin"]
    width = indices.total_half_width[int(np.argmax(indices.total))]
    told = [e.text for e in classed(figure, "text", "tick")]
    assert told[0] == f"{100.0 * ranked[0][2]:.0f} \u00b1{100.0 * width:.0f}\u202f%"
    assert len(view["rows"]) == 10
