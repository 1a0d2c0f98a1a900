"""Report sections of the simulated actuator in a real Chromium, wide and narrow."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path
from typing import Any

import pytest
from report_browser import clipped, overlapping, probe, run_browser
from shared_outputs import report_input

from cqdd_design.actuator.bench import run_bench
from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.design import Design, load_design
from cqdd_design.machine import resolve
from cqdd_design.report import build_report

pytestmark = pytest.mark.deep

FIGURES = {
    "envelope",
    "efficiency-driving",
    "efficiency-generating",
    "torque-bode",
    "position-bode-45",
    "position-bode-5",
    "backlash-loop",
    "breakaway-trace",
    "backdrive-trace",
    "ripple-spectrum",
    "ripple-orders",
}

DUTY = [
    {"torque": "20 N*m", "speed": "5 rad/s", "share": 0.5},
    {"torque": "21 N*m", "speed": "5.2 rad/s", "share": 0.3},
    {"torque": "-15 N*m", "speed": "8 rad/s", "share": 0.2},
]


@pytest.fixture(scope="module")
def page(paper_design_file: Path) -> str:
    """The paper's design with a duty whose points lie close together."""
    mapping = load_design(paper_design_file).to_mapping()
    mapping["requirements"]["duty"] = DUTY
    design = Design.from_mapping(mapping)
    actuator = actuator_parameters(resolve(design))
    measured = run_bench(actuator, rated_current=20.0, beside_paper=True)
    return build_report(dataclasses.replace(report_input(design), bench=(actuator, measured)))


@pytest.fixture(scope="module", params=["1280,1600", "500,1600"])
def seen(
    request: pytest.FixtureRequest, page: str, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Any]:
    return probe(page, tmp_path_factory.mktemp("browser"), size=request.param)


def test_all_figures_draw_without_overlap(seen: dict[str, Any]) -> None:
    assert seen["errors"] == []
    assert seen["console"] == []
    assert seen["overflow"] <= 0
    figures = {figure["id"]: figure for figure in seen["figures"]}
    assert set(figures) >= FIGURES
    for name in FIGURES:
        figure = figures[name]
        assert figure["labelled"], name
        assert figure["drawn"] >= 6, name
        assert overlapping(figure) == [], name
        assert clipped(figure) == [], name


def test_parameters_open_on_paper(page: str, tmp_path: Path) -> None:
    """An expander cannot be opened on paper: what it hides is printed."""
    hidden = "<style>section, header { display: none } section#actuator { display: block }</style>"
    sheets = []
    for name, markup in (
        ("closed", page),
        ("without", re.sub("<details.*?</details>", "", page, flags=re.S)),
    ):
        path = tmp_path / f"{name}.html"
        path.write_text(markup.replace("</head>", f"{hidden}</head>"), encoding="utf-8")
        pdf = tmp_path / f"{name}.pdf"
        run_browser(tmp_path, "--no-pdf-header-footer", f"--print-to-pdf={pdf}", page=path)
        sheets.append(len(re.findall(rb"/Type /Page\b(?!s)", pdf.read_bytes())))
    assert sheets[0] > sheets[1]
