"""``torque generate`` and ``torque import`` as commands: files, JSON, exit codes, sentences."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import numpy as np
import pytest
import typer

from cqdd_design.cli import main, session
from cqdd_design.cli.main import run
from cqdd_design.cli.torque_generate import generate
from cqdd_design.cli.torque_import import import_log

pytest.importorskip("pyarrow")

from cqdd_design.torque.data.episodes import read_data

DESIGN = Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml"
SMALL = ("--episodes", "3", "--seconds", "1", "--unit-gearboxes", "0", "--held-mass", "none")
GAINS = ("--position-gain", "60 N*m/rad", "--velocity-gain", "2 N*m*s/rad")
COLUMNS = ("--columns", "time=t,position=q,target=q_des,velocity=dq,torque=tau")


@pytest.fixture(autouse=True)
def torque_commands(monkeypatch, tmp_path):
    """The two commands, whether or not the application has registered its own."""
    app = typer.Typer(rich_markup_mode=None, pretty_exceptions_enable=False)
    group = typer.Typer()
    group.command("generate")(session.command(generate))
    group.command("import")(session.command(import_log))
    app.add_typer(group, name="torque")
    monkeypatch.setattr(main, "app", app)
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def documents(monkeypatch):
    """Every JSON document printed."""
    printed = []
    monkeypatch.setattr(session, "print_result", printed.append)
    return printed


def log(path: Path, seconds=3.0, **changes) -> Path:
    t = np.arange(round(1000 * seconds)) / 1000.0
    q, dq = np.sin(5.0 * t), 5.0 * np.cos(5.0 * t)
    columns = {"t": t, "q": q, "q_des": q + 0.1, "dq": dq, "tau": 6.0 - 2.0 * dq} | changes
    table = np.column_stack(list(columns.values()))
    np.savetxt(path, table, delimiter=",", header=",".join(columns), comments="", fmt="%.12g")
    return path


# generate ---------------------------------------------------------------------------------------


def test_generate_writes_what_it_says_twice_the_same_and_does_not_overwrite(
    documents, capsys, tmp_path
):
    arguments = ["torque", "generate", str(DESIGN), *SMALL, "--json", "--out"]
    assert run([*arguments, "set"]) == 0
    (document,) = map(json.loads, documents)
    data = read_data(tmp_path / "set")
    results = document["results"]
    assert results["sha256"] == data.sha256
    assert results["episodes"] == len(data.episodes) == 3
    assert results["samples"] == 600
    assert results["position_gain_Nm_per_rad"] == data.position_gain == 60.0
    assert [Path(file["path"]).name for file in document["files"]] == ["manifest.json"]
    manifest = json.loads((tmp_path / "set" / "manifest.json").read_text("utf-8"))
    assert manifest["units"]["torque"] == "N m"
    assert manifest["facts"]["training_gearbox"] == 1
    assert manifest["facts"]["held_mass_kg"] is None
    assert run([*arguments, "set"]) == 2
    assert "--force" in capsys.readouterr().err
    for more, same in (((), True), (("--seed", "4"), False)):
        assert run([*arguments, "set", "--force", *more]) == 0
        again = json.loads(documents[-1])["results"]["sha256"]
        assert (again == results["sha256"]) == same


def test_generate_tells_what_cannot_be_followed(documents, capsys):
    arguments = ["torque", "generate", str(DESIGN), *SMALL, "--voltage", "10 V"]
    assert run(arguments) == 0
    told = capsys.readouterr().err
    assert "cannot be followed" in told
    assert "kept and flagged" in told
    shown = "\n".join(documents)
    assert "samples saturated" in shown
    assert "exports/cqdd-10-torque" in shown
    assert Path("exports/cqdd-10-torque/manifest.json").exists()
    assert run(arguments) == 0  # its own output


def test_what_is_met_alone_is_told_alone(documents, capsys):
    """At 14 V all of the short targets could be followed, and some meet the supply."""
    Path("weak.toml").write_text('peak_torque = "2 N*m"\n', "utf-8")
    motor = ("--motor-file", "weak.toml")
    assert run(["torque", "generate", str(DESIGN), *SMALL, "--voltage", "14 V", *motor]) == 0
    told = capsys.readouterr().err
    assert "more than its own peak torque of 2 N*m" in told
    assert re.search(r"warning: \d+ of \d+ episodes saturate the drive", told)
    assert "cannot be followed" not in told


def test_generate_takes_gains_and_a_calibration(documents, tmp_path):
    from cqdd_design.design import load_design

    content = {
        "format": "cqdd-design calibration 1",
        "name": "cqdd-10",
        "design_sha256": load_design(DESIGN).sha256,
        "unknowns": {
            "motor_coulomb": {"value": 0.2, "unit": "N m"},
            "tolerance_scale": {"factor": 5.0},
        },
    }
    (tmp_path / "fit.json").write_text(json.dumps(content), "utf-8")
    more = ("--position-gain", "100 N*m/rad", "--calibration", "fit.json", "--json")
    assert run(["torque", "generate", str(DESIGN), *SMALL, *more, "--out", "set"]) == 0
    data = read_data(tmp_path / "set")
    assert data.position_gain == 100.0
    assert data.facts["calibration"] == {"motor_coulomb": 0.2}
    assert any("tolerance_scale" in text for text in json.loads(documents[0])["warnings"])


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (("--held-mass", "1.14 kg"), "hold nothing back"),
        (("--held-mass", "1.7"), "--held-mass"),
        (("--held-mass", "-1 kg"), "not above zero"),
        (("--seconds", "0"), "no sample"),
        (("--seconds", "nan"), "no sample"),
        (("--seconds", "1000000"), "use --seconds"),
        (("--voltage", "0 V"), "not above zero"),
        (("--position-gain", "-60 N*m/rad"), "must be 0 or more"),
        (("--episodes", "0"), "--episodes"),
        (("--unit-gearboxes", "-1"), "--unit-gearboxes"),
        (("--calibration", "none.json"), "cannot read"),
    ],
)
def test_generate_refuses_what_makes_no_sense(options, told, capsys):
    few = ("--episodes", "1", "--unit-gearboxes", "0")
    assert run(["torque", "generate", str(DESIGN), *few, *options, "--out", "set"]) == 2
    assert told in capsys.readouterr().err
    assert not Path("set").exists()


# import -----------------------------------------------------------------------------------------


def test_import_writes_the_same_kind_of_set(documents, tmp_path, capsys):
    truth = np.arange(4000) / 1000.0
    keep = np.r_[0:2000, 2500:4000]
    q, dq = np.sin(5.0 * truth[keep]), 5.0 * np.cos(5.0 * truth[keep])
    log(tmp_path / "a.csv", 3.5, t=truth[keep], q=q, dq=dq, q_des=q + 0.1)
    more = ("--group", "mass=1.14,rig=left", "--out", "set", "--json")
    code = run(["torque", "import", "a.csv", *COLUMNS, *GAINS, *more])
    told = capsys.readouterr().err
    assert code == 0, told
    results = json.loads(documents[0])["results"]
    assert results["gaps"] == [
        {"log": "a.csv", "begin_s": pytest.approx(1.999), "seconds": pytest.approx(0.501)}
    ]
    assert "nothing for 0.501 s" in told
    data = read_data(tmp_path / "set")
    assert [one.name for one in data.episodes] == ["a-000", "a-001"]
    assert data.episodes[0].group["mass"] == 1.14
    assert data.episodes[0].group["rig"] == "left"
    assert data.velocity_gain == 2.0


def test_import_reads_a_map_and_options_go_before_it(documents, tmp_path):
    t = np.arange(3000) / 1000.0
    log(tmp_path / "a.csv", q=np.degrees(np.sin(5.0 * t)), q_des=np.degrees(np.sin(5.0 * t)) + 6.0)
    lines = ["[columns]", 'time = "t"', 'position = "q"', 'target = "q_des"', 'velocity = "dq"']
    lines += ['torque = "tau"', "[units]", 'position = "deg"', 'target = "rad"']
    (tmp_path / "map.toml").write_text("\n".join(lines), "utf-8")
    more = ("--map", "map.toml", "--units", "target=deg", "--rate", "100 Hz")
    assert run(["torque", "import", "a.csv", *more, *GAINS, "--json"]) == 0
    data = read_data(tmp_path / "exports" / "torque-logs")
    assert data.dt == pytest.approx(0.01)
    assert np.abs(data.episodes[0].columns["position"]).max() == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ((*COLUMNS, "--position-gain", "-60 N*m/rad"), "turn the log's signs"),
        ((*COLUMNS, "--units", "velocity=deg/s"), "0.01745 times"),
        (
            (*COLUMNS, "--units", "time=min"),
            "60 times the derivative of position, which looks like other",
        ),
        ((*COLUMNS, "--units", "positon=deg"), "did you mean 'position'"),
        ((*COLUMNS, "--units", "position=mm"), "unit of position"),
        (("--columns", "position=q"), "no column for target"),
        (("--columns", "position"), "not of the form A=B"),
        (("--columns", "position=q,position=r"), "twice"),
        (("--columns", "time=t,position=q,target=q_des,velocity=dq,torque=taux"), "'taux'"),
        ((*COLUMNS, "--dt", "2 ms"), "not 0.002 s"),
        ((*COLUMNS, "--rate", "2 kHz"), "slower than"),
        ((*COLUMNS, "--map", "none.toml"), "cannot read none.toml"),
    ],
)
def test_import_refuses_what_contradicts_itself(options, told, tmp_path, capsys):
    log(tmp_path / "a.csv")
    given = options if "--position-gain" in options else (*options, *GAINS[:2])
    assert run(["torque", "import", "a.csv", *given, *GAINS[2:], "--out", "set"]) == 2
    assert told in capsys.readouterr().err
    assert not Path("set").exists()


def test_import_refuses_nan_by_its_line(tmp_path, capsys):
    t = np.arange(3000) / 1000.0
    torque = np.where(t == 0.5, math.nan, 1.0)
    log(tmp_path / "a.csv", tau=torque)
    assert run(["torque", "import", "a.csv", *COLUMNS, *GAINS]) == 2
    assert "line 502: tau is nan" in capsys.readouterr().err
