"""What stands beside the code for those who cite, report, and build: it says what is so."""

import re
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
import yaml
from rattler_build import RecipeParseError, Stage0Recipe

import cqdd_design

REPOSITORY = Path(__file__).resolve().parents[2]
GITHUB = REPOSITORY / ".github"
FORMS = sorted(one for one in (GITHUB / "ISSUE_TEMPLATE").glob("*.yml") if one.stem != "config")
WORKFLOW = GITHUB / "workflows" / "tests.yml"
PAGES = [REPOSITORY / name for name in ("SECURITY.md", "CODE_OF_CONDUCT.md", "CONTRIBUTING.md")]
TEXTS = [*FORMS, *PAGES, GITHUB / "PULL_REQUEST_TEMPLATE.md", REPOSITORY / "examples" / "README.md"]


@pytest.fixture(scope="module")
def project():
    return tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))["project"]


@pytest.fixture(scope="module")
def citation():
    return yaml.safe_load((REPOSITORY / "CITATION.cff").read_text(encoding="utf-8"))


def test_a_citation_has_what_the_format_asks_for(citation):
    assert citation["cff-version"] == "1.2.0"
    assert {"message", "title", "authors"} <= set(citation)
    assert all("name" in one or "family-names" in one for one in citation["authors"])


def test_a_citation_says_the_version_and_licence_of_the_package(citation, project):
    assert citation["version"] == cqdd_design.__version__
    assert citation["license"] == project["license"]
    assert citation["keywords"] == project["keywords"]
    assert citation["title"].startswith(project["name"])


def test_a_citation_names_the_paper_as_the_bibliography_does(citation, project):
    (paper,) = citation["references"]
    page = (REPOSITORY / "docs" / "bibliography.md").read_text(encoding="utf-8")
    (entry,) = (line for line in page.split("\n- ") if "the paper." in line)
    entry = re.sub(r"\s+", " ", entry)
    assert paper["title"].lower() in entry.lower()
    assert str(paper["year"]) in entry
    assert all(one["family-names"] in entry for one in paper["authors"])
    assert paper["url"] in entry
    assert paper["url"] == project["urls"]["Paper"]


def versions(project) -> list[str]:
    """Pythons of the classifiers."""
    found = [re.fullmatch(r".*Python :: (3\.\d+)", one) for one in project["classifiers"]]
    return [one[1] for one in found if one]


def test_classifiers_are_known_sorted_and_of_the_versions_that_are_required(project):
    least = project["requires-python"].removeprefix(">=")
    assert versions(project)[0] == least
    assert versions(project) == [f"3.{minor}" for minor in range(11, 15)]
    rest = project["classifiers"]
    assert len(set(rest)) == len(rest)
    # A licence that is an SPDX expression has no classifier (PEP 639).
    assert not any(one.startswith("License") for one in rest)


def test_the_workflow_runs_every_python_on_three_systems(project):
    jobs = yaml.safe_load(WORKFLOW.read_text(encoding="utf-8"))["jobs"]
    matrix = jobs["daily"]["strategy"]["matrix"]
    assert matrix["python"] == versions(project)
    assert {name.partition("-")[0] for name in matrix["system"]} == {"ubuntu", "macos", "windows"}
    lines = [step["run"] for job in jobs.values() for step in job["steps"] if "run" in step]
    assert 'python -m pip install -c constraints.txt -e ".[dev]"' in lines
    assert "python -m pytest -n auto" in lines
    # Lint and types are those of .ci/run, and its script and tools exist.
    script = (REPOSITORY / ".ci" / "run").read_text(encoding="utf-8")
    for tool in ("ruff check .", "ruff format --check .", "mypy", "lint-imports"):
        program, *rest = shlex.split(tool)
        assert tool in lines
        assert " ".join([f'"$bin/{program}"', *rest]) in script
    for line in lines:
        for path in re.findall(r"(?:\.ci|tools)/[\w.]+", line):
            assert (REPOSITORY / path).exists(), path


def test_the_workflow_installs_what_the_readme_says():
    readme = (REPOSITORY / "README.md").read_text(encoding="utf-8")
    wanted = re.search(r"apt-get install -y ([\w ]+)\n", readme)[1].split()
    told = re.findall(r"apt-get install -y ([\w ]+)\n", WORKFLOW.read_text(encoding="utf-8"))
    assert told
    # The hosted runners have Chromium.
    assert all({*one.split(), "chromium"} == set(wanted) for one in told)


def test_one_form_is_for_numbers_that_look_wrong():
    assert "This number looks wrong" in [
        yaml.safe_load(form.read_text(encoding="utf-8"))["name"] for form in FORMS
    ]


@pytest.mark.parametrize("form", FORMS, ids=lambda form: form.stem)
def test_a_form_is_one_that_is_shown(form):
    content = yaml.safe_load(form.read_text(encoding="utf-8"))
    assert set(content) <= {"name", "description", "title", "labels", "body"}
    assert content["name"]
    assert content["description"]
    fields = content["body"]
    assert {one["type"] for one in fields} <= {"textarea", "input", "checkboxes"}
    assert len({one["id"] for one in fields}) == len(fields)
    assert any(one.get("validations", {}).get("required") for one in fields)
    for one in fields:
        assert one["attributes"]["label"]
        if one["type"] == "checkboxes":
            assert all(option["label"] for option in one["attributes"]["options"])


@pytest.mark.parametrize("text", TEXTS, ids=lambda text: text.name)
def test_what_is_named_exists(text):
    """Links, pages of docs/, and commands of the program with their options."""
    from cqdd_design.cli.main import COMMANDS

    content = text.read_text(encoding="utf-8")
    for target in re.findall(r"\]\((?!https?://)([^)#]+)", content):
        assert (text.parent / target).exists(), target
    for page in re.findall(r"\bdocs/[\w./-]+\.\w+", content):
        assert (REPOSITORY / page).exists(), page
    commands = {function.__name__ for function in COMMANDS}
    for line in re.findall(r"`cqdd-design ([^`]+)`", content):
        first = line.split()[0]
        assert first in {"--version", "--help"} or first in commands, line


def test_no_page_for_people_names_a_private_place():
    for text in [*TEXTS, WORKFLOW, REPOSITORY / "CITATION.cff", REPOSITORY / "pyproject.toml"]:
        hosts = re.findall(r"https?://([\w.-]+)", text.read_text(encoding="utf-8"))
        assert set(hosts) <= {
            "arxiv.org",
            "keepachangelog.com",
            "scientific-python.org",
            "semver.org",
        }, text.name


def test_the_sample_report_is_one_light_file():
    """Under 2 MB, as every report is meant to be; none of its chapters left out."""
    sample = (REPOSITORY / "reports" / "cqdd-10.html").read_bytes()
    assert len(sample) < 2_000_000
    for chapter in ("machine", "contact", "tolerances", "bench", "bom", "downloads", "planetary"):
        assert f'id="{chapter}"'.encode() in sample


def test_rattler_build_renders_the_recipe(project):
    """By the tool that conda-forge builds with: keys, jinja and versions as it takes them."""
    path = REPOSITORY / "recipe" / "recipe.yaml"
    (variant,) = Stage0Recipe.from_file(path).render()
    recipe = variant.recipe.to_dict()
    assert recipe["package"] == {"name": "cqdd-design", "version": cqdd_design.__version__}
    assert recipe["build"]["noarch"] == "python"
    run = [one.replace(" ", "") for one in recipe["requirements"]["run"]]
    assert run == [f"python{project['requires-python']}", *project["dependencies"]]
    assert recipe["tests"][1]["script"][-1].startswith("cqdd-design size")
    for right, wrong in (("requirements:", "requirement:"), ("${{ version }}", "${{ version")):
        with pytest.raises(RecipeParseError):
            Stage0Recipe.from_yaml(path.read_text(encoding="utf-8").replace(right, wrong))


def test_the_recipe_of_conda_forge_asks_for_what_the_package_asks_for(project):
    recipe = yaml.safe_load((REPOSITORY / "recipe" / "recipe.yaml").read_text(encoding="utf-8"))
    context = recipe["context"]
    assert recipe["schema_version"] == 1
    assert recipe["package"]["name"] == project["name"]
    assert context["version"] == cqdd_design.__version__
    assert f">={context['python_min']}" == project["requires-python"]
    run = [one.replace(" ", "") for one in recipe["requirements"]["run"]]
    assert run[0] == "python>=${{python_min}}"
    assert run[1:] == project["dependencies"]
    build = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))
    assert set(build["build-system"]["requires"]) <= {
        one.replace(" ", "") for one in recipe["requirements"]["host"]
    }
    (point,) = recipe["build"]["python"]["entry_points"]
    assert dict([point.split(" = ")]) == project["scripts"]
    assert recipe["about"]["license"] == project["license"]
    assert recipe["about"]["license_file"] == project["license-files"]
    assert recipe["about"]["summary"] == project["description"]


def test_no_two_modules_import_each_other_in_a_circle():
    run = subprocess.run(
        [sys.executable, REPOSITORY / "tools" / "imports.py"],
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.stderr == ""
    assert run.returncode == 0
    assert "design       catalog" in run.stdout
