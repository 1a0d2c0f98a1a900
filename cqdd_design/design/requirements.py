"""What the user asks for: ratio, torque, speed and the space there is."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Self

from pydantic import (
    Field,
    ModelWrapValidatorHandler,
    PrivateAttr,
    ValidationInfo,
    model_validator,
)

from cqdd_design.design.fields import (
    FreeText,
    FrozenModel,
    MaterialName,
    MotorName,
    Share,
    Whole,
    default,
)
from cqdd_design.errors import DesignError
from cqdd_design.units import (
    CURRENT,
    DURATION,
    FORCE,
    INERTIA,
    LENGTH,
    LOAD_SPEED,
    MASS,
    SMALL_ANGLE,
    SPEED,
    STIFFNESS,
    TEMPERATURE,
    TORQUE,
    VOLTAGE,
    QuantityIn,
    format_quantity,
    read_quantity,
    real_number,
    whole_number,
)

if TYPE_CHECKING:
    from cqdd_design.design.duty_log import DutyLog

LEAST_RATIO, MOST_RATIO = 4, 119
LEAST_TORQUE, LEAST_LASTING, MOST_TORQUE = 1e-3, 1e-4, 1e5
"""Peak torques that are worked with, N m."""

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
#: Default life at the continuous torque or over the duty.
DEFAULT_LIFE = "1000 h"
#: Default share of toleranced gearboxes that meet every requirement.
DEFAULT_YIELD = 0.95
#: Seconds.
HOUR = 3600.0
_ROUNDING = 1.0 + 1e-12


class DutyPoint(FrozenModel):
    """One step of a duty cycle, at the output."""

    torque: Annotated[
        float, QuantityIn(TORQUE, "-100000 N*m", "100000 N*m", "a robot joint, not a mill")
    ]
    speed: Annotated[
        float, QuantityIn(LOAD_SPEED, "-10000 rad/s", "10000 rad/s", "the output of a reducer")
    ]
    share: Annotated[float, Share(0.0, 1.0, "a share of the time")]


class DutyColumnNames(FrozenModel):
    """Columns of the duty's file, where their headings are not the usual ones.

    Each as in the file; a unit in brackets after it where the heading has none.
    """

    time: FreeText | None = None
    torque: FreeText | None = None
    speed: FreeText | None = None


_Angle = Annotated[
    float, QuantityIn(SMALL_ANGLE, "0.01 arcmin", "600 arcmin", "play of a gear train")
]

EXTERNAL_LOADS = {"external_moment": "N*m", "external_axial": "N", "external_radial": "N"}
"""Requirements of what pushes the output from outside, and the units that they are told in."""


class Requirements(FrozenModel):
    """The requirements a gearbox is sized for and checked against.

    Only `ratio` has no default. Torques are at the output, speed at the input. What is None is not
    asked for: it is not judged, and not written to files.

    Examples
    --------
    >>> from cqdd_design import Requirements
    >>> asked = Requirements(ratio=10, peak_torque="30 N*m", backlash="6 arcmin")
    >>> asked.peak_torque, round(asked.backlash, 6), asked.stiffness  # N m, rad
    (30.0, 0.001745, None)
    """

    ratio: Ratio
    peak_torque: Annotated[
        float,
        QuantityIn(
            TORQUE, f"{LEAST_TORQUE:g} N*m", f"{MOST_TORQUE:.0f} N*m", "a robot joint, not a mill"
        ),
    ]
    continuous_torque: Annotated[
        float,
        QuantityIn(
            TORQUE, f"{LEAST_LASTING:g} N*m", f"{MOST_TORQUE:.0f} N*m", "a robot joint, not a mill"
        ),
    ]
    input_speed: Annotated[
        float, QuantityIn(SPEED, "1 rpm", "30000 rpm", "greased eccentric bearings")
    ] = default(DEFAULT_INPUT_SPEED)
    #: Of the input, at which the continuous torque is held for ever; None: the input speed.
    continuous_speed: (
        Annotated[float, QuantityIn(SPEED, "1 rpm", "30000 rpm", "greased eccentric bearings")]
        | None
    ) = None
    #: Of the output, up to which the peak torque is reached; None: at a standstill.
    speed_at_peak: (
        Annotated[float, QuantityIn(LOAD_SPEED, "0 rad/s", "1000 rad/s", "the output of a reducer")]
        | None
    ) = None
    life: Annotated[
        float, QuantityIn(DURATION, "1 h", "100000 h", "eleven years without a stop")
    ] = default(DEFAULT_LIFE)
    duty: tuple[DutyPoint, ...] = ()
    #: Of a duty over time, from the design file's folder.
    duty_file: FreeText | None = None
    duty_columns: DutyColumnNames | None = None
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
    #: Diameter that cables or a shaft need through the middle.
    bore: Annotated[float, QuantityIn(LENGTH, "0.5 mm", "500 mm", "cables or a shaft")] | None = (
        None
    )
    #: Of the whole actuator.
    mass: (
        Annotated[float, QuantityIn(MASS, "0.01 kg", "1000 kg", "a joint that a robot carries")]
        | None
    ) = None
    #: At the output, of everything that turns.
    reflected_inertia: (
        Annotated[
            float, QuantityIn(INERTIA, "1e-7 kg*m^2", "10000 kg*m^2", "rotor times ratio squared")
        ]
        | None
    ) = None
    #: At most, of the output with the input held; of the toleranced gearboxes 95 % have less.
    backlash: _Angle | None = None
    #: At most, at 3 % of the continuous torque to either side.
    lost_motion: _Angle | None = None
    #: At least, of the output with the input held.
    stiffness: (
        Annotated[
            float, QuantityIn(STIFFNESS, "1 N*m/rad", "100000000 N*m/rad", "a joint with teeth")
        ]
        | None
    ) = None
    #: At least, of the gearbox that drives, at the continuous torque or over the duty.
    efficiency: Annotated[float, Share(0.01, 0.999, "what leaves over what enters")] | None = None
    #: At most, of the housing outside.
    surface_temperature: (
        Annotated[
            float, QuantityIn(TEMPERATURE, "0 degC", "200 degC", "what is touched or stands beside")
        ]
        | None
    ) = None
    #: On the output from outside, any direction: what tilts it, along its axis and across it.
    external_moment: (
        Annotated[float, QuantityIn(TORQUE, "0 N*m", "100000 N*m", "what hangs on the output")]
        | None
    ) = None
    external_axial: (
        Annotated[float, QuantityIn(FORCE, "0 N", "1000000 N", "what hangs on the output")] | None
    ) = None
    external_radial: (
        Annotated[float, QuantityIn(FORCE, "0 N", "1000000 N", "what hangs on the output")] | None
    ) = None
    #: Of the supply there is.
    voltage: (
        Annotated[float, QuantityIn(VOLTAGE, "1 V", "1000 V", "supply of the driver")] | None
    ) = None
    #: At most, of the motor.
    current: (
        Annotated[float, QuantityIn(CURRENT, "0.01 A", "2000 A", "limit of the driver")] | None
    ) = None
    #: Share of toleranced gearboxes that meet every requirement; ``yield`` in files.
    yield_share: Annotated[float, Share(0.01, 1.0, "a share of the gearboxes made")] = Field(
        default=DEFAULT_YIELD, alias="yield"
    )
    motor: MotorName = "CubeMars RO100 KV55"
    disc_count: DiscCount = 2
    disc_material: MaterialName = "AISI 4140 Q&T 540C"
    ring_material: MaterialName = "AISI 4140 Q&T 540C"
    pin_material: MaterialName = "Alloy steel 12.9 (ISO 7379)"

    if TYPE_CHECKING:  # what is an attribute's float is given with its unit

        def __init__(self, **keys: Any) -> None: ...

    _duty_log: DutyLog | None = PrivateAttr(default=None)
    _derived: frozenset[str] = PrivateAttr(default=frozenset())

    @model_validator(mode="wrap")
    @classmethod
    def _derive_torques(
        cls, data: Any, made: ModelWrapValidatorHandler[Self], info: ValidationInfo
    ) -> Self:
        """Fill in the torques that follow from the ratio when they are not given."""
        if not isinstance(data, dict):
            return made(data)
        filled = dict(data)
        ratio = filled.get("ratio")
        if (
            "peak_torque" not in filled
            and (lobes := whole_number(ratio)) is not None
            and LEAST_RATIO <= lobes <= MOST_RATIO
        ):
            peak = min(DEFAULT_PEAK_PER_RATIO * lobes, DEFAULT_PEAK_MOST)
            filled["peak_torque"] = format_quantity(peak, TORQUE)
        if "peak_torque" in filled and "continuous_torque" not in filled:
            si = info.context is not None and bool(info.context.get("si"))
            lasting = _share_of(filled["peak_torque"], DEFAULT_CONTINUOUS_SHARE, si=si)
            if lasting is not None:
                filled["continuous_torque"] = lasting
        whole = made(filled)
        whole._derived = frozenset(filled) - frozenset(data)
        return whole

    @property
    def derived(self) -> frozenset[str]:
        """Torques that were not stated and follow from the ratio."""
        return self._derived

    def deriving(self, *torques: str) -> Requirements:
        """The same, with torques that count as not stated and may be lowered."""
        free = self.model_copy()
        free.model_fields_set.difference_update(torques)
        free._derived = frozenset(torques)
        return free

    @property
    def held_speed(self) -> float:
        """Input speed at which the continuous torque is held for ever, rad/s."""
        return self.input_speed if self.continuous_speed is None else self.continuous_speed

    @property
    def duty_log(self) -> DutyLog | None:
        """What the duty's file says; None without one.

        Raises
        ------
        DesignError
            Where a file is named that has not been read, as `load_design` does.
        """
        if self.duty_file is not None and self._duty_log is None:
            raise DesignError(
                f"requirements.duty_file '{self.duty_file}' has not been read: load the design "
                "from its file, or attach its duty."
            )
        return self._duty_log

    @property
    def load_cases(self) -> tuple[DutyPoint, ...]:
        """The steps of the duty, as stated or from its file; none without a duty."""
        log = self.duty_log
        if log is None:
            return self.duty
        from cqdd_design.design.duty_spectrum import load_cases

        return tuple(DutyPoint.model_construct(**case._asdict()) for case in load_cases(log))

    @property
    def lasting_torque(self) -> float:
        """Greatest size of a torque of the duty, or without one the continuous torque, N m."""
        cases = self.load_cases
        return max((abs(one.torque) for one in cases), default=self.continuous_torque)

    @property
    def fastest_speed(self) -> float:
        """Greatest speed of the input: that which is stated, or a duty's, rad/s."""
        duty = max((abs(one.speed) for one in self.load_cases), default=0.0)
        return max(self.input_speed, self.ratio * duty)

    @property
    def equal_speed(self) -> float:
        """Mean input speed of a duty with its rest, or that of the continuous torque, rad/s."""
        cases = self.load_cases
        if not cases:
            return self.held_speed
        return self.ratio * sum(one.share * abs(one.speed) for one in cases)

    @property
    def equal_torque(self) -> float:
        """The torque that stands for a duty, or without one the continuous torque, N m.

        Of torques at their turns the mean by cubes, by which ball bearings last; of a duty that
        only stands, the greatest; of one without any torque, the continuous torque.
        """
        cases = self.load_cases
        turns = sum(one.share * abs(one.speed) for one in cases)
        cubes = sum(one.share * abs(one.speed) * abs(one.torque) ** 3 for one in cases)
        mean = float((cubes / turns) ** (1.0 / 3.0)) if turns else 0.0
        return mean or self.lasting_torque or self.continuous_torque

    def with_duty_log(self, log: DutyLog | None) -> Requirements:
        """The same requirements with what their duty's file says."""
        changed = self.model_copy()
        changed._duty_log = log
        return changed

    @property
    def life_hours(self) -> float:
        """Required life, h."""
        return self.life / HOUR

    @model_validator(mode="after")
    def _without_contradiction(self) -> Requirements:
        if self.continuous_torque > self.peak_torque * _ROUNDING:
            raise ValueError(
                f"continuous_torque {format_quantity(self.continuous_torque, TORQUE)} is above "
                f"peak_torque {format_quantity(self.peak_torque, TORQUE)}; "
                "lower it or raise peak_torque"
            )
        fastest = format_quantity(self.input_speed, SPEED)
        if self.held_speed > self.input_speed * _ROUNDING:
            raise ValueError(
                f"continuous_speed {format_quantity(self.held_speed, SPEED)} is above input_speed "
                f"{fastest}, the fastest that is asked for; lower it or raise input_speed"
            )
        peak_speed = (self.speed_at_peak or 0.0) * self.ratio
        if peak_speed > self.input_speed * _ROUNDING:
            raise ValueError(
                f"speed_at_peak {format_quantity(peak_speed / self.ratio, LOAD_SPEED)} turns the "
                f"input at {peak_speed / SPEED.si_factor:.5g} rpm, above input_speed {fastest}; "
                "lower it or raise input_speed"
            )
        if self.bore is not None and self.bore >= self.outer_diameter:
            raise ValueError(
                f"bore {format_quantity(self.bore, LENGTH)} is not within outer_diameter "
                f"{format_quantity(self.outer_diameter, LENGTH)}; lower it or raise outer_diameter"
            )
        if self.duty_file is not None and self.duty:
            raise ValueError("duty and duty_file are both given; keep one of them")
        if self.duty_columns is not None and self.duty_file is None:
            raise ValueError("duty_columns belong to a duty_file, and there is none; name it")
        if self.duty and not any(point.torque or point.speed for point in self.duty):
            raise ValueError(
                "torque and speed are 0 in every step of duty, which is rest alone; give steps of "
                "what the joint does, or leave duty out"
            )
        total = sum(point.share for point in self.duty)
        if total > 1.0 + 1e-6:
            raise ValueError(
                f"the shares of duty add up to {total:g}, more than all of the time; lower them "
                "to 1 or less: what is missing is rest"
            )
        return self


def _share_of(peak: Any, share: float, *, si: bool) -> str | float | None:
    """A share of a peak torque, a quantity or an SI float, as that is written.

    None where the peak torque will be refused: what follows from it would be refused as well.
    """
    bare = real_number(peak) if si else None
    try:
        whole = read_quantity(peak, TORQUE) if bare is None else bare
    except DesignError:
        return None
    if not LEAST_TORQUE / _ROUNDING <= whole <= MOST_TORQUE * _ROUNDING:
        return None
    return format_quantity(share * whole, TORQUE) if bare is None else share * bare
