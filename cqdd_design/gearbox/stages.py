"""What the rigid law needs of a design, read once: lengths, counts, elastic moduli, fits."""

from __future__ import annotations

from dataclasses import dataclass

from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.errors import GeometryError
from cqdd_design.gearbox import hertz, rigid
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.disc import hole_diameter
from cqdd_design.geometry.output_pins import mean_pin_diameter
from cqdd_design.geometry.runners import pin_runner, ring_runner


@dataclass(frozen=True, eq=False)
class Stages:
    """What the rigid law needs of a design, SI.

    Attributes
    ----------
    lobe_count, disc_count, pin_count : int
        n, D, N_w.
    ring_pitch_radius, eccentricity, tooth_radius : float
        R, e, r.
    pin_circle_radius, hole_clocking : float
        R_w and the angle of the first hole from the valley on +x.
    pin_contact_radius, hole_radius : float
        Radius of pin (its mean diameter) or sleeve, and of the hole.
    contact_length : float
        Disc thickness.
    ring_modulus, pin_modulus : float
        E* of tooth on disc and of pin on disc.
    """

    lobe_count: int
    disc_count: int
    pin_count: int
    ring_pitch_radius: float
    eccentricity: float
    tooth_radius: float
    pin_circle_radius: float
    hole_clocking: float
    pin_contact_radius: float
    hole_radius: float
    contact_length: float
    ring_modulus: float
    pin_modulus: float

    @classmethod
    def from_design(cls, design: Design) -> Stages:
        """Read a design; a sleeve is taken to be of the pin's material."""
        reducer, pins = design.reducer, design.reducer.output_pins
        contact_diameter = pins.sleeve_diameter or mean_pin_diameter(pins)
        hole = hole_diameter(design)
        _refuse_tight_hole(design, contact_diameter, hole)
        disc = find_material(reducer.disc_material)
        return cls(
            lobe_count=reducer.ratio,
            disc_count=reducer.disc_count,
            pin_count=pins.count,
            ring_pitch_radius=reducer.ring_pitch_radius,
            eccentricity=reducer.eccentricity,
            tooth_radius=0.5 * reducer.tooth_diameter,
            pin_circle_radius=pins.circle_radius,
            hole_clocking=pins.hole_clocking,
            pin_contact_radius=0.5 * contact_diameter,
            hole_radius=0.5 * hole,
            contact_length=reducer.disc_thickness,
            ring_modulus=hertz.pair_modulus(disc, find_material(reducer.ring_material)),
            pin_modulus=hertz.pair_modulus(disc, find_material(pins.material)),
        )

    @property
    def phases(self) -> FloatArray:
        """Crank phases of the discs, (D,)."""
        return kinematics.crank_phases(self.disc_count)

    def disc_clocking(self, phase: float) -> float:
        """Clocking of the holes of the disc at crank phase `phase`, in its own lobe frame."""
        return float(kinematics.hole_clocking_in_disc(self.lobe_count, self.hole_clocking, phase))

    def ring_forces(self, disc_torque: float, disc_angle: FloatArray) -> FloatArray:
        """Return (A, n+1) forces on one disc at its own crank angle, N."""
        return rigid.ring_forces(
            self.lobe_count, self.ring_pitch_radius, self.eccentricity, disc_torque, disc_angle
        )

    def ring_pressures(self, force: FloatArray, disc_angle: FloatArray) -> FloatArray:
        """Hertz pressures (A, n+1) of ring forces at the same angles, Pa."""
        curvature = rigid.ring_contact_curvature(
            self.lobe_count, self.ring_pitch_radius, self.eccentricity, disc_angle
        )
        radius = hertz.ring_equivalent_radius(self.tooth_radius, curvature)
        return hertz.line_contact_pressure(force, self.contact_length, radius, self.ring_modulus)

    def ring_radial_force(self, disc_torque: float, disc_angle: FloatArray) -> FloatArray:
        """Ring resultant (A,) along the crank, N."""
        return rigid.ring_radial_force(
            self.lobe_count, self.ring_pitch_radius, self.eccentricity, disc_torque, disc_angle
        )

    def pin_forces(
        self, disc_torque: float, disc_angle: FloatArray, disc_clocking: float
    ) -> FloatArray:
        """Return (A, N_w) forces on one disc at its own crank angle, N."""
        return rigid.output_pin_forces(
            self.lobe_count,
            self.pin_count,
            self.pin_circle_radius,
            disc_torque,
            disc_angle,
            disc_clocking,
        )

    def pin_pressures(self, force: FloatArray) -> FloatArray:
        """Hertz pressures of pin forces in their holes, Pa."""
        radius = hertz.conformal_equivalent_radius(self.pin_contact_radius, self.hole_radius)
        return hertz.line_contact_pressure(force, self.contact_length, radius, self.pin_modulus)

    def cam_loads(
        self, disc_torque: float, disc_angle: FloatArray, disc_clocking: float
    ) -> FloatArray:
        """Cam bearing load (A, 2) on one disc in its crank's frame, N."""
        radial = self.ring_radial_force(disc_torque, disc_angle)
        pins = self.pin_forces(disc_torque, disc_angle, disc_clocking).sum(axis=-1)
        return rigid.cam_load(self.lobe_count, self.eccentricity, disc_torque, radial, pins)


def _refuse_tight_hole(design: Design, contact_diameter: float, hole: float) -> None:
    """Raise where sleeve or roller does not go over its pin, or the hole over what runs in it."""
    pins = design.reducer.output_pins
    pin_runner(design)
    ring_runner(design)
    if hole <= contact_diameter:
        raise GeometryError(
            f"output_pins.hole_clearance {pins.hole_clearance * 1e6:g} um makes the holes no "
            f"larger than the {contact_diameter * 1e3:g} mm pins in them; raise it above "
            f"{-2e6 * design.reducer.eccentricity:g} um."
        )
