"""What lasts, in the report: a duty and what its cycle comes to, or the continuous torque."""

from __future__ import annotations

import math

from cqdd_design.design import Design, Requirements
from cqdd_design.report.ink.numbers import RPM, significant, with_unit

Row = tuple[str, str, str]


def duty_text(asked: Requirements) -> str:
    """Greatest and r.m.s. torque of the duty; empty without one."""
    if not asked.load_cases:
        return ""
    log = asked.duty_log
    square = sum(one.share * one.torque**2 for one in asked.load_cases)
    effective = math.sqrt(square) if log is None else log.figures.torque_rms
    return (
        f"{with_unit(asked.lasting_torque, 'N*m')} at most and {with_unit(effective, 'N*m')} r.m.s."
    )


def held_speed_text(asked: Requirements) -> str:
    """Speed of the input at the continuous torque, and which of the requirements it is."""
    which = "input" if asked.continuous_speed is None else "continuous"
    return f"the {which} speed of {with_unit(asked.held_speed * RPM, 'rpm')}"


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
