"""The report: one self-contained HTML page that a design review reads, on screen and on paper.

Its names are imported when they are first asked for: this package is imported with `cqdd_design`
itself, which has a function of the same name.
"""

from __future__ import annotations

from importlib import import_module

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from cqdd_design.report.build import build_report
    from cqdd_design.report.input import ReportInput
    from cqdd_design.report.judgement.origins import read_comments

__all__ = ["ReportInput", "build_report", "read_comments"]

_ROOMS = {"ReportInput": "input", "build_report": "build", "read_comments": "judgement.origins"}


def __getattr__(name: str) -> Any:
    """One of the names, from where it stands."""
    if name not in _ROOMS:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_ROOMS[name]}"), name)
