"""What ``cqdd-design --where`` shows: every folder that commands write into."""

from __future__ import annotations

from cqdd_design.cli.tables import folded
from cqdd_design.environment import OUTPUTS, PROJECT, cache_folder, output_folder

_WIDTH = 14
"""Of the column of names."""


def places() -> str:
    """Outputs, what is kept for the next run, and how to change each; a path stays whole."""
    from cqdd_design.roads.kernels import kernel_folder

    shown = [(name, output_folder(name), what) for name, what in OUTPUTS.items()]
    shown += [
        ("kept results", cache_folder(), "meshes and gearboxes of earlier runs"),
        ("kernels", kernel_folder(), "compiled on the first use"),
    ]
    lines = []
    for name, folder, what in shown:
        lines += [f"{name:<{_WIDTH}}{folder.absolute()}", f"{'':<{_WIDTH}}{what}"]
    change = (
        f"--project DIR or {PROJECT} names another folder for designs, exports and reports; "
        "CQDD_DESIGN_CACHE one for kept results, NUMBA_CACHE_DIR one for kernels."
    )
    return "\n".join([*lines, "", *folded(change)])
