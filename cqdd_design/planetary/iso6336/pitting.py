"""ISO 6336-2: contact stress and the stress the flanks can bear (pitting)."""

from __future__ import annotations

import math

from cqdd_design.planetary.gear_material import GearMaterial
from cqdd_design.planetary.tooth_geometry import GearPair

#: Load cycles up to which pitting strength is static, and at which it reaches sigma_Hlim (Table 2,
#: steels through-, case- or induction-hardened, no pitting allowed).
STATIC_CYCLES, REFERENCE_CYCLES = 1e5, 5e7
#: Z_NT at static strength, and at 1e10 cycles.
STATIC_LIFE_FACTOR, LONG_LIFE_FACTOR, LONG_CYCLES = 1.6, 0.85, 1e10


def zone_factor(pair: GearPair) -> float:
    """Z_H = sqrt(2 cos(beta_b) cos(alpha_wt)/(cos^2(alpha_t) sin(alpha_wt))), 6.1, eq. 15.

    Examples
    --------
    >>> round(zone_factor(GearPair(12, 36, 1e-3, 12e-3)), 3)
    2.495
    """
    alpha, working = pair.transverse_pressure_angle, pair.working_pressure_angle
    top = 2.0 * math.cos(pair.base_helix_angle) * math.cos(working)
    return math.sqrt(top / (math.cos(alpha) ** 2 * math.sin(working)))


def elasticity_factor(pinion: GearMaterial, wheel: GearMaterial) -> float:
    """Z_E = sqrt(1/(pi sum (1 - nu^2)/E)), sqrt(Pa), clause 7, eq. 19."""
    compliance = sum(
        (1.0 - gear.poisson_ratio**2) / gear.youngs_modulus for gear in (pinion, wheel)
    )
    return math.sqrt(1.0 / (math.pi * compliance))


def contact_ratio_factor(pair: GearPair) -> float:
    """Z_eps, clause 8, eq. 20 to 23: spur, helical, and between for eps_beta < 1.

    Examples
    --------
    >>> round(contact_ratio_factor(GearPair(12, 36, 1e-3, 12e-3)), 3)
    0.903
    """
    transverse, overlap = pair.transverse_contact_ratio, pair.overlap_ratio
    if overlap >= 1.0:
        return math.sqrt(1.0 / transverse)
    # Beyond eps_alpha = 2 two pairs always share; the spur formula stays valid to 2.5 (eq. 20).
    return math.sqrt((4.0 - transverse) / 3.0 * (1.0 - overlap) + overlap / transverse)


def helix_factor(pair: GearPair) -> float:
    """Z_beta = 1/sqrt(cos(beta)), clause 9, eq. 24 of the 2006 corrigendum (2019: eq. 25)."""
    return 1.0 / math.sqrt(math.cos(pair.helix_angle))


def single_pair_factors(pair: GearPair) -> tuple[float, float]:
    """Z_B of the pinion and Z_D of the wheel, 6.2, eq. 17 and 18; at least 1.

    They move the stress from the pitch point to the inner point of single pair contact. Helical
    gears with eps_beta >= 1 need neither; below 1 the excess is interpolated. A ring's Z_D is 1.

    Examples
    --------
    >>> [round(z, 3) for z in single_pair_factors(GearPair(12, 36, 1e-3, 12e-3))]
    [1.227, 1.0]
    """
    ratio = pair.transverse_contact_ratio
    rolls = []
    for teeth, tip in zip(pair.teeth, pair.tip_diameters, strict=True):
        base = pair.base_diameter(teeth)
        rolls.append((math.sqrt((tip / base) ** 2 - 1.0), 2.0 * math.pi / teeth))
    (roll_1, pitch_1), (roll_2, pitch_2) = rolls
    tangent = math.tan(pair.working_pressure_angle)
    factors = []
    for near, far in (
        (roll_1 - pitch_1, roll_2 - (ratio - 1.0) * pitch_2),
        (roll_2 - pitch_2, roll_1 - (ratio - 1.0) * pitch_1),
    ):
        # A point off the involute (undercut, interference) has no radius; the pitch point then
        # decides and the rating's warnings say so.
        curvature = near * far
        factor = tangent / math.sqrt(curvature) if near > 0.0 and far > 0.0 else 1.0
        excess = max(factor - 1.0, 0.0)
        factors.append(1.0 + excess * max(1.0 - pair.overlap_ratio, 0.0))
    return factors[0], 1.0 if pair.internal else factors[1]


def nominal_contact_stress(
    pair: GearPair, tangential: float, elasticity: float, *, at_pitch_point: bool = False
) -> float:
    """sigma_H0 = Z_H Z_E Z_eps Z_beta sqrt(F_t/(d1 b) (u + 1)/u), Pa, 5.2, eq. 6.

    Parameters
    ----------
    tangential : float
        Nominal F_t of one mesh, N.
    elasticity : float
        Z_E, sqrt(Pa).
    at_pitch_point : bool
        Leave Z_eps and Z_beta out: the Hertz pressure of ONE pair of teeth at the pitch point.
    """
    u = pair.gear_ratio
    load = tangential / (pair.reference_diameter(pair.pinion_teeth) * pair.face_width)
    stress = zone_factor(pair) * elasticity * math.sqrt(load * (u + 1.0) / u)
    if at_pitch_point:
        return stress
    return stress * contact_ratio_factor(pair) * helix_factor(pair)


def lubricant_factor(contact_limit: float, viscosity: float) -> float:
    """Z_L = C + 4 (1 - C)/(1.2 + 134/nu_40)^2, 12.3.1, eq. 37 to 40, nu_40 in mm^2/s.

    Parameters
    ----------
    contact_limit : float
        sigma_Hlim of the softer gear, Pa.
    viscosity : float
        Kinematic viscosity at 40 C, m^2/s; of a grease, that of its base oil.

    Examples
    --------
    ISO/TR 6336-30 example 1 prints 1.04739:

    >>> round(lubricant_factor(1500e6, 320e-6), 5)
    1.04739
    """
    constant = _film_constant(contact_limit)
    return constant + 4.0 * (1.0 - constant) / (1.2 + 134.0 / (viscosity * 1e6)) ** 2


def velocity_factor(contact_limit: float, pitch_line_speed: float) -> float:
    """Z_v = C + 2 (1 - C)/sqrt(0.8 + 32/v) with C = C_ZL + 0.02, 12.3.2, eq. 42, 43; v in m/s.

    Examples
    --------
    ISO/TR 6336-30 example 1 prints 0.96911:

    >>> round(velocity_factor(1500e6, 2.664), 5)
    0.96911
    """
    constant = _film_constant(contact_limit) + 0.02
    return constant + 2.0 * (1.0 - constant) / math.sqrt(0.8 + 32.0 / pitch_line_speed)


def _film_constant(contact_limit: float) -> float:
    """C_ZL of eq. 38 to 40: 0.83 below 850 MPa, 0.91 above 1200 MPa, linear between."""
    return min(max(contact_limit * 1e-6, 850.0), 1200.0) / 4375.0 + 0.6357


def roughness_factor(contact_limit: float, roughness: float, relative_radius: float) -> float:
    """Z_R = (3/R_z10)^C_ZR, R_z10 = R_z (10 mm/rho_red)^(1/3), 12.3.3, eq. 44 to 51.

    Parameters
    ----------
    contact_limit : float
        sigma_Hlim of the softer gear, Pa.
    roughness : float
        Mean peak-to-valley R_z of both flanks after running in, m.
    relative_radius : float
        rho_red at the pitch point, m.
    """
    limit = min(max(contact_limit * 1e-6, 850.0), 1200.0)
    relative_roughness = roughness * 1e6 * (10e-3 / relative_radius) ** (1.0 / 3.0)
    return float((3.0 / relative_roughness) ** (0.32 - 0.0002 * limit))


def relative_curvature_radius(pair: GearPair) -> float:
    """rho_red = rho1 rho2/(rho1 + rho2), rho = 0.5 d_b tan(alpha_wt), m, eq. 46, 47.

    The ring's radius is negative, so an internal pair fits closer and rho_red exceeds rho1.
    """
    tangent = 0.5 * math.tan(pair.working_pressure_angle)
    radius_1 = pair.base_diameter(pair.pinion_teeth) * tangent
    radius_2 = pair.base_diameter(pair.wheel_teeth) * tangent
    return radius_1 * radius_2 / (radius_1 + radius_2)


def work_hardening_factor(gear: GearMaterial, mate: GearMaterial) -> float:
    """Z_W, clause 13: 1.2 - (HB - 130)/1700 for a soft gear against a hard mate, else 1.

    HB of the softer gear is kept between 130 and 470.
    """
    if gear.surface_hardened or not mate.surface_hardened:
        return 1.0
    brinell = min(max(gear.hardness_vickers / 1.05, 130.0), 470.0)
    return 1.2 - (brinell - 130.0) / 1700.0


def size_factor(gear: GearMaterial, module: float) -> float:
    """Z_X, clause 14: 1.05 - 0.005 m_n for surface-hardened steel from 10 to 30 mm, else 1."""
    if not gear.surface_hardened:
        return 1.0
    return 1.05 - 0.005 * min(max(module * 1e3, 10.0), 30.0)


def life_factor(cycles: float) -> float:
    """Z_NT of Table 2: 1.6 up to 1e5 cycles, 1 at 5e7, 0.85 at 1e10 and beyond, log-log between.

    Examples
    --------
    ISO/TR 6336-30 example 1 prints 0.91 and 0.962:

    >>> [round(life_factor(n), 3) for n in (1.08e9, 1.783e8)]
    [0.91, 0.962]
    """
    if cycles <= REFERENCE_CYCLES:
        span = math.log(REFERENCE_CYCLES / STATIC_CYCLES)
        slope = math.log(STATIC_LIFE_FACTOR) / span
        return float((REFERENCE_CYCLES / max(cycles, STATIC_CYCLES)) ** slope)
    slope = math.log(1.0 / LONG_LIFE_FACTOR) / math.log(LONG_CYCLES / REFERENCE_CYCLES)
    return float((REFERENCE_CYCLES / min(cycles, LONG_CYCLES)) ** slope)


def bearable_contact_stress(
    contact_limit: float, film_factor: float, hardening_and_size: float, cycles: float
) -> float:
    """sigma_HG = sigma_Hlim Z_NT Z_L Z_v Z_R Z_W Z_X, Pa, 5.4, eq. 4 with 5.4.3 for limited life.

    Static strength knows no lubricant film (Z_L Z_v Z_R = 1), so up to 5e7 cycles the bearable
    stress is interpolated, log on log, between the static one at 1e5 and the endurance limit.

    Parameters
    ----------
    contact_limit : float
        sigma_Hlim, Pa.
    film_factor : float
        Z_L Z_v Z_R.
    hardening_and_size : float
        Z_W Z_X.
    cycles : float
        Load cycles of this gear's flank, N_L.
    """
    reference = contact_limit * film_factor * hardening_and_size
    if cycles > REFERENCE_CYCLES:
        return reference * life_factor(cycles)
    static = contact_limit * STATIC_LIFE_FACTOR * hardening_and_size
    share = math.log(REFERENCE_CYCLES / max(cycles, STATIC_CYCLES)) / math.log(
        REFERENCE_CYCLES / STATIC_CYCLES
    )
    return float(reference * (static / reference) ** share)
