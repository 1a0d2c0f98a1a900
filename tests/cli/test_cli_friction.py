"""`analyse --friction`: what it changes, what it leaves, and what it refuses."""

import numpy as np
import pytest


def told(cqdd, design, *options):
    done = cqdd("analyse", design, "--torque", "40 N*m", "--angles", "24", *options, "--json")
    assert done.code == 0, done.err
    return done.document["results"]


@pytest.mark.deep
@pytest.mark.parametrize("sense", ["drive", "backdrive"])
def test_friction_changes_forces_precision_and_life(cqdd, paper_design_file, sense):
    without = told(cqdd, paper_design_file, "--friction", "off")
    rubbed = told(cqdd, paper_design_file, "--friction", sense)
    same = set(rubbed) - {"contact", "precision", "life", "bending", "bodies"}
    assert {key: rubbed[key] for key in same} == {key: without[key] for key in same}
    contact, plain = rubbed["contact"], without["contact"]
    assert (contact["friction"], plain["friction"]) == (sense, "off")
    for kind in ("ring", "output_pin"):
        along = np.asarray(contact[f"{kind}_tangential_N"])
        pressed = np.asarray(contact[f"{kind}_force_N"])
        assert np.abs(np.abs(along) - 0.08 * pressed).max() < 1e-9 * pressed.max()
        assert not np.any(plain[f"{kind}_tangential_N"])
    more = contact["cam_bearing_load_max_N"] > plain["cam_bearing_load_max_N"]
    assert more == (sense == "drive")
    assert 0.5 < contact["efficiency"] < plain["efficiency"] == 1.0
    for free in ("backlash_arcmin", "lost_motion_arcmin"):
        assert rubbed["precision"][free] == without["precision"][free]
    assert rubbed["precision"]["torque_ripple_pp_Nm"] > without["precision"]["torque_ripple_pp_Nm"]


def test_the_crank_drives_unless_told_otherwise(cqdd, paper_design_file):
    assert told(cqdd, paper_design_file)["contact"]["friction"] == "drive"


@pytest.mark.deep
def test_to_say_that_the_crank_drives_changes_nothing(cqdd, paper_design_file):
    assert told(cqdd, paper_design_file) == told(cqdd, paper_design_file, "--friction", "drive")


def test_a_sense_that_is_none_is_refused(cqdd, paper_design_file):
    done = cqdd("analyse", paper_design_file, "--friction", "sideways")
    assert done.code == 2
    assert "'sideways' is not one of" in done.err


@pytest.mark.deep
def test_stress_of_discs_and_ring_stands_beside_its_checks(cqdd, paper_design_file):
    done = cqdd("analyse", paper_design_file, "--angles", "24", "--json").document
    bodies, checks = done["results"]["bodies"], {one["id"]: one for one in done["checks"]}
    give = bodies["tooth_compliance"]
    assert bodies["tooth_compliance_nm_per_N"] == give["on_bearing"]["mean_nm_per_N"]
    held, on_bearing, free = (
        give[how]["mean_nm_per_N"] for how in ("bore_round", "on_bearing", "bore_free")
    )
    assert 0.0 < held < on_bearing < free
    for part in ("ligament", "root", "ring"):
        check = checks[f"{part.upper()}-STRESS"]
        assert check["value"] == pytest.approx(bodies[f"{part}_stress_max_MPa"])
        assert check["status"] == ("pass" if check["value"] <= check["limit"] else "fail")
        assert checks[f"{part.upper()}-FATIGUE"]["value"] > 0.0
    told_checks = cqdd("check", paper_design_file, "--json").document["checks"]
    assert {one["id"]: one["value"] for one in told_checks if one["id"] != "YIELD"} == {
        name: one["value"] for name, one in checks.items()
    }
    less = told(cqdd, paper_design_file)["bodies"]
    assert less["root_stress_max_MPa"] < 0.5 * bodies["root_stress_max_MPa"]
    lines = cqdd("analyse", paper_design_file, "--angles", "24").out
    assert "greatest ligament stress" in lines
