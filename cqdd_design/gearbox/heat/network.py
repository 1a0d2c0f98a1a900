"""Bodies of one temperature each, joined by conductances: steady and transient temperatures.

    C_i dT_i/dt = P_i + sum_j G_ij (T_j - T_i) + G_i,air(T_i) (T_air - T_i)

Surfaces in air conduct the better the warmer they are; at every step they are taken as they are at
its beginning, and between updates the solution is exact. Heat of a winding grows with its
temperature up to a limit, beyond which it stays: what burns has no use for a runaway.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.errors import DesignError
from cqdd_design.gearbox.heat.surfaces import Surface, outside_conductance
from cqdd_design.geometry.contours import FloatArray

_ROUNDS, _STILL = 200, 1e-12
_FIRST_RISE, _LONGEST_STEP, _NUDGE = 100.0, 100.0, 1e-2
"""Where the search for steady temperatures starts, its longest step, and that of slopes, K."""
_STEP_SHARE = 0.05
"""Longest step of a transient over the time that has passed, and over the quickest whole answer."""


class Heat(NamedTuple):
    """Heat in the nodes, W.

    Attributes
    ----------
    fixed : array (N,)
        W.
    slope : array (N,)
        What it grows by, W/K, from 0 deg C on.
    most : array (N,)
        Temperature above which it grows no more, deg C.
    """

    fixed: FloatArray
    slope: FloatArray
    most: FloatArray

    @classmethod
    def constant(cls, watts: ArrayLike) -> Heat:
        """Heat that no temperature changes."""
        fixed = np.asarray(watts, dtype=float)
        return cls(fixed, np.zeros(fixed.shape), np.full(fixed.shape, np.inf))

    def at(self, temperature: FloatArray) -> FloatArray:
        """W at temperatures (N,), deg C."""
        return np.asarray(self.fixed + self.slope * np.minimum(temperature, self.most))


@dataclass(frozen=True, eq=False)
class ThermalNetwork:
    """Nodes and what joins them.

    Attributes
    ----------
    names : tuple of str
        N of them.
    capacity : array (N,)
        J/K.
    conductance : array (N, N)
        Between nodes, symmetric, W/K.
    to_ambient : array (N,)
        To the air but by `surfaces`, W/K.
    surfaces : tuple of Surface
        In the air.
    cooling : float
        Factor on what `surfaces` give off.
    ambient : float
        deg C.
    """

    names: tuple[str, ...]
    capacity: FloatArray
    conductance: FloatArray
    to_ambient: FloatArray
    ambient: float
    surfaces: tuple[Surface, ...] = ()
    cooling: float = 1.0

    def __post_init__(self) -> None:
        """Refuse what no bodies are."""
        G = self.conductance
        if not (np.all(self.capacity > 0.0) and np.all(G >= 0.0) and np.allclose(G, G.T)):
            raise DesignError(
                "a thermal network needs capacities above zero, and conductances that are the same "
                "both ways and not negative."
            )
        if not (np.any(self.to_ambient > 0.0) or self.surfaces):
            raise DesignError("a thermal network without a way to the air has no steady state.")

    def outward(self, temperature: FloatArray) -> FloatArray:
        """Conductance of every node to the air at temperatures (N,), W/K."""
        found = self.to_ambient.astype(float)
        for one in self.surfaces:
            here = outside_conductance(one, float(temperature[one.node]), self.ambient)
            found[one.node] += self.cooling * here
        return found

    def matrix(self, outward: FloatArray) -> FloatArray:
        """Heat that leaves every node by rises of all, (N, N), W/K."""
        return np.diag(self.conductance.sum(axis=1) + outward) - self.conductance

    def steady(self, heat: Heat) -> FloatArray:
        """Temperatures (N,) that heat ends at, deg C.

        Raises
        ------
        DesignError
            Where they do not settle.
        """
        now = np.full(len(self.names), self.ambient + _FIRST_RISE)
        for _ in range(_ROUNDS):
            growing = np.where(now < heat.most, heat.slope, 0.0)
            left = heat.at(now) - self.matrix(self.outward(now)) @ (now - self.ambient)
            slope = self.matrix(self._tangent(now)) - np.diag(growing)
            step = np.linalg.solve(slope, left)
            largest = np.abs(step).max()
            now = now + step * min(1.0, _LONGEST_STEP / max(largest, 1e-300))
            if largest <= _STILL * (np.abs(now).max() + 1.0):
                return np.asarray(now)
        raise DesignError("the thermal network finds no steady temperatures.")

    def _tangent(self, temperature: FloatArray) -> FloatArray:
        """What heat to the air grows by with every node's temperature, (N,), W/K."""
        found = self.to_ambient.astype(float)
        for one in self.surfaces:
            at = float(temperature[one.node])
            ahead, behind = (
                outside_conductance(one, t, self.ambient) * (t - self.ambient)
                for t in (at + _NUDGE, at - _NUDGE)
            )
            found[one.node] += self.cooling * (ahead - behind) / (2.0 * _NUDGE)
        return found

    def given_off(self, temperature: FloatArray) -> float:
        """Heat to the air at temperatures (N,), W."""
        return float(self.outward(temperature) @ (temperature - self.ambient))

    def history(self, heat: Heat, times: ArrayLike, start: ArrayLike | None = None) -> FloatArray:
        """Temperatures (T, N), deg C, after rising times (T,), s, under heat that stays on.

        Parameters
        ----------
        start : array_like, optional
            Of all nodes, or of every one, deg C; default the air's.
        """
        now = np.broadcast_to(
            np.asarray(self.ambient if start is None else start, dtype=float), len(self.names)
        ).copy()
        found, before = [], 0.0
        for end in np.atleast_1d(np.asarray(times, dtype=float)):
            while end - before > 1e-12 * max(end, 1.0):
                kept, fixed = self._linear(heat, now)
                rates, modes = modes_of(kept, self.capacity)
                step = end - before
                if self.surfaces or np.any(heat.slope):
                    step = min(step, max(_STEP_SHARE * before, _STEP_SHARE / rates.max()))
                now = self.ambient + _stepped(
                    rates, modes, self.capacity, now - self.ambient, fixed, step
                )
                before += step
            found.append(now)
        return np.array(found)

    def _linear(self, heat: Heat, now: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Matrix and heat over rises, with surfaces and growth as they are now."""
        growing = np.where(now < heat.most, heat.slope, 0.0)
        kept = self.matrix(self.outward(now)) - np.diag(growing)
        return kept, heat.at(now) - growing * (now - self.ambient)

    def resistances(self, node: int, temperature: FloatArray) -> FloatArray:
        """Rise of every node by a watt in one, (N,), K/W, with surfaces as at temperatures (N,)."""
        unit = np.zeros(len(self.names))
        unit[node] = 1.0
        return np.asarray(np.linalg.solve(self.matrix(self.outward(temperature)), unit))

    def rates(self, temperature: FloatArray) -> FloatArray:
        """Rates (N,) at which differences die away, surfaces as at temperatures (N,), 1/s."""
        return modes_of(self.matrix(self.outward(temperature)), self.capacity)[0]


def modes_of(kept: FloatArray, capacity: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Rates (N,), 1/s, and modes (N, N) of the symmetric form C^-1/2 K C^-1/2."""
    root = np.sqrt(capacity)
    rates, modes = np.linalg.eigh(kept / np.outer(root, root))
    return np.asarray(rates), np.asarray(modes)


def _stepped(
    rates: FloatArray,
    modes: FloatArray,
    capacity: FloatArray,
    rise: FloatArray,
    heat: FloatArray,
    step: float,
) -> FloatArray:
    """Rises after a step: exp(-A t) of those before and what heat adds, exactly."""
    root = np.sqrt(capacity)
    own, fed = modes.T @ (root * rise), modes.T @ (heat / root)
    exponent = rates * step
    safe = np.where(rates == 0.0, 1.0, rates)
    gained = np.where(rates == 0.0, step, -np.expm1(-exponent) / safe)
    return np.asarray(modes @ (own * np.exp(-exponent) + fed * gained) / root)
