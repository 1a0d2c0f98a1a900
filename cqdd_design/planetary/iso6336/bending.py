"""ISO 6336-3: tooth root stress and the stress the roots can bear (bending)."""

from __future__ import annotations

import itertools
import math

from cqdd_design.errors import GeometryError
from cqdd_design.planetary.gear_material import GearMaterial
from cqdd_design.planetary.tooth_geometry import GearPair

#: Stress correction factor of the reference test gears, 7.4.
TEST_GEAR_STRESS_CORRECTION = 2.0
#: Notch parameter of the reference test gears, 13.3.
TEST_GEAR_NOTCH_PARAMETER = 2.5
#: Cycles at which the root reaches its endurance limit (Table 1), and Y_NT at 1e10 cycles.
REFERENCE_CYCLES, LONG_CYCLES, LONG_LIFE_FACTOR = 3e6, 1e10, 0.85
#: Y_NT at static strength, 2.5 for through-hardened, case- and induction-hardened steel.
STATIC_LIFE_FACTOR = 2.5
#: Share of sigma_Flim left when the root is bent both ways (ISO 6336-5:2016, 5.3.2: idlers).
REVERSED_BENDING_FACTOR = 0.7

#: Slip-layer thickness rho' in m by yield strength in Pa, Table 3, through-hardened steel.
_SLIP_LAYER = (
    (500e6, 0.0281e-3),
    (600e6, 0.0194e-3),
    (800e6, 0.0064e-3),
    (1000e6, 0.0014e-3),
)
_SLIP_LAYER_SURFACE_HARDENED = 0.0030e-3


def helix_factor(pair: GearPair) -> float:
    """Y_beta = 1 - eps_beta beta/120 deg, eps_beta <= 1, beta <= 30 deg, clause 8, eq. 39."""
    angle = min(math.degrees(abs(pair.helix_angle)), 30.0)
    return 1.0 - min(pair.overlap_ratio, 1.0) * angle / 120.0


def rim_factor_internal(rim: float, module: float) -> float:
    """Y_B of a ring, 9.3, eq. 43, 44: 1 from s_R = 3.5 m_n, 1.15 ln(8.324 m_n/s_R) below.

    Raises
    ------
    GeometryError
        s_R <= 1.75 m_n, where the standard gives no factor.

    Examples
    --------
    >>> round(rim_factor_internal(2.5e-3, 1e-3), 3)
    1.383
    """
    ratio = rim / module
    if ratio >= 3.5:
        return 1.0
    if ratio <= 1.75:
        raise GeometryError(
            f"a ring rim of {rim * 1e3:.3g} mm is too thin to rate at module {module * 1e3:.3g} "
            f"mm; ISO 6336-3 asks for over 1.75 modules, so make it {2.0 * module * 1e3:.3g} mm."
        )
    return 1.15 * math.log(8.324 / ratio)


def deep_tooth_factor(virtual_contact_ratio: float, accuracy_class: int) -> float:
    """Y_DT, clause 10, eq. 45: below 1 only for eps_alpha,n > 2.05 and classes up to 4."""
    if accuracy_class > 4 or virtual_contact_ratio <= 2.05:
        return 1.0
    return max(2.366 - 0.666 * virtual_contact_ratio, 0.7)


def nominal_root_stress(
    tangential: float,
    face_width: float,
    module: float,
    form_factor: float,
    stress_correction: float,
    further_factors: float,
) -> float:
    """sigma_F0 = F_t/(b m_n) Y_F Y_S Y_beta Y_B Y_DT, Pa, 5.2.2, eq. 3.

    `further_factors` is the product Y_beta Y_B Y_DT.
    """
    return tangential / (face_width * module) * form_factor * stress_correction * further_factors


def slip_layer_thickness(gear: GearMaterial) -> float:
    """Slip layer rho' of Table 3, m: linear in the yield strength between rows, clamped at ends."""
    if gear.surface_hardened:
        return _SLIP_LAYER_SURFACE_HARDENED
    strength = gear.yield_strength
    if strength <= _SLIP_LAYER[0][0]:
        return _SLIP_LAYER[0][1]
    for (low, thick), (high, thin) in itertools.pairwise(_SLIP_LAYER):
        if strength <= high:
            return thick + (thin - thick) * (strength - low) / (high - low)
    return _SLIP_LAYER[-1][1]


def relative_notch_sensitivity(notch_parameter: float, slip_layer: float) -> float:
    """Y_deltarelT at the endurance limit, 13.3.1, eq. 49 to 51.

    (1 + sqrt(rho' chi*))/(1 + sqrt(rho' chi*_T)), chi* = (1 + 2 q_s)/5 per mm, q_sT = 2.5.
    """
    roots = []
    for q in (notch_parameter, TEST_GEAR_NOTCH_PARAMETER):
        gradient = (1.0 + 2.0 * q) / 5.0 * 1e3
        roots.append(1.0 + math.sqrt(slip_layer * gradient))
    return roots[0] / roots[1]


def relative_notch_sensitivity_static(gear: GearMaterial, stress_correction: float) -> float:
    """Y_deltarelT for static stress, 13.3.2.

    (1 + 0.82 (Y_S - 1) r)/(1 + 0.82 r), r = (300 MPa/sigma_0.2)^(1/4), for through-hardened steel;
    0.44 Y_S + 0.12 for surface-hardened. Both are 1 for the test gear's Y_S = 2.
    """
    if gear.surface_hardened:
        return 0.44 * stress_correction + 0.12
    ratio = 0.82 * math.pow(300e6 / gear.yield_strength, 0.25)
    return (1.0 + ratio * (stress_correction - 1.0)) / (1.0 + ratio)


def relative_surface_factor(roughness: float) -> float:
    """Y_RrelT = 1.674 - 0.529 (R_z + 1)^0.1 of hardened steel, R_z in um, 14.3, eq. 56.

    1.12 below 1 um, and R_z counts up to 40 um; 1 at the test gears' 10 um.

    Parameters
    ----------
    roughness : float
        R_z of the root fillet, m.
    """
    micrometres = min(roughness * 1e6, 40.0)
    if micrometres < 1.0:
        return 1.12
    return float(1.674 - 0.529 * (micrometres + 1.0) ** 0.1)


def size_factor(gear: GearMaterial, module: float) -> float:
    """Y_X, clause 15, Table 5: 1 to m_n = 5 mm, then falling to 0.85 at 30 or 0.8 at 25 mm."""
    millimetres = module * 1e3
    if gear.surface_hardened:
        return 1.05 - 0.01 * min(max(millimetres, 5.0), 25.0)
    return 1.03 - 0.006 * min(max(millimetres, 5.0), 30.0)


def static_cycles(gear: GearMaterial) -> float:
    """Cycles up to which the root's strength is static: 1e4 through-, 1e3 surface-hardened."""
    return 1e3 if gear.surface_hardened else 1e4


def life_factor(gear: GearMaterial, cycles: float) -> float:
    """Y_NT of Table 1: 2.5 when static, 1 at 3e6 cycles, 0.85 at 1e10 and beyond, log-log between.

    Examples
    --------
    >>> from cqdd_design.catalog import find_material
    >>> from cqdd_design.planetary.gear_material import gear_material
    >>> steel = gear_material(find_material("AISI 4140 Q&T 540C"))
    >>> [round(life_factor(steel, n), 3) for n in (1e4, 3e6, 1e10)]
    [2.5, 1.0, 0.85]
    """
    if cycles <= REFERENCE_CYCLES:
        least = static_cycles(gear)
        slope = math.log(STATIC_LIFE_FACTOR) / math.log(REFERENCE_CYCLES / least)
        return float((REFERENCE_CYCLES / max(cycles, least)) ** slope)
    slope = math.log(1.0 / LONG_LIFE_FACTOR) / math.log(LONG_CYCLES / REFERENCE_CYCLES)
    return float((REFERENCE_CYCLES / min(cycles, LONG_CYCLES)) ** slope)


def bearable_root_stress(
    gear: GearMaterial,
    endurance_factors: float,
    static_factors: float,
    cycles: float,
    reversed_bending: bool,
) -> float:
    """sigma_FG = sigma_Flim Y_ST Y_NT Y_deltarelT Y_RrelT Y_X, Pa, 5.4, eq. 5, and 5.4.4.

    Up to 3e6 cycles the bearable stress is interpolated, log on log, between the static one (with
    `static_factors`) and the endurance limit (with `endurance_factors`).

    Parameters
    ----------
    endurance_factors, static_factors : float
        Y_deltarelT Y_RrelT Y_X; the static product has no Y_RrelT.
    cycles : float
        Load cycles of this gear's tooth, N_L.
    reversed_bending : bool
        The tooth is bent both ways: 0.7 of the stress number.
    """
    limit = gear.bending_limit * TEST_GEAR_STRESS_CORRECTION
    limit *= REVERSED_BENDING_FACTOR if reversed_bending else 1.0
    if cycles > REFERENCE_CYCLES:
        return float(limit * endurance_factors * life_factor(gear, cycles))
    static = STATIC_LIFE_FACTOR * static_factors
    least = static_cycles(gear)
    share = math.log(REFERENCE_CYCLES / max(cycles, least)) / math.log(REFERENCE_CYCLES / least)
    return float(limit * endurance_factors * (static / endurance_factors) ** share)
