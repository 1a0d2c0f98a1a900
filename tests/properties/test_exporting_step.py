"""STEP files read back by the kernel: solids, volumes, names, colours, places, bytes."""

from __future__ import annotations

import importlib.util
import re
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from solids_designs import known_design, known_parts, part_named

from cqdd_design.catalog.fits import fit_limits
from cqdd_design.errors import ReadBackError
from cqdd_design.exporting.edm.cut_facts import zones_of
from cqdd_design.exporting.edm.flat_parts import flat_parts
from cqdd_design.exporting.job import ExportJob
from cqdd_design.exporting.solids import step
from cqdd_design.exporting.solids.step import export_step, write_part_step, write_step
from cqdd_design.files import file_label
from cqdd_design.machine import resolve
from cqdd_design.solids.features.holes import ClearanceHole, FittedHole, TappedHole
from cqdd_design.solids.features.kinds import Seat, Shoulder

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("cadquery") is None, reason="cadquery is not installed"
)


@pytest.fixture(scope="module")
def assembly_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("step") / "machine.step"
    write_step(known_design("paper"), known_parts("paper"), path)
    return path


def read_pieces(path: Path) -> dict[str, Any]:
    """The pieces of a STEP file by name."""
    import cadquery

    root = cadquery.Assembly.importStep(str(path))
    return {child.name: child for child in root.children}


def test_reimport_gives_valid_solids_of_the_exact_volumes(assembly_file: Path) -> None:
    found = read_pieces(assembly_file)
    pieces = {piece.name: part for part in known_parts("paper") for piece in part.instances}
    assert set(pieces) == set(found)
    for name, part in pieces.items():
        child = found[name]
        shape = child.obj
        assert shape.ShapeType() == "Solid"
        assert shape.isValid()
        # Against Green's theorem for disc and ring, closed forms for the rest.
        assert shape.Volume() * 1e-9 == pytest.approx(part.exact_volume, rel=1e-5)
        assert child.color.toTuple()[:3] == pytest.approx(part.colour, abs=1e-6)


@pytest.mark.deep
def test_pieces_stand_where_the_mechanism_puts_them(tmp_path: Path) -> None:
    design, parts, angle = known_design("three discs"), known_parts("three discs"), 2.2
    path = tmp_path / "turned.step"
    write_step(design, parts, path, angle)
    found = read_pieces(path)
    for part in parts:
        for piece in part.instances:
            child = found[piece.name]
            pose = piece.pose(design, angle)
            centre = child.obj.moved(child.loc).Center().toTuple()
            drawn = part.shape.mass_properties(1.0)
            for cut in part.cuts:
                drawn = drawn + cut.mass_properties(-1.0)
            wanted = (pose[:3, :3] @ drawn.centre + pose[:3, 3]) * 1e3
            assert np.abs(np.array(centre) - wanted).max() < 1e-6, piece.name


def test_features_are_surfaces_of_their_kind_in_text_and_read_back(assembly_file: Path) -> None:
    """Chamfers and drill points are cones and fillets tori, by two readers and by the features."""
    text = assembly_file.read_text()
    parts = known_parts("paper")
    cuts = [cut for part in parts for cut in part.cuts]
    fillets = sum(len(cut.centres) * sum(map(bool, cut.bulges)) for cut in cuts)
    read = read_pieces(assembly_file)
    first = [read[part.instances[0].name].obj for part in parts]
    faces = Counter(face.geomType() for shape in first for face in shape.Faces())
    assert len(re.findall(r"TOROIDAL_SURFACE\(", text)) == faces["TORUS"] == fillets > 4
    assert len(re.findall(r"CONICAL_SURFACE\(", text)) == faces["CONE"] >= len(cuts)
    tapped = [one for part in parts for one in part.features if isinstance(one, TappedHole)]
    assert len(tapped) >= 5
    for one in tapped:
        drilled = f"{0.5e3 * one.drill:.6g}"
        assert re.search(rf"CYLINDRICAL_SURFACE\('',#\d+,{re.escape(drilled)}0*\)", text), one.name


def test_header_says_what_and_whose(assembly_file: Path) -> None:
    head = assembly_file.read_text(encoding="ascii").split("DATA;")[0]
    assert "FILE_SCHEMA(('AUTOMOTIVE_DESIGN" in head  # AP214
    assert f"design sha256 {known_design('paper').sha256}" in head
    assert "FILE_NAME('machine.step','1970-01-01T00:00:00',('cqdd-design'),('cqdd-design')" in head
    assert "LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.)" in assembly_file.read_text()


def test_header_takes_the_time_it_is_given(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    path = tmp_path / "a.step"
    write_part_step(known_design("paper"), part_named(known_parts("paper"), "ring"), path)
    assert "'2023-11-14T22:13:20'" in path.read_text()


def test_same_design_same_bytes(assembly_file: Path, tmp_path: Path) -> None:
    again = write_step(known_design("paper"), known_parts("paper"), tmp_path / "machine.step")
    assert again.path.read_bytes() == assembly_file.read_bytes()
    assert again.kind == "step"
    assert again.bytes == assembly_file.stat().st_size


def test_disc_has_the_arcs_of_the_drawing_and_no_spline(tmp_path: Path) -> None:
    disc = part_named(known_parts("paper"), "disc")
    path = tmp_path / "disc.step"
    write_part_step(known_design("paper"), disc, path)
    text = path.read_text()
    assert "B_SPLINE" not in text
    shape = disc.shape.layers[0].shape
    # One cylinder an arc of the outline, one a hole.
    assert len(re.findall(r"CYLINDRICAL_SURFACE\(", text)) == len(shape.outer.bulges) + len(
        shape.holes
    )


def test_one_file_for_the_machine_and_one_for_every_part(tmp_path: Path) -> None:
    job = ExportJob(resolve(known_design("paper")), tmp_path, lambda _: None)
    job.__dict__["parts"] = known_parts("paper")
    names = [one.path.name for one in export_step(job)]
    assert names[0] == "cqdd-10.step"
    every = [part.name for part in known_parts("paper")]
    assert names[1:] == [f"cqdd-10-{file_label(name)}.step" for name in every]
    assert {path.name for path in tmp_path.iterdir()} == set(names)


@pytest.mark.deep
def test_ap242_says_so_and_the_next_file_does_not(tmp_path: Path) -> None:
    import cadquery

    disc = part_named(known_parts("paper"), "disc")
    texts = []
    for schema in ("AP242", "AP214", "AP242"):
        path = tmp_path / "disc.step"
        write_part_step(known_design("paper"), disc, path, schema)
        texts.append(path.read_text(encoding="ascii"))
        shape = cadquery.importers.importStep(str(path)).val()
        assert shape.Volume() * 1e-9 == pytest.approx(disc.exact_volume, rel=1e-5)
    assert "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING" in texts[0]
    assert "AUTOMOTIVE_DESIGN" in texts[1]
    assert texts[2] == texts[0]


def test_ap242_carries_the_sizes_that_a_drawing_gives_a_zone(tmp_path: Path) -> None:
    """Read back as product and manufacturing information, of a solid that is whole."""
    from OCP.STEPCAFControl import STEPCAFControl_Reader
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDF import TDF_LabelSequence
    from OCP.TDocStd import TDocStd_Document
    from OCP.XCAFDoc import XCAFDoc_Dimension, XCAFDoc_DocumentTool

    plate = part_named(known_parts("paper"), "carrier plate")
    path = tmp_path / "plate.step"
    write_part_step(known_design("paper"), plate, path, "AP242")
    reader, document = STEPCAFControl_Reader(), TDocStd_Document(TCollection_ExtendedString("x"))
    reader.SetGDTMode(True)
    reader.ReadFile(str(path))
    assert reader.Transfer(document)
    tool = XCAFDoc_DocumentTool.DimTolTool_s(document.Main())
    labels = TDF_LabelSequence()
    tool.GetDimensionLabels(labels)
    read = []
    for i in range(1, labels.Length() + 1):
        faces = TDF_LabelSequence()
        tool.GetRefShapeLabel_s(labels.Value(i), faces, TDF_LabelSequence())
        size = XCAFDoc_Dimension.Set_s(labels.Value(i)).GetObject()
        values = size.GetValue(), size.GetLowerTolValue(), size.GetUpperTolValue()
        read.append((*(round(value, 6) for value in values), faces.Length()))
    # Lower ones as the kernel has them, how far below: 50 h5, 22 H7, the centring bore; 4 H7 of the
    # five seats of pins and of two dowels, each with its faces.
    assert sorted(read) == [
        (4.0, 0.0, 0.012, 2),
        (4.0, 0.0, 0.012, 5),
        (18.4, 0.0, 0.021, 1),
        (22.0, 0.0, 0.021, 1),
        (50.0, 0.011, 0.0, 1),
    ]


def bounds_in(text: str) -> set[tuple[float, float, float]]:
    """Diameter, lower and upper bound of every size of a STEP file, by its text alone, mm."""
    lines = dict(re.findall(r"#(\d+) ?= ?([^;]*);", text.replace("\n", "")))

    def number(key: str) -> float:
        return float(re.search(r"MEASURE(?:_WITH_UNIT)?\(([-\d.E+]+)[,)]", lines[key])[1])

    found = set()
    for limits, size in re.findall(
        r"PLUS_MINUS_TOLERANCE\(#(\d+),#(\d+)\)", "".join(lines.values())
    ):
        lower, upper = re.findall(r"#(\d+)", lines[limits])
        (told,) = (
            one
            for one in lines.values()
            if one.startswith(f"DIMENSIONAL_CHARACTERISTIC_REPRESENTATION(#{size},")
        )
        shown = lines[re.findall(r"#(\d+)", told)[1]]
        (value,) = re.findall(r"#(\d+)", shown.split("(", 1)[1])[:1]
        diameter = float(re.search(r"POSITIVE_LENGTH_MEASURE\(([\d.E+-]+)\)", lines[value])[1])
        found.add(tuple(round(one, 6) + 0.0 for one in (diameter, number(lower), number(upper))))
    return found


@pytest.mark.parametrize("name", ["carrier plate", "disc", "eccentric shaft", "ring clamp"])
def test_bounds_of_a_size_have_the_sign_that_the_zone_has(name: str, tmp_path: Path) -> None:
    """Read from the text: the kernel turns a sign when it writes, and again when it reads."""
    part = part_named(known_parts("paper"), name)
    path = tmp_path / "part.step"
    write_part_step(known_design("paper"), part, path, "AP242")
    zones = {(fit.zone, fit.diameter) for fit in part.fits}
    expected = set()
    for zone, diameter in zones:
        limits = fit_limits(zone, diameter)
        bounds = (1e3 * one for one in (diameter, limits.lower, limits.upper))
        expected.add(tuple(round(one, 6) + 0.0 for one in bounds))
    assert expected
    assert expected <= bounds_in(path.read_text(encoding="ascii"))


def read_back(path: Path) -> list[tuple[str, float, str, int]]:
    """Kind, width, letters of datums in their order, and faces of every tolerance of a file."""
    from OCP.STEPCAFControl import STEPCAFControl_Reader
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDF import TDF_LabelSequence
    from OCP.TDocStd import TDocStd_Document
    from OCP.XCAFDoc import XCAFDoc_Datum, XCAFDoc_DocumentTool, XCAFDoc_GeomTolerance

    reader, document = STEPCAFControl_Reader(), TDocStd_Document(TCollection_ExtendedString("x"))
    reader.SetGDTMode(True)
    reader.ReadFile(str(path))
    assert reader.Transfer(document)
    tool, labels = XCAFDoc_DocumentTool.DimTolTool_s(document.Main()), TDF_LabelSequence()
    tool.GetGeomToleranceLabels(labels)
    read = []
    for i in range(1, labels.Length() + 1):
        faces, datums = TDF_LabelSequence(), TDF_LabelSequence()
        tool.GetRefShapeLabel_s(labels.Value(i), faces, TDF_LabelSequence())
        tool.GetDatumWithObjectOfTolerLabels_s(labels.Value(i), datums)
        letters = [
            XCAFDoc_Datum.Set_s(datums.Value(k)).GetObject() for k in range(1, datums.Length() + 1)
        ]
        places: dict[int, list[str]] = {}
        for one in letters:
            places.setdefault(one.GetPosition(), []).append(one.GetName().ToCString())
        stated = XCAFDoc_GeomTolerance.Set_s(labels.Value(i)).GetObject()
        kind = stated.GetType().name.rpartition("_")[2]
        # Those that share a place in the frame are a common datum.
        named = "".join("-".join(sorted(places[one])) for one in sorted(places))
        read.append((kind, round(stated.GetValue(), 6), named, faces.Length()))
    return sorted(read)


@pytest.mark.parametrize("name", ["carrier plate", "ring clamp", "eccentric shaft"])
def test_ap242_carries_form_place_and_datums(name: str, tmp_path: Path) -> None:
    """Of the features, not of what the writer made of them; two letters in their order."""
    part = part_named(known_parts("paper"), name)
    path = tmp_path / "part.step"
    write_part_step(known_design("paper"), part, path, "AP242")
    read = read_back(path)
    wanted: list[tuple[str, float, str]] = []
    for one in part.features:
        if isinstance(one, Seat) and one.cylindricity:
            wanted.append(("Cylindricity", one.cylindricity, ""))
        if isinstance(one, Seat) and one.position:
            wanted.append(("Position", one.position, one.refers))
        elif isinstance(one, Seat) and one.refers:
            wanted.append(("TotalRunout", one.run_out, one.refers))
        if isinstance(one, Shoulder) and one.refers:
            wanted.append(("CircularRunout", one.run_out, one.refers))
        if isinstance(one, FittedHole | TappedHole | ClearanceHole):
            wanted.append(("Position", one.position, one.refers))
    assert [one[:3] for one in read] == sorted(
        (kind, round(1e3 * value, 6), letters) for kind, value, letters in wanted
    )
    assert all(faces >= 1 for *_, faces in read)


def test_what_the_plate_and_clamp_say_of_their_holes(tmp_path: Path) -> None:
    """Five threads of pins within 0.2 mm of A; eight holes of the clamp to its face, then axis."""
    design = known_design("paper")
    path = tmp_path / "part.step"
    write_part_step(design, part_named(known_parts("paper"), "carrier plate"), path, "AP242")
    assert ("Position", 0.2, "A", 5) in read_back(path)
    write_part_step(design, part_named(known_parts("paper"), "ring clamp"), path, "AP242")
    assert ("Position", 0.2, "BA", 8) in read_back(path)


@pytest.mark.parametrize(("name", "rounds"), [("disc", 1 + 5), ("ring", 8 + 24)])
def test_ap242_carries_the_profiles_that_wire_cuts(name: str, rounds: int, tmp_path: Path) -> None:
    """All walls but the bore and the holes, or the outside between its grooves of three arcs."""
    design, part = known_design("paper"), part_named(known_parts("paper"), name)
    path = tmp_path / "part.step"
    write_part_step(design, part, path, "AP242")
    (read,) = (one for one in read_back(path) if one[0] == "ProfileOfLine")
    flat = next(one for one in flat_parts(resolve(design)) if one.label == name)
    zones, walls = zones_of(flat, design), len(part.solid.Faces()) - 2
    letters = "AC" if name == "disc" else "A"
    assert read == ("ProfileOfLine", round(1e3 * zones.profile, 6), letters, walls - rounds)
    assert b"GEOMETRIC_TOLERANCE_WITH_MODIFIERS((.COMMON_ZONE.))" in path.read_bytes()
    if name == "disc":
        assert ("Position", round(1e3 * zones.hole_position, 6), "A", 5) in read_back(path)


def test_a_file_that_lost_a_tolerance_is_not_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from cqdd_design.exporting.solids import pmi_file

    def nothing(self: object, zone: object) -> None:
        """As a kernel that drops what it does not know."""

    monkeypatch.setattr(pmi_file._Sheet, "add_zone", nothing)
    nut = part_named(known_parts("paper"), "bearing nut")
    with pytest.raises(ReadBackError, match="0 tolerances instead of one with 1 and 2"):
        write_part_step(known_design("paper"), nut, tmp_path / "nut.step", "AP242")
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_lost_a_solid_is_not_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import cadquery

    def without_last(design: object, parts: object, crank_angle: float = 0.0) -> object:
        assembly = cadquery.Assembly(name="short")
        for part in list(parts)[:-1]:  # type: ignore[call-overload]
            assembly.add(part.solid, name=part.name)
        return assembly

    monkeypatch.setattr("cqdd_design.solids.assembly.build_assembly", without_last)
    with pytest.raises(ReadBackError, match="holds 24 solids instead of 25"):
        write_step(known_design("paper"), known_parts("paper"), tmp_path / "short.step")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("given", "wanted"),
    [
        ("plain", "plain"),
        ("it's", "it''s"),
        ("a\\b", "a\\\\b"),
        ("Zahnräder", "Zahnr\\X2\\00E4\\X0\\der"),
        ("\N{GEAR}\N{ROBOT FACE}", "\\X2\\2699\\X0\\\\X4\\0001F916\\X0\\"),
    ],
)
def test_names_are_written_as_the_standard_wants(given: str, wanted: str) -> None:
    assert step._text(given) == wanted


def test_a_name_beyond_ascii_survives(tmp_path: Path) -> None:
    import cadquery

    design = known_design("paper").replacing({"name": "Bein's Gelenk ö"})
    path = tmp_path / "named.step"
    write_part_step(design, part_named(known_parts("paper"), "bearing nut"), path)
    assert path.read_bytes().isascii()
    root = cadquery.Assembly.importStep(str(path))
    assert root.name == "Bein's Gelenk ö"
    assert root.children[0].obj.isValid()
