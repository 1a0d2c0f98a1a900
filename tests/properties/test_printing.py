"""Printed and moulded parts: compensation, inserts, walls, the coupon and its way back."""

from __future__ import annotations

import math
import re
import zipfile
from collections import Counter

import numpy as np
import pytest

from cqdd_design.catalog import materials
from cqdd_design.catalog.printing import inserts, printed_materials
from cqdd_design.design import load_design
from cqdd_design.errors import DesignError, GeometryError
from cqdd_design.exporting.bill.known import catalogue_designations
from cqdd_design.exporting.printing.compensate import Compensation, compensated, grown
from cqdd_design.exporting.printing.coupon import HOLE_OFFSETS, PIN_OFFSETS, coupon
from cqdd_design.exporting.printing.marks import marks
from cqdd_design.exporting.printing.package import coupons_of, printed_parts
from cqdd_design.exporting.printing.readme import readme_text
from cqdd_design.exporting.printing.threads import ThreadedHoles, with_inserts
from cqdd_design.exporting.solids.bom import bill_of_materials
from cqdd_design.geometry.contours import Circle, as_complex
from cqdd_design.machine import resolve
from cqdd_design.roads.export import export
from cqdd_design.solids.features.holes import FittedHole
from cqdd_design.solids.features.kinds import ON_AXIS, Chamfer, Groove
from cqdd_design.solids.walls import least_walls
from cqdd_design.verdict.retention_lines import retention_lines

PLASTIC = "PC-CF FDM along layers"


@pytest.fixture(scope="module")
def design(paper_design_file):
    return load_design(paper_design_file.with_name("printed-13.toml"))


@pytest.fixture(scope="module")
def machine(design):
    return resolve(design)


@pytest.fixture(scope="module")
def every(machine):
    return printed_parts(machine, machine.parts)


def test_rows_are_of_materials_of_the_catalogue_with_a_source():
    known = materials()
    for name, row in printed_materials().items():
        assert known[name].youngs_modulus < 10e9
        assert row.source
        assert 0.0 <= row.shrinkage <= 0.03
        assert row.least_wall >= 2.0 * row.line_width - 1e-9 or row.process == "SLS"
    for one in inserts():
        assert one.hole > one.thread
        assert one.source


def test_all_parts_of_plastic_are_in_the_package_and_no_metal(every):
    names = {one.drawn.name for one in every}
    assert {"disc", "ring", "carrier plate", "carrier cap", "housing", "motor cover"} <= names
    assert not names & {"eccentric shaft", "rotor bell", "cam bearing"}
    assert all(one.drawn.designation.startswith("printed, FDM") for one in every)


def test_what_the_printer_does_to_a_file_gives_the_drawing(machine):
    """A printer that shrinks by 0.4 %, with holes 0.12 mm small and outsides 0.05 mm large."""
    by = Compensation(0.004, -120e-6, 50e-6, measured=True)
    for part in machine.parts:
        if part.name not in ("carrier cap", "ring clamp", "disc"):
            continue
        made = compensated(part, by)
        for layer, drawn in zip(made.shape.layers, part.shape.layers, strict=True):
            assert layer.height * (1.0 - 0.004) == pytest.approx(drawn.height, rel=1e-12)
            holes = zip(layer.shape.holes, drawn.shape.holes, strict=True)
            for file, wanted in holes:
                if isinstance(file, Circle):
                    printed = 2.0 * file.radius * (1.0 - 0.004) - 120e-6
                    assert printed == pytest.approx(2.0 * wanted.radius, abs=1e-12)
            if isinstance(drawn.shape.outer, Circle):
                printed = 2.0 * layer.shape.outer.radius * (1.0 - 0.004) + 50e-6
                assert printed == pytest.approx(2.0 * drawn.shape.outer.radius, abs=1e-12)


def test_a_measured_coupon_brings_sizes_back_as_drawn(machine, every):
    """A printer prints the coupon; what its README asks for makes it print the parts as drawn.

    Shrinkage is in the measured bores and pins too: it counts once.
    """
    shrunk, small, large = 0.006, -90e-6, 40e-6
    parts = [one.drawn for one in every]
    test = coupon(parts, "PLA")
    plate, *raised = test.part.shape.layers
    bores = [2.0 * hole.radius for hole in plate.shape.holes]
    pins = [2.0 * one.shape.outer.radius for one in raised if isinstance(one.shape.outer, Circle)]
    measured = [(1.0 - shrunk) * one + small for one in bores]
    grown_pins = [(1.0 - shrunk) * one + large for one in pins]
    text = " ".join(readme_text(machine.design, every, [test]).split())
    found = re.search(
        r"bores, drawn ([\d.]+) mm in the mean, and pins, drawn ([\d.]+) mm, the errors are the "
        r"mean of all as measured less \(1 - shrinkage\) times that",
        text,
    )
    hole, pin = (1e-3 * float(one) for one in found.groups())
    by = Compensation(
        shrunk,
        float(np.mean(measured)) - (1.0 - shrunk) * hole,
        float(np.mean(grown_pins)) - (1.0 - shrunk) * pin,
        measured=True,
    )
    part = next(one for one in parts if one.name == "ring clamp")
    for made, drawn in zip(compensated(part, by).shape.layers, part.shape.layers, strict=True):
        for file, wanted in zip(made.shape.holes, drawn.shape.holes, strict=True):
            if isinstance(file, Circle):
                printed = 2.0 * file.radius * (1.0 - shrunk) + small
                assert printed == pytest.approx(2.0 * wanted.radius, abs=1e-6)
        printed = 2.0 * made.shape.outer.radius * (1.0 - shrunk) + large
        assert printed == pytest.approx(2.0 * drawn.shape.outer.radius, abs=1e-6)


def test_edges_of_files_are_those_of_the_drawn_part(every):
    """As wide as drawn: a spigot that a lead-in was kept short for still finds its seat."""
    parts = {one.drawn.name: one for one in every}
    assert not [cut for cut in parts["disc"].made.cuts if cut.centres == (ON_AXIS,)]
    for one in every:
        drawn, scale = one.drawn.turned, one.by.scale
        assert len(one.made.features) == len(drawn)
        for file, wanted in zip(one.made.features, drawn, strict=True):
            if isinstance(wanted, Chamfer):
                assert file.width == pytest.approx(scale * wanted.width, rel=1e-12)
                assert file.radius == pytest.approx(scale * wanted.radius, rel=1e-12)
                assert file.height == pytest.approx(scale * wanted.height, rel=1e-12)
    cover, clamp = parts["output cover"].made, parts["ring clamp"].made
    (seat,) = (f for f in parts["output cover"].drawn.fits if f.inside and f.lead_in)
    (lead,) = (
        f
        for f in cover.features
        if f.inside and f.radius == pytest.approx(0.5 * seat.diameter * parts["disc"].by.scale)
    )
    assert lead.width < 0.25e-3
    spigot = max(
        f.height - f.width
        for f in clamp.features
        if not f.inside and f.facing == "up" and f.radius == pytest.approx(lead.radius)
    )
    assert spigot > lead.height + lead.width + 0.3e-3


def test_an_edge_moves_with_the_measured_error_of_its_side(every):
    by = Compensation(0.004, -120e-6, 50e-6, measured=True)
    part = next(one.drawn for one in every if one.drawn.name == "carrier plate")
    assert {type(one) for one in part.turned} == {Chamfer, Groove}
    for file, drawn in zip(compensated(part, by).features, part.turned, strict=True):
        error = -120e-6 if drawn.inside else 50e-6
        radius = "radius" if isinstance(drawn, Chamfer) else "cylinder"
        printed = 2.0 * getattr(file, radius) * (1.0 - 0.004) + error
        assert printed == pytest.approx(2.0 * getattr(drawn, radius), abs=1e-12)
        if isinstance(drawn, Groove):
            assert file.diameter * (1.0 - 0.004) + error == pytest.approx(drawn.diameter, abs=1e-12)
            assert (file.top - file.bottom) * 0.996 == pytest.approx(drawn.top - drawn.bottom)


def test_what_a_coupon_showed_is_of_its_plastic_alone(design, tmp_path):
    mixed = design.replacing({"housing.material": "ABS", "printing.shrinkage": 0.004})
    machine = resolve(mixed)
    parts = printed_parts(machine, machine.parts)
    of = {one.drawn.name: one.by for one in parts}
    # Most parts follow the housing.
    assert (of["housing"].shrinkage, of["housing"].measured) == (0.004, True)
    assert of["disc"] == Compensation(0.003, 0.0, 0.0, measured=False)
    two = mixed.replacing(
        {
            "printing.material": PLASTIC,
            "printing.others": [{"material": "ABS", "hole_error": "-80 um"}],
        }
    )
    machine = resolve(two)
    parts = printed_parts(machine, machine.parts)
    of = {one.drawn.name: one.by for one in parts}
    assert of["disc"] == Compensation(0.004, 0.0, 0.0, measured=True)
    assert of["housing"].shrinkage == pytest.approx(0.007)
    assert (of["housing"].hole_error, of["housing"].measured) == (-80e-6, True)
    tests = coupons_of(parts)
    assert [one.part.material for one in tests] == ["ABS", PLASTIC]
    text = readme_text(two, parts, tests)
    assert "Test coupon of ABS" in text
    assert f'material = "{PLASTIC}"' in text
    assert "printed-13-coupon-pc-cf-fdm-along-layers.step" in text
    files = {one.path.name for one in export(two, ("print",), tmp_path)}
    assert {"printed-13-coupon-abs.3mf", "printed-13-coupon-pc-cf-fdm-along-layers.3mf"} <= files


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"printing.material": "PA66"}, "no printed part is of that; they are of PC-CF FDM along"),
        ({"printing.others": [{"material": PLASTIC}]}, "has 'PC-CF FDM along layers' twice"),
    ],
)
def test_a_coupon_of_no_plastic_of_the_design_is_refused(design, changes, words):
    machine = resolve(design.replacing({"printing.hole_error": "10 um", **changes}))
    with pytest.raises(DesignError, match=words):
        printed_parts(machine, machine.parts)


def test_the_wall_of_a_thread_without_an_insert_is_that_of_its_thread(machine, every):
    judged = {one.part: one for one in least_walls(machine.parts)}
    for one in every:
        bare = [hole for hole in one.threads if hole.insert is None]
        if bare and one.wall is not None:
            assert one.wall.thickness <= judged[one.drawn.name].thickness + 1e-12


def test_curves_move_along_their_normals(machine):
    """The disc's lobes and the teeth of the ring by 60 um everywhere, corners too."""
    parts = {part.name: part for part in machine.parts}
    lobes = parts["disc"].shape.layers[0].shape.outer
    teeth = parts["ring"].shape.layers[0].shape.holes[0]
    for contour, distance in ((lobes, -60e-6), (teeth, 60e-6)):
        moved = grown("part", contour, distance, 120e-6)
        away = contour.distances(moved.sample(2e-7))
        assert away.min() == pytest.approx(60e-6, abs=0.5e-6)
        assert away.max() == pytest.approx(60e-6, abs=0.5e-6)
        assert (moved.moments().area > contour.moments().area) == (distance > 0.0)
    ears = parts["motor cover"].shape.layers[-1].shape.outer
    moved = grown("part", ears, 60e-6, 120e-6)
    assert ears.distances(moved.sample(2e-7)).min() == pytest.approx(60e-6, abs=0.5e-6)
    # Arcs keep their centres, and inner corners lie where the moved arcs meet.
    assert moved.arcs().centres == pytest.approx(ears.arcs().centres, abs=1e-12)
    radii = ears.arcs().radii + np.sign(ears.bulges) * 60e-6
    assert moved.arcs().radii == pytest.approx(radii, abs=1e-12)


def test_an_error_as_large_as_a_hole_is_refused_by_name(machine):
    part = next(one for one in machine.parts if one.name == "motor cover")
    with pytest.raises(GeometryError) as caught:
        compensated(part, Compensation(0.0, 2.5e-3, 0.0, measured=True))
    assert "motor cover" in caught.value.message
    assert "printing.hole_error" in caught.value.message


def test_threads_in_plastic_become_holes_of_inserts_that_leave_a_wall(every):
    by_name = {one.drawn.name: one for one in every}
    plate = by_name["carrier plate"]
    # Of the output, drilled deeper than the screws reach: pins are dowels.
    assert sum(threads.count for threads in plate.threads) == 6
    assert {threads.insert.name for threads in plate.threads} == {"heat-set insert M4 x 8.1"}
    bored, _ = with_inserts(plate.drawn, plate.material.least_wall)
    sizes = [
        round(2e3 * hole.radius, 4)
        for layer in bored.shape.layers
        for hole in layer.shape.holes
        if isinstance(hole, Circle)
    ]
    assert 3.3 not in sizes
    assert sizes.count(5.6) >= 14
    # The necks of the shoulder screws sit on the motor's side of their threads, to H7.
    (seat,) = (
        one for one in plate.drawn.stated if isinstance(one, FittedHole) and "pin" in one.name
    )
    assert seat.diameter == pytest.approx(5e-3)
    lowest = min(bored.shape.layers, key=lambda one: one.bottom)
    necks = [hole for hole in lowest.shape.holes if isinstance(hole, Circle)]
    assert sum(abs(2.0 * hole.radius - 5e-3) < 0.05e-3 for hole in necks) == len(seat.circle.angles)
    assert plate.wall.thickness >= plate.material.least_wall
    cover = {threads.thread: threads for threads in by_name["motor cover"].threads}
    assert cover[3e-3].insert is None
    assert "there is room for holes of" in str(cover[3e-3])
    assert cover[2e-3].insert.name == "heat-set insert M2 x 3"
    assert "it is too short" in str(ThreadedHoles(2e-3, 1e-3, 3, 4e-3, None))


def test_it_is_said_which_threads_are_without_an_insert_among_others(machine):
    """An audit asked which two of eight: those whose wall the slot of a cable or a lead thins."""
    housing = next(part for part in machine.parts if part.name == "housing")
    bare = [one for one in with_inserts(housing, 1.2e-3)[1] if one.insert is None]
    (some,) = (one for one in bare if one.angles)
    assert len(some.angles) == some.count
    places = {
        round(math.degrees(math.atan2(*hole.centre[::-1])) % 360.0, 2)
        for layer in housing.shape.layers
        for hole in layer.shape.holes
        if isinstance(hole, Circle)
    }
    assert set(some.angles) <= places
    assert f"at {' and '.join(f'{one:g}' for one in some.angles)} deg: no insert" in str(some)


def test_walls_of_plastic_are_judged_by_what_can_be_printed(machine):
    (wall,) = (one for one in retention_lines(machine) if one.id == "RETENTION-WALL")
    assert wall.limit == pytest.approx(0.84)


def test_the_coupon_has_bores_and_pins_of_the_fits_at_every_offset(every):
    (test,) = coupons_of(every)
    assert test.sizes == (5e-3, 19e-3, 21e-3)
    plate = test.part.shape.layers[0]
    holes = sorted(round(2.0 * hole.radius, 7) for hole in plate.shape.holes)
    assert holes == sorted(round(s + o, 7) for s in test.sizes for o in HOLE_OFFSETS)
    pins = [layer for layer in test.part.shape.layers if isinstance(layer.shape.outer, Circle)]
    found = sorted(round(2.0 * layer.shape.outer.radius, 7) for layer in pins)
    assert found == sorted(round(s + o, 7) for s in test.sizes for o in PIN_OFFSETS)
    assert all(layer.bottom == plate.top for layer in pins)
    # Nothing stands over a hole or over another thing, all of it on the plate.
    raised = [layer.shape.outer for layer in test.part.shape.layers[1:]]
    outlines = [as_complex(one.sample(1e-5)) for one in raised]
    corners = plate.shape.outer.points
    for points in outlines:
        assert (points.real > corners[:, 0].min()).all()
        assert (points.real < corners[:, 0].max()).all()
        assert (points.imag < corners[:, 1].max()).all()
        for hole in plate.shape.holes:
            assert np.abs(points - complex(*hole.centre)).min() > hole.radius + 0.5e-3
    boxes = [(p.real.min(), p.real.max(), p.imag.min(), p.imag.max()) for p in outlines]
    for k, a in enumerate(boxes):
        for b in boxes[:k]:
            assert a[1] <= b[0] or b[1] <= a[0] or a[3] <= b[2] or b[3] <= a[2]


def test_marks_of_every_sign_differ():
    shown = {
        sign: frozenset(
            (round(1e6 * x), round(1e6 * y))
            for bar in marks(sign, 0.0, 0.0, 0.0, 1e-3)
            for x, y in bar.shape.outer.points
        )
        for sign in "0123456789+-."
    }
    assert len(set(shown.values())) == len(shown)
    assert len(marks("8", 0.0, 0.0, 0.0, 1e-3)) == 7


def test_no_fit_no_coupon():
    assert coupon([], "PLA") is None


def test_the_readme_says_what_was_done_and_what_is_left(design, machine, every):
    text = " ".join(readme_text(design, every, coupons_of(every)).split())
    assert text.isascii()
    assert "Scaled by 1.00301 for a shrinkage of 0.3 %, holes drawn +0 um" in text
    assert "nothing measured yet" in text
    assert "6 x M4, 10.1 mm deep: heat-set insert M4 x 8.1 in holes of 5.6 mm" in text
    assert "BELOW 0.84 mm" in text
    assert "Seats come out at their nominal size with no stock on them" in text
    assert "the bearing nut's, are cut on a lathe and are not in these files" in text
    assert "it keeps strength and shape up to 110 degc" in text.lower()
    assert "How it creeps is not known: hold no torque for long" in text
    assert "bores and pins of 5, 19, 21 mm" in text
    measured = design.replacing({"printing.outside_error": "60 um", "printing.shrinkage": 0.002})
    again = " ".join(
        readme_text(measured, printed_parts(resolve(measured), machine.parts), ()).split()
    )
    assert (
        "shrinkage of 0.2 %, holes drawn +0 um and outsides -60 um on the diameter (measured)"
        in again
    )


@pytest.mark.deep
def test_measurements_come_back_as_files_and_are_said(design, tmp_path):
    """One small part of plastic, so that the kernel has little to do."""
    metal = {
        "reducer.disc_material": "AISI 4140 Q&T 540C",
        "housing.material": "7075-T6",
        "printing.hole_error": "-100 um",
        "printing.shrinkage": 0.005,
    }
    files = {one.path.name: one.path for one in export(design.replacing(metal), "print", tmp_path)}
    assert sorted(files) == [
        "README.txt",
        "printed-13-ring.3mf",
        "printed-13-ring.step",
        "printed-13-ring.stl",
    ]
    text = " ".join(files["README.txt"].read_text(encoding="ascii").split())
    assert "shrinkage of 0.5 %, holes drawn +100 um and outsides +0 um" in text
    assert "(measured)" in text
    assert "No fit of the design is of a size" in text
    data = files["printed-13-ring.stl"].read_bytes()
    count = int.from_bytes(data[80:84], "little")
    record = np.dtype([("n", "<f4", 3), ("p", "<f4", (3, 3)), ("a", "<u2")])
    points = np.frombuffer(data[84:], dtype=record, count=count)["p"].reshape(-1, 3)
    radii = np.hypot(points[:, 0], points[:, 1])
    assert radii.max() == pytest.approx(0.5 * 71.5 / 0.995, abs=1e-3)
    drawn = (34.0 - 3.5 + 0.05) / 0.995
    assert radii.min() == pytest.approx(drawn, abs=0.02)
    assert np.ptp(points[:, 2]) == pytest.approx(25.0 / 0.995, rel=1e-3) or np.ptp(
        points[:, 2]
    ) == pytest.approx(1e3 * design.reducer.pack_length / 0.995, rel=1e-5)
    with zipfile.ZipFile(files["printed-13-ring.3mf"]) as archive:
        model = archive.read("3D/3dmodel.model").decode()
    assert model.count("<item ") == 1


def test_a_machine_of_metal_has_nothing_to_print(paper_design_file, tmp_path):
    with pytest.raises(DesignError, match=r"reducer\.disc_material"):
        export(load_design(paper_design_file), "print", tmp_path)


@pytest.mark.deep
def test_the_printed_design_is_exported_whole(design, tmp_path):
    files = export(design.replacing({"printing.hole_error": "-80 um"}), "print", tmp_path)
    names = {one.path.name for one in files}
    assert len(names) == 8 * 3 + 2 + 1
    assert {"printed-13-coupon.step", "printed-13-coupon.3mf"} <= names
    assert all(math.isfinite(one.bytes) and one.bytes > 1000 for one in files)


def test_a_machine_of_metal_is_refused_before_anything_is_begun(paper_design_file, tmp_path):
    """Not after the files of another kind are written: their solids take seconds."""
    told = []
    with pytest.raises(DesignError, match="no part is of a plastic to be printed or moulded"):
        export(load_design(paper_design_file), "step,print", tmp_path / "out", progress=told.append)
    assert told == []
    assert not (tmp_path / "out").exists()


def test_the_bill_has_the_inserts_that_the_files_have_holes_for(machine, every):
    bought = {
        row.designation: row.quantity
        for row in bill_of_materials(machine, machine.parts)
        if row.part == "heat-set insert"
    }
    held = Counter()
    for one in every:
        for threads in one.threads:
            if threads.insert is not None:
                held[threads.insert.name] += one.drawn.count * threads.count
    assert held
    assert bought == held
    assert bought.keys() <= catalogue_designations()


def test_inserts_go_in_from_the_face(every):
    """Through the counterbores over the threads of the housing, which are narrower than they."""
    housing = next(one for one in every if one.made.name == "housing").made
    deep, mounting = (t for t in housing_threads(every) if t.insert is not None)
    assert mounting.count == 8
    radius = 0.5 * deep.insert.hole
    holes = [
        (layer.bottom, layer.top, tuple(np.round(hole.centre, 7)))
        for layer in housing.shape.layers
        for hole in layer.shape.holes
        if isinstance(hole, Circle) and hole.radius > 0.99 * radius and hole.radius < 1.1 * radius
    ]
    wide = {place: max(top for _, top, at in holes if at == place) for _, _, place in holes}
    tops = [wide[place] for place in wide if np.hypot(*place) > 0.04]
    assert len([top for top in tops if top > housing.shape.top - 0.1e-3]) >= deep.count


def housing_threads(every):
    return next(one for one in every if one.made.name == "housing").threads
