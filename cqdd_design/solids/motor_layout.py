"""The motor on paper: heights along the axis and turned dimensions of its parts."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cqdd_design.solids.selection import CapScrew


@dataclass(frozen=True)
class MotorLayout:
    """Motor around the housing's tube, its bell and cover, and the encoder on the shaft's end, m.

    Attributes
    ----------
    stack_inner, stack_outer, slot_radius : float
        Laminations of the stator: bore, outside, bottom of the slots, which the coils fill.
    stack_bottom, stack_top, coil : float
        Heights of the laminations, and how far the coils stand out beyond them.
    rotor_inner, rotor_outer, ring_bottom, ring_top : float
        The rotor's ring of magnets and back iron.
    bell_radius, web_bottom, web_top : float
        Outside of the bell that carries the ring; its web.
    hub_radius, hub_bottom, hub_top : float
        The bell's hub on the shaft's stub; below the web it stands in the cover's dish.
    magnet_radius, magnet_height, magnet_bottom : float
        Of the encoder's magnet: flush with the end of the shaft, or on it.
    board_radius, board_bottom, board_top, sensor_top : float
        Encoder board with its sensor.
    cover_inner, cover_outer, cover_floor, cover_wall : float
        Inside and outside radius of the cover; height of its floor's inner face about the bell,
        and its thickness (the dish under the board lies lower).
    spigot, spigot_inner : float
        How deep a rim of the flange reaches into the cover, and its inner radius.
    ear_radius, ear_circle, ear_height : float
        Ears of flange and cover, for the screws that hold them together.
    flange_top : float
        Height of the flange's face under the heads of those screws.
    cable_radius, cable_circle : float
        Hole in the flange for the phase leads; 0 where there is no room.
    """

    stack_inner: float
    stack_outer: float
    slot_radius: float
    stack_bottom: float
    stack_top: float
    coil: float
    rotor_inner: float
    rotor_outer: float
    ring_bottom: float
    ring_top: float
    bell_radius: float
    web_bottom: float
    web_top: float
    hub_radius: float
    hub_bottom: float
    hub_top: float
    magnet_radius: float
    magnet_height: float
    magnet_bottom: float
    board_radius: float
    board_bottom: float
    board_top: float
    sensor_top: float
    board_screw: CapScrew
    cover_inner: float
    cover_outer: float
    cover_floor: float
    cover_wall: float
    spigot: float
    spigot_inner: float
    ear_count: int
    ear_radius: float
    ear_circle: float
    ear_height: float
    flange_top: float
    cover_screw: CapScrew
    cable_radius: float
    cable_circle: float

    @property
    def ear_angles(self) -> np.ndarray:
        """Directions of the ears, rad."""
        return (0.5 + np.arange(self.ear_count)) * 2.0 * math.pi / self.ear_count
