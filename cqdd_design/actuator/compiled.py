"""Whether the kernel of the actuator in time is in numba's cache."""

from __future__ import annotations


def is_compiled() -> bool:
    """Whether the simulation need not be compiled now; see `gearbox.compiled.in_cache`."""
    from cqdd_design.actuator.kernels import stepping as kernel
    from cqdd_design.gearbox.compiled import in_cache

    return in_cache(kernel.run_sets)
