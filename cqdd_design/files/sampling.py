"""Times of samples: whether they rise, and whether rows are missing between them."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_UNIFORM, _GAP = 0.9, 5.0
"""Share of equal intervals from which rows count as evenly sampled; a gap, over those."""
_EQUAL = 0.05


def first_that_does_not_rise(times: NDArray[np.float64]) -> int | None:
    """Place of the first time that is not above the one before; None where all are."""
    import numpy as np

    wrong = np.flatnonzero(np.diff(times) <= 0.0)
    return int(wrong[0]) + 1 if wrong.size else None


def gap_in_even_rows(
    times: NDArray[np.float64], least: int, known: NDArray[np.bool_]
) -> tuple[int, float, float] | None:
    """The longest gap of an even sampling: its end's place, its length, and the usual interval, s.

    None where rows are not evenly sampled, as corner points far apart are not, or fewer intervals
    than `least` tell that, or none of them is much longer.

    Parameters
    ----------
    times : array (N,)
        Rising, s.
    known : array (N - 1,)
        Which intervals need no rows, as their ends tell all.
    """
    import numpy as np

    between = np.diff(times)
    if len(between) < least:
        return None
    usual = float(np.median(between))
    even = float(np.mean(np.abs(between - usual) <= _EQUAL * usual))
    longest = int(np.argmax(np.where(known, 0.0, between)))
    if even < _UNIFORM or known[longest] or between[longest] <= _GAP * usual:
        return None
    return longest + 1, float(between[longest]), usual
