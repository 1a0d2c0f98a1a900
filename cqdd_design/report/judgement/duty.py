"""The duty over time in the report: what a cycle comes to."""

from __future__ import annotations

from cqdd_design.design import Design
from cqdd_design.report.ink.numbers import significant, with_unit

Row = tuple[str, str, str]


def duty_rows(design: Design) -> tuple[Row, ...]:
    """Rows of (quantity, value, remark) of a duty that comes from a file; none without one."""
    log = design.requirements.duty_log
    if log is None:
        return ()
    found = log.figures
    cases = len(design.requirements.load_cases)
    return (
        ("duty over time", log.source, f"{found.rows} rows, taken as {cases} load cases"),
        ("cycle", with_unit(found.cycle_time, "s"), "comes again and again"),
        ("torque, r.m.s.", with_unit(found.torque_rms, "N*m"), "at the output"),
        (
            "greatest torque",
            with_unit(found.torque_peak, "N*m"),
            f"at {significant(found.torque_peak_at)} s",
        ),
        (
            "speed, r.m.s.",
            with_unit(found.speed_rms, "rad/s"),
            f"at most {significant(found.speed_peak)}, on average {significant(found.speed_mean)}",
        ),
        ("work on the load", with_unit(found.energy_delivered, "J"), "in a cycle"),
        ("work of the load", with_unit(found.energy_returned, "J"), "given back in a cycle"),
    )
