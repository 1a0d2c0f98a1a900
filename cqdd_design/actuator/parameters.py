"""What describes an actuator in time: frozen values, SI units, one sign convention.

Conventions, once and for all:

- The motor is its power-equivalent DC machine: ``v = R i + L di/dt + K w`` and ``tau = K i`` with
  one K in N m/A = V s/rad, R and L line to line (six-step currents). `motor_constants` converts to
  and from line and phase, peak and r.m.s. values.
- The motor angle theta counts with the crank. The output stands at ``N' theta + eps(theta)`` with
  N' = 1/ratio and ratio = -n for a fixed ring: positive motion of the motor is negative motion of
  the output.
- Torque ``gear_torque`` acts on the output, positive counter-clockwise, like the output's angle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from cqdd_design.actuator.fitted_under import FittedUnder
from cqdd_design.actuator.rig import SENSOR_TWIST, RigParameters
from cqdd_design.catalog.motors import WINDING_MOST
from cqdd_design.errors import DesignError

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_NO_LOOK = 0.1
"""Of the mean stiffness: where harmonics leave more in any case, their sum is not looked at."""


def _refuse(table: str, key: str, value: float, wanted: str, fix: str) -> None:
    raise DesignError(f"{table}.{key} {value:g} is not {wanted}; {fix}.")


def _positive(owner: object, table: str, **fixes: str) -> None:
    for key, fix in fixes.items():
        value = getattr(owner, key)
        if not (math.isfinite(value) and value > 0.0):
            _refuse(table, key, value, "above zero", fix)


def _not_negative(owner: object, table: str, *keys: str) -> None:
    for key in keys:
        value = getattr(owner, key)
        if not (math.isfinite(value) and value >= 0.0):
            _refuse(table, key, value, "zero or more", "use 0 to leave it out")


@dataclass(frozen=True)
class MotorParameters:
    """The motor as a DC machine.

    Attributes
    ----------
    torque_constant : float
        K, N m/A and V s/rad.
    resistance, inductance : float
        Line to line at `reference_temperature`, ohm and H.
    rotor_inertia : float
        Of the motor's own rotor, the cup of an outrunner included, kg m^2.
    rated_torque, peak_torque : float
        Of the motor by its catalogue, N m; nan where it gives none.
    cogging_amplitude, cogging_order : float, int
        N m, and periods in a turn of the motor.
    iron_loss : float
        Drag torque over speed from eddy currents, N m s/rad.
    hysteresis : float
        Drag torque from hysteresis, N m.
    reference_temperature : float
        deg C.
    coulomb, viscous : float
        What else drags on the motor alone, N m and N m s/rad at its shaft: its bearings, and where
        it was measured as a whole its iron too. The gearbox's own friction is in
        :class:`FrictionParameters`.
    """

    torque_constant: float
    resistance: float
    inductance: float
    rotor_inertia: float
    pole_pairs: int
    rated_torque: float
    peak_torque: float
    cogging_amplitude: float = 0.0
    cogging_order: int = 1
    iron_loss: float = 0.0
    hysteresis: float = 0.0
    reference_temperature: float = 25.0
    coulomb: float = 0.0
    viscous: float = 0.0

    def __post_init__(self) -> None:
        """Refuse a motor that cannot exist."""
        _positive(
            self,
            "motor",
            torque_constant="1/KV in SI, 9.549/KV with KV in rpm/V",
            resistance="measure it from line to line",
        )
        names = ("inductance", "rotor_inertia", "cogging_amplitude", "iron_loss", "hysteresis")
        _not_negative(self, "motor", *names, "coulomb", "viscous")
        for key in ("pole_pairs", "cogging_order"):
            if getattr(self, key) < 1:
                _refuse("motor", key, getattr(self, key), "1 or more", "count pairs or periods")

    @property
    def peak_current(self) -> float:
        """Of its own peak torque, A; infinite where its catalogue gives none."""
        if math.isfinite(self.peak_torque):
            return self.peak_torque / self.torque_constant
        return math.inf

    @property
    def dry_drag(self) -> float:
        """Drag torque of the motor alone that does not depend on speed, N m."""
        return self.coulomb + self.hysteresis

    @property
    def drag_slope(self) -> float:
        """Drag torque of the motor alone over speed, N m s/rad."""
        return self.viscous + self.iron_loss


@dataclass(frozen=True)
class DriveParameters:
    """The drive's electronics.

    Attributes
    ----------
    supply_voltage, current_limit : float
        V and A.
    current_bandwidth : float
        Of the first-order current loop, Hz.
    delay : float
        Of the torque command, s.
    control_rate : float
        Of the position loop, Hz.
    encoder_bits : int
        Counts of a turn of the motor shaft are 2^bits; 0 is an ideal encoder.
    position_gain, velocity_gain : float
        Impedance control at the output, N m/rad and N m s/rad.
    """

    supply_voltage: float
    current_limit: float
    current_bandwidth: float
    delay: float
    control_rate: float
    encoder_bits: int
    position_gain: float
    velocity_gain: float

    def __post_init__(self) -> None:
        """Refuse a drive that cannot exist."""
        _positive(
            self,
            "drive",
            supply_voltage="without supply nothing turns, use 24 or 48 V",
            current_limit="use the driver's limit",
            current_bandwidth="1000 Hz is usual",
            control_rate="1000 Hz is usual",
        )
        _not_negative(self, "drive", "delay", "position_gain", "velocity_gain")
        if not 0 <= self.encoder_bits <= 32:
            _refuse("drive", "encoder_bits", self.encoder_bits, "within 0 to 32", "0 is ideal")

    @property
    def encoder_step(self) -> float:
        """One count of the encoder, rad at the motor; 0 of an ideal one."""
        return 2.0 * math.pi / 2.0**self.encoder_bits if self.encoder_bits else 0.0


@dataclass(frozen=True)
class ThermalParameters:
    """Winding and housing as two nodes.

    Attributes
    ----------
    winding_to_housing, housing_to_ambient : float
        K/W.
    winding_capacity, housing_capacity : float
        J/K.
    ambient, derating_begins, most : float
        deg C; between the last two the current limit falls to what holds `most` for ever.
    """

    winding_to_housing: float
    housing_to_ambient: float
    winding_capacity: float
    housing_capacity: float
    ambient: float = 25.0
    derating_begins: float = 100.0
    most: float = WINDING_MOST

    def __post_init__(self) -> None:
        """Refuse a network that cannot exist."""
        _positive(
            self,
            "thermal",
            winding_to_housing="0.1 to 2 K/W is usual",
            housing_to_ambient="0.3 to 5 K/W is usual",
            winding_capacity="mass of the winding times 385 J/(kg K)",
            housing_capacity="mass of the housing times 900 J/(kg K)",
        )
        if not (self.ambient < self.derating_begins <= self.most):
            raise DesignError(
                f"thermal.ambient {self.ambient:g}, derating_begins {self.derating_begins:g} and "
                f"most {self.most:g} degC must rise in this order; 25, 100 and 120 do."
            )


@dataclass(frozen=True)
class FrictionParameters:
    """Friction of the gearbox on its motor side and on its output side.

    The motor's own drag is that of :class:`MotorParameters`, and comes on top.

    Attributes
    ----------
    motor_coulomb, output_coulomb : float
        N m at either side, independent of load.
    motor_viscous, output_viscous : float
        N m s/rad at either side.
    stribeck_extra, stribeck_speed : float
        Share by which breakaway exceeds Coulomb friction, and the motor speed at which it has
        fallen off (exp(-(w/w_s)^2)), rad/s.
    load_forward, load_backward : float
        Friction over transmitted torque when the motor drives and when the output drives; it acts
        on the motor side: efficiencies 1/(1 + forward) and 1 - backward.
    load_knee, load_growth : float
        Torque carried up to which these shares hold, N m at the output, and the share by which
        friction of what is carried above it is more.
    bristle_deflection, bristle_damping : float
        Of LuGre friction: motor angle at which breakaway is reached, rad, and the bristles'
        damping, N m s/rad at the motor. Coulomb friction by the stopping torque needs neither.
    """

    motor_coulomb: float
    output_coulomb: float
    motor_viscous: float
    output_viscous: float
    stribeck_extra: float
    stribeck_speed: float
    load_forward: float
    load_backward: float
    bristle_deflection: float = 1e-3
    bristle_damping: float = 0.0
    load_knee: float = 0.0
    load_growth: float = 0.0

    def __post_init__(self) -> None:
        """Refuse friction that cannot exist."""
        names = ("motor_coulomb", "output_coulomb", "motor_viscous", "output_viscous")
        more = ("stribeck_extra", "load_forward", "load_backward", "bristle_damping")
        _not_negative(self, "friction", *names, *more, "load_knee", "load_growth")
        _positive(
            self,
            "friction",
            stribeck_speed="1 to 10 rad/s of the motor is usual",
            bristle_deflection="1e-4 to 1e-2 rad of the motor is usual",
        )


@dataclass(frozen=True, eq=False)
class GearParameters:
    """The gearbox as the actuator feels it.

    Attributes
    ----------
    ratio : float
        Signed: motor speed over output speed.
    input_inertia : float
        All that turns or orbits with the crank but the motor's rotor, carrier side left out,
        kg m^2 at the motor.
    output_inertia : float
        Carrier, pins and their bearings about the axis, kg m^2 at the output.
    error_orders : array (H,) of int
        Periods of each harmonic of the kinematic error in one turn of the output.
    error_cosine, error_sine : array (H,)
        eps(theta) = sum a cos(order theta/n) + b sin(order theta/n), rad at the output, the mean
        over loads from -`error_torque` to it.
    error_torque : float
        Torque up to which the error was solved, N m.
    stiffness : float
        Secant at the output, N m/rad.
    stiffness_cosine, stiffness_sine : array (H,)
        Relative variation of the stiffness over angle, same orders.
    stiffening : float
        Exponent p of torque = k d^p beyond the dead zone, relative to the load `error_torque`:
        1 is a linear spring.
    damping : float
        Of the transmission, N m s/rad at the output.
    backlash : float
        Whole free angle at the output, rad.
    """

    ratio: float
    input_inertia: float
    output_inertia: float
    error_orders: IntArray
    error_cosine: FloatArray
    error_sine: FloatArray
    error_torque: float
    stiffness: float
    stiffness_cosine: FloatArray
    stiffness_sine: FloatArray
    stiffening: float
    damping: float
    backlash: float

    def __post_init__(self) -> None:
        """Refuse a gearbox that cannot exist."""
        if not (math.isfinite(self.ratio) and abs(self.ratio) >= 1.0):
            _refuse("gear", "ratio", self.ratio, "1 or more in size", "-n for a fixed ring")
        _positive(
            self,
            "gear",
            output_inertia="a carrier without inertia has no motion",
            error_torque="use the continuous torque",
            stiffness="use the secant of the loaded curve, N m/rad",
        )
        _not_negative(self, "gear", "input_inertia", "damping", "backlash")
        if not 1.0 <= self.stiffening <= 4.0:
            _refuse("gear", "stiffening", self.stiffening, "within 1 to 4", "1 is a linear spring")
        series = ("error_cosine", "error_sine", "stiffness_cosine", "stiffness_sine")
        wanted = np.shape(self.error_orders)
        for key in series:
            values = np.asarray(getattr(self, key))
            if values.shape != wanted or not np.all(np.isfinite(values)):
                raise DesignError(
                    f"gear.{key} must be {wanted} finite numbers, one for each of error_orders."
                )
        if np.any(np.asarray(self.error_orders) < 1):
            raise DesignError("gear.error_orders count periods of an output turn: 1 or more.")
        refuse_variation(self.error_orders, self.stiffness_cosine, self.stiffness_sine)

    @property
    def error_rms(self) -> float:
        """R.m.s. of the kinematic error, rad at the output."""
        return math.sqrt(0.5 * float(np.sum(self.error_cosine**2 + self.error_sine**2)))


def least_stiffness(orders: IntArray, cosine: FloatArray, sine: FloatArray) -> float:
    """Least of a stiffness over angle whose mean is 1, of these relative harmonics (H,).

    Where they are small together, what they leave at least.
    """
    swing = float(np.sum(np.hypot(cosine, sine)))
    if swing < 1.0 - _NO_LOOK:
        return 1.0 - swing
    turn = np.linspace(0.0, 2.0 * math.pi, 8 * int(np.max(orders)) + 1)
    angle = np.multiply.outer(turn, orders)
    return 1.0 + float((np.cos(angle) @ cosine + np.sin(angle) @ sine).min())


def refuse_variation(orders: IntArray, cosine: FloatArray, sine: FloatArray) -> None:
    """Raise a `DesignError` where a stiffness of these relative harmonics (H,) falls to zero."""
    if least_stiffness(orders, cosine, sine) <= 0.0:
        swing = float(np.sum(np.hypot(cosine, sine)))
        _refuse("gear", "stiffness_cosine", swing, "below 1 in sum", "lower the variation")


@dataclass(frozen=True, eq=False)
class ActuatorParameters:
    """Everything that a simulation, the bench and the exporters read.

    Attributes
    ----------
    mass : float
        kg.
    origins : mapping of str to str
        Dotted name of a value to where it comes from: "catalogue", "computed", "assumed",
        "calibrated", with a remark.
    fitted : tuple of str
        Measurements of the bench that values were fitted to, so that they predict nothing.
    fitted_under : FittedUnder or None
        What these were measured under; None where that is not known, or nothing is fitted.
    seed : int or None
        Of the gearbox drawn from the tolerances; None for perfect parts.
    rig : RigParameters
        Of the bench that it is held on.
    """

    name: str
    motor: MotorParameters
    drive: DriveParameters
    thermal: ThermalParameters
    friction: FrictionParameters
    gear: GearParameters
    mass: float
    origins: dict[str, str] = field(default_factory=dict)
    fitted: tuple[str, ...] = ()
    fitted_under: FittedUnder | None = None
    seed: int | None = None
    rig: RigParameters = field(default_factory=RigParameters)

    def __post_init__(self) -> None:
        """Refuse a motor side without inertia, or without mass."""
        _positive(self, "actuator", mass="weigh it")
        if self.motor_side_inertia <= 0.0:
            raise DesignError(
                "motor.rotor_inertia and gear.input_inertia add up to 0; give the rotor's inertia."
            )

    @property
    def torque_limit(self) -> float:
        """What the driver's current gives at the joint if nothing rubs, N m."""
        return self.motor.torque_constant * self.drive.current_limit * abs(self.gear.ratio)

    @property
    def peak_current(self) -> float:
        """What the driver gives and the motor's own peak torque allows, A."""
        return min(self.drive.current_limit, self.motor.peak_current)

    @property
    def sensor_stiffness(self) -> float:
        """Of a torque sensor rated for `torque_limit`, N m/rad."""
        return self.torque_limit / SENSOR_TWIST

    @property
    def motor_side_inertia(self) -> float:
        """Inertia at the motor: rotor, and what turns or orbits with the crank, kg m^2."""
        return self.motor.rotor_inertia + self.gear.input_inertia

    @property
    def reflected_inertia(self) -> float:
        """Inertia at the output with the motor free to turn, kg m^2."""
        return self.gear.ratio**2 * self.motor_side_inertia + self.gear.output_inertia
