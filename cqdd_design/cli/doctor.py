"""``cqdd-design doctor``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from cqdd_design.cli.session import Output
from cqdd_design.cli.tables import table
from cqdd_design.errors import DependencyError

if TYPE_CHECKING:
    from cqdd_design.environment import Finding


def doctor(out: Output) -> int:
    """Look for everything the package needs; exit code 5 when something is missing."""
    from cqdd_design.environment import examine, project_folder
    from cqdd_design.roads.places import kept_places

    findings = [*examine(project_folder()), *kept_places()]
    missing = [finding for finding in findings if finding.state == "missing"]
    out.say(table([*_rows(findings)]))
    out.say("", f"{len(missing)} missing" if missing else "everything needed is here")
    if out.as_json:  # people have read it in the table
        out.warn(*(f"{finding.name}: {finding.detail}" for finding in missing))
    out.document(
        {
            "findings": [{"name": f.name, "state": f.state, "detail": f.detail} for f in findings],
            "missing": [f.name for f in missing],
        }
    )
    return DependencyError.exit_code if missing else 0


def _rows(findings: Sequence[Finding]) -> Iterator[list[str]]:
    """A row for each finding, and for what an extra would bring one of all together."""
    from cqdd_design.environment import DISTRIBUTION, EXTRAS

    yield from ([f.state, f.name, f.detail] for f in findings if not f.extra)
    for extra, use in EXTRAS.items():
        lacking = [f.name for f in findings if f.extra == extra]
        if lacking:
            fix = f"pip install '{DISTRIBUTION}[{extra}]'"
            yield ["optional", extra, f"for {use}: {fix} brings {', '.join(lacking)}"]
