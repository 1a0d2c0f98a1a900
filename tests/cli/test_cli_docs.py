"""README and docs are true: their commands run, their set-up lines are what CI runs."""

import importlib.util
import math
import pickle
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from terminal_lines import too_wide

from cqdd_design.design import load_design
from cqdd_design.geometry import kinematics

REPOSITORY = Path(__file__).resolve().parents[2]
PAGES = [REPOSITORY / "README.md", *sorted((REPOSITORY / "docs").glob("*.md"))]


def blocks(page: Path, language: str) -> list[str]:
    text = page.read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```$", text, flags=re.MULTILINE | re.DOTALL)


def console_commands(page: Path) -> list[str]:
    lines = "\n".join(blocks(page, "console")).splitlines()
    return [line[2:] for line in lines if line.startswith("$ ")]


def paragraphs(page: Path) -> list[str]:
    """Running text: no code, tables or directives."""
    text = re.sub(r"```.*?```", "\n\n", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    found = re.split(r"\n\s*\n|\n(?=\s*[-*] |\s*\d+\. )", text)
    return [one.strip() for one in found if not one.strip().startswith(("|", "<", "#", ":"))]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_no_paragraph_is_a_wall(page):
    """A reader who looks for one thing does not go through a screen of others."""
    assert [one[:60] for one in paragraphs(page) if len(one) > 1300] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_are_words(page):
    """The site has no `.md`: a link named by its file names nothing there."""
    text = page.read_text(encoding="utf-8")
    kept = [] if "; the site has it here." in text else re.findall(r"\[[\w./-]+\.md\]\(", text)
    assert kept == []


def test_the_picture_of_a_report_shows_what_the_gallery_has():
    """It says of itself what it shows: the first tutorial's design, judged by today's code."""
    picture = (REPOSITORY / "docs" / "images" / "report.png").read_bytes()
    told = re.search(rb"tEXtDescription\x00([\x20-\x7e]+?; [\d., ]+)", picture)[1].decode()
    verdict, _, figures = told.partition("; ")
    gallery = (REPOSITORY / "docs" / "gallery.md").read_text(encoding="utf-8")
    plain = gallery.split("\n## ")[1]
    assert "plain-10" in plain
    assert f"requirements: {verdict}." in plain
    rows = re.findall(r"(?m)^\| [^|]+ \| ([\d.]+) \| [^|]+ \| [^|]* \| pass \|$", plain)
    assert figures.split(", ") == rows


@pytest.fixture(scope="module")
def shown_before():
    return set()


@pytest.mark.deep
@pytest.mark.parametrize(
    "page",
    # The commands of torque-estimation.md need torch; test_cli_torque_docs.py runs them, and
    # test_site.py those of the tutorials, which build on each other.
    [
        p
        for p in PAGES
        if console_commands(p)
        and p.name != "torque-estimation.md"
        and not p.name.startswith("tutorial-")
    ],
    ids=lambda page: page.name,
)
def test_every_command_shown_runs(page, cqdd, tmp_path, shown_before):
    """In the order of the page, from a folder with the repository's designs and the page's files.

    What they tell fits a terminal of 80 columns.

    A block of TOML or CSV that begins with a file's name is that file. A command of the paper's
    design that another page has shown before, and of which no file is read later, is not run again.
    """
    shutil.copytree(REPOSITORY / "designs", tmp_path / "designs")
    for block in (*blocks(page, "toml"), *blocks(page, "csv")):
        if name := re.match(r"# ([\w-]+\.(?:toml|csv))\b", block):
            (tmp_path / name[1]).write_text(block)
    for command in console_commands(page):
        program, *arguments = shlex.split(command, comments=True)
        assert program == "cqdd-design", command
        alone = {"bench", "calibrate", "inertia", "compare"} & set(arguments[:1])
        if alone and arguments[1:] == ["designs/cqdd-10.toml"]:
            if arguments[0] in shown_before:
                continue
            shown_before.add(arguments[0])
        done = cqdd(*arguments, timeout=300)
        # The paper's design is a no, whatever motor or duty; what `size` writes is a yes.
        wanted = 4 if arguments[:2] == ["check", "designs/cqdd-10.toml"] else 0
        assert done.code == wanted, f"{command}\n{done.err}"
        # However long the name of this place is.
        told = done.out.replace(str(tmp_path), ".")
        assert "--json" in arguments or too_wide(told) == [], command


def test_pages_show_commands_only_in_console_blocks():
    """A command in another kind of block would not be run by the test above."""
    allowed = set(blocks(REPOSITORY / "README.md", "sh"))
    for page in PAGES:
        for language in ("sh", "bash", "shell"):
            for block in blocks(page, language):
                assert "cqdd-design" not in block or block in allowed, (page, block)


def test_readme_sets_up_in_two_commands():
    apt, install, test, torque = blocks(REPOSITORY / "README.md", "sh")
    assert re.fullmatch(r"apt-get install -y [\w ]+\n", apt)
    for command in (install, test):
        assert command.count("\n") == 1
        assert command.startswith("python3 -m venv .venv && .venv/bin/pip install -c constraints")
    assert "size --ratio 10 --report --export dxf,step" in install
    assert "pytest" in test
    lines = torque.splitlines()
    assert all(line.startswith(".venv/bin/pip install ") for line in lines)
    script = (REPOSITORY / ".ci" / "run").read_text()
    pattern = re.search(r'grep -E "([^"]*)" README.md\)', script)
    assert pattern is not None
    assert lines == [line for line in lines if re.search(pattern[1], line)]


def test_ci_runs_the_readmes_own_commands():
    script = (REPOSITORY / ".ci" / "run").read_text()
    assert "python3 -m venv" in script
    pattern = re.search(r"tests=\$\(grep -m1 -E '([^']*)' README.md\)", script)
    assert pattern is not None
    readme = (REPOSITORY / "README.md").read_text().splitlines()
    matching = [line for line in readme if re.search(pattern[1], line)]
    assert matching == [blocks(REPOSITORY / "README.md", "sh")[2].strip()]


@pytest.mark.deep
def test_generated_pages_are_up_to_date():
    done = subprocess.run(
        [sys.executable, REPOSITORY / "docs" / "build.py", "--check"],
        capture_output=True,
        text=True,
        cwd=REPOSITORY,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("stiffness 2142 N", "stiffness 2141 N", True),
        ("| 2.07 | -71 % |", "| 2.06 | -71 % |", True),
        ("below 1e-11 | 1e-09", "below 1e-12 | 1e-09", True),
        ("M1.20,-3.4", "M1.2,-3.5", True),
        ("stiffness 2142 N", "stiffness 2139 N", False),
        ("| 2.07 | -71 % |", "| 2.07 | 71 % |", False),
        ("below 1e-11 | 1e-09", "below 1e-08 | 1e-09", False),
        ("M1.20,-3.4", "M1.20,-3.6", False),
        ("1.5 N", "1.5 mN", False),
        ("12 of 13", "12 of 13 of 14", False),
        ("0.10 and 1", "0.12 and 1", False),
    ],
)
def test_a_page_is_out_of_date_by_more_than_processors_round(monkeypatch, one, other, same):
    """The same code wrote 2142 N m/rad on one processor and 2141 on another."""
    monkeypatch.syspath_prepend(REPOSITORY / "docs")
    spec = importlib.util.spec_from_file_location("build", REPOSITORY / "docs" / "build.py")
    build = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(build)
    assert build.alike(one, other) == build.alike(other, one) == same


def test_pages_take_what_whole_files_of_an_earlier_run_recorded(monkeypatch, tmp_path):
    """And nothing where one of the folder's files failed or did not run."""
    monkeypatch.syspath_prepend(REPOSITORY / "docs")
    recorded = importlib.import_module("recorded")
    files = sorted((REPOSITORY / "tests" / "published").glob("test_*.py"))
    told = {f"published/{file.name}": [("published", (file.stem, 1.5))] for file in files}
    monkeypatch.setenv("CQDD_TEST_RUNS", str(tmp_path))
    assert recorded.recorded_before("published") is None
    (tmp_path / "recorded.pickle").write_bytes(pickle.dumps(told))
    rows = recorded.recorded_before("published")
    assert rows == [(file.name, "published", (file.stem, 1.5)) for file in files]
    assert recorded.recorded_before("properties/test_contact_validation.py") is None
    del told[f"published/{files[3].name}"]
    (tmp_path / "recorded.pickle").write_bytes(pickle.dumps(told))
    assert recorded.recorded_before("published") is None
    one = recorded.recorded_before(f"published/{files[0].name}")
    assert one == [(files[0].name, "published", (files[0].stem, 1.5))]


def test_rules_of_checks_are_printed_with_letters_and_help_with_short_names():
    allowables = (REPOSITORY / "docs" / "assumptions.md").read_text(encoding="utf-8")
    rules = [line.split(" | ")[1] for line in allowables.splitlines() if line.startswith("| `")]
    assert len(rules) > 80
    names = r"(?<![\w.])(?:alpha|delta|mu|omega|pi|rho|sigma|tau)(?=_|\b)|\ddeg|<=|>="
    assert [rule for rule in rules if re.search(names, rule)] == []
    assert any("\u03c3_a/(1 \u2212 \u03c3_m/S_u)" in rule for rule in rules)
    # What stands for a value is short, as N, Q or FILE.
    helped = (REPOSITORY / "docs" / "cli.md").read_text(encoding="utf-8")
    assert re.findall(r"--[\w-]+ <(?:int|float)[^>]*>", helped) == []


def test_no_validation_shows_a_figure_above_its_bound():
    rows = [
        (page.name, line)
        for page in PAGES
        for line in page.read_text(encoding="utf-8").splitlines()
        if re.search(r"\| below [\d.e-]+ \| [\d.e-]+ \|$", line)
    ]
    assert len(rows) > 40
    for name, line in rows:
        met, bound = re.findall(r"[\d.e-]+", line.partition("| below ")[2])
        assert float(met) <= float(bound), (name, line)


def test_clearances_said_to_be_doubled_are(monkeypatch):
    monkeypatch.syspath_prepend(REPOSITORY / "docs")
    spec = importlib.util.spec_from_file_location("build", REPOSITORY / "docs" / "build.py")
    build = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(build)
    paper = load_design(REPOSITORY / "designs" / "cqdd-10.toml")
    cases = dict(build._paper_cases())
    for words, factor in (("doubled", 2.0), ("half as wide again", 1.5)):
        wider = paper.replacing(cases[f"all, clearances {words}"]).reducer
        now = paper.reducer
        assert wider.modification.equidistant == pytest.approx(
            factor * now.modification.equidistant
        )
        assert wider.output_pins.hole_clearance == pytest.approx(
            factor * now.output_pins.hole_clearance
        )
        assert wider.cam_bearing.radial_clearance == pytest.approx(
            factor * now.cam_bearing.radial_clearance
        )
    page = (REPOSITORY / "docs" / "contact-model.md").read_text(encoding="utf-8")
    assert all(f"| {words} |" in page for words in cases)


def test_the_period_of_the_docs_is_that_of_the_code():
    """2 pi n/((n+1) gcd(n, N_w)): the page once lacked the n."""
    page = (REPOSITORY / "docs" / "theory.md").read_text(encoding="utf-8")
    assert "2πn/((n+1)·gcd(n, N_w))" in page
    assert kinematics.mesh_period(10, 5) == pytest.approx(2.0 * math.pi * 10 / (11 * 5))


def test_exit_codes_of_the_docs_are_those_of_the_errors():
    from cqdd_design import errors

    page = (REPOSITORY / "docs" / "cli.md").read_text()
    told = {int(code) for code in re.findall(r"^\| (\d+) \|", page, flags=re.MULTILINE)}
    family = [errors.CqddError]
    for kind in family:
        family += kind.__subclasses__()
    assert told == {0, 130} | {kind.exit_code for kind in family}


def test_constraints_pin_every_dependency():
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text())["project"]
    pins = dict(
        line.split("==")
        for line in (REPOSITORY / "constraints.txt").read_text().splitlines()
        if line and not line.startswith("#")
    )
    pinned = {re.sub(r"[-_.]+", "-", name).lower() for name in pins}
    extras = project["optional-dependencies"]
    needed = [*project["dependencies"], *extras["dev"], *extras["docs"], *extras["torque"]]
    for requirement in needed:
        assert re.match(r"[\w-]+", requirement)[0].lower() in pinned, requirement


_NAME = r"[A-Z](?:[^\W\d_]|['-](?=[^\W\d_]))+"
_AUTHORS = rf"({_NAME})(?:(?:, {_NAME})*,? and {_NAME}| et al\.)?"
_CITED = re.compile(rf"{_AUTHORS},? \(?(?:[A-Z]+, )?(1[89]\d\d|20[0-2]\d)\b")
_STANDARD = re.compile(r"\b((?:ISO(?:/TR)?|AGMA|ASTM|ASME|IEC) (?:VIII|[A-Z]?\d+))")


def cited(path):
    """Sources that a file cites: first author and year, and numbers of standards."""
    text = re.sub(r"\s+", " ", path.read_text(encoding="utf-8"))
    return {f"{name} {year}" for name, year in _CITED.findall(text)} | set(_STANDARD.findall(text))


def test_every_source_cited_is_in_the_bibliography():
    bibliography = REPOSITORY / "docs" / "bibliography.md"
    keys = re.findall(r"\*\*([^*]+)\*\*", bibliography.read_text(encoding="utf-8"))
    words = [set(re.split(r"[ ,()-]+", key)) for key in keys]
    sources = [page for page in PAGES if page != bibliography]
    sources += sorted((REPOSITORY / "cqdd_design").rglob("*.py"))
    missing = {
        (source.name, one)
        for source in sources
        for one in cited(source)
        if not any(set(one.split(" ")) <= key for key in words)
    }
    assert not missing
    assert {"Cowper 1966", "Tate 1946", "ISO 76"} <= cited(REPOSITORY / "docs" / "contact-model.md")


def test_every_torque_density_that_does_not_follow_is_an_erratum():
    """Of the paper's comparison, on the page of theory and in the report."""
    from cqdd_design.actuator.comparison import published_actuators
    from cqdd_design.report.judgement.closing import ERRATA

    page = (REPOSITORY / "docs" / "theory.md").read_text(encoding="utf-8")
    wrong = [one for one in published_actuators() if one.remark]
    assert {one.name for one in wrong} == {"BEAR", "Lee et al."}
    for one in wrong:
        right = f"{one.torque_density:.2f} N\u00b7m/kg"
        assert any(one.name in line and right in line for line in page.splitlines())
        assert any(one.name in row[0] and row[2] == right for row in ERRATA)


def test_links_between_pages_lead_somewhere():
    for page in PAGES:
        for target in re.findall(r"\]\((?!https?://)([^)#]+)", page.read_text(encoding="utf-8")):
            assert (page.parent / target).exists(), f"{page.name}: {target}"


@pytest.mark.parametrize(
    "page",
    # Those of the library take long or build on each other; test_library_docs.py runs them, and
    # test_site.py that of the tutorial.
    [
        p
        for p in PAGES
        if blocks(p, "python")
        and p.name not in ("README.md", "library.md", "tutorial-simulator.md")
    ],
    ids=lambda page: page.name,
)
def test_python_shown_runs(page):
    for block in blocks(page, "python"):
        done = subprocess.run(
            [sys.executable, "-c", block],
            cwd=REPOSITORY,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        assert done.stdout


def test_requirements_shown_are_requirements(tmp_path):
    from cqdd_design.design import load_requirements

    shown = [b for p in PAGES for b in blocks(p, "toml") if b.startswith("[requirements]")]
    assert shown
    (tmp_path / "knee.csv").write_text("t [ms],tau_knee [N*m],dq [deg/s]\n0,1,2\n5,3,4\n")
    for number, block in enumerate(shown):
        path = tmp_path / f"{number}.toml"
        path.write_text(block)
        load_requirements(path)


@pytest.mark.deep
def test_the_claims_of_the_paper_are_those_computed(cqdd):
    done = cqdd("compare", REPOSITORY / "designs" / "cqdd-10.toml", "--json")
    claims = done.document["results"]["paper_claims"]
    table = (
        (REPOSITORY / "docs" / "theory.md")
        .read_text(encoding="utf-8")
        .split("## Claims of the paper")[1]
        .split("\n## ")[0]
    )
    rows = [line.split("|")[1:-1] for line in table.splitlines() if line.startswith("| ")][1:]
    assert len(rows) == len(claims)
    for (_, _, ours, holds), claim in zip(rows, claims, strict=True):
        assert holds.strip() == claim["verdict"]
        for number in re.findall(r"[0-9]+[.][0-9]+|[0-9]+(?= mm)", ours):
            assert number in str(claim["ours"]), claim["claim"]
