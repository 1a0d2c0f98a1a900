"""Put the report together: a table of chapters, each with its values, in one page by Jinja2."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

from cqdd_design.gearbox.checks.allowables import UNEVEN_SHARING
from cqdd_design.report.actuator.bench_table import bench_view
from cqdd_design.report.actuator.envelope import actuator_view
from cqdd_design.report.drawings.front_view import front_view
from cqdd_design.report.drawings.half_section import half_section
from cqdd_design.report.drawings.outlines import Outlines
from cqdd_design.report.drawings.turning_mesh import mesh_data, mesh_figure, mesh_readout
from cqdd_design.report.drawings.wire_edm import edm_view
from cqdd_design.report.gearbox.contact import contact_view
from cqdd_design.report.gearbox.life import life_view
from cqdd_design.report.gearbox.load_charts import load_charts
from cqdd_design.report.gearbox.losses import losses_view
from cqdd_design.report.gearbox.masses import bodies_view
from cqdd_design.report.gearbox.precision import precision_view
from cqdd_design.report.gearbox.tolerances import tolerance_view
from cqdd_design.report.ink.numbers import RPM, significant, with_unit
from cqdd_design.report.ink.page import environment
from cqdd_design.report.input import ReportInput
from cqdd_design.report.judgement.check_rows import check_groups, printed
from cqdd_design.report.judgement.closing import (
    ERRATA,
    model_assumptions,
    paper_symbols,
    sources_used,
)
from cqdd_design.report.judgement.facts import derived_values, head_facts
from cqdd_design.report.judgement.origins import Value, defaults, values_by_group
from cqdd_design.report.judgement.planetary import planetary_view
from cqdd_design.report.judgement.search import sizing_view
from cqdd_design.report.judgement.verdict import Verdict, pin_figure, verdict


def build_report(results: ReportInput) -> str:
    """One self-contained HTML page about a design.

    It needs no network and no other file, prints on A4, and is complete without scripts; with
    them the mesh turns. The same input gives the same bytes.

    Parameters
    ----------
    results : ReportInput
        What to show; sections whose results are missing are left out.

    Returns
    -------
    str
        HTML, to be written as UTF-8.
    """
    source = _Source(results)
    shown = [(chapter, chapter.values(source)) for chapter in CHAPTERS]
    context: dict[str, Any] = {
        "design": results.design,
        "provenance": results.provenance,
        "date": results.provenance.time.partition("T")[0],
        "verdict": source.verdict,
        "facts": head_facts(results, source.verdict.least),
        "contents": tuple(
            heading for chapter, found in shown if found is not None for heading in chapter.headings
        ),
        "chapters": tuple(chapter.template for chapter, found in shown if found is not None),
    }
    for _, found in shown:
        context |= found or {}
    return environment().get_template("report.html").render(context)


@dataclass(frozen=True)
class _Source:
    """What chapters are made from: the results, and what several chapters share."""

    results: ReportInput

    @cached_property
    def outlines(self) -> Outlines:
        results = self.results
        return Outlines.from_design(results.design, results.gearbox.cam_bearing.bearing)

    @cached_property
    def verdict(self) -> Verdict:
        return verdict(self.results.design, self.results.gearbox.checks)

    @cached_property
    def groups(self) -> tuple[tuple[str, tuple[Value, ...]], ...]:
        return values_by_group(self.results.design, self.results.comments)


Values = dict[str, Any] | None


def _verdict(source: _Source) -> Values:
    return {
        "pins": pin_figure(source.results.gearbox),
        "uneven_sharing": significant(UNEVEN_SHARING),
    }


def _drawings(source: _Source) -> Values:
    outlines, law = source.outlines, source.results.gearbox.rigid
    return {
        "front_view": front_view(outlines),
        "section_view": half_section(outlines),
        "mesh": mesh_figure(outlines, law.torque, law.cam_bearing_load),
        "mesh_data": mesh_data(outlines, law.torque, law.cam_bearing_load),
        "mesh_readout": mesh_readout(outlines, law.torque),
        "mesh_torque": with_unit(law.torque, "N*m"),
    }


def _machine(source: _Source) -> Values:
    found = source.results.pictures
    return None if found is None else {"machine_views": found[0], "machine_viewer": found[1]}


def _values(source: _Source) -> Values:
    return {"values": source.groups[1:], "derived": derived_values(source.results)}


def _contact(source: _Source) -> Values:
    found, law = source.results.contact, source.results.gearbox.rigid
    return None if found is None else {"contact": contact_view(found, source.outlines, law)}


def _precision(source: _Source) -> Values:
    found, design = source.results.contact, source.results.design
    return None if found is None else {"precision": precision_view(found, design)}


def _losses(source: _Source) -> Values:
    found = source.results.contact
    return None if found is None else {"losses": losses_view(found)}


def _life(source: _Source) -> Values:
    found = source.results.contact
    return None if found is None else {"life": life_view(found.life)}


def _tolerances(source: _Source) -> Values:
    found = source.results.tolerance
    return None if found is None else {"tolerances": tolerance_view(found)}


def _actuator(source: _Source) -> Values:
    results = source.results
    if results.bench is None:
        missing = results.bench_missing
        return {"actuator": None, "bench_missing": missing} if missing else None
    return {"actuator": actuator_view(*results.bench, results.design.requirements)}


def _bench(source: _Source) -> Values:
    found, pins = source.results.bench, source.results.design.reducer.output_pins
    return None if found is None else {"bench": bench_view(*found, pin_count=pins.count)}


def _bodies(source: _Source) -> Values:
    results, design = source.results, source.results.design
    if results.bodies is None:
        return None
    return {
        "bodies": bodies_view(results.gearbox.design, results.bodies),
        "counterweights": design.reducer.balance.counterweights,
        "input_speed": with_unit(design.requirements.input_speed * RPM, "rpm"),
    }


def _sizing(source: _Source) -> Values:
    found = source.results.sizing
    return None if found is None else {"sizing": sizing_view(found)}


def _closing(source: _Source) -> Values:
    results, design, analysis = source.results, source.results.design, source.results.gearbox
    parts = () if results.bodies is None else results.bodies.parts
    literature, catalogue = sources_used(analysis, parts)
    return {
        "symbols": paper_symbols(design),
        "errata": ERRATA,
        "assumptions": model_assumptions(design),
        "warnings": tuple(printed(line) for line in (*analysis.warnings, *results.notes)),
        "defaults": defaults(source.groups),
        "literature": literature,
        "catalogue": catalogue,
        "files": results.files,
    }


class Chapter(NamedTuple):
    """One template: its entries in the contents, and its values; None leaves the chapter out."""

    template: str
    headings: tuple[tuple[str, str], ...]
    values: Callable[[_Source], Values]


CHAPTERS = (
    Chapter("verdict.html", (("verdict", "Verdict"),), _verdict),
    Chapter(
        "requirements.html",
        (("requirements", "Requirements"),),
        lambda source: {"requirements": source.groups[0]},
    ),
    Chapter("drawings.html", (("drawings", "Drawings"), ("mesh-section", "Mesh")), _drawings),
    Chapter("machine3d.html", (("machine", "The machine"),), _machine),
    Chapter("values.html", (("values", "Design values"),), _values),
    Chapter(
        "checks.html",
        (("checks", "Checks"),),
        lambda source: {"check_groups": check_groups(source.results.gearbox.checks)},
    ),
    Chapter(
        "loads.html",
        (("loads", "Forces"),),
        lambda source: {"load_charts": load_charts(source.results.gearbox)},
    ),
    Chapter("contact.html", (("contact", "Contact"),), _contact),
    Chapter("precision.html", (("precision", "Precision"),), _precision),
    Chapter("losses.html", (("losses", "Losses"),), _losses),
    Chapter("life.html", (("life", "Life"),), _life),
    Chapter("tolerances.html", (("tolerances", "Tolerances"),), _tolerances),
    Chapter("actuator.html", (("actuator", "Actuator"),), _actuator),
    Chapter("bench.html", (("bench", "Test bench"),), _bench),
    Chapter(
        "planetary.html",
        (("planetary", "Planetary"),),
        lambda source: {"planetary": planetary_view(source.results.planetary)},
    ),
    Chapter(
        "edm.html", (("edm", "Wire EDM"),), lambda source: {"edm": edm_view(source.results.machine)}
    ),
    Chapter("bodies.html", (("inertia", "Inertia"), ("bom", "Bill of materials")), _bodies),
    Chapter("sizing.html", (("sizing", "Sizing"),), _sizing),
    Chapter(
        "closing.html",
        (
            ("symbols", "Symbols"),
            ("assumptions", "Assumptions"),
            ("sources", "Sources"),
            ("provenance", "Provenance"),
        ),
        _closing,
    ),
)
"""The report from top to bottom."""
