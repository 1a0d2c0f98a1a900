"""numba, with a cache of compiled kernels that may be spoilt: such a kernel is compiled anew.

numba keeps what it compiled in files, which a full disk or a killed process leaves damaged, and
believes whatever it finds there. Kernels import numba from here.
"""

from __future__ import annotations

import functools
import logging
from typing import Any

import numba
from numba.core.caching import FunctionCache

__all__ = ["numba"]

_log = logging.getLogger("cqdd_design")


def _guard() -> None:
    """Let this package's kernels survive what cannot be loaded; other packages' are left alone."""
    load: Any = FunctionCache.load_overload

    @functools.wraps(load)
    def guarded(cache: Any, signature: Any, context: Any) -> Any:
        try:
            return load(cache, signature, context)
        except Exception as error:
            kernel = cache._py_func
            if not kernel.__module__.startswith("cqdd_design."):
                raise
            _log.warning(
                "the compiled kernel %s in %s is spoilt (%s); compiling it anew",
                kernel.__name__,
                cache.cache_path,
                type(error).__name__,
            )
            cache.flush()
            return None

    FunctionCache.load_overload = guarded  # type: ignore[method-assign]


_guard()
