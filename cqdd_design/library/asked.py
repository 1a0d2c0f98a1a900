"""The keys of ``[requirements]`` as arguments of `size`, for type checkers and editors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, TypedDict

if TYPE_CHECKING:
    from cqdd_design.units import Quantity


class Asked(TypedDict, total=False):
    """Requirements but ratio and motor; what each means stands in docs/how-to-duty.md."""

    peak_torque: Quantity
    continuous_torque: Quantity
    input_speed: Quantity
    continuous_speed: Quantity
    speed_at_peak: Quantity
    life: Quantity
    duty: Sequence[Mapping[str, Quantity | float]]
    duty_file: str
    duty_columns: Mapping[str, str]
    shock_speed: Quantity
    outer_diameter: Quantity
    length: Quantity
    bore: Quantity
    mass: Quantity
    reflected_inertia: Quantity
    backlash: Quantity
    lost_motion: Quantity
    stiffness: Quantity
    efficiency: float
    surface_temperature: Quantity
    external_moment: Quantity
    external_axial: Quantity
    external_radial: Quantity
    voltage: Quantity
    current: Quantity
    yield_share: float
    disc_count: int
    disc_material: str
    ring_material: str
    pin_material: str


class AskedOfScenario(TypedDict, total=False):
    """What belongs to some loads, commands and signals of `simulate`."""

    load_inertia: Quantity
    load_damping: Quantity
    mass: Quantity
    arm: Quantity
    wall_angle: Quantity
    wall_stiffness: Quantity
    output_speed: Quantity
    sensor_stiffness: Quantity
    start_angle: Quantity
    amplitude: Quantity
    offset: Quantity
    frequency: Quantity
    end_frequency: Quantity
    reference: str
    position_gain: Quantity
    velocity_gain: Quantity
