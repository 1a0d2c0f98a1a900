"""Parts of the motor, its bell and cover, and the encoder."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from cqdd_design.catalog.adhesives import ROTOR_COMPOUND
from cqdd_design.catalog.dowels import MATERIAL as DOWEL_MATERIAL
from cqdd_design.catalog.encoders import magnets_of, sensors_with
from cqdd_design.catalog.motors import Motor
from cqdd_design.catalog.printing import made_how
from cqdd_design.design import Design
from cqdd_design.results import MassProperties
from cqdd_design.solids import encoder_shapes, motor_shapes
from cqdd_design.solids.carrier import cap_screw_shape
from cqdd_design.solids.features.holes import BoltCircle
from cqdd_design.solids.features.housing import ear_circle
from cqdd_design.solids.features.kinds import Feature
from cqdd_design.solids.features.motor import (
    bell_features,
    board_circle,
    board_features,
    cover_features,
    flanged_cover_features,
)
from cqdd_design.solids.flanged_can import flanged_can
from cqdd_design.solids.inertia import BELL, ROTOR
from cqdd_design.solids.layers import Stack
from cqdd_design.solids.layout import Layout
from cqdd_design.solids.motor_layout import MotorEnd, MotorLayout
from cqdd_design.solids.motor_rules import bell_material
from cqdd_design.solids.part import Colour, Part, Source, around, on_axis, placed
from cqdd_design.solids.poses import HOUSING, SHAFT, Body, transform
from cqdd_design.solids.selection import CapScrew

COVER_SCREW = "motor cover screw"
STATOR_MATERIAL = "Electrical steel M400-50A"
MAGNET_MATERIAL = "NdFeB N42"
ENCODER_MAGNET_MATERIAL = "NdFeB N35H"
BOARD_MATERIAL = "FR-4 glass epoxy"

_ROTOR_SHARE, LEAST_STATOR = 0.4, 0.05
"""Of a motor's mass: a rotor of unknown inertia, and the least that is left to the stator."""

_STATOR: Colour = (0.72, 0.45, 0.20)
_ROTOR: Colour = (0.30, 0.31, 0.34)
_BELL: Colour = (0.62, 0.65, 0.70)
_COVER: Colour = (0.40, 0.44, 0.50)
_MAGNET: Colour = (0.80, 0.80, 0.82)
_BOARD: Colour = (0.10, 0.40, 0.22)
_SCREW: Colour = (0.16, 0.17, 0.19)
_STEEL: Colour = (0.78, 0.80, 0.82)


def motor_parts(design: Design, layout: Layout, fastener: str) -> list[Part]:
    """Every part of an outrunner's end; none when there is none.

    Parameters
    ----------
    fastener : str
        Material of screws.
    """
    motor = layout.motor
    if motor is None:
        return []
    row, metal, unit = layout.motor_row, design.housing.material, layout.unit
    stub = 0.5 * layout.shaft.support.bearing.bore_diameter
    on_bell = bell_features(motor, stub)
    if motor.behind:
        on_cover = flanged_cover_features(motor, unit)
        cover, screws = flanged_can(motor, unit, on_cover), screws_below(motor, fastener)
    else:
        on_cover = cover_features(motor, motor.joint, unit)
        cover = motor_shapes.motor_cover(motor, motor.joint, unit, on_cover)
        screws = _screws(
            COVER_SCREW, motor.cover_screw, fastener, ear_circle(motor), motor.flange_top
        )
    bell = piece(
        BELL, motor_shapes.bell(motor, stub, on_bell), bell_material(design), _BELL,
        "cup of the motor's rotor, turned and drilled, bonded on the shaft and to the magnets with "
        f"{ROTOR_COMPOUND.name}",
        body=SHAFT, make=True, features=on_bell,
    )  # fmt: skip
    masses = _motor_masses(row, motor, bell.exact_properties)
    return [
        *magnetic_circuit(row, motor_shapes.stator(motor), motor_shapes.rotor(motor),
                          masses.stator, masses.magnets),
        replace(bell, catalogue_mass=masses.bell),
        motor_cover_part(cover, metal, on_cover),
        *encoder_parts(design, motor, fastener),
        screws,
    ]  # fmt: skip


def piece(
    name: str,
    shape: Stack,
    material: str,
    colour: Colour,
    designation: str,
    *,
    body: Body = HOUSING,
    z: float = 0.0,
    make: bool = False,
    mass: float | None = None,
    features: tuple[Feature, ...] = (),
) -> Part:
    """A part of the motor's end that there is once, on the axis of its body."""
    source: Source = "make" if make else "buy"
    pieces = on_axis(name, body, z)
    return Part(name, shape, material, colour, source, designation, pieces, mass, stated=features)


def magnetic_circuit(
    row: Motor, stator: Stack, rotor: Stack, stator_mass: float, rotor_mass: float
) -> list[Part]:
    """Stator and ring of magnets, as the maker sells them; masses in kg."""
    return [
        piece("motor stator", stator, STATOR_MATERIAL, _STATOR, f"{row.name}, stator",
              mass=stator_mass),
        piece(ROTOR, rotor, MAGNET_MATERIAL, _ROTOR,
              f"{row.name}, ring of magnets with its back iron", body=SHAFT, mass=rotor_mass),
    ]  # fmt: skip


def motor_cover_part(shape: Stack, metal: str, features: tuple[Feature, ...]) -> Part:
    """The cover with its dish."""
    how = made_how(metal, "turned and milled")
    return piece("motor cover", shape, metal, _COVER, how, make=True, features=features)


def encoder_parts(design: Design, motor: MotorEnd, fastener: str) -> list[Part]:
    """Magnet, board and its screws, of a material."""
    on_board = board_features(motor)
    bits = design.drive.encoder_bits
    sensors = sensors_with(bits, beside=motor.open)
    board_name = next((one.name for one in sensors), f"magnetic encoder, {bits} bits")
    if motor.open:
        magnet_name = (
            f"ring magnet {ENCODER_MAGNET_MATERIAL}, magnetised across, "
            f"{2e3 * motor.magnet_radius:g} x {2e3 * motor.magnet_inner:g} x "
            f"{motor.magnet_height * 1e3:g} mm"
        )
    else:
        magnets = magnets_of(2.0 * motor.magnet_radius, motor.magnet_height)
        size = f"{2e3 * motor.magnet_radius:g} x {motor.magnet_height * 1e3:g} mm"
        magnet_name = (
            magnets[0].name if magnets else f"diametric magnet {ENCODER_MAGNET_MATERIAL} {size}"
        )
    magnet, board = encoder_shapes.encoder_magnet(motor), encoder_shapes.encoder_board
    return [
        piece("encoder magnet", magnet, ENCODER_MAGNET_MATERIAL, _MAGNET, magnet_name,
              body=SHAFT, z=motor.magnet_bottom),
        piece("encoder board", board(motor, on_board), BOARD_MATERIAL, _BOARD, board_name,
              features=on_board),
        _screws("encoder screw", motor.board_screw, fastener, board_circle(motor), motor.board_top),
    ]  # fmt: skip


class _Masses(NamedTuple):
    """Masses of the motor's parts, kg; a bell of None weighs what is drawn."""

    stator: float
    magnets: float
    bell: float | None


def _motor_masses(row: Motor, motor: MotorLayout, bell: MassProperties) -> _Masses:
    """Split the catalogue's motor over the parts that stand for it.

    Magnets and bell together have the catalogue's rotor inertia, and with the stator its mass: a
    maker's rotor is magnets in their cup. The bell weighs what is drawn, and no more than half of
    the rotor. Without a rotor inertia the rotor is two fifths of the motor's mass, as is usual for
    outrunners.
    """
    whole = row.mass or 0.0
    own = float(bell.inertia[2, 2])
    square = 0.5 * (motor.rotor_inner**2 + motor.rotor_outer**2)
    if row.rotor_inertia is None:
        rotor = row.rotor_mass or _ROTOR_SHARE * whole
        part = min(1.0, 0.5 * rotor / bell.mass)
        magnets = rotor - part * bell.mass
    else:
        part = min(1.0, 0.5 * row.rotor_inertia / own)
        magnets = (row.rotor_inertia - part * own) / square
    carried = part * bell.mass
    stator = max(whole - magnets - carried, LEAST_STATOR * whole)
    return _Masses(stator, magnets, carried if part < 1.0 else None)


def _screws(name: str, screw: CapScrew, material: str, circle: BoltCircle, height: float) -> Part:
    """Cap screws of the housing on a circle, their heads on a height, m."""
    pieces = around(name, HOUSING, np.array(circle.centres), height)
    shape = cap_screw_shape(screw)
    how = screw.designation
    return Part(name, shape, material, _SCREW, "buy", how, pieces, catalogue_mass=screw.mass)


def screws_below(motor: MotorEnd, material: str) -> Part:
    """Screws of a cover with their heads under its ears, threads in the housing's flange."""
    screw = motor.cover_screw
    heads = (
        transform(x=x, y=y, z=motor.joint - motor.ear_height, turned_over=True)
        for x, y in np.array(ear_circle(motor).centres)
    )
    return Part(COVER_SCREW, cap_screw_shape(screw), material, _SCREW, "buy", screw.designation,
                placed(COVER_SCREW, HOUSING, *heads), catalogue_mass=screw.mass)  # fmt: skip


def dowel_part(layout: Layout) -> list[Part]:
    """The dowels between ring and housing; none where there is no room."""
    dowels, radius = layout.dowels, layout.pack.ring_radius
    if dowels.radius <= 0.0:
        return []
    size = f"{2e3 * dowels.radius:g} m6 x {dowels.length * 1e3:g} A"
    places = (transform(angle, *_on(radius, angle), dowels.bottom) for angle in dowels.angles)
    return [
        Part(
            "ring dowel",
            motor_shapes.dowel(dowels),
            DOWEL_MATERIAL,
            _STEEL,
            "buy",
            f"ISO 8734 {size}",
            placed("ring dowel", HOUSING, *places),
        )
    ]


def _on(radius: float, angle: float) -> tuple[float, float]:
    return radius * math.cos(angle), radius * math.sin(angle)
