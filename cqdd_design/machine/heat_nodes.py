"""Nodes of a machine's thermal network, and what its conductances are made with."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

import numpy as np

from cqdd_design.catalog.materials import find_material
from cqdd_design.errors import DesignError
from cqdd_design.geometry.contours import FloatArray

Node = Literal["winding", "stator", "rotor", "cover", "housing", "ring", "disc", "shaft", "carrier"]

NODES: tuple[Node, ...] = (
    "winding",
    "stator",
    "rotor",
    "cover",
    "housing",
    "ring",
    "disc",
    "shaft",
    "carrier",
)

SLOTS_PER_PAIR = 12.0 / 7.0
"""Slots over pole pairs of a motor whose slots are not known: 36 to 42 poles."""
AIR = 0.028
"""Conductivity of warm air in narrow gaps, W/(m K): they are too narrow for it to circulate."""
LEAST_AIR_GAP = 0.2e-3


def series(*conductance: float) -> float:
    """Of conductances one behind the other, W/K."""
    return 1.0 / sum(1.0 / one for one in conductance)


def known(name: str, what: Literal["conductivity", "specific_heat", "emissivity"]) -> float:
    """A thermal figure of a material.

    Raises
    ------
    DesignError
        Where the catalogue has none.
    """
    value = getattr(find_material(name), what)
    if value is None:
        raise DesignError(
            f"no thermal network: the catalogue has no {what.replace('_', ' ')} of '{name}'; name "
            "a material that has one."
        )
    return float(value)


def node_values(values: dict[Node, float]) -> FloatArray:
    """Figures by node, zero where there is none, (N,)."""
    return np.array([values.get(node, 0.0) for node in NODES])


def by_node(values: Iterable[float]) -> dict[str, float]:
    """Figures of all nodes by name."""
    return {node: float(value) for node, value in zip(NODES, values, strict=True)}
