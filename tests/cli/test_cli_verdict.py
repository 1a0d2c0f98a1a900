"""Every command that says whether a design will do says the same."""

from __future__ import annotations

import pytest


def lines_of(document):
    return {one["id"]: one for one in document["checks"]}


def test_check_report_and_analyse_say_the_same(cqdd, paper_design_file, tmp_path):
    check = cqdd("check", paper_design_file, "--json").document
    report = cqdd("report", paper_design_file, "--out", tmp_path / "r.html", "--json").document
    analyse = cqdd("analyse", paper_design_file, "--json").document
    assert report["checks"] == check["checks"]
    assert report["results"]["verdict"] == check["results"]["verdict"]
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
    page = (tmp_path / "r.html").read_text()
    assert "Does not meet its requirements" in page


@pytest.mark.deep
def test_tolerance_and_bench_agree_with_the_verdict(cqdd, paper_design_file):
    bench = cqdd("bench", paper_design_file, "--json").document
    check = cqdd("check", paper_design_file, "--json").document
    assert bench["results"]["verdict"] == check["results"]["verdict"]
    assert bench["checks"] == check["checks"]
    figures = {one["id"]: one for one in check["results"]["verdict"]["headline"]}
    drawn = cqdd("tolerance", paper_design_file, "--samples", "256", "--json").document
    backlash = drawn["results"]["backlash_arcmin"]["p95"]
    assert figures["backlash_p95"]["value"] == pytest.approx(backlash, rel=1e-9)
    mass = bench["results"]["metrics"]["mass"]["value"]
    assert figures["mass"]["value"] == pytest.approx(mass)


def test_a_no_ends_in_exit_code_four_with_what_would_change_it(cqdd, paper_design_file):
    done = cqdd("check", paper_design_file)
    assert done.code == 4
    assert "what is not met, and what would change that:" in done.out
    limits = cqdd("check", paper_design_file, "--json").document["results"]["verdict"]["limits"]
    failing = [one for one in limits if one["status"] == "fail"]
    assert failing
    for one in failing:
        assert f"- {one['id']}: " in done.out
        assert one["remedy"]


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
