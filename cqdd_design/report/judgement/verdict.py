"""The verdict as the report shows it, and the paper's figure of the output pins."""

from __future__ import annotations

from collections.abc import Sequence

from cqdd_design.catalog.paper import PIN_TORQUE, PINS_TORQUE
from cqdd_design.design import Design
from cqdd_design.gearbox import GearboxAnalysis
from cqdd_design.report.ink.numbers import TIMES, decimals, significant, with_unit
from cqdd_design.report.ink.page import Values
from cqdd_design.report.judgement.check_rows import WORDS, check_row, printed, sentence
from cqdd_design.report.judgement.duty import duty_text
from cqdd_design.results import Status
from cqdd_design.verdict import Verdict
from cqdd_design.verdict.headline import Figure
from cqdd_design.verdict.judge import Meets

_BADGES: dict[Meets, tuple[Status, str]] = {
    "yes": ("pass", "Meets its requirements"),
    "no": ("fail", "Does not meet its requirements"),
    "unknown": ("unknown", "Not shown to meet its requirements"),
}


def verdict(judged: Verdict, costs: Sequence[str]) -> Values:
    """What a reader must know first: the answer, seven figures, and what is in the way of a yes.

    Where nothing is, what comes closest to its limit. In the end what more would cost, where a
    search told.
    """
    asked, limits = judged.evidence.machine.design.requirements, judged.limits
    status, badge = _BADGES[judged.meets]
    least = next(line for line in (*limits, *judged.lines) if line.known)
    closest = () if judged.meets == "no" else limits
    sizes = ", ".join(line.title[0].lower() + line.title[1:] for line in judged.filled)
    margin, duty = significant(least.margin, 3), duty_text(asked)
    lasting = f"{with_unit(asked.continuous_torque, 'N*m')} continuous torque."
    apart = ", apart from sizes at their limit" if sizes and least not in judged.filled else ""
    return {
        "status": status,
        "badge": badge,
        "headline": f"{judged.sentence}.",
        "detail": f"Judged at {with_unit(asked.peak_torque, 'N*m')} peak and "
        f"{f'over the duty, {duty}' if duty else lasting} The least margin is "
        f"{margin}, in “{least.title[0].lower()}{least.title[1:]}”{apart}.",
        "figures": tuple(_figure(one) for one in judged.headline),
        "rows": tuple(check_row(line) for line in limits if line.status != "pass"),
        "closest": tuple(check_row(line) for line in closest if line.status == "pass"),
        "filled": sizes,
        "costs": tuple(map(printed, costs)),
        "least": margin,
    }


def _figure(one: Figure) -> Values:
    """One of the seven, as shown."""
    return {
        "title": sentence(one.title).rstrip("."),
        "value": "not known" if one.value is None else with_unit(one.value, one.unit, 3),
        "required": "" if one.required is None else with_unit(one.required, one.unit),
        "status": one.status,
        "word": WORDS[one.status],
        "basis": printed(one.basis),
    }


_HELD = {
    "clamped": "clamped in plate and cap",
    "hinged": "clamped in the plate and pinned in the cap",
    "columns": "clamped in the plate and pinned in the cap, with columns",
}


def _held(design: Design) -> str:
    reducer = design.reducer
    both = reducer.output_pins.support == "both"
    return _HELD[reducer.carrier.joint] if both else "held at one end"


def pin_figure(analysis: GearboxAnalysis) -> Values:
    """Output pins of a design by the paper's method, by shared shear and by shared bending."""
    pins, design = analysis.output_pins, analysis.design
    peak, bending = design.requirements.peak_torque, pins.bending_torque_capacity
    methods = (
        (
            "The paper's method: every pin in single shear at "
            f"{significant(pins.paper_shear / 1e6)} MPa, all at full load and full radius at once",
            _torque(pins.paper_torque_per_pin),
            pins.paper_torque_total,
        ),
        (
            "The same shear strength, with the torque shared as rigid discs share it",
            "shared",
            pins.shared_torque_capacity,
        ),
        (
            f"Bending at the peak limit, shared the same way, pins {_held(design)}",
            "shared",
            bending,
        ),
    )
    conclusion = "The shear figure is no capacity: it loads every pin fully at once and leaves out "
    if bending < peak:
        conclusion += (
            "bending. A pin in bending reaches its limit at "
            f"{with_unit(bending, 'N*m', 3)} of output torque, "
            f"{significant(bending / peak, 2)} of the peak torque asked for."
        )
    else:
        conclusion += "bending. Here bending, too, leaves room at the peak torque asked for."
    paper = (f"{PIN_TORQUE:.2f}", f"{PINS_TORQUE:.2f}")
    return {
        "paper": paper,
        "as_printed": paper
        == (f"{pins.paper_torque_per_pin:.2f}", f"{pins.paper_torque_total:.2f}"),
        "rows": tuple(
            (method, per_pin, _torque(capacity), f"{decimals(capacity / peak, 2)} {TIMES}")
            for method, per_pin, capacity in methods
        ),
        "conclusion": conclusion,
    }


def _torque(value: float) -> str:
    """A torque to two decimals, as the paper prints its own."""
    return f"{decimals(value, 2)}\u202fN\u00b7m"
