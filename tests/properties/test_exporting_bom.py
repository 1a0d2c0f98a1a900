"""The bill of materials names every part, adds up, and says where every mass comes from."""

from __future__ import annotations

import csv
import dataclasses
import io
import math
import subprocess
import sys

import pytest

from cqdd_design.catalog import bearings, find_material, find_motor
from cqdd_design.design import load_design
from cqdd_design.errors import UsageError
from cqdd_design.exporting.bill.consumables import bonds
from cqdd_design.exporting.bill.fitting import fitting_notes
from cqdd_design.exporting.bill.known import catalogue_designations
from cqdd_design.exporting.bill.prices import read_prices
from cqdd_design.exporting.bill.substitutes import (
    equal_bearings,
    longer_screw,
    ordered_as,
    passes,
)
from cqdd_design.exporting.options import DEFAULTS, ExportOptions, refuse_unread
from cqdd_design.exporting.sheets.assembly_facts import AssemblyFacts
from cqdd_design.exporting.solids.bom import (
    TOTAL,
    bill_of_materials,
    bom_csv,
    priced,
    total_rows,
)
from cqdd_design.machine import resolve
from cqdd_design.machine.grease import grease_fill
from cqdd_design.machine.screws import screw_joints
from cqdd_design.roads.export import export
from cqdd_design.verdict.output_seat_line import output_seat_line
from cqdd_design.verdict.screw_lines import screw_lines

COLUMNS = [
    *("item", "part", "quantity", "make_or_buy", "material", "mass_each_kg", "mass_total_kg"),
    *("designation", "fitting", "substitutes", "price_each", "price_total", "currency", "vendor"),
    "notes",
]


@pytest.fixture(scope="module")
def paper(paper_design_file):
    return load_design(paper_design_file)


@pytest.fixture(scope="module")
def parts(paper):
    return resolve(paper).parts


@pytest.fixture(scope="module")
def bill(paper, parts):
    return bill_of_materials(resolve(paper), parts)


@pytest.fixture(scope="module")
def rows(bill):
    return list(csv.DictReader(io.StringIO(bom_csv(bill))))


def test_columns_and_items(rows):
    assert list(rows[0]) == COLUMNS
    assert [row["item"] for row in rows] == [str(k + 1) for k in range(len(rows))]
    assert {row["make_or_buy"] for row in rows} == {"make", "buy"}
    assert all(row["designation"] and row["notes"].startswith("mass: ") for row in rows)


def test_every_part_is_there_in_its_number(rows, parts):
    listed = {row["part"]: int(row["quantity"]) for row in rows}
    beside = {"retaining compound": 1, "ring's compound": 1, "lubricant": 1}
    assert listed == {**{part.name: part.count for part in parts}, **beside}
    assert (listed["motor stator"], listed["motor rotor"]) == (1, 1)
    assert listed["disc"] == 2
    assert listed["shoulder screw"] == 5
    assert listed["cam bearing"] == 2


def test_masses_add_up_to_the_machine_with_its_motor(rows, parts, paper):
    total = math.fsum(float(row["mass_total_kg"] or 0.0) for row in rows)
    assert math.isclose(
        total, sum(part.mass * part.count for part in parts), abs_tol=1e-5 * len(rows)
    )
    motor = [row for row in rows if row["part"] in ("motor stator", "motor rotor", "rotor bell")]
    mass = math.fsum(float(row["mass_total_kg"]) for row in motor)
    assert math.isclose(mass, find_motor(paper.motor.name).mass, abs_tol=2e-5)
    for row in rows[: len(parts)]:
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
    assert by_part["shoulder screw"]["designation"].startswith("shoulder screw 4 f9")
    assert by_part["motor stator"]["designation"] == "CubeMars RO100 Lite KV55"
    assert by_part["encoder magnet"]["designation"] == "ams AS5000-MD6H-2"
    known = catalogue_designations()
    for row in rows:
        if row["make_or_buy"] == "buy" and row["part"] != "motor rotor":
            # Thin bearings' shims are sold cut to any size.
            cut = row["designation"] == "shim rings 61.2 x 66, cut from strip"
            assert row["designation"] in known or cut, row
    assert "catalogue (the maker's page" in by_part["motor stator"]["notes"]
    assert "exact profile x 7850 kg/m3" in by_part["ring"]["notes"]


def test_both_seats_of_the_shafts_bearings_are_told(rows):
    (row,) = (row for row in rows if row["part"] == "shaft bearing")
    assert (
        "on the eccentric shaft 10 k6, in the housing 22 H7 and the carrier plate 22 H7"
        in (row["fitting"])
    )


def test_the_output_bearing_is_ordered_with_the_clearance_that_is_judged(paper, rows):
    """A thin crossed roller has C0 alone; a ball bearing on aluminium is ordered loose."""
    (row,) = (row for row in rows if row["part"] == "output bearing")
    assert "on the carrier plate 50 h5" in row["fitting"]
    assert "radial clearance C0, 0 to 15 \u00b5m" in row["fitting"]
    for plate, name in (("auto", "C4"), ("AISI 4140 Q&T 540C", "CN")):
        balls = {"reducer.carrier_bearing.designation": "6810", "reducer.carrier.material": plate}
        machine = resolve(paper.replacing(balls))
        assert f"radial clearance {name}, " in fitting_notes(machine)["output bearing"]
        assert f"6810 {name}, " in output_seat_line(machine).substituted


def test_the_third_cam_bearing_has_a_seat_of_its_own(paper, rows):
    """On the loose cam, whose lobe is ground smaller for it grows when it is pressed on."""
    three = resolve(paper.replacing({"reducer.disc_count": 3}))
    said = fitting_notes(three)["cam bearing"]
    assert "on the eccentric shaft 15 h6" in said
    assert said.endswith("; the third on the eccentric cam 15 g5")
    (row,) = (row for row in rows if row["part"] == "cam bearing")
    assert "third" not in row["fitting"]


def test_a_screw_of_no_length_that_is_sold_says_so(paper, rows):
    """Three discs of 9 mm take a shoulder of 32 mm; those of 4 mm end at 30 mm."""
    three = {"reducer.disc_count": 3, "reducer.disc_thickness": "9 mm"}
    machine = resolve(paper.replacing(three))
    bill = bill_of_materials(machine, machine.parts)
    (row,) = (row for row in bill if row.part == "shoulder screw")
    assert row.designation not in catalogue_designations()
    assert "no such length is sold: turned to order" in row.fitting
    assert not any("no such length" in row["fitting"] for row in rows)


def test_a_motor_that_is_not_drawn_is_the_last_line(paper):
    design = paper.replacing({"motor.name": "MAD 5010 110KV"})
    machine = resolve(design)
    every = csv.DictReader(io.StringIO(bom_csv(bill_of_materials(machine, machine.parts))))
    (motor,) = (row for row in every if row["part"] == "motor")
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


def test_bill_sheet_and_verdict_state_one_torque_of_a_screw(paper, rows):
    # They said 2.3, 2.28 and 2.2 N m of one screw.
    machine = dataclasses.replace(resolve(paper), stiff=True)
    joint = next(one for one in screw_joints(machine) if one.place.startswith("cover"))
    told = f"{float(f'{joint.clamping.torque:.3g}'):g}"
    assert len(told.replace(".", "")) == 3
    (row,) = (row for row in rows if row["part"] == "cover screw")
    assert row["fitting"].startswith(f"tighten to {told} N m")
    preload = next(line for line in screw_lines(machine) if line.id == "SCREW-PRELOAD")
    assert f"{joint.screw} at {told} N*m" in preload.substituted
    torques = {place: torque for place, _, torque in AssemblyFacts(machine).torques()}
    assert torques[joint.place] == told


def test_substitutes_of_bearings_are_no_smaller_and_no_weaker(rows):
    found = 0
    for row in bearings().values():
        for other in equal_bearings(row):
            found += 1
            assert (other.bore_diameter, other.outer_diameter, other.width) == (
                row.bore_diameter,
                row.outer_diameter,
                row.width,
            )
            assert other.dynamic_rating >= row.dynamic_rating
            assert other.static_rating >= row.static_rating
            assert other.kind == row.kind
    assert found >= 2
    by_part = {row["part"]: row for row in rows}
    assert by_part["ring dowel"]["substitutes"] == "DIN 6325 1.5 m6 x 4 A"
    assert by_part["cam bearing"]["substitutes"] == (
        "ball bearing 15 x 28 x 7 mm of any maker, C 4.3 kN and C0 2.25 kN or more"
    )
    assert ordered_as(bearings()["needle cage K15x19x10"]) == "K15x19x10"


def test_a_substitute_that_fails_a_check_is_not_offered(paper_design_file):
    machine = resolve(load_design(paper_design_file.with_name("reference-s.toml")))
    key = "reducer.cam_bearing.designation"
    assert passes(machine, {key: "16003"})
    # The same bore in thinner series bears too little.
    assert not passes(machine, {key: "6803"})
    assert not passes(machine, {key: "6903"})
    assert passes(machine, {"reducer.friction.lubricant": "NLGI 2 grease"})


def test_a_longer_screw_is_named_where_it_ends_in_its_thread(paper):
    machine = resolve(paper)
    assert longer_screw(machine, "encoder screw") is None
    housing = machine.layout.housing
    room = housing.cover_flange_top - housing.flange_bottom
    other = longer_screw(machine, "cover screw")
    steps = [one for one in (12e-3, 16e-3) if housing.screw.length < one <= room]
    assert (other.length if other else None) == (steps[0] if steps else None)
    wide = dataclasses.replace(housing, flange_bottom=housing.flange_bottom - 6e-3)
    grown = dataclasses.replace(machine)
    grown.__dict__["layout"] = dataclasses.replace(machine.layout, housing=wide)
    assert longer_screw(grown, "cover screw").designation == "ISO 4762 M3 x 12 - 12.9"


def test_grease_and_compound_are_of_the_space_there_is(paper, rows):
    """The free space by hand: the ring's bore less two discs, two bearings, five pins and lobes."""
    machine = resolve(paper)
    parts = {part.name: part for part in machine.parts}
    height = machine.layout.pack.top
    bore = math.pi * machine.layout.pack.ring_radius**2 * height - parts["ring"].shape.volume
    discs = 2 * (parts["disc"].shape.volume + parts["cam bearing"].shape.volume)
    pins = 5 * math.pi / 4 * 3.975e-3**2 * height
    lobes = 2 * math.pi * 7.5e-3**2 * 7e-3
    fill = grease_fill(machine)
    assert math.isclose(fill.free, bore - discs - pins - lobes, rel_tol=0.06)
    (grease,) = (row for row in rows if row["part"] == "lubricant")
    assert grease["fitting"].startswith(f"about {fill.free / 3 * 0.9e6:.2g} g")
    (bell,) = (one for one in bonds(machine) if one.place == "bell on the shaft")
    assert math.isclose(bell.gap, 0.5 * (20.5e-6 - 8e-6), rel_tol=0.2) or bell.gap == 20e-6


def _list(tmp_path, text):
    path = tmp_path / "prices.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_prices_are_filled_in_and_added_up_for_each_currency(bill, tmp_path):
    text = (
        "designation,price,currency,vendor\n6902,4.5,EUR,Alpha\n disc ,80,EUR,\n"
        "cubemars ro100  lite KV55,210,USD,Beta\n6903,5,EUR,\nlockring,,,\n"
    )
    rows = priced(bill, read_prices(_list(tmp_path, text)))
    by_part = {row.part: row for row in rows}
    assert by_part["cam bearing"].price_total == 9.0
    assert by_part["cam bearing"].vendor == "Alpha"
    assert by_part["disc"].price_total == 160.0
    assert by_part["ring"].price_each is None
    euro, dollar = total_rows(rows)
    assert (euro.part, euro.price_total, euro.currency) == (TOTAL, 169.0, "EUR")
    assert (dollar.price_total, dollar.currency) == (210.0, "USD")
    assert euro.notes == f"{len(rows) - 4} of {len(rows) - 1} lines have no price"
    last = bom_csv(rows, totals=True).splitlines()[-1]
    assert ",210.00,USD,," in last


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("designation,price,currency\n6902x,4,EUR\n", ["line 2", "'6902x'", "'6902'"]),
        ("designation,price,currency\n6902,4\n", ["line 2", "no currency", "EUR"]),
        ("designation,price,currency\n6902,-4,EUR\n", ["'-4'", "no number from 0"]),
        ("designation,price,currency\n6902,nan,EUR\n", ["no number"]),
        ("designation,cost\n6902,4\n", ["no column 'price'", "designation,price,currency,vendor"]),
        ("designation,price,currency\n6902,4,EUR\n6902 ,5,EUR\n", ["lines 2 and 3", "keep one"]),
        ("designation,price,currency\n,4,EUR\n", ["without a designation"]),
        ("", ["no column 'designation'"]),
    ],
)
def test_a_wrong_price_list_is_refused_by_row(bill, tmp_path, text, words):
    with pytest.raises(UsageError) as caught:
        priced(bill, read_prices(_list(tmp_path, text)))
    for word in words:
        assert word in caught.value.message


def test_prices_need_the_bill(tmp_path):
    path = _list(tmp_path, "designation,price,currency\n6902,4,EUR\n")
    with pytest.raises(UsageError, match="--to bom"):
        refuse_unread(("dxf",), DEFAULTS, prices=path)
    refuse_unread(("dxf",), DEFAULTS, prices=None)
    refuse_unread(("bom",), DEFAULTS, prices=path)
    found = read_prices(path)
    assert found.of(" 6902").amount == 4.0
    assert ExportOptions(prices=found).arguments()[-2:] == ["--prices", str(path)]
