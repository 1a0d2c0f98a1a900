"""Blocks of drawn gearboxes on disk: every command that judges a design needs the same ones."""

from __future__ import annotations

import json
from collections.abc import Iterator

import numpy as np

from cqdd_design.design import Design
from cqdd_design.environment import cache_folder
from cqdd_design.files.kept import entry_path, read_entry, write_entry
from cqdd_design.files.package_state import package_state
from cqdd_design.gearbox.tolerance.ensemble import Block, Ensemble, work_block
from cqdd_design.geometry.contours import FloatArray

_MOST_KEPT = 100_000_000
"""Bytes of all entries together: ten thousand blocks."""
_ELSEWHERE = frozenset({"name", "motor", "drive", "edm"})
"""Tables of a design that no gearbox knows."""


def work_remembered(ensemble: Ensemble, blocks: list[Block]) -> Iterator[tuple[int, FloatArray]]:
    """Blocks as the disk has them, or worked in this process and put there; see :data:`.Mapper`."""
    for place, block in enumerate(blocks):
        yield place, _block(ensemble, block)


def _block(ensemble: Ensemble, block: Block) -> FloatArray:
    text = json.dumps(
        {
            "code": package_state(),
            "design": _physical(ensemble.design),
            "bodies": None if ensemble.bodies is None else _physical(ensemble.bodies),
            "torque": ensemble.torque,
            "angles": ensemble.angles,
            "seed": ensemble.seed,
            "temperatures": vars(ensemble.temperatures),
            "outputs": ensemble.outputs,
            "at_rest": ensemble.at_rest,
            "gearboxes": [block.first, block.count, *block.exchanged],
        },
        sort_keys=True,
    )
    path = entry_path(cache_folder() / "gearboxes", text, "block")
    kept = read_entry(path, text)
    if kept is not None:
        return np.asarray(kept[0][0], dtype=np.float64)
    values = work_block(ensemble, block)
    write_entry(path, text, [np.ascontiguousarray(values, "<f8")], None, _MOST_KEPT)
    return values


def _physical(design: Design) -> dict[str, object]:
    """What gearboxes can depend on, and more: not the name, the motor, or how files are cut."""
    mapping = design.to_mapping()
    mapping["requirements"].pop("motor", None)
    return {key: value for key, value in mapping.items() if key not in _ELSEWHERE}
