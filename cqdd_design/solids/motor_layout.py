"""The motor on paper: heights along the axis and turned dimensions of its parts."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cqdd_design.solids.rotor_pull import WebHoles
from cqdd_design.solids.selection import CapScrew


@dataclass(frozen=True)
class EncoderPlace:
    """Magnet at the end of a shaft, and the board under it or round it; m.

    Attributes
    ----------
    magnet_inner, magnet_radius, magnet_height, magnet_bottom : float
        Of the encoder's magnet: flush with the end of the shaft, or on it; a ring round a shaft
        that stays open, of a magnet on the axis the inner radius is 0.
    shaft_end : float
        Height at which the shaft ends.
    board_inner, board_radius, board_bottom, board_top, sensor_top : float
        Encoder board with its sensor; the inner radius is 0 of one under the shaft.
    seat_bottom : float
        Height of the dish inside the board's seat, which is lower under a ring magnet.
    way : float
        Radius of the hole in the dish below an open shaft; 0 of a closed one.
    """

    magnet_inner: float
    magnet_radius: float
    magnet_height: float
    magnet_bottom: float
    shaft_end: float
    board_inner: float
    board_radius: float
    board_bottom: float
    board_top: float
    sensor_top: float
    board_screw: CapScrew
    seat_bottom: float
    way: float

    @property
    def open(self) -> bool:
        """Whether the shaft's hole goes on through the encoder."""
        return self.magnet_inner > 0.0


@dataclass(frozen=True)
class MotorEnd(EncoderPlace):
    """What all motors have: stator and rotor, a hub on the shaft, cover and encoder; m.

    Attributes
    ----------
    stack_inner, stack_outer : float
        Laminations of the stator: bore and outside.
    stack_bottom, stack_top, coil : float
        Heights of the laminations, and how far the coils stand out beyond them.
    rotor_inner, rotor_outer, ring_bottom, ring_top : float
        The rotor's ring of magnets and back iron.
    hub_radius, hub_bottom, hub_top : float
        The hub on the shaft's stub that the rotor hangs on; below its web it stands in the cover's
        dish.
    cover_inner, cover_outer, cover_floor, cover_wall : float
        Inside and outside radius of the cover; height of its floor's inner face, and its thickness
        (the dish under the board lies lower).
    joint, body, flange : float
        Height of the face between housing and cover; radius of the flanges there, ears left out;
        thickness of the housing's.
    spigot, spigot_inner : float
        How deep a rim of the housing reaches into the cover, and its inner radius.
    ear_radius, ear_circle, ear_height : float
        Ears of housing and cover, for the screws that hold them together; height of the cover's.
    cover_grip, cover_engaged : float
        Thickness under the heads of those screws, and length of thread that there is for them.
    """

    stack_inner: float
    stack_outer: float
    stack_bottom: float
    stack_top: float
    coil: float
    rotor_inner: float
    rotor_outer: float
    ring_bottom: float
    ring_top: float
    hub_radius: float
    hub_bottom: float
    hub_top: float
    cover_inner: float
    cover_outer: float
    cover_floor: float
    cover_wall: float
    joint: float
    body: float
    flange: float
    spigot: float
    spigot_inner: float
    ear_count: int
    ear_radius: float
    ear_circle: float
    ear_height: float
    cover_screw: CapScrew
    cover_grip: float
    cover_engaged: float

    @property
    def ear_angles(self) -> np.ndarray:
        """Directions of the ears, rad."""
        return (0.5 + np.arange(self.ear_count)) * 2.0 * math.pi / self.ear_count


@dataclass(frozen=True)
class MotorLayout(MotorEnd):
    """An outrunner around the housing's tube, or behind the gearbox on a neck of its floor; m.

    Attributes
    ----------
    slot_radius : float
        Bottom of the slots, which the coils fill.
    bell_radius, web_bottom, web_top : float
        Outside of the bell that carries the ring; its web.
    lightening : WebHoles
        Through the web.
    flange_top : float
        Height of the housing's face under the heads of the cover's screws.
    cable_radius, cable_circle : float
        Hole in the housing's flange for the phase leads; 0 where there is no room.
    neck_inner : float
        Bore of the neck that carries the stator; 0 where the housing's tube does.
    """

    slot_radius: float
    bell_radius: float
    web_bottom: float
    web_top: float
    lightening: WebHoles
    flange_top: float
    cable_radius: float
    cable_circle: float
    neck_inner: float = 0.0

    @property
    def behind(self) -> bool:
        """Whether it stands behind the gearbox."""
        return self.neck_inner > 0.0

    @property
    def lip(self) -> float:
        """Radius of the step over the laminations, which they stand against."""
        return 0.5 * (self.stack_inner + self.slot_radius)


@dataclass(frozen=True)
class InrunnerLayout(MotorEnd):
    """An inrunner behind the gearbox, its stator in the cover, m.

    Attributes
    ----------
    coil_inner, coil_outer : float
        Radii of the coils' ends.
    ledge : float
        Bore of the cover below the stator, which stands on the step.
    sleeve_inner, lip_bottom, lip_radius, web_top : float
        Of the hub that carries the rotor: the bore of its sleeve, the lip under the rotor, and the
        top of its web, which begins where the lip does.
    cable_radius, cable_circle : float
        Hole in the cover's floor for the phase leads; 0 where there is no room.
    """

    coil_inner: float
    coil_outer: float
    ledge: float
    sleeve_inner: float
    lip_bottom: float
    lip_radius: float
    web_top: float
    cable_radius: float
    cable_circle: float
