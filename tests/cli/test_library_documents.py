"""A call and the command of the same name say the same document."""

import inspect
from pathlib import Path

import pytest

import cqdd_design as cq
from cqdd_design.errors import UsageError

DESIGN = Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml"


def same(document, result):
    """Whether they are, but for the moment when they were made."""
    told = result.to_dict()
    for one in (document, told):
        one["provenance"].pop("time")
    assert told == document


@pytest.mark.deep
def test_analyse(cqdd):
    done = cqdd("analyse", DESIGN, "--angles", "24", "--json")
    same(done.document, cq.analyse(DESIGN, angles=24))


def test_compare(cqdd):
    document, beside = cqdd("compare", DESIGN, "--json").document, cq.compare(DESIGN)
    planetary = document["results"]["planetary"]
    told = repr(beside).splitlines()
    assert told[1] == f"  planets that fit: {planetary['planets_that_fit']} at most"
    assert told[3].endswith(f"contact: {planetary['planets_needed_peak_contact']}")
    assert len(beside.to_pandas()) == len(planetary["by_planets"])
    same(document, beside)


@pytest.mark.deep
def test_compare_with_settings(cqdd):
    done = cqdd("compare", DESIGN, "--teeth", "12,36,22,70", "--life-hours", "2000", "--json")
    same(done.document, cq.compare(DESIGN, teeth=(12, 36, 22, 70), settings={"life_hours": 2000.0}))


@pytest.mark.deep
def test_check(cqdd):
    same(cqdd("check", DESIGN, "--json").document, cq.check(DESIGN))


@pytest.mark.deep
def test_inertia(cqdd):
    document, weighed = cqdd("inertia", DESIGN, "--json").document, cq.inertia(DESIGN)
    results, parts = document["results"], weighed.to_pandas()
    assert f"  mass: {results['total_mass_kg']:.4g} kg" in repr(weighed).splitlines()
    at_output = f"{results['reflected_inertia_output_kgm2']:.4g} kg*m^2"
    assert f"  inertia at the output: {at_output}" in repr(weighed).splitlines()
    assert list(parts.mass_kg) == [part["mass_kg"] for part in results["parts"]]
    same(document, weighed)


@pytest.mark.deep
def test_size(cqdd, tmp_path):
    done = cqdd("size", "--ratio", "10", "--peak-torque", "30 N*m", "--quick", "--json")
    document = done.document
    assert document["files"].pop()["path"].endswith("sized-10.toml")
    found = cq.size(10, peak_torque="30 N*m", quick=True)
    same(document, found)
    assert list(found.to_pandas().mass_kg)[1:] == [
        one["mass_kg"] for one in document["results"]["alternatives"]
    ]
    page = found._repr_html_()
    assert "Designs of the screen" in page
    assert "toleranced gearboxes until all agreed" not in page
    path = tmp_path / "knee.toml"
    written = cq.size(10, peak_torque="30 N*m", quick=True, out=path)
    assert written.files[0].path == path
    assert written.design.name == "knee"
    assert written.design.reducer == found.design.reducer
    assert cq.load(path).sha256 == written.design.sha256
    with pytest.raises(UsageError, match="force=True"):
        cq.size(10, quick=True, out=path)


def test_simulate(cqdd, tmp_path):
    words = ("--load", "pendulum", "--mass", "1 kg", "--duration", "30 ms", "--frequency", "5 Hz")
    done = cqdd("simulate", DESIGN, *words, "--out", tmp_path / "a.npz", "--json")
    run = cq.simulate(
        DESIGN,
        load="pendulum",
        mass="1 kg",
        duration="30 ms",
        frequency="5 Hz",
        out=tmp_path / "b.npz",
    )
    document, told = done.document, run.to_dict()
    assert [one["bytes"] for one in document["files"]] == [one["bytes"] for one in told["files"]]
    assert told["results"] == document["results"]
    assert told["warnings"] == document["warnings"]


def test_tolerance(cqdd):
    words = ("--samples", "4", "--angles", "110", "--seed", "7", "--json")
    document = cqdd("tolerance", DESIGN, *words).document
    drawn = cq.tolerance(DESIGN, samples=4, angles=110, seed=7)
    backlash = document["results"]["backlash_arcmin"]
    shown = f"  backlash_arcmin: {backlash['p50']:.4g} in the middle, {backlash['p95']:.4g} of 95 %"
    assert shown in repr(drawn).splitlines()
    told = drawn.to_dict()
    for one in (document, told):
        one["results"].pop("seconds")
        one["provenance"].pop("time")
    assert told == document


def test_export(cqdd, tmp_path):
    document = cqdd("export", DESIGN, "--to", "dxf", "--out", tmp_path / "a", "--json").document
    told = cq.export(DESIGN, ["dxf"], out=tmp_path / "b").to_dict()
    for one in (document, told):
        one["files"] = [(Path(file["path"]).name, file["sha256"]) for file in one["files"]]
        one["provenance"].pop("time")
    assert told == document


@pytest.mark.deep
def test_bench_of_one_row(cqdd):
    document = cqdd("bench", DESIGN, "--only", "output_resolution", "--json").document
    told = cq.bench(DESIGN, only=["output_resolution"]).to_dict()
    for one in (document, told):
        one["results"].pop("seconds")
        one["provenance"].pop("time")
    assert told == document


def test_every_call_has_the_options_of_its_command():
    """Under the same names, but those that are of files, of motors and duties, or of printing."""
    from cqdd_design.cli.main import COMMANDS

    loaded = {"motor", "motor_file", "duty", "duty_columns"}
    rating = {
        *("settings", "material_quality", "accuracy_class", "application_factor"),
        *("mesh_load_table", "lubricant_viscosity", "life_hours", "peak_cycles"),
        *("least_contact_safety", "least_bending_safety", "shifts"),
    }
    elsewhere = {
        "analyse": loaded | {"law"},
        "bench": loaded | {"folder"},
        "calibrate": loaded | {"path"},
        "check": loaded,
        "compare": loaded | rating,
        "export": loaded | {"folder", "workers"},
        "inertia": loaded,
        "report": loaded | {"target"},
        "tolerance": set(),
    }
    commands = {function.__name__: function for function in COMMANDS}
    for name, left in elsewhere.items():
        options = set(inspect.signature(commands[name]).parameters) - {"out", "design"} - left
        own = set(inspect.signature(getattr(cq, name)).parameters) - {"design"}
        assert own - {"progress", "out", "contact_law", "settings"} == options, name
    assert loaded == set(inspect.signature(cq.load).parameters) - {"design"}
