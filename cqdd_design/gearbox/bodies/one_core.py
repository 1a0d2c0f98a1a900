"""Linear algebra on one core while bodies are made and read: their blocks are small.

Threads of a product of small matrices wait for each other, on the core that they wait on: a body
takes four times as long with two of them, and what goes on beside it waits too. One core also gives
the same numbers whatever the number of cores.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager

from threadpoolctl import threadpool_limits

_lock = threading.Lock()
_inside, _limits = 0, None


@contextmanager
def one_core() -> Iterator[None]:
    """Hold the process's linear algebra on one core until the last that asked for it is out.

    The number of its threads is the process's and not a thread's: without a count whoever comes
    out first would give the others theirs back.
    """
    # What is loaded later is not held: scipy brings a library of its own.
    import scipy.linalg  # noqa: F401

    global _inside, _limits
    with _lock:
        _inside += 1
        if _inside == 1:
            _limits = threadpool_limits(limits=1, user_api="blas")
    try:
        yield
    finally:
        with _lock:
            _inside -= 1
            if _inside == 0 and _limits is not None:
                _limits.restore_original_limits()
