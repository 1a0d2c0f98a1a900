"""`analyse` bounds what shaft and carrier bend and tilt; where it cannot, it says why."""

import pytest

KEYS = {
    "shaft_deflection_um",
    "shaft_slope_mrad",
    "core_deflection_um",
    "core_slope_mrad",
    "support_load_N",
    "support_static_rating_N",
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


@pytest.mark.deep
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
    other = {"model", "support_load_N", "support_static_rating_N", "edge_load_factor"}
    for key in KEYS - other - {"carrier_tilt_mrad"}:
        assert less.document["results"]["bending"][key] < bending[key]
    text = cqdd("analyse", paper_design_file, "--angles", "24").out
    assert "shaft and tilt, bounded" in text
    assert "carrier tilting moment" in text


@pytest.mark.deep
def test_a_line_that_may_leave_an_end_is_warned_of(cqdd, paper_design_file):
    """A small torque: balls yield by its power 2/3, lines by almost its first."""
    done = cqdd("analyse", paper_design_file, "--torque", "1 N*m", "--angles", "24", "--json")
    bending = done.document["results"]["bending"]
    assert bending["edge_closing_um"] > 2.0 * bending["ring_approach_um"]
    assert bending["edge_load_factor"] > 2.0
    (told,) = [one for one in done.document["warnings"] if "leave one end of the line" in one]
    assert "which a row of balls hardly makes it do" in told
    assert f"{bending['edge_load_factor'] ** 0.5:.2f} of what is told" in told
    full = cqdd("analyse", paper_design_file, "--angles", "24", "--json").document
    assert not any("leave one end of the line" in one for one in full["warnings"])


@pytest.mark.deep
def test_a_support_bearing_beyond_its_static_rating_is_warned_of(cqdd, paper_design_file):
    """SKF 61900: 1270 N, where the peak torque of the paper's gearbox asks for four times that."""
    for torque, beyond in (((), True), (("--torque", "1 N*m"), False)):
        done = cqdd("analyse", paper_design_file, *torque, "--angles", "24", "--json")
        bending = done.document["results"]["bending"]
        assert bending["support_static_rating_N"] == pytest.approx(1270.0)
        assert (max(bending["support_load_N"]) > 1270.0) is beyond
        told = [one for one in done.document["warnings"] if "support bearing" in one]
        assert bool(told) is beyond


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
