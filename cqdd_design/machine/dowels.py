"""What a machine's dowels bear: those round the ring, and those of the output's face."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cqdd_design.catalog.dowels import DowelStress, across_a_joint, along_a_seam
from cqdd_design.catalog.materials import find_material
from cqdd_design.gearbox.checks.allowables import Allowable, dowel_limit_seat
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
    """

    place: str
    size: str
    torque: float
    across: float
    stress: DowelStress
    seat: Allowable
    metal: str


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


def ring_torque(machine: Machine) -> float:
    """Greatest torque on the ring at the peak torque, N m: the output's and the crank's.

    Raises
    ------
    ContactError
        When the peak torque has no equilibrium.
    """
    crank = np.abs(machine.peak_pack.torque.sum(axis=2)).max()
    return float(machine.design.requirements.peak_torque + crank)
