"""Report sections of the simulated actuator: figures and tables show what was computed."""

from __future__ import annotations

import dataclasses
import math
import re
from xml.etree import ElementTree

import numpy as np
import pytest
from shared_outputs import paper_bench, report_input
from shared_outputs import paper_input as shared_input

from cqdd_design.actuator.bench import BenchResult, Metric
from cqdd_design.actuator.bench.gear import ARCMIN, DIAL, DIAL_RADIUS, dead_zone
from cqdd_design.actuator.bench.metric import is_near
from cqdd_design.actuator.demands import demands
from cqdd_design.actuator.envelope import limit_curves
from cqdd_design.actuator.motor import iron_drag, resistance_at, torque_constant_at
from cqdd_design.actuator.operating import (
    DRIVER,
    HEAT,
    PEAK,
    VOLTAGE,
    envelope_torque,
    held_torque,
    judge,
    motor_torque,
    needed,
    output_torque,
    time_to_limit,
)
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.actuator.thermal import continuous_current, response, steady_state
from cqdd_design.catalog.paper import METRICS as PAPER
from cqdd_design.design import Design
from cqdd_design.machine import resolve
from cqdd_design.report import ReportInput, build_report
from cqdd_design.report.actuator.bench_charts import Response, bode, spectrum
from cqdd_design.report.actuator.bench_figures import efficiency_maps
from cqdd_design.report.actuator.bench_table import (
    bench_row,
    bench_view,
    comparison,
    off_by,
)
from cqdd_design.report.actuator.envelope import actuator_view, duration, sentence
from cqdd_design.report.actuator.parameter_rows import parameter_rows
from cqdd_design.report.ink.axes import Labels, linear_axis, log_axis, thinned
from cqdd_design.report.ink.svg import Figure, Words
from cqdd_design.roads.bench import measured_actuator

WORDS = Words("id", "title", "description", "caption")


@pytest.fixture(scope="module")
def paper_input() -> ReportInput:
    return shared_input()


@pytest.fixture(scope="module")
def design(paper_input: ReportInput) -> Design:
    return paper_input.design


@pytest.fixture(scope="module")
def found() -> tuple[ActuatorParameters, BenchResult]:
    return paper_bench()


@pytest.fixture(scope="module")
def actuator(found: tuple[ActuatorParameters, BenchResult]) -> ActuatorParameters:
    return found[0]


@pytest.fixture(scope="module")
def measured(found: tuple[ActuatorParameters, BenchResult]) -> BenchResult:
    return found[1]


@pytest.fixture(scope="module")
def page(paper_input: ReportInput, found: tuple[ActuatorParameters, BenchResult]) -> str:
    return page_of(paper_input, bench=found)


def page_of(
    results: ReportInput,
    *,
    bench: tuple[ActuatorParameters, BenchResult] | None = None,
    missing: str = "",
) -> str:
    return build_report(dataclasses.replace(results, bench=bench, bench_missing=missing))


def section(page: str, anchor: str) -> str:
    begin = page.index(f'<section id="{anchor}"')
    return page[begin : page.index("</section>", begin)]


def words_of(markup: str) -> str:
    plain = re.sub(r"<[^>]+>", " ", markup).replace("\u202f", " ").replace("&#39;", "'")
    return re.sub(r"\s+", " ", plain)


def tree(figure: Figure) -> ElementTree.Element:
    return ElementTree.fromstring(figure.render())


def classed(figure: Figure, tag: str, words: str) -> list[ElementTree.Element]:
    wanted = set(words.split())
    return [e for e in tree(figure).iter(tag) if wanted <= set(e.get("class", "").split())]


def number(element: ElementTree.Element, name: str) -> float:
    return float(element.get(name, "nan"))


def path_of(element: ElementTree.Element) -> np.ndarray:
    numbers = re.findall(r"-?\d+(?:\.\d+)?", element.get("d", ""))
    return np.array([float(v) for v in numbers]).reshape(-1, 2)


def metric_of(measured: BenchResult, name: str) -> Metric:
    return next(metric for metric in measured.metrics if metric.name == name)


# ------------------------------------------------------------------ operating points


def test_friction_is_taken_off_and_put_back(actuator: ActuatorParameters) -> None:
    rng = np.random.default_rng(2)
    speed, torque = rng.uniform(0.0, 25.0, 200), rng.uniform(0.0, 90.0, 200)
    shaft = motor_torque(actuator, torque, speed)
    assert output_torque(actuator, shaft, speed) == pytest.approx(torque, abs=1e-9)
    assert np.all(shaft > torque / abs(actuator.gear.ratio))


def test_inside_and_outside_agree_with_the_motor_s_circuit(actuator: ActuatorParameters) -> None:
    rng = np.random.default_rng(5)
    n, thermal = abs(actuator.gear.ratio), actuator.thermal
    seen = set()
    for torque, speed, hot in zip(
        rng.uniform(-90.0, 90.0, 300), rng.uniform(0.0, 32.0, 300), rng.random(300) < 0.5,
        strict=True,
    ):  # fmt: skip
        found = judge(actuator, float(torque), float(speed), lasting=False, hot=bool(hot))
        temperature = thermal.most if hot else thermal.ambient
        current = (found.need.motor_torque + float(iron_drag(actuator.motor, n * speed))) / float(
            torque_constant_at(actuator.motor, temperature)
        )
        volts = float(resistance_at(actuator.motor, temperature)) * current
        volts += float(torque_constant_at(actuator.motor, temperature)) * n * speed
        inside = (
            abs(current) <= actuator.drive.current_limit
            and abs(volts) <= actuator.drive.supply_voltage
        )
        assert inside == (not {DRIVER, VOLTAGE} & set(found.binding))
        if torque > 0.0 and PEAK not in found.binding:
            assert found.inside == (torque <= found.most * (1.0 + 1e-9))
        seen.add(found.binding)
    assert {(), (DRIVER,), (VOLTAGE,)} <= seen


def test_the_most_torque_is_where_a_limit_begins_to_bind(actuator: ActuatorParameters) -> None:
    for speed in (0.0, 2.0, 13.0, 26.0):
        for lasting in (False, True):
            most = judge(actuator, 1.0, speed, lasting=lasting, hot=True).most
            assert judge(actuator, 0.9999 * most, speed, lasting=lasting, hot=True).inside
            assert not judge(actuator, 1.001 * most, speed, lasting=lasting, hot=True).inside


def test_a_weak_motor_binds_before_its_driver(actuator: ActuatorParameters) -> None:
    weak = dataclasses.replace(actuator, motor=dataclasses.replace(actuator.motor, peak_torque=4.0))
    found = judge(weak, 40.0, 5.0, lasting=False, hot=False)
    assert found.binding == (PEAK,)
    assert found.most == pytest.approx(float(output_torque(weak, 4.0, 5.0)))


def test_the_envelope_is_what_the_bench_measures(
    actuator: ActuatorParameters, measured: BenchResult
) -> None:
    """The bench simulates; the figure computes.

    A locked motor creeps in jumps, in which Stribeck's friction is less than at rest.
    """
    stalled = metric_of(measured, "stall_torque").value
    assert float(envelope_torque(actuator, 0.0, 25.0)[0]) == pytest.approx(stalled, rel=0.015)
    assert float(envelope_torque(actuator, 0.0, 25.0)[0]) < stalled
    forever = metric_of(measured, "continuous_torque").value
    assert float(held_torque(actuator, 0.0)[0]) == pytest.approx(forever, rel=0.015)


def test_held_torque_heats_the_winding_to_its_limit(actuator: ActuatorParameters) -> None:
    motor, thermal = actuator.motor, actuator.thermal
    for speed in (0.0, 4.0, 15.0):
        for seconds in (10.0, 60.0, math.inf):
            torque = float(held_torque(actuator, speed, seconds)[0])
            need = needed(actuator, torque, speed, thermal.most)
            if math.isinf(seconds):
                winding, _ = steady_state(motor, thermal, need.current, need.heat)
            else:
                winding = response(motor, thermal, need.current, [seconds], housing_heat=need.heat)[
                    0, 0
                ]
                lasts = time_to_limit(actuator, need.current, need.heat)
                assert lasts == pytest.approx(seconds, rel=1e-3)
            assert winding == pytest.approx(thermal.most, abs=0.01)
    still = continuous_current(motor, thermal)
    at_rest = needed(actuator, float(held_torque(actuator, 0.0)[0]), 0.0, thermal.most)
    assert at_rest.current == pytest.approx(still, rel=1e-6)


def test_shorter_overloads_allow_more_and_friction_takes_from_speed(
    actuator: ActuatorParameters,
) -> None:
    speed = np.array([1.0, 5.0, 10.0, 20.0])
    ten, minute, ever = (held_torque(actuator, speed, s) for s in (10.0, 60.0, math.inf))
    assert np.all(ten > minute)
    assert np.all(minute > ever)
    assert np.all(np.diff(ever) < 0.0)
    assert np.all(held_torque(actuator, speed, 1e9) == pytest.approx(ever, rel=1e-6))


# ------------------------------------------------------------------ envelope in the page


def test_curves_stay_within_voltage_driver_and_each_other(actuator: ActuatorParameters) -> None:
    found = limit_curves(actuator, 31.0)
    assert [curve.temperature for curve in found[:2]] == [25.0, actuator.thermal.most]
    curves = {curve.seconds: curve for curve in found[2:]}
    assert set(curves) == {math.inf, 60.0, 10.0}
    for curve in found:
        assert np.all(curve.torque >= 0.0)
        assert curve.torque[-1] == pytest.approx(0.0, abs=1e-9)
    for curve in curves.values():
        # Each ends where it meets zero, in which it is cut between two speeds.
        bound = np.maximum(
            envelope_torque(actuator, curve.speed, 25.0),
            envelope_torque(actuator, curve.speed, actuator.thermal.most),
        )
        assert np.all(curve.torque[:-1] <= bound[:-1] + 1e-9)


def test_a_heat_line_that_never_binds_is_left_out(actuator: ActuatorParameters) -> None:
    cool = dataclasses.replace(actuator.thermal, winding_to_housing=1e-3, housing_to_ambient=1e-3)
    curves = limit_curves(dataclasses.replace(actuator, thermal=cool), 31.0)
    assert all(math.isnan(curve.seconds) for curve in curves)
    assert len(curves) == 2


def test_points_of_the_requirements_are_judged_and_told(
    actuator: ActuatorParameters, design: Design
) -> None:
    points = {point.name: point for point in demands(actuator, design.requirements)}
    assert set(points) == {"peak torque", "continuous torque"}
    peak, ever = points["peak torque"], points["continuous torque"]
    assert peak.found.binding == (DRIVER, PEAK)
    assert "the driver's current and the motor's peak torque bind" in sentence(actuator, peak)
    assert peak.speed == 0.0
    assert ever.found.binding == (HEAT,)
    assert "heat binds" in sentence(actuator, ever)
    assert duration(ever.found.lasts) in sentence(actuator, ever)
    assert ever.speed * abs(actuator.gear.ratio) == pytest.approx(design.requirements.input_speed)
    easy = design.requirements.model_copy(update={"peak_torque": 30.0, "continuous_torque": 5.0})
    assert all(point.found.inside for point in demands(actuator, easy))
    assert all("inside" in sentence(actuator, point) for point in demands(actuator, easy))


def test_every_step_of_the_duty_is_a_point_and_its_heat_is_told(
    actuator: ActuatorParameters, measured: BenchResult, design: Design
) -> None:
    mapping = design.to_mapping()
    mapping["requirements"]["duty"] = [
        {"torque": "20 N*m", "speed": "5 rad/s", "share": 0.5},
        {"torque": "-15 N*m", "speed": "8 rad/s", "share": 0.5},
    ]
    asked = Design.from_mapping(mapping).requirements
    view = actuator_view(actuator, measured, asked)
    # Of the continuous torque a duty asks nothing.
    assert view["points"][0][0].name == "peak torque"
    steps = [point for point, _ in view["points"][1:]]
    assert [point.name for point in steps] == ["duty 1", "duty 2"]
    assert [point.generating for point in steps] == [False, True]
    currents = [point.found.need.current for point in steps]
    assert currents[0] > abs(currents[1]), "friction helps where the output drives"
    mean = math.sqrt(0.5 * currents[0] ** 2 + 0.5 * currents[1] ** 2)
    assert f"{mean:.3g}" in view["duty"]
    assert "within its limit" in view["duty"]
    assert len(classed(view["envelope"], "circle", "dot")) == 3


def test_the_speed_of_the_peak_torque_is_a_point_of_its_own(
    actuator: ActuatorParameters, measured: BenchResult, design: Design
) -> None:
    none = actuator_view(actuator, measured, design.requirements)["envelope"]
    assert "the requirements name no speed for the peak torque" in none.caption
    asked = design.requirements.model_copy(update={"speed_at_peak": 3.0})
    view = actuator_view(actuator, measured, asked)
    names = [point.name for point, _ in view["points"]]
    assert names == ["peak torque", "peak torque at its speed", "continuous torque"]
    point, told = view["points"][1]
    assert (point.torque, point.speed) == (asked.peak_torque, 3.0)
    assert "120\u202fN\u00b7m at 28.65\u202frpm" in told
    assert "no speed for the peak torque" not in view["envelope"].caption
    assert len(classed(view["envelope"], "circle", "dot")) == 3


def test_dots_stand_at_their_points(
    actuator: ActuatorParameters, measured: BenchResult, design: Design
) -> None:
    view = actuator_view(actuator, measured, design.requirements)
    dots = classed(view["envelope"], "circle", "dot")
    grid = classed(view["envelope"], "line", "grid")
    ticks = [e for e in classed(view["envelope"], "text", "tick") if e.get("text-anchor") == "end"]
    level = {float(t.text or "nan"): number(g, "y1") for g, t in zip(grid, ticks, strict=True)}
    scale = (level[40.0] - level[0.0]) / 40.0
    for dot, (point, _) in zip(dots, view["points"], strict=True):
        assert number(dot, "cy") == pytest.approx(level[0.0] + scale * point.torque, abs=0.1)
        assert ("inside" in dot.get("class", "")) == point.found.inside


# ------------------------------------------------------------------ building blocks


def test_axes() -> None:
    axis = log_axis(1.0, 100.0, "x")
    assert axis.share(10.0) == pytest.approx(0.5)
    assert axis.ticks == (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)
    assert linear_axis(-3.0, 7.0, "x").share(-4.0) == 0.0
    assert linear_axis(0.0, 7.3, "x", tight=True).share(7.3) == 1.0


def test_labels_keep_clear_of_each_other() -> None:
    labels = Labels(0.0, 0.0, 400.0, 300.0)
    drawn = [labels.place((200.0, 150.0), "twelve signs") for _ in range(6)]
    places = [(float(e.get("x", "nan")), float(e.get("y", "nan"))) for e in map(
        ElementTree.fromstring, drawn
    )]  # fmt: skip
    for i, (x, y) in enumerate(places):
        for other in places[i + 1 :]:
            assert abs(x - other[0]) > 70.0 or abs(y - other[1]) > 11.0


def test_thinning_keeps_extremes_and_ends() -> None:
    x = np.linspace(0.0, 1.0, 20_000)
    y = np.sin(900.0 * x)
    y[7777] = 5.0
    kept_x, kept_y = thinned(x, y, 100)
    assert len(kept_x) <= 2 * 100 + 2
    assert kept_y.max() == 5.0
    assert (kept_x[0], kept_x[-1]) == (0.0, 1.0)
    assert np.all(np.diff(kept_x) > 0.0)


def test_crossings_of_a_bode_plot_lie_on_its_curves() -> None:
    """First order with 8 Hz: -3 dB there, -45 degrees, -90 nowhere."""
    f = np.geomspace(0.5, 200.0, 300)
    h = 1.0 / (1.0 + 1j * f / 8.0)
    figure = bode(WORDS, Response(f, np.abs(h), np.angle(h), edge=8.0, quarter=None))
    (dot,) = classed(figure, "circle", "dot")
    curve = path_of(classed(figure, "path", "curve series-1")[0])
    y = np.interp(number(dot, "cx"), curve[:, 0], curve[:, 1])
    assert number(dot, "cy") == pytest.approx(y, abs=0.3)


def test_faint_begins_where_coherence_falls() -> None:
    f = np.geomspace(1.0, 100.0, 50)
    coherence = np.where(f < 20.0, 0.95, 0.3)
    figure = bode(WORDS, Response(f, np.ones(50), np.zeros(50), None, None, coherence))
    sure = path_of(classed(figure, "path", "curve series-1")[0])
    weak = path_of(classed(figure, "path", "curve weak")[0])
    assert len(sure) == np.sum(f < 20.0)
    assert weak[0] == pytest.approx(sure[-1])


def test_bars_of_a_spectrum_are_in_proportion() -> None:
    order = np.arange(1.0, 61.0)
    amplitude = np.zeros(60)
    amplitude[[9, 21, 43]] = 2.0, 4.0, 1.0
    figure = spectrum(WORDS, order, amplitude, [22, 10], "y")
    bars = classed(figure, "line", "order-bar")
    tall = [number(e, "y1") - number(e, "y2") for e in bars]
    assert tall == pytest.approx([tall[1] / 2.0, tall[1], tall[1] / 4.0], abs=0.02)
    across = [number(e, "x1") for e in bars]
    assert (across[2] - across[1]) / (across[1] - across[0]) == pytest.approx(22 / 12, abs=0.01)


def test_of_bars_that_hide_each_other_the_tallest_is_drawn() -> None:
    """Two thousand orders on 356 px: every tall one is seen, at its place and height."""
    order = np.arange(1.0, 2001.0)
    amplitude = 1.0 + np.sin(order) ** 2
    amplitude[[499, 1499]] = 8.0, 6.0
    figure = spectrum(WORDS, order, amplitude, [500], "y")
    bars = classed(figure, "line", "order-bar")
    assert 600 < len(bars) < 750
    tall = sorted(number(e, "y1") - number(e, "y2") for e in bars)
    assert tall[-2] / tall[-1] == pytest.approx(6.0 / 8.0, abs=2e-3)
    across = np.array([number(e, "x1") for e in bars])
    assert np.diff(across).max() < 1.01
    heights = [number(e, "y1") - number(e, "y2") for e in bars]
    places = across[np.argsort(heights)[-2:]]
    least = across.min()
    assert (places[1] - least) / (places[0] - least) == pytest.approx(499 / 1499, abs=2e-3)
    # Of two or three orders side by side one is a half off a zero of the sine at least.
    assert min(heights) > (1.0 + math.sin(0.5) ** 2) / 8.0 * tall[-1]


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_the_dead_zone_of_a_drawn_loop_is_found(sense: float) -> None:
    """Motor to one flank, rest, and back through 7 arcmin; the output follows on the flanks."""
    half, threshold = 3.5 / ARCMIN, DIAL / DIAL_RADIUS
    reach = 12.0 / ARCMIN
    motor = np.r_[
        np.linspace(0.0, reach, 400), np.full(300, reach), np.linspace(reach, -reach, 4000)
    ]
    output = np.empty_like(motor)
    last = 0.0
    for k, angle in enumerate(motor):
        last = min(max(last, angle - half), angle + half)
        output[k] = last
    found = dead_zone(sense * motor, sense * output)
    assert found is not None
    assert sense * found[0] == pytest.approx(reach, abs=0.03 * reach)
    assert abs(found[1] - found[0]) * ARCMIN == pytest.approx(7.0, abs=0.3)
    assert abs(found[2]) == pytest.approx(reach - half, rel=1e-6)
    assert threshold * ARCMIN < 1.0
    assert dead_zone(motor, np.zeros_like(motor)) is None


# ------------------------------------------------------------------ figures of the bench


def test_figures_of_the_bench_show_its_numbers(
    actuator: ActuatorParameters, measured: BenchResult
) -> None:
    figures = {f.id: f for f in bench_view(actuator, measured, pin_count=5)["figures"]}
    assert list(figures) == [
        "torque-bode",
        "position-bode-45",
        "position-bode-5",
        "backlash-loop",
        "breakaway-trace",
        "backdrive-trace",
        "ripple-spectrum",
        "ripple-orders",
    ]
    for name, anchor in (
        ("torque_bandwidth", "torque-bode"),
        ("position_bandwidth_45deg", "position-bode-45"),
        ("position_bandwidth_5deg", "position-bode-5"),
    ):
        figure, metric = figures[anchor], metric_of(measured, name)
        if metric.known is None:
            assert "no measured frequency" in figure.caption
            continue
        dot = classed(figure, "circle", "dot")[0]
        # Gain comes first: its faint part, where there is one, and its sure one.
        parts = [path_of(e) for e in tree(figure).iter("path") if "curve" in e.get("class", "")]
        curve = np.vstack(parts[: 2 if anchor == "torque-bode" else 1])
        curve = curve[np.argsort(curve[:, 0], kind="stable")]
        y = np.interp(number(dot, "cx"), curve[:, 0], curve[:, 1])
        assert number(dot, "cy") == pytest.approx(y, abs=0.5), name
        labels = " ".join(e.text or "" for e in classed(figure, "text", "tick"))
        assert f"{metric.value:.3g} Hz" in labels
    limits = metric_of(measured, "position_bandwidth_45deg").details
    bound = " ".join(e.text or "" for e in classed(figures["position-bode-45"], "text", "tick"))
    for key in ("limit_by_speed_Hz", "limit_by_torque_Hz"):
        assert f"{limits[key]:.3g} Hz" in bound
    for told in ("60\u202fN·m/rad", "2\u202fN·m·s/rad", "24\u202fV"):
        assert told in figures["position-bode-5"].caption
    loop = metric_of(measured, "backlash")
    zone = dead_zone(*loop.trace.values())
    assert zone is not None
    assert abs(zone[1] - zone[0]) * ARCMIN == pytest.approx(loop.value, abs=0.4)
    widths = [number(e, "width") for e in classed(figures["ripple-orders"], "rect", "share-bar")]
    sizes = np.sort(metric_of(measured, "torque_ripple").trace["amplitude [N m]"])[::-1]
    assert widths[1] / widths[0] == pytest.approx(sizes[1] / sizes[0], rel=0.02)


def test_the_gain_of_torque_names_no_unit_that_a_switch_would_turn_in_one_place_alone(
    actuator: ActuatorParameters, measured: BenchResult
) -> None:
    figures = bench_view(actuator, measured, pin_count=5)["figures"]
    (caption,) = [one.caption for one in figures if "gain relative" in one.caption]
    assert re.search(r"gain relative to [01]\.\d+ of the torque asked at low", caption)


def test_cells_of_efficiency_are_those_measured(measured: BenchResult) -> None:
    grid = metric_of(measured, "efficiency_peak")
    torque, efficiency = grid.trace["torque [N m]"], grid.trace["efficiency"]
    figures = {figure.id: figure for figure in efficiency_maps(grid)}
    assert set(figures) == {"efficiency-driving", "efficiency-generating"}
    for name, chosen in (("driving", torque > 0.0), ("generating", torque < 0.0)):
        figure = figures[f"efficiency-{name}"]
        cells = classed(figure, "rect", "cell")
        assert len(cells) == np.sum(efficiency[chosen] > 0.0)
        shown = [e.text or "" for e in classed(figure, "text", "cell-text")]
        written = sorted(float(v) for v in shown if v != "\u2013")
        expected = np.sort(100.0 * efficiency[chosen & (efficiency > 0.0)])
        assert written == pytest.approx(expected, abs=0.0501)
        (framed,) = classed(figure, "rect", "peak-cell")
        texts = classed(figure, "text", "cell-text")
        inside = [
            e.text for e in texts
            if 0.0 < number(e, "x") - number(framed, "x") < number(framed, "width")
            and 0.0 < number(e, "y") - number(framed, "y") < number(framed, "height")
        ]  # fmt: skip
        assert inside == [f"{100.0 * efficiency[chosen].max():.1f}"]
    driving_only = {key: values[torque > 0.0] for key, values in grid.trace.items()}
    assert len(efficiency_maps(dataclasses.replace(grid, trace=driving_only))) == 1


# ------------------------------------------------------------------ tables


def test_the_table_stands_beside_the_paper_s(
    actuator: ActuatorParameters, measured: BenchResult
) -> None:
    view = bench_view(actuator, measured, pin_count=5)
    rows = {row["name"]: row for row in view["rows"]}
    assert set(PAPER) <= set(rows)
    assert rows["output_resolution"]["value"] == "0.002197"
    assert rows["output_resolution"]["off"] == "+0.3\u202f%"
    assert rows["backlash"]["paper"] == "7.03 ±1.3"
    assert rows["efficiency_peak"]["off"].endswith(" points")
    assert rows["efficiency_peak"]["paper"] == "82.3"
    assert rows["actuator_inertia"]["unit"] == "kg·cm²"
    assert rows["actuator_inertia"]["paper"] == "5.01"
    for row in view["rows"]:
        assert row["relation"] in dict(view["relations"])
        assert row["protocol"].endswith(".")
        assert (row["off"] == "\u2013") == (
            row["relation"] == "not comparable" or "\u2013" in (row["paper"], row["value"])
        )
    predicted = [m for m in measured.metrics if m.relation == "predicted" and m.known]
    near = [m for m in predicted if is_near(m.unit, m.value, PAPER[m.name].value)]
    assert f"Of {len(predicted)} predicted rows {len(near)} lie within" in view["summary"]


@pytest.mark.parametrize(
    ("name", "value", "paper", "shown"),
    [
        ("mass", 1.82, 1.4, "+30\u202f%"),
        ("no_load_speed", 126.6, 128.6, "\u22121.6\u202f%"),
        ("efficiency_peak", 0.773, 0.823, "\u22125.0 points"),
        ("rated_power", 960.0, 960.0, "0.0\u202f%"),
        ("backdrive_static", math.nan, 1.99, "\u2013"),
    ],
)
def test_how_far_off(name: str, value: float, paper: float, shown: str) -> None:
    assert off_by(Metric(name, value, "predicted", "p."), paper) == shown
    assert off_by(Metric(name, value, "not comparable", "p."), paper) == "\u2013"
    assert off_by(Metric(name, value, "predicted", "p."), None) == "\u2013"


def test_another_design_has_no_paper_beside_it(
    actuator: ActuatorParameters, measured: BenchResult, paper_input: ReportInput
) -> None:
    alone = dataclasses.replace(measured, beside_paper=False)
    view = bench_view(actuator, alone, pin_count=5)
    assert view["summary"] == ""
    assert all(row["paper"] == row["off"] == "\u2013" for row in view["rows"])
    bench = section(page_of(paper_input, bench=(actuator, alone)), "bench")
    assert ">Paper<" not in bench
    assert ">Off by<" not in bench
    # Nothing is measured that the values could agree with.
    assert ">Value is<" in bench
    assert "greement" not in bench
    assert "without looking at the measured value" not in bench


def test_a_gearbox_that_holds_itself_has_nothing_to_backdrive(
    actuator: ActuatorParameters, measured: BenchResult, design: Design
) -> None:
    stiff = dataclasses.replace(actuator.friction, load_backward=1.3)
    holding = dataclasses.replace(actuator, friction=stiff)
    view = bench_view(holding, measured, pin_count=5)
    assert {"breakaway-trace", "backdrive-trace"}.isdisjoint(
        figure.id for figure in view["figures"]
    )
    rows = {row["name"]: row for row in view["rows"]}
    for name in ("backdrive_static", "backdrive_dynamic"):
        assert (rows[name]["value"], rows[name]["off"]) == ("\u2013", "\u2013")
        assert "holds itself" in rows[name]["protocol"]
    seen = actuator_view(holding, measured, design.requirements)
    assert [figure.id for figure in seen["efficiency"]] == ["efficiency-driving"]
    assert "holds itself" in seen["lead"]


def test_the_comparison_has_this_design_and_the_misprint(
    actuator: ActuatorParameters, measured: BenchResult
) -> None:
    table = comparison(actuator, measured)
    assert measured.name in table["headings"][table["own"]]
    rows = dict(table["rows"])
    density = metric_of(measured, "peak_torque").value / actuator.mass
    assert float(rows["torque density, N·m/kg"][table["own"]]) == pytest.approx(density, rel=1e-3)
    assert any("83.96" in remark and "83.7" in remark for remark in table["remarks"])
    bare = dataclasses.replace(measured, metrics=measured.metrics[:1])
    assert comparison(actuator, bare)["own"] == -1


def test_every_parameter_is_listed_with_its_origin(actuator: ActuatorParameters) -> None:
    rows = {row.key: row for _, group in parameter_rows(actuator) for row in group}
    for part in ("motor", "drive", "thermal", "friction", "gear"):
        for field in dataclasses.fields(getattr(actuator, part)):
            # One row stands for orders, cosines and sines.
            series = field.name in ("error_orders", "error_sine", "stiffness_sine")
            assert series or f"{part}.{field.name}" in rows, field.name
    for key, row in rows.items():
        assert actuator.origins.get(key, "default").startswith(row.origin)
    assert rows["motor.torque_constant"].origin == "catalogue"
    assert rows["gear.backlash"].shown == f"{actuator.gear.backlash * ARCMIN:.4g}\u202farcmin"
    unknown = dataclasses.replace(actuator.motor, rated_torque=math.nan)
    bare = parameter_rows(dataclasses.replace(actuator, motor=unknown))
    assert any(row.shown == "not given" for _, group in bare for row in group)


# ------------------------------------------------------------------ the page


def test_the_page_has_both_sections_in_order(page: str) -> None:
    headings = re.findall(r"<h[23]>([^<]+)</h[23]>", section(page, "actuator"))
    assert headings == ["Actuator", "Efficiency"]
    headings = re.findall(r"<h[23]>([^<]+)</h[23]>", section(page, "bench"))
    assert headings == ["Virtual test bench", "Traces", "Beside other actuators"]
    anchors = re.findall(r'<a href="#([\w-]+)">', page[: page.index("</nav>")])
    assert anchors.index("actuator") + 1 == anchors.index("bench")
    assert anchors.index("bench") + 1 == anchors.index("edm")
    assert "<details" in section(page, "actuator")


def test_nothing_that_is_not_a_number_is_printed(page: str) -> None:
    for anchor in ("actuator", "bench"):
        markup = section(page, anchor)
        assert not re.search(r"\b(?:nan|NaN|None|inf|Infinity)\b|\u221e", words_of(markup)), anchor
        assert not re.search(r'="[^"]*\b(?:nan|inf)\b', markup), anchor


def test_every_measurement_has_its_row_and_protocol(
    page: str, actuator: ActuatorParameters, measured: BenchResult
) -> None:
    bench = section(page, "bench")
    rows = re.findall(r'<tbody data-metric="(\w+)">(.*?)</tbody>', bench, re.S)
    assert [name for name, _ in rows] == [metric.name for metric in measured.metrics]
    for _, row in rows:
        assert row.count("<tr") == 2
    for word, meaning in bench_view(actuator, measured, pin_count=5)["relations"]:
        assert word in words_of(bench)
        assert meaning in words_of(bench)


def test_the_same_input_gives_the_same_bytes(
    page: str, paper_input: ReportInput, found: tuple[ActuatorParameters, BenchResult]
) -> None:
    again = page_of(paper_input, bench=found)
    for anchor in ("actuator", "bench"):
        assert section(again, anchor) == section(page, anchor)


def test_without_a_bench_there_are_no_sections(paper_input: ReportInput) -> None:
    bare = page_of(paper_input)
    for anchor in ("actuator", "bench"):
        assert f'id="{anchor}"' not in bare
        assert f'href="#{anchor}"' not in bare


def test_a_motor_that_cannot_be_simulated_leaves_a_sentence(design: Design) -> None:
    mapping = design.to_mapping()
    mapping["motor"]["name"] = "VT8020"
    unknown = Design.from_mapping(mapping)
    found, missing = measured_actuator(resolve(unknown))
    assert found is None
    assert "the resistance of VT8020 is not known" in missing
    page = page_of(report_input(unknown), missing=missing)
    assert "the resistance of VT8020 is not known" in section(page, "actuator")
    assert 'href="#actuator"' in page
    assert 'href="#bench"' not in page
    assert 'id="bench"' not in page
    # What the gearbox's analysis and the verdict both warn of is told once.
    again = report_input(unknown)
    notes = (*again.notes, *again.gearbox.warnings)
    warned = build_report(dataclasses.replace(again, notes=notes))
    assert again.gearbox.warnings
    closing = words_of(section(warned, "assumptions"))
    assert closing.count("has no stator bore in the catalogue") == 1


def test_the_paper_is_spoken_of_beside_its_own_actuator_alone(
    found: tuple[ActuatorParameters, BenchResult],
) -> None:
    measured = found[1]
    for beside in (True, False):
        told = dataclasses.replace(measured, beside_paper=beside)
        rows = [bench_row(one, told) for one in measured.metrics]
        gains = [row for row in rows if row["relation"] == "not comparable"]
        assert gains
        assert all(("The paper gives no gains." in row["protocol"]) is beside for row in gains)
        assert all("*" not in row["protocol"] for row in rows)


def test_cogging_is_called_so_among_the_orders_of_the_ripple(page: str) -> None:
    assert "2520: cogging 1" in page
    assert "crank and ring teeth 252" not in page
