"""Which torque a torque density counts, for the test bench and for the table of masses alike."""

from __future__ import annotations

import math

from cqdd_design.actuator.motor import torque_constant_at
from cqdd_design.actuator.parameters import DriveParameters, MotorParameters


def torques_of_drive(
    motor: MotorParameters, drive: DriveParameters, ratio: float, ambient: float
) -> dict[str, float]:
    """Torques at the output that driver and motor allow, N m, losses left out.

    Of a motor whose magnets are as warm as the air, `ambient` in deg C.
    """
    constant = float(torque_constant_at(motor, ambient))
    torques = {"driver_limited_Nm": constant * drive.current_limit * ratio}
    by_motor = motor.peak_torque * ratio
    return torques | ({"motor_limited_Nm": by_motor} if math.isfinite(by_motor) else {})


def density_torque(peak: float | None, required: float) -> tuple[float, str]:
    """Torque of a torque density, N m, and which it is.

    Parameters
    ----------
    peak : float or None
        What motor and driver give, N m; None where that is not known.
    required : float
        What is asked of the gearbox, N m.
    """
    if peak is None:
        return required, f"{required:.4g} N*m required (what motor and driver give is not known)"
    if required < peak:
        return (
            required,
            f"{required:.4g} N*m required (motor and driver give {peak:.4g} N*m before friction)",
        )
    beyond = f" ({required:.4g} N*m is required)" if math.isfinite(required) else ""
    return peak, f"{peak:.4g} N*m of motor and driver{beyond}"
