"""Whether the compiled kernels of this installation are in numba's cache."""

from __future__ import annotations

from typing import Any


def in_cache(kernel: Any) -> bool:
    """Whether a former run has left a kernel compiled behind, of the code that is there now.

    Where kernels are not compiled, or numba keeps none, the answer is yes: there is nothing to do
    beforehand.
    """
    from cqdd_design.files.kernel_cache import kept_signatures

    cache = getattr(kernel, "_cache", None)
    return not hasattr(cache, "_cache_file") or bool(kept_signatures(cache))
