"""Values of unknowns, each in its range, with which the bench gives measured rows.

Least squares of relative misses over logarithms. Where a row cannot be measured with some values
(a gearbox that holds itself, a machine that cannot be stepped), its miss is past all others: the
search turns back there instead of ending. What it ends with is bounded, can be measured, and comes
within `CLOSE` of as many rows as there are unknowns; else a sentence says what fails.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from cqdd_design.actuator.bench.run import run_bench
from cqdd_design.actuator.bench.unknowns import UNKNOWNS
from cqdd_design.actuator.parameters import ActuatorParameters, FloatArray
from cqdd_design.errors import CqddError, UsageError
from cqdd_design.terms import measurement

CLOSE = 0.05
"""Relative miss of a row below which it counts as fitted."""
_STEP = 0.02
"""Of a logarithm for its slope: simulated rows are smooth to a part in a thousand only."""
_UNMEASURED = 1500.0
"""Miss of a row that cannot be measured: above the logarithm of any ratio of two floats."""
_FITTED = 1e-3
"""Relative miss that is not worth another step."""
_MOST_ROUNDS, _HALVINGS, _LONGEST = 15, 5, 2.0
"""Steps at most, halvings of one, and its greatest change of a logarithm."""
_AT_END = 0.005
"""Nearer to an end of its range, as a share of it, an unknown counts as not found."""


class _Misses:
    """Logarithms of what the bench gives over what was measured, each point asked once."""

    def __init__(
        self,
        parameters: ActuatorParameters,
        targets: Mapping[str, float],
        names: tuple[str, ...],
        voltage: float,
        rig_stiffness: float | None,
    ) -> None:
        self._parameters, self._targets, self._names = parameters, targets, names
        self._voltage, self._rig = voltage, rig_stiffness
        self._found: dict[bytes, FloatArray] = {}
        self.why = ""

    def at(self, logarithms: FloatArray) -> FloatArray:
        """Misses of the rows; `why` tells of the last point at which one cannot be measured."""
        key = logarithms.tobytes()
        if key not in self._found:
            self._found[key] = self._measured(logarithms)
        return self._found[key]

    def _measured(self, logarithms: FloatArray) -> FloatArray:
        changed = self._parameters
        for name, logarithm in zip(self._names, logarithms, strict=True):
            changed = UNKNOWNS[name].change(changed, math.exp(logarithm))
        try:
            result = run_bench(
                changed,
                only=tuple(self._targets),
                voltage=self._voltage,
                rig_stiffness=self._rig,
            )
        except CqddError as error:
            self.why = error.message.rstrip(".")
            return np.full(len(self._targets), _UNMEASURED)
        misses = []
        for name, wanted in self._targets.items():
            value = result.value(name)
            if value is None:
                said = measurement(name)
                self.why = next(
                    (one.rstrip(".") for one in result.warnings if one.startswith(said)), said
                )
            lost = value is None or value <= 0.0
            misses.append(_UNMEASURED if lost or value is None else math.log(value / wanted))
        return np.array(misses)

    def slopes(self, logarithms: FloatArray, most: FloatArray) -> FloatArray:
        """Of the misses over the logarithms (R, U), by steps that stay in the range."""
        here = self.at(logarithms)
        columns = []
        for k in range(len(logarithms)):
            step = _STEP if logarithms[k] + _STEP <= most[k] else -_STEP
            for way in (step, -step):
                beside = logarithms.copy()
                beside[k] += way
                change = self.at(beside) - here
                if not np.any(np.abs(self.at(beside)) >= _UNMEASURED):
                    break
            columns.append(change / way)
        return np.array(columns).T


def _searched(
    misses: _Misses, start: FloatArray, least: FloatArray, most: FloatArray
) -> FloatArray:
    """Logarithms with the least misses that Gauss and Newton's steps lead to from a start.

    A whole step takes every row nearer at once; descent would first lower the largest miss at the
    cost of others. Steps are halved until the misses fall, and end at the ends of the range.
    """
    at, here = start, misses.at(start)
    for _ in range(_MOST_ROUNDS):
        if np.abs(here).max() < _FITTED:
            break
        slopes = misses.slopes(at, most)
        step = np.linalg.lstsq(slopes, -here, rcond=1e-6)[0]
        # What stands at an end and wants to go beyond stays; the others make up for it.
        held = ((at <= least) & (step < 0.0)) | ((at >= most) & (step > 0.0))
        if held.any():
            step = np.linalg.lstsq(np.where(held, 0.0, slopes), -here, rcond=1e-6)[0]
        step *= min(1.0, _LONGEST / max(float(np.abs(step).max()), 1e-12))
        for share in 0.5 ** np.arange(_HALVINGS):
            there = np.clip(at + share * step, least, most)
            found = misses.at(there)
            if np.linalg.norm(found) < (1.0 - 0.01 * share) * np.linalg.norm(here):
                at, here = there, found
                break
        else:
            break
    return at


def fit(
    parameters: ActuatorParameters,
    targets: Mapping[str, float],
    names: tuple[str, ...],
    voltage: float,
    rig_stiffness: float | None = None,
) -> dict[str, float]:
    """Values of unknowns with which the bench gives rows.

    Parameters
    ----------
    targets : mapping of str to float
        Measured rows in the bench's units.
    names : tuple of str
        Of `UNKNOWNS`, no more than rows.
    voltage, rig_stiffness : float
        As for `run_bench`.

    Raises
    ------
    UsageError
        Where a row cannot be measured, or as many unknowns as rows do not come within `CLOSE`,
        naming the one that ends at an end of its range.
    """
    ranges = {name: UNKNOWNS[name].bounds(parameters) for name in names}
    least, most = np.log(np.array(list(ranges.values()))).T
    misses = _Misses(parameters, targets, names, voltage, rig_stiffness)
    first = np.log([UNKNOWNS[name].start(parameters) for name in names])
    found = _searched(misses, first, least, most)
    left = misses.at(found)
    asked = ", ".join(f"{row} {value:g}" for row, value in targets.items())
    if np.any(np.abs(left) >= _UNMEASURED):
        raise UsageError(f"cannot calibrate to what cannot be measured: {misses.why}.")
    if np.abs(left).max() <= CLOSE:
        return {name: math.exp(value) for name, value in zip(names, found, strict=True)}
    for name, value, low, high in zip(names, found, least, most, strict=True):
        if min(value - low, high - value) < _AT_END * (high - low):
            lower, upper = ranges[name]
            unit = UNKNOWNS[name].unit or "times the computed one"
            raise UsageError(
                f"no {name} from {lower:.3g} to {upper:.3g} {unit} gives {asked}; check the "
                "measured values and their units, or leave this row to prediction."
            )
    if len(names) == len(targets):
        nearest = ", ".join(
            f"{row} {value * math.exp(miss):.3g}"
            for (row, value), miss in zip(targets.items(), left, strict=True)
        )
        raise UsageError(
            f"no {', '.join(names)} give {asked} together; the nearest that was found is "
            f"{nearest}. Leave a row to prediction, or name other unknowns."
        )
    return {name: math.exp(value) for name, value in zip(names, found, strict=True)}
