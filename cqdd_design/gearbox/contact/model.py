"""What the contact equilibrium needs of a design, read once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cqdd_design.catalog.bearings import find_bearing
from cqdd_design.catalog.materials import Material, find_material
from cqdd_design.catalog.screws import mean_pin_diameter
from cqdd_design.design import Design
from cqdd_design.gearbox.contact import laws
from cqdd_design.gearbox.contact.laws import Bodies, CamSpring, LineLaw, LineModel
from cqdd_design.gearbox.contact.pin_beam import HELD, pin_in_stack, pin_section
from cqdd_design.gearbox.hertz import conformal_equivalent_radius
from cqdd_design.gearbox.output_pins import sleeve_share
from cqdd_design.gearbox.stages import Stages
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.cycloid import CycloidDisc


@dataclass(frozen=True, eq=False)
class ContactModel(Stages):
    """A gearbox as the contact equilibrium sees it: its stages and how they yield, SI.

    Attributes
    ----------
    disc : CycloidDisc
        Finished outline.
    ring_law, pin_law : LineLaw
        Law of either line contact.
    ring_bodies, pin_bodies : Bodies
        Of tooth and disc, and of pin and disc.
    pin_series : array (D,)
        Compliance of a pin at every disc, m/N.
    cam : CamSpring
        Between bore and cam.
    tooth_friction, hole_friction : float
        Coulomb friction at ring teeth, and at the walls of the holes: that of plain pins, or what
        sleeves leave of it (a sleeve turns where the moments of both of its faces balance,
        t r_sleeve = mu F r_pin).
    carrier_stiffness : float or None
        Radial stiffness of the carrier's bearing, N/m; None where it is rigid.
    """

    disc: CycloidDisc
    ring_law: LineLaw
    pin_law: LineLaw
    ring_bodies: Bodies
    pin_bodies: Bodies
    pin_series: FloatArray
    cam: CamSpring
    tooth_friction: float
    hole_friction: float
    carrier_stiffness: float | None = None

    @classmethod
    def from_design(cls, design: Design, line_model: LineModel = "palmgren") -> ContactModel:
        """Read a design that names its cam bearing; a sleeve is of the pin's material.

        Parameters
        ----------
        line_model : {"palmgren", "johnson", "linear"}
            Approach of teeth and pins. ``linear`` takes the secant of Palmgren's law at 50 N/mm.

        Raises
        ------
        GeometryError
            When disc or holes cannot exist.
        """
        reducer, pins = design.reducer, design.reducer.output_pins
        disc = CycloidDisc.from_design(design)
        stages = Stages.from_design(design)
        bearing = find_bearing(reducer.cam_bearing.designation)
        steel = find_material(reducer.disc_material)
        tooth = find_material(reducer.ring_material)
        pin = find_material(pins.material)
        plate = find_material(design.housing.material)
        behind_flank = disc.valley_distance - 0.5 * bearing.outer_diameter
        ring_bodies = (
            _body(0.5 * reducer.ring_pin_diameter, tooth),
            _body(max(behind_flank, 0.5 * reducer.ring_pin_diameter), steel),
        )
        pin_bodies = (_body(stages.pin_contact_radius, pin), _body(stages.hole_radius, steel))
        logarithms = (0.0, 0.0)
        if line_model == "johnson":
            length = reducer.disc_thickness
            logarithms = (
                laws.johnson_coefficients(length, 1.0, stages.ring_modulus, ring_bodies)[1],
                laws.johnson_coefficients(length, 1.0, stages.pin_modulus, pin_bodies)[1],
            )
        beam = pin_in_stack(
            reducer.disc_count,
            reducer.disc_thickness,
            reducer.disc_spacing,
            pin_section(pins.diameter, pin.youngs_modulus, pin.poisson_ratio, plate.youngs_modulus),
            HELD[pins.support],
        )
        return cls(
            **vars(stages),
            disc=disc,
            ring_law=LineLaw(line_model, logarithms[0]),
            pin_law=LineLaw(line_model, logarithms[1]),
            ring_bodies=ring_bodies,
            pin_bodies=pin_bodies,
            pin_series=np.diag(beam.influence).copy(),
            cam=laws.cam_spring(bearing, reducer.cam_bearing.radial_clearance),
            tooth_friction=reducer.friction.tooth,
            hole_friction=reducer.friction.pin
            * sleeve_share(mean_pin_diameter(pins.diameter), pins.sleeve_diameter),
            carrier_stiffness=reducer.carrier_bearing.stiffness or None,
        )

    @property
    def tooth_count(self) -> int:
        """Ring teeth n + 1."""
        return self.lobe_count + 1

    @property
    def pin_gap(self) -> float:
        """Gap at an output pin in the nominal pose, half of the hole clearance, m."""
        return self.hole_radius - self.pin_contact_radius - self.eccentricity

    @property
    def pin_equivalent_radius(self) -> float:
        """R_eq of pin in hole, m."""
        return float(conformal_equivalent_radius(self.pin_contact_radius, self.hole_radius))

    def ring_coefficient(self, equivalent_radius: FloatArray) -> FloatArray:
        """Coefficient of the ring's law for contacts of the given R_eq (m)."""
        return self._coefficient(
            self.ring_law, equivalent_radius, self.ring_modulus, self.ring_bodies
        )

    def pin_coefficient(self) -> float:
        """Coefficient of the pins' law."""
        radius = np.asarray(self.pin_equivalent_radius)
        return float(self._coefficient(self.pin_law, radius, self.pin_modulus, self.pin_bodies))

    def _coefficient(
        self, law: LineLaw, equivalent_radius: FloatArray, modulus: float, bodies: Bodies
    ) -> FloatArray:
        if law.model == "johnson":
            return laws.johnson_coefficients(
                self.contact_length, equivalent_radius, modulus, bodies
            )[0]
        c = laws.palmgren_coefficient(self.contact_length, modulus)
        if law.model == "linear":
            # Palmgren's secant at a line load of 50 N/mm, a usual one at the rated torque.
            c *= (LINE_LOAD * self.contact_length) ** -0.1
        return np.full(np.shape(equivalent_radius), c)


LINE_LOAD = 50e3
"""Line load at which the linear law has Palmgren's secant stiffness, N/m."""


def _body(depth: float, material: Material) -> tuple[float, float, float]:
    return depth, material.youngs_modulus, material.poisson_ratio
