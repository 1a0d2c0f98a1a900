"""The joint of a third disc's loose cam on the eccentric shaft: its torque, and the cam's stress.

A disc's force on its eccentric acts at the eccentric's axis, off the shaft's by the eccentricity:
about the shaft's axis it is a torque, all of which goes through the cam's joint (static
equilibrium of the cam; its bearing rolls).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cqdd_design.catalog.adhesives import joint_shear
from cqdd_design.catalog.bearings import shaft_material
from cqdd_design.catalog.fits import fit_limits
from cqdd_design.catalog.materials import Material, find_material
from cqdd_design.gearbox.eccentric_ring import PressedRing, pressed_ring
from cqdd_design.gearbox.pack_loads import PackLoads
from cqdd_design.machine.machine import Machine
from cqdd_design.machine.shaft import disc_heights
from cqdd_design.solids.features import zones
from cqdd_design.solids.registers import LEAD_IN


@dataclass(frozen=True)
class LooseCam:
    """A cam that is pressed and bonded on the shaft.

    Attributes
    ----------
    diameter, length : float
        Of the joint, its length between the chamfers of the bore, m.
    place : int
        Of its disc in the loads of a pack.
    material : Material
        Of the cam, and of the shaft.
    least_interference, most_interference : float
        Of its press fit by the zones that are drawn, m on the diameter; negative is play.
    lobe, throw : float
        Diameter of its outside, and how far that stands off the shaft's axis, m.
    """

    diameter: float
    length: float
    place: int
    material: Material
    least_interference: float
    most_interference: float
    lobe: float
    throw: float

    @property
    def wall(self) -> float:
        """Between bore and outside where it is thinnest, m."""
        return 0.5 * (self.lobe - self.diameter) - self.throw

    def pressed(self) -> PressedRing:
        """Stress and growth in the tightest fit. Cam and shaft are of one steel, and as warm."""
        return pressed_ring(
            0.5 * self.diameter, 0.5 * self.lobe, self.throw, self.most_interference, self.material
        )

    def push(self, loads: PackLoads) -> float:
        """Most pressure of its disc's force on the joint, as a cosine about half of it, Pa."""
        most = float(np.abs(loads.turning[:, :, self.place]).max())
        return 4.0 * most / (math.pi * self.diameter * self.length)

    def torque(self, loads: PackLoads) -> float:
        """Greatest torque about the shaft's axis in the joint over cases and crank angles, N m."""
        return float(np.abs(loads.torque[:, :, self.place]).max())

    def shear(self, torque: float) -> float:
        """Mean shear stress of the joint under a torque (N m), Pa."""
        return joint_shear(torque, self.diameter, self.length)


def loose_cam(machine: Machine) -> LooseCam | None:
    """The loose cam of a machine; None where every eccentric is one piece with the shaft.

    Raises
    ------
    GeometryError
        When the machine cannot be laid out.
    CatalogError
        When no zone is known for the diameter.
    """
    pack, shaft = machine.layout.pack, machine.layout.shaft
    if pack.disc_count < 3:
        return None
    bottom, top, size = pack.cam_top(1), pack.cam_top(2), 2.0 * shaft.shoulder_radius
    middles = disc_heights(pack)
    hole, core = fit_limits(zones.CAM_BORE, size), fit_limits(zones.PRESSED_CAM, size)
    return LooseCam(
        diameter=size,
        length=top - bottom - 2.0 * LEAD_IN,
        place=int(np.argmax(middles)),
        material=find_material(shaft_material(pack.cam.bearing)),
        least_interference=core.lower - hole.upper,
        most_interference=core.upper - hole.lower,
        lobe=pack.cam.bearing.bore_diameter,
        throw=pack.eccentricity,
    )
