"""`analyse` bounds what shaft and carrier bend and tilt; where it cannot, it says why."""

import pytest

KEYS = {
    "shaft_deflection_um",
    "shaft_slope_mrad",
    "core_deflection_um",
    "core_slope_mrad",
    "support_load_N",
    "support_deflection_um",
    "support_slope_mrad",
    "cam_approach_um",
    "edge_closing_um",
    "ring_approach_um",
    "edge_load_factor",
    "carrier_tilting_moment_Nm",
    "carrier_tilt_mrad",
    "model",
}


def test_bending_is_bounded_in_the_document_and_in_the_text(cqdd, paper_design_file):
    done = cqdd("analyse", paper_design_file, "--angles", "24", "--json")
    assert done.code == 0, done.err
    bending = done.document["results"]["bending"]
    assert set(bending) == KEYS
    assert bending["carrier_tilt_mrad"] is None
    assert any("knife edges" in sentence for sentence in bending["model"])
    slopes = bending["core_slope_mrad"] + bending["support_slope_mrad"]
    assert bending["edge_closing_um"] == pytest.approx(8.0 * slopes)
    assert len(bending["support_load_N"]) == 2
    less = cqdd("analyse", paper_design_file, "--torque", "60 N*m", "--angles", "24", "--json")
    assert less.document["results"]["bending"]["shaft_deflection_um"] > 0.0
    for key in KEYS - {"carrier_tilt_mrad", "model", "support_load_N", "edge_load_factor"}:
        assert less.document["results"]["bending"][key] < bending[key]
    text = cqdd("analyse", paper_design_file, "--angles", "24").out
    assert "shaft and tilt, bounded" in text
    assert "carrier_tilting_moment_Nm" in text


def test_a_line_that_may_leave_an_end_is_warned_of(cqdd, paper_design_file):
    """A small torque: balls yield by its power 2/3, lines by almost its first."""
    done = cqdd("analyse", paper_design_file, "--torque", "1 N*m", "--angles", "24", "--json")
    bending = done.document["results"]["bending"]
    assert bending["edge_closing_um"] > 2.0 * bending["ring_approach_um"]
    assert bending["edge_load_factor"] > 2.0
    assert any("leave one end of the line" in one for one in done.document["warnings"])
    full = cqdd("analyse", paper_design_file, "--angles", "24", "--json").document
    assert not any("leave one end of the line" in one for one in full["warnings"])


def test_a_machine_that_cannot_be_laid_out_is_still_analysed(cqdd, paper_design_file, tmp_path):
    """Its cam bearings are wider than its discs, so that nothing has a height along the axis."""
    design = tmp_path / "thin.toml"
    text = paper_design_file.read_text(encoding="utf-8")
    was = 'disc_thickness = "8 mm"'
    assert was in text
    design.write_text(text.replace(was, 'disc_thickness = "5 mm"'), encoding="utf-8")
    done = cqdd("analyse", design, "--angles", "24", "--json")
    assert done.code == 0, done.err
    assert "Traceback" not in done.err
    assert done.document["results"]["bending"] is None
    assert done.document["results"]["contact"] is not None
    assert any(
        "no bound on bending and tilt: cam_bearing 6902 is 7 mm wide" in one
        for one in done.document["warnings"]
    )
