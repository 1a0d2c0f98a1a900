"""Where an inrunner goes: behind the gearbox, its rotor on the shaft, its stator in the cover.

Half section, output upward; the gearbox's tube ends at the joint::

        |tube|_________ floor _________|shaft        housing_bottom, the joint
      [ear]__|_flange_[rim]            |     |
      [ear]  |        [ coil ]  _______|_hub |
      |wall  |        [ stack ]|rotor| |     |
      |wall  |________[ coil  ]|_____|_web___|
      |______ floor ____________        [magnet]
                               |__ [board] _____

The gearbox inside a wide rotor, or around a slim motor, would be shorter; neither is drawn. No
motor whose sizes the catalogue has takes a ring of 45 mm inside, or goes into a ring of 150 mm;
whether one would is told of every machine (`machine.motor_standing`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cqdd_design.catalog.motors import Motor
from cqdd_design.solids.encoder_rules import lay_out_encoder
from cqdd_design.solids.motor_layout import InrunnerLayout
from cqdd_design.solids.motor_rules import AIR_GAP, hub_length
from cqdd_design.solids.registers import spigot_depth
from cqdd_design.solids.selection import cap_screw, thread_size

if TYPE_CHECKING:
    from cqdd_design.solids.layout import HousingLayout
    from cqdd_design.solids.selection import ChosenBearing

_COIL_INNER, _COIL_OUTER = 0.02, 0.06
"""From bore and outside of the laminations to the coils' ends, in shares of their width: RI100 and
RI80 of the catalogue have 0.02 and 0.06 or more."""
_LEAST_HUB = 1.0
"""Wall of a hub between stub and rotor, units."""
_LEAST_WALL = 0.5e-3
"""Between the tube and the threads beside it, m."""


def misfit(motor: Motor, support: ChosenBearing, unit: float) -> str:
    """Why the rotor does not go over the shaft's end; empty where it does."""
    bore, stub = motor.hollow_diameter or 0.0, support.bearing.bore_diameter
    hub = 2.0 * _LEAST_HUB * unit
    least = stub + hub
    if bore >= least - 1e-9:
        return ""
    told = (
        f"the rotor of {motor.name} has a bore of {1e3 * bore:.4g} mm, and with a hub it needs "
        f"{1e3 * least:.3g} mm on a shaft of {1e3 * stub:.3g} mm"
    )
    if bore <= hub:
        return told
    return (
        f"{told}, or a shaft of at most {1e3 * (bore - hub):.3g} mm, which a cam bearing with a "
        "smaller bore brings"
    )


def lay_out_inrunner(
    motor: Motor,
    housing: HousingLayout,
    support: ChosenBearing,
    unit: float,
    torque: float,
    hollow: float | None = None,
) -> InrunnerLayout:
    """Lay out motor, hub, cover and encoder.

    Parameters
    ----------
    motor : Motor
        With the sizes that `drawn_motor` asks for, and no :func:`misfit`.
    support : ChosenBearing
        Its bore is the diameter of the shaft's stub.
    unit : float
        A millimetre at the scale of this machine, m.
    torque : float
        That the hub passes to the shaft, N m; it is as long as that asks for.
    hollow : float or None
        As `lay_out_encoder` takes it.
    """
    gap, stack, ring = motor.gap_diameter or 0.0, motor.stack_length or 0.0, motor.rotor_length or 0
    stack_inner, stack_outer = 0.5 * (gap + AIR_GAP), 0.5 * (motor.outer_diameter or 0.0)
    rotor_inner, rotor_outer = 0.5 * (motor.hollow_diameter or 0.0), 0.5 * (gap - AIR_GAP)
    across = stack_outer - stack_inner
    coil_outer = stack_outer - _COIL_OUTER * across
    coil = max(0.5 * ((motor.length or 0.0) - stack), 0.0)

    joint, spigot = housing.bottom, min(spigot_depth(unit), 0.8 * unit)
    # Coils and rotor stand clear of the rim that centres the cover.
    stack_top = joint - spigot - 0.3 * unit - max(coil, 0.5 * (ring - stack) + 0.3 * unit)
    stack_bottom, ring_top = stack_top - stack, stack_top + 0.5 * (ring - stack)
    ring_bottom = ring_top - ring
    lip_bottom = ring_bottom - 1.0 * unit

    journal, hub_top = 0.5 * support.bearing.bore_diameter, joint - 0.8 * unit
    hub_bottom = min(lip_bottom, hub_top - hub_length(torque, 2.0 * journal))
    hub = min(journal + 3.5 * unit, rotor_inner)
    sleeve = rotor_inner - 2.0 * unit

    wall, thread = 1.6 * unit, thread_size(3.0 * unit)
    head = cap_screw(thread, 0.0).head_diameter
    outside = stack_outer + wall
    grip = max(2.0 * unit, thread)
    screw = cap_screw(thread, grip + 1.2 * thread)
    # Stiff enough to hold the stator out on it.
    flange = min(max(screw.length - grip, 2.5 * unit), housing.flange_bottom - joint)
    floor = min(stack_bottom - coil - 0.8 * unit, lip_bottom - 1.0 * unit)
    encoder = lay_out_encoder(journal, hub_bottom - 0.5 * unit, hollow)
    # The shaft reaches as far as its encoder, whose board lies in a dish below the floor.
    short = encoder.board_bottom - (floor - wall)
    if encoder.open:
        # A board round the shaft is wide: its screws' heads stay below the stator's coils.
        heads = encoder.board_top + encoder.board_screw.head_height
        short = max(short, heads - floor)
    if short > 0.0:
        hub_bottom -= short
        encoder = lay_out_encoder(journal, hub_bottom - 0.5 * unit, hollow)
    dish = max(encoder.board_radius, hub) + 1.0 * unit + wall
    ledge = round(0.5 * (coil_outer + stack_outer), 4)
    room = ledge - dish
    return InrunnerLayout(
        stack_inner=stack_inner,
        stack_outer=stack_outer,
        stack_bottom=stack_bottom,
        stack_top=stack_top,
        coil=coil,
        rotor_inner=rotor_inner,
        rotor_outer=rotor_outer,
        ring_bottom=ring_bottom,
        ring_top=ring_top,
        hub_radius=hub,
        hub_bottom=hub_bottom,
        hub_top=hub_top,
        **vars(encoder),
        cover_inner=stack_outer,
        cover_outer=outside,
        cover_floor=floor,
        cover_wall=wall,
        spigot=spigot,
        spigot_inner=stack_outer - 1.0 * unit,
        ear_count=6,
        ear_radius=0.5 * head + 0.8 * unit,
        # Heads beside the cover's wall, threads beside the tube.
        ear_circle=max(
            outside + 0.5 * head + 0.3 * unit,
            housing.register_radius + 0.5 * thread + _LEAST_WALL,
        ),
        ear_height=grip,
        cover_screw=screw,
        cover_grip=grip,
        cover_engaged=flange,
        joint=joint,
        body=max(outside, housing.register_radius),
        flange=flange,
        coil_inner=stack_inner + _COIL_INNER * across,
        coil_outer=coil_outer,
        ledge=ledge,
        # A hub that comes near the rotor is in one piece with its sleeve.
        sleeve_inner=sleeve if sleeve > hub + 0.5 * unit else hub,
        lip_bottom=lip_bottom,
        lip_radius=rotor_inner + min(1.0 * unit, 0.4 * (rotor_outer - rotor_inner)),
        web_top=min(lip_bottom + 2.5 * unit, ring_top),
        cable_radius=min(0.3 * room, 3.0 * unit) if room > 3.0 * unit else 0.0,
        cable_circle=round(dish + 0.5 * room, 4),
    )
