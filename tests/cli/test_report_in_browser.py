"""The report in a real Chromium: no error, every figure drawn, the mesh turns, it prints."""

from __future__ import annotations

import dataclasses
import math
import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from report_browser import browser, clipped, overlapping, probe
from shared_outputs import paper_input, report_input, sized

from cqdd_design.design import Design, load_design
from cqdd_design.errors import DependencyError
from cqdd_design.gearbox.loads import rigid_series
from cqdd_design.gearbox.stages import Stages
from cqdd_design.report import build_report
from cqdd_design.report.printing import printed_page

FIGURES = {
    "front-view",
    "section-view",
    "mesh",
    "ring-force-chart",
    "pin-force-chart",
    "cam-load-chart",
    "pressure-chart",
}
#: Where the evidence is there: a disc that can be meshed, losses that have an equilibrium.
OF_EVIDENCE = {"disc-stress", "warming"}
SLID = 100.0

#: Designs unlike the paper's: three discs and sleeves; one disc on cantilevers; thin and many.
OTHERS: dict[str, dict[str, Any]] = {
    "three discs, sleeves, conjugate ring": {
        "reducer": {
            "ratio": 7,
            "ring_pitch_radius": "34 mm",
            "eccentricity": "2.2 mm",
            "ring_pin_diameter": "9 mm",
            "ring_type": "conjugate",
            "disc_count": 3,
            "disc_thickness": "6 mm",
            "output_pins": {
                "count": 6,
                "diameter": "4 mm",
                "sleeve_diameter": "5.5 mm",
                "circle_radius": "21 mm",
            },
            "cam_bearing": {"designation": "6803"},
            "ring": {"outer_diameter": "82 mm"},
        },
    },
    "one disc, cantilever pins, pinwheel": {
        "reducer": {
            "ratio": 12,
            "ring_pitch_radius": "30 mm",
            "eccentricity": "1.2 mm",
            "ring_pin_diameter": "6 mm",
            "ring_type": "pinwheel",
            "disc_count": 1,
            "disc_thickness": "7 mm",
            "output_pins": {"count": 8, "support": "cantilever", "circle_radius": "19 mm"},
            "cam_bearing": {"designation": "6902"},
            "ring": {"outer_diameter": "72 mm"},
        },
    },
    "ratio 40": {
        "reducer": {
            "ratio": 40,
            "ring_pitch_radius": "50 mm",
            "eccentricity": "0.8 mm",
            "ring_pin_diameter": "5 mm",
            "output_pins": {"count": 16, "circle_radius": "34 mm"},
            "cam_bearing": {"designation": "needle cage K25x29x10"},
            "ring": {"outer_diameter": "112 mm"},
        },
    },
}


@pytest.fixture(scope="module")
def paper_page() -> str:
    return build_report(paper_input())


@pytest.fixture(scope="module")
def seen(paper_page: str, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    return probe(paper_page, tmp_path_factory.mktemp("browser"), angle=SLID)


def test_no_error_and_nothing_on_the_console(seen: dict[str, Any]) -> None:
    assert seen["errors"] == []
    assert seen["console"] == []


def test_the_probe_would_see_an_error(paper_page: str, tmp_path: Path) -> None:
    broken = paper_page.replace('"lobe_count": 10', '"lobe_count": oops')
    assert broken != paper_page
    found = probe(broken, tmp_path)
    assert found["errors"]
    assert found["console"]


def test_every_figure_is_drawn(seen: dict[str, Any]) -> None:
    figures = {figure["id"]: figure for figure in seen["figures"]}
    assert set(figures) == FIGURES | OF_EVIDENCE | {"inertia-chart"}
    for name, figure in figures.items():
        assert figure["drawn"] >= 6, f"{name} is empty"
        assert figure["width"] > 300, name
        assert figure["height"] > 150, name
        assert figure["title"], f"{name} has no title"
        assert figure["labelled"], f"{name} points at a label that is missing"


def test_bars_of_the_margins_are_shown(seen: dict[str, Any]) -> None:
    assert seen["bars"] > 40
    assert seen["hiddenBars"] == 0


def test_labels_stand_clear_of_each_other(seen: dict[str, Any]) -> None:
    for figure in seen["figures"]:
        assert overlapping(figure) == [], figure["id"]
        assert clipped(figure) == [], figure["id"]


def test_links_and_width(seen: dict[str, Any], paper_page: str, tmp_path: Path) -> None:
    assert seen["outside"] == [], "links to places that do not exist"
    assert seen["overflow"] <= 0
    narrow = probe(paper_page, tmp_path, size="500,900")
    assert narrow["overflow"] <= 0, "the page is wider than a small screen"


def test_the_slider_turns_the_mesh(seen: dict[str, Any]) -> None:
    start, slid, back = seen["start"], seen["slid"], seen["back"]
    assert slid["crank"] == "100.0°"
    assert slid["carrierAngle"] == "\u221210.0°"
    assert slid["carrier"] == ["rotate(10.0000)"]
    assert all(a != b for a, b in zip(start["discs"], slid["discs"], strict=True))
    assert start["arrows"] != slid["arrows"]
    assert back == start, "going back does not restore the picture"


def test_play_moves_the_crank_and_pause_stops_it(seen: dict[str, Any]) -> None:
    """One turn takes six seconds, so 50 ms between two frames are 3 degrees."""
    assert seen["back"]["crank"] == "30.0°"
    assert seen["playing"]["crank"] == "33.0°"
    assert seen["playing"]["discs"] != seen["back"]["discs"]
    assert seen["paused"] == seen["playing"]
    assert seen["labels"] == ["Pause", "Play"]


def test_the_second_disc_shows_its_own_forces_and_can_hide_the_first(seen: dict[str, Any]) -> None:
    assert seen["second"]["arrows"] != seen["slid"]["arrows"]
    assert seen["second"]["shown"] == 2
    assert seen["alone"]["shown"] == 1


def test_script_and_package_have_one_load_law(
    seen: dict[str, Any], paper_page: str, paper_design_file: Path
) -> None:
    """The poster is Python's, the first picture of the script must be the same to a micrometre."""
    poster = re.findall(r'<path d="([^"]*)" class="force force-\w+"/>', paper_page)
    assert len(poster) == 11 + 5 + 1
    for drawn, ours in zip(seen["start"]["arrows"], poster, strict=True):
        here, there = (
            np.array([float(v) for v in re.findall(r"-?\d+(?:\.\d+)?", d)]) for d in (drawn, ours)
        )
        assert here == pytest.approx(there, abs=2e-3)

    design = load_design(paper_design_file)
    angle = np.array([math.radians(SLID)])
    series = rigid_series(Stages.from_design(design), design.requirements.peak_torque, angle)
    for state, disc in ((seen["slid"], 0), (seen["second"], 1)):
        assert _newtons(state["ring"]) == round(series.ring_force[0, disc].max())
        assert _newtons(state["pin"]) == round(series.output_pin_force[0, disc].max())
        assert _newtons(state["cam"]) == round(series.cam_load[0, disc])
        tooth = int(state["ring"].split("tooth ")[1]) - 1
        assert tooth == int(series.ring_force[0, disc].argmax())


def _newtons(text: str) -> int:
    return int(text.split("N")[0].replace("\u202f", ""))


def test_it_is_complete_without_scripts(paper_page: str) -> None:
    """What a mail program or a printer shows: the poster has its forces, the values are there."""
    still = re.sub(r"<script.*?</script>", "", paper_page, flags=re.S)
    assert still.count('class="force force-ring"') == 11
    readout = re.search(r'id="mesh-ring-force">([^<]+)<', still)
    assert readout is not None
    assert _newtons(readout.group(1)) > 1000
    assert ".controls { display: none;" in still


@pytest.mark.deep
def test_it_prints_with_bookmarks(paper_page: str) -> None:
    content = printed_page(paper_page, browser())
    sheets = re.findall(rb"/Type /Page\b(?!s)", content)
    boxes = re.findall(rb"/MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", content)
    assert 8 <= len(sheets) <= 28
    width, height = (float(side) for side in boxes[0])
    assert width == pytest.approx(595, abs=2), "not A4"
    assert height == pytest.approx(842, abs=2), "not A4"
    assert b"/Outlines" in content
    for heading in (b"Verdict", b"Requirements", b"Checks", b"Provenance"):
        assert b"/Title (" + heading + b")" in content


def test_a_browser_that_prints_nothing_is_told(paper_page: str) -> None:
    with pytest.raises(DependencyError, match="did not print the report"):
        printed_page(paper_page, sys.executable)


def test_without_a_browser_a_pdf_is_refused_before_anything_is_computed(
    cqdd: Callable[..., Any], paper_design_file: Path, tmp_path: Path
) -> None:
    done = cqdd("report", paper_design_file, "--format", "pdf", environment={"PATH": str(tmp_path)})
    assert done.code == 5
    assert "apt-get install -y chromium" in done.err
    assert not (tmp_path / "reports").exists()
    done = cqdd(
        "report", paper_design_file, "--out", "page.pdf", environment={"PATH": str(tmp_path)}
    )
    assert done.code == 5, "the ending asks for a print"


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--format", "docx"), "a report is html or pdf"),
        (("--out", "page.txt"), "page.txt ends neither in .html nor in .pdf; name it page.html"),
        (("--out", "page"), "name it page.html"),
        (("--out", "page.html", "--format", "pdf"), "name it page.pdf, or leave --format out"),
        (("--out", "page.PDF", "--format", "html"), "name it page.html, or leave --format out"),
    ],
)
def test_a_report_is_called_as_what_it_is(
    cqdd: Callable[..., Any], paper_design_file: Path, words: tuple[str, ...], says: str
) -> None:
    done = cqdd("report", paper_design_file, *words)
    assert done.code == 2
    assert says in done.err


def _draws_cleanly(page: str, folder: Path) -> None:
    found = probe(page, folder)
    assert found["errors"] == []
    assert found["console"] == []
    assert found["overflow"] <= 0
    ids = {figure["id"] for figure in found["figures"]}
    assert ids >= FIGURES
    assert ("inertia-chart" in ids) == ('id="inertia"' in page)
    for figure in found["figures"]:
        assert figure["drawn"] >= 6, figure["id"]
        assert overlapping(figure) == [], figure["id"]
        assert clipped(figure) == [], figure["id"]
    assert found["start"]["discs"] != found["slid"]["discs"]


@pytest.mark.deep
@pytest.mark.parametrize("name", OTHERS)
def test_other_designs_draw_as_cleanly(name: str, tmp_path: Path) -> None:
    _draws_cleanly(build_report(report_input(Design.from_mapping(OTHERS[name]))), tmp_path)


@pytest.mark.deep
@pytest.mark.parametrize(
    "ratio", [12, *(pytest.param(ratio, marks=pytest.mark.deep) for ratio in (6, 10, 24))]
)
def test_sized_designs_draw_as_cleanly(
    ratio: int, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    found = sized(ratio=ratio)
    page = build_report(dataclasses.replace(report_input(found.design), sizing=found))
    _draws_cleanly(page, tmp_path)
