"""`bench` and `calibrate` as real processes: fixed names, files, and what they refuse."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from actuator_samples import paper_actuator
from terminal_lines import too_wide

from cqdd_design.actuator.bench import METRICS, BenchResult, run_bench
from cqdd_design.actuator.bench.calibrate import Calibration, Row
from cqdd_design.actuator.bench.metric import Metric
from cqdd_design.actuator.bench.unknowns import Fit
from cqdd_design.catalog.paper import METRICS as PAPER
from cqdd_design.cli.bench import _lines
from cqdd_design.cli.calibrate import _lines as calibrated_lines
from cqdd_design.cli.main import run
from cqdd_design.report.actuator.bench_table import bench_row

REPOSITORY = Path(__file__).resolve().parents[2]
DESIGN = str(REPOSITORY / "designs" / "cqdd-10.toml")
FIXED = {
    "continuous_torque", "peak_torque", "no_load_speed", "rated_power", "output_resolution",
    "efficiency_peak", "torque_density", "actuator_inertia", "mass", "backlash",
    "backdrive_static", "backdrive_dynamic", "torque_ripple", "torque_bandwidth",
    "position_bandwidth_45deg", "position_bandwidth_5deg",
}  # fmt: skip
RELATIONS = {"given", "calibrated", "predicted", "not comparable"}


@pytest.mark.deep
def test_bench_measures_every_row_and_writes_its_traces(cqdd, tmp_path):
    found = cqdd("bench", DESIGN, "--json", "--out", str(tmp_path / "traces"))
    assert found.code == 0
    results = found.document["results"]
    metrics = results["metrics"]
    assert set(metrics) >= FIXED
    for name, metric in metrics.items():
        assert metric["relation"] in RELATIONS, name
        assert metric["protocol"].endswith("."), name
        assert metric["paper"] > 0.0
    assert metrics["stall_torque"]["paper"] == 89.9
    assert metrics["stall_torque"]["relation"] == "predicted"
    columns = {one["name"]: one["torque_density_Nm_per_kg"] for one in results["comparison"]}
    assert columns["Lee et al."] == pytest.approx(83.96, abs=0.005)
    assert columns["cqdd-10 (this design)"] == pytest.approx(metrics["torque_density"]["value"])
    written = {Path(file["path"]).name for file in found.document["files"]}
    assert "cqdd-10-torque-bandwidth.npz" in written
    with np.load(tmp_path / "traces" / "cqdd-10-torque-bandwidth.npz") as trace:
        assert {"frequency [Hz]", "gain", "phase [rad]", "coherence"} == set(trace.files)
        details = metrics["torque_bandwidth"]["details"]
        edge, sure = details["gain_falls_by_3_dB_Hz"], details["coherence_falls_below_0.8_Hz"]
        gain = np.interp(edge, trace["frequency [Hz]"], trace["gain"])
    assert gain / details["low_frequency_gain"] == pytest.approx(10.0**-0.15, rel=1e-6)
    # A bandwidth is read only where the coherence holds.
    value, missing = (metrics["torque_bandwidth"].get(key) for key in ("value", "missing"))
    assert (value, missing is None) == ((edge, True) if edge <= sure else (None, False))
    assert (missing is None) == (not any("coherence" in one for one in found.document["warnings"]))


def test_bench_says_what_an_agreement_is(cqdd):
    found = cqdd("bench", DESIGN, "--only", "mass,peak_torque,no_load_speed", "--voltage", "48 V")
    assert found.code == 0
    lines = {line.split("  ")[0]: line.split() for line in found.out.splitlines() if line}
    assert lines["mass"][-1] == "predicted"
    assert lines["peak torque"][-1] == "given"
    # Twice the voltage, about twice the paper's speed at 24 V.
    assert 255.0 < float(lines["no-load speed"][2]) < 270.0
    assert "actuator  " not in found.out


def test_measurements_are_told_in_words_and_kept_under_names():
    """What people read has no key in it, is aligned, fits 80 columns, and is what the page says."""
    metrics = tuple(
        Metric(name, 1.07 * PAPER[name].value, "predicted", "Told.", remark="so")
        for name in METRICS
    )
    result = BenchResult("some", metrics, True, 24.0, 1.0)
    said = "\n".join(_lines(result))
    assert "_" not in said
    assert too_wide(said) == []
    title, line, *rows = said.partition("\n\n")[0].splitlines()
    first, value = (len(dashes) for dashes in line.split("  ")[:2])
    names: list[str] = []
    for row in rows:
        # What is folded goes on below, indented.
        if row.startswith(" "):
            names[-1] += f" {row[:first].strip()}"
        else:
            names.append(row[:first].strip())
            assert row[first:].startswith("  ")
            assert float(row[first : first + 2 + value])
            assert row.endswith("+7.0  predicted")
    assert names == [bench_row(one, result)["words"] for one in metrics]
    assert len(set(names)) == len(METRICS)
    assert title.split() == [
        "measurement",
        "value",
        "spread",
        "unit",
        "paper",
        "off",
        "%",
        "row",
        "is",
    ]


def test_warnings_of_the_bench_are_in_words():
    """A measurement without a value is called in its warning as in the table."""
    found = run_bench(paper_actuator(), only=("rated_power",))
    assert found.metrics == ()
    assert found.warnings[0].startswith("rated electrical power: the motor's catalogue gives no")


@pytest.mark.deep
def test_calibration_goes_from_one_command_into_the_others(cqdd, tmp_path):
    measured = tmp_path / "rig.csv"
    measured.write_text("name,value,unit\nbackdrive_static,2200,mN*m\nno_load_speed,13.5,rad/s\n")
    path = tmp_path / "fit.json"
    found = cqdd("calibrate", DESIGN, "--measured", str(measured), "--out", str(path), "--json")
    assert found.code == 0
    rows = found.document["results"]["rows"]
    assert rows["backdrive_static"]["relation"] == "calibrated"
    assert rows["backdrive_static"]["after"] == pytest.approx(2.2, rel=1e-3)
    assert found.document["results"]["predicted"] == ["no_load_speed"]
    again = cqdd(
        "bench", DESIGN, "--only", "backdrive_static", "--calibration", str(path), "--json"
    )
    value = again.document["results"]["metrics"]["backdrive_static"]["value"]
    assert value == pytest.approx(2.2, rel=1e-3)
    assert again.document["results"]["metrics"]["backdrive_static"]["relation"] == "calibrated"
    out = tmp_path / "card"
    cqdd("export", DESIGN, "--to", "card", "--calibration", str(path), "--out", str(out))
    assert "calibrated: motor_cogging" in (out / "cqdd-10-card.md").read_text()
    file = tmp_path / "run.npz"
    run = cqdd(
        "simulate", DESIGN, "--duration", "0.1 s", "--calibration", str(path), "--out", str(file)
    )
    assert run.code == 0
    assert "kept in" not in path.read_text()
    assert json.loads(path.read_text())["unknowns"]["motor_cogging"]["value"] < 0.05


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["bench", DESIGN, "--only", "backlsh"], "did you mean 'backlash'"),
        pytest.param(
            ["bench", DESIGN, "--voltage", "0 V"], "not above zero", marks=pytest.mark.deep
        ),
        (["bench", DESIGN, "--voltage", "24"], "has no unit"),
        (["bench", DESIGN, "--beside", "Some Motor"], "no motor 'Some Motor'"),
        (["bench", DESIGN, "--beside", "CubeMars RO100 KV55"], "geared"),
        (["bench", DESIGN, "--calibration", "none.json"], "cannot read none.json"),
        pytest.param(
            ["calibrate", DESIGN, "--to", "mass"], "decides no unknown", marks=pytest.mark.deep
        ),
        (["calibrate", DESIGN, "--measured", "none.csv"], "cannot read none.csv"),
        pytest.param(
            ["calibrate", DESIGN, "--unknowns", "fricton_load"],
            "did you mean 'friction_load'",
            marks=pytest.mark.deep,
        ),
    ],
)
def test_wrong_usage(arguments, says, capfd):
    assert run(arguments) in (2, 3)
    told = capfd.readouterr().err
    assert says in " ".join(told.split())
    assert "Traceback" not in told


@pytest.mark.parametrize(
    ("old", "new", "beside"),
    [
        ('name = "cqdd-10"', 'name = "a copy"', True),
        ('eccentricity = "1.6 mm"', 'eccentricity = "1.5 mm"', False),
    ],
)
def test_the_papers_actuator_is_known_by_what_it_is(cqdd, old, new, beside, tmp_path):
    file = tmp_path / "design.toml"
    file.write_text(Path(DESIGN).read_text("utf-8").replace(old, new, 1), "utf-8")
    found = cqdd("bench", str(file), "--only", "mass", "--json")
    paper = found.document["results"]["metrics"]["mass"]["paper"]
    assert paper == (1.4 if beside else None)


def test_designs_without_measurements_say_so(tmp_path, capfd):
    other = tmp_path / "other.toml"
    text = (REPOSITORY / "designs" / "cqdd-10.toml").read_text()
    text = text.replace('eccentricity = "1.6 mm"', 'eccentricity = "1.5 mm"', 1)
    other.write_text(text.replace('name = "cqdd-10"', 'name = "mine"', 1))
    assert run(["calibrate", str(other)]) == 2
    assert "no measured values of mine" in " ".join(capfd.readouterr().err.split())


@pytest.mark.parametrize(
    ("motor", "says"),
    [
        ("CubeMars AK10-9 V2 KV60", "geared actuator"),
        ("no such motor", "no motor"),
    ],
)
def test_motors_that_cannot_be_simulated(motor, says, tmp_path, capfd):
    other = tmp_path / "other.toml"
    text = (REPOSITORY / "designs" / "cqdd-10.toml").read_text()
    other.write_text(text.replace("CubeMars RO100 Lite KV55", motor))
    assert run(["bench", str(other)]) == 3
    assert says in " ".join(capfd.readouterr().err.split())


@pytest.mark.deep
def test_like_names_of_unlike_figures_are_told_apart(cqdd, paper_design_file):
    """Its continuous torque is of a standing output, that of the verdict for ever at speed."""
    done = cqdd("bench", paper_design_file)
    lines = done.out.splitlines()
    standing = next(line for line in lines if line.startswith("continuous torque,"))
    verdict = next(line for line in lines if " continuous torque " in line)
    (value, *_) = re.findall(r"[0-9.]+", standing)
    lasting = re.search(r" continuous torque at 1286 rpm +([0-9.]+) ", verdict)
    assert lasting
    assert float(value) != float(lasting[1])
    words = " ".join(done.out.split())
    assert "continuous torque, standing, is of an output at rest, the continuous torque" in words
    assert too_wide(done.out) == []


@pytest.mark.parametrize(
    ("measured", "told"),
    [
        (None, "No measured row is left to tell how well the others are predicted."),
        (2.0, "1 of 1 predicted rows are within 20 % (efficiency: 5 points): mass."),
    ],
)
def test_a_fit_to_all_that_was_measured_predicts_nothing_that_could_be_judged(measured, told):
    row = Row("mass", "kg", measured, 2.1, 2.1, "predicted")
    bench = BenchResult("a", (), beside_paper=False, voltage=24.0, seconds=0.0)
    found = Calibration(paper_actuator(), Fit({}, ()), (row,), bench, {})
    assert told in " ".join(calibrated_lines(found))
