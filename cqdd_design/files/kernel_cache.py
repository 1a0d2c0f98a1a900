"""numba, with a cache of compiled kernels that may be spoilt or old: these are compiled anew.

numba keeps what it compiled in files, which a full disk or a killed process leaves damaged, and
believes whatever it finds there, though what was compiled into a kernel has changed in another
file. Kernels import numba from here. Where no folder can be written, which numba refuses, they are
kept for one run.
"""

from __future__ import annotations

import atexit
import functools
import logging
import os
import shutil
import tempfile
from pathlib import Path
from typing import Any

import numba
from numba.core.caching import FunctionCache

from cqdd_design.files.kernel_stamp import kernel_stamp

__all__ = ["KEPT_IN", "cache_place", "kept_signatures", "numba"]

_log = logging.getLogger("cqdd_design")


def _guard() -> None:
    """Let this package's kernels survive what cannot be loaded; other packages' are left alone."""
    load: Any = FunctionCache.load_overload
    save: Any = FunctionCache.save_overload

    @functools.wraps(load)
    def guarded(cache: Any, signature: Any, context: Any) -> Any:
        kernel = cache._py_func
        if not kernel.__module__.startswith("cqdd_design."):
            return load(cache, signature, context)
        _stamp(cache)
        try:
            return load(cache, signature, context)
        except Exception as error:
            _log.warning(
                "the compiled kernel %s in %s is spoilt (%s); compiling it anew",
                kernel.__name__,
                cache.cache_path,
                type(error).__name__,
            )
            cache.flush()
            return None

    @functools.wraps(save)
    def stamped(cache: Any, signature: Any, data: Any) -> Any:
        if cache._py_func.__module__.startswith("cqdd_design."):
            _stamp(cache)
        return save(cache, signature, data)

    FunctionCache.load_overload = guarded  # type: ignore[method-assign]
    FunctionCache.save_overload = stamped  # type: ignore[method-assign]


def _find_place() -> str:
    """Keep kernels for this run alone where none of numba's folders can be written.

    Returns the folder in which they are kept; nothing for one run.

    In a folder of this user, since what is read from it is run.
    """
    place: Any = FunctionCache
    try:
        return str(place(_guard).cache_path)
    except RuntimeError:
        folder = tempfile.mkdtemp(prefix="cqdd-design-kernels-")
        # Processes that are started inherit the variable.
        os.environ["NUMBA_CACHE_DIR"] = folder
        config: Any = numba.config
        config.reload_config()
        atexit.register(_clear, folder, os.getpid())
        _log.warning(
            "no folder for compiled kernels can be written, so every run compiles them; "
            "set NUMBA_CACHE_DIR to one"
        )
        return ""


def _clear(folder: str, owner: int) -> None:
    """Remove the folder of one run, at the exit of the process that made it and of no fork."""
    if os.getpid() == owner:
        shutil.rmtree(folder, ignore_errors=True)


def _stamp(cache: Any) -> None:
    """Keep a kernel as long as all that is in it stays; asked when all of its module is there."""
    if not isinstance(cache._cache_file._source_stamp, str):
        cache._cache_file._source_stamp = kernel_stamp(cache._py_func)


def cache_place(cache: Any) -> Path:
    """The folder that a kernel's cache is written into."""
    return Path(cache.cache_path)


def kept_signatures(cache: Any) -> list[Any]:
    """Types of arguments for which a kernel's cache has machine code of the code that is there now.

    None where it is spoilt.
    """
    _stamp(cache)
    try:
        return list(cache._cache_file._load_index())
    except Exception:  # pickled files raise what they like
        return []


KEPT_IN = _find_place()
"""Folder of this module's kernels, where there are some; empty where they are kept for one run."""
_guard()
