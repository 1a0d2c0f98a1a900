"""Write the pages and files of docs/ that follow from code and tests.

    python docs/build.py            write them
    python docs/build.py --check    only compare; exit code 1 when one is out of date

* ``design.schema.json``: what ``cqdd-design schema`` prints.
* ``cli.md``: the help of every command, between its markers.
* ``validation.md``: every row of the table of published numbers, as its test compared it.
* ``contact-model.md``: its validations and its comparison with the paper, between their markers.
* ``actuator-model.md``: its validations and the calibrated table, between their markers.
* ``images/*.svg``: the figures of the pages on theory and models, from the code's own results.
* ``measured.md``: measurements of hardware beside predictions, between its markers; what is read
  off records is left as it is where there are none (``../shared/data/measured``).
* ``assumptions.md``: every allowable, between its markers.
* ``cite.md``: CITATION.cff as BibTeX, between its markers.
* ``gallery.md`` and ``images/gallery-*.svg``: designs with their verdict (`gallery.py` sizes them).
"""

from __future__ import annotations

import argparse
import contextlib
import importlib
import io
import json
import os
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from operator import attrgetter
from pathlib import Path
from typing import Any

import gallery
from recorded import records, rows_of

DOCS = Path(__file__).resolve().parent
_NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e[+-]?\d+)?")
BEGIN, END = "<!-- help: written by docs/build.py -->", "<!-- end of help -->"


def schema_file() -> str:
    """The JSON schema of design files."""
    from cqdd_design.design.schema import design_schema

    return json.dumps(design_schema(), indent=2, ensure_ascii=False) + "\n"


def cli_page() -> str:
    """cli.md with the help of every command as it is now."""
    page = (DOCS / "cli.md").read_text(encoding="utf-8")
    before, _, rest = page.partition(BEGIN)
    after = rest.partition(END)[2]
    return f"{before}{BEGIN}\n\n{''.join(_help_texts())}{END}{after}"


def _help_texts() -> Iterator[str]:

    from cqdd_design.cli.main import COMMANDS, TORQUE_COMMANDS, app

    os.environ["COLUMNS"] = "88"
    names = [[function.__name__] for function in COMMANDS]
    names += [["torque", name] for name in TORQUE_COMMANDS]
    for words in names:
        name = " ".join(words)
        caught = io.StringIO()
        with contextlib.redirect_stdout(caught):
            app([*words, "--help"], prog_name="cqdd-design", standalone_mode=False)
        text = "\n".join(line.rstrip() for line in caught.getvalue().strip().splitlines())
        yield f"### {name}\n\n```text\n{text}\n```\n\n"
        yield _kinds(name)


def _kinds(command: str) -> str:
    """The kinds of files of an export command, as a table."""
    from cqdd_design.exporting import KINDS
    from cqdd_design.exporting.estimators.kinds import KINDS as ESTIMATORS

    table = {"export": KINDS, "torque export": ESTIMATORS}.get(command, {})
    rows = [f"| `{kind.name}` | {kind.title} |\n" for kind in table.values()]
    return "".join(["| kind | what is written |\n|---|---|\n", *rows, "\n"]) if rows else ""


def validation_page() -> str:
    """The page of validation tables, from a run of tests/published."""
    from validation import page

    folder = DOCS.parent / "tests" / "published"
    records = [value for _, name, value in rows_of("published") if name == "published"]
    return page(records, folder / "data" / "published_examples.csv")


def _recorded(*names: str) -> str:
    """Table of what the tests of some files recorded, from a run of them."""
    found = records("validation", *names)
    rows = [f"| {' | '.join(one)} |".replace("N m ", "N·m ") for one in found]
    return "\n".join(["| quantity | against | worst met | bound |", "|---|---|---|---|", *rows])


def _validated() -> str:
    """Table of the contact engine's validations."""
    return _recorded("properties/test_contact_validation.py", "published/test_contact_reference.py")


def _actuator_validated() -> str:
    """Table of the simulation's validations, MuJoCo beside it."""
    return _recorded("properties/test_actuator_validation.py", "cli/test_mujoco_bench.py")


def _calibrated() -> str:
    """Every row of the bench before and after calibration, beside the paper's."""
    import measured

    from cqdd_design.actuator.bench.unknowns import UNKNOWNS
    from cqdd_design.report.ink.numbers import pretty_unit

    found = measured.papers_fit()
    head = [
        "| row | unit | paper | computed | calibrated | off | agreement is |",
        "|---|---|---|---|---|---|---|",
    ]
    rows = []
    for row in found.rows:
        measured = "" if row.measured is None else f"{row.measured:.4g}"
        off = "" if row.off is None else f"{round(100.0 * row.off):+d}\u202f%"
        before, after = ("\u2013" if v is None else f"{v:.3g}" for v in (row.before, row.after))
        rows.append(
            f"| `{row.name}` | {pretty_unit(row.unit)} | {measured} | {before} | {after} "
            f"| {off} | {row.relation} |"
        )
    factors = ", ".join(
        f"`{name}` {UNKNOWNS[name].told(value).replace('*', '·')}"
        + (" (at an end of its range)" if name in found.at_an_end else "")
        for name, value in found.factors.items()
    )
    good = ", ".join(f"`{row.name}`" for row in found.within)
    told = (
        f"Fitted: {factors}. Within 20 % (efficiency: 5 points) of the {len(found.predicted)} "
        f"predicted rows: {good}."
    )
    return "\n".join([*head, *rows, "", told])


CLEARANCES = (
    "reducer.modification.equidistant",
    "reducer.output_pins.hole_clearance",
    "reducer.cam_bearing.radial_clearance",
)
EDM_ONLY = dict.fromkeys(
    ("pin_position", "pin_diameter", "eccentricity", "bearing_clearance", "output_position"), 0.0
) | {"tooth_position": 1e-6, "hole_position": 1e-6}


def _all_tolerances(factor: float) -> dict[str, float]:
    """Every tolerance of the paper's design, so many times as wide."""
    from cqdd_design.design import load_design

    usual = load_design(DOCS.parent / "designs" / "cqdd-10.toml").tolerances
    keys = [key for key in type(usual).model_fields if key != "distribution"]
    return {f"tolerances.{key}": factor * getattr(usual, key) for key in keys}


def _paper_cases() -> list[tuple[str, dict[str, float]]]:
    """What is drawn: words, and changes of the paper's design."""
    from cqdd_design.design import load_design

    paper = load_design(DOCS.parent / "designs" / "cqdd-10.toml")

    def clearances(factor: float) -> dict[str, float]:
        return {key: factor * attrgetter(key)(paper) for key in CLEARANCES}

    doubled = clearances(2.0)
    edm = {f"tolerances.{key}": value for key, value in EDM_ONLY.items()}
    return [
        ("wire EDM alone: \u00b12 \u00b5m on every cut and position, pins and cams exact", edm),
        ("all tolerances of the design", {}),
        ("all, at 120 N\u00b7m", {"torque": 120.0}),
        ("all, clearances half as wide again", clearances(1.5)),
        ("all, clearances doubled", doubled),
        ("all three times as wide, clearances doubled", _all_tolerances(3.0) | doubled),
        ("all five times as wide, clearances doubled", _all_tolerances(5.0) | doubled),
        ("holes out of place by 30 \u00b5m, the rest usual", {"tolerances.hole_position": 30e-6}),
    ]


def _paper_table() -> str:
    """Backlash and ripple of ensembles beside what the paper measured."""
    from cqdd_design.design import load_design
    from cqdd_design.gearbox.tolerance.ensemble import make_ensemble
    from cqdd_design.gearbox.tolerance.run import run_ensemble

    paper = load_design(DOCS.parent / "designs" / "cqdd-10.toml")

    def told_of(changes: dict[str, float], samples: int) -> tuple[Any, Any]:
        torque = changes.pop("torque", 40.0)
        ensemble = make_ensemble(paper.replacing(changes), torque=torque)
        told = run_ensemble(ensemble, samples, sensitivity=False).statistics()
        return told["backlash_arcmin"], told["torque_ripple_pp_Nm"]

    backlash, ripple = told_of(_all_tolerances(0.0), 1)
    rows = [
        "| the paper, measured | 7.03 \u00b1 1.3 | 3 (\u00b11.5) | |",
        f"| perfect parts | {backlash['mean']:.1f} | {ripple['mean']:.2f} | |",
    ]
    for words, changes in _paper_cases():
        backlash, ripple = told_of(changes, 400)
        rows.append(
            f"| {words} | {backlash['mean']:.1f} \u00b1 {backlash['std']:.1f} "
            f"| {ripple['mean']:.2f} \u00b1 {ripple['std']:.2f} | {ripple['p95']:.2f} |"
        )
    head = [
        "| 400 gearboxes | backlash, arcmin | ripple, peak to peak, N\u00b7m | its 95 % |",
        "|---|---|---|---|",
    ]
    return "\n".join([*head, *rows])


def contact_page() -> str:
    """contact-model.md with its tables as the tests and ensembles give them now."""
    return _with_tables("contact-model.md", {"validation": _validated, "paper": _paper_table})


def actuator_page() -> str:
    """actuator-model.md with its tables as the tests and the bench give them now."""
    tables = {"calibration": _calibrated, "actuator validation": _actuator_validated}
    return _with_tables("actuator-model.md", tables)


STRENGTHS = (
    "AISI 4140 Q&T 540C",
    "AISI 4140 Q&T 425C",
    "AISI 52100 / 100Cr6 hardened",
    "18-8 shoulder screw (seed-consistent)",
    "Alloy steel 12.9 (ISO 7379)",
)
"""Materials whose limits stand on the page: those of the designs, and of the tables of sources."""


def _allowables() -> str:
    """Every check with its rule, and what the rules come to for some materials."""
    from functools import partial

    from cqdd_design.catalog.materials import find_material
    from cqdd_design.gearbox.checks import allowables
    from cqdd_design.gearbox.checks.guide import CHECK_GUIDE
    from cqdd_design.gearbox.checks.guide_row import HOUSE
    from cqdd_design.report.ink.mathml import signs
    from cqdd_design.report.ink.numbers import pretty_unit
    from cqdd_design.report.judgement.check_rows import printed

    rows = ["| check | rule | unit | missed | source |", "|---|---|---|---|---|"]
    for row in CHECK_GUIDE.values():
        source = row.source.replace(HOUSE, "house rule")
        missed = f"{row.severity}; {row.exception}" if row.exception else row.severity
        cells = (f"`{row.id}`", printed(signs(row.formula)), pretty_unit(row.unit), missed, source)
        rows.append(f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |")
    bending = partial(allowables.pin_bending_limit_continuous, duty_reverses=False)
    limits = (
        allowables.contact_limit_static,
        allowables.contact_limit_fatigue,
        allowables.pin_limit_peak,
        allowables.pin_shear_limit_peak,
        bending,
    )
    strengths = [
        "| MPa | contact, peak | contact, continuous | pin bending, peak | pin shear, peak "
        "| pin bending, continuous |",
        "|---|---|---|---|---|---|",
    ]
    for name in STRENGTHS:
        found = " | ".join(f"{limit(find_material(name)).value / 1e6:.0f}" for limit in limits)
        strengths.append(f"| {name} | {found} |")
    static, fatigue = (
        f"{limit / 1e6:g} MPa"
        for limit in (allowables.HARDENED_STATIC_PRESSURE, allowables.HARDENED_FATIGUE_PRESSURE)
    )
    ranges = (
        f"Contact: the weaker part decides. Steel through-hardened to {allowables.HARDENED_HRC:g} "
        f"HRC has {static} at the peak torque, and with a hard surface {fatigue} at the continuous "
        f"torque. The line over HB holds from {allowables.AGMA_LEAST_HB:g} to "
        f"{allowables.AGMA_MOST_HB:g} HB, above which it stays level. Pin bending at the "
        "continuous torque is what the catalogue tables for the screw, else "
        f"S_u/{1.0 / allowables.PIN_FATIGUE_SHARE:g}, pulsating."
    )
    return "\n".join([*rows, "", ranges, "", *strengths])


def assumptions_page() -> str:
    """assumptions.md with the allowables as the code has them now."""
    return _with_tables("assumptions.md", {"allowables": _allowables})


def _citations() -> str:
    """What CITATION.cff says, as BibTeX."""
    import yaml

    told = yaml.safe_load((DOCS.parent / "CITATION.cff").read_text(encoding="utf-8"))
    (paper,) = told["references"]
    names = " and ".join(one["family-names"] for one in paper["authors"])
    title = " ".join(paper["title"].split())
    number = paper["identifiers"][0]["value"].removeprefix("arXiv:")
    (author,) = told["authors"]
    return "\n".join(
        [
            "```bibtex",
            f"@software{{cqdd_design, title = {{{told['title']}}},",
            f"  author = {{{{{author['name']}}}}},",
            f"  version = {{{told['version']}}}, license = {{{told['license']}}}}}",
            "",
            f"@misc{{cqdd_paper, title = {{{title}}},",
            f"  author = {{{names}}}, year = {{{paper['year']}}},",
            f"  eprint = {{{number}}}, archivePrefix = {{arXiv}}, url = {{{paper['url']}}}}}",
            "```",
        ]
    )


def cite_page() -> str:
    """cite.md with the citation as BibTeX."""
    return _with_tables("cite.md", {"citation": _citations})


def _with_tables(page_name: str, tables: Mapping[str, Callable[[], str]]) -> str:
    """A page with what stands between its markers made anew."""
    page = (DOCS / page_name).read_text(encoding="utf-8")
    for name, make in tables.items():
        begin, end = f"<!-- {name}: written by docs/build.py -->", f"<!-- end of {name} -->"
        before, _, rest = page.partition(begin)
        page = f"{before}{begin}\n\n{make()}\n\n{end}{rest.partition(end)[2]}"
    return page


def _published(group: str) -> list[Any]:
    """What a run of tests/published computed for the rows of a group."""
    rows = records(
        "published", "published/test_losses_published.py", "published/test_film_published.py"
    )
    return [row for row in rows if row[0]["group"] == group]


def measured_page() -> str:
    """measured.md with its tables as records, bench and tests give them now."""
    import measured

    tables = {
        "paper": measured.paper_table,
        "paper parts": measured.paper_parts_table,
        "records": measured.read_table,
        "loops": measured.loop_table,
        "friction": measured.friction_table,
        "parts": measured.parts_table,
        "twists": measured.twist_table,
        "published": lambda: measured.published_table(_published("efficiency by films")),
    }
    if not measured.RECORDS.is_dir():
        for name in ("records", "loops", "friction", "twists"):
            del tables[name]
        print("measured.md: what was read off the records is not compared, they are not there")
    return _with_tables("measured.md", tables)


def _measured_loops() -> str:
    """The figure of measured.md; as it is where there are no records."""
    import measured

    if measured.RECORDS.is_dir():
        return _figure("locked", "loaded")
    print("images/measured-loops.svg is not compared, the records are not there")
    return (DOCS / "images" / "measured-loops.svg").read_text(encoding="utf-8")


def _figure(chapter: str, name: str) -> str:
    """A figure of a page as a file."""
    from figures.sheet import sheet

    drawn = getattr(importlib.import_module(f"figures.{chapter}"), name)
    return sheet(drawn())


PAGES = {
    "design.schema.json": schema_file,
    "cli.md": cli_page,
    "validation.md": validation_page,
    "contact-model.md": contact_page,
    "actuator-model.md": actuator_page,
    "images/theory-profile.svg": lambda: _figure("theory", "profile"),
    "images/theory-forces.svg": lambda: _figure("theory", "forces"),
    "images/contact-teeth.svg": lambda: _figure("contact", "teeth"),
    "images/contact-error.svg": lambda: _figure("contact", "error"),
    "images/actuator-scheme.svg": lambda: _figure("actuator", "scheme"),
    "images/actuator-position.svg": lambda: _figure("actuator", "position"),
    "images/tutorial-gait.svg": lambda: _figure("tutorial", "gait"),
    "images/measured-loops.svg": _measured_loops,
    "measured.md": measured_page,
    "assumptions.md": assumptions_page,
    "cite.md": cite_page,
    "gallery.md": gallery.page,
    **{f"images/gallery-{one.name}.svg": partial(gallery.picture, one) for one in gallery.DESIGNS},
}


def alike(one: str, other: str) -> bool:
    """Whether two pages differ at most in the last digits that processors round differently.

    That is by one of the last digit of a number, or in a power of ten by which a figure is below
    its bound.
    """
    if _NUMBER.sub("#", one) != _NUMBER.sub("#", other):
        return False
    return all(map(_as_near, _NUMBER.findall(one), _NUMBER.findall(other)))


def _as_near(one: str, other: str) -> bool:
    if one == other:
        return True
    values = float(one), float(other)
    if one.startswith("1e-") and other.startswith("1e-"):
        return 0.05 < values[0] / values[1] < 20.0
    return abs(values[0] - values[1]) <= 1.01 * max(map(_last_digit, (one, other)))


def _last_digit(number: str) -> float:
    """What one of the last digit of a number as it is written is worth."""
    mantissa, _, power = number.lower().partition("e")
    return float(10.0 ** (int(power or 0) - len(mantissa.partition(".")[2])))


def main() -> int:
    """Write or compare every page."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--check", action="store_true", help="only compare; 1 when out of date")
    only_compare = parser.parse_args().check
    stale = []
    for name, make in PAGES.items():
        path, text = DOCS / name, make()
        if not path.exists() or not alike(path.read_text(encoding="utf-8"), text):
            stale.append(name)
            if not only_compare:
                path.write_text(text, encoding="utf-8")
    if only_compare and stale:
        print(f"out of date: {', '.join(stale)}; run `python docs/build.py`")
        return 1
    print(f"wrote {', '.join(stale)}" if stale else "every page is up to date")
    return 0


if __name__ == "__main__":
    sys.exit(main())
