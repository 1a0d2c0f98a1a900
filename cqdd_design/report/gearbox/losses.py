"""Losses in the report: where the power goes, efficiency, backdriving; films and wear."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cqdd_design.report.ink.bars import bar_chart
from cqdd_design.report.ink.heat import labelled_map
from cqdd_design.report.ink.numbers import NONE, RPM, per_cent, significant, with_unit
from cqdd_design.report.ink.page import Values
from cqdd_design.report.ink.svg import Words
from cqdd_design.terms import term

if TYPE_CHECKING:
    from cqdd_design.gearbox.film.running import Running
    from cqdd_design.machine.contact_analysis import ContactAnalysis


def losses_view(analysis: ContactAnalysis) -> Values:
    """Figures, and rows of (name, value, remark)."""
    found, grid, order = analysis.losses, analysis.map, slice(None, None, -1)
    total = f"{significant(found.total, 3)} W in all"
    at = f"at {with_unit(found.torque, 'N*m')} and {with_unit(found.input_speed * RPM, 'rpm')}"
    sources = found.by_source
    bars = bar_chart(
        Words(
            "loss-bars",
            "Where the power goes",
            f"Losses by source {at}, {total}.",
            f"{total} {at} of the input: friction of teeth and pins, bearings, and the shear of "
            "the grease.",
        ),
        [name.replace("_", " ") for name in sources],
        list(sources.values()),
        [f"{significant(value, 3)} W" for value in sources.values()],
    )
    chart = labelled_map(
        Words(
            "efficiency-map",
            "Efficiency, driven by the motor",
            "Efficiency of the gearbox, driven by the motor, over input speed and output torque.",
            "Per cent; the gearbox alone.",
        ),
        grid.forward.T[order],
        [significant(float(t), 3) for t in grid.torque[order]],
        [significant(float(w) * RPM, 3) for w in grid.input_speed],
        ("output torque, N\u00b7m", "input speed, rpm"),
    )
    return {"figures": (bars, chart), "rows": _rows(analysis)}


def _rows(analysis: ContactAnalysis) -> tuple[tuple[str, str, str], ...]:
    found = analysis.losses
    back = found.backdrive
    turns = "the output can turn it" if found.backdrives else "it holds itself"
    at_output = "at the output; the gearbox alone, without the motor's drag, seals and preloads"
    torques = [
        "does not turn" if torque is None else with_unit(torque, "N*m", 3)
        for torque in (back.static_torque, back.dynamic_torque)
    ]
    return (
        (term("efficiency_forward").words, _share(found.efficiency_forward), "the gearbox alone"),
        (term("efficiency_backward").words, _share(found.efficiency_backward), turns),
        (term("backdrive_static_Nm").words, torques[0], at_output),
        (term("backdrive_dynamic_Nm").words, torques[1], at_output),
        *_film_rows(analysis.running),
    )


def _film_rows(found: Running) -> list[tuple[str, str, str]]:
    """Films, friction and wear of what slides."""
    rows = []
    at = f"{found.lubricant} at {significant(found.temperature, 3)} °C, mean under load"
    for name, film in (("ring teeth", found.teeth), ("output pins", found.pins)):
        if film is None:
            continue
        ratio = significant(film.ratio, 2)
        rows += [
            (
                f"{term('thickness_um').words} at the {name}",
                with_unit(film.thickness * 1e6, "µm", 2),
                at,
            ),
            (
                f"friction coefficient at the {name}",
                significant(film.friction, 3),
                f"λ {ratio}; the film leaves {significant(film.by_film, 3)}",
            ),
        ]
    hours = significant(found.wear.hours, 3)
    gap = with_unit(found.wear.clearance * 1e6, "µm", 3)
    places = (
        ("flanks", found.wear.disc_flank, f"mean; their clearance is {gap}"),
        ("ring teeth", found.wear.ring_tooth, "where contacts travel on them"),
        ("holes", found.wear.hole, "mean"),
        ("output pins", found.wear.pin, "mean"),
    )
    for name, band, remark in places:
        if band is not None:
            low, high = (significant(1e6 * one, 2) for one in band)
            told = f"Archard, 10⁻⁹ to 10⁻⁸ mm³/(N·m); {remark}"
            rows.append((f"wear of the {name} in {hours} h", f"{low} to {high} µm", told))
    return rows


def _share(value: float | None) -> str:
    return NONE if value is None else per_cent(value, 3)
