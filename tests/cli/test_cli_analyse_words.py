"""`analyse` for people: words and units, and the verdict's status at what has a limit."""

from __future__ import annotations

import re

import pytest
from terminal_lines import too_wide

from cqdd_design.cli.analysis_text import _JUDGED, _SECTIONS, section_of
from cqdd_design.cli.check_names import CHECKS
from cqdd_design.cli.tables import number
from cqdd_design.terms import UNITS, term


@pytest.fixture
def told(cqdd, paper_design_file):
    return cqdd("analyse", paper_design_file, "--angles", "24").out


@pytest.fixture
def document(cqdd, paper_design_file):
    return cqdd("analyse", paper_design_file, "--angles", "24", "--json").document


def test_no_key_is_left_and_every_line_fits(told):
    assert too_wide(told) == []
    assert re.findall(r"\b[a-z]+_\w+", told.replace("(--torque)", "")) == []
    assert re.search(r"^ +greatest ring force +\d+  N$", told, re.M)
    assert re.search(r"^ +stiffness +[\d.]+  N\*m/arcmin$", told, re.M)


def test_what_is_not_met_is_marked_once_with_value_and_limit(told, document):
    """Every failing line of the verdict, and no other, by value and limit beside its word."""
    failing = [check for check in document["checks"] if check["status"] == "fail"]
    assert len(failing) == len(re.findall(r"^FAIL  ", told, re.M)) > 10
    rows = [" ".join(line.split()) for line in told.splitlines() if line.startswith("FAIL")]
    for check in failing:
        most = "at most" if check["sense"] == "max" else "at least"
        shown = [number(check["value"]), check["unit"], most, number(check["limit"])]
        assert any(row.endswith(" ".join(filter(None, shown))) for row in rows), check["id"]


@pytest.mark.deep
def test_a_figure_is_judged_only_at_the_torque_of_the_verdict(cqdd, paper_design_file, told):
    """At 60 N*m the stress of a disc is another than the one that is limited."""
    judged = re.search(r"^pass +greatest ligament stress +(\S+) +MPa +at most", told, re.M)
    other = cqdd("analyse", paper_design_file, "--torque", "60 N*m", "--angles", "24").out
    line = re.search(r"^ +greatest ligament stress +(\S+) +MPa$", other, re.M)
    assert judged
    assert line
    assert float(line[1]) < float(judged[1])
    assert "contact equilibrium of perfect parts, at 60 N*m (--torque)" in other
    assert "at the requirements, not at the torque asked for" in other


def test_sections_say_what_they_stand_for(told):
    for heading in (
        "contact equilibrium of perfect parts, at the peak torque",
        "precision, at the continuous torque",
        "geometry of disc and ring",
    ):
        assert f"{heading}\n{'-' * len(heading)}\n" in told


def test_limits_belong_to_one_section():
    """A beginning that fits no id would lose a limit to the last section."""
    starts = [start for section in _SECTIONS for start in section.limits]
    assert len(starts) == len(set(starts))
    for start in starts:
        assert any(one.startswith(start) for one in CHECKS), start
    assert section_of("PIN-BENDING-PEAK") == "contact"
    assert section_of("PIN-SHEAR-PEAK") == "output_pins"
    assert section_of("MOTOR-PEAK") == ""
    assert {name for name in _JUDGED.values()} <= set(CHECKS)
    for (section, _), name in _JUDGED.items():
        assert section_of(name) == section


def test_every_figure_has_a_unit_or_none_in_its_key(document):
    """No unit is left in the words, and words differ within a section where keys do."""
    parts = {part for unit in UNITS for part in unit.split("_")} - {"per", "min", "s", "rad"}
    for name, section in document["results"].items():
        words = [term(key) for key in section] if isinstance(section, dict) else []
        assert len(set(words)) == len(words), name
        for one in words:
            assert not parts & set(one.words.split()), one
