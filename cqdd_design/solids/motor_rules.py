"""Where the motor goes: an outrunner around the housing's tube, its bell on the shaft's stub.

One that the tube does not fill stands behind the gearbox (`behind_rules`).

Half section, output upward; the discs are inside the tube::

      ear  |  flange of the housing                     | pack_top
      |____|_____________________________________[lip]__|  flange_bottom
      | |  [bell| ring of |  gap  | coil          ]|tube|
      | |  [    | magnets |       | laminations   ]|    |
      | |  [    |_________|       | coil          ]|____|  housing bottom
      | |  [____________ web ________________  hub ]|shaft
      | |____________ cover __________________     [magnet]
                                         |___ [board] ___
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from cqdd_design.catalog.adhesives import ROTOR_COMPOUND, SAFETY, length_needed
from cqdd_design.catalog.materials import Material, find_material
from cqdd_design.catalog.motors import Motor
from cqdd_design.geometry.scale import MOST_TUBE_WALL
from cqdd_design.solids.encoder_rules import lay_out_encoder
from cqdd_design.solids.motor_layout import MotorEnd, MotorLayout
from cqdd_design.solids.registers import LEAD_IN, spigot_depth
from cqdd_design.solids.rotor_pull import (
    NO_HOLES,
    WebHoles,
    WebLoad,
    pull_rate,
    stiff_holes,
    stiff_web,
)
from cqdd_design.solids.selection import cap_screw, thread_size

if TYPE_CHECKING:
    from cqdd_design.design import Design
    from cqdd_design.solids.layout import HousingLayout, PackLayout
    from cqdd_design.solids.selection import ChosenBearing

AIR_GAP = 0.5e-3
"""Radial air gap of a motor whose catalogue gives only the gap's diameter."""
_LEAST_FILL = 0.6
"""Of a rotor's ring: gaps between magnets and cuts in the iron leave more."""
_COIL_SHARE = 0.5
"""Height of the coils' ends over the depth of the slots."""
_LEAST_EFFICIENCY = 0.6
"""Of a gearbox between motor and output."""
_LIGHTENING = 6
"""Holes in the web of a bell."""
_BELL_METAL = "7075-T6"
_HOT = 120.0
"""At which the bond of the bell still holds the motor's torque, deg C: what grease bears."""
MOST_HUB = 2.0
"""Length of a bonded hub over its diameter: beyond, only its ends carry."""
_LEAST_WALL = 0.5e-3
"""Inside the threads of the cover's ears, m."""
_STYLUS = 5.5e-3
"""Between the flange and heads of screws, m: there an indicator's lever stands on the flange."""
_CIRCUIT = (
    ("outer_diameter", "outside diameter"),
    ("gap_diameter", "diameter of the air gap"),
    ("stack_length", "length of the stack"),
    ("rotor_length", "length of the magnets"),
)
_OUTRUNNER = (
    ("bore_diameter", "stator bore"),
    *_CIRCUIT,
    ("slot_depth", "depth of the slots"),
    ("mass", "mass"),
)
_INRUNNER = (
    ("hollow_diameter", "bore of the rotor"),
    *_CIRCUIT,
    ("length", "length over the coils"),
    ("mass", "mass"),
)
"""What is drawn of a motor, and its words."""


def light_rotor(motor: Motor) -> str:
    """Say that an inrunner's rotor would be lighter than its sizes are; empty where it is not.

    Magnets on a back iron are a ring from the rotor's bore to the air gap. Where the inertia that
    the source prints is that of a ring far less dense, it has left something out.
    """
    inner, outer = motor.hollow_diameter, motor.gap_diameter
    long, inertia = motor.rotor_length or motor.stack_length, motor.rotor_inertia
    if not (motor.is_inrunner and inner and outer and long and inertia):
        return ""
    # J = pi/32 rho l (D^4 - d^4)
    ring = math.pi / 32.0 * long * ((outer - AIR_GAP) ** 4 - inner**4)
    dense = find_material("NdFeB N42").density
    if inertia >= _LEAST_FILL * dense * ring:
        return ""
    return (
        f"{motor.name} is listed with a rotor inertia of {inertia:.4g} kg*m^2, that of a ring of "
        f"its sizes of {inertia / ring:.0f} kg/m^3, where magnets on iron have {dense:.0f} "
        f"({dense * ring:.2g} kg*m^2): measure it, or state rotor_inertia in [motor]"
    )


def _sizes(motor: Motor) -> tuple[tuple[str, str], ...]:
    return _INRUNNER if motor.is_inrunner else _OUTRUNNER


def undrawn_sizes(motor: Motor) -> tuple[str, ...]:
    """What is not known of a motor and is needed to draw it, in words."""
    return tuple(words for field, words in _sizes(motor) if getattr(motor, field) is None)


def drawn_motor(motor: Motor) -> tuple[Motor | None, str]:
    """Return a motor if its parts can be drawn, or None and why not."""
    lacking = [(field, words) for field, words in _sizes(motor) if getattr(motor, field) is None]
    if lacking:
        *most, last = (words for _, words in lacking)
        named = (
            f"{', '.join(most)} and {last} of {motor.name} are"
            if most
            else (f"{last} of {motor.name} is")
        )
        keys = ", ".join(field for field, _ in lacking)
        if motor.kind == "own":
            keys += ', or kind = "inrunner" where its rotor turns inside'
        return None, f"the {named} not known (state {keys} in [motor] or with --motor-file)"
    return motor, ""


class MotorPlace(NamedTuple):
    """Where a motor goes."""

    tube: float
    """Outside radius of the housing's tube, m."""
    outrunner: Motor | None
    """The motor if it is one that is drawn, round the tube or behind the gearbox."""
    behind: bool
    """Whether the tube does not fill its stator's bore."""
    missing: str
    """Which of its sizes are not known."""


def motor_place(motor: Motor, pack: PackLayout, unit: float) -> MotorPlace:
    """Place a motor round the housing's tube where that fills its stator's bore, else behind it.

    Parameters
    ----------
    unit : float
        A millimetre at the scale of this machine, m.
    """
    own = pack.ring_radius + 2.0 * unit
    drawn, missing = drawn_motor(motor)
    if motor.is_inrunner or drawn is None:
        return MotorPlace(own, None, False, missing)
    inside = 0.5 * (drawn.bore_diameter or 0.0)
    wall = inside - pack.ring_radius
    if float(unit) * (1.0 - 1e-9) <= wall <= MOST_TUBE_WALL * float(unit):
        return MotorPlace(inside, drawn, False, "")
    return MotorPlace(own, drawn, True, "")


def bell_torque(design: Design, motor: Motor) -> float:
    """Greatest torque that the motor puts through its bell, N m.

    By the driver's current, and no more than the motor's own peak torque; where neither is known,
    what the peak torque of the output asks for.
    """
    constant = motor.torque_constant
    driven = None if constant is None else constant * design.motor.current_limit
    known = [one for one in (driven, motor.peak_torque) if one]
    asked = design.requirements.peak_torque / (_LEAST_EFFICIENCY * design.reducer.ratio)
    return min(known, default=asked)


def bell_material(design: Design) -> str:
    """What the bell is made of: as the housing, or aluminium where that is no metal.

    A plastic neither bonds to a shaft nor stays round at its magnets' temperature.
    """
    own = design.housing.material
    return own if ROTOR_COMPOUND.share_on(find_material(own)) else _BELL_METAL


def hub_length(torque: float, diameter: float) -> float:
    """Length of a bonded hub, m: what holds the torque hot, up to `MOST_HUB` diameters."""
    compound = ROTOR_COMPOUND
    lasting = compound.strength * compound.metal_share * compound.share_at(_HOT) / SAFETY
    needed = min(length_needed(torque, diameter, lasting), MOST_HUB * diameter) + 2.0 * LEAD_IN
    return math.ceil(round(needed * 2e3, 9)) / 2e3


def bonded_length(motor: MotorEnd) -> float:
    """Of a hub between the chamfers of its bore, m."""
    return motor.hub_top - motor.hub_bottom - 2.0 * LEAD_IN


def _most_holes(hub: float, rim: float, unit: float) -> WebHoles:
    """The largest lightening holes that go into a bell's web, none where they save nothing."""
    room = rim - 2.0 * unit - hub - 1.5 * unit
    middle = hub + 1.5 * unit + 0.5 * room
    hole = min(0.5 * room, middle * math.sin(math.pi / _LIGHTENING) - 1.5 * unit)
    return WebHoles(_LIGHTENING, middle, hole) if hole > unit else NO_HOLES


def lay_out_motor(
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
    """Lay out motor, bell, cover and encoder.

    Parameters
    ----------
    motor : Motor
        With the sizes that :func:`drawn_motor` asks for.
    support : ChosenBearing
        Its bore is the diameter of the shaft's stub.
    unit : float
        A millimetre at the scale of this machine, m.
    torque : float
        That the bell's hub passes to the shaft, N m; it is as long as that asks for.
    weights : bool
        Whether room for balance weights is left about the bell.
    metal : Material
        Of the bell, whose web is as thick as the pull on the rotor asks for.
    hollow : float or None
        As `lay_out_encoder` takes it.
    """
    gap, depth = motor.gap_diameter or 0.0, motor.slot_depth or 0.0
    stack, ring = motor.stack_length or 0.0, motor.rotor_length or 0.0
    stack_outer = 0.5 * (gap - AIR_GAP)
    rotor_inner = 0.5 * (gap + AIR_GAP)
    # The catalogue's outside is that of the cup, which is the bell.
    bell = 0.5 * (motor.outer_diameter or 0.0)
    rotor_outer = bell - min(1.2 * unit, 0.5 * (bell - rotor_inner))
    coil = _COIL_SHARE * depth
    room = 2.0 * unit if weights else 0.0
    stack_top = (
        housing.flange_bottom - 0.5 * unit - max(coil, 0.5 * (ring - stack) + 1.0 * unit + room)
    )
    stack_bottom = stack_top - stack
    ring_top = stack_top + 0.5 * (ring - stack)
    web_top = min(
        stack_bottom - coil - 0.8 * unit, ring_top - ring - 1.0 * unit, housing.bottom - 0.8 * unit
    )
    journal = 0.5 * support.bearing.bore_diameter
    hub, middle = journal + 3.5 * unit, ring_top - 0.5 * ring
    pulled = WebLoad(hub, rotor_inner, middle - web_top, pull_rate(gap, stack, AIR_GAP), metal)
    web = stiff_web(pulled, 2.0 * unit)
    web_bottom = web_top - web
    hub_top = housing.bottom - 0.8 * unit
    hub_bottom = min(web_bottom, hub_top - hub_length(torque, 2.0 * journal))
    encoder = lay_out_encoder(journal, hub_bottom - 0.5 * unit, hollow)

    wall = 1.6 * unit
    thread = thread_size(3.0 * unit)
    head = cap_screw(thread, 0.0).head_diameter
    beside = max(wall + 0.3 * 0.55 * thread, 0.5 * thread + _LEAST_WALL)
    inner = max(bell + 1.0 * unit, housing.flange_radius + _STYLUS + 0.5 * head - beside)
    circle = inner + beside
    ear_height = 2.0 * thread
    flange = min(3.0 * unit, pack.top - housing.flange_bottom)
    # Over the bell, whose ring ends a unit and a half below the flange.
    spigot = min(spigot_depth(unit), 0.8 * unit)
    spigot_inner = inner - 1.0 * unit
    if housing.flange_radius > spigot_inner:
        spigot = 0.0
    cable_room = inner - 0.5 * unit - housing.flange_radius - 0.5 * unit
    return MotorLayout(
        stack_inner=0.5 * (motor.bore_diameter or 0.0),
        stack_outer=stack_outer,
        slot_radius=stack_outer - depth,
        stack_bottom=stack_bottom,
        stack_top=stack_top,
        coil=coil,
        rotor_inner=rotor_inner,
        rotor_outer=rotor_outer,
        ring_bottom=ring_top - ring,
        ring_top=ring_top,
        bell_radius=bell,
        web_bottom=web_bottom,
        web_top=web_top,
        lightening=stiff_holes(pulled, web, _most_holes(hub, rotor_inner, unit), unit),
        hub_radius=hub,
        hub_bottom=hub_bottom,
        hub_top=hub_top,
        **vars(encoder),
        cover_inner=inner,
        cover_outer=inner + wall,
        cover_floor=web_bottom - 1.0 * unit - room,
        cover_wall=wall,
        joint=housing.flange_bottom,
        body=inner + wall,
        flange=flange,
        spigot=spigot,
        spigot_inner=spigot_inner,
        ear_count=6,
        ear_radius=0.5 * head + 0.8 * unit,
        ear_circle=circle,
        ear_height=ear_height,
        flange_top=housing.flange_bottom + flange,
        cover_screw=cap_screw(thread, flange + 1.2 * thread),
        cover_grip=flange,
        cover_engaged=ear_height,
        cable_radius=min(0.3 * cable_room, 4.0 * unit) if cable_room > 3.0 * unit else 0.0,
        cable_circle=housing.flange_radius + 0.5 * unit + 0.35 * cable_room,
    )
