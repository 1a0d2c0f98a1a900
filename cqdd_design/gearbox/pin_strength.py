"""Strength of a design's output pins: the paper's figure, shared capacity, stresses."""

from __future__ import annotations

import math
from dataclasses import dataclass

from cqdd_design.catalog.materials import Material, find_material
from cqdd_design.design import Design
from cqdd_design.errors import DesignError
from cqdd_design.gearbox import output_pins, rigid
from cqdd_design.gearbox.carrier import design_bending_arm
from cqdd_design.gearbox.checks import allowables
from cqdd_design.gearbox.loads import RigidMaxima


@dataclass(frozen=True)
class PinStrength:
    """Output pins of a design, raw: no factor for uneven sharing in any number.

    Attributes
    ----------
    diameter : float
        Nominal diameter d, m; strength counts with it, as screw tables do.
    span, bending_arm : float
        Free length L between the carrier plates, and bending moment per newton by
        :func:`.carrier.design_bending_arm`, m.
    peak_force_factor : float
        k of F = k T/(D N_w R_w).
    paper_shear : float
        Half of the ultimate strength, Pa.
    paper_torque_per_pin, paper_torque_total : float
        By the paper's method, N m.
    shared_torque_capacity : float
        Torque at which the most loaded pin reaches `paper_shear`, N m.
    bending_torque_capacity : float
        Torque at which it reaches the bending limit for the peak torque, N m.
    bending_stress_peak, bending_stress_continuous, shear_stress_peak, bearing_pressure_peak : float
        Pa.
    duty_reverses : bool
        Whether the design's duty has both senses of torque.
    """

    diameter: float
    span: float
    bending_arm: float
    peak_force_factor: float
    paper_shear: float
    paper_torque_per_pin: float
    paper_torque_total: float
    shared_torque_capacity: float
    bending_torque_capacity: float
    bending_stress_peak: float
    bending_stress_continuous: float
    shear_stress_peak: float
    bearing_pressure_peak: float
    duty_reverses: bool

    def to_dict(self) -> dict[str, float]:
        """Return the JSON form (``output_pins``)."""
        return {
            "paper_torque_per_pin_Nm": self.paper_torque_per_pin,
            "paper_torque_total_Nm": self.paper_torque_total,
            "paper_shear_MPa": self.paper_shear / 1e6,
            "shared_torque_capacity_Nm": self.shared_torque_capacity,
            "bending_torque_capacity_Nm": self.bending_torque_capacity,
            "bending_stress_max_MPa": self.bending_stress_peak / 1e6,
            "bending_stress_continuous_MPa": self.bending_stress_continuous / 1e6,
            "shear_stress_max_MPa": self.shear_stress_peak / 1e6,
            "bearing_pressure_max_MPa": self.bearing_pressure_peak / 1e6,
            "span_mm": self.span * 1e3,
            "bending_arm_mm": self.bending_arm * 1e3,
            "peak_force_factor": self.peak_force_factor,
        }


def _ultimate(material: Material) -> float:
    if material.ultimate_strength is None:
        raise DesignError(
            f"output_pins.material '{material.name}' has no ultimate strength in the catalogue; "
            "choose a pin material that has one, such as 'Alloy steel 12.9 (ISO 7379)'."
        )
    return material.ultimate_strength


def pin_strength(design: Design, peak: RigidMaxima, continuous: RigidMaxima) -> PinStrength:
    """Strength of the output pins of a design.

    Parameters
    ----------
    design : Design
        For the pins, discs and duty.
    peak, continuous : RigidMaxima
        At the peak and at the continuous torque.

    Raises
    ------
    DesignError
        When the pins' material has no ultimate strength in the catalogue.
    """
    reducer, pins = design.reducer, design.reducer.output_pins
    material = find_material(pins.material)
    d, b = pins.diameter, reducer.disc_thickness
    factor = rigid.peak_pin_force_factor(pins.count)
    arm = design_bending_arm(design)
    paper_shear = allowables.PAPER_SHEAR_SHARE * _ultimate(material)
    per_pin = float(output_pins.single_shear_torque_per_pin(d, paper_shear, pins.circle_radius))
    bending_limit = allowables.pin_limit_peak(material).value
    senses = [point.torque for point in design.requirements.load_cases]

    def capacity(force: float) -> float:
        return float(
            output_pins.shared_torque_capacity(
                reducer.disc_count, pins.count, pins.circle_radius, force, factor
            )
        )

    return PinStrength(
        diameter=d,
        span=float(output_pins.pin_span(reducer.disc_count, b, reducer.disc_spacing)),
        bending_arm=arm,
        peak_force_factor=factor,
        paper_shear=paper_shear,
        paper_torque_per_pin=per_pin,
        paper_torque_total=pins.count * per_pin,
        shared_torque_capacity=capacity(math.pi / 4.0 * d**2 * paper_shear),
        bending_torque_capacity=capacity(math.pi / 32.0 * d**3 * bending_limit / arm),
        bending_stress_peak=float(output_pins.bending_stress(peak.output_pin_force, arm, d)),
        bending_stress_continuous=float(
            output_pins.bending_stress(continuous.output_pin_force, arm, d)
        ),
        shear_stress_peak=float(output_pins.shear_stress(peak.output_pin_force, d)),
        bearing_pressure_peak=float(
            output_pins.bearing_pressure(peak.output_pin_force, max(d, pins.sleeve_diameter), b)
        ),
        duty_reverses=min(senses, default=0.0) < 0.0 < max(senses, default=0.0),
    )
