"""What a machine's dowels bear: round the ring, in the output's face, and seats of output pins."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cqdd_design.catalog.dowels import DowelStress, across_a_joint, along_a_seam
from cqdd_design.catalog.materials import find_material
from cqdd_design.gearbox.checks.allowables import Allowable, dowel_limit_seat
from cqdd_design.gearbox.output_pins import shear_stress
from cqdd_design.machine.held_stress import ends_of_pins, pressed_seats
from cqdd_design.machine.machine import Machine


@dataclass(frozen=True)
class LoadedDowels:
    """Some dowels under a torque.

    Attributes
    ----------
    place, size : str
        Where they are, and which, in words.
    torque, across : float
        N m, and a force across the axis from outside, N.
    stress : DowelStress
    seat : Allowable
        Pressure that their seats bear.
    metal : str
        Key of what they sit in.
    wider : str
        What presses less, in words.
    """

    place: str
    size: str
    torque: float
    across: float
    stress: DowelStress
    seat: Allowable
    metal: str
    wider: str = "a larger ring"


def loaded_dowels(machine: Machine) -> tuple[LoadedDowels, ...]:
    """The dowels of a machine at the peak torque; none where nothing has room.

    Raises
    ------
    ContactError
        When the peak torque has no equilibrium.
    GeometryError
        When the machine cannot be laid out.
    """
    layout, design = machine.layout, machine.design
    ring, face = layout.dowels, layout.carrier.flange_dowels
    metal, found = find_material(design.housing.material), []
    asked = design.requirements
    peak, across = asked.peak_torque, asked.external_radial or 0.0
    if ring.radius:
        count, size, torque = len(ring.angles), 2.0 * ring.radius, ring_torque(machine)
        found.append(
            LoadedDowels(
                "ring in its seat",
                f"{count} of {1e3 * size:g} mm x {1e3 * ring.length:g} mm",
                torque,
                0.0,
                along_a_seam(torque, count, layout.pack.ring_radius, size, ring.bearing_length),
                dowel_limit_seat(metal, find_material(design.reducer.ring_material)),
                "housing.material",
            )
        )
    if face.count:
        circle = layout.carrier.bolt_circle_radius
        found.append(
            LoadedDowels(
                "output's face",
                f"{face.count} of {1e3 * face.diameter:g} mm, {1e3 * face.depth:.3g} mm deep",
                peak,
                across,
                # A force across adds to that of the torque where both have one direction.
                across_a_joint(
                    peak + across * circle, face.count, circle, face.diameter, face.depth
                ),
                dowel_limit_seat(find_material(design.carrier_material)),
                "carrier.material",
            )
        )
    return tuple(found)


def loaded_pin_seats(machine: Machine) -> tuple[LoadedDowels, ...]:
    """The output pins of a machine at the peak torque, each as its seat alone holds its end.

    None where the pins' moments are not known. Errors are those of :func:`loaded_dowels`.
    """
    if machine.contact.pin is None:
        return ()
    peak = machine.design.requirements.peak_torque
    metal = find_material(machine.design.carrier_material)
    return tuple(
        LoadedDowels(
            f"output pins in the {one.part}",
            f"{1e3 * one.diameter:g} mm, {1e3 * one.depth:.3g} mm deep",
            peak,
            0.0,
            DowelStress(float(shear_stress(one.force, one.diameter)), one.pressure),
            dowel_limit_seat(metal),
            "carrier.material",
            "more or thicker output_pins",
        )
        for one in pressed_seats(machine, ends_of_pins(machine.peak_sweeps))
    )


def ring_torque(machine: Machine) -> float:
    """Greatest torque on the ring at the peak torque, N m: the output's and the crank's.

    Raises
    ------
    ContactError
        When the peak torque has no equilibrium.
    """
    crank = np.abs(machine.peak_pack.torque.sum(axis=2)).max()
    return float(machine.design.requirements.peak_torque + crank)
