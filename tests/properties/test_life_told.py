"""A life that is hardly any is told alike everywhere, and as a number only to programs."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

import cqdd_design as cq
from cqdd_design.cli.analysis_text import _limit_rows
from cqdd_design.cli.tables import checks_table, headline_table
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.report.ink.numbers import THIN, with_unit
from cqdd_design.report.judgement.check_rows import check_row
from cqdd_design.terms import hardly, life_text
from cqdd_design.verdict.headline import Figure

ROOT = Path(__file__).resolve().parents[2]
SHORT = 1.178e-5
"""Hours: what output pins under twelve times their stress last."""


@pytest.mark.parametrize(
    ("hours", "told"), [(0.0, True), (SHORT, True), (0.999, True), (1.0, False), (1e3, False)]
)
def test_less_than_an_hour_is_told_as_such(hours, told):
    assert (hardly(hours, "h") == "under 1") is told
    assert (life_text(hours) == "under 1 h") is told
    assert (with_unit(hours, "h") == f"under 1{THIN}h") is told
    assert hardly(hours, "N*m") == hardly(-hours - 1.0, "h") == ""


def test_longer_lives_keep_their_digits():
    assert life_text(677.25, 3) == "677 h"
    assert life_text(2.706e5) == "270600 h"
    assert with_unit(677.25, "h", 3) == f"677{THIN}h"


@pytest.mark.parametrize(
    ("hours", "told"), [(270631.8, "270632 h"), (677.25, "677.2 h"), (SHORT, "under 1 h")]
)
def test_a_figure_of_the_verdict_has_no_exponent(hours, told):
    figure = Figure("life", "life", hours, "h", 1000.0, "pass", "duty")
    assert figure.told == f"pass     life: {told}, 1000 asked"


def test_terminal_and_report_tell_a_check_alike():
    check = build_check("BEARING-LIFE", SHORT, 1000.0, "together", "larger", model="duty")
    assert re.search(r"BEARING-LIFE +under 1 +>= +1000 +h ", checks_table([check]))
    ((_, _, value, unit, limit),) = _limit_rows([check])
    assert (value, unit, limit) == ("under 1", "h", "at least 1000")
    assert check_row(check)["value"] == f"under 1{THIN}h"
    assert check.to_dict()["value"] == SHORT


@pytest.mark.deep
def test_every_output_of_a_design_says_the_same_of_its_life(paper_design_file):
    judged = cq.check(paper_design_file)
    life = next(one for one in judged.verdict.headline if one.id == "life")
    assert life.value is not None
    assert life.value < 1.0
    assert life.told == "fail     life: under 1 h, 1000 asked"
    assert re.search(r"FAIL +life +under 1 +1000 +h", headline_table(judged.verdict))
    assert json.loads(json.dumps(life.to_dict()))["value"] == life.value
    assert "under 1 h" in next(
        line.substituted for line in judged.checks if line.id == "PIN-BENDING-CONTINUOUS"
    )
    page = (ROOT / "docs" / "gallery.md").read_text(encoding="utf-8")
    assert "| life | under 1 | 1000 | h | fail |" in page
    assert not re.search(r"\| life \| \d\S*e-", page)
