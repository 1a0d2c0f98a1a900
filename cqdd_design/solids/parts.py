"""The parts of the gearbox: shape, material, colour, where each piece stands, make or buy.

`build_parts` needs no CAD kernel; the first use of `Part.solid` does.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from cqdd_design.catalog.bearings import shaft_material
from cqdd_design.catalog.printing import made_how
from cqdd_design.design import Design
from cqdd_design.geometry.columns import COLUMN_MATERIAL
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.disc import disc_contour, disc_moments
from cqdd_design.geometry.output_pins import RACEWAY, pin_zone
from cqdd_design.geometry.ring import ring_contour, ring_moments, ring_pins
from cqdd_design.geometry.runners import pin_runner, ring_runner
from cqdd_design.solids import carrier as carrier_shapes
from cqdd_design.solids import housing as housing_shapes
from cqdd_design.solids import rotating
from cqdd_design.solids.behind_shapes import with_neck
from cqdd_design.solids.clocking import DiscGroup, disc_groups
from cqdd_design.solids.counterweights import balance_weights
from cqdd_design.solids.encoder_shapes import with_magnet_pocket
from cqdd_design.solids.features import carrier as carrier_features
from cqdd_design.solids.features import zones
from cqdd_design.solids.features.flat import SIGMAS, disc_features, ring_features
from cqdd_design.solids.features.holes import FittedHole
from cqdd_design.solids.features.housing import (
    clamp_features,
    cover_features,
    housing_features,
    ring_dowel_holes,
    screw_circle,
)
from cqdd_design.solids.features.inrunner import flange_features
from cqdd_design.solids.features.kinds import AxialThread, Feature
from cqdd_design.solids.features.rotating import (
    RING_PIN_PLAY,
    loose_cam_features,
    pin_features,
    ring_pin_features,
    shaft_features,
)
from cqdd_design.solids.flanged_can import with_flange
from cqdd_design.solids.inrunner_parts import inrunner_parts
from cqdd_design.solids.layers import Stack, prism
from cqdd_design.solids.layout import Layout, ShimLayout
from cqdd_design.solids.motor_parts import dowel_part, motor_parts
from cqdd_design.solids.motor_shapes import (
    with_dowel_grooves,
    with_dowel_notches,
    with_motor_flange,
)
from cqdd_design.solids.mounting import SCREW_MATERIAL
from cqdd_design.solids.part import Colour, Instance, Part, around, on_axis, placed
from cqdd_design.solids.poses import CARRIER, HOUSING, SHAFT, Body, transform
from cqdd_design.solids.runner_parts import BEARING_COLOUR, runner_parts
from cqdd_design.solids.selection import ChosenBearing
from cqdd_design.solids.shims import SHIM_MATERIAL

NUT_MATERIAL = "AISI 4140 Q&T 540C"

_ALUMINIUM: Colour = (0.72, 0.74, 0.77)
_HOUSING: Colour = (0.36, 0.40, 0.46)
_COVER: Colour = (0.45, 0.49, 0.55)
_RING: Colour = (0.20, 0.45, 0.70)
_DISCS: tuple[Colour, ...] = ((0.93, 0.69, 0.13), (0.85, 0.45, 0.16), (0.62, 0.72, 0.25))
_SHAFT: Colour = (0.72, 0.20, 0.22)
_SCREW: Colour = (0.16, 0.17, 0.19)


def build_parts(design: Design, layout: Layout) -> tuple[Part, ...]:
    """Every part of a gearbox.

    Parameters
    ----------
    layout : Layout
        Of the same design, from `lay_out`.

    Returns
    -------
    tuple of Part
        Discs, ring, rotating parts, carrier, housing.

    Raises
    ------
    GeometryError
        When the parts cannot exist or cannot be put together.
    """
    parts = [
        *_disc_parts(design, layout),
        *_ring_parts(design, layout),
        *_shaft_parts(design, layout),
        *_carrier_parts(design, layout),
        *_housing_parts(design, layout),
        *motor_parts(design, layout, SCREW_MATERIAL),
        *inrunner_parts(design, layout, SCREW_MATERIAL),
    ]
    if design.reducer.balance.counterweights:
        parts += balance_weights(design, layout, parts, _SHAFT)
    return tuple(parts)


def _disc_parts(design: Design, layout: Layout) -> list[Part]:
    groups = disc_groups(design)
    return [_disc_part(design, layout, group, alone=len(groups) == 1) for group in groups]


def _disc_part(design: Design, layout: Layout, group: DiscGroup, *, alone: bool) -> Part:
    pack, thickness = layout.pack, layout.pack.disc_thickness
    bore = pack.cam.bearing.outer_diameter
    drawn = group.placements[0].disc
    contour = disc_contour(design, drawn, bore_diameter=bore)
    instances = []
    for one in group.placements:
        z = pack.disc_bottom(one.disc) + (thickness if one.turned_over else 0.0)
        at = transform(one.angle, z=z, turned_over=one.turned_over)
        instances.append(Instance(f"disc {one.disc + 1}", Body("disc", one.disc), at))
    return Part(
        "disc" if alone else f"disc {drawn + 1}",
        prism(contour, 0.0, thickness),
        design.reducer.disc_material,
        _DISCS[drawn % len(_DISCS)],
        "make",
        made_how(design.reducer.disc_material, f"wire EDM, {thickness * 1e3:g} mm plate"),
        tuple(instances),
        exact_section=disc_moments(design, drawn, bore_diameter=bore),
        fitted_section=contour.moments(),
        stated=disc_features(design, pack, drawn),
    )


def _ring_parts(design: Design, layout: Layout) -> list[Part]:
    height, dowels = layout.pack.top, layout.dowels
    contour, material = ring_contour(design), design.reducer.ring_material
    shape = prism(contour, 0.0, height)
    features = ring_features(design, layout.pack, dowels)
    for holes in features:
        if isinstance(holes, FittedHole):
            shape = with_dowel_notches(shape, layout.pack.ring_radius, holes)
    ring = Part(
        "ring",
        shape,
        material,
        _RING,
        "make",
        made_how(material, f"wire EDM, {height * 1e3:g} mm plate"),
        on_axis("ring", HOUSING),
        exact_section=ring_moments(design),
        fitted_section=contour.moments(),
        stated=features,
    )
    parts, pins = [ring], ring_pins(design)
    if pins:
        held, diameter = layout.pack.held_pins, design.reducer.ring_pin_diameter
        beyond = 0.0 if held is None else layout.pack.relief + held.depth
        low, high = RING_PIN_PLAY - beyond, height + beyond - RING_PIN_PLAY
        shape = rotating.plain_pin(diameter, low, high)
        designation = f"ground pin {diameter * 1e3:g} x {(high - low) * 1e3:.6g} mm"
        pieces = around("ring pin", HOUSING, (pin.centre for pin in pins))
        zone = RACEWAY if design.reducer.ring.roller_diameter else zones.RING_PIN
        stated = ring_pin_features(diameter, low, high, zone)
        parts.append(
            Part(
                "ring pin", shape, material, BEARING_COLOUR, "make", designation, pieces,
                stated=stated,
            )
        )  # fmt: skip
    rollers = ring_runner(design)
    if rollers is not None:
        centres = [pin.centre for pin in pins]
        parts += runner_parts("ring", "roller", rollers, material, layout.pack, HOUSING, centres)
    return [*parts, *dowel_part(layout)]


def _shaft_parts(design: Design, layout: Layout) -> list[Part]:
    pack, shaft, motor = layout.pack, layout.shaft, layout.motor_end
    material = shaft_material(pack.cam.bearing)

    def ground(name: str, shape: Stack, features: tuple[Feature, ...], more: str = "") -> Part:
        how, pieces = f"turned and ground{more}", on_axis(name, SHAFT)
        return Part(name, shape, material, _SHAFT, "make", how, pieces, stated=features)

    position = SIGMAS * design.tolerances.eccentricity

    turned = rotating.eccentric_shaft(pack, shaft)
    if motor is not None:
        turned = with_magnet_pocket(turned, motor)
    parts = [ground("eccentric shaft", turned, shaft_features(pack, shaft, motor, position))]
    if pack.disc_count > 2:
        loose = rotating.loose_cam(pack, shaft)
        features = loose_cam_features(pack, shaft, position)
        parts.append(ground("eccentric cam", loose, features, ", pressed on the shaft"))
    cams = [
        Instance(f"cam bearing {disc + 1}", Body("disc", disc), transform(z=pack.cam_bottom(disc)))
        for disc in range(pack.disc_count)
    ]
    lower = shaft.lower_seat_top - shaft.support.bearing.width
    supports = (
        *on_axis("shaft bearing, housing end", HOUSING, lower),
        *on_axis("shaft bearing, output end", CARRIER, shaft.upper_seat_bottom),
    )
    return [
        *parts,
        _bearing_part("cam bearing", pack.cam, cams, SHAFT),
        _bearing_part("shaft bearing", shaft.support, supports, SHAFT),
    ]


def _bearing_part(
    name: str, chosen: ChosenBearing, instances: Sequence[Instance], inner: Body
) -> Part:
    row = chosen.bearing
    return Part(
        name,
        rotating.bearing_envelope(chosen),
        chosen.material,
        BEARING_COLOUR,
        "make" if chosen.source == "bush" else "buy",
        row.designation,
        tuple(instances),
        catalogue_mass=row.mass,
        inner_body=inner,
    )


def _carrier_parts(design: Design, layout: Layout) -> list[Part]:
    carrier, metal = layout.carrier, design.carrier_material

    def made(name: str, shape: Stack, how: str, features: tuple[Feature, ...]) -> Part:
        pieces = on_axis(name, CARRIER)
        return Part(name, shape, metal, _ALUMINIUM, "make", how, pieces, stated=features)

    turned = made_how(metal, "turned and drilled")
    position = SIGMAS * design.tolerances.pin_position
    features = carrier_features.plate_features(carrier, layout.shaft, position)
    plate = carrier_shapes.carrier_plate(carrier, layout.shaft, features)
    parts = [made("carrier plate", plate, turned, features)]
    if carrier.cap:
        how = turned
        if carrier.bonded_in_cap:
            drawn = " and drawn against their heads" if carrier.pin.screw else ""
            zone, size = pin_zone(design.reducer.output_pins), carrier.pin.nominal_diameter
            how += f", seats {1e3 * size:g} H7 bonded on the {zone} pins{drawn}"
        features = carrier_features.cap_features(carrier, layout.pack.gap, position)
        cap = carrier_shapes.carrier_cap(carrier, layout.pack.gap, features)
        parts.append(made("carrier cap", cap, how, features))
    features = carrier_features.nut_features(carrier)
    core = next(one.core for one in features if isinstance(one, AxialThread))
    nut = made(
        "bearing nut",
        carrier_shapes.bearing_nut(carrier, core),
        f"slotted nut, thread {2e3 * carrier.nut_radius:g} mm",
        features,
    )
    parts += [
        dataclasses.replace(nut, material=NUT_MATERIAL, colour=_SCREW),
        _pin_part(design, layout),
        *_column_parts(layout),
    ]
    runner = pin_runner(design)
    if runner is not None:
        steel, centres = design.reducer.output_pins.material, _pin_positions(layout)
        parts += runner_parts("pin", "sleeve", runner, steel, layout.pack, CARRIER, centres)
    seat = on_axis("output bearing", HOUSING, carrier.bearing_bottom)
    return [
        *parts,
        _bearing_part("output bearing", carrier.output, seat, CARRIER),
        _shims("shaft shim", carrier.shaft_shim, CARRIER, carrier.shaft_seat_top),
        _shims("output shim", carrier.output_shim, HOUSING, carrier.output_seat_top),
    ]


def _shims(name: str, shim: ShimLayout, body: Body, top: float) -> Part:
    """A pack of shims under the face at a height, m; the play lies between it and its bearing."""
    shape = rotating.sleeve(2.0 * shim.inner, 2.0 * shim.outer, shim.pack)
    pieces = on_axis(name, body, top - shim.pack)
    return Part(name, shape, SHIM_MATERIAL, BEARING_COLOUR, "buy", shim.designation, pieces)


def _column_parts(layout: Layout) -> list[Part]:
    columns, pack = layout.carrier.columns, layout.pack
    if columns is None:
        return []
    places = np.array(carrier_features.column_circle(layout.carrier, columns).centres)
    bottom, top = -pack.gap, layout.carrier.plate_bottom
    size = f"{2e3 * columns.radius:.6g} x {2e3 * columns.bore_radius:g} x {1e3 * (top - bottom):g}"
    heads_down = (transform(x=x, y=y, z=columns.seat, turned_over=True) for x, y in places)
    return [
        Part(
            "carrier column",
            carrier_shapes.column_shape(columns, bottom, top),
            COLUMN_MATERIAL,
            BEARING_COLOUR,
            "make",
            f"tube {size} mm, faces ground as one set to one length",
            around("carrier column", CARRIER, places),
            stated=carrier_features.column_features(columns, bottom, top),
        ),
        Part(
            "column screw",
            carrier_shapes.cap_screw_shape(columns.screw),
            SCREW_MATERIAL,
            _SCREW,
            "buy",
            columns.screw.designation,
            placed("column screw", CARRIER, *heads_down),
            catalogue_mass=columns.screw.mass,
        ),
    ]


def _pin_positions(layout: Layout) -> FloatArray:
    return np.array(carrier_features.pin_circle(layout.carrier).centres)


def _pin_part(design: Design, layout: Layout) -> Part:
    carrier = layout.carrier
    pin, length = carrier.pin, carrier.shoulder_top - carrier.shoulder_bottom
    name = "dowel pin" if pin.screw is None else "shoulder screw"
    zone = pin_zone(design.reducer.output_pins)
    if pin.screw is None:
        size = f"{pin.nominal_diameter * 1e3:g} {zone} x {length * 1e3:.4g}"
        bonded = "plate and cap" if carrier.bonded_in_cap else "the plate"
        designation = f"ground dowel {size}, bonded in {bonded}"
    else:
        designation = pin.screw.designation(length)
    return Part(
        name,
        carrier_shapes.pin_shape(carrier),
        design.reducer.output_pins.material,
        _SCREW,
        "make" if pin.screw is None else "buy",
        designation,
        around(name, CARRIER, _pin_positions(layout)),
        stated=()
        if pin.screw
        else pin_features(
            pin.nominal_diameter, carrier.shoulder_bottom, carrier.shoulder_top, zone
        ),
    )


def _housing_parts(design: Design, layout: Layout) -> list[Part]:
    housing, metal = layout.housing, design.housing.material

    def made(name: str, shape: Stack, colour: Colour, features: tuple[Feature, ...]) -> Part:
        how, pieces = made_how(metal, "turned and drilled"), on_axis(name, HOUSING)
        return Part(name, shape, metal, colour, "make", how, pieces, stated=features)

    body, clamp = housing_features(layout), clamp_features(layout)
    if layout.inrunner is not None or (layout.motor is not None and layout.motor.behind):
        assert layout.motor_end is not None
        body += flange_features(layout.motor_end)
    cover = cover_features(layout)
    places = np.array(screw_circle(housing).centres)
    screws = around("cover screw", HOUSING, places, housing.cover_flange_top)
    screw = carrier_shapes.cap_screw_shape(housing.screw)
    how, mass = housing.screw.designation, housing.screw.mass
    return [
        made("housing", _housing_shape(layout, body), _HOUSING, body),
        made("ring clamp", housing_shapes.ring_clamp(layout, clamp), _COVER, clamp),
        made("output cover", housing_shapes.output_cover(layout, cover), _HOUSING, cover),
        Part("cover screw", screw, SCREW_MATERIAL, _SCREW, "buy", how, screws, catalogue_mass=mass),
    ]


def _housing_shape(layout: Layout, features: Sequence[Feature]) -> Stack:
    shape = housing_shapes.housing_body(layout, features)
    motor, inrunner, register = layout.motor, layout.inrunner, layout.housing.register_radius
    if motor is not None and motor.behind:
        shape = with_neck(shape, register, motor, features)
    elif motor is not None:
        shape = with_motor_flange(shape, layout, motor, features)
    elif inrunner is not None:
        shape = with_flange(shape, register, inrunner, features)
    dowels, top = layout.dowels, layout.housing.face
    for holes in ring_dowel_holes(layout.pack, dowels, dowels.bottom, top):
        shape = with_dowel_grooves(shape, layout.pack.ring_radius, holes)
    return shape
