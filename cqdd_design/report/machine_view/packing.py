"""Model and viewer as text that is small enough to travel inside the page.

Both are gzip in base64, which browsers unpack themselves (``DecompressionStream``). Before, every
corner of the model's triangles becomes its distance from the next vertex that has not been used
yet, mostly a small number; ``machine3d.js`` turns it back. Nothing is lost.
"""

from __future__ import annotations

import base64
import gzip
import json
import struct
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.exporting.solids.gltf import INDICES
from cqdd_design.report.ink.page import Values

if TYPE_CHECKING:
    from cqdd_design.report.machine_view.model import ViewerData
    from cqdd_design.report.machine_view.stills import MachineViews

_EFFORT = 8
"""Of gzip's 9: the last makes a model a thousandth smaller in twice the time."""
_VENDOR = Path(__file__).parents[1] / "vendor"


def packed(content: bytes) -> str:
    """Bytes as text for the page; the same bytes give the same text."""
    return base64.b64encode(gzip.compress(content, _EFFORT, mtime=0)).decode("ascii")


def packed_model(glb: bytes) -> str:
    """A binary glTF whose vertices stand in the order of their first use."""
    size = struct.unpack_from("<I", glb, 12)[0]
    document = json.loads(glb[20 : 20 + size])
    content = bytearray(glb)
    start = 28 + size
    for accessor in document["accessors"]:
        view = document["bufferViews"][accessor["bufferView"]]
        if view["target"] != INDICES:
            continue
        kind = np.dtype({5123: "<u2", 5125: "<u4"}[accessor["componentType"]])
        corners = np.frombuffer(content, kind, accessor["count"], start + view["byteOffset"])
        reached = np.maximum.accumulate(np.concatenate([[-1], corners[:-1].astype(np.int64)])) + 1
        corners[:] = reached - corners
    return packed(bytes(content))


def packed_script() -> str:
    """The vendored viewer."""
    return packed((_VENDOR / "machine-viewer.min.js").read_bytes())


def licence() -> str:
    """Of what the viewer contains."""
    return (_VENDOR / "three-LICENSE.txt").read_text(encoding="utf-8").strip()


def machine_values(views: MachineViews, viewer: ViewerData | None) -> Values:
    """What ``machine3d.html`` is given; without a viewer it shows the still pictures alone."""
    values: Values = {"machine_views": views, "machine_viewer": viewer}
    if viewer is None:
        return values
    return values | {
        "machine_model": packed_model(viewer.glb),
        "machine_script": packed_script(),
        "machine_licence": licence(),
    }
