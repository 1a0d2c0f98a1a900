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
    torque_capacity : float
        Torque at which `value` reaches `limit`, N*m.
    model : str
        What `value` and `torque_capacity` rest on.
    reached : bool
        False where the contact equilibrium ends at `torque_capacity`, before the limit.
    """

    part: str
    title: str
    load: LoadName
    torque: float
    value: float
    limit: float
    unit: str
    torque_capacity: float
    model: str = ""
    reached: bool = True

    def __post_init__(self) -> None:
        """Refuse what has no margin."""
        numbers = (self.torque, self.value, self.limit)
        if min(numbers) <= 0.0 or self.torque_capacity < 0.0:
            raise UsageError(
                f"cycloid limit '{self.part}, {self.title}': torque, value and limit must be "
                f"positive and the capacity not negative, not {self.torque:g}, {self.value:g}, "
                f"{self.limit:g}, {self.torque_capacity:g}."
            )

    @property
    def margin(self) -> float:
        """limit/value."""
        return self.limit / self.value

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
            "reached": self.reached,
        }


def binding_limit(limits: Sequence[CycloidLimit], load: LoadName) -> CycloidLimit | None:
    """The limit of this load reached at the least torque; None when there is none.

    Of limits at one torque that which is reached; the equilibrium may end there before others are.

    Examples
    --------
    >>> pins = CycloidLimit("output pins", "shear", "peak", 120.0, 49.0, 120.7, "MPa", 295.6)
    >>> ring = CycloidLimit("ring teeth", "pressure", "peak", 120.0, 1527.0, 1393.0, "MPa", 99.9)
    >>> binding_limit([pins, ring], "peak").part
    'ring teeth'
    """
    return min(
        (limit for limit in limits if limit.load == load),
        key=lambda limit: (limit.torque_capacity, not limit.reached),
        default=None,
    )
