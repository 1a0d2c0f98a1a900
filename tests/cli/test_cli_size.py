"""size: requirements to files, as whole processes."""

import hashlib
import re
import tomllib

import pytest

from cqdd_design.design import Requirements, load_design, requirements_from_mapping
from cqdd_design.design.requirements import LEAST_RATIO, MOST_RATIO
from cqdd_design.roads.sized_file import STAMP, kept_costs, write_fresh
from cqdd_design.sizing import size
from cqdd_design.sizing.infeasible import SizingInfeasibleError
from cqdd_design.sizing.result import Cost
from cqdd_design.sizing.verified import size_to_verdict


@pytest.mark.deep
def test_the_first_command_of_a_newcomer(cqdd, tmp_path):
    done = cqdd("size", "--ratio", "10", "--report", "--export", "dxf")
    assert done.code == 0, done.err
    design = load_design(tmp_path / "designs" / "sized-10.toml")
    assert design.reducer.ratio == 10
    written = {str(p.relative_to(tmp_path)) for p in tmp_path.rglob("*") if p.is_file()}
    assert written == {
        "designs/sized-10.toml",
        "exports/sized-10/sized-10-disc.dxf",
        "exports/sized-10/sized-10-ring.dxf",
        "reports/sized-10.html",
    }
    for path in written:
        assert f"wrote {path}" in done.out
    assert "by what motor and gearbox can do" in " ".join(done.out.split())
    assert "candidates" in done.out
    # What was asked for already is no next step.
    assert done.out.partition("next:\n")[2].splitlines()[0] == (
        "  cqdd-design check designs/sized-10.toml"
    )
    assert "cqdd-design report" not in done.out
    assert "cqdd-design export" not in done.out
    # All checks and what was rejected are told with --verbose.
    assert "rejected first by" not in done.out
    assert max(map(len, done.out.splitlines())) <= 80
    told = re.search(r"sized-10 meets its requirements: of (\d+) lines (\d+) pass", done.out)
    assert told is not None
    assert told[1] == told[2]
    page = (tmp_path / "reports" / "sized-10.html").read_text()
    assert 'class="badge pass">Meets its requirements<' in page
    check = cqdd("check", "designs/sized-10.toml", "--json")
    assert check.code == 0
    # The most that nobody stated is near what the motor reaches, and asked for in the file.
    figures = {one["id"]: one for one in check.document["results"]["verdict"]["headline"]}
    for name in ("peak_torque", "continuous_torque"):
        assert 0.8 * figures[name]["value"] < figures[name]["required"] <= figures[name]["value"]
    text = (tmp_path / "designs" / "sized-10.toml").read_text()
    assert 'continuous_speed = "300 rpm" # assumed' in text
    # What the search alone can tell goes with the design.
    assert re.search(r"# What more would cost:\n# - 10 % more peak torque .+\n", text)
    costs = check.document["results"]["costs"]
    assert len(costs) == 4
    assert costs[0].startswith("10 % more peak torque ")
    assert all(one in page for one in costs)


QUICK = ("size", "--quick", "--ratio", "10")


def test_what_was_rejected_is_told_with_verbose(cqdd):
    assert "rejected first by" not in cqdd(*QUICK).out
    told = cqdd(*QUICK, "--verbose", "--force").out
    assert re.search(r"rejected first by:\n  GEO-\S+ +[\d,]+\n", told)


MILD = (
    *("--ratio", "10", "--discs", "2", "--peak-torque", "40 N*m"),
    *("--continuous-torque", "5 N*m", "--continuous-speed", "300 rpm"),
)


@pytest.mark.deep
def test_size_prints_the_verdict_that_check_gives(cqdd):
    sized = cqdd("size", *MILD, "--json").document
    done = cqdd("check", "designs/sized-10.toml", "--json")
    assert sized["results"]["verdict"] == done.document["results"]["verdict"]
    assert sized["results"]["verdict"]["meets"] == "yes"
    assert sized["checks"] == done.document["checks"]
    assert done.code == 0
    asked = sized["design"]["requirements"]
    assert (asked["peak_torque"], asked["continuous_torque"]) == ("40 N*m", "5 N*m")


@pytest.mark.deep
@pytest.mark.parametrize("goal", ["inertia", "backlash"])
def test_another_objective_makes_that_small(cqdd, goal):
    """Less of it than the lightest design has, which weighs less."""
    asked = ("--peak-torque", "40 N*m", "--continuous-torque", "15 N*m")
    light, other = (
        cqdd(*QUICK, *asked, "--objective", name, "--out", f"{name}.toml", "--json").document
        for name in ("mass", goal)
    )
    by_mass, by_goal = (one["results"]["objective"] for one in (light, other))
    assert by_goal["goal"] == goal
    assert by_goal["mass_kg"] >= by_mass["mass_kg"]
    if goal == "inertia":
        assert by_goal["gearbox_inertia_kgm2"] < by_mass["gearbox_inertia_kgm2"]
    else:
        play = [
            2 * 6e-3 / (10 * one["eccentricity"]) + 16e-3 / one["circle"]
            for one in (
                {
                    "eccentricity": float(reducer["eccentricity"].split()[0]),
                    "circle": float(reducer["output_pins"]["circle_radius"].split()[0]),
                }
                for reducer in (doc["design"]["reducer"] for doc in (light, other))
            )
        ]
        assert play[1] < play[0]


def test_the_objectives_are_the_goals_of_the_search():
    from typing import get_args

    from cqdd_design.cli.size import Objective
    from cqdd_design.sizing.frame import Goal

    assert tuple(one.value for one in Objective) == get_args(Goal)


def test_the_screen_alone_says_that_it_is_no_verdict(cqdd, tmp_path):
    done = cqdd("size", "--quick", "--ratio", "10")
    assert done.code == 0
    assert "no verdict, but the screen by closed forms" in done.out
    assert "meets" not in done.out
    # So does what it writes, and that does not take the place of what was judged.
    own = tmp_path / "designs" / "sized-10.toml"
    first, rest = own.read_text().split("\n", 1)
    assert first.startswith("# No verdict has seen this design")
    body = rest.rpartition("# `size`")[0]
    own.write_text(body + STAMP + hashlib.sha256(body.encode()).hexdigest() + "\n")
    judged = own.read_bytes()
    done = cqdd("size", "--quick", "--ratio", "10")
    assert done.code == 2
    assert "nothing has judged" in done.err
    assert own.read_bytes() == judged
    assert cqdd("size", "--quick", "--ratio", "10", "--force").code == 0
    assert own.read_text().startswith(first)


@pytest.mark.deep
def test_what_no_gearbox_carries_is_refused_by_the_equilibrium():
    """Closed forms allow it; the sentence says what is carried."""
    hard = {
        "ratio": 10, "disc_count": 2, "current": "200 A", "continuous_speed": "300 rpm",
        "peak_torque": "100 N*m", "continuous_torque": "5 N*m",
    }  # fmt: skip
    with pytest.raises(SizingInfeasibleError, match="by the contact equilibrium") as refused:
        size_to_verdict(requirements_from_mapping(hard), best_alone=True)
    assert 40.0 < refused.value.most_torque < 100.0


def test_every_written_value_says_its_origin(cqdd, tmp_path):
    named = ("--motor", "cubemars ro100 kv55", "--outer-diameter", "74 mm")
    assert cqdd("size", "--quick", "--ratio", "10", *named).code == 0
    text = (tmp_path / "designs" / "sized-10.toml").read_text()
    lines = [line for line in text.splitlines() if "=" in line]
    assert lines[0] == "schema_version = 1"
    for line in lines[2:]:
        assert line.rpartition("# ")[2] in {"given", "sized", "assumed"}, line
    assert 'outer_diameter = "74 mm" # given' in text
    assert 'disc_material = "AISI 4140 Q&T 540C" # assumed' in text
    assert tomllib.loads(text)["motor"]["name"] == "CubeMars RO100 KV55"


def test_results_in_json(cqdd):
    document = cqdd("size", "--quick", "--ratio", "10", "--json").document
    results = document["results"]
    assert "verdict" not in results
    assert results["candidates_screened"] >= 200_000
    assert sum(results["rejected"].values()) < results["candidates_screened"]
    assert results["objective"]["mass_kg"] > 0.0
    assert results["alternatives"]
    (file,) = document["files"]
    assert file["path"] == "designs/sized-10.toml"
    assert file["kind"] == "design"
    assert {check["status"] for check in document["checks"]} <= {"pass", "warn"}
    assert "requirements.peak_torque" in document["assumed"]


def test_the_same_answer_every_time(cqdd, tmp_path):
    cqdd("size", "--quick", "--ratio", "10")
    first = (tmp_path / "designs" / "sized-10.toml").read_bytes()
    cqdd("size", "--quick", "--ratio", "10")
    assert (tmp_path / "designs" / "sized-10.toml").read_bytes() == first


def test_a_motor_nobody_named_stays_assumed(cqdd, tmp_path):
    cqdd("size", "--quick", "--ratio", "10")
    assert "motor" not in tomllib.loads((tmp_path / "designs" / "sized-10.toml").read_text())


LOADS = ("--peak-torque", "30 N*m", "--continuous-torque", "6 N*m")


def test_any_motor_by_the_screen_and_an_alternative_of_it(cqdd, tmp_path):
    done = cqdd(*QUICK, *LOADS, "--motor", "Any", "--pick", "d", "--json")
    assert done.code == 0, done.err
    results = done.document["results"]
    found = results["motors"]
    assert found["chosen"] == "CubeMars RO100 Lite KV55"
    assert found["tried_by"] == "closed forms"
    assert found["only_screened"] == ["CubeMars RO100 KV55"]
    missing = {one["motor"]: one["missing"] for one in found["left_out"]}
    assert "depth of the slots" in missing["CubeMars RO80 KV105"]
    assert "verdict" not in results
    text = (tmp_path / "designs" / "sized-10.toml").read_text()
    assert 'motor = "CubeMars RO100 Lite KV55" # sized' in text
    assert done.document["design"]["requirements"]["motor"] == "CubeMars RO100 Lite KV55"
    # The alternative of the most reserve is written under the file's name, and the first beside it.
    assert done.document["design"]["name"] == "sized-10"
    others = {one["name"]: one for one in results["alternatives"]}
    assert "sized-10-d" not in others
    assert results["objective"]["torque_reserve"] > others["sized-10-a"]["torque_reserve"]
    assert results["objective"]["mass_kg"] > others["sized-10-a"]["mass_kg"]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--motor", "any"), "--peak-torque"),
        (("--pick", "x"), "b"),
    ],
)
def test_any_motor_and_pick_that_make_no_sense(cqdd, tmp_path, options, said):
    done = cqdd(*QUICK, *options)
    assert done.code == 2
    assert said in done.err
    assert list(tmp_path.iterdir()) == []


def test_any_motor_and_one_that_a_file_describes_contradict_each_other(cqdd, tmp_path):
    (tmp_path / "mine.toml").write_text('mass = "0.9 kg"\n')
    done = cqdd(*QUICK, *LOADS, "--motor", "any", "--motor-file", "mine.toml")
    assert done.code == 2
    assert "mine.toml describes one; keep one of them" in " ".join(done.err.split())
    assert [one.name for one in tmp_path.iterdir()] == ["mine.toml"]


def test_any_motor_where_none_is_strong_enough(cqdd, tmp_path):
    heavy = ("--peak-torque", "300 N*m", "--continuous-torque", "6 N*m")
    done = cqdd(*QUICK, *heavy, "--motor", "any", "--json")
    assert done.code == 3
    assert "no motor fits" in done.err
    assert "77.16 of 300 N*m" in done.err
    details = done.document["error"]["details"]
    assert details["binding"] == ["MOTOR-PEAK"]
    assert details["motors"]["tried"] == []
    assert list(tmp_path.iterdir()) == []


@pytest.mark.deep
def test_any_motor_ends_in_a_verdict_that_is_yes(cqdd):
    slow = ("--continuous-speed", "300 rpm")
    done = cqdd("size", "--ratio", "10", *LOADS, *slow, "--motor", "any")
    assert done.code == 0, done.err
    told = "is the first by the screen's order whose verdict is yes: 1 tried by the whole verdict"
    folded = " ".join(done.out.split())
    assert f"'CubeMars RO100 Lite KV55' {told}, 1 only screened." in folded
    assert cqdd("check", "designs/sized-10.toml").code == 0


@pytest.mark.deep
def test_any_motor_where_none_holds_the_torque_for_ever(cqdd, tmp_path):
    """Its own drag heats the one and the other at the usual input speed."""
    done = cqdd("size", "--ratio", "10", *LOADS, "--motor", "any", "--json")
    assert done.code == 3
    assert not list(tmp_path.iterdir())
    details = done.document["error"]["details"]
    assert "MOTOR-CONTINUOUS" in details["binding"]
    tried = [one["motor"] for one in details["motors"]["tried"]]
    assert tried == ["CubeMars RO100 Lite KV55", "CubeMars RO100 KV55"]


@pytest.mark.deep
def test_a_picked_alternative_is_judged_and_written_whatever_the_verdict(cqdd, tmp_path):
    loads = ("--peak-torque", "55 N*m", "--continuous-torque", "7 N*m", "--discs", "2")
    asked = ("--ratio", "10", "--continuous-speed", "300 rpm", *loads)
    done = cqdd("size", *asked, "--pick", "c", "--json")
    meets = done.document["results"]["verdict"]["meets"]
    assert done.code == (0 if meets == "yes" else 4)
    assert ("was written all the same" in done.err) == (meets != "yes")
    check = cqdd("check", "designs/sized-10.toml", "--json")
    assert check.code == done.code
    assert check.document["results"]["verdict"] == done.document["results"]["verdict"]
    others = {one["name"][-1] for one in done.document["results"]["alternatives"]} - {"a"}
    missing = min(set("bcd") - others - {"c"})
    lost = cqdd("size", *asked, "--pick", missing, "--out", "other.toml")
    assert lost.code == 2
    assert f"the letters there are: {', '.join(sorted(others | {'c'}))} " in lost.err
    assert not (tmp_path / "other.toml").exists()


def test_motor_that_does_not_exist(cqdd):
    done = cqdd("size", "--quick", "--ratio", "10", "--motor", "CubeMars RO10 KV55")
    assert done.code == 2
    assert "CubeMars RO100 KV55" in done.err


def test_a_named_file_names_the_design_and_is_not_overwritten_without_force(cqdd, tmp_path):
    mine = tmp_path / "knee.toml"
    mine.write_text("precious")
    named = ("size", "--quick", "--ratio", "10", "--out", mine, "--export", "dxf")
    done = cqdd(*named)
    assert done.code == 2
    assert "--force" in done.err
    assert mine.read_text() == "precious"
    assert cqdd(*named, "--force").code == 0
    written = load_design(mine)
    assert (written.name, written.reducer.ratio) == ("knee", 10)
    assert (tmp_path / "exports" / "knee" / "knee-disc.dxf").exists()


@pytest.mark.parametrize(
    "edit",
    [
        lambda text: text.replace('name = "sized-10"', 'name = "sized-10" # ours'),
        pytest.param(lambda text: text + "\n[drive]\nencoder_bits = 16\n", marks=pytest.mark.deep),
        pytest.param(lambda text: "\n".join(text.splitlines()[:-1]) + "\n", marks=pytest.mark.deep),
        pytest.param(lambda text: "not even TOML [", marks=pytest.mark.deep),
    ],
    ids=["a remark", "a key after the stamp", "no stamp", "another file"],
)
def test_an_edited_design_is_not_replaced_without_force(cqdd, tmp_path, edit):
    own = tmp_path / "designs" / "sized-10.toml"
    assert cqdd("size", "--quick", "--ratio", "10").code == 0
    fresh = own.read_text()
    own.write_text(edited := edit(fresh))
    done = cqdd("size", "--quick", "--ratio", "10", "--peak-torque", "60 N*m")
    assert done.code == 2
    assert "edited" in done.err
    assert "--force" in done.err
    assert own.read_text() == edited
    assert cqdd("size", "--quick", "--ratio", "10", "--force").code == 0
    assert own.read_text() == fresh


def test_its_own_output_is_replaced_by_other_requirements(cqdd, tmp_path):
    own = tmp_path / "designs" / "sized-10.toml"
    cqdd("size", "--quick", "--ratio", "10")
    assert cqdd("size", "--quick", "--ratio", "10", "--peak-torque", "60 N*m").code == 0
    assert load_design(own).requirements.peak_torque == 60.0


def test_requirements_from_a_file_with_options_over_it(cqdd, tmp_path):
    (tmp_path / "joint.toml").write_text(
        '[requirements]\nratio = 8\npeak_torque = "30 N*m"\nouter_diameter = "70 mm"\n'
    )
    done = cqdd(
        "size", "--quick", "--requirements", "joint.toml", "--peak-torque", "40 N*m", "--json"
    )
    assert done.code == 0, done.err
    asked = done.document["design"]["requirements"]
    assert asked["ratio"] == 8
    assert asked["peak_torque"] == "40 N*m"
    assert asked["outer_diameter"] == "70 mm"


def test_bad_requirements_file(cqdd, tmp_path):
    (tmp_path / "joint.toml").write_text('[requirements]\nratio = 8\npeak_torque = "30 J"\n')
    done = cqdd("size", "--quick", "--requirements", "joint.toml")
    assert done.code == 3
    assert "joint.toml" in done.err
    assert "not a unit of torque" in done.err


def test_neither_ratio_nor_requirements(cqdd):
    done = cqdd("size")
    assert done.code == 2
    assert "--ratio N or --requirements FILE" in done.err


@pytest.mark.parametrize(
    ("option", "value", "said"),
    [
        ("--peak-torque", "-5 N*m", "0.001 N*m"),
        ("--continuous-torque", "500 N*m", "above peak_torque"),
        ("--discs", "4", "nearest allowed is 3"),
        ("--length", "1 m", "500 mm"),
        ("--input-speed", "9 Hz", "rpm"),
    ],
)
def test_requirement_out_of_range(cqdd, tmp_path, option, value, said):
    done = cqdd("size", "--quick", "--ratio", "10", option, value)
    assert done.code == 2
    assert said in done.err
    assert list(tmp_path.iterdir()) == []


def test_a_surface_as_cold_as_the_air_is_refused_before_any_search(cqdd, tmp_path):
    asked = "size", "--ratio", "10", "--surface-temperature"
    for more, air in (("25 degC",), "25"), (("38 degC", "--ambient", "40 degC"), "40"):
        done = cqdd(*asked, *more)
        assert done.code == 2
        assert f"not above environment.ambient {air} degC" in done.err
    assert not list(tmp_path.rglob("*.toml"))


def test_what_of_a_file_is_not_asked_for_is_told(cqdd, tmp_path):
    """A design for cooler air than the file's would look as if it were for that."""
    path = tmp_path / "asked.toml"
    text = "[requirements]\nratio = 10\npeak_torque = '20 N*m'\n[motor]\nvoltage = '48 V'\n"
    path.write_text(text)
    done = cqdd("size", "--quick", "--requirements", path)
    assert (done.code, "are read, but not" in done.err) == (0, False)
    path.write_text(
        text + "[environment]\nambient = '40 degC'\n[drive]\nthermal_resistance = '1 K/W'\n"
    )
    done = cqdd("size", "--quick", "--requirements", path, "--force")
    assert done.code == 0
    told = " ".join(done.err.split())
    assert "are read, but not [environment], [drive]" in told


def test_the_screen_says_what_it_does_not_judge(cqdd):
    done = cqdd(
        "size", "--ratio", "10", "--peak-torque", "20 N*m", "--quick", "--backlash", "1 arcmin",
        "--mass", "0.5 kg",
    )  # fmt: skip
    assert "not judged by the screen: mass, backlash; `check` judges them." in done.out
    again = cqdd("size", "--ratio", "10", "--peak-torque", "20 N*m", "--quick", "--force")
    assert "not judged" not in again.out


def test_when_nothing_fits(cqdd, tmp_path):
    done = cqdd("size", "--quick", "--ratio", "10", "--outer-diameter", "40 mm", "--json")
    assert done.code == 3
    assert "in a 40 mm ring the most is" in done.err
    assert "bind" in done.err
    error = done.document["error"]
    assert error["code"] == 3
    assert error["details"]["binding"]
    assert 3.0 < error["details"]["most_peak_torque_Nm"] < 8.0
    assert list(tmp_path.iterdir()) == []


def test_help_names_the_ratios_that_requirements_take(cqdd):
    """The help is shown without the models of the design, so it cannot read them."""
    told = " ".join(cqdd("size", "--help").out.split())
    assert f"a whole number from {LEAST_RATIO} to {MOST_RATIO}." in told


def test_costs_are_told_of_the_design_they_were_found_for(tmp_path):
    """Not of a file that was edited since, nor of its design with other requirements."""
    path = tmp_path / "sized.toml"
    design = size(Requirements(ratio=10, peak_torque="30 N*m")).design
    noted = (Cost("life", "twice the life", 2000.0, 3e-3),)
    write_fresh(path, design, {}, noted, judged=True)
    own = load_design(path)
    assert kept_costs(path, own) == ("twice the life +3 g",)
    assert kept_costs(path, own.replacing({"requirements.life": "2 h"})) == ()
    path.write_text(path.read_text().replace("# - twice", "# - thrice"))
    assert kept_costs(path, own) == ()
    assert kept_costs(tmp_path / "none.toml", own) == ()
