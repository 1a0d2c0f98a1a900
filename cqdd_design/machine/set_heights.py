"""What is set by a height gauge as it is bonded: no shoulder places it along the axis."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cqdd_design.catalog.encoders import EncoderSensor, encoder_sensors

if TYPE_CHECKING:
    from cqdd_design.machine.machine import Machine
    from cqdd_design.solids.motor_layout import MotorEnd

_MM, _SAME = 1e3, 1e-7
_SET_WITHIN = 0.1
"""What a height gauge on a surface plate sets while a bond cures, to either side, mm."""
_FACE = "the housing's face for the motor cover"


def set_heights(machine: Machine) -> list[str]:
    """How rotor and encoder come to their heights, in sentences; none without a drawn motor.

    All heights count from the face between housing and motor cover, which both sheets have.

    Raises
    ------
    GeometryError
        When the machine cannot be laid out.
    """
    motor = machine.layout.motor_end
    if motor is None:
        return []
    carrier = "rotor hub" if machine.layout.inrunner is not None else "rotor bell"
    rotor = (
        f"No shoulder places the {carrier} on the shaft. With the shaft pushed down onto its lower "
        f"bearing, set its hub's lower face {_MM * (motor.joint - motor.hub_bottom):.4g} "
        f"\u00b1{_SET_WITHIN:g} mm from {_FACE} by a height gauge, and hold it so until the bond "
        "has set."
    )
    return [rotor, _encoder(machine, motor)]


def _encoder(machine: Machine, motor: MotorEnd) -> str:
    board = next(part.designation for part in machine.parts if part.name == "encoder board")
    sensor = next((one for one in encoder_sensors() if one.name == board), None)
    if motor.open:
        return (
            "The encoder's ring magnet stands flush with the shaft's end, "
            f"{_MM * (motor.joint - motor.shaft_end):.4g} \u00b1{_SET_WITHIN:g} mm from {_FACE}: "
            "the sensor is then at half its height."
        )
    gap = f"{_MM * (motor.magnet_bottom - motor.sensor_top):.3g} mm as drawn"
    if sensor is not None and sensor.least_gap is not None:
        gap = (
            f"{_MM * sensor.least_gap:.3g} to {_MM * sensor.most_gap:.3g} mm for the "
            f"{sensor.name}, {gap}"
        )
    return (
        "The encoder's gap is measured before the magnet is bonded, which is laid in dry: from "
        f"{_FACE} to the sensor in it {_MM * (motor.joint - motor.sensor_top):.4g} mm as drawn, "
        f"less from the same face to the magnet {_MM * (motor.joint - motor.magnet_bottom):.4g} mm "
        f"as drawn, has to leave {gap}. Where that is too little, deepen the magnet's seat; where "
        f"it is too much, bond it proud.{_other_magnet(motor, sensor)}"
    )


def _other_magnet(motor: MotorEnd, sensor: EncoderSensor | None) -> str:
    """Where the sensor's gap is stated for another magnet than that which the shaft takes."""
    size = (2.0 * motor.magnet_radius, motor.magnet_height)
    if sensor is None or abs(sensor.magnet_diameter - size[0]) < _SAME:
        return ""
    told = f"{_MM * sensor.magnet_diameter:g} mm x {_MM * sensor.magnet_height:g} mm"
    return (
        f" That gap is for a magnet of {told}, this one is {_MM * size[0]:g} mm x "
        f"{_MM * size[1]:g} mm: let the field that the sensor itself reads decide."
    )
