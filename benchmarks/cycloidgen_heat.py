"""Temperature rise, motor ceiling and a duty of four points by cycloidgen.

Run by `heat.py` with the Python of an environment that has cycloidgen 8.0.0; reads designs as JSON
from standard input, prints JSON.
"""

from __future__ import annotations

import json
import sys

from cycloidgen.analysis.duty import DutyCycle, DutyPoint, analyse_duty
from cycloidgen.analysis.motor import analyse_motor
from cycloidgen.analysis.thermal import solve_operating_point
from cycloidgen.core.spec import GearSpec, MotorKind


def judged(given: dict) -> dict[str, float]:
    """One design at its point, and over its duty."""
    points = given.pop("duty")
    given["motor_kind"] = MotorKind(given["motor_kind"])
    spec = GearSpec(**given)
    efficiency, thermal = solve_operating_point(spec)
    motor = analyse_motor(spec, efficiency)
    keys = ("name", "output_torque_Nm", "output_rpm", "seconds")
    cycle = DutyCycle(
        points=tuple(DutyPoint(**dict(zip(keys, point, strict=True))) for point in points)
    )
    duty = analyse_duty(spec, cycle)
    return {
        "loss_W": thermal.loss_W,
        "rise_K": thermal.temperature_rise_C,
        "cooling_area_mm2": thermal.cooling_area_mm2,
        "motor_required_Nm": motor.required_Nm,
        "output_ceiling_Nm": motor.output_torque_ceiling_Nm,
        "duty_loss_W": duty.mean_loss_W,
        "duty_rise_K": duty.temperature_C - spec.ambient_temp_C,
        "duty_rms_motor_Nm": duty.rms_motor_torque_Nm,
        "duty_peak_motor_Nm": duty.peak_motor_torque_Nm,
    }


print(json.dumps([judged(one) for one in json.load(sys.stdin)]))
