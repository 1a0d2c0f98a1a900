"""One thing has one name, and one unit one spelling, in commands, documents, report and pages."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

import cqdd_design
from cqdd_design.catalog import browse
from cqdd_design.gearbox.tolerance.evaluate import OUTPUTS
from cqdd_design.report.ink.numbers import pretty_unit
from cqdd_design.terms import PHRASES, UNITS, term

PACKAGE = Path(cqdd_design.__file__).parent
REPOSITORY = PACKAGE.parent

#: What we say instead of what others say.
NAMES = {
    r"disks?\b(?! is full)(?<!from disk)(?<!to disk)(?<!on disk)": "disc",
    r"(?:gear[ -]box|gearheads?|speed reducer)\b": "gearbox",
    r"(?:annulus|ring gear|ring wheel|outer ring gear)\b": "ring",
    r"(?:lifetime|life time|lifespan|service life)\b": "life",
    r"(?:free play|free-play|angular play)\b": "backlash",
    r"(?:flexspline|cyclo(?:idal)? (?:wheel|gear))\b": "disc",
    r"(?:pin wheel)\b": "pinwheel",
    r"(?:torsional rigidity|spring rate of the gearbox)\b": "stiffness",
    r"(?:analyz\w+|aluminum|behavior)\b": "British spelling",
}
#: How sentences spell units: as design files take them; columns of data files have theirs in
#: square brackets, and files for other programs those programs' own.
UNITS_OF_SENTENCES = {
    r"(?:(?<=\d )|(?<=^ ))N m\b": "N*m",
    r"(?<!\[)\bdeg C\b": "degC",
    r"\b(?:kg|g)\*m?m2\b": "kg*m^2",
    r"\bmm3\b(?!_)": "mm^3",
}
ELSEWHERE = (
    "exporting/",  # drawings, cards and headers of other programs
    "report/",  # prints N·m and °C itself
    "solids/",
    "catalog/",
    "terms.py",  # the last parts of keys
)


def strings(path: Path) -> Iterator[tuple[int, str]]:
    """Every string of a module but its docstrings; a formatted value reads as the digit 0."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    described, inside = set(), set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            described.add(id(node.value))
        if isinstance(node, ast.JoinedStr):
            inside |= {id(part) for part in ast.walk(node) if part is not node}
    for node in ast.walk(tree):
        if id(node) in described or id(node) in inside:
            continue
        if isinstance(node, ast.JoinedStr):
            parts = [part.value if isinstance(part, ast.Constant) else "0" for part in node.values]
            yield node.lineno, "".join(map(str, parts))
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.lineno, node.value


def misnamed(text: str, banned: dict[str, str]) -> list[tuple[str, str]]:
    return [
        (found[0], preferred)
        for pattern, preferred in banned.items()
        for found in re.finditer(rf"(?<![\w-]){pattern}", text, re.I)
    ]


def test_modules_say_one_name_and_spell_one_unit():
    wrong = []
    for path in sorted(PACKAGE.rglob("*.py")):
        place = path.relative_to(PACKAGE).as_posix()
        for line, text in strings(path):
            if " " not in text:
                continue  # a key or a word that a program matches
            found = misnamed(text, NAMES)
            if not place.startswith(ELSEWHERE):
                units = {p: q for p, q in UNITS_OF_SENTENCES.items() if re.search(p, text)}
                found += [(p, q) for p, q in units.items()]
            wrong += [f"{place}:{line}: {was!r}, say {better}" for was, better in found]
    assert wrong == []


@pytest.mark.parametrize("folder", ["cqdd_design/report/templates", "docs", "examples", "."])
def test_pages_say_one_name(folder):
    pages = [
        page
        for pattern in ("*.html", "*.md")
        for page in sorted((REPOSITORY / folder).glob(pattern))
        if page.name not in {"CHANGELOG.md", "bibliography.md"}
    ]
    for page in pages:
        text = re.sub(r"https?://\S+|`[^`]*`", "", page.read_text(encoding="utf-8"))
        assert misnamed(text, NAMES) == [], page.name


def test_the_reader_sees_what_is_wrong():
    """The patterns above find what they are for, and leave what they should."""
    assert misnamed("two Disks of a gear box, lifetime 3 h", NAMES) == [
        ("Disks", "disc"),
        ("gear box", "gearbox"),
        ("lifetime", "life"),
    ]
    assert misnamed("the disk is full; discs are read back from disk", NAMES) == []
    assert re.search(next(iter(UNITS_OF_SENTENCES)), "at 0 N m")
    assert not re.search(next(iter(UNITS_OF_SENTENCES)), "output_torque [N m]")


# keys -------------------------------------------------------------------------------------------


def test_units_of_keys_are_those_of_design_files():
    """Each is read as a quantity, so that a line can be copied into a design."""
    pint = pytest.importorskip("pint")
    registry = pint.UnitRegistry()
    for unit in UNITS.values():
        assert registry.Unit(unit) is not None, unit
    assert all(" " not in unit for unit in UNITS.values())


def test_words_are_words():
    for key, words in PHRASES.items():
        assert words.strip() == words
        assert "_" not in words, key
    for kind, columns in browse.COLUMNS.items():
        told = [term(column) for column in columns]
        assert len(set(told)) == len(told), kind


def test_the_report_says_what_the_command_says():
    """Outputs of toleranced gearboxes, in the table of one and the histograms of the other."""
    from cqdd_design.report.gearbox.tolerances import _named

    for name in OUTPUTS:
        words, unit = term(name)
        assert unit, name
        assert _named(name) == (words, pretty_unit(unit))


#: What a page once called a thing that has words in `terms`.
FORMER = {
    r"(?:forward|backward) efficiency\b": "efficiency_forward, efficiency_backward",
    r"greatest (?:Hertz pressure|force|load) (?:at|of) an? ": "a key that ends in _max",
    r"torque to (?:start it|keep it turning) from": "backdrive_static, backdrive_dynamic",
    r"film at the\b": "thickness",
    r"diameter of the output holes\b": "hole_diameter",
}


def test_pages_and_commands_read_their_words_from_the_terms():
    """Nobody writes by hand what `terms` calls a thing, nor what it was called before."""
    phrases = {words for words in PHRASES.values() if words.count(" ") >= 2 or "," in words}
    wrong = []
    for room in ("report", "cli"):
        for path in sorted((PACKAGE / room).rglob("*.py")):
            for line, text in strings(path):
                if text in phrases or misnamed(text, FORMER):
                    wrong.append(f"{path.relative_to(PACKAGE)}:{line}: {text!r}")
    assert wrong == []


def test_the_reader_of_former_names_sees_them():
    assert misnamed("Forward efficiency at 3 rpm", FORMER)
    assert misnamed("greatest force at a ring tooth", FORMER)
    assert not misnamed("greatest ring force", FORMER)


def test_heads_of_the_reports_tables_begin_alike():
    """With a capital, a figure or nothing; a unit alone stays as it is."""
    small = []
    for path in sorted((PACKAGE / "report" / "templates").glob("*.html")):
        text = path.read_text(encoding="utf-8")
        heads = re.findall(r"<th(?![^>]*colspan)[^>]*>([^<{]+)</th>", text)
        for row in re.findall(r"\btable\(\[([^\]]*)\]", text):
            heads += [name.lstrip("#~") for name in re.findall(r'"([^"]*)"', row)]
        small += [(path.name, head) for head in heads if head[:1].islower()]
    assert small == []
