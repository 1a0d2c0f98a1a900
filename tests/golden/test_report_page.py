"""What the page says, apart from how a browser draws it."""

from __future__ import annotations

import base64
import csv
import dataclasses
import html
import io
import json
import re
from collections import Counter
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest
from shared_outputs import paper_input as shared_input
from shared_outputs import report_input, sized

from cqdd_design.design import Design, load_design
from cqdd_design.files import WrittenFile
from cqdd_design.gearbox.heat.expansion import HOTTEST
from cqdd_design.machine import resolve
from cqdd_design.machine.heat_nodes import by_node
from cqdd_design.report import ReportInput, build_report
from cqdd_design.report.gearbox.masses import bodies_view
from cqdd_design.report.ink.mathml import lowered
from cqdd_design.report.ink.tables import readable_tables
from cqdd_design.report.judgement.check_rows import printed
from cqdd_design.report.judgement.origins import values_by_group
from cqdd_design.report.machine_view.balloons import legend
from cqdd_design.results import Check

VOID = {"meta", "link", "br", "hr", "img", "input", "col", "circle", "line", "path", "rect"}


@pytest.fixture(scope="module")
def paper_input() -> ReportInput:
    return shared_input()


@pytest.fixture(scope="module")
def page(paper_input: ReportInput) -> str:
    return build_report(paper_input)


def text_of(markup: str) -> str:
    """The words of a page, blanks made one."""
    plain = re.sub(r"<(script|style)\b.*?</\1>", " ", markup, flags=re.S)
    plain = re.sub(r"<[^>]+>", " ", plain)
    return re.sub(r"\s+", " ", plain.replace("\u202f", " ").replace("&#8239;", " "))


def test_the_same_input_gives_the_same_bytes(paper_input: ReportInput, page: str) -> None:
    assert build_report(paper_input) == page


def test_one_file_of_modest_size(page: str) -> None:
    assert len(page.encode()) < 1_500_000
    assert not re.search(r"\b(?:src|href)\s*=\s*[\"'](?!#|data:)", page), "points outside itself"
    assert not re.search(r"url\((?!#)|@import|https?://(?!www\.w3\.org)", page)


class _Tags(HTMLParser):
    """Checks that tags close in order, and collects ids."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.ids: Counter[str] = Counter()
        self.wrong: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.ids.update(value for name, value in attrs if name == "id" and value)
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.ids.update(value for name, value in attrs if name == "id" and value)

    def handle_endtag(self, tag: str) -> None:
        if tag in VOID:
            return
        if not self.open or self.open.pop() != tag:
            self.wrong.append(tag)


def test_tags_close_and_ids_are_unique(page: str) -> None:
    tags = _Tags()
    tags.feed(page)
    assert tags.wrong == []
    assert tags.open == []
    assert [name for name, count in tags.ids.items() if count > 1] == []


def test_the_paper_s_design_is_told_plainly(page: str, paper_input: ReportInput) -> None:
    words = text_of(page)
    lines = paper_input.verdict.lines
    failed = sum(line.status == "fail" for line in lines)
    assert failed >= 12
    assert "Does not meet its requirements" in words
    assert f"{paper_input.verdict.sentence}." in words
    assert f"{failed} FAIL" in words
    assert "Judged at 120 N·m peak and 40 N·m continuous torque" in words
    # The paper's shear figure, and the same screws with shared shear and in bending.
    assert "The paper prints 59.13 N·m a pin and 295.65 N·m in all for these screws" in words
    for capacity in ("295.65 N·m", "140.84 N·m", "8.47 N·m"):
        assert capacity in words


def test_every_check_is_there_in_full(page: str, paper_input: ReportInput) -> None:
    for check in paper_input.verdict.lines:
        at = page.index(f'<tbody id="{check.id}">')
        block = page[at : page.index("</tbody>", at)]
        words = text_of(block)
        why = printed(check.why).split("'")[0]
        assert text_of(lowered(why)) in words, check.id
        assert "Source: " in words
        assert ('aria-label="margin ' in block) == check.known
        assert f"Value: {printed(check.basis).partition(chr(39))[0]}" in words
        assert ("To pass:" in words) == (not check.satisfied), check.id
        assert "<math" in block or 'class="prose-formula"' in block
    assert page.count("<math") > 40


def test_remedies_of_failing_checks_stand_in_the_verdict(
    page: str, paper_input: ReportInput
) -> None:
    verdict = page[page.index('id="verdict"') : page.index('id="requirements"')]
    for check in paper_input.verdict.lines:
        assert (f'href="#{check.id}"' in verdict) == (not check.satisfied), check.id


def test_every_value_has_its_origin(page: str, paper_input: ReportInput) -> None:
    rows = dict(
        re.findall(r'<td title="([\w.]+)">.*?<span class="chip (\w+)">\2</span>', page, flags=re.S)
    )
    nested = [key for key in paper_input.design.dotted_keys() if "." in key]
    assert sorted(rows) == sorted(nested)
    # What is left to the program is folded away.
    open_, closed = (
        re.sub(r"<details.*?</details>", "", page, flags=re.S),
        "".join(re.findall(r"<details.*?</details>", page, flags=re.S)),
    )
    for key, origin in rows.items():
        assert (f'title="{key}"' in closed) == (origin == "default"), key
        assert (f'title="{key}"' in open_) != (origin == "default"), key
    assert rows["requirements.ratio"] == "paper"
    assert rows["requirements.input_speed"] == "derived"
    assert rows["reducer.eccentricity"] == "assumed"
    assert rows["reducer.output_pins.circle_radius"] == "paper"
    assert rows["reducer.ring.relief_clearance"] == "default"
    assert {"reducer.eccentricity", "motor.name"}.isdisjoint(paper_input.design.assumed)


@pytest.mark.deep
def test_a_design_without_remarks_knows_given_default_and_derived() -> None:
    design = Design.from_mapping(
        {
            "reducer": {
                "ratio": 10,
                "ring_pitch_radius": "32 mm",
                "eccentricity": "1.6 mm",
                "ring_pin_diameter": "7 mm",
                "output_pins": {"count": 6},
                "cam_bearing": {"designation": "6902"},
            }
        }
    )
    page = build_report(report_input(design))
    rows = dict(re.findall(r'<td title="([\w.]+)">.*?<span class="chip (\w+)">', page, flags=re.S))
    assert rows["reducer.eccentricity"] == "given"
    assert rows["reducer.output_pins.circle_radius"] == "derived"
    assert rows["requirements.peak_torque"] == "derived"
    assert rows["motor.voltage"] == "default"


@pytest.mark.parametrize(
    ("symbol", "value"),
    [("Z<sub>r</sub>", "32"), ("Z<sub>e</sub>", "1.6"), ("Z<sub>p</sub>", "7")],
)
def test_the_paper_s_symbols_are_mapped(page: str, symbol: str, value: str) -> None:
    closing = page[page.index('id="symbols"') :]
    row = re.search(rf'<tr><td[^>]*><span class="symbol">{symbol}</span>.*?</tr>', closing, re.S)
    assert row is not None
    assert f">{value}\u202fmm<" in row[0]


def test_dimensions_are_those_of_the_design(page: str) -> None:
    front = text_of(page[page.index('id="front-view"') : page.index('id="section-view"')])
    front = front.replace(" \u200b", "").replace("\u200b", "")
    for shown in ("32 mm", "1.6 mm", "⌀ 72 mm", "R 19.5 mm", "⌀ 7.191 mm", "⌀ 28 mm"):
        assert shown in front, shown
    for name in ("Z r", "Z e", "Z p", "Z o"):
        assert name in front, name
    section = text_of(page[page.index('id="section-view"') : page.index('id="mesh-section"')])
    for shown in (
        "8 mm",
        "0.5 mm",
        "16.5 mm",
        "17.5 mm",
        "cam bearing 6902",
        "15 \u00d7 28 \u00d7 7 mm",
    ):
        assert shown in section, shown


def test_text_of_the_design_cannot_become_markup(paper_input: ReportInput) -> None:
    mapping = paper_input.design.to_mapping()
    named = mapping["motor"]["name"]
    mapping["motor"] |= {"name": "<script>alert('motor')</script>", "based_on": named}
    design = Design.from_mapping(mapping)
    comments = {"reducer.eccentricity": "assumed: <img src=x onerror=alert(1)> & more"}
    page = build_report(
        dataclasses.replace(paper_input, machine=resolve(design), comments=comments)
    )
    assert "<script>alert(" not in page
    assert "&lt;script&gt;alert(" in page
    assert "<img" not in page


def test_claims_of_the_paper_are_answered(page: str, paper_input: ReportInput) -> None:
    planetary = text_of(page[page.index('<section id="planetary"') : page.index('id="symbols"')])
    assert paper_input.planetary is not None
    assert len(paper_input.planetary.claims) == 6
    assert "10.5455" in planetary
    assert "12 / 36 / 22 / 70" in planetary


def test_sources_are_those_of_the_checks_and_rows_used(page: str) -> None:
    sources = text_of(page[page.index('id="sources"') : page.index('id="provenance"')])
    for source in ("ISO 281:2007", "ISO 76:2006", "Johnson 1985", "arXiv:2410.16591", "ISO 6336"):
        assert source in sources, source
    for row in (
        "AISI 4140 Q&amp;T 540C:",
        "bearing 6902:",
        "CubeMars RO100 Lite KV55:",
        "7075-T6:",
    ):
        assert row in sources, row


def test_provenance(page: str, paper_input: ReportInput) -> None:
    assert paper_input.design.sha256 in page
    assert paper_input.provenance.time in page


def test_bill_of_materials_and_inertia(page: str, paper_input: ReportInput) -> None:
    bodies = paper_input.bodies
    assert bodies is not None
    bill = text_of(page[page.index('id="bom"') : page.index('id="symbols"')])
    for part in bodies.parts:
        assert part.name in bill
    assert f"{bodies.inertia.total.mass:.4g} kg" in bill
    assert sum(part.mass * part.count for part in bodies.parts) == pytest.approx(
        bodies.inertia.total.mass, rel=1e-12
    )
    inertia = text_of(page[page.index('id="inertia"') : page.index('id="bom"')])
    assert f"{1e4 * bodies.inertia.reflected_input:.4g}" in inertia
    assert "the paper prints 5.01" in inertia
    other = bodies_view(
        paper_input.design.replacing({"reducer.output_pins.circle_radius": "19.6 mm"}), bodies
    )
    assert "paper" not in str(other["reflected"])


def test_what_is_bought_goes_by_the_name_of_an_order(paper_input: ReportInput) -> None:
    """As on the assembly's sheet and in its bill: "SKF * 6200" is a word of the catalogue."""
    bodies = paper_input.bodies
    assert bodies is not None
    parts = [
        dataclasses.replace(part, designation="SKF * 6200")
        if part.name == "shaft bearing"
        else part
        for part in bodies.parts
    ]
    rows = bodies_view(paper_input.design, dataclasses.replace(bodies, parts=parts))["rows"]
    assert [row[2] for row in rows if row[0] == "shaft bearing"] == ["SKF 6200"]
    assert "DIN 988 - 16 \u00d7 22" in {row[2].split(",")[0] for row in rows}
    listed = legend(parts, 900.0, 0.0)[0]
    assert "SKF 6200" in listed
    assert "SKF * " not in listed


def test_without_bodies_and_sizing_their_sections_are_left_out(paper_input: ReportInput) -> None:
    bare = build_report(dataclasses.replace(paper_input, bodies=None))
    for anchor in ("inertia", "bom", "sizing"):
        assert f'id="{anchor}"' not in bare
        assert f'href="#{anchor}"' not in bare


@pytest.mark.deep
def test_a_sized_design_shows_how_it_was_found() -> None:
    found = sized(ratio=10)
    page = build_report(dataclasses.replace(report_input(found.design), sizing=found))
    words = text_of(page[page.index('id="sizing"') : page.index('id="assumptions"')])
    # The paper stands in the report of its own actuator alone.
    assert "appendix" not in words.lower()
    for anchor in ("planetary", "pins", "symbols"):
        assert f'id="{anchor}"' not in page
        assert f'href="#{anchor}"' not in page
    assert "paper" not in text_of(
        page[page.index('id="verdict"') : page.index('id="drawings"')]
    ).replace("paper printed there", "")
    assert f"{found.candidates_screened:,}".replace(",", " ") in words
    for alternative in found.alternatives:
        assert alternative.design.name in words
    for count in found.rejected.values():
        assert count == 0 or f"{count:,}".replace(",", " ") in words


def test_the_first_page_says_what_the_verdict_says(paper_input: ReportInput, page: str) -> None:
    """Badge, sentence and the seven figures, each with what it rests on."""
    first = page[: page.index('id="requirements"')]
    words = text_of(first)
    judged = paper_input.verdict
    assert 'class="badge fail"' in first
    assert len(judged.headline) == 7
    for figure in judged.headline:
        assert printed(figure.basis) in words, figure.id
        shown = "not known" if figure.value is None else f"{figure.value:.3g}"
        assert figure.id in {"life", "mass"} or shown in words, figure.id


def told(results: ReportInput, lines: tuple[Check, ...]) -> str:
    """The page of the same design with other lines."""
    return build_report(replace(results, verdict=replace(results.verdict, lines=lines)))


def test_only_a_yes_is_green(paper_input: ReportInput) -> None:
    """One line that fails or is not known among lines that pass; warnings do not hinder."""
    lines = paper_input.verdict.lines
    passing = tuple(replace(line, value=line.limit) for line in lines if line.limit is not None)
    assert 'class="badge pass"' in told(paper_input, passing)
    for k in range(0, len(passing), 6):
        line = passing[k]
        broken = replace(line, value=2.0 * line.limit if line.sense == "max" else -1.0)
        page = told(paper_input, (*passing[:k], broken, *passing[k + 1 :]))
        wanted = "pass" if broken.status in {"warn", "pass"} else "fail"
        assert f'class="badge {wanted}"' in page, line.id
    unsure = replace(passing[0], value=None)
    page = told(paper_input, (unsure, *passing[1:]))
    assert 'class="badge unknown"' in page
    assert "Not shown to meet its requirements" in page
    gentle = replace(passing[0], value=-1.0, sense="min", severity="warn")
    assert 'class="badge pass"' in told(paper_input, (gentle, *passing[1:]))


def test_stress_of_discs_and_ring_is_a_chapter(paper_input: ReportInput, page: str) -> None:
    chapter = page[page.index('<section id="stress"') :]
    chapter = chapter[: chapter.index("</section>")]
    assert 'id="disc-stress-svg"' in chapter
    words = text_of(chapter)
    for check in paper_input.evidence.stress_checks:
        assert f"{check.value:.3g} MPa" in words
        assert f'<tbody id="{check.id}">' in page
    assert "has it in all of its forces" in words
    without = replace(paper_input.evidence, stress=None)
    judged = replace(paper_input.verdict, evidence=without)
    assert 'id="stress"' not in build_report(replace(paper_input, verdict=judged))


Given = dict[str, str | None]


class _Tables(HTMLParser):
    """Every table: its heads with their scopes, and the cells of its rows with their labels."""

    def __init__(self) -> None:
        super().__init__()
        self.tables: list[
            tuple[list[dict[str, str | None]], list[list[dict[str, str | None]]]]
        ] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag == "table":
            self.tables.append(([], []))
        elif tag == "th":
            self.tables[-1][0].append(dict(attrs))
        elif tag == "tr":
            self.tables[-1][1].append([])
        elif tag == "td":
            self.tables[-1][1][-1].append(dict(attrs))


def test_heads_have_a_scope_and_cells_of_wide_tables_tell_their_column(page: str) -> None:
    found = _Tables()
    found.feed(page)
    assert len(found.tables) > 20
    wide = 0
    for heads, rows in found.tables:
        assert all(head.get("scope") in {"col", "rowgroup"} for head in heads)
        columns = sum(head["scope"] == "col" for head in heads)
        for cells in rows[1:]:
            if columns >= 4 and len(cells) == columns:
                assert all(cell.get("data-label") for cell in cells[1:])
                wide += 1
    assert wide > 100


def test_a_figure_at_the_head_of_a_stacked_row_says_what_it_is() -> None:
    """A name needs no column; an index is written as one."""
    heads = "".join(f"<th>{one}</th>" for one in ("Offset, µm", "S<sub>H</sub>", "B", "C"))

    def row(first: str) -> str:
        cells = f"<td>{first}</td><td>1</td><td>2</td><td>3</td>"
        return readable_tables(
            f"<table><thead><tr>{heads}</tr></thead><tbody><tr>{cells}</tr></tbody></table>"
        )

    for figure in ("0", "6, the design", "-1.5"):
        assert f'<td data-head="Offset, µm">{figure}</td>' in row(figure)
    for name in ("disc", "2 discs", ""):
        assert f"<td>{name}</td>" in row(name)
    assert '<td data-label="S_H">1</td>' in row("disc")


def test_files_travel_with_the_page_and_those_of_the_run_are_linked(
    paper_input: ReportInput, page: str, tmp_path: Path
) -> None:
    """The design is the one that was judged; a drawing beside the page is found from it."""
    carried = dict(
        (name, base64.b64decode(content).decode())
        for content, name in re.findall(
            r'href="data:[\w/]+;base64,([^"]+)" download="([^"]+)"', page
        )
    )
    assert set(carried) == {"cqdd-10.toml", "cqdd-10-checks.csv", "cqdd-10-verdict.json"}
    again = tmp_path / "again.toml"
    again.write_text(carried["cqdd-10.toml"], encoding="utf-8")
    assert load_design(again).sha256 == paper_input.design.sha256
    rows = list(csv.DictReader(io.StringIO(carried["cqdd-10-checks.csv"], newline="")))
    assert [row["id"] for row in rows] == [check.id for check in paper_input.verdict.lines]
    for row, check in zip(rows, paper_input.verdict.lines, strict=True):
        assert row["value"] == ("" if check.value is None else repr(float(check.value)))
    assert json.loads(carried["cqdd-10-verdict.json"])["meets"] == "no"
    beside = WrittenFile(tmp_path / "exports" / "a b.dxf", "dxf", 3, "0" * 64)
    linked = build_report(
        replace(paper_input, files=(beside,), target=tmp_path / "reports" / "x.html")
    )
    assert '<a href="../exports/a%20b.dxf">a b.dxf</a>' in linked


def test_what_is_closest_is_shown_where_nothing_fails(paper_input: ReportInput) -> None:
    lines = tuple(replace(line, value=line.limit) for line in paper_input.verdict.lines)
    assert "Closest to their limits" in told(paper_input, lines)
    assert "Closest to their limits" not in told(paper_input, paper_input.verdict.lines)


def test_the_page_ranks_what_binds_as_the_verdict_does(paper_input: ReportInput) -> None:
    """Not sizes that a search has filled; the terminal and the JSON tell the same list."""
    lines = tuple(
        line if line.status == "pass" else replace(line, value=line.limit)
        for line in paper_input.verdict.lines
    )
    judged = replace(paper_input.verdict, lines=lines)
    page = build_report(replace(paper_input, verdict=judged))
    table = page.partition('<table class="stacked closest">')[2].partition("</table>")[0]
    shown = re.findall(r'href="#([A-Z0-9-]+)"', table)
    assert shown == [line.id for line in judged.limits]
    first = judged.limits[0].title
    assert f"in “{first[0].lower()}{first[1:]}”" in text_of(page)
    assert judged.filled
    for line in judged.filled:
        assert line.id not in shown
        assert f"{line.title[0].lower()}{line.title[1:]}" in html.unescape(text_of(page))


def test_temperatures_are_those_of_the_network(paper_input: ReportInput, page: str) -> None:
    """Every part's, how it is cooled, and that clearances are told on the way there."""
    found = paper_input.evidence.temperatures
    assert found is not None
    section = page.partition('<section id="temperatures"')[2].partition("</section>")[0]
    told = text_of(section)
    assert "1.2 K/W from the winding as stated" in told
    for name, value in by_node(found.steady).items():
        assert f"{name} {float(f'{value:.3g}'):g}" in told
    assert f"the warmest of the gearbox at {HOTTEST:g} °C" in told


def test_no_keys_plain_units_and_powers_are_left_in_the_text(page: str) -> None:
    text = text_of(re.sub(r"<(script|style|code|svg).*?</\1>", "", page, flags=re.S))
    assert not re.findall(r"\b\d(?:\.\d+)?e[-+]\d+", text)
    for plain in ("degC", "S_u", "S_y", "N*m", "<=", ">="):
        assert plain not in text, plain


def test_every_table_of_a_design_has_a_heading_in_words(paper_input: ReportInput) -> None:
    groups = values_by_group(paper_input.design, {})
    assert not [name for name, _ in groups if name == name.lower()]
