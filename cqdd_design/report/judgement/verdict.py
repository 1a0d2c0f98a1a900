"""The verdict: pass, warn or fail, what fails and what would change it, and the paper's figure."""

from __future__ import annotations

from collections.abc import Sequence

from cqdd_design.catalog.paper import PIN_TORQUE, PINS_TORQUE
from cqdd_design.design import Design
from cqdd_design.gearbox import GearboxAnalysis
from cqdd_design.report.ink.numbers import TIMES, decimals, significant, with_unit
from cqdd_design.report.ink.page import Values
from cqdd_design.report.judgement.check_rows import closest, failing
from cqdd_design.report.judgement.shortfalls import Shortfall
from cqdd_design.results import Check, worst_status

_CLOSEST = 6
"""Checks shown for a design that fails none."""

_SCREEN = (
    " The checks are a first screen: but for the stress of discs and ring, rigid parts share the "
    "load there. The contact equilibrium, the life and the test bench below judge the same loads "
    "more closely, and where they say less, they count."
)


def verdict(design: Design, checks: Sequence[Check], short: Sequence[Shortfall] = ()) -> Values:
    """What a reader must know first: failures and warnings, or the least margins where none.

    Parameters
    ----------
    short : sequence of Shortfall
        What closer models find not to be met: no design that has any is shown as passing.
    """
    name, asked = design.name, design.requirements
    status = worst_status(checks)
    total = len(checks)
    failed = sum(check.status == "fail" for check in checks)
    warned = sum(check.status == "warn" for check in checks)
    at = (
        f"at {with_unit(asked.peak_torque, 'N*m')} peak and "
        f"{with_unit(asked.continuous_torque, 'N*m')} continuous torque"
    )
    least = min(checks, key=lambda check: check.margin)
    if status == "fail":
        badge = f"Fails {failed} of {total} checks"
        headline = f"{name} does not meet its requirements: {at}, {failed} of {total} checks fail."
    elif status == "warn":
        badge = f"Passes, {_count(warned, 'warning')}"
        headline = (
            f"{name} passes {total - warned} of {total} checks {at}; "
            f"{_count(warned, 'is a warning', 'are warnings')}."
        )
    else:
        badge = f"Passes all {total} checks"
        headline = f"{name} passes all {total} checks {at}."
    if short and status != "fail":
        status = "warn"
        badge = "Checks pass, closer models do not"
        headline = headline.removesuffix(".") + ", but closer models say less than is asked."
    also = (
        f" {_count(warned, 'more is a warning', 'more are warnings')}." if failed and warned else ""
    )
    margin = significant(least.margin, 3)
    screen = "" if failed or short else _SCREEN
    return {
        "status": status,
        "badge": badge,
        "headline": headline,
        "detail": f"The least margin is {margin}, in "
        f"“{least.title[0].lower()}{least.title[1:]}”.{also}{screen}",
        "rows": failing(checks),
        "short": short,
        "closest": () if failed else closest(checks, _CLOSEST),
        "least": margin,
    }


def _count(number: int, one: str, many: str = "") -> str:
    return f"{number} {one if number == 1 else many or one + 's'}"


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
