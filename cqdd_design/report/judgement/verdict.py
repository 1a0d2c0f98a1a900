"""The verdict: pass, warn or fail, what fails and what would change it, and the paper's figure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from cqdd_design.catalog.paper import PIN_TORQUE, PINS_TORQUE
from cqdd_design.gearbox import GearboxAnalysis
from cqdd_design.report.ink.numbers import TIMES, decimals, significant, with_unit
from cqdd_design.report.judgement.check_rows import CheckRow, closest, failing
from cqdd_design.results import Check, Status, worst_status

#: Checks shown for a design that fails none.
_CLOSEST = 6


@dataclass(frozen=True)
class Verdict:
    """What a reader must know first.

    Attributes
    ----------
    status : Status
    badge, headline, detail : str
        A few words; one sentence; one more.
    rows : tuple of CheckRow
        Failures, then warnings.
    closest : tuple of CheckRow
        Where nothing fails: the checks met with the least margins.
    least : str
        Least margin of all checks, with what it belongs to.
    """

    status: Status
    badge: str
    headline: str
    detail: str
    rows: tuple[CheckRow, ...]
    closest: tuple[CheckRow, ...]
    least: str


def verdict(name: str, checks: Sequence[Check], peak: float, continuous: float) -> Verdict:
    """Sum up the checks of a design.

    Parameters
    ----------
    name : str
        Of the design.
    checks : sequence of Check
    peak, continuous : float
        Torques asked for, N m.
    """
    status = worst_status(checks)
    total = len(checks)
    failed = sum(check.status == "fail" for check in checks)
    warned = sum(check.status == "warn" for check in checks)
    asked = f"{with_unit(peak, 'N*m')} peak and {with_unit(continuous, 'N*m')} continuous torque"
    least = min(checks, key=lambda check: check.margin)
    if status == "fail":
        badge = f"Fails {failed} of {total} checks"
        headline = (
            f"{name} does not meet its requirements: at {asked}, {failed} of {total} checks fail."
        )
    elif status == "warn":
        badge = f"Passes, {_count(warned, 'warning')}"
        headline = (
            f"{name} meets every limit that decides at {asked}, with {_count(warned, 'warning')} "
            f"among its {total} checks."
        )
    else:
        badge = f"Passes all {total} checks"
        headline = f"{name} meets its requirements: at {asked}, all {total} checks pass."
    also = (
        f" {_count(warned, 'more is a warning', 'more are warnings')}." if failed and warned else ""
    )
    return Verdict(
        status=status,
        badge=badge,
        headline=headline,
        detail=f"The least margin is {significant(least.margin, 3)}, in "
        f"“{least.title[0].lower()}{least.title[1:]}”.{also}",
        rows=failing(checks),
        closest=() if failed else closest(checks, _CLOSEST),
        least=significant(least.margin, 3),
    )


def _count(number: int, one: str, many: str = "") -> str:
    return f"{number} {one if number == 1 else many or one + 's'}"


@dataclass(frozen=True)
class PinFigure:
    """The paper's output-pin figure beside what shared loads allow.

    Attributes
    ----------
    as_printed : bool
        Whether these pins give the very figure that the paper prints.
    rows : tuple of (method, per pin, in all, share of the peak torque)
    conclusion : str
    """

    as_printed: bool
    rows: tuple[tuple[str, str, str, str], ...]
    conclusion: str


def pin_figure(analysis: GearboxAnalysis) -> PinFigure:
    """Output pins of a design by the paper's method, by shared shear and by shared bending."""
    pins = analysis.output_pins
    requirements = analysis.design.requirements
    peak = requirements.peak_torque
    shear = pins.paper_shear / 1e6
    printed = (
        abs(pins.paper_torque_per_pin - PIN_TORQUE) < 0.006
        and abs(pins.paper_torque_total - PINS_TORQUE) < 0.05
    )

    def row(method: str, per_pin: str, capacity: float) -> tuple[str, str, str, str]:
        return (
            method,
            per_pin,
            _torque(capacity),
            f"{decimals(capacity / peak, 2)} {TIMES}",
        )

    held = {
        "both": "held at both ends",
        "cantilever": "held at one end",
    }[analysis.design.reducer.output_pins.support]
    rows = (
        row(
            f"The paper's method: every pin in single shear at {significant(shear)} MPa, all at "
            "full load and full radius at once",
            _torque(pins.paper_torque_per_pin),
            pins.paper_torque_total,
        ),
        row(
            "The same shear strength, with the torque shared as rigid discs share it",
            "shared",
            pins.shared_torque_capacity,
        ),
        row(
            f"Bending at the peak limit, shared the same way, pins {held}",
            "shared",
            pins.bending_torque_capacity,
        ),
    )
    if pins.bending_torque_capacity < peak:
        conclusion = (
            "The shear figure is no capacity: it loads every pin fully at once and leaves out "
            f"bending. A pin in bending reaches its limit at "
            f"{with_unit(pins.bending_torque_capacity, 'N*m', 3)} of output torque, "
            f"{significant(pins.bending_torque_capacity / peak, 2)} of the peak torque asked for."
        )
    else:
        conclusion = (
            "The shear figure is no capacity: it loads every pin fully at once and leaves out "
            "bending. Here bending, too, leaves room at the peak torque asked for."
        )
    return PinFigure(printed, rows, conclusion)


def _torque(value: float) -> str:
    """A torque to two decimals, as the paper prints its own."""
    return f"{decimals(value, 2)}\u202fN\u00b7m"
