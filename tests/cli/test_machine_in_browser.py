"""The model of the machine in a real Chromium: it draws, comes apart, is cut, and obeys the law."""

from __future__ import annotations

import importlib.util
import math
from pathlib import Path
from typing import Any

import pytest
from report_browser import clipped, findings, overlapping

from cqdd_design.design import Design, load_design
from cqdd_design.machine import resolve
from cqdd_design.report.ink.page import environment
from cqdd_design.report.ink.svg import Figure
from cqdd_design.report.machine_view import MachineViews, hidden_line_views, viewer_data
from cqdd_design.report.machine_view.packing import machine_values
from cqdd_design.solids.part import Part
from cqdd_design.solids.poses import body_pose

pytestmark = [
    pytest.mark.deep,
    pytest.mark.skipif(
        importlib.util.find_spec("cadquery") is None, reason="cadquery is not installed"
    ),
]

CRANK = 2.0
#: Without a graphics card Chromium draws in software, if it is told that this is safe.
WEBGL = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
NO_WEBGL = "--disable-3d-apis"
_COLLECTOR = """<script>
window.probeErrors = [];
window.addEventListener("error", function (e) { window.probeErrors.push(e.message); });
window.addEventListener("unhandledrejection", function (e) {
  window.probeErrors.push(String(e.reason)); });
</script>"""
_PROBE = """<script>
(function () {
  function colours() {
    var canvas = document.querySelector("#machine-stage canvas");
    var copy = document.createElement("canvas"), seen = {};
    copy.width = canvas.width; copy.height = canvas.height;
    var context = copy.getContext("2d");
    context.drawImage(canvas, 0, 0);
    var data = context.getImageData(0, 0, copy.width, copy.height).data, drawn = 0, sum = 0;
    for (var i = 0; i < data.length; i += 4) {
      if (data[i + 3] > 0) {
        drawn += 1;
        seen[data[i] + "," + data[i + 1] + "," + data[i + 2]] = 1;
      }
      sum = (sum * 31 + data[i] + 7 * data[i + 1] + 13 * data[i + 3]) % 1000000007;
    }
    return { share: 4 * drawn / data.length, colours: Object.keys(seen).length, sum: sum };
  }
  function slide(id, value) {
    var slider = document.getElementById(id);
    slider.value = value;
    slider.dispatchEvent(new Event("input", { bubbles: true }));
  }
  function texts(figure) {
    var svg = figure.querySelector("svg"), box = svg.getBoundingClientRect();
    return { id: figure.id, left: box.left, right: box.right, top: box.top, bottom: box.bottom,
      texts: Array.prototype.map.call(svg.querySelectorAll("text"), function (text) {
        var at = text.getBoundingClientRect();
        return { text: text.textContent, left: at.left, right: at.right, top: at.top,
          bottom: at.bottom };
      }) };
  }
  // The page starts the view when its stage comes into sight; observers are told in their order.
  var begun = false;
  new IntersectionObserver(function (entries) {
    begun = begun || entries.some(function (entry) { return entry.isIntersecting; });
  }, { rootMargin: "200px" }).observe(document.getElementById("machine-stage"));
  var timer = setInterval(function () {
    var view = document.getElementById("machine-view");
    if (!begun || (!window.cqddMachineHandle && !view.hasAttribute("data-failed"))) {
      return;
    }
    clearInterval(timer);
    var found = { failed: view.getAttribute("data-failed"), poster: getComputedStyle(
      document.getElementById("machine-poster")).display };
    found.figures = Array.prototype.map.call(document.querySelectorAll("figure"), texts);
    if (window.cqddMachineHandle) {
      // A canvas can be read in the very task that drew it, not later.
      slide("machine-crank", 0);
      found.start = colours();
      slide("machine-crank", CRANK_DEG);
      found.turned = colours();
      found.state = cqddMachineHandle.state();
      found.shown = document.getElementById("machine-crank-shown").textContent;
      slide("machine-explode", 1);
      found.apart = colours();
      found.moved = cqddMachineHandle.state();
      slide("machine-explode", 0);
      slide("machine-section-cut", 0.5);
      found.cut = colours();
    }
    found.errors = window.probeErrors;
    postFindings(found);
  }, 100);
}());
</script>"""


@pytest.fixture(scope="module")
def machine(paper_design_file: Path) -> tuple[Design, tuple[Part, ...]]:
    design = load_design(paper_design_file)
    return design, resolve(design).parts


@pytest.fixture
def page(machine: tuple[Design, tuple[Part, ...]]) -> str:
    return page_of(hidden_line_views(*machine), machine)


def page_of(views: MachineViews, machine: tuple[Design, tuple[Part, ...]]) -> str:
    fragment = (
        environment()
        .get_template("machine3d.html")
        .render(machine_values(views, viewer_data(*machine)))
    )
    style = environment().get_template("style.css").render()
    probe = _PROBE.replace("CRANK_DEG", f"{math.degrees(CRANK):.12f}")
    # The slider of a page steps by whole degrees; the probe asks for any angle.
    assert 'step="1" value="0"' in fragment
    fragment = fragment.replace('step="1" value="0"', 'step="any" value="0"', 1)
    return (
        f'<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>machine</title>'
        f"{_COLLECTOR}<style>{style}</style></head><body><div class='page'>{fragment}</div>"
        f"{probe}</body></html>"
    )


def seen_by(page: str, folder: Path, *flags: str) -> dict[str, Any]:
    return findings(page, folder, *flags, "--window-size=1100,900")


def test_the_model_draws_turns_comes_apart_and_is_cut(
    page: str, machine: tuple[Design, tuple[Part, ...]], tmp_path: Path
) -> None:
    seen = seen_by(page, tmp_path, *WEBGL)
    assert seen["failed"] is None
    assert seen["errors"] == []
    assert seen["console"] == []
    assert seen["poster"] == "none"
    assert seen["start"]["colours"] > 200
    assert 0.1 < seen["start"]["share"] < 0.9

    # Every control changes the picture, and the cut takes some of it away.
    assert len({seen[state]["sum"] for state in ("start", "turned", "apart", "cut")}) == 4
    assert seen["cut"]["share"] < seen["start"]["share"]
    assert seen["shown"].startswith("115\u00b0")

    # Every piece stands where the package puts it.
    design, parts = machine
    pieces = {piece.name: piece for part in parts for piece in part.instances}
    shown = {piece["name"]: piece for piece in seen["state"]["pieces"]}
    assert set(shown) == set(pieces)
    for name, piece in pieces.items():
        pose = body_pose(design, piece.body, CRANK)
        assert shown[name]["at"][:2] == pytest.approx(pose[:2, 3].tolist(), abs=1e-9)
        angle = shown[name]["angle"]
        assert [math.cos(angle), math.sin(angle)] == pytest.approx(pose[:2, 0].tolist(), abs=1e-9)
    heights = [piece["at"][2] for piece in seen["moved"]["pieces"]]
    assert max(heights) - min(heights) > 0.1

    # Labels of the still pictures stand clear.
    assert {figure["id"] for figure in seen["figures"]} == {"machine-section", "machine-exploded"}
    for figure in seen["figures"]:
        assert overlapping(figure) == [], figure["id"]
        assert clipped(figure) == [], figure["id"]


def test_the_poster_stays_where_webgl_is_missing(
    machine: tuple[Design, tuple[Part, ...]], tmp_path: Path
) -> None:
    blank = Figure("machine-blank", "blank", "nothing", 10.0, 10.0, "<path d='M0 0h9v9'/>")
    found = seen_by(page_of(MachineViews(blank, blank, blank), machine), tmp_path, NO_WEBGL)
    assert found["failed"] == "no WebGL"
    assert found["poster"] == "flex"
    assert found["errors"] == []
    assert "start" not in found
