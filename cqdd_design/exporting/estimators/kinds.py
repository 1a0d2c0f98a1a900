"""Forms in which a torque estimator is written: one row a kind, and nothing else lists them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

from cqdd_design.exporting.kinds import load_writer

if TYPE_CHECKING:
    from pathlib import Path

    from cqdd_design.exporting.estimators.options import Export
    from cqdd_design.torque.networks.artefact import Artefact

    Writer = Callable[[Artefact, Path], Export]


@dataclass(frozen=True)
class EstimatorKind:
    """A form of an estimator.

    Attributes
    ----------
    name : str
        As in ``torque export --to``.
    writer : str
        ``chapter.module:function``, imported only when asked for; the function writes an artefact
        under names that begin with that of a path.
    title : str
        What is written, in a few words.
    """

    name: str
    writer: str
    title: str

    def load(self) -> Writer:
        """Import the function that writes it."""
        found: Writer = load_writer(f"estimators.{self.writer}")
        return found


_ROWS = (
    EstimatorKind("onnx", "onnx:export_onnx", "a step or a window for onnxruntime"),
    EstimatorKind("torchscript-isaaclab", "isaaclab:export_isaaclab", "networks for Isaac Lab"),
    EstimatorKind("newton", "newton:export_newton", "a GRU for Newton"),
    EstimatorKind("mjlab", "mjlab:export_mjlab", "a network for mjlab"),
    EstimatorKind("c", "c_header:export_c", "a C99 header without dependencies"),
)
KINDS: Mapping[str, EstimatorKind] = MappingProxyType({row.name: row for row in _ROWS})
"""Every kind by its name, in the order of help."""
