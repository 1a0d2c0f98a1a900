"""The cycloid's side of the comparison, handed in as values: this room computes none of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from cqdd_design.errors import UsageError

LoadName = Literal["peak", "continuous"]


@dataclass(frozen=True)
class CycloidLimit:
    """One limit of a cycloid gearbox at one torque.

    Attributes
    ----------
    part : str
        What it is a limit of: ``output pins``, ``ring teeth``, ``cam bearing``, ...
    title : str
        What is compared ("bending, load sharing").
    load : {"peak", "continuous"}
    torque : float
        Output torque `value` was computed at, N*m.
    value, limit : float
        In `unit`, both positive; `value` may reach `limit`.
    torque_exponent : float
        `value` grows as torque to this power: 1 for forces and stresses, 0.5 for Hertz pressures of
        line contacts.
    model : str
        What `value` rests on.
    solved_capacity : float or None
        Torque at which a model that knows no such power reaches the limit, N*m.
    """

    part: str
    title: str
    load: LoadName
    torque: float
    value: float
    limit: float
    unit: str
    torque_exponent: float = 1.0
    model: str = "rigid law"
    solved_capacity: float | None = None

    def __post_init__(self) -> None:
        """Refuse what has no margin."""
        if min(self.torque, self.value, self.limit, self.torque_exponent) <= 0.0:
            raise UsageError(
                f"cycloid limit '{self.part}, {self.title}': torque, value, limit and exponent "
                f"must be positive, not {self.torque:g}, {self.value:g}, {self.limit:g}, "
                f"{self.torque_exponent:g}."
            )

    @property
    def margin(self) -> float:
        """limit/value."""
        return self.limit / self.value

    @property
    def torque_capacity(self) -> float:
        """Torque at which the limit is reached, N*m: margins of stress and pressure made equal."""
        if self.solved_capacity is not None:
            return self.solved_capacity
        return float(self.torque * self.margin ** (1.0 / self.torque_exponent))

    @property
    def holds(self) -> bool:
        """Whether the limit is kept at the load's torque."""
        return self.torque_capacity >= self.torque

    def to_dict(self) -> dict[str, object]:
        """The JSON form."""
        return {
            "part": self.part,
            "title": self.title,
            "load": self.load,
            "torque_Nm": self.torque,
            "value": self.value,
            "limit": self.limit,
            "unit": self.unit,
            "margin": self.margin,
            "model": self.model,
            "torque_capacity_Nm": self.torque_capacity,
        }


def binding_limit(limits: Sequence[CycloidLimit], load: LoadName) -> CycloidLimit | None:
    """The limit of this load reached at the least torque; None when there is none.

    Examples
    --------
    >>> pins = CycloidLimit("output pins", "shear", "peak", 120.0, 49.0, 120.7, "MPa")
    >>> ring = CycloidLimit("ring teeth", "pressure", "peak", 120.0, 1527.0, 1393.0, "MPa", 0.5)
    >>> binding_limit([pins, ring], "peak").part
    'ring teeth'
    """
    return min(
        (limit for limit in limits if limit.load == load),
        key=lambda limit: limit.torque_capacity,
        default=None,
    )
