"""The tables of a design file around reducer and motor: drive, housing, surroundings and more."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import model_validator

from cqdd_design.design.fields import FrozenModel, MaterialName, Whole, default
from cqdd_design.units import (
    BANDWIDTH,
    DAMPING_GAIN,
    LENGTH,
    SMALL_LENGTH,
    STIFFNESS_GAIN,
    TEMPERATURE,
    THERMAL_RESISTANCE,
    QuantityIn,
    format_quantity,
)


class Drive(FrozenModel):
    """Drive electronics and the joint controller."""

    current_bandwidth: Annotated[float, QuantityIn(BANDWIDTH, "1 Hz", "1 MHz", "current loop")] = (
        default("1 kHz")
    )
    control_rate: Annotated[float, QuantityIn(BANDWIDTH, "1 Hz", "1 MHz", "joint controller")] = (
        default("1 kHz")
    )
    encoder_bits: Annotated[int, Whole(4, 32, "on the motor shaft")] = 14
    position_gain: Annotated[
        float,
        QuantityIn(STIFFNESS_GAIN, "0 N*m/rad", "1000000 N*m/rad", "impedance at the output"),
    ] = default("60 N*m/rad")
    velocity_gain: Annotated[
        float,
        QuantityIn(DAMPING_GAIN, "0 N*m*s/rad", "100000 N*m*s/rad", "impedance at the output"),
    ] = default("2 N*m*s/rad")
    thermal_resistance: Annotated[
        float,
        QuantityIn(
            THERMAL_RESISTANCE, "0 K/W", "1000 K/W", "winding to ambient; 0: of the drawn parts"
        ),
    ] = default("0 K/W")


class Housing(FrozenModel):
    """The housing."""

    material: MaterialName = "7075-T6"


class Environment(FrozenModel):
    """Where the actuator works: temperature of the still air, and the coldest it starts at."""

    ambient: Annotated[
        float, QuantityIn(TEMPERATURE, "-60 degC", "90 degC", "air round a robot's joint")
    ] = default("25 degC")
    coldest: Annotated[
        float, QuantityIn(TEMPERATURE, "-60 degC", "90 degC", "all parts before a cold start")
    ] = default("-10 degC")

    @model_validator(mode="after")
    def _coldest_first(self) -> Environment:
        if self.coldest > self.ambient:
            if "coldest" not in self.model_fields_set:
                return self.unchecked_copy({"coldest": self.ambient})
            raise ValueError(
                f"coldest {format_quantity(self.coldest, TEMPERATURE)} is above ambient "
                f"{format_quantity(self.ambient, TEMPERATURE)}; lower it, or raise ambient"
            )
        return self


_Deviation = Annotated[float, QuantityIn(SMALL_LENGTH, "0 um", "1000 um", "a standard deviation")]


ZONE_OF_CIRCLE = 4.0
"""Diameter of a circle over the standard deviation, along any direction, of a place that is
anywhere in it alike."""


class Tolerances(FrozenModel):
    """Manufacturing tolerances as standard deviations, and how they scatter.

    Positions count per axis. `disc_profile` is the error along the normal at any point of the
    profile, `eccentricity` the error of every cam's centre along and across its crank (throw and
    phase), the diameters are those of holes and pins, `bearing_clearance` is that of the play.
    With `distribution = "uniform"` every error is even over the zone that has this standard
    deviation, 1.73 of it to either side. `output_position`, of the carrier's axis against the
    ring's, is what the output is centred to at assembly: the axis lies anywhere in a circle of
    four of them in diameter alike, whatever the distribution, and never outside it.
    """

    distribution: Literal["normal", "uniform"] = "normal"
    tooth_position: _Deviation = default("2 um")
    tooth_radius: _Deviation = default("1 um")
    disc_profile: _Deviation = default("1 um")
    hole_position: _Deviation = default("3 um")
    hole_diameter: _Deviation = default("1 um")
    pin_position: _Deviation = default("3 um")
    pin_diameter: _Deviation = default("9 um")
    eccentricity: _Deviation = default("2 um")
    bearing_clearance: _Deviation = default("2 um")
    output_position: _Deviation = default("5 um")

    @property
    def output_zone(self) -> float:
        """Diameter of the zone of the output's axis about the ring's, m."""
        return ZONE_OF_CIRCLE * self.output_position


THINNEST_WIRE = "0.02 mm"


class Edm(FrozenModel):
    """Wire EDM: the wire, its gap, and how closely files follow the exact curve."""

    wire_diameter: Annotated[
        float, QuantityIn(LENGTH, THINNEST_WIRE, "0.5 mm", "wires made for EDM")
    ] = default("0.25 mm")
    spark_gap: Annotated[
        float, QuantityIn(SMALL_LENGTH, "0 um", "200 um", "gap between wire and work")
    ] = default("12 um")
    profile_tolerance: Annotated[
        float,
        QuantityIn(SMALL_LENGTH, "0.05 um", "50 um", "of the file against the exact curve"),
    ] = default("0.5 um")

    @property
    def wire_offset(self) -> float:
        """From a contour to the wire's centre on the finishing cut, m: its radius and the gap.

        No concave arc of less than this radius can be cut.
        """
        return 0.5 * self.wire_diameter + self.spark_gap
