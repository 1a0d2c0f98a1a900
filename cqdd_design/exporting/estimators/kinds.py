"""Forms in which a torque estimator is written: one row a kind, and nothing else lists them.

Their writers take an artefact and the path whose name begins that of every file.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from cqdd_design.exporting.kinds import Kind

_ROWS = (
    Kind("onnx", "estimators.onnx:export_onnx", "a step or a window for onnxruntime"),
    Kind("torchscript-isaaclab", "estimators.isaaclab:export_isaaclab", "networks for Isaac Lab"),
    Kind("newton", "estimators.newton:export_newton", "a GRU for Newton"),
    Kind("mjlab", "estimators.mjlab:export_mjlab", "a network for mjlab"),
    Kind("c", "estimators.c_header:export_c", "a C99 header without dependencies"),
)
KINDS: Mapping[str, Kind] = MappingProxyType({row.name: row for row in _ROWS})
"""Every kind by its name, in the order of help."""
