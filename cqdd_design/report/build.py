"""Put the report together: every section's values, then one page by Jinja2."""

from __future__ import annotations

import html
import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cqdd_design.catalog.paper import is_papers_actuator
from cqdd_design.gearbox.checks.allowables import UNEVEN_SHARING
from cqdd_design.report.actuator.actuator_view import actuator_view
from cqdd_design.report.actuator.bench_view import bench_view
from cqdd_design.report.drawings.edm_view import edm_view
from cqdd_design.report.drawings.front_view import front_view
from cqdd_design.report.drawings.outlines import Machine
from cqdd_design.report.drawings.section_view import section_view
from cqdd_design.report.drawings.turning_mesh import mesh_data, mesh_figure, mesh_readout
from cqdd_design.report.gearbox.bodies import bodies_view
from cqdd_design.report.gearbox.contact_view import contact_view
from cqdd_design.report.gearbox.life_view import life_view
from cqdd_design.report.gearbox.load_charts import load_charts
from cqdd_design.report.gearbox.losses_view import losses_view
from cqdd_design.report.gearbox.precision_view import precision_view
from cqdd_design.report.gearbox.tolerance_view import tolerance_view
from cqdd_design.report.ink.mathml import lowered
from cqdd_design.report.ink.numbers import TIMES, significant, with_unit
from cqdd_design.report.input import ReportInput
from cqdd_design.report.judgement.check_rows import chapters, printed
from cqdd_design.report.judgement.closing import (
    ERRATA,
    model_assumptions,
    paper_symbols,
    sources_used,
)
from cqdd_design.report.judgement.origins import Value, values_by_group
from cqdd_design.report.judgement.planetary_view import planetary_view
from cqdd_design.report.judgement.sizing_view import sizing_view
from cqdd_design.report.judgement.verdict import pin_figure, verdict

if TYPE_CHECKING:
    from jinja2 import Environment

    from cqdd_design.solids.part import Part

_TEMPLATES = Path(__file__).parent / "templates"


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
    return _environment().get_template("report.html").render(_context(results))


def _environment() -> Environment:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined
    from markupsafe import Markup

    environment = Environment(
        loader=FileSystemLoader(_TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    # Only markup that this package has built and escaped itself goes through `markup`.
    environment.filters["markup"] = Markup
    environment.filters["prose"] = lambda text: Markup(lowered(text))
    environment.filters["symbol"] = lambda text: Markup(symbol_html(text))
    return environment


def symbol_html(text: str) -> str:
    """Escaped text with ``Z_r`` and ``N_{np}`` lowered.

    Examples
    --------
    >>> symbol_html("Z_r & Z_np")
    'Z<sub>r</sub> &amp; Z<sub>np</sub>'
    """
    return re.sub(r"_(?:\{(\w+)\}|(\w+))", r"<sub>\1\2</sub>", html.escape(text))


def _context(results: ReportInput) -> dict[str, Any]:
    design, analysis, bodies = results.design, results.gearbox, results.bodies
    requirements = design.requirements
    machine = Machine.from_design(design, analysis.cam_bearing.bearing)
    cam_load = analysis.rigid.cam_bearing_load
    torque = analysis.rigid.torque
    literature, catalogue = sources_used(
        analysis.checks,
        analysis,
        _PLANETARY_SOURCES,
        () if bodies is None else bodies.parts,
    )
    groups = values_by_group(design, results.comments)
    found = verdict(
        design.name, analysis.checks, requirements.peak_torque, requirements.continuous_torque
    )
    return {
        "design": design,
        "provenance": results.provenance,
        "date": results.provenance.time.partition("T")[0],
        "verdict": found,
        "pins": pin_figure(analysis),
        "uneven_sharing": significant(UNEVEN_SHARING),
        "facts": _facts(results, found.least),
        "contents": _contents(results),
        "front_view": front_view(machine),
        "section_view": section_view(machine),
        "mesh": mesh_figure(machine, torque, cam_load),
        "mesh_data": mesh_data(machine, torque, cam_load),
        "mesh_readout": mesh_readout(machine, torque),
        "mesh_torque": with_unit(torque, "N*m"),
        "requirements": groups[0],
        "values": groups[1:],
        "derived": _derived(results),
        "chapters": chapters(analysis.checks),
        "load_charts": load_charts(analysis),
        **_engine(results, machine),
        **_bench(results),
        "bodies": None if bodies is None else bodies_view(analysis.design, bodies),
        "sizing": None if results.sizing is None else sizing_view(results.sizing),
        "counterweights": results.design.reducer.balance.counterweights,
        "input_speed": with_unit(requirements.input_speed * 30.0 / math.pi, "rpm"),
        "planetary": planetary_view(results.planetary),
        "edm": edm_view(design),
        "machine_views": None if results.machine is None else results.machine[0],
        "machine_viewer": None if results.machine is None else results.machine[1],
        "symbols": paper_symbols(design),
        "errata": ERRATA,
        "assumptions": model_assumptions(design),
        "warnings": tuple(printed(line) for line in (*analysis.warnings, *results.notes)),
        "defaults": _defaults(groups),
        "literature": literature,
        "catalogue": catalogue,
        "files": results.files,
    }


def _engine(results: ReportInput, machine: Machine) -> dict[str, Any]:
    """Values of the sections that come from the contact equilibrium; None where there is none."""
    found, design = results.contact, results.design
    names = ("contact", "precision", "losses", "life")
    values: dict[str, Any] = dict.fromkeys(names)
    if found is not None:
        values = {
            "contact": contact_view(found, machine, results.gearbox.rigid),
            "precision": precision_view(found, is_papers_actuator(design)),
            "losses": losses_view(found),
            "life": life_view(found.life),
        }
    ensemble = results.tolerance
    values["tolerances"] = None if ensemble is None else tolerance_view(ensemble)
    return values


def _bench(results: ReportInput) -> dict[str, Any]:
    """Values of the sections that come from the simulated actuator; None where there is none."""
    measured = results.bench
    if measured is None:
        return {"actuator": None, "bench": None, "bench_missing": results.bench_missing}
    actuator, found = measured
    return {
        "actuator": actuator_view(actuator, found, results.design.requirements),
        "bench": bench_view(actuator, found, pin_count=results.design.reducer.output_pins.count),
        "bench_missing": "",
    }


_PLANETARY_SOURCES = (
    "ISO 6336-1, -2 and -3:2019, load capacity of spur gears",
    "ISO 6336-5:2016, strength of gear materials",
    "ISO 1328-1:2013, flank tolerances",
    "ISO 21771:2007, geometry of cylindrical gears",
)

_CONTENTS = (
    ("verdict", "Verdict"),
    ("requirements", "Requirements"),
    ("drawings", "Drawings"),
    ("mesh-section", "Mesh"),
    ("machine", "The machine"),
    ("values", "Design values"),
    ("checks", "Checks"),
    ("loads", "Forces"),
    ("contact", "Contact"),
    ("precision", "Precision"),
    ("losses", "Losses"),
    ("life", "Life"),
    ("tolerances", "Tolerances"),
    ("actuator", "Actuator"),
    ("bench", "Test bench"),
    ("planetary", "Planetary"),
    ("edm", "Wire EDM"),
    ("inertia", "Inertia"),
    ("bom", "Bill of materials"),
    ("sizing", "Sizing"),
    ("symbols", "Symbols"),
    ("assumptions", "Assumptions"),
    ("sources", "Sources"),
    ("provenance", "Provenance"),
)


def _contents(results: ReportInput) -> tuple[tuple[str, str], ...]:
    absent = set()
    if results.bodies is None:
        absent |= {"inertia", "bom"}
    if results.machine is None:
        absent.add("machine")
    if results.sizing is None:
        absent.add("sizing")
    if results.contact is None:
        absent |= {"contact", "precision", "losses", "life"}
    if results.tolerance is None:
        absent.add("tolerances")
    if results.bench is None:
        absent |= {"bench"} if results.bench_missing else {"actuator", "bench"}
    return tuple(entry for entry in _CONTENTS if entry[0] not in absent)


def _facts(results: ReportInput, least_margin: str) -> tuple[tuple[str, str, str], ...]:
    design, reducer = results.design, results.design.reducer
    asked = design.requirements
    facts = [
        ("Ratio", f"{reducer.ratio} : 1", "ring held, output reversed"),
        (
            "Peak torque",
            with_unit(asked.peak_torque, "N*m"),
            f"{with_unit(asked.continuous_torque, 'N*m')} continuous",
        ),
        (
            "Envelope",
            f"\u2300 {significant(1e3 * reducer.ring.outer_diameter)} {TIMES} "
            f"{with_unit(1e3 * reducer.pack_length, 'mm')}",
            "ring and disc pack",
        ),
        (
            "Discs",
            f"{reducer.disc_count} {TIMES} {with_unit(1e3 * reducer.disc_thickness, 'mm')}",
            reducer.disc_material,
        ),
        ("Least margin", least_margin, "1 is on the limit"),
    ]
    if results.bodies is not None:
        mass = with_unit(results.bodies.inertia.total.mass, "kg", 3)
        whole = not results.bodies.inertia.motor_missing
        facts.insert(4, ("Mass", mass, "with the motor" if whole else "without the motor"))
        if whole:
            facts.insert(3, ("Actuator", _size(results.bodies.parts), "over everything"))
    return tuple(facts)


def _size(parts: Sequence[Part]) -> str:
    """Largest diameter and length of a machine: parts that stand still, and the output's face."""
    pieces = [(part, piece) for part in parts for piece in part.instances]
    ends = [
        piece.placement[2, 3] + (end if piece.placement[2, 2] > 0.0 else -end)
        for part, piece in pieces
        for end in (part.shape.bottom, part.shape.top)
    ]
    reach = max(
        math.hypot(*piece.placement[:2, 3]) + part.shape.outside_radius for part, piece in pieces
    )
    length = max(ends) - min(ends)
    return f"\u2300 {significant(2e3 * reach, 4)} {TIMES} {with_unit(1e3 * length, 'mm', 3)}"


def _derived(results: ReportInput) -> tuple[tuple[str, str, str], ...]:
    analysis = results.gearbox
    geometry = analysis.geometry
    thinnest = geometry.ligaments[0]

    def mm(length: float) -> str:
        return with_unit(1e3 * length, "mm", 5)

    return (
        ("signed ratio, ring held", "i", significant(geometry.ratio)),
        ("shortening coefficient e (n + 1)/R", "K_1", significant(geometry.shortening_coefficient)),
        ("largest tooth radius before undercut", "", mm(geometry.undercut_radius_limit)),
        ("least convex radius of the disc", "", mm(geometry.disc_min_convex_radius)),
        ("least concave radius of the disc", "", mm(geometry.disc_min_concave_radius)),
        ("least concave radius of the ring", "", mm(geometry.ring_min_concave_radius)),
        ("diameter of the output holes", "d_hole", mm(geometry.hole_diameter)),
        (f"thinnest ligament, {thinnest.where}", "", mm(thinnest.thickness)),
        (
            "area inside the lobed outline",
            "",
            with_unit(1e6 * geometry.profile_area, "mm^2", 6),
        ),
        ("length of the lobed outline", "", mm(geometry.profile_perimeter)),
        ("free length of the output pins", "L", mm(analysis.output_pins.span)),
        (
            f"bore for the cam bearing {analysis.cam_bearing.bearing.designation}",
            "",
            mm(analysis.cam_bearing.bearing.outer_diameter),
        ),
    )


def _defaults(groups: tuple[tuple[str, tuple[Value, ...]], ...]) -> tuple[str, ...]:
    return tuple(
        f"{row.label.words} {row.shown}"
        for _, rows in groups
        for row in rows
        if row.origin == "default"
    )
