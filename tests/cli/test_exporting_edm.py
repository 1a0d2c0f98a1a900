"""The EDM package and G-code as processes: options, exit codes, what is left behind."""

from __future__ import annotations

from pathlib import Path

import ezdxf
import pytest


def test_package_and_programs_in_one_go(cqdd, paper_design_file, tmp_path):
    done = cqdd(
        *("export", paper_design_file, "--to", "edm,gcode,dxf", "--json"),
        *("--dxf-version", "r12", "--dxf-style", "entities", "--tab-length", "2 mm"),
    )
    assert done.code == 0, done.err
    files = done.document["files"]
    assert all((tmp_path / file["path"]).stat().st_size == file["bytes"] for file in files)
    assert {Path(file["path"]).parent for file in files} == {
        Path("exports/cqdd-10"),
        Path("exports/cqdd-10/edm"),
    }
    for file in files:
        if file["path"].endswith(".dxf"):
            assert ezdxf.readfile(tmp_path / file["path"]).dxfversion == "AC1009"
    program = (tmp_path / "exports/cqdd-10/edm/cqdd-10-disc.nc").read_text(encoding="ascii")
    assert "TAB OF 2.000 MM LEFT" in program
    assert "INSUNITS" not in done.err


def test_a_bearing_left_to_the_catalogue_changes_no_hash(cqdd, paper_design_file, tmp_path):
    """Every file names the design as it was written, the way the JSON does."""
    text = paper_design_file.read_text().replace('designation = "6902"', 'designation = "auto"')
    (tmp_path / "auto.toml").write_text(text)
    done = cqdd("export", tmp_path / "auto.toml", "--to", "edm,gcode,svg,urdf,card", "--json")
    assert done.code == 0, done.err
    wanted = done.document["provenance"]["design_sha256"][:12]
    told = 0
    for file in done.document["files"]:
        path = tmp_path / file["path"]
        if path.suffix in {".txt", ".nc", ".dxf", ".urdf", ".md", ".yaml"} or "/edm/" in str(path):
            if path.suffix == ".pdf":
                continue
            assert wanted.lower() in path.read_text().lower(), path.name
            told += 1
    assert told >= 9


@pytest.mark.parametrize(
    ("option", "value", "said"),
    [
        ("--dxf-version", "R14", "R12, R2000, R2010"),
        ("--dxf-style", "spline", "polyline, entities"),
        ("--step-schema", "AP203", "AP214, AP242"),
        ("--tab-length", "2", "mm"),
        ("--tab-length", "1 m", "nearest is 50 mm"),
        ("--passes", "5", "1 to 4; the nearest is 4"),
        ("--passes", "0", "1 to 4; the nearest is 1"),
        ("--gcode-dialect", "fanuc", "The choices are iso, sodick"),
        ("--tab-length", "0 mm", "not above zero"),
    ],
)
def test_a_wrong_option_is_exit_2_and_names_the_choices(
    cqdd, paper_design_file, tmp_path, option, value, said
):
    done = cqdd("export", paper_design_file, "--to", "edm", option, value)
    assert done.code == 2
    assert said in " ".join(done.err.split())
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("kind", "option", "value", "readers"),
    [
        ("dxf", "--seed", "3", "mjcf or urdf or card or bam"),
        ("dxf", "--calibration", "cal.json", "mjcf or urdf or card or bam"),
        ("dxf", "--passes", "2", "gcode or edm"),
        ("dxf", "--gcode-dialect", "sodick", "gcode or edm"),
        ("dxf", "--step-schema", "AP242", "step or print"),
        ("dxf", "--prices", "p.csv", "bom"),
        ("bom", "--dxf-version", "R12", "dxf or edm"),
        ("bom", "--dxf-style", "entities", "dxf or edm"),
        ("bom", "--tab-length", "1 mm", "dxf or edm or gcode or sheets"),
    ],
)
def test_an_option_that_no_kind_reads_is_exit_2_and_names_those_that_do(
    cqdd, paper_design_file, tmp_path, kind, option, value, readers
):
    done = cqdd("export", paper_design_file, "--to", kind, option, value)
    assert done.code == 2
    told = " ".join(done.err.split())
    assert f"cqdd-design: {option} " in told
    assert f"ask for it with --to {readers}, or leave the option out." in told
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("tolerance", "nearest"), [("0 um", "0.05 um"), ("1 m", "50 um"), ("-1 um", "0.05 um")]
)
def test_a_tolerance_that_no_file_can_have_is_exit_3(
    cqdd, paper_design_file, tmp_path, tolerance, nearest
):
    text = paper_design_file.read_text(encoding="utf-8")
    odd = text.replace('profile_tolerance = "0.5 um"', f'profile_tolerance = "{tolerance}"')
    assert odd != text
    (tmp_path / "odd.toml").write_text(odd, encoding="utf-8")
    done = cqdd("export", "odd.toml", "--to", "edm,gcode", "--out", "files")
    assert done.code == 3
    assert "edm.profile_tolerance" in done.err
    assert f"the nearest allowed is {nearest}" in done.err
    assert [path.name for path in tmp_path.iterdir()] == ["odd.toml"]


def test_a_wire_too_thick_for_a_valley_is_exit_4_and_leaves_nothing(
    cqdd, sharp_design_file, tmp_path
):
    done = cqdd("export", sharp_design_file, "--to", "edm,gcode", "--out", "files")
    assert done.code == 4, done.err
    assert "ring, inner contour 1: edm.wire_diameter 0.5 mm" in done.err
    assert "choose a wire of at most" in done.err
    assert [path.name for path in tmp_path.iterdir()] == [sharp_design_file.name]
