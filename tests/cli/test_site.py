"""The site builds without a warning, leads nowhere wrong and is readable; its tutorials run."""

from __future__ import annotations

import importlib.util
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from page_readers import axe_source, read

from cqdd_design.design import load_design

REPOSITORY = Path(__file__).resolve().parents[2]
DOCS = REPOSITORY / "docs"
READ = ("index", "theory", "gallery", "cli", "api", "genindex", "tutorial-gait-to-knee", "faq")
"""Pages that are opened: one of every kind."""

#: Furo takes its looks from the body, and the readers tell them to the root.
_LOOKS = """<script>new MutationObserver(function () {
  document.body.dataset.theme = document.documentElement.dataset.look;
}).observe(document.documentElement, { attributes: true });</script>"""


def _module(name: str, place: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, place)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


#: The wheel alone is tried by the same: they build on each other.
TUTORIALS = _module("package_tool", REPOSITORY / "tools" / "package.py").TUTORIALS


@pytest.fixture(scope="module")
def checker() -> ModuleType:
    return _module("site_tool", REPOSITORY / "tools" / "site.py")


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Built and checked as `python tools/site.py` does it."""
    pytest.importorskip("sphinx", reason="the extra `docs` is not installed")
    folder = tmp_path_factory.mktemp("site") / "site"
    done = subprocess.run(
        [sys.executable, REPOSITORY / "tools" / "site.py", folder],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


@pytest.mark.deep
def test_every_page_and_every_file_of_the_gallery_is_there(site: Path) -> None:
    for page in DOCS.glob("*.md"):
        assert (site / f"{page.stem}.html").is_file(), page.name
    gallery = (site / "gallery.html").read_text(encoding="utf-8")
    designs = re.findall(r"(?m)^## ", (DOCS / "gallery.md").read_text(encoding="utf-8"))
    assert len(designs) >= 8
    for kind in (r"-ring\.dxf", r"-bom\.csv", r"\.toml"):
        assert len(set(re.findall(rf'href="(_downloads/[^"]+{kind})"', gallery))) == len(designs)
    # Three discs of nine lobes are three different ones.
    discs = {
        re.sub(r"-disc.*", "", one) for one in re.findall(r"/([\w-]+-disc[\w-]*)\.dxf", gallery)
    }
    assert len(discs) == len(designs)
    # Equations are drawn by the browser itself, and the changelog is that of the repository.
    assert "<mfrac>" in (site / "theory.html").read_text(encoding="utf-8")
    assert "Keep a Changelog" in (site / "changelog.html").read_text(encoding="utf-8")


@pytest.mark.deep
def test_indices_and_powers_are_set(site: Path) -> None:
    for page in DOCS.glob("*.md"):
        text = (site / f"{page.stem}.html").read_text(encoding="utf-8")
        text = text[text.index("<article") : text.index("</article>")]
        text = re.sub(r"(?s)<(pre|code|math|style|h\d|dl)\b.*?</\1>", "", text)
        words = re.sub(r"<[^>]+>", " ", text)
        assert re.findall(r"(?<![\w/.])[^\W\d_]_[A-Za-z]+\b(?!_)", words) == [], page.name
        assert re.findall("<sub>[^<]*[\u00b2\u00b3\u2074][^<]*</sub>", text) == [], page.name
    theory = (site / "theory.html").read_text(encoding="utf-8")
    assert "Z<sub>R</sub>" in theory


@pytest.mark.deep
def test_classes_are_not_told_how_python_makes_them(site: Path) -> None:
    text = (site / "api.html").read_text(encoding="utf-8")
    assert 'id="cqdd_design.Design.replacing"' in text
    assert "__new__" not in text


#: Boxes that are wider than the screen, what each says of it, and options on more than one line.
_WIDE = """
var page = frame.contentDocument, view = frame.contentWindow;
return {
  wide: Array.from(page.querySelectorAll(".equation, .table-wrapper, pre")).filter(function (box) {
    return box.scrollWidth > box.clientWidth;
  }).map(function (box) {
    var part = box.matches(".equation") ? "::after" : "::before";
    return [box.className.split(" ")[0] || box.tagName, view.getComputedStyle(box, part).content];
  }),
  broken: Array.from(page.querySelectorAll(".whole")).filter(function (one) {
    return one.getClientRects().length > 1;
  }).length,
  options: page.querySelectorAll(".whole").length,
  tallest: Math.max(0, ...Array.from(page.querySelectorAll("tbody tr")).map(function (row) {
    return row.getBoundingClientRect().height;
  }))
};
"""


@pytest.mark.deep
@pytest.mark.parametrize(
    ("page", "scrolls"),
    [
        ("theory", set()),
        ("actuator-model", {"table-wrapper"}),
        ("benchmarks", {"table-wrapper"}),
        ("how-to-motor", {"PRE"}),
        ("cli", {"PRE"}),
    ],
)
def test_what_is_wider_than_a_phone_says_so(
    page: str, scrolls: set[str], site: Path, tmp_path: Path
) -> None:
    """Equations have lines that fit, keys of tables give way, options stay whole."""
    here = tmp_path / "site"
    shutil.copytree(site, here)
    text = (here / f"{page}.html").read_text(encoding="utf-8")
    found = read(text, here, more=_WIDE)
    for screen in ("400 800 light", "400 800 dark"):
        seen = found[screen]["more"]
        assert {kind for kind, _ in seen["wide"]} == scrolls, screen
        assert all("scrolls sideways" in said for _, said in seen["wide"]), seen["wide"]
        assert seen["broken"] == 0
        assert seen["options"] > 0 or page == "theory"
        # A row is read at a glance: sentences have room in a table that scrolls.
        assert seen["tallest"] < 240
    wide = found["1300 900 light"]["more"]["wide"]
    assert [kind for kind, _ in wide if kind != "PRE"] == []


def test_options_stay_whole_and_keys_in_tables_may_be_broken() -> None:
    nodes = pytest.importorskip("docutils.nodes")
    site_parts = _module("site_parts", DOCS / "site_parts.py")
    context = {
        "body": '<a href="#--to">say --to, --step-schema</a> a--b <!-- --x --> -- <i>1e-11</i>'
    }
    site_parts.whole_words(None, "", "", context, None)
    assert context["body"] == (
        '<a href="#--to">say <span class="whole">--to</span>, '
        '<span class="whole">--step-schema</span></a> a--b <!-- --x --> -- '
        '<i><span class="whole">1e-11</span></i>'
    )
    site_parts.whole_words(None, "", "", {}, None)
    cell, beside = nodes.entry(), nodes.literal("", "drive.thermal_limit")
    cell += nodes.literal("", "drive.thermal_limit")
    cell += nodes.literal("", ".count_")
    tree = nodes.section("", cell, nodes.paragraph("", "", beside))
    site_parts.breakable(None, tree)
    pieces = [[one.astext() for one in code.children] for code in cell.children]
    assert pieces == [["drive.", "<wbr>", "thermal_", "<wbr>", "limit"], [".count_"]]
    assert len(beside.children) == 1


def test_numbers_stay_with_their_units() -> None:
    pytest.importorskip("docutils")
    site_parts = _module("site_parts", DOCS / "site_parts.py")
    told = "M4 m 10.72 s, 5 kN·m/rad, 3 mm²/s and 17.0 % of 3 A3 sheets; v1.2 mm, 12 cqdd"
    found = [one.astext() for one in site_parts.quantities(told) if one.tagname == "inline"]
    assert found == ["10.72 s", "5 kN·m/rad", "3 mm²/s", "17.0 %"]
    assert "".join(one.astext() for one in site_parts.quantities(told)) == told


def test_pages_that_docstrings_name_are_links() -> None:
    pytest.importorskip("docutils")
    site_parts = _module("site_parts", DOCS / "site_parts.py")
    lines = ["The model is docs/contact-model.md, with its sources."]
    site_parts.link_pages(None, "", "", None, None, lines)
    assert lines == ["The model is :doc:`docs/contact-model.md <contact-model>`, with its sources."]


def test_no_line_of_a_page_is_taken_for_a_comment() -> None:
    """MyST drops lines that begin with a per cent sign: a number had lost its unit."""
    begins = re.compile(r"(?m)^[ >*-]*(%|\+\+\+)")
    assert begins.search("make 27\n  %. The dimensions")
    named = ("CHANGELOG.md", "CONTRIBUTING.md", "README.md", "examples/README.md")
    for page in (*DOCS.glob("*.md"), *(REPOSITORY / name for name in named)):
        assert begins.search(page.read_text(encoding="utf-8")) is None, page.name


def test_symbols_are_told_from_names() -> None:
    pytest.importorskip("docutils")
    site_parts = _module("site_parts", DOCS / "site_parts.py")

    def set_as(text: str) -> str:
        return "".join(
            one.astext() if one.tagname == "#text" else f"[{one.tagname[:3]} {one.astext()}]"
            for one in site_parts.symbols(text)
        )

    assert set_as("R_w sin(\u03c6), F^0.9/b^0.8") == ("R[sub w] sin(\u03c6), F[sup 0.9]/b[sup 0.8]")
    assert set_as("N_w(n+1)") == "N[sub w](n+1)"
    assert set_as("r_p\u2074 - (b_i\u00b2)") == "r[sub p]\u2074 - (b[sub i]\u00b2)"
    assert set_as("(F_V - F_A)/F_Q >= mu_0/d_p") == (
        "(F[sub V] - F[sub A])/F[sub Q] >= mu[sub 0]/d[sub p]"
    )
    assert set_as("sigma_m/S_u. So") == "sigma[sub m]/S[sub u]. So"
    assert set_as("E*_1, W^-0.13, d^(2/3).") == "E*[sub 1], W[sup \u22120.13], d[sup 2/3]."
    assert set_as("(d_pin,max - d_pin,mean), B_m, max") == (
        "(d[sub pin,max] - d[sub pin,mean]), B[sub m], max"
    )
    for name in ("peak_torque", "x_position_m", "a/b_c.toml", "file_a"):
        assert set_as(name) == name


@pytest.mark.deep
@pytest.mark.parametrize("page", READ)
def test_a_page_is_for_every_reader(page: str, site: Path, tmp_path: Path) -> None:
    """No text under 11 px, nothing wider than the screen, nothing serious by axe."""
    here = tmp_path / "site"
    shutil.copytree(site, here)
    text = (here / f"{page}.html").read_text(encoding="utf-8")
    found = read(text.replace("</body>", f"{_LOOKS}</body>"), here, axe=axe_source())
    for screen, seen in found.items():
        _legible(screen, seen)


def _legible(screen: str, seen: dict[str, Any]) -> None:
    assert seen["small"] == [], screen
    assert seen["overflow"] <= 0, screen
    serious = [v for v in seen.get("violations", ()) if v["impact"] in {"serious", "critical"}]
    assert serious == [], screen


def test_the_checker_sees_what_is_wrong(checker: ModuleType, tmp_path: Path) -> None:
    (tmp_path / "good.html").write_text('<h1 id="here">x</h1><a href="#here">x</a>')
    assert list(checker.faults(tmp_path)) == []
    (tmp_path / "bad.html").write_text(
        '<a href="gone.html">x</a><a href="good.html#there">x</a><img src="none.png">'
        '<script src="https://example.org/x.js"></script><a href="https://example.org">x</a>'
    )
    (tmp_path / "bad.css").write_text("@import url(https://example.org/font.css);")
    found = {one.removeprefix("bad.html").lstrip(": ") for one in checker.faults(tmp_path)}
    assert found == {
        "gone.html is not there",
        "good.html#there has no such anchor",
        "none.png is not there",
        "loads https://example.org/x.js",
        "bad.css loads from elsewhere: https:",
    }


def test_what_the_site_is_built_with_is_in_the_extra() -> None:
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    wanted = {re.match(r"[\w-]+", one)[0] for one in project["optional-dependencies"]["docs"]}
    assert wanted == {"furo", "myst-parser", "sphinx", "sphinx-copybutton"}


def _blocks(page: Path, language: str) -> list[str]:
    text = page.read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```$", text, flags=re.MULTILINE | re.DOTALL)


@pytest.mark.deep
def test_tutorials_run_one_after_the_other(cqdd: Any, tmp_path: Path) -> None:
    """As a reader with nothing but the installed package follows them, in one empty folder."""
    assert {path.stem for path in DOCS.glob("tutorial-*.md")} == {
        f"tutorial-{t}" for t in TUTORIALS
    }
    for name in TUTORIALS:
        page = DOCS / f"tutorial-{name}.md"
        for table in _blocks(page, "csv"):
            (tmp_path / re.match(r"# ([\w-]+\.csv)", table)[1]).write_text(table, encoding="utf-8")
        for line in "".join(_blocks(page, "console")).splitlines():
            program, *arguments = shlex.split(line.removeprefix("$ "))
            assert program == "cqdd-design"
            done = cqdd(*arguments, timeout=600)
            wanted = 4 if arguments == ["check", "printed-13.toml"] else 0
            assert done.code == wanted, f"{line}\n{done.err}"
        for code in _blocks(page, "python"):
            run = subprocess.run(
                [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True
            )
            assert run.returncode == 0, run.stderr
            # Half of the voltage of 48 V turns the joint of ten to one at half its no-load speed.
            speed = float(re.search(r"([\d.]+) rad/s", run.stdout)[1])
            assert 12.0 < speed < 14.5
    # Every file that the pages name was written, and the printer's errors are a design's.
    for name in ("reports/sized-10.html", "exports/sized-10/sized-10-disc.dxf"):
        assert (tmp_path / name).is_file()
    for name in ("disc.dxf", "ring.pdf", "ring.svg", "disc.nc"):
        assert (tmp_path / "exports" / "sized-10" / "edm" / f"sized-10-{name}").is_file()
    assert (tmp_path / "exports/printed-13/print/printed-13-coupon.3mf").is_file()
    (printing,) = _blocks(DOCS / "tutorial-printed.md", "toml")
    design = tmp_path / "printed-13.toml"
    design.write_text(f"{design.read_text('utf-8')}\n{printing}", encoding="utf-8")
    assert load_design(design).printing.hole_error == pytest.approx(-120e-6)
