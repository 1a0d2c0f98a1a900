"""Where an outrunner goes that the housing's tube does not fill: behind the gearbox, on a neck.

Half section, output upward; the gearbox's tube ends at the joint::

             |tube|______ floor ______|shaft         housing_bottom, the joint
      [ear]__|___flange______[neck|   |     |
      [ear]  [bell| ring of | coil]|  |     |
      |wall  [    | magnets | stack]| |     |
      |wall  [    |         | coil]|  |_hub |
      |wall  [____|______ web ________|_____|
      |______ floor ____________        [magnet]
                               |__ [board] _____

The phase leads leave through the flange, beside the tube.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from cqdd_design.catalog.materials import Material
from cqdd_design.catalog.motors import Motor
from cqdd_design.geometry.scale import Unit, millimetre_unit
from cqdd_design.solids.encoder_rules import lay_out_encoder
from cqdd_design.solids.motor_layout import MotorLayout
from cqdd_design.solids.motor_rules import hub_length, lay_out_motor
from cqdd_design.solids.registers import spigot_depth
from cqdd_design.solids.selection import cap_screw, thread_size

if TYPE_CHECKING:
    from cqdd_design.solids.layout import HousingLayout, PackLayout
    from cqdd_design.solids.selection import ChosenBearing

_NECK_WALL, _HUB_WALL, _BESIDE = 2.5, 3.5, 0.8
"""Of the neck and the bell's hub, and from hub to neck, units."""
_LEAST_HUB = 0.6
"""Length of the bell's hub over its bore."""
_LEADS = 1.6
"""Radius of the hole of the phase leads, units."""


def _scale(motor: Motor, unit: float) -> Unit:
    """A millimetre at the scale of the larger of machine and motor, m."""
    return Unit(max(unit, millimetre_unit(motor.bore_diameter or 0.0)))


def misfit(motor: Motor, support: ChosenBearing, unit: float) -> str:
    """Why the bell's hub does not go into the neck; empty where it does.

    Parameters
    ----------
    motor : Motor
        With the sizes that `drawn_motor` asks for.
    support : ChosenBearing
        Its bore is the diameter of the shaft's stub.
    unit : float
        A millimetre at the scale of this machine, m.
    """
    bore, stub = motor.bore_diameter or 0.0, support.bearing.bore_diameter
    walls = 2.0 * (_NECK_WALL + _HUB_WALL + _BESIDE) * _scale(motor, unit)
    if bore >= stub + walls - 1e-9:
        return ""
    told = (
        f"{motor.name} stands behind the gearbox on a neck in its {1e3 * bore:.4g} mm stator bore, "
        f"which needs {1e3 * (stub + walls):.3g} mm round a hub on a shaft of {1e3 * stub:.3g} mm"
    )
    if bore <= walls:
        return told
    return (
        f"{told}, or a shaft of at most {1e3 * (bore - walls):.3g} mm, which a cam bearing with a "
        "smaller bore brings"
    )


def lay_out_behind(
    motor: Motor,
    pack: PackLayout,
    housing: HousingLayout,
    support: ChosenBearing,
    unit: float,
    torque: float,
    *,
    weights: bool,
    metal: Material,
    hollow: float | None = None,
) -> MotorLayout:
    """Lay out motor, bell, neck, cover and encoder; parameters as `lay_out_motor`, no misfit.

    As round a tube whose flange is the gearbox's own floor; the cover is wide enough to leave the
    phase leads a way beside the tube.
    """
    scale, tube = _scale(motor, unit), housing.register_radius
    floor = replace(housing, flange_bottom=housing.bottom, flange_radius=tube)
    around = lay_out_motor(motor, pack, floor, support, scale, torque, weights=weights, metal=metal)
    thread = thread_size(3.0 * scale)
    head = cap_screw(thread, 0.0).head_diameter
    leads = _LEADS * scale
    inner = max(around.cover_inner, tube + 2.0 * leads + 2.0 * scale)
    outside = inner + around.cover_wall
    grip = max(2.0 * scale, thread)
    screw = cap_screw(thread, grip + 1.2 * thread)
    # Stiff enough to hold the stator out on it.
    flange = min(max(screw.length - grip, 2.5 * scale), housing.flange_bottom - housing.bottom)
    stub = support.bearing.bore_diameter
    # What the bond asks for, and long enough to stand square.
    needed = around.web_bottom + max(hub_length(torque, stub), _LEAST_HUB * stub)
    encoder = lay_out_encoder(0.5 * stub, around.hub_bottom - 0.5 * unit, hollow)
    return replace(
        around,
        **vars(encoder),
        hub_top=min(around.hub_top, max(around.web_top, needed)),
        cover_inner=inner,
        cover_outer=outside,
        body=outside,
        flange=flange,
        flange_top=housing.bottom + flange,
        spigot=min(spigot_depth(scale), 0.8 * scale),
        spigot_inner=inner - 1.0 * scale,
        ear_radius=0.5 * head + 0.8 * scale,
        ear_circle=outside + 0.5 * head + 0.3 * scale,
        ear_height=grip,
        cover_screw=screw,
        cover_grip=grip,
        cover_engaged=flange,
        cable_radius=leads,
        cable_circle=inner - 1.5 * scale - leads,
        neck_inner=around.stack_inner - _NECK_WALL * scale,
    )
