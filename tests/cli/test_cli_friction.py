"""`analyse --friction`: which forces it changes, and what it refuses."""

import numpy as np
import pytest

TANGENTIAL = {"ring_tangential_N", "output_pin_tangential_N"}


def told(cqdd, design, *options):
    done = cqdd("analyse", design, "--angles", "8", "--torque", "40 N*m", *options, "--json")
    assert done.code == 0, done.err
    return done.document["results"]


@pytest.mark.parametrize("sense", ["drive", "backdrive"])
def test_friction_changes_the_contact_forces_and_nothing_else(cqdd, paper_design_file, sense):
    without = told(cqdd, paper_design_file)
    rubbed = told(cqdd, paper_design_file, "--friction", sense)
    assert without == told(cqdd, paper_design_file, "--friction", "off")
    contact, plain = rubbed.pop("contact"), without.pop("contact")
    assert rubbed == without
    assert contact["friction"] == sense
    assert not TANGENTIAL & set(plain)
    for kind in ("ring", "output_pin"):
        along = np.asarray(contact[f"{kind}_tangential_N"])
        pressed = np.asarray(contact[f"{kind}_force_N"])
        assert np.abs(np.abs(along) - 0.08 * pressed).max() < 1e-9 * pressed.max()
    more = contact["cam_bearing_load_max_N"] > plain["cam_bearing_load_max_N"]
    assert more == (sense == "drive")
    assert 0.5 < contact["efficiency"] < 1.0


def test_a_sense_that_is_none_is_refused(cqdd, paper_design_file):
    done = cqdd("analyse", paper_design_file, "--friction", "sideways")
    assert done.code == 2
    assert "'sideways' is not one of" in done.err
