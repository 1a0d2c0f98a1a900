"""Brent's root of a function between two ends.

In Python, because a command needs it a few times and the package that has it takes half a second
to come in; the numbers are those of ``scipy.optimize.brentq`` to the bit, which a test compares.
"""

from __future__ import annotations

from collections.abc import Callable

_STEPS = 100


def _apart(one: float, other: float) -> bool:
    """Whether one is above zero and the other below; their product may be too small to tell."""
    return one < 0.0 < other or other < 0.0 < one


def bracketed_root(
    function: Callable[[float], float],
    low: float,
    high: float,
    *,
    absolute: float,
    relative: float = 8.881784197001252e-16,
) -> float:
    """The root of a function whose signs at two ends differ; Brent 1973, chapter 4.

    Inverse quadratic interpolation or the secant where they shorten the bracket fast enough, else
    its half.

    Parameters
    ----------
    function : callable
        Continuous.
    low, high : float
        Ends.
    absolute, relative : float
        The root is found to the sum of `absolute` and `relative` times itself; the latter defaults
        to four roundings.

    Raises
    ------
    ValueError
        When the signs at the ends are the same, a value is not a number, or the root is not found
        in 100 steps.
    """
    before, now = low, high
    f_before, f_now = function(before), function(now)
    if f_before == 0.0:
        return before
    if f_now == 0.0:
        return now
    if not _apart(f_before, f_now):
        raise ValueError(f"no root is known between {low} and {high}: {f_before} and {f_now}")
    other, f_other, step, last = 0.0, 0.0, 0.0, 0.0
    for _ in range(_STEPS):
        if _apart(f_before, f_now):
            other, f_other = before, f_before
            step = last = now - before
        if abs(f_other) < abs(f_now):
            before, now, other = now, other, now
            f_before, f_now, f_other = f_now, f_other, f_now
        least = (absolute + relative * abs(now)) / 2.0
        half = (other - now) / 2.0
        if f_now == 0.0 or abs(half) < least:
            return now
        if abs(last) > least and abs(f_now) < abs(f_before):
            if before == other:
                trial = -f_now * (now - before) / (f_now - f_before)
            else:
                rise = (f_before - f_now) / (before - now)
                other_rise = (f_other - f_now) / (other - now)
                trial = -f_now * (f_other * other_rise - f_before * rise)
                trial /= other_rise * rise * (f_other - f_before)
            good = 2.0 * abs(trial) < min(abs(last), 3.0 * abs(half) - least)
            last, step = (step, trial) if good else (half, half)
        else:
            last = step = half
        before, f_before = now, f_now
        if abs(step) > least:
            now += step
        else:
            now += least if half > 0.0 else -least
        f_now = function(now)
        if f_now != f_now:
            raise ValueError(f"the function is not a number at {now}")
    raise ValueError(f"no root was found to this tolerance after {_STEPS} steps")
