"""What every check of the gearbox means: rule, reason and source, independent of any design.

:data:`CHECK_GUIDE` is what ``cqdd-design explain`` prints and what the checks are built from, so
the two cannot disagree.
"""

from __future__ import annotations

from cqdd_design.errors import UsageError, did_you_mean
from cqdd_design.gearbox.checks import (
    guide_asked,
    guide_bodies,
    guide_drawn,
    guide_drive,
    guide_heat,
    guide_joints,
    guide_loads,
    guide_retention,
    guide_runners,
    guide_shaft,
    guide_shape,
)
from cqdd_design.gearbox.checks.guide_row import CheckGuide

CHECK_GUIDE: dict[str, CheckGuide] = {
    row.id: row
    for row in (
        *guide_shape.ROWS,
        *guide_loads.ROWS,
        *guide_shaft.ROWS,
        *guide_joints.ROWS,
        *guide_retention.ROWS,
        *guide_runners.ROWS,
        *guide_bodies.ROWS,
        *guide_heat.ROWS,
        *guide_drive.ROWS,
        *guide_drawn.ROWS,
        *guide_asked.ROWS,
    )
}


def check_guide(check_id: str) -> CheckGuide:
    """Look up the meaning of the check called `check_id`, in any case of letters.

    Raises
    ------
    UsageError
        With the nearest identifiers, when there is none.

    Examples
    --------
    >>> check_guide("bearing-life").unit
    'h'
    """
    row = CHECK_GUIDE.get(check_id.strip().upper())
    if row is None:
        raise UsageError(f"there is no check '{check_id}'{did_you_mean(check_id, CHECK_GUIDE)}.")
    return row
