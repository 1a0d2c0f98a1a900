"""ISO 6336-1: tooth stiffness and the load factors K_gamma, K_v, K_Hbeta, K_Halpha, K_Fbeta ...

Stiffness is per face width: 1 N/(mm um) = 1e9 Pa. `line_load` is always F_t K_A K_gamma/b, N/m.
"""

from __future__ import annotations

import math

from cqdd_design.errors import GeometryError, UsageError, did_you_mean

#: K_gamma by number of planets 2, 3, 4, ... "iso": ISO 6336-1 with IEC 61400-4 (as tabulated by
#: gfsReboucas/Drivetrain); "abs": ABS steel vessel rules (FVA Workbench help); the AGMA levels of
#: ANSI/AGMA 6123-B06 are from memory and need checking before they decide anything.
MESH_LOAD_TABLES: dict[str, tuple[float, ...]] = {
    "iso": (1.05, 1.10, 1.25, 1.35, 1.44, 1.47),
    "abs": (1.0, 1.0, 1.2, 1.3, 1.4, 1.4),
    "agma level 1": (1.16, 1.23, 1.32, 1.35, 1.38, 1.47, 1.52, 1.61),
    "agma level 2": (1.0, 1.0, 1.25, 1.35, 1.44, 1.47),
    "agma level 3": (1.0, 1.0, 1.15, 1.19, 1.23, 1.27, 1.30),
    "agma level 4": (1.0, 1.0, 1.08, 1.12, 1.16, 1.20, 1.23),
    "equal": (1.0, 1.0),
}


def mesh_load_factor(planets: int, table: str = "iso") -> float:
    """Mesh load factor K_gamma: the most loaded planet against the mean (ISO 6336-1, 4.1.3).

    One planet carries all, K_gamma = 1. The iso and abs tables begin with three planets; for two,
    "iso" takes half of what it adds for three. Beyond the end of a table its last step is repeated
    for every further planet, since sharing does not get better with more of them.

    Examples
    --------
    >>> [round(mesh_load_factor(n), 3) for n in (1, 2, 3, 6, 8)]
    [1.0, 1.05, 1.1, 1.44, 1.5]
    """
    if table not in MESH_LOAD_TABLES:
        raise UsageError(
            f"mesh load table: there is none called '{table}'"
            f"{did_you_mean(table, MESH_LOAD_TABLES)}. Choose one of {', '.join(MESH_LOAD_TABLES)}."
        )
    values = MESH_LOAD_TABLES[table]
    if planets <= 1:
        return 1.0
    index = planets - 2
    if index < len(values):
        return values[index]
    return values[-1] + (values[-1] - values[-2]) * (index - len(values) + 1)


def theoretical_single_stiffness(
    virtual_teeth_1: float, virtual_teeth_2: float, shift_1: float, shift_2: float
) -> float:
    """c'_th = 1/q' of eq. 81 and 82 with Table 9, Pa (1e9 Pa = 1 N/(mm um)).

    An internal gear counts as infinitely many teeth (9.3.1), so pass math.inf for it. Valid for
    x1 >= x2 and -0.5 <= x1 + x2 <= 2.

    Raises
    ------
    GeometryError
        Shifts so far outside that the teeth would be stiffer than solid steel.

    Examples
    --------
    ISO/TR 6336-30 example 1 prints 17.856 N/(mm um):

    >>> round(theoretical_single_stiffness(18.905, 114.543, 0.145, 0.0) / 1e9, 2)
    17.86
    """
    z1, z2, x1, x2 = virtual_teeth_1, virtual_teeth_2, shift_1, shift_2
    flexibility = (
        0.04723
        + 0.15551 / z1
        + 0.25791 / z2
        - 0.00635 * x1
        - 0.11654 * x1 / z1
        - 0.00193 * x2
        - 0.24188 * x2 / z2
        + 0.00529 * x1 * x1
        + 0.00182 * x2 * x2
    )
    if flexibility < 0.01:
        raise GeometryError(
            f"the profile shifts {x1:g} and {x2:g} are outside the range of ISO 6336-1, which "
            "rates pairs whose shifts add to -0.5 to 2; bring them nearer to zero."
        )
    return 1e9 / flexibility


def basic_rack_factor(dedendum: float, pressure_angle: float) -> float:
    """C_B = (1 + 0.5 (1.2 - h_fP*)) (1 - 0.02 (20 deg - alpha_Pn)), eq. 86."""
    return (1.0 + 0.5 * (1.2 - dedendum)) * (1.0 - 0.02 * (20.0 - math.degrees(pressure_angle)))


def single_stiffness(
    theoretical: float,
    rack_factor: float,
    helix_angle: float,
    line_load: float,
    youngs_modulus_1: float,
    youngs_modulus_2: float,
) -> float:
    """Single stiffness c' = c'_th C_M C_R C_B cos(beta) E/E_St, Pa, eq. 80, 83, 84, 88 to 90.

    C_M = 0.8 and C_R = 1 (solid blanks). Below 100 N/mm of line load the contact is softer and c'
    falls with its fourth root (eq. 90).

    Parameters
    ----------
    theoretical : float
        c'_th, Pa.
    rack_factor : float
        C_B.
    helix_angle : float
        rad.
    line_load : float
        F_t K_A K_gamma/b, N/m.
    youngs_modulus_1, youngs_modulus_2 : float
        Pa; E_St is 206 GPa.
    """
    modulus = 2.0 * youngs_modulus_1 * youngs_modulus_2 / (youngs_modulus_1 + youngs_modulus_2)
    stiffness = theoretical * 0.8 * rack_factor * math.cos(helix_angle) * modulus / 206e9
    return stiffness * math.pow(min(line_load / 1e5, 1.0), 0.25)


def mesh_stiffness(single: float, transverse_contact_ratio: float) -> float:
    """c_gamma,alpha = c' (0.75 eps_alpha + 0.25), eq. 91; c_gamma,beta is 0.85 of it (eq. 92)."""
    return single * (0.75 * transverse_contact_ratio + 0.25)


def blank_mass(diameters: float, base_diameter: float, density: float) -> float:
    """Mass per face width of a solid gear, reduced to its base circle: m* of eq. 30 to 32, kg/m.

    m* = pi/8 rho d_m^4/d_b^2 with the mean diameter d_m = (d_a + d_f)/2 given as `diameters`, m.
    """
    return math.pi / 8.0 * density * diameters**4 / base_diameter**2


def resonance_speed(pinion_teeth: int, stiffness: float, reduced_mass: float) -> float:
    """Pinion speed at main resonance, omega = sqrt(c_gamma,alpha/m_red)/z1, rad/s (eq. 6)."""
    return math.sqrt(stiffness / reduced_mass) / pinion_teeth


def dynamic_factor(
    speed_ratio: float,
    single: float,
    line_load: float,
    base_pitch_deviation: float,
    profile_deviation: float,
    total_contact_ratio: float,
) -> float:
    """Internal dynamic factor K_v by method B, 6.5, eq. 9 to 22 with Table 4; at least 1.

    Parameters
    ----------
    speed_ratio : float
        N, speed over resonance speed.
    single : float
        c', Pa.
    line_load : float
        F_t K_A K_gamma/b, N/m.
    base_pitch_deviation, profile_deviation : float
        f_pb,eff and f_falpha,eff after running in, m.
    total_contact_ratio : float
        eps_gamma.

    Notes
    -----
    Teeth have no tip relief here (B_k = 1): at module 1 a relief of a few micrometres is smaller
    than the deviations of the class.
    """
    ratio = total_contact_ratio
    pitch = single * base_pitch_deviation / line_load
    profile = single * profile_deviation / line_load
    cv1, cv5 = 0.32, 0.47
    if ratio <= 2.0:
        cv2, cv3, cv4, cv6 = 0.34, 0.23, 0.90, 0.47
    else:
        cv2 = 0.57 / (ratio - 0.3)
        cv3 = 0.096 / (ratio - 1.56)
        cv4 = (0.57 - 0.05 * ratio) / (ratio - 1.44)
        cv6 = 0.12 / (ratio - 1.74)
    if ratio <= 1.5:
        cv7 = 0.75
    elif ratio <= 2.5:
        cv7 = 0.125 * math.sin(math.pi * (ratio - 2.0)) + 0.875
    else:
        cv7 = 1.0
    main = cv1 * pitch + cv2 * profile + cv4 + 1.0
    above = cv5 * pitch + cv6 * profile + cv7
    lower_limit = 0.5 + 0.35 * math.sqrt(min(line_load / 1e5, 1.0))
    if speed_ratio <= lower_limit:
        factor = 1.0 + speed_ratio * (cv1 * pitch + cv2 * profile + cv3)
    elif speed_ratio <= 1.15:
        factor = main
    elif speed_ratio < 1.5:
        factor = above + (main - above) * (1.5 - speed_ratio) / 0.35
    else:
        factor = above
    return max(factor, 1.0)


def running_in_pitch(deviation: float, contact_limit: float, surface_hardened: bool) -> float:
    """Running-in allowance y_alpha of a pitch deviation, m, eq. 75 and 77.

    160 MPa/sigma_Hlim of the deviation for through-hardened steel; 7.5 %, at most 3 um, for
    surface-hardened. (Above 5 m/s the standard stops crediting deviations beyond 40 um.)
    """
    if surface_hardened:
        return min(0.075 * deviation, 3e-6)
    return min(160e6 / contact_limit, 1.0) * deviation


def running_in_helix(misalignment: float, contact_limit: float, surface_hardened: bool) -> float:
    """Running-in allowance y_beta of a misalignment F_betax, m, eq. 44 and 48.

    320 MPa/sigma_Hlim of it for through-hardened steel; 15 %, at most 6 um, for surface-hardened.
    (Above 5 m/s the standard stops crediting misalignments beyond 40 um.)
    """
    if surface_hardened:
        return min(0.15 * misalignment, 6e-6)
    return min(320e6 / contact_limit, 1.0) * misalignment


def torsional_misalignment(
    line_load: float, face_width: float, pinion_diameter: float, meshes: int, balanced: bool
) -> float:
    """Equivalent misalignment f_sh of a pinion that winds up under its torque, m.

    From 7.5.2.4 with s = 0: f_sh = (F_m/b) 0.023 um mm/N (0.7 + 0.3) (b/d1)^2. The part 0.7, that
    is 4/(pi G), is the wind-up of a solid pinion driven from one end and grows with the torque of
    all its meshes; the part 0.3 is bending, which equally spaced meshes balance.

    Parameters
    ----------
    line_load : float
        F_m/b of one mesh, N/m.
    face_width, pinion_diameter : float
        b and d1, m.
    meshes : int
        Meshes around the pinion.
    balanced : bool
        Whether their radial forces cancel.
    """
    share = 0.7 * meshes + (0.0 if balanced else 0.3)
    return line_load * 0.023e-9 * share * (face_width / pinion_diameter) ** 2


def equivalent_misalignment(
    pinion_deflection: float,
    pinion_helix_slope: float,
    wheel_helix_slope: float,
    line_load: float,
    crowned: bool,
) -> float:
    """Initial equivalent misalignment F_betax, m, eq. 52, 55, 56 with Table 8.

    1.33 B1 f_sh + B2 f_ma with f_ma = sqrt(f_Hbeta1^2 + f_Hbeta2^2); central crowning of half f_ma
    makes B2 = 0.5 (row 2), else B1 = B2 = 1. Never below the larger of 0.005 um mm/N F_m/b and half
    f_Hbeta of the wheel.
    """
    mounting = math.hypot(pinion_helix_slope, wheel_helix_slope)
    found = 1.33 * pinion_deflection + (0.5 if crowned else 1.0) * mounting
    return max(found, 0.005e-9 * line_load, 0.5 * wheel_helix_slope)


def face_load_factor_contact(misalignment: float, stiffness: float, line_load: float) -> float:
    """K_Hbeta by method C, 7.5, eq. 39 and 41, from F_betay (m), c_gamma,beta (Pa), F_m/b (N/m).

    1 + F c/(2 w) while the contact spans the face, sqrt(2 F c/w) beyond.
    """
    ratio = misalignment * stiffness / (2.0 * line_load)
    return math.sqrt(4.0 * ratio) if ratio >= 1.0 else 1.0 + ratio


def face_load_factor_bending(contact_factor: float, width_to_depth: float) -> float:
    """K_Fbeta = K_Hbeta^N_F, N_F = 1/(1 + h/b + (h/b)^2), b/h at least 3 (7.6, eq. 69, 70)."""
    ratio = 1.0 / max(width_to_depth, 3.0)
    return float(contact_factor ** (1.0 / (1.0 + ratio + ratio * ratio)))


def transverse_load_factor(
    stiffness: float,
    effective_pitch_deviation: float,
    line_load: float,
    total_contact_ratio: float,
) -> float:
    """K_Halpha = K_Falpha before their limits, method B, 8.3.2, eq. 71 and 72.

    Parameters
    ----------
    stiffness : float
        c_gamma,alpha, Pa.
    effective_pitch_deviation : float
        f_pb - y_alpha, m.
    line_load : float
        F_tH/b = F_t K_A K_gamma K_v K_Hbeta/b, N/m.
    total_contact_ratio : float
        eps_gamma.
    """
    share = stiffness * effective_pitch_deviation / line_load
    if total_contact_ratio <= 2.0:
        return 0.5 * total_contact_ratio * (0.9 + 0.4 * share)
    spread = math.sqrt(2.0 * (total_contact_ratio - 1.0) / total_contact_ratio)
    return 0.9 + 0.4 * spread * share


def limited_transverse_factors(
    factor: float,
    transverse_contact_ratio: float,
    total_contact_ratio: float,
    contact_ratio_factor: float,
) -> tuple[float, float]:
    """K_Halpha and K_Falpha within the limits of 8.3.3 and 8.3.4, eq. 73 and 74.

    1 <= K_Halpha <= eps_gamma/(eps_alpha Z_eps^2); 1 <= K_Falpha <= eps_gamma/(0.25 eps_alpha +
    0.75): one pair of teeth carries all the load at worst.
    """
    most_contact = total_contact_ratio / (transverse_contact_ratio * contact_ratio_factor**2)
    most_bending = total_contact_ratio / (0.25 * transverse_contact_ratio + 0.75)
    return max(min(factor, most_contact), 1.0), max(min(factor, most_bending), 1.0)
