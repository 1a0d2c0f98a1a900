"""What a command tells fits 80 columns, and is folded between words.

The commands that work on a design are held to it where other tests run them: all that the pages
show in test_cli_docs.py, and those of test_cli_tolerance.py, test_cli_compare.py and others.
"""

from __future__ import annotations

import random
import re

import pytest
from terminal_lines import too_wide

from cqdd_design.catalog import browse
from cqdd_design.cli.fitting import WIDTH
from cqdd_design.cli.main import COMMANDS, TORQUE_COMMANDS
from cqdd_design.cli.tables import listing, table
from cqdd_design.gearbox.checks.guide import CHECK_GUIDE

CHEAP = [
    ["catalog"],
    *(["catalog", kind] for kind in browse.COLUMNS),
    ["catalog", "CubeMars RO100 KV55"],
    ["catalog", "AISI 4140 Q&T 540C"],
    ["catalog", "motors", "TQ"],
    ["doctor"],
    ["explain"],
    ["explain", "PIN-BENDING-PEAK"],
    ["size", "--ratio", "10", "--quick", "--verbose"],
]


@pytest.mark.parametrize("arguments", CHEAP, ids=" ".join)
def test_cheap_commands_fit_a_terminal(cqdd, arguments):
    done = cqdd(*arguments)
    assert done.out
    assert too_wide(done.out) == []


def test_every_help_page_fits_a_terminal(cqdd):
    names = [[function.__name__] for function in COMMANDS]
    names += [["torque", name] for name in TORQUE_COMMANDS]
    for name in ([], *names):
        done = cqdd(*name, "--help", environment={"COLUMNS": str(WIDTH)})
        assert done.code == 0
        assert too_wide(done.out) == [], name


# folding ----------------------------------------------------------------------------------------


def test_folding_keeps_every_word_and_number():
    """Tables of words of any length: nothing is lost, nothing cut, numbers stay whole."""
    draw = random.Random(3)
    letters = "abcdefghij"
    for _ in range(200):
        columns = draw.randint(2, 9)
        head = [_phrase(draw, letters, 3) for _ in range(columns)]
        rows = [
            [
                _phrase(draw, letters, 4),
                *(f"{draw.uniform(-1e4, 1e4):.4g}" for _ in head[2:]),
                _phrase(draw, letters, 9),
            ]
            for _ in range(draw.randint(1, 4))
        ]
        text = listing(rows, head=head)
        assert too_wide(text) == []
        words = text.replace(";", " ").split()
        for cell in (cell for row in rows for cell in row):
            assert set(cell.split()) <= set(words)


def _phrase(draw: random.Random, letters: str, most: int) -> str:
    count = draw.randint(1, most)
    return " ".join("".join(draw.choices(letters, k=draw.randint(1, 9))) for _ in range(count))


def test_what_fits_is_not_folded():
    rows = [["a b", "1"], ["c", "22"]]
    assert table(rows, head=["name of it", "x"], right=(1,)) == (
        "name of it   x\n----------  --\na b          1\nc           22"
    )


def test_names_are_the_last_to_be_folded():
    name, source = "a name of five words", "w " * 60
    told = table([[name, "1", source.strip()]], head=["name", "n", "source"])
    assert re.search(rf"^{name}  1  w w", told, re.M)


def test_every_line_of_the_guide_can_be_told():
    """`explain` of any check, without running each."""
    from cqdd_design.cli.explain import _paragraph

    for guide in CHECK_GUIDE.values():
        for text in (guide.formula, guide.why, guide.source):
            assert too_wide(_paragraph("rule", text)) == []


def test_a_long_address_leaves_columns_in_line():
    """A deep project folder put each name of `doctor` on a line of its own."""
    for folder in ("/home/somebody/robots/knee", "/home/" + 40 * "k", "/home/" + 90 * "k"):
        rows = [["ok", "Python", f"3.11.7 at {folder}/.venv/bin/python3"]]
        rows += [["optional", "compiled kernels", f"{folder}/.cache/kernels"]]
        text = table(rows)
        starts = [line.split("  ")[0] for line in text.splitlines() if re.match(r"\w+  ", line)]
        assert starts == ["ok", "optional"]
        assert f"{folder}/.venv/bin/python3" in text.split()
        assert too_wide(text) == []
