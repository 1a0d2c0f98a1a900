"""What the user asks for: ratio, torque, speed and the space there is."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import model_validator

from cqdd_design.design.fields import (
    FrozenModel,
    MaterialName,
    MotorName,
    Share,
    Whole,
    default,
)
from cqdd_design.units import LENGTH, LOAD_SPEED, SPEED, TORQUE, QuantityIn, format_quantity

LEAST_RATIO, MOST_RATIO = 4, 119

Ratio = Annotated[
    int, Whole(LEAST_RATIO, MOST_RATIO, "the ratio is the number of lobes of one disc")
]
DiscCount = Annotated[int, Whole(1, 3, "discs share one eccentric shaft")]

#: Default peak torque: min(9 N*m x ratio, 90 N*m), what a 72 mm ring with catalogue ball
#: bearings carries.
DEFAULT_PEAK_PER_RATIO = 9.0
DEFAULT_PEAK_MOST = 90.0
#: Default continuous torque as a share of the peak.
DEFAULT_CONTINUOUS_SHARE = 0.38
#: No-load speed of the paper's motor on 24 V, measured through its gearbox, rpm.
DEFAULT_INPUT_SPEED = "1286 rpm"


class DutyPoint(FrozenModel):
    """One step of a duty cycle, at the output."""

    torque: Annotated[
        float, QuantityIn(TORQUE, "-100000 N*m", "100000 N*m", "a robot joint, not a mill")
    ]
    speed: Annotated[
        float, QuantityIn(LOAD_SPEED, "-10000 rad/s", "10000 rad/s", "the output of a reducer")
    ]
    share: Annotated[float, Share(0.0, 1.0, "a share of the time")]


class Requirements(FrozenModel):
    """The requirements a gearbox is sized for and checked against.

    Only `ratio` has no default. Torques are at the output, speed at the input.
    """

    ratio: Ratio
    peak_torque: Annotated[
        float, QuantityIn(TORQUE, "0.001 N*m", "100000 N*m", "a robot joint, not a mill")
    ]
    continuous_torque: Annotated[
        float, QuantityIn(TORQUE, "0.0001 N*m", "100000 N*m", "a robot joint, not a mill")
    ]
    input_speed: Annotated[
        float, QuantityIn(SPEED, "1 rpm", "30000 rpm", "greased eccentric bearings")
    ] = default(DEFAULT_INPUT_SPEED)
    duty: tuple[DutyPoint, ...] = ()
    #: Of the output when it meets a rigid stop, beside the rated speed; 0 asks for none.
    shock_speed: Annotated[
        float, QuantityIn(LOAD_SPEED, "0 rad/s", "1000 rad/s", "the output of a reducer")
    ] = default("0 rad/s")
    outer_diameter: Annotated[
        float, QuantityIn(LENGTH, "10 mm", "1000 mm", "outside diameter of the ring")
    ] = default("72 mm")
    length: Annotated[
        float, QuantityIn(LENGTH, "3 mm", "500 mm", "length of the pack of discs")
    ] = default("20 mm")
    motor: MotorName = "CubeMars RO100 KV55"
    disc_count: DiscCount = 2
    disc_material: MaterialName = "AISI 4140 Q&T 540C"
    ring_material: MaterialName = "AISI 4140 Q&T 540C"
    pin_material: MaterialName = "Alloy steel 12.9 (ISO 7379)"

    @model_validator(mode="before")
    @classmethod
    def _derive_torques(cls, data: Any) -> Any:
        """Fill in the torques that follow from the ratio when they are not given."""
        if not isinstance(data, dict):
            return data
        filled = dict(data)
        ratio = filled.get("ratio")
        if (
            "peak_torque" not in filled
            and isinstance(ratio, (int, float))
            and LEAST_RATIO <= ratio <= MOST_RATIO
        ):
            peak = min(DEFAULT_PEAK_PER_RATIO * ratio, DEFAULT_PEAK_MOST)
            filled["peak_torque"] = format_quantity(peak, TORQUE)
        if "peak_torque" in filled and "continuous_torque" not in filled:
            filled["continuous_torque"] = _share_of(filled["peak_torque"], DEFAULT_CONTINUOUS_SHARE)
        return filled

    @model_validator(mode="after")
    def _continuous_within_peak(self) -> Requirements:
        if self.continuous_torque > self.peak_torque * (1.0 + 1e-12):
            raise ValueError(
                f"continuous_torque {format_quantity(self.continuous_torque, TORQUE)} is above "
                f"peak_torque {format_quantity(self.peak_torque, TORQUE)}; "
                "lower it or raise peak_torque"
            )
        total = sum(point.share for point in self.duty)
        if self.duty and abs(total - 1.0) > 1e-6:
            raise ValueError(f"the shares of duty add up to {total:g}; they must add up to 1")
        return self


def _share_of(torque: Any, share: float) -> Any:
    """A share of a torque that may still be a unit string; unreadable text is passed on as is."""
    from cqdd_design.errors import DesignError
    from cqdd_design.units import parse_quantity

    if isinstance(torque, str):
        try:
            return format_quantity(share * parse_quantity(torque, TORQUE), TORQUE)
        except DesignError:
            return torque
    return share * torque if isinstance(torque, (int, float)) else torque
