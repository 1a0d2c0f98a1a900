"""The bill of materials names every part, adds up, and says where every mass comes from."""

from __future__ import annotations

import csv
import io
import math
import subprocess
import sys

import pytest

from cqdd_design.catalog import bearings, find_material, find_motor
from cqdd_design.design import load_design
from cqdd_design.exporting.solids.bom import bill_of_materials, bom_csv
from cqdd_design.machine import resolve
from cqdd_design.roads.export import export

COLUMNS = [
    *("item", "part", "quantity", "make_or_buy", "material", "mass_each_kg", "mass_total_kg"),
    *("designation", "notes"),
]


@pytest.fixture(scope="module")
def paper(paper_design_file):
    return load_design(paper_design_file)


@pytest.fixture(scope="module")
def parts(paper):
    return resolve(paper).parts


@pytest.fixture(scope="module")
def rows(paper, parts):
    return list(
        csv.DictReader(io.StringIO(bom_csv(bill_of_materials(resolve(paper).motor, parts))))
    )


def test_columns_and_items(rows):
    assert list(rows[0]) == COLUMNS
    assert [row["item"] for row in rows] == [str(k + 1) for k in range(len(rows))]
    assert {row["make_or_buy"] for row in rows} == {"make", "buy"}
    assert all(row["designation"] and row["notes"].startswith("mass: ") for row in rows)


def test_every_part_is_there_in_its_number(rows, parts):
    listed = {row["part"]: int(row["quantity"]) for row in rows}
    assert listed == {part.name: part.count for part in parts}
    assert (listed["motor stator"], listed["motor rotor"]) == (1, 1)
    assert listed["disc"] == 2
    assert listed["shoulder screw"] == 5
    assert listed["cam bearing"] == 2


def test_masses_add_up_to_the_machine_with_its_motor(rows, parts, paper):
    total = math.fsum(float(row["mass_total_kg"]) for row in rows)
    assert math.isclose(
        total, sum(part.mass * part.count for part in parts), abs_tol=1e-5 * len(rows)
    )
    motor = [row for row in rows if row["part"] in ("motor stator", "motor rotor", "rotor bell")]
    mass = math.fsum(float(row["mass_total_kg"]) for row in motor)
    assert math.isclose(mass, find_motor(paper.motor.name).mass, abs_tol=2e-5)
    for row in rows:
        each, every = float(row["mass_each_kg"]), float(row["mass_total_kg"])
        assert math.isclose(each * int(row["quantity"]), every, abs_tol=1e-5 * int(row["quantity"]))


def test_the_disc_weighs_what_its_area_says(rows, paper):
    """Lobed area less bore and holes, times thickness and density, with the areas by hand."""
    holes = math.pi / 4.0 * (28e-3**2 + 5 * 7.191e-3**2)
    density = find_material(paper.reducer.disc_material).density
    wanted = (2584.74702681e-6 - holes) * 8e-3 * density
    (disc,) = (row for row in rows if row["part"] == "disc")
    assert math.isclose(float(disc["mass_each_kg"]), wanted, abs_tol=0.5e-5)


def test_bought_parts_can_be_ordered(rows):
    by_part = {row["part"]: row for row in rows}
    assert by_part["cam bearing"]["designation"] == "6902"
    assert by_part["cam bearing"]["designation"] in bearings()
    assert by_part["shoulder screw"]["designation"].startswith("ISO 7379 4 f9")
    assert by_part["motor stator"]["designation"] == "CubeMars RO100 Lite KV55, stator"
    assert "catalogue (the maker's page" in by_part["motor stator"]["notes"]
    assert "exact profile x 7850 kg/m3" in by_part["ring"]["notes"]


def test_a_motor_that_is_not_drawn_is_the_last_line(paper):
    design = paper.replacing({"motor.name": "MAD 5010 110KV"})
    machine = resolve(design)
    (*_, motor) = csv.DictReader(
        io.StringIO(bom_csv(bill_of_materials(machine.motor, machine.parts)))
    )
    assert (motor["part"], motor["designation"]) == ("motor", "MAD 5010 110KV")
    assert (motor["mass_each_kg"], motor["mass_total_kg"]) == ("", "")
    assert "not in the catalogue" in motor["notes"]


def test_the_bill_needs_no_cad(paper_design_file, tmp_path):
    code = (
        "import sys; from pathlib import Path; from cqdd_design.design import load_design\n"
        f"sys.path.insert(0, {str(paper_design_file.parents[1])!r})\n"
        "from cqdd_design.roads.export import export\n"
        "export(load_design(Path(sys.argv[1])), 'bom', Path(sys.argv[2]))\n"
        "assert not {'cadquery', 'OCP', 'trimesh'} & set(sys.modules)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(paper_design_file), str(tmp_path)],
        cwd=paper_design_file.parents[1],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["cqdd-10-bom.csv"]


def test_the_written_bill_is_the_same_twice(paper, tmp_path):
    shas = {
        file.sha256 for folder in ("a", "b") for file in export(paper, "bom", tmp_path / folder)
    }
    assert len(shas) == 1
