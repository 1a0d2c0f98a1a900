"""Numbers, formulas, charts and drawing lines of the report, against values worked by hand."""

from __future__ import annotations

import itertools
import math
import re
from pathlib import Path
from xml.dom import minidom

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cqdd_design.catalog import find_bearing
from cqdd_design.cli.tables import checks_table
from cqdd_design.design import Design, load_design
from cqdd_design.gearbox import CHECK_GUIDE
from cqdd_design.gearbox.disc_forces import disc_forces
from cqdd_design.geometry.contours import ArcContour, Circle
from cqdd_design.machine import resolve
from cqdd_design.report.drawings.front_view import front_view
from cqdd_design.report.drawings.half_section import half_section, reach_along_x
from cqdd_design.report.drawings.outlines import Outlines
from cqdd_design.report.drawings.turning_mesh import mesh_figure
from cqdd_design.report.ink.axes import nice_step
from cqdd_design.report.ink.charts import Curve, Level, line_chart, margin_bar
from cqdd_design.report.ink.dimensions import Leader, leader_column
from cqdd_design.report.ink.mathml import mathml
from cqdd_design.report.ink.numbers import decimals, quantity_text, significant, with_unit
from cqdd_design.report.ink.svg import View, Words, contour_path, element, text
from cqdd_design.report.judgement.check_rows import check_row, margin_text, printed, sentence
from cqdd_design.results import Check


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        (0.0, "0"),
        (1526.93, "1527"),
        (0.00015, "0.00015"),
        (-10, "\u221210"),
        (0.99996, "1"),
        (5.012e-4, "0.0005012"),
        (5.012e-7, "5.012\u202f\u00d7\u202f10\u207b\u2077"),
        (123456.0, "123\u202f500"),
        (math.inf, "\u221e"),
    ],
)
def test_significant_digits(value: float, shown: str) -> None:
    assert significant(value) == shown


@given(st.floats(1e-12, 1e12), st.integers(2, 8))
def test_significant_digits_read_back(value: float, digits: int) -> None:
    shown = significant(value, digits).replace("\u202f", "")
    if "\u00d7" in shown:
        raised = str.maketrans(
            "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079\u207b", "0123456789-"
        )
        mantissa, power = shown.split("\u00d710")
        shown = f"{mantissa}e{power.translate(raised)}"
    assert float(shown) == pytest.approx(value, rel=0.51 * 10.0 ** (1 - digits))


def test_units_are_printed() -> None:
    assert quantity_text("120 N*m") == "120\u202fN\u00b7m"
    assert quantity_text("6 um") == "6\u202f\u00b5m"
    assert quantity_text("CubeMars RO100 KV55") == "CubeMars RO100 KV55"
    assert with_unit(0.5, "") == "0.5"
    assert decimals(-0.001, 2) == "0.00"


@pytest.mark.parametrize("guide", CHECK_GUIDE.values(), ids=list(CHECK_GUIDE))
def test_every_rule_is_well_formed_markup(guide: object) -> None:
    markup = mathml(guide.formula)  # type: ignore[attr-defined]
    minidom.parseString(f"<p>{markup}</p>")
    assert "_" not in re.sub(r"<[^>]*>", "", markup).replace("outer_diameter", "")


def _words(markup: str) -> str:
    return re.sub(r"<[^>]+>", "", markup)


def test_a_fraction_takes_all_that_stands_before_it() -> None:
    markup = mathml("4 F/(pi d^2)")
    above, below = re.search(r"<mfrac>(<mrow>.*?</mrow>)(.*)</mfrac>", markup).groups()  # type: ignore[union-attr]
    assert _words(above) == "4F"
    assert _words(below) == "\u03c0d2"
    assert "(" not in below, "a fraction bar needs no parentheses"


def test_roots_indices_and_relations() -> None:
    markup = mathml("p0 = sqrt(1.15 F E*/(pi b R_eq)) <= 1.67 S_y")
    assert markup.count("<math") == 3
    assert "<msqrt><mfrac>" in markup
    assert "<msub><mi>R</mi><mtext>eq</mtext></msub>" in markup
    assert " \u2264 " in markup


def test_prose_stays_prose() -> None:
    assert "<math" not in mathml("least distance of hole edge and flank")
    assert "<script" not in mathml("a < <script>alert(1)</script> of the very worst kind")


def check(value: float, limit: float, sense: str = "max", severity: str = "fail") -> Check:
    return Check(
        id="TEST-ONE",
        title="A title",
        value=value,
        limit=limit,
        unit="MPa",
        sense=sense,  # type: ignore[arg-type]
        formula="sigma = F/A",
        substituted="2 x 3 N*m = 6 um",
        why="Why.",
        remedy="use more",
        source="nobody",
        severity=severity,  # type: ignore[arg-type]
    )


@pytest.mark.parametrize(
    ("value", "limit", "side"), [(50.0, 100.0, 1), (200.0, 100.0, -1), (1e4, 100.0, -1)]
)
def test_margin_bar_points_the_right_way(value: float, limit: float, side: int) -> None:
    bar = margin_bar(check(value, limit))
    one = float(re.findall(r'<line x1="([\d.]+)"', bar)[-1])
    left = float(re.search(r'<rect x="([\d.]+)"', bar)[1])  # type: ignore[index]
    assert (left >= one - 1e-9) == (side > 0)
    assert ("<circle" in bar) == (abs(math.log(limit / value)) < math.log(4.0))


def test_check_rows() -> None:
    row = check_row(check(200.0, 100.0))
    assert (row["word"], row["margin"], row["limit"]) == ("fails", "0.5", "\u2264 100\u202fMPa")
    assert row["substituted"] == "2 \u00d7 3 N\u00b7m = 6 \u00b5m"
    assert row["remedy"] == "Use more."
    assert check_row(check(50.0, 100.0))["remedy"] == ""
    assert check_row(check(200.0, 100.0, severity="warn"))["word"] == "warning"


def test_a_narrow_failure_does_not_read_as_one() -> None:
    assert margin_text(check(100.02, 100.0)) == "0.9998"
    assert margin_text(check(100.0, 100.0)) == "1"
    assert margin_text(check(1e-9, 100.0)) == "ample"


@pytest.mark.parametrize(("value", "told"), [(0.6, "167"), (0.05, "ample")])
def test_the_terminal_and_the_report_call_a_great_margin_the_same(value: float, told: str) -> None:
    one = check(value, 100.0)
    assert margin_text(one) == told
    assert checks_table([one]).split()[-1] == told


def test_a_needle_bearing_on_its_inner_ring_is_named_in_two_lines(paper_design_file: Path) -> None:
    """27 signs in one were cut at the edge of the drawing."""
    machine = resolve(load_design(paper_design_file.with_name("printed-13.toml")))
    drawn = half_section(Outlines.from_design(machine.design, machine.cam)).body
    assert "needle HK1522<" in drawn
    assert "on IR12x15x22.5, cam bearing<" in drawn


def test_signs_and_sentences() -> None:
    assert printed("cut at +-2 um, -9.5 of 1e6") == "cut at \u00b12 \u00b5m, \u22129.5 of 10\u2076"
    assert printed("18-8 screws to 52-58 HRC") == "18-8 screws to 52-58 HRC"
    assert sentence("disc_thickness to 9 mm") == "disc_thickness to 9 mm."
    assert sentence("raise it") == "Raise it."


@given(st.floats(1e-6, 1e9), st.integers(2, 10))
def test_ticks_are_round_and_few(span: float, most: int) -> None:
    step = nice_step(span, most)
    assert span / step <= most * (1.0 + 1e-9)
    assert step <= 2.6 * span / most * (1.0 + 1e-9)
    mantissa = step / 10.0 ** math.floor(math.log10(step) + 1e-9)
    assert min(abs(mantissa - good) for good in (1.0, 2.0, 2.5, 5.0)) < 1e-6


def test_a_curve_keeps_its_shape_with_the_points_that_show() -> None:
    x = np.linspace(0.0, 360.0, 721)
    y = 1000.0 * np.abs(np.sin(np.radians(3.0 * x)))
    ticks = (0.0, 360.0)
    chart = line_chart(
        Words("c", "t", "d"), x, [Curve("", y, "faint")], x_label="", y_label="", x_ticks=ticks
    )
    d = re.search(r'<path d="M([^"]+)" class="curve', chart.render())[1]  # type: ignore[index]
    kept = np.array([[float(v) for v in pair.split()] for pair in d.split("L")])
    assert 30 < len(kept) < 300
    across = (kept[-1, 0] - kept[0, 0]) / 360.0
    zero, high = kept[0, 1], (kept[0, 1] - kept[:, 1].min()) / 1000.0
    # Across the curve it is a twentieth of a px; downward, where it is steep, a little more.
    shown = np.interp(x, (kept[:, 0] - kept[0, 0]) / across, zero - kept[:, 1])
    assert np.abs(shown - high * y).max() < 0.4
    beside = np.abs(shown - high * y) / np.hypot(1.0, np.gradient(high * y, across * x))
    assert beside.max() < 0.08


def test_a_chart_puts_its_numbers_where_they_belong() -> None:
    x = np.linspace(0.0, 360.0, 5)
    figure = line_chart(
        Words("a-chart", "Title", "Description"),
        x,
        [Curve("line", np.array([0.0, 50.0, 110.0, 50.0, 0.0]), "series-1")],
        [Level("limit", 50.0)],
        x_label="angle",
        y_label="force",
        x_ticks=(0.0, 180.0, 360.0),
    )
    svg = figure.render()
    d = re.search(r'<path d="M([^"]+)" class="curve', svg)[1]  # type: ignore[index]
    points = np.array([[float(v) for v in pair.split()] for pair in d.split("L")])
    limit = float(re.search(r'y1="([\d.]+)"[^>]*class="limit"', svg)[1])  # type: ignore[index]
    assert points[1, 1] == pytest.approx(limit, abs=0.02), "50 lies on the limit of 50"
    assert points[0, 1] > points[1, 1] > points[2, 1], "up is more"
    assert np.diff(points[:, 0]) == pytest.approx([points[1, 0] - points[0, 0]] * 4, abs=0.02)
    assert 'role="img"' in svg
    assert "<title" in svg


def test_contours_become_true_arcs() -> None:
    """A half circle and a chord: the arc runs over the top of the page, where y is smaller."""
    half = ArcContour(np.array([[1e-3, 0.0], [-1e-3, 0.0]]), np.array([1.0, 0.0]))
    path = contour_path(half, View(1e4, (100.0, 50.0)))
    assert path == "M110 50A10 10 0 0 0 90 50L110 50Z"
    whole = contour_path(Circle(np.zeros(2), 1e-3), View(1e4, (0.0, 0.0)))
    assert whole == "M-10 0a10 10 0 1 0 20 0a10 10 0 1 0 -20 0Z"


def test_text_is_escaped_and_lowered() -> None:
    shown = text((1.0, 2.0), "Z_r < 3 & R_{eq}")
    assert "&lt; 3 &amp; R" in shown
    assert '<tspan class="sub" dy="3">eq</tspan>' in shown
    assert element("g", title='a "b"') == '<g title="a &quot;b&quot;"/>'


@given(st.lists(st.floats(0.0, 400.0), min_size=1, max_size=7))
def test_leader_labels_keep_apart_and_in_order(heights: list[float]) -> None:
    leaders = [Leader((300.0, y), f"v{i}", f"n{i}") for i, y in enumerate(heights)]
    markup = leader_column(leaders, 100.0, "left", 20.0, 420.0)
    placed = [
        (int(name), float(y))
        for y, name in re.findall(r'y="([-\d.]+)" class="value"[^>]*>v(\d+)<', markup)
    ]
    assert len(placed) == len(heights)
    ys = [y for _, y in placed]
    assert all(b - a >= 46.0 - 0.011 for a, b in itertools.pairwise(ys))
    assert min(ys) >= 20.0 - 0.011
    assert max(ys) <= 420.011
    targets = [heights[i] for i, _ in placed]
    assert targets == sorted(targets), "leaders would cross"


@pytest.mark.parametrize("ratio", [4, 5, 9, 23, 60, 119])
@pytest.mark.parametrize("discs", [1, 2, 3])
def test_drawings_of_every_ratio_are_well_formed(ratio: int, discs: int) -> None:
    """From the smallest ratio to the largest; the paths hold finite numbers only."""
    radius = 60.0
    design = Design.from_mapping(
        {
            "reducer": {
                "ratio": ratio,
                "ring_pitch_radius": f"{radius} mm",
                "eccentricity": f"{0.5 * radius / (ratio + 1)} mm",
                "ring_pin_diameter": f"{0.7 * radius * math.sin(math.pi / (ratio + 1))} mm",
                "disc_count": discs,
                "output_pins": {"count": 6, "circle_radius": "30 mm"},
                "ring": {"outer_diameter": "200 mm"},
            }
        }
    )
    outlines = Outlines.from_design(design, find_bearing("6902"))
    for figure in (
        front_view(outlines),
        half_section(outlines),
        mesh_figure(outlines, 90.0, 4000.0),
    ):
        svg = figure.render()
        minidom.parseString(svg)
        assert "nan" not in svg
        assert "inf" not in svg
        assert len(svg) < 250_000


@pytest.mark.parametrize("degrees", [0.0, 30.0, 217.0])
def test_drawn_pins_stand_where_the_law_has_them(degrees: float) -> None:
    """In the order of the law, and each within its hole of every disc."""
    design = Design.from_mapping(
        {
            "reducer": {
                "ratio": 10,
                "ring_pitch_radius": "32 mm",
                "eccentricity": "1.6 mm",
                "ring_pin_diameter": "7 mm",
                "disc_count": 3,
                "output_pins": {"count": 5, "circle_radius": "19.5 mm"},
                "ring": {"outer_diameter": "72 mm"},
            }
        }
    )
    outlines, angle = Outlines.from_design(design, find_bearing("6902")), math.radians(degrees)
    stages = outlines.stages
    around = np.array(outlines.pin_angles(angle))
    pins = stages.pin_circle_radius * np.column_stack([np.cos(around), np.sin(around)])
    for disc in range(3):
        forces = disc_forces(stages, 50.0, angle, disc)
        touched = pins + stages.pin_contact_radius * forces.pin_direction
        assert forces.pin_point == pytest.approx(touched, abs=1e-12)
        holes = outlines.posed_disc(disc, angle).holes
        middles = np.array([hole.centre for hole in holes if isinstance(hole, Circle)])
        apart = np.linalg.norm(middles[:, None] - pins, axis=-1).min(axis=0)
        assert apart == pytest.approx([design.reducer.eccentricity] * 5, abs=1e-9)


def test_a_section_reaches_where_the_parts_do() -> None:
    """At crank angle 0 disc 1 has its valley on +x and touches tooth 0, but for its offset."""
    design = Design.from_mapping(
        {
            "reducer": {
                "ratio": 10,
                "ring_pitch_radius": "32 mm",
                "eccentricity": "1.6 mm",
                "ring_pin_diameter": "7 mm",
                "output_pins": {"count": 5, "circle_radius": "19.5 mm"},
                "ring": {"outer_diameter": "72 mm"},
            }
        }
    )
    outlines = Outlines.from_design(design, find_bearing("6902"))
    apex = design.reducer.ring_pitch_radius - 0.5 * design.reducer.ring_pin_diameter
    gap = design.reducer.modification.equidistant
    assert reach_along_x(outlines.posed_disc(0, 0.0).outer) == pytest.approx(apex - gap, abs=1e-8)
    assert reach_along_x(outlines.posed_disc(1, 0.0).outer) == pytest.approx(apex - gap, abs=3e-6)
    assert reach_along_x(outlines.ring.holes[0]) == pytest.approx(apex, abs=1e-8)
