"""Every command that says whether a design will do says the same."""

from __future__ import annotations

import random
from types import SimpleNamespace

import pytest
from terminal_lines import too_wide

from cqdd_design.cli.tables import binding
from cqdd_design.design import Requirements, load_design, save_design
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.roads.analyse import asks_of_gearboxes
from cqdd_design.sizing import size


def lines_of(document):
    return {one["id"]: one for one in document["checks"]}


@pytest.mark.deep
def test_check_and_report_say_the_same(cqdd, paper_design_file, tmp_path):
    check = cqdd("check", paper_design_file, "--json").document
    report = cqdd("report", paper_design_file, "--json").document
    assert report["checks"] == check["checks"]
    assert report["results"]["verdict"] == check["results"]["verdict"]
    page = (tmp_path / "reports" / "cqdd-10.html").read_text()
    assert "Does not meet its requirements" in page


@pytest.mark.deep
def test_analyse_draws_gearboxes_where_their_lines_are_asked_for(cqdd, paper_design_file, tmp_path):
    """`size --stiffness` wrote a design whose verdict is yes, and of which `analyse` knew less."""
    asked = {"requirements.backlash": "6 arcmin", "requirements.stiffness": "1 N*m/arcmin"}
    for key, value in asked.items():
        assert asks_of_gearboxes(load_design(paper_design_file).replacing({key: value}))
    design = tmp_path / "asked.toml"
    save_design(design, load_design(paper_design_file).replacing(asked))
    check = cqdd("check", design, "--json").document
    analyse = cqdd("analyse", design, "--json").document
    assert lines_of(check) == lines_of(analyse)
    for line in ("BACKLASH", "STIFFNESS", "YIELD"):
        assert lines_of(analyse)[line]["status"] in {"pass", "warn", "fail"}
    assert "`check` draws" not in cqdd("analyse", design).out


@pytest.mark.deep
def test_check_and_analyse_say_the_same(cqdd, paper_design_file):
    check = cqdd("check", paper_design_file, "--json").document
    analyse = cqdd("analyse", paper_design_file, "--json").document
    assert check["results"]["verdict"]["meets"] == "no"
    own = lines_of(check)
    assert {k: v for k, v in own.items() if k != "YIELD"} == lines_of(analyse)
    # What `analyse` prints of the same things is what the lines compare.
    results = analyse["results"]
    contact, life = results["contact"], results["life"]
    assert own["CONTACT-RING-PEAK"]["value"] == pytest.approx(contact["ring_pressure_max_MPa"])
    assert own["CONTACT-PIN-PEAK"]["value"] == pytest.approx(contact["output_pressure_max_MPa"])
    assert own["BEARING-LIFE"]["value"] == life["cam_bearings"]["set_L10h"]
    least = min(part["life_hours"] for part in life["parts"])
    figures = {one["id"]: one for one in check["results"]["verdict"]["headline"]}
    assert figures["life"]["value"] == least
    assert list(figures) == [
        "peak_torque",
        "continuous_torque",
        "life",
        "backlash_p95",
        "efficiency",
        "temperature",
        "mass",
    ]
    assert figures["efficiency"]["value"] == pytest.approx(results["losses"]["efficiency_forward"])
    winding = results["temperatures_degC"]["winding"]
    assert own["THERMAL-RISE"]["value"] == pytest.approx(winding)


@pytest.mark.deep
def test_tolerance_and_bench_agree_with_the_verdict(cqdd, paper_design_file):
    check = cqdd("check", paper_design_file, "--json").document
    assert_bench_agrees(cqdd, paper_design_file, check)
    assert_tolerance_agrees(cqdd, paper_design_file, check)


def assert_bench_agrees(cqdd, design, check):
    bench = cqdd("bench", design, "--json").document
    assert bench["results"]["verdict"] == check["results"]["verdict"]
    assert bench["checks"] == check["checks"]
    figures = {one["id"]: one for one in check["results"]["verdict"]["headline"]}
    mass = bench["results"]["metrics"]["mass"]["value"]
    assert figures["mass"]["value"] == pytest.approx(mass)


def assert_tolerance_agrees(cqdd, design, check):
    """The same gearboxes, worked again."""
    figures = {one["id"]: one for one in check["results"]["verdict"]["headline"]}
    drawn = cqdd("tolerance", design, "--samples", "256", "--json").document
    backlash = drawn["results"]["backlash_arcmin"]["p95"]
    assert figures["backlash_p95"]["value"] == pytest.approx(backlash, rel=1e-9)


def drawn_requirements(seed):
    """What somebody may ask for; closed forms give a design, whatever the verdict on it."""
    draw = random.Random(seed)
    peak = 10.0 ** draw.uniform(0.9, 1.6)
    return Requirements(
        ratio=draw.choice([6, 8, 9, 11, 13]),
        peak_torque=f"{peak:.3g} N*m",
        continuous_torque=f"{peak * draw.uniform(0.05, 0.4):.3g} N*m",
        input_speed=f"{draw.choice([300, 800, 1500])} rpm",
        life=f"{draw.choice([300, 2000])} h",
        disc_count=draw.choice([1, 2, 3]),
        disc_material=draw.choice(["AISI 4140 Q&T 540C", "AISI 52100 / 100Cr6 hardened"]),
    )


@pytest.mark.deep
@pytest.mark.parametrize("seed", [4, 8, 9])
def test_every_command_says_the_same_of_designs_nobody_chose(cqdd, tmp_path, seed):
    design = tmp_path / "drawn.toml"
    save_design(design, size(drawn_requirements(seed)).design)
    check = cqdd("check", design, "--json").document
    own = lines_of(check)
    assert {k: v for k, v in own.items() if k != "YIELD"} == lines_of(
        cqdd("analyse", design, "--json").document
    )
    assert_bench_agrees(cqdd, design, check)
    if seed == 4:
        assert_tolerance_agrees(cqdd, design, check)
        page = tmp_path / "r.html"
        report = cqdd("report", design, "--out", page, "--json").document
        assert report["results"]["verdict"] == check["results"]["verdict"]
        assert report["checks"] == check["checks"]


def test_a_no_ends_in_exit_code_four_with_what_would_change_it(cqdd, paper_design_file):
    done = cqdd("check", paper_design_file)
    assert done.code == 4
    assert too_wide(done.out) == []
    assert "what is not met, and what would change that:" in done.out
    limits = cqdd("check", paper_design_file, "--json").document["results"]["verdict"]["limits"]
    failing = [one for one in limits if one["status"] == "fail"]
    assert failing
    for one in failing:
        assert f"- {one['id']}, " in done.out
        assert one["remedy"]


def test_what_is_not_known_is_one_sentence_with_its_remedy():
    """Some reasons are messages, which end in a full stop."""
    line = build_check(
        "THERMAL-RISE", None, None, "the depth of the slots is not known.", "state it"
    )
    said = binding(SimpleNamespace(limits=(line,), filled=(), costs=()))
    assert "the depth of the slots is not known: state it" in " ".join(said.split())


def test_a_reason_that_many_lines_share_is_told_once():
    wide = "the bearing is too wide; take a narrower one."
    names = ("SHAFT-STRENGTH", "SHAFT-FATIGUE", "SHAFT-STUB")
    cures = ("see why it is not known", "see why it is not known", "name a motor")
    alike = [build_check(one, None, None, wide, two) for one, two in zip(names, cures, strict=True)]
    own = build_check("MOTOR-SPEED", None, None, "no drag", "give it")
    fails = build_check("BEARING-WIDTH", 2.0, 1.0, "2", "lower it")
    said = binding(SimpleNamespace(limits=(alike[0], own, fails, *alike[1:]), filled=(), costs=()))
    words = " ".join(said.split())
    assert words.count("too wide") == 1
    assert "- SHAFT-STRENGTH, SHAFT-FATIGUE, SHAFT-STUB, 3 lines that are not known: the" in words
    assert words.count("no drag: give it") == words.count("lower it") == 1
    assert "see why" not in words
    assert "name a motor" not in words
    assert "-\n" not in said


def test_what_is_not_known_is_no_yes(cqdd, paper_design_file, tmp_path):
    """A motor that nobody measured: lines that name the missing figures, and exit code 4."""
    text = paper_design_file.read_text()
    design = tmp_path / "d.toml"
    design.write_text(text.replace("CubeMars RO100 Lite KV55", "T-Motor U8 KV150"))
    done = cqdd("check", design, "--json")
    assert done.code == 4
    own = lines_of(done.document)
    assert own["MOTOR-DATA"]["status"] == own["MOTOR-BORE"]["status"] == "unknown"
    assert own["MOTOR-BORE"]["limit"] is None
    for words in ("peak torque", "stator bore", "rotor inertia"):
        assert words in own["MOTOR-DATA"]["substituted"]
    shown = cqdd("check", design).out
    assert "UNKNOWN  MOTOR-BORE" in shown
