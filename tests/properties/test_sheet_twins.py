"""PDF, SVG and DXF of a sheet: the same words, in a DXF that another program reads rightly."""

from __future__ import annotations

import io
import re
from collections import Counter
from xml.etree import ElementTree

import ezdxf
import pytest

from cqdd_design.design import load_design
from cqdd_design.exporting.edm.cut_facts import facts_of
from cqdd_design.exporting.edm.flat_parts import flat_parts
from cqdd_design.exporting.sheets.assembly_facts import AssemblyFacts
from cqdd_design.exporting.sheets.assembly_sheet import draw_assembly
from cqdd_design.exporting.sheets.cut_sheet import draw_cut_sheet
from cqdd_design.exporting.sheets.drawing import AXIS, OUTLINE, THIN, new_sheet
from cqdd_design.exporting.sheets.lettering import printable
from cqdd_design.exporting.sheets.part_facts import PartFacts
from cqdd_design.exporting.sheets.part_sheet import draw_part, plan_sheet
from cqdd_design.exporting.sheets.sheet_files import twins
from cqdd_design.machine import resolve

SVG = "{http://www.w3.org/2000/svg}"
DRAWINGS = {
    "disc": "\u00d8\u00b1\u00b5\u00b0",
    "eccentric shaft": "\u00d8\u00b1\u00b0\u00d7",
    "carrier plate": "\u00d8\u00b1\u00b0\u00d7",
    "assembly": "\u00d7\u00b7\u00b3",
}
"""Of each, the signs that no other alphabet has and that are to come through."""


@pytest.fixture(scope="module")
def machine(paper_design_file):
    return resolve(load_design(paper_design_file))


def draw(name, machine):
    if name == "assembly":
        return draw_assembly(AssemblyFacts(machine))
    if name in ("disc", "ring"):
        flat = next(one for one in flat_parts(machine) if one.label == name)
        return draw_cut_sheet(facts_of(flat, machine))
    part = next(one for one in machine.parts if one.name == name)
    return draw_part(PartFacts(part, machine.given))


def words_of_pdf(data):
    shown = re.findall(rb"\(((?:\\.|[^\\)])*)\) Tj", data)
    return Counter(re.sub(r"\\(.)", r"\1", text.decode("cp1252")) for text in shown)


def words_of_svg(text):
    return Counter(
        "".join(node.itertext()) for node in ElementTree.fromstring(text).iter(f"{SVG}text")
    )


def words_of_dxf(document):
    found = []
    for entity in document.modelspace():
        inner = entity.virtual_entities() if entity.dxftype() == "DIMENSION" else [entity]
        for one in inner:
            if one.dxftype() == "TEXT":
                found.append(one.dxf.text)
            elif one.dxftype() == "MTEXT":
                found += one.plain_text().split("\n")
    return Counter(found)


@pytest.mark.parametrize("name", DRAWINGS)
def test_twins_have_the_same_words(name, machine):
    files = twins(draw(name, machine), name)
    document = ezdxf.read(io.StringIO(files["dxf"]))
    words = words_of_pdf(files["pdf"])
    assert sum(words.values()) > 60
    assert words == words_of_svg(files["svg"]) == words_of_dxf(document)
    assert "?" not in "".join(words)
    assert all(text.strip() for text in words)
    assert set(DRAWINGS[name]) <= set("".join(words))
    used = {entity.dxf.layer for entity in document.modelspace()}
    assert {OUTLINE, THIN, AXIS} <= used <= {layer.dxf.name for layer in document.layers}
    assert document.units == ezdxf.units.MM


def test_twins_that_differ_would_be_seen():
    sheet = new_sheet(1.0)
    sheet.text(50.0 + 50.0j, "one (\\) \u00d87")
    files = twins(sheet, "")
    document = ezdxf.read(io.StringIO(files["dxf"]))
    assert words_of_dxf(document) == words_of_pdf(files["pdf"]) == Counter(["one (\\) \u00d87"])
    document.modelspace().add_text("two")
    assert words_of_dxf(document) != words_of_svg(files["svg"])


def test_a_dxf_names_a_font_that_there_is_and_that_is_as_wide(machine):
    """``*monospace`` is a name of ezdxf alone: other programs put their widest font for it."""
    files = twins(draw("disc", machine), "")
    document = ezdxf.read(io.StringIO(files["dxf"]))
    named = {style.dxf.name: style.dxf.font for style in document.styles}
    styles = {one.dxf.style for one in document.modelspace().query("TEXT")}
    assert {named[style] for style in styles} == {"arial.ttf"}
    # Dimensions are laid out before, without any font: the file is the same on every computer.
    assert new_sheet(1.0).drawing.styles.get(styles.pop()).dxf.font == "*monospace"


def test_signs_that_a_sheet_has_are_in_its_font():
    assert (
        printable("\u00b2\u00b3\u00b7\u00b5\u00b0\u00b1\u00d8\u00d7")
        == "\u00b2\u00b3\u00b7\u00b5\u00b0\u00b1\u00d8\u00d7"
    )
    assert printable("\u03b1") == "?"


def test_extension_lines_begin_where_an_eccentric_body_ends(machine):
    """They hung 2 eccentricities off the side that the lobe turns away from."""
    one = resolve(machine.given.replacing({"reducer.disc_count": 1}))
    shaft = next(part for part in one.parts if part.name == "eccentric shaft")
    (lobe,) = (f for f in shaft.features if f.name == "lobe 1")
    section = plan_sheet(PartFacts(shaft, one.given)).section.shape
    upper, lower = section.directions
    assert (upper, lower) == pytest.approx((0.0, 3.141592653589793))
    reach = {round(1e6 * height): below for height, below in section.heights}
    assert reach[round(1e6 * lobe.top)] == pytest.approx(0.5 * lobe.diameter - lobe.centre[0])
    assert lobe.centre[0] > 1e-3
