"""Values that every room speaks: checks, mass properties, provenance."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Status = Literal["pass", "warn", "fail", "unknown"]


def read_only(values: NDArray[Any]) -> NDArray[Any]:
    """A view of an array that cannot be written: what a result holds stays as it was found."""
    seen = values.view()
    seen.flags.writeable = False
    return seen


@dataclass(frozen=True)
class Check:
    """One limit that a design meets or does not.

    Attributes
    ----------
    id : str
        Stable identifier such as ``CONTACT-RING-PEAK``; the argument of ``explain``.
    title : str
        A few words for tables.
    value, limit : float or None
        In `unit` (the unit shown to people, so pressures are in MPa), comparable as they stand;
        None where it is not known, which `substituted` explains.
    unit : str
        Unit of both; empty for pure numbers.
    sense : {"max", "min"}
        Whether `limit` is the most or the least allowed.
    formula, substituted : str
        The rule in symbols, and with this design's numbers.
    why, remedy : str
        Why it matters; what would make it pass, with a number where one can be computed.
    source : str
        Where rule and limit come from.
    severity : {"fail", "warn"}
        What a violated limit means. Only rules of thumb are warnings.
    basis : str
        The model that the value comes from.
    """

    id: str
    title: str
    value: float | None
    limit: float | None
    unit: str
    sense: Literal["max", "min"]
    formula: str
    substituted: str
    why: str
    remedy: str
    source: str
    severity: Literal["fail", "warn"] = "fail"
    basis: str = ""

    def __post_init__(self) -> None:
        """Refuse numbers that could not be compared."""
        if not all(math.isfinite(one) for one in (self.value, self.limit) if one is not None):
            raise ValueError(f"check {self.id} has a value that is not finite")

    @property
    def compared(self) -> tuple[float, float]:
        """Value and limit of a check that is known; both not numbers of one that is not."""
        if self.value is None or self.limit is None:
            return math.nan, math.nan
        return self.value, self.limit

    @property
    def known(self) -> bool:
        """Whether there is a value and a limit to compare it with."""
        return self.value is not None and self.limit is not None

    @property
    def margin(self) -> float:
        """How many times the limit is met: 1 is on the limit, below 1 it is violated.

        Not a number where it is not known.
        """
        value, limit = self.compared
        top, bottom = (limit, value) if self.sense == "max" else (value, limit)
        if bottom <= 0.0:
            return 1e6 if top >= bottom else 0.0
        return max(min(top / bottom, 1e6), -1e6) if self.known else math.nan

    @property
    def satisfied(self) -> bool:
        """Whether the limit is met, with a relative slack of 1e-9 for rounding; never unknown."""
        value, limit = self.compared
        slack = 1e-9 * max(abs(value), abs(limit))
        if self.sense == "max":
            return value <= limit + slack
        return value >= limit - slack

    @property
    def status(self) -> Status:
        """``pass``, ``warn``, ``fail``, or ``unknown``."""
        if not self.known:
            return "unknown"
        return "pass" if self.satisfied else self.severity

    def to_dict(self) -> dict[str, object]:
        """The JSON form; the first eight keys are a fixed interface."""
        keys = "id title value limit unit margin status source sense formula substituted why remedy"
        told = {key: getattr(self, key) for key in keys.split()}
        return told | {"margin": self.margin if self.known else None, "basis": self.basis}


def worst_status(checks: Iterable[Check]) -> Status:
    """``fail`` if any check fails, else ``unknown``, ``warn`` or ``pass``."""
    found = {check.status for check in checks}
    order: tuple[Status, ...] = ("fail", "unknown", "warn")
    return next((status for status in order if status in found), "pass")


@dataclass(frozen=True)
class MassProperties:
    """Mass, centre of mass and inertia about it; two bodies add with ``+``.

    Attributes
    ----------
    mass : float
        kg, not negative.
    centre : array (3,)
        Centre of mass in m, in the frame of the assembly.
    inertia : array (3, 3)
        Inertia tensor about the centre of mass, kg m^2, axes of the assembly.
    """

    mass: float
    centre: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))
    inertia: NDArray[np.float64] = field(default_factory=lambda: np.zeros((3, 3)))

    def __add__(self, other: MassProperties) -> MassProperties:
        """The two bodies as one rigid body (parallel-axis theorem)."""
        mass = self.mass + other.mass
        if mass == 0.0:
            return MassProperties(0.0)
        centre = (self.mass * self.centre + other.mass * other.centre) / mass
        inertia = self.inertia_about(centre) + other.inertia_about(centre)
        return MassProperties(mass, centre, inertia)

    def inertia_about(self, point: NDArray[np.float64]) -> NDArray[np.float64]:
        """Inertia tensor (3, 3) about `point` (3,) in m, kg m^2."""
        arm = self.centre - np.asarray(point, dtype=float)
        shift: NDArray[np.float64] = float(arm @ arm) * np.eye(3) - np.outer(arm, arm)
        return self.inertia + self.mass * shift

    def moved(
        self, translation: NDArray[np.float64], rotation: NDArray[np.float64] | None = None
    ) -> MassProperties:
        """The body after rotating by `rotation` (3, 3) about the origin, then translating (3,)."""
        turn = np.eye(3) if rotation is None else np.asarray(rotation, dtype=float)
        return MassProperties(
            self.mass,
            turn @ self.centre + np.asarray(translation, dtype=float),
            turn @ self.inertia @ turn.T,
        )


@dataclass(frozen=True)
class Provenance:
    """What made a result: package version, time, and the hash of the resolved design."""

    version: str
    time: str
    design_sha256: str

    def to_dict(self) -> dict[str, str]:
        """The JSON form."""
        return dict(vars(self))
