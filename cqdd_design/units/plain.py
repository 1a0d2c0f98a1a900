"""Plain numbers, without a unit: what counts as one, of Python and of numpy alike."""

from __future__ import annotations

import math
from numbers import Integral, Real


def real_number(value: object) -> float | None:
    """A number as a float; None of anything else, of a truth value among it.

    Examples
    --------
    >>> import numpy as np
    >>> real_number(2), real_number(np.float32(0.5)), real_number(True), real_number("2")
    (2.0, 0.5, None, None)
    """
    if isinstance(value, bool) or not isinstance(value, Real):
        return None
    try:
        return float(value)
    except OverflowError:  # a whole number of more than 308 digits
        return math.copysign(math.inf, value)


def whole_number(value: object) -> int | None:
    """A whole number as an int, a whole float too; None of anything else.

    Examples
    --------
    >>> import numpy as np
    >>> whole_number(np.int64(8)), whole_number(8.0), whole_number(8.5), whole_number(True)
    (8, 8, None, None)
    """
    if isinstance(value, Integral) and not isinstance(value, bool):
        return int(value)
    number = real_number(value)
    if number is None or not number.is_integer():
        return None
    return int(number)
