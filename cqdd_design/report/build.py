"""Put the report together: a table of chapters, each with its values, in one page by Jinja2."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

from cqdd_design.gearbox.checks.allowables import UNEVEN_SHARING
from cqdd_design.report.actuator.bench_table import bench_view
from cqdd_design.report.actuator.envelope import actuator_view
from cqdd_design.report.actuator.shock import shock_view
from cqdd_design.report.drawings.front_view import front_view
from cqdd_design.report.drawings.half_section import half_section
from cqdd_design.report.drawings.outlines import Outlines
from cqdd_design.report.drawings.turning_mesh import mesh_data, mesh_figure, mesh_readout
from cqdd_design.report.drawings.wire_edm import edm_view
from cqdd_design.report.gearbox.axial import axial_view
from cqdd_design.report.gearbox.contact import contact_view
from cqdd_design.report.gearbox.life import life_view
from cqdd_design.report.gearbox.load_charts import load_charts
from cqdd_design.report.gearbox.losses import losses_view
from cqdd_design.report.gearbox.masses import bodies_view
from cqdd_design.report.gearbox.precision import precision_view
from cqdd_design.report.gearbox.stress import stress_view
from cqdd_design.report.gearbox.temperatures import temperatures_view
from cqdd_design.report.gearbox.tolerances import tolerance_view
from cqdd_design.report.ink.numbers import RPM, significant, with_unit
from cqdd_design.report.ink.page import Values, environment
from cqdd_design.report.ink.tables import readable_tables
from cqdd_design.report.input import ReportInput
from cqdd_design.report.judgement.check_rows import check_groups, printed
from cqdd_design.report.judgement.closing import (
    ERRATA,
    model_assumptions,
    paper_symbols,
    sources_used,
)
from cqdd_design.report.judgement.downloads import downloads_view
from cqdd_design.report.judgement.duty import duty_rows
from cqdd_design.report.judgement.facts import derived_values, head_facts
from cqdd_design.report.judgement.origins import Group, folded, values_by_group
from cqdd_design.report.judgement.planetary import limit_models, limit_rows, planetary_view
from cqdd_design.report.judgement.search import sizing_view
from cqdd_design.report.judgement.verdict import pin_figure, verdict
from cqdd_design.report.machine_view.packing import machine_values

if TYPE_CHECKING:
    from cqdd_design.machine.contact_analysis import ContactAnalysis


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
    judged = verdict(results.verdict, results.costs)
    shown = [chapter for chapter in _chapters(results) if chapter.values is not None]
    context: Values = {
        "design": results.design,
        "provenance": results.provenance,
        "date": results.provenance.time.partition("T")[0],
        "verdict": judged,
        "facts": head_facts(results, judged["least"]),
        "contents": tuple(
            heading for chapter in shown if not chapter.appended for heading in chapter.headings
        ),
        "appendix": tuple(
            heading for chapter in shown if chapter.appended for heading in chapter.headings
        ),
        "chapters": tuple(chapter.template for chapter in shown),
    }
    for chapter in shown:
        context |= chapter.values or {}
    return readable_tables(environment().get_template("report.html").render(context))


class _Chapter(NamedTuple):
    """One template: its entries in the contents, and its values; None leaves the chapter out."""

    template: str
    headings: tuple[tuple[str, str], ...]
    values: Values | None
    appended: bool = False
    """Of the appendix."""


def _chapters(results: ReportInput) -> list[_Chapter]:
    """The report from top to bottom."""
    design, gearbox, contact = results.design, results.gearbox, results.contact
    outlines = Outlines.from_design(design, gearbox.cam_bearing.bearing)
    groups, law = values_by_group(design, results.comments), gearbox.rigid
    pictures, found = results.pictures, results.evidence
    pin_count = design.reducer.output_pins.count

    def chapter(name: str, title: str, values: Values | None) -> _Chapter:
        """One whose template is called like its entry in the contents."""
        return _Chapter(f"{name}.html", ((name, title),), values)

    def of_contact(name: str, title: str, view: Callable[[ContactAnalysis], Values]) -> _Chapter:
        return chapter(name, title, None if contact is None else {name: view(contact)})

    return [
        chapter("verdict", "Verdict", {}),
        chapter(
            "requirements",
            "Requirements",
            {"requirements": folded(groups[:1], headings=False), "duty_rows": duty_rows(design)},
        ),
        _Chapter(
            "drawings.html",
            (("drawings", "Drawings"), ("mesh-section", "Mesh")),
            {
                "front_view": front_view(outlines),
                "section_view": half_section(outlines),
                "mesh": mesh_figure(outlines, law.torque, law.cam_bearing_load),
                "mesh_data": mesh_data(outlines, law.torque, law.cam_bearing_load),
                "mesh_readout": mesh_readout(outlines, law.torque),
                "mesh_torque": with_unit(law.torque, "N*m"),
            },
        ),
        _Chapter(
            "machine3d.html",
            (("machine", "The machine"),),
            pictures and machine_values(*pictures),
        ),
        chapter(
            "values",
            "Design values",
            {"values": folded(groups[1:]), "derived": derived_values(results)},
        ),
        chapter("checks", "Checks", {"check_groups": check_groups(results.checks)}),
        chapter(
            "limits",
            "What limits the torque",
            {"limits": limit_rows(results.limits), "limit_models": limit_models(results.limits)}
            if results.limits
            else None,
        ),
        chapter("loads", "Forces", {"load_charts": load_charts(gearbox)}),
        of_contact("contact", "Contact", lambda found: contact_view(found, outlines, law)),
        chapter("stress", "Stress", _stress(results, outlines)),
        of_contact("precision", "Precision", lambda found: precision_view(found, design)),
        of_contact("losses", "Losses", losses_view),
        chapter(
            "temperatures",
            "Temperatures",
            None
            if found.temperatures is None
            else {"temperatures": temperatures_view(found.temperatures)},
        ),
        chapter("axial", "Axial play", axial_view(results.machine, found.temperatures)),
        of_contact("life", "Life", lambda found: life_view(found.life, design.requirements)),
        chapter(
            "tolerances",
            "Tolerances",
            None
            if found.drawn is None
            else {"tolerances": tolerance_view(found.drawn.continuous, results.clearances)},
        ),
        chapter("actuator", "Actuator", _actuator(results)),
        chapter(
            "bench",
            "Test bench",
            results.bench and {"bench": bench_view(*results.bench, pin_count=pin_count)},
        ),
        chapter("edm", "Wire EDM", {"edm": edm_view(results.machine)}),
        _Chapter(
            "bodies.html", (("inertia", "Inertia"), ("bom", "Bill of materials")), _bodies(results)
        ),
        chapter(
            "sizing",
            "Sizing",
            None if results.sizing is None else {"sizing": sizing_view(results.sizing)},
        ),
        _Chapter(
            "closing.html",
            (("assumptions", "Assumptions"), ("sources", "Sources"), ("provenance", "Provenance")),
            _closing(results, groups),
        ),
        chapter("downloads", "Files", downloads_view(results)),
        *_appendix(results),
    ]


def _appendix(results: ReportInput) -> list[_Chapter]:
    """What the paper says, beside the paper's own actuator."""
    compared = results.planetary
    if compared is None:
        return []
    beside = {"planetary": planetary_view(compared, limits=False)}
    return [
        _Chapter("planetary.html", (("planetary", "Beside a planetary"),), beside, appended=True),
        _Chapter(
            "paper.html",
            (("pins", "Output pins"), ("symbols", "Symbols and corrections")),
            {
                "pins": pin_figure(results.gearbox),
                "uneven_sharing": significant(UNEVEN_SHARING),
                "symbols": paper_symbols(results.design),
                "errata": ERRATA,
            },
            appended=True,
        ),
    ]


def _stress(results: ReportInput, outlines: Outlines) -> Values | None:
    found = results.evidence
    if found.stress is None:
        return None
    return {"stress": stress_view(found.stress, found.stress_checks, outlines)}


def _actuator(results: ReportInput) -> Values | None:
    if results.bench is None:
        missing = results.bench_missing
        return {"actuator": None, "bench_missing": missing} if missing else None
    return {
        "actuator": actuator_view(*results.bench, results.design.requirements),
        "shocks": shock_view(results.shocks),
    }


def _bodies(results: ReportInput) -> Values | None:
    if results.bodies is None:
        return None
    design = results.design
    return {
        "bodies": bodies_view(results.gearbox.design, results.bodies),
        "counterweights": design.reducer.balance.counterweights,
        "input_speed": with_unit(design.requirements.input_speed * RPM, "rpm"),
    }


def _closing(results: ReportInput, groups: tuple[Group, ...]) -> Values:
    design, analysis = results.design, results.gearbox
    parts = () if results.bodies is None else results.bodies.parts
    literature, catalogue = sources_used(
        analysis, parts, results.checks, planetary=results.planetary is not None
    )
    # A model and the verdict, which took it up, may warn of the same.
    warnings = dict.fromkeys((*analysis.warnings, *results.notes))
    return {
        "assumptions": model_assumptions(design),
        "warnings": tuple(printed(line) for line in warnings),
        "defaults": folded(groups).left,
        "literature": literature,
        "catalogue": tuple((printed(row), uses) for row, uses in catalogue),
    }
