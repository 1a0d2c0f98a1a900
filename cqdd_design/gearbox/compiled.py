"""Whether the compiled kernels of this installation are in numba's cache."""

from __future__ import annotations

from pathlib import Path
from typing import Any


def in_cache(kernel: Any) -> bool:
    """Whether a former run has left a kernel compiled behind.

    Told from the folder of numba's cache for it, beside its module or in the user's cache folder;
    where numba keeps it elsewhere the answer is that it is compiled, and nothing is announced.
    """
    cache = getattr(kernel, "_cache", None)
    folder = getattr(cache, "cache_path", None)
    name = f"{kernel.__module__.rpartition('.')[2]}.{kernel.__name__}"
    return folder is None or any(Path(folder).glob(f"{name}-*.nbi"))


def is_compiled() -> bool:
    """Whether the contact solver need not be compiled now."""
    from cqdd_design.gearbox.contact.sweep_kernel import solve_sweep

    return in_cache(solve_sweep)
