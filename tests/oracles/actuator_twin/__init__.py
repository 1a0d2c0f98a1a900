"""The compiled kernels in plain numpy: the same equations, written to be read."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from actuator_twin.stepping import run_sets
from cqdd_design.actuator import simulate


@contextmanager
def in_plain_numpy() -> Iterator[None]:
    """Simulations run by the twin, some thousand times slower, in place of the kernel."""
    compiled = simulate.run_compiled
    simulate.run_compiled = lambda work, threads=None: run_sets(*work)
    try:
        yield
    finally:
        simulate.run_compiled = compiled
