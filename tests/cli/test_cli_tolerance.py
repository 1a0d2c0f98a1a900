"""``tolerance`` and the contact part of ``analyse`` as processes: text, JSON, errors, Ctrl-C."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from terminal_lines import too_wide

from cqdd_design.gearbox.checks.allowables import YIELD_SAMPLES

DESIGN = Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml"
OUTPUTS = (
    "backlash_arcmin",
    "transmission_error_pp_arcmin",
    "ring_force_max_N",
    "stiffness_Nm_per_arcmin",
    "torque_ripple_pp_Nm",
)


def changed(tmp_path: Path, old: str, new: str) -> str:
    text = DESIGN.read_text(encoding="utf-8")
    assert old in text
    path = tmp_path / "d.toml"
    path.write_text(text.replace(old, new), encoding="utf-8")
    return str(path)


def test_the_document_has_what_others_read(cqdd) -> None:
    done = cqdd("tolerance", str(DESIGN), "--samples", "160", "--angles", "88", "--json")
    assert done.code == 0, done.err
    results = json.loads(done.out)["results"]
    for name in OUTPUTS:
        told = results[name]
        assert set(told) == {"mean", "std", "p5", "p50", "p95", "p99"}
        assert told["p5"] <= told["p50"] <= told["p95"] <= told["p99"]
        shares = results["sensitivity"][name]
        assert set(shares) == {
            key for key in json.loads(done.out)["design"]["tolerances"] if key != "distribution"
        }
        assert all(isinstance(value, float) for value in shares.values())
    assert results["samples"] == 160
    assert results["solves"] > 160 * 88
    assert results["seconds"] > 0.0


@pytest.mark.deep
def test_the_same_seed_gives_the_same_and_another_another(cqdd) -> None:
    def told(seed: str) -> object:
        done = cqdd(
            "tolerance", str(DESIGN), "--samples", "5", "--angles", "44", "--seed", seed, "--json"
        )
        return json.loads(done.out)["results"]["backlash_arcmin"]

    assert told("3") == told("3")
    assert told("3") != told("4")


def test_people_get_a_table_and_a_ranking(cqdd) -> None:
    done = cqdd("tolerance", str(DESIGN), "--samples", "128", "--angles", "44")
    assert done.code == 0
    assert too_wide(done.out) == []
    assert "backlash, arcmin" in done.out
    assert "5 %" in done.out
    assert "95 %" in done.out
    assert "which tolerance it comes from" in done.out
    assert "of 128" not in done.out
    assert len(done.err.splitlines()) <= 12


@pytest.mark.deep
def test_the_backlash_of_the_verdict_is_that_of_as_many_gearboxes(cqdd) -> None:
    """Of 1000 gearboxes it is another number, and said to be."""
    judged = cqdd("check", str(DESIGN), "--json").document["results"]["verdict"]["headline"]
    backlash = next(one["value"] for one in judged if one["id"] == "backlash_p95")
    words = f"backlash of {YIELD_SAMPLES} gearboxes: --samples {YIELD_SAMPLES} --seed 0 draws"
    same = cqdd("tolerance", str(DESIGN), "--samples", str(YIELD_SAMPLES))
    assert f" {backlash:.4g} " in next(one for one in same.out.splitlines() if "backlash" in one)
    assert words not in " ".join(same.out.split())
    assert words in " ".join(cqdd("tolerance", str(DESIGN), "--samples", "20").out.split())


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (("--samples", "0"), 2, "samples"),
        (("--samples", "-3"), 2, "samples"),
        (("--samples", "many"), 2, "samples"),
        (("--angles", "7"), 2, "angles"),
        (("--angles", "99999999"), 2, "--angles"),
        (("--torque", "0 N*m"), 2, "--torque"),
        (("--torque", "40"), 2, "N*m"),
        (("--seed", "-1"), 2, "seed"),
        (("--torque", "1e9 N*m"), 3, "N*m"),
    ],
)
def test_bad_values_are_refused(cqdd, arguments: tuple[str, ...], code: int, words: str) -> None:
    done = cqdd("tolerance", str(DESIGN), *arguments)
    assert done.code == code, done.err
    assert words in done.err
    assert "Traceback" not in done.err


@pytest.mark.deep
def test_a_wrong_scheduler_is_told_and_not_waited_for(cqdd) -> None:
    pytest.importorskip("distributed")
    wrong = ("--scheduler", "tcp://127.0.0.1:1", "--samples", "5")
    done = cqdd("tolerance", str(DESIGN), *wrong, timeout=60.0)
    assert done.code == 2
    assert "no Dask scheduler at tcp://127.0.0.1:1" in done.err


def test_without_dask_it_says_what_to_install(tmp_path: Path) -> None:
    (tmp_path / "distributed.py").write_text("raise ImportError('none')\n", encoding="utf-8")
    done = subprocess.run(
        [
            sys.executable, "-m", "cqdd_design", "tolerance", str(DESIGN),
            "--scheduler", "tcp://127.0.0.1:1",
        ],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
    )  # fmt: skip
    assert done.returncode == 5
    assert 'pip install "cqdd-design[sweep]"' in done.stderr


def test_ctrl_c_keeps_what_is_done(cqdd) -> None:
    cqdd("tolerance", str(DESIGN), "--samples", "1", "--angles", "44")  # compiled from here on
    process = subprocess.Popen(
        [sys.executable, "-m", "cqdd_design", "tolerance", str(DESIGN), "--samples", "3000",
         "--angles", "44", "--json"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )  # fmt: skip
    assert process.stderr is not None
    assert any(" gearboxes" in line for line in process.stderr)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=120)
    assert process.returncode == 130, err
    results = json.loads(out)["results"]
    assert results["interrupted"] is True
    assert 0 < results["samples"] < 3_000
    assert results["backlash_arcmin"]["std"] > 0.0
    assert "Traceback" not in err


# ------------------------------------------------------------------ analyse


def test_analyse_gives_contact_precision_losses_and_life(cqdd) -> None:
    done = cqdd("analyse", str(DESIGN), "--torque", "40 N*m", "--angles", "24", "--json")
    assert done.code == 0, done.err
    results = json.loads(done.out)["results"]
    contact = results["contact"]
    assert len(contact["crank_angle_deg"]) == 24
    shape = (24, 2)
    for key, last in (
        ("ring_force_N", (11,)),
        ("ring_normal", (11, 2)),
        ("ring_point_mm", (11, 2)),
        ("output_pin_force_N", (5,)),
        ("output_pin_normal", (5, 2)),
        ("output_pin_point_mm", (5, 2)),
        ("cam_force_N", (2,)),
        ("disc_centre_mm", (2,)),
        ("disc_displacement_um", (3,)),
    ):
        assert _shape(contact[key]) == shape + last, key
    assert len(contact["carrier_angle_error_arcmin"]) == 24
    assert sum(contact["disc_torque_share"]) == pytest.approx(1.0)
    precision = results["precision"]
    assert precision["backlash_min_arcmin"] <= precision["backlash_arcmin"]
    assert precision["backlash_arcmin"] <= precision["backlash_max_arcmin"]
    assert precision["orders"][0]["name"].startswith(("teeth", "pins"))
    assert 0.0 < results["losses"]["efficiency_backward"] < results["losses"]["efficiency_forward"]
    assert results["life"]["parts"]
    _balances(contact)


def _shape(values: object) -> tuple[int, ...]:
    found = []
    while isinstance(values, list):
        found.append(len(values))
        values = values[0]
    return tuple(found)


def _balances(contact: dict[str, list]) -> None:
    """Forces and moments of every disc from nothing but the document."""
    for angle in range(len(contact["crank_angle_deg"])):
        for disc in range(2):
            x = y = moment = load = 0.0
            cx, cy = contact["disc_centre_mm"][angle][disc]
            for kind in ("ring", "output_pin"):
                forces = contact[f"{kind}_force_N"][angle][disc]
                along = contact[f"{kind}_tangential_N"][angle][disc]
                normals = contact[f"{kind}_normal"][angle][disc]
                points = contact[f"{kind}_point_mm"][angle][disc]
                for force, rub, (nx, ny), (px, py) in zip(
                    forces, along, normals, points, strict=True
                ):
                    # Friction acts along the normal turned a quarter turn counter-clockwise.
                    own_x, own_y = force * nx - rub * ny, force * ny + rub * nx
                    x, y = x + own_x, y + own_y
                    moment += (px - cx) * own_y - (py - cy) * own_x
                    load = max(load, force)
            fx, fy = contact["cam_force_N"][angle][disc]
            assert abs(x + fx) < 1e-9 * load
            assert abs(y + fy) < 1e-9 * load
            assert abs(moment) < 1e-9 * load * 32.0


@pytest.mark.deep
def test_interference_is_told_as_preload(cqdd, tmp_path: Path) -> None:
    design = changed(tmp_path, 'equidistant = "6 um"', 'equidistant = "-6 um"')
    done = cqdd("analyse", design, "--angles", "24", "--json")
    assert done.code == 0, done.err
    document = json.loads(done.out)
    assert document["results"]["contact"]["preload"]["ring_force_max_N"] > 100.0
    # The teeth are pressed; the pins keep some of their play.
    assert 0.5 < document["results"]["precision"]["backlash_arcmin"] < 3.0
    assert any("preloaded" in sentence for sentence in document["warnings"])


@pytest.mark.parametrize(
    ("torque", "kept"),
    [pytest.param("0.01 N*m", True, marks=pytest.mark.deep), ("9e4 N*m", False)],
)
def test_any_torque_gives_an_answer_or_says_why(cqdd, torque: str, kept: bool) -> None:
    done = cqdd("analyse", str(DESIGN), "--torque", torque, "--json")
    assert done.code == 0, done.err
    document = json.loads(done.out)
    assert (document["results"]["contact"] is not None) is kept
    if not kept:
        assert any("no contact analysis" in sentence for sentence in document["warnings"])
    beyond = cqdd("analyse", str(DESIGN), "--torque", "1e9 N*m")
    assert beyond.code == 2
    assert "--torque: 1000000000 N*m is outside" in beyond.err


def test_teeth_that_do_not_reach_are_told(cqdd, tmp_path: Path) -> None:
    design = changed(tmp_path, 'equidistant = "6 um"', 'equidistant = "450 um"')
    done = cqdd("analyse", design, "--json")
    assert done.code in (0, 3)
    assert "Traceback" not in done.err
    if done.code == 0:
        document = json.loads(done.out)
        assert document["results"]["contact"] is None
        assert any("do not reach" in sentence for sentence in document["warnings"])


def test_a_thousand_lobes_are_refused(cqdd, tmp_path: Path) -> None:
    design = changed(
        tmp_path, "ratio = 10                        # paper: 10 lobes", "ratio = 1000 #"
    )
    done = cqdd("analyse", design)
    assert done.code == 3
    assert "1000" in done.err
