"""Parts of kernels: functions that are compiled into the kernels that call them, and there alone.

numba makes machine code of every compiled function by itself, of all that it calls anew. A kernel
six calls deep so is optimised six times, though only the outermost is ever run: most of a minute
for one of ours. A part waits: its instructions are optimised once, where they end. Called from
Python a part is plain Python, slow and the same.

That takes steps that numba keeps for itself (:mod:`.kernel_unfinished`); with versions that they
were not tried with parts are compiled numba's usual way, to the same numbers in twice the time.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numba
from numba.extending import register_jitable

_Function = TypeVar("_Function", bound=Callable[..., Any])

_TRIED = ("0.68.",)
"""Beginnings of the versions of numba whose inner steps are known."""


def part(*, borrows: bool = False, **options: Any) -> Callable[[_Function], _Function]:
    """Decorator of a function that kernels call, with numba's options (`forceinline`, `fastmath`).

    Division is numpy's, as in all kernels here.

    Parameters
    ----------
    borrows : bool
        Whether it makes no array and gives none back. Nobody counts references to its arrays then,
        for its callers hold them: kernels side by side, which share most of theirs, spent a quarter
        of their time on taking turns at the counters. numba refuses one that makes an array.
    """
    # All is said, as it would be taken from whichever caller comes first.
    chosen = {"error_model": "numpy", "fastmath": False, "_nrt": not borrows, **options}

    def decorate(function: _Function) -> _Function:
        if numba.__version__.startswith(_TRIED):
            from cqdd_design.files.kernel_unfinished import register

            register(function, {"no_cfunc_wrapper": True, **chosen})
        else:
            register_jitable(**chosen)(function)
        function.part_options = chosen  # type: ignore[attr-defined]
        return function

    return decorate
