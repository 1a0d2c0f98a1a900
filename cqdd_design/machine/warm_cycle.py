"""Temperatures of a machine's parts over a cycle of its duty."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import permutations

import numpy as np

from cqdd_design.geometry.contours import FloatArray
from cqdd_design.machine.heat_nodes import NODES, Node

_SHOWN = 200
"""Times of a duty's cycle in JSON."""
_FITTED: tuple[Node, ...] = ("ring", "disc", "shaft", "carrier", "housing")
"""Parts that clearances and seats hang on."""


@dataclass(frozen=True, eq=False)
class WarmCycle:
    """Temperatures over one cycle of a duty, the same in every one.

    Attributes
    ----------
    time : array (K,)
        From the beginning of the cycle, s.
    temperature : array (K, N)
        At these times, deg C.
    """

    time: FloatArray
    temperature: FloatArray

    @property
    def winding(self) -> tuple[float, float]:
        """Greatest temperature of the winding, deg C, and when it has it, s."""
        values = self.temperature[:, NODES.index("winding")]
        hottest = int(values.argmax())
        return float(values[hottest]), float(self.time[hottest])

    @cached_property
    def extremes(self) -> FloatArray:
        """Temperatures (M, N) at the moments when parts are hottest or most unlike, deg C."""
        fitted = [self.temperature[:, NODES.index(node)] for node in _FITTED]
        found = {int(one.argmax()) for one in fitted}
        found |= {int((one - other).argmax()) for one, other in permutations(fitted, 2)}
        return np.asarray(self.temperature[sorted(found)])

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form, some hundred times of the cycle and the hottest."""
        most, when = self.winding
        some = np.unique(np.linspace(0, len(self.time) - 1, _SHOWN).round().astype(int))
        return {
            "winding_peak_degC": most,
            "winding_peak_at_s": when,
            "winding_least_degC": float(self.temperature[:, NODES.index("winding")].min()),
            "time_s": self.time[some].tolist(),
            "cycle_degC": {n: self.temperature[some, i].tolist() for i, n in enumerate(NODES)},
        }
