"""Whether the compiled kernels of this installation are in numba's cache."""

from __future__ import annotations

from pathlib import Path


def is_compiled() -> bool:
    """Whether a former run has left compiled kernels behind, so that none need be compiled now.

    Told from the folder of numba's cache for the kernels, beside them or in the user's cache
    folder; where numba keeps it elsewhere the answer is that they are compiled, and nothing is
    announced.
    """
    from cqdd_design.gearbox.contact import kernel

    cache = getattr(kernel.solve_sweep, "_cache", None)
    folder = getattr(cache, "cache_path", None)
    return folder is None or any(Path(folder).glob("kernel.solve_sweep-*.nbi"))
