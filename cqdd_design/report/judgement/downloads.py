"""Files that the page carries or points to."""

from __future__ import annotations

import base64
import csv
import io
import json
import os
from collections.abc import Sequence
from pathlib import Path
from urllib.parse import quote

from cqdd_design.design.toml import design_text
from cqdd_design.files import WrittenFile
from cqdd_design.report.ink.page import Values
from cqdd_design.report.input import ReportInput
from cqdd_design.results import Check


def downloads_view(results: ReportInput) -> Values:
    """The design, its checks and its verdict as files; and links to those of the same run."""
    name, design = results.design.file_name, results.design
    verdict = json.dumps(results.verdict.to_dict(), indent=1, sort_keys=True, allow_nan=False)
    files = (
        (
            f"{name}.toml",
            "the design as it was judged, for cqdd-design",
            _address("application/toml", design_text(design, results.comments)),
        ),
        (
            f"{name}-checks.csv",
            "every check with value, limit and margin, for a spreadsheet",
            _address("text/csv", _checks(results.checks)),
        ),
        (
            f"{name}-verdict.json",
            "verdict, figures and limits, for a script",
            _address("application/json", verdict),
        ),
    )
    return {
        "downloads": files,
        "model_name": f"{name}.glb" if results.pictures else "",
        "files": _linked(results.files, results.target),
        "design_file": f"designs/{name}.toml",
    }


def _address(kind: str, text: str) -> str:
    content = base64.b64encode(text.encode()).decode("ascii")
    return f"data:{kind};base64,{content}"


def _checks(checks: Sequence[Check]) -> str:
    out = io.StringIO()
    rows = csv.writer(out, lineterminator="\r\n")
    rows.writerow(["id", "title", "value", "limit", "unit", "margin", "status", "basis", "source"])
    for check in checks:
        numbers = (check.value, check.limit, check.margin if check.known else None)
        value, limit, margin = ("" if one is None else repr(float(one)) for one in numbers)
        told = (check.status, check.basis, check.source)
        rows.writerow([check.id, check.title, value, limit, check.unit, margin, *told])
    return out.getvalue()


def _linked(
    files: Sequence[WrittenFile], target: Path | None
) -> tuple[tuple[str, str, WrittenFile], ...]:
    """Name of each file, its address from where the page stands, and the file.

    Without an address where the page's place is not known, or no path leads from one to the other.
    """
    found = []
    for file in files:
        address = ""
        if target is not None:
            try:
                way = os.path.relpath(file.path.absolute(), target.absolute().parent)
            except ValueError:  # another drive
                way = ""
            address = quote(Path(way).as_posix()) if way else ""
        found.append((file.path.name, address, file))
    return tuple(found)
