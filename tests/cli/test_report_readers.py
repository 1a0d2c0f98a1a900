"""Report and torque page for every reader: desk and phone, in the dark, by ear, by the keys."""

from __future__ import annotations

import dataclasses
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from page_readers import axe_source, read
from report_browser import findings
from shared_outputs import paper_bench, paper_input

import cqdd_design as cq
from cqdd_design.machine.contact_analysis import analyse_contact
from cqdd_design.report import build_report
from cqdd_design.report.torque.page import torque_page
from cqdd_design.torque.data.episodes import DataSet, Episode
from cqdd_design.torque.evaluation.behaviour import Effort
from cqdd_design.torque.evaluation.estimator import Estimator
from cqdd_design.torque.evaluation.evaluate import evaluate

pytestmark = pytest.mark.deep

#: What shares a unit is converted together, what counts pieces is not.
UNITS = {
    "1270 N/5115.4 N = 0.248 at 120 N\u00b7m": "285.5 lbf/1150 lbf = 0.248 at 1062 lbf\u00b7in",
    "8 of 1.5 mm \u00d7 4 mm": "8 of 0.05906 in \u00d7 0.1575 in",
    "124 of 597 MPa": "17.98 of 86.59 ksi",
    "0.85 \u00d7 32 mm \u00d7 sin(180\u00b0/11)": "0.85 \u00d7 1.26 in \u00d7 sin(180\u00b0/11)",
    "0.9 \u00d7 10.5641 mm = 9.5077 mm": "0.9 \u00d7 0.415909 in = 0.37432 in",
    "6 M4 of 12.9, 8 mm deep": "6 M4 of 12.9, 0.315 in deep",
    "14 needles 2 \u00d7 18.8 mm": "14 needles 0.07874 \u00d7 0.7402 in",
    "NdFeB N35H 4 \u00d7 2 mm": "NdFeB N35H 0.1575 \u00d7 0.07874 in",
    "0.12 to 0.19 N m": "1.062 to 1.682 lbf\u00b7in",
    "1 \u00d7 10\u207b\u2075 N\u00b7m": "8.851\u202f\u00d7\u202f10\u207b\u2075\u202flbf\u00b7in",
    "2 of 4 mm": "2 of 0.1575 in",
    "magnet 6 x 2.5 mm": "magnet 0.2362 x 0.09843 in",
    "M2.5 \u00d7 6 mm": "M2.5 \u00d7 0.2362 in",
    "2 \u00d7 8 mm": "2 \u00d7 0.315 in",
    "\u2300 72 \u00d7 16.5 mm": "\u2300 2.835 \u00d7 0.6496 in",
    "15 \u00d7 28 \u00d7 7 mm": "0.5906 \u00d7 1.102 \u00d7 0.2756 in",
    "\u22126.0 to 75.2 MPa": "\u22120.8702 to 10.91 ksi",
    "1.2 N\u00b7m/rad, 5 mm\u207b\u00b9": "10.62 lbf\u00b7in/rad, 5 mm\u207b\u00b9",
    "40 \u00b0C": "104 \u00b0F",
    "4.5 mN\u00b7m": "0.6373 ozf\u00b7in",
    "12.88 g\u00b7mm": "0.01789 oz\u00b7in",
    "5.29 kg\u00b7cm\u00b2": "1.808 lb\u00b7in\u00b2",
    "5 \u00b10.3 N\u00b7m": "44.25 \u00b12.655 lbf\u00b7in",
    "3 N\u00b7m (\u00b11.5 N\u00b7m)": "26.55 lbf\u00b7in (\u00b113.28 lbf\u00b7in)",
    "40 \u00b110 \u00b0C": "104 \u00b118 \u00b0F",
    "0.88 K/W, 1.7 nm/N": "0.88 K/W, 1.7 nm/N",
}

#: Tables whose unit stands in a head, in a row or in a column of its own: in SI, and converted.
TABLES = (
    (
        (("Part", "Room, mm", "Heat, \u00b0C", "input, 10\u207b\u2076 kg\u00b7m\u00b2", "g each"),
         ("disc", "0.33 to 1.09", "40", "1.74", "110.9"),
         ("ring", "+0.05 / \u22120.05", "\u2013", "0", "28.35*")),
        (("Part", "Room, in", "Heat, \u00b0F", "input, lb\u00b7in\u00b2", "oz each"),
         ("disc", "0.01299 to 0.04291", "104", "0.005946", "3.912"),
         ("ring", "+0.001969 / \u22120.001969", "\u2013", "0", "1*")),
    ),
    (
        (("Quantity", "Mean", "Limit"), ("ring force, N", "1926", "\u2264 2000"),
         ("backlash, arcmin", "2.418", ""), ("ripple, N\u00b7m", "1.5", "")),
        (("Quantity", "Mean", "Limit"), ("ring force, lbf", "433", "\u2264 449.6"),
         ("backlash, arcmin", "2.418", ""), ("ripple, lbf\u00b7in", "13.28", "")),
    ),
    (
        (("Measurement", "Here", "Spread", "Unit", "Off by"),
         ("torque", "21.87", "\u00b10.25", "N\u00b7m", "\u221242\u202f%"),
         ("temperature", "40", "\u00b110", "\u00b0C", "\u2013"),
         ("bandwidth", "60", "<0.1\u202f%", "Hz", "\u2013")),
        (("Measurement", "Here", "Spread", "Unit", "Off by"),
         ("torque", "193.6", "\u00b12.213", "lbf\u00b7in", "\u221242\u202f%"),
         ("temperature", "104", "\u00b118", "\u00b0F", "\u2013"),
         ("bandwidth", "60", "<0.1\u202f%", "Hz", "\u2013")),
    ),
)  # fmt: skip

#: Lists whose numbers share a unit that is said once, at the end.
_MIXED = re.compile(
    r"\d of \d+, [^;\n]*\u00b0C|\d \([a-z ]+\) and .\d|each of [\d.]+,"
    r"|\d and [\d.]+\s(?:mm|\u00b0C)"
)

#: Units there and back, the contents, and what the keyboard reaches.
_USED = """
  var page = frame.contentDocument, view = frame.contentWindow;
  function shown() { return page.querySelector(".page").innerText; }
  function choose(name, value) {
    page.querySelector("input[name='" + name + "'][value='" + value + "']").click();
  }
  function columns(id) {
    return Array.prototype.map.call(page.querySelectorAll("#" + id + " tr"), function (row) {
      return Array.prototype.map.call(row.children, function (c) { return c.textContent; }); });
  }
  page.querySelector(".page").insertAdjacentHTML("beforeend", EXAMPLES);
  function examples() { return [0, 1, 2].map(function (k) { return columns("example-" + k); }); }
  var si = shown(), seats = columns("bom"), named = examples();
  choose("units", "us");
  var us = shown(), converted = columns("bom"), renamed = examples();
  var drawn = page.querySelector("#front-view").textContent;
  choose("units", "si");
  var again = shown();
  var button = page.getElementById("contents-button"), list = page.getElementById("contents-list");
  var bar = view.getComputedStyle(button.parentNode).display;
  var before = view.getComputedStyle(list).display;
  if (bar !== "none") { button.click(); }
  var after = view.getComputedStyle(list).display;
  var expanded = button.getAttribute("aria-expanded");
  var link = list.querySelector("a[href='#checks']");
  link.click();
  page.documentElement.style.scrollBehavior = "auto";
  page.getElementById("checks").scrollIntoView();
  view.dispatchEvent(new view.Event("scroll"));
  var nav = page.getElementById("contents").getBoundingClientRect();
  var headings = Array.prototype.map.call(page.querySelectorAll("h1, h2, h3, h4"), function (h) {
    return Number(h.tagName[1]); });
  var told = CASES.map(view.cqddUnits);
  return { told: told, same: si === again, si: si, us: us, drawn: drawn, seats: seats,
    converted: converted, named: named, renamed: renamed, back: examples(),
    bar: bar, before: before, after: after, expanded: expanded,
    nav: [nav.top, nav.bottom, nav.height],
    current: (list.querySelector("[aria-current]") || {}).textContent, headings: headings,
    scrolled: Array.prototype.filter.call(page.querySelectorAll("figure, .scroll"),
      function (box) { return box.scrollWidth > box.clientWidth + 1 &&
        box.getAttribute("tabindex") !== "0"; }).length };
"""


@pytest.fixture(scope="module")
def readers(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """All chapters but tolerances and the solids."""
    results = paper_input()
    contact = analyse_contact(results.machine, angles=120)
    page = build_report(dataclasses.replace(results, contact=contact, bench=paper_bench()))
    cases = json.dumps([_thin(one) for one in UNITS])
    examples = "".join(_table(k, si) for k, (si, _) in enumerate(TABLES))
    used = _USED.replace("CASES", cases).replace("EXAMPLES", json.dumps(examples))
    return read(page, tmp_path_factory.mktemp("readers"), axe=axe_source(), more=used)


def _table(number: int, rows: tuple[tuple[str, ...], ...]) -> str:
    head, *body = ("".join(f"<td>{cell}</td>" for cell in row) for row in rows)
    lines = "".join(f"<tr>{row}</tr>" for row in body)
    return (
        f'<table id="example-{number}"><thead><tr>{head}</tr></thead><tbody>{lines}</tbody></table>'
    )


def _thin(text: str) -> str:
    """With thin spaces before units, as the report prints them."""
    return re.sub(r"(\d) (?=[A-Za-z\u00b0])(?!of|to|at|x )", "\\1\u202f", text)


def test_every_reader_can_read_it(readers: dict[str, Any]) -> None:
    """No text under 11 px, nothing wider than the screen, 4.5 to 1, and nothing serious by axe."""
    for screen, seen in readers.items():
        _legible(screen, seen)


def _legible(screen: str, seen: dict[str, Any]) -> None:
    assert seen["small"] == [], screen
    assert seen["pale"] == [], screen
    # Between phone and desktop the widest tables scroll in boxes of their own.
    assert seen["cut"] == [] or screen.startswith("800"), screen
    assert seen["overflow"] <= 0, screen
    serious = [v for v in seen.get("violations", ()) if v["impact"] in {"serious", "critical"}]
    assert serious == [], screen


def test_contents_are_at_hand_and_headings_in_order(readers: dict[str, Any]) -> None:
    for screen, seen in readers.items():
        used = seen["more"]
        narrow = not screen.startswith("1300")
        assert (used["bar"] != "none") == narrow
        assert used["before"] == ("none" if narrow else "block")
        assert used["after"] == "block"
        assert used["expanded"] == str(narrow).lower()
        # Far down the page the contents, or the bar that opens them, are still in sight.
        assert 0.0 <= used["nav"][0] < used["nav"][1] <= 900.0
        assert used["current"] == "Checks"
        assert used["headings"][0] == 1
        assert used["headings"].count(1) == 1
        steps = np.diff(used["headings"])
        assert steps.max() <= 1, "a level of headings is left out"
        assert used["scrolled"] == 0, "a scrolled box that no key reaches"


def test_units_go_to_inches_and_back(readers: dict[str, Any]) -> None:
    used = readers["1300 900 light"]["more"]
    assert used["same"]
    for words, told in zip(UNITS.values(), used["told"], strict=True):
        assert told == _thin(words)
    for k, (si, us) in enumerate(TABLES):
        assert used["named"][k] == used["back"][k] == [list(row) for row in si]
        assert used["renamed"][k] == [list(row) for row in us]
    assert "120\u202fN\u00b7m" in used["si"]
    assert "1062\u202flbf\u00b7in" in used["us"]
    assert "120\u202fN\u00b7m" not in used["us"]
    # A limit of 120 degC, and a ring of 72 x 16.5 mm with both of its sides.
    assert "248\u202f\u00b0F" in used["us"]
    assert "\u2300 2.835 \u00d7 0.6496\u202fin" in used["us"]
    assert "2 \u00d7 0.315\u202fin" in used["us"], "pieces are no length"
    assert "1.26\u202fin" in used["drawn"]
    assert _MIXED.findall(used["si"]) == [], "numbers that share a unit said once"
    for row, other in zip(used["seats"], used["converted"], strict=True):
        for cell, new in zip(row, other, strict=True):
            if cell.endswith("\u202fg") and cell.split("\u202f")[0].replace(".", "").isdigit():
                grams, ounces = float(cell.split("\u202f")[0]), float(new.split("\u202f")[0])
                assert ounces == pytest.approx(grams / 28.349523, rel=5e-3)


def test_a_result_in_a_notebook_is_seen_whole(tmp_path: Path) -> None:
    """Verdict and drawing in one look: a frame of one height cut the drawing in half."""
    sized = cq.size(10, peak_torque="30 N*m", quick=True)
    heights = """<script>window.addEventListener("load", function () { setTimeout(function () {
      var frame = document.querySelector("iframe");
      var page = frame.contentDocument, drawing = page.querySelector("figure");
      postFindings({ frame: frame.getBoundingClientRect().height, page: page.body.scrollHeight,
        drawing: drawing.getBoundingClientRect().bottom }); }, 200); });</script>"""
    shown = f"<html><head></head><body>{sized._repr_html_()}{heights}</body></html>"
    found = findings(shown, tmp_path, "--window-size=1000,800")
    assert found["drawing"] <= found["frame"] <= 1280.0
    assert found["page"] <= found["frame"] or found["frame"] == 1280.0


def test_nought_on_the_torque_page_has_no_sign() -> None:
    """A phase of -0.4 degrees was printed as minus nought."""
    page = torque_page(_evaluated())
    assert re.search(r"\u22120\.\d*[1-9]", page)
    assert re.search(r"\u22120(?:\.0+)?(?![\d.])", page) is None


def test_the_torque_page_can_be_read_too(tmp_path: Path) -> None:
    for screen, seen in read(torque_page(_evaluated()), tmp_path, axe=axe_source()).items():
        _legible(screen, seen)


def _evaluated() -> Any:
    """Three estimators with known errors on swings in closed form."""
    rng, step = np.random.default_rng(4), 0.005
    time = step * np.arange(1200)
    episodes = []
    for k in range(6):
        pulse = 5.0 + 0.3 * k
        position, velocity = np.sin(pulse * time), pulse * np.cos(pulse * time)
        torque = -0.2 * pulse**2 * position + 0.4 * np.sin(11.0 * position)
        columns = {"target": position, "position": position, "velocity": velocity}
        columns["torque"] = torque + 0.05 * rng.normal(size=len(time))
        episodes.append(Episode(f"e{k:02}", {"number": str(k)}, step, columns))
    pendulum = {"hanging_angle": 3.14159, "gravity": 9.80665, "viscous": 0.0}
    pendulum |= {"bar_inertia": 0.08, "bar_gravity_moment": 1.8}
    data = DataSet(tuple(episodes), 60.0, 2.0, (-90.0, 90.0), {"pendulum": pendulum})

    def known(name: str, noise: float, kind: str) -> Estimator:
        def estimate(episode: Episode) -> np.ndarray:
            own = np.random.default_rng([len(name), int(episode.group["number"])])
            return episode.columns["torque"] + noise * own.normal(size=len(episode))

        return Estimator(name, estimate, 7, 1, kind, "", needs=("torque",))

    models = [known("pva-gru", 0.5, "network"), known("mlp", 1.0, "network")]
    effort = Effort(draws=100, rollouts=0, drift_steps=0, timed=False)
    names = {"trajectory": tuple(one.name for one in episodes)}
    return evaluate(data, names, [*models, known("pd-law", 2.0, "baseline")], effort=effort)
