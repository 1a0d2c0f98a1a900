"""The rules that turn a design into a `Layout`: what fits where, proportions for the rest."""

from __future__ import annotations

import math

from cqdd_design.catalog.bearings import AUTO, Bearing, find_bearing
from cqdd_design.catalog.materials import find_material
from cqdd_design.catalog.motors import Motor
from cqdd_design.design import Design
from cqdd_design.errors import GeometryError
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.ring import ring_root_radius
from cqdd_design.geometry.runners import pin_runner, ring_runner
from cqdd_design.geometry.scale import Unit, millimetre_unit
from cqdd_design.geometry.validate import validate_geometry
from cqdd_design.solids import behind_rules
from cqdd_design.solids.carrier_rules import (
    column_head_radius,
    counterbore_radius,
    lay_out_carrier,
    pin_wall,
    reach_beside_circle,
)
from cqdd_design.solids.dowel_rules import ring_dowels
from cqdd_design.solids.inrunner_rules import lay_out_inrunner, misfit
from cqdd_design.solids.layout import (
    CarrierLayout,
    HeldPins,
    HousingLayout,
    Layout,
    PackLayout,
    ShaftLayout,
)
from cqdd_design.solids.motor_layout import MotorEnd
from cqdd_design.solids.motor_rules import (
    MotorPlace,
    bell_material,
    bell_torque,
    lay_out_motor,
    motor_place,
)
from cqdd_design.solids.mounting import cover_thread, mounting_thread
from cqdd_design.solids.registers import output_seal, shaft_seal, spigot_depth
from cqdd_design.solids.ring_room import ring_play
from cqdd_design.solids.selection import (
    ChosenBearing,
    OutputPin,
    Room,
    cap_screw,
    fitting_output_bearings,
    named_output_bearing,
    output_bearing,
    output_pin,
    thread_size,
)
from cqdd_design.solids.shaft_bearings import (
    ShaftRoom,
    fitting_support_bearings,
    named_support_bearing,
    support_bearing,
)

_FLOOR, _LEAST_FLOOR = 2.5, 1.5
"""Thickness of the housing's floor, and of what is left of it under the shaft's bearing, units."""
_LEAST_TUBE, _LEAST_TUBE_SHARE = 1.25, 0.2
"""Least wall of a hollow journal, units, and over its radius: thinner ones do not stay round in the
grinder's chuck and under the bearing's press fit."""
_LEAST_HOLE = 0.75e-3
"""Radius of the smallest hole that is drilled through a shaft, m."""
_LEAST_CORE_SHARE = 0.2
"""Least core of the eccentric shaft as a share of the cam bearing's bore radius."""


def lay_out(design: Design, cam_bearing: Bearing, motor: Motor) -> Layout:
    """Lay out the machine around the discs of a design.

    Raises
    ------
    GeometryError
        When disc, ring or holes cannot exist, when neighbouring cam bearings overlap, or when the
        eccentrics leave no shaft.
    """
    pin = output_pin(design.reducer.output_pins)
    pin_runner(design)
    validate_geometry(design, bore_diameter=cam_bearing.outer_diameter)
    unit = _unit(design)
    pack = _pack(design, cam_bearing, unit)
    _refuse_wide_cam(design, cam_bearing)
    _refuse_no_shaft(pack)
    core = _core_radius(pack)
    support, output = _seats(design, pack, pin, core, unit)
    carrier = lay_out_carrier(
        design, pin, pack, support, output, core, unit, _most_shoulder_radius(pack, unit)
    )
    place = motor_place(motor, pack, unit)
    row, behind, missing = place.outrunner, place.behind, place.missing
    housing, seat_top = _housing(design, pack, carrier, support, unit, place)
    drawn, inside, torque = None, None, bell_torque(design, motor)
    wanted = design.requirements.bore
    hole = _shaft_hole(support, unit, wanted)
    hollow = None if wanted is None else hole
    if row is not None:
        missing = behind_rules.misfit(row, support, unit) if behind else ""
        if not missing:
            rule = behind_rules.lay_out_behind if behind else lay_out_motor
            weights = design.reducer.balance.counterweights
            metal = find_material(bell_material(design))
            drawn = rule(
                row, pack, housing, support, unit, torque,
                weights=weights, metal=metal, hollow=hollow,
            )  # fmt: skip
    elif motor.is_inrunner and not missing:
        missing = misfit(motor, support, unit)
        if not missing:
            inside = lay_out_inrunner(motor, housing, support, unit, torque, hollow)
    return Layout(
        unit=unit,
        pack=pack,
        shaft=_shaft(pack, support, core, housing, seat_top, unit, drawn or inside, hole),
        carrier=carrier,
        housing=housing,
        dowels=ring_dowels(design, pack, housing, unit),
        motor=drawn,
        inrunner=inside,
        motor_row=motor,
        motor_missing=missing,
    )


def seat_bearings(design: Design, cam_bearing: Bearing) -> tuple[ChosenBearing, ChosenBearing]:
    """The bearings at both ends of the shaft, and of the carrier, as `lay_out` chooses them.

    They are also told where the rest of the machine cannot be laid out: such a gearbox can still
    be analysed. A shaft without room for its core counts with the least one.

    Raises
    ------
    GeometryError
        When the disc cannot exist.
    """
    return _seats(design, *_with_core(design, cam_bearing))


def shaft_bearings(design: Design, cam_bearing: Bearing) -> tuple[ChosenBearing, ...]:
    """Catalogue bearings that go on both ends of the shaft, what a layout prefers first.

    Raises
    ------
    GeometryError
        When the disc cannot exist.
    """
    return fitting_support_bearings(_rooms(design, *_with_core(design, cam_bearing))[0])


def _with_core(design: Design, cam_bearing: Bearing) -> tuple[PackLayout, OutputPin, float, float]:
    unit = _unit(design)
    pack = _pack(design, cam_bearing, unit)
    core = max(_core_radius(pack), _least_core(pack))
    return pack, output_pin(design.reducer.output_pins), core, unit


def carrier_bearings(design: Design, cam_bearing: Bearing) -> tuple[ChosenBearing, ...]:
    """Catalogue bearings that go between carrier and housing, what a layout prefers first.

    Raises
    ------
    GeometryError
        When the disc cannot exist.
    """
    unit = _unit(design)
    room = _carrier_room(design, _pack(design, cam_bearing, unit), unit)
    return fitting_output_bearings(room)


def _unit(design: Design) -> Unit:
    return Unit(millimetre_unit(design.reducer.ring.outer_diameter))


def _seats(
    design: Design, pack: PackLayout, pin: OutputPin, core: float, unit: float
) -> tuple[ChosenBearing, ChosenBearing]:
    onto, around = _rooms(design, pack, pin, core, unit)
    support = design.reducer.support_bearing.designation
    output = design.reducer.carrier_bearing.designation
    return (
        support_bearing(onto)
        if support == AUTO
        else named_support_bearing(find_bearing(support), onto),
        output_bearing(around, unit)
        if output == AUTO
        else named_output_bearing(find_bearing(output), around),
    )


def _rooms(
    design: Design, pack: PackLayout, pin: OutputPin, core: float, unit: float
) -> tuple[ShaftRoom, Room]:
    """Of the bearings at the shaft's ends, and of the carrier's."""
    pins = design.reducer.output_pins
    circle, radius = pins.circle_radius, reach_beside_circle(design.reducer)
    heads = max(counterbore_radius(pin), column_head_radius(design.reducer), radius)
    onto = ShaftRoom(
        2.0 * core,
        max(0.4e-3, 0.16 * core),
        min(pack.cam.bearing.outer_diameter, 2.0 * (circle - radius - unit)),
        2.0 * (circle - heads - pin_wall(pins.diameter, unit) - 2.3 * unit),
    )
    return onto, _carrier_room(design, pack, unit)


def _carrier_room(design: Design, pack: PackLayout, unit: float) -> Room:
    most_shoulder = _most_shoulder_radius(pack, unit)
    around = design.reducer.output_pins.circle_radius + reach_beside_circle(design.reducer)
    return Room(
        2.0 * (around + _within(0.2 * unit, most_shoulder - around - unit, 1.2 * unit)),
        most_shoulder,
        2.0 * pack.ring_radius + 8.0 * unit,
    )


def _pack(design: Design, cam_bearing: Bearing, unit: float) -> PackLayout:
    reducer = design.reducer
    reach = CycloidDisc.from_design(design).tip_distance + reducer.eccentricity
    ring_radius = 0.5 * reducer.ring.outer_diameter
    relief = max(reducer.disc_spacing, 0.3 * unit)
    seat, held = reach, None
    if ring_runner(design) is not None:
        # The ring is clamped outside the rollers' pockets, and the pins span what they bend over.
        seat, held = ring_root_radius(design), _held_pins(design, unit)
        relief = reducer.disc_spacing or relief
    ledge = min(seat + 0.15 * unit, 0.5 * (seat + ring_radius))
    # On three quarters of the ring's wall, and on pins that stand in its pockets.
    clamp = ring_radius - 0.25 * (ring_radius - ledge)
    inner = ledge
    if held is not None:
        wall = max(1.0 * unit, 0.25 * held.diameter)
        inner = clamp = held.circle_radius - 0.5 * held.diameter - wall
    elif reducer.ring_type == "pinwheel":
        clamp = min(clamp, reducer.ring_pitch_radius + 0.25 * reducer.ring_pin_diameter)
    return PackLayout(
        disc_thickness=reducer.disc_thickness,
        pitch=reducer.disc_thickness + reducer.disc_spacing,
        top=reducer.pack_length,
        gap=reducer.disc_spacing,
        disc_count=reducer.disc_count,
        eccentricity=reducer.eccentricity,
        cam=ChosenBearing(cam_bearing),
        reach=reach,
        ledge_radius=ledge,
        relief=relief,
        ring_play=ring_play(reducer.ring_material, design.housing.material, reducer.pack_length),
        inner_radius=inner,
        most_clamp_radius=clamp,
        held_pins=held,
        ring_radius=ring_radius,
    )


def _held_pins(design: Design, unit: float) -> HeldPins:
    reducer = design.reducer
    diameter = reducer.ring_pin_diameter
    depth = max(1.5 * unit, 0.5 * diameter)
    return HeldPins(reducer.ring_tooth_count, reducer.ring_pitch_radius, diameter, depth)


def _refuse_wide_cam(design: Design, cam_bearing: Bearing) -> None:
    reducer = design.reducer
    pitch = reducer.disc_thickness + reducer.disc_spacing
    most = pitch if reducer.disc_count > 1 else pitch + reducer.disc_spacing
    if cam_bearing.width > most + 1e-9:
        raise GeometryError(
            f"cam_bearing {cam_bearing.designation} is {cam_bearing.width * 1e3:g} mm wide, more "
            f"than the {most * 1e3:g} mm that disc_thickness and disc_spacing leave it; raise "
            f"disc_thickness to {cam_bearing.width * 1e3:g} mm or choose a narrower bearing."
        )


def _core_radius(pack: PackLayout) -> float:
    """Radius of the round core that a cam bearing can pass on its way to its lobe.

    A third disc needs a loose cam, pressed on this core, whose wall must remain.
    """
    return 0.5 * pack.cam.bearing.bore_diameter - pack.eccentricity - _core_wall(pack)


def _core_wall(pack: PackLayout) -> float:
    bore = 0.5 * pack.cam.bearing.bore_diameter
    return max(0.6e-3, 0.1 * bore) if pack.disc_count > 2 else max(0.03e-3, 0.02 * bore)


def _least_core(pack: PackLayout) -> float:
    return _LEAST_CORE_SHARE * 0.5 * pack.cam.bearing.bore_diameter


def _refuse_no_shaft(pack: PackLayout) -> None:
    bore, wall, least = 0.5 * pack.cam.bearing.bore_diameter, _core_wall(pack), _least_core(pack)
    if _core_radius(pack) < least:
        most = max(bore - wall - least, 0.0)
        enough = 2.0 * (pack.eccentricity + wall) / (1.0 - _LEAST_CORE_SHARE)
        raise GeometryError(
            f"eccentricity {pack.eccentricity * 1e3:.4g} mm leaves no eccentric shaft inside cam "
            f"bearing {pack.cam.bearing.designation} with its {2e3 * bore:g} mm bore; lower it to "
            f"{math.floor(most * 1e5) / 1e2:g} mm, or choose a bearing with a bore of at least "
            f"{math.ceil(enough * 1e4) / 10:g} mm."
        )


def _most_shoulder_radius(pack: PackLayout, unit: float) -> float:
    """Room for the shoulder of the carrier plate inside the ring clamp, m."""
    return pack.most_clamp_radius - 0.3 * unit


def _within(least: float, value: float, most: float) -> float:
    return min(max(value, least), most)


def _housing(
    design: Design,
    pack: PackLayout,
    carrier: CarrierLayout,
    support: ChosenBearing,
    unit: float,
    place: MotorPlace,
) -> tuple[HousingLayout, float]:
    """Housing, and the height of the lower support bearing's upper face."""
    count = 6 if design.reducer.ring.outer_diameter < 50e-3 else 8
    thread = cover_thread(design, thread_size(3.0 * unit), count, 5.5 * unit)
    spigot = spigot_depth(unit)
    face, cover_bottom = pack.top + spigot, carrier.bearing_bottom - spigot
    lip = max(2.0 * unit, 0.3 * thread)
    hub = 0.5 * carrier.output.bearing.outer_diameter + 2.5 * unit
    head = cap_screw(thread, 0.0).head_diameter
    cover_flange_top = carrier.bearing_bottom + max(
        3.0 * unit, min(thread, carrier.output.bearing.width)
    )
    # Threads begin below the clamp's spigot: a long grip loses less of its preload.
    grip = cover_flange_top - pack.top
    screw = cap_screw(thread, grip + 1.3 * thread)
    flange_bottom = pack.top - max(screw.length - grip, 1.3 * thread) - 0.5 * unit
    bolt_circle = max(
        place.tube + 0.5 * thread + 1.0 * unit,
        hub + 0.5 * head + 0.4 * unit,
        pack.ring_radius + 0.5 * thread + 1.0 * unit,
    )
    pin_heads = carrier.pin_circle_radius - 0.5 * max(
        carrier.pin.head_diameter, carrier.pin.nominal_diameter
    )
    inside = carrier.cap_inner if carrier.cap else pin_heads
    boss = 0.5 * support.bearing.outer_diameter + max(1.2 * unit, 0.3 * support.section)
    nested = inside >= boss + 0.5 * unit
    clear = carrier.lowest - 0.8 * unit
    seat_top = -pack.gap if nested else clear
    seat_bottom = seat_top - support.bearing.width
    bottom = min(clear - _FLOOR * unit, seat_bottom - _LEAST_FLOOR * unit)
    # Round the seat alone a floor has to be as thick as the bearing.
    floor_top = clear if nested else min(clear, bottom + _FLOOR * unit)
    flange_bottom = max(flange_bottom, bottom)
    mount = mounting_thread(
        design.requirements,
        count,
        bolt_circle,
        thread,
        cover_flange_top - face,
        face - flange_bottom,
        find_material(design.housing.material),
        design.environment.coldest,
    )
    # Larger ones leave a wall and the ring's dowels room.
    bolt_circle = max(bolt_circle, pack.ring_radius + 0.55 * mount + 1.85 * unit)
    rim = max(0.5 * head, 0.55 * mount) + 1.0 * unit
    cover_top = carrier.output_seat_top + lip
    layout = HousingLayout(
        register_radius=place.tube,
        seated_motor=place.outrunner is not None and not place.behind,
        flange_radius=bolt_circle + rim,
        flange_bottom=flange_bottom,
        bolt_circle_radius=bolt_circle,
        screw=screw,
        screw_count=count,
        mount_thread=mount,
        face=face,
        spigot=spigot,
        clamp_inner=min(carrier.output.lip_radius, pack.most_clamp_radius),
        cover_bottom=cover_bottom,
        cover_flange_top=cover_flange_top,
        cover_hub_radius=hub,
        cover_top=cover_top,
        boss_radius=boss,
        floor_top=floor_top,
        bottom=bottom,
        output_seal=output_seal(carrier, max(cover_top, cover_flange_top), unit),
        shaft_seal=shaft_seal(support, bottom, seat_bottom, unit),
    )
    return layout, seat_top


def _shaft_hole(support: ChosenBearing, unit: float, wanted: float | None) -> float:
    """Radius of the hole through the shaft, m: what lightens it, or more where that is asked for.

    What is too small to be drilled is left out later; a wall has to remain that can be ground.
    """
    journal = 0.5 * support.bearing.bore_diameter
    usual = journal - max(2.5 * unit, 0.3 * journal)
    if wanted is None:
        return usual
    most = journal - max(_LEAST_TUBE * unit, _LEAST_TUBE_SHARE * journal)
    return max(usual, min(0.5 * wanted, most))


def _shaft(
    pack: PackLayout,
    support: ChosenBearing,
    core: float,
    housing: HousingLayout,
    seat_top: float,
    unit: float,
    motor: MotorEnd | None,
    hole: float,
) -> ShaftLayout:
    journal = support.bearing.bore_diameter
    cam_bore = 0.5 * pack.cam.bearing.bore_diameter
    # The collar touches inner rings only: e to the far side of the bearing's own centre.
    web = pack.cam.shoulder_radius - pack.eccentricity
    # Never tangent to a lobe from inside or outside: kernels fuse tangent cylinders badly.
    if abs(abs(web - cam_bore) - pack.eccentricity) < 0.02e-3:
        web -= 0.05e-3
    upper = pack.top + pack.gap
    bottom = housing.bottom - min(1.2 * journal, 12.0 * unit)
    if motor is not None:
        bottom = motor.shaft_end
        if not motor.open:
            # The encoder's magnet needs a seat at the end of the bore.
            hole = min(hole, motor.magnet_radius - 0.4e-3)
    return ShaftLayout(
        support=support,
        shoulder_radius=core,
        web_radius=max(web, core + 0.05e-3),
        bore_radius=hole if hole >= _LEAST_HOLE else 0.0,
        lower_seat_top=seat_top,
        upper_seat_bottom=upper,
        bottom=bottom,
        top=upper + support.bearing.width,
    )
