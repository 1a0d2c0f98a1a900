"""Where compiled kernels and costly results are kept, for those who look after a machine."""

from __future__ import annotations

from cqdd_design.environment import Finding, cache_folder, writable


def kept_places() -> list[Finding]:
    """Both places, or what to set where there is none: everything works without, and takes long."""
    return [_kernels(), _results()]


def _kernels() -> Finding:
    from cqdd_design.files import kernel_cache

    name = "compiled kernels"
    if kernel_cache.KEPT_IN:
        return Finding(name, "ok", f"kept in {kernel_cache.KEPT_IN} and beside")
    told = "no folder can be written, so every run compiles them; set NUMBA_CACHE_DIR to one"
    return Finding(name, "optional", told)


def _results() -> Finding:
    name, folder = "kept results", cache_folder()
    if writable(folder).state == "ok":
        return Finding(name, "ok", f"{folder} can be written")
    told = f"{folder} cannot be written, so nothing is kept; set CQDD_DESIGN_CACHE to a folder"
    return Finding(name, "optional", told)
