"""Linear algebra of bodies runs on one core, and has its threads back when the last is out."""

import numpy as np
from threadpoolctl import threadpool_info, threadpool_limits

from cqdd_design.gearbox.bodies.one_core import one_core


def threads() -> set[int]:
    np.linalg.cholesky(np.eye(3))
    return {one["num_threads"] for one in threadpool_info() if one["user_api"] == "blas"}


def test_threads_come_back_when_the_last_is_out():
    with one_core():
        # Whatever is loaded by now is held, scipy's own library too.
        assert threads() == {1}
    with threadpool_limits(limits=2, user_api="blas"):
        first, second = one_core(), one_core()
        first.__enter__()
        second.__enter__()
        assert threads() == {1}
        # The one that came first goes first, as threads beside each other do.
        first.__exit__(None, None, None)
        assert threads() == {1}
        second.__exit__(None, None, None)
        assert threads() == {2}


def test_threads_come_back_after_an_error():
    with threadpool_limits(limits=2, user_api="blas"):
        try:
            with one_core():
                raise ValueError
        except ValueError:
            pass
        assert threads() == {2}
