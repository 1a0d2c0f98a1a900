"""``cqdd-design check``."""

from __future__ import annotations

from cqdd_design.cli.options import DesignFile
from cqdd_design.cli.session import Output


def check(out: Output, design: DesignFile) -> int:
    """Run every check of a design (exit code 4: one fails)."""
    from cqdd_design.cli.tables import checks_table, remedies, verdict
    from cqdd_design.design import load_design
    from cqdd_design.gearbox import analyse_gearbox
    from cqdd_design.results import worst_status

    loaded = load_design(design)
    analysis = analyse_gearbox(loaded)
    out.say(checks_table(analysis.checks), "")
    if worst_status(analysis.checks) != "pass":
        out.say(remedies(analysis.checks), "")
    out.say(f"{loaded.name}: {verdict(analysis.checks)}")
    for sentence in analysis.warnings:
        out.warn(sentence)
    out.document({"verdict": worst_status(analysis.checks)}, design=loaded, checks=analysis.checks)
    return 4 if worst_status(analysis.checks) == "fail" else 0
