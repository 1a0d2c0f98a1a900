"""What ``cqdd-design --where`` shows: every folder that commands write into."""

from __future__ import annotations

from pathlib import Path

from cqdd_design.cli.tables import folded
from cqdd_design.environment import OUTPUTS, PROJECT, cache_folder, output_folder

_WIDTH = 14
"""Of the column of names."""


def _shown() -> list[tuple[str, Path, str]]:
    """Name, folder, and what stands in it."""
    from cqdd_design.roads.kernels import kernel_folder

    shown = [(name, output_folder(name), what) for name, what in OUTPUTS.items()]
    shown += [
        ("kept results", cache_folder(), "meshes, gearboxes and times of earlier runs"),
        ("kernels", kernel_folder(), "compiled on the first use, here and beside"),
    ]
    return [(name, folder.absolute(), what) for name, folder, what in shown]


def places() -> str:
    """Outputs, what is kept for the next run, and how to change each; a path stays whole."""
    lines = []
    for name, folder, what in _shown():
        lines += [f"{name:<{_WIDTH}}{folder}", f"{'':<{_WIDTH}}{what}"]
    change = (
        f"--project DIR or {PROJECT} names another folder for designs, exports and reports; "
        "CQDD_DESIGN_CACHE one for kept results, NUMBA_CACHE_DIR one for kernels."
    )
    return "\n".join([*lines, "", *folded(change)])


def places_document() -> str:
    """The same folders as a JSON document."""
    from cqdd_design.library.envelope import result_document

    told = [{"name": name, "folder": str(folder), "what": what} for name, folder, what in _shown()]
    return result_document("where", {"places": told}, design=None, checks=(), warnings=(), files=())
