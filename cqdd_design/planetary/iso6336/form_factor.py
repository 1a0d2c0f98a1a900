"""ISO 6336-3, clauses 6 and 7: the critical section of the tooth root, Y_F and Y_S (method B).

The section lies where the tangent to the fillet makes 30 degrees with the tooth's centre line
(external gear) or 60 degrees (internal gear); the load acts at the outer point of single pair
contact. Lengths here are in modules.

External teeth follow the rack exactly. For internal teeth the 2006 edition replaces the pinion
cutter's fillet by an equivalent rack fillet (eq. 11). Against the exactly generated fillet of
cutters with 20 to 35 teeth and 0.25 to 0.38 modules of tip radius, cutting rings of 70 to 120
teeth, its section lies within 0.01 modules of the true depth, its fillet radius is 0 to 4 % large
and its chord 4 to 10 % small, so a ring's Y_F is on the safe side by twice that
(tests/properties/test_planetary_form_factor.py).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from cqdd_design.errors import GeometryError
from cqdd_design.planetary.cutting_tools import BasicRack, PinionCutter, involute
from cqdd_design.planetary.tooth_geometry import GearPair


@dataclass(frozen=True)
class RootSection:
    """Critical section of one tooth, in modules.

    Attributes
    ----------
    chord : float
        s_Fn/m_n.
    fillet_radius : float
        rho_F/m_n at the section.
    height : float
        Twice the distance of the section from the gear axis along the tooth's centre line, signed
        like the teeth; what eq. 18 and 19 subtract from the load's.
    """

    chord: float
    fillet_radius: float
    height: float


def equivalent_fillet_radius(rack: BasicRack, cutter: PinionCutter) -> float:
    """rho_fPv of a ring in modules, eq. 11.

    rho_a0 + (x0 + h_fP - rho_a0)^1.95/(3.156 1.036^z0) for a pinion cutter of z0 teeth with the tip
    radius rho_a0 and without profile shift x0.
    """
    excess = (rack.dedendum - cutter.tip_radius) ** 1.95
    return float(cutter.tip_radius + excess / (3.156 * 1.036**cutter.teeth))


def root_section(
    virtual_teeth: float, shift: float, rack: BasicRack, cutter: PinionCutter | None = None
) -> RootSection:
    """Chord, fillet radius and height of the critical section, eq. 10 to 17.

    Parameters
    ----------
    virtual_teeth : float
        z_n, negative for an internal gear.
    shift : float
        x.
    cutter : PinionCutter, optional
        Of an internal gear, default the usual one; an external gear is cut by the rack.

    Raises
    ------
    GeometryError
        The fillet never reaches the tangent of the critical section: the tooth has no root.

    Examples
    --------
    ISO 6336-3 charts z = 20, x = 0:

    >>> section = root_section(20.0, 0.0, BasicRack())
    >>> round(section.chord, 5), round(section.fillet_radius, 5)
    (1.94475, 0.57295)
    """
    internal = virtual_teeth < 0
    radius = rack.fillet_radius
    if internal:
        cutter = cutter or PinionCutter.usual(round(-virtual_teeth), rack=rack)
        radius = equivalent_fillet_radius(rack, cutter)
        rack = replace(rack, fillet_radius=cutter.tip_radius)
    g = radius - rack.dedendum + shift
    tangent = math.pi / 6.0 if internal else math.pi / 3.0
    h = 2.0 / virtual_teeth * (0.5 * math.pi - rack.half_tip_land) - tangent
    theta = _solve_tangent(virtual_teeth, g, h, internal)
    bracket = g / math.cos(theta) - radius
    chord = virtual_teeth * math.sin(tangent - theta) + bracket * (
        1.0 if internal else math.sqrt(3)
    )
    height = virtual_teeth * math.cos(tangent - theta) + bracket * (
        math.sqrt(3) if internal else 1.0
    )
    cosine = math.cos(theta)
    fillet = radius + 2.0 * g * g / (cosine * (virtual_teeth * cosine * cosine - 2.0 * g))
    if chord <= 0.0 or fillet <= 0.0:
        raise GeometryError(
            f"a gear of {abs(virtual_teeth):g} teeth with profile shift {shift:g} has no root left "
            "between its fillets; bring the shift nearer to zero or raise the tooth count."
        )
    return RootSection(chord, fillet, height)


def _solve_tangent(virtual_teeth: float, g: float, h: float, internal: bool) -> float:
    """Theta of eq. 14, theta = 2 G/z_n tan(theta) - H, by Newton from pi/6 (ring: pi/3)."""
    theta = math.pi / 3.0 if internal else math.pi / 6.0
    slope = 2.0 * g / virtual_teeth
    for _ in range(50):
        residual = theta - slope * math.tan(theta) + h
        derivative = 1.0 - slope / math.cos(theta) ** 2
        if derivative == 0.0:
            break
        step = residual / derivative
        theta = min(max(theta - step, -1.5), 1.5)
        if abs(step) < 1e-14:
            return theta
    raise GeometryError(
        f"the root of a gear of {abs(virtual_teeth):g} teeth has no critical section; its profile "
        "shift is too far from zero."
    )


@dataclass(frozen=True)
class ToothForm:
    """Form and stress correction of one gear of a pair.

    Attributes
    ----------
    form_factor, stress_correction : float
        Y_F and Y_S.
    notch_parameter : float
        q_s = s_Fn/(2 rho_F); Y_S is fitted for 1 <= q_s < 8.
    chord, moment_arm, fillet_radius : float
        s_Fn, h_Fe, rho_F in modules.
    load_angle : float
        alpha_Fen, rad.
    """

    form_factor: float
    stress_correction: float
    notch_parameter: float
    chord: float
    moment_arm: float
    fillet_radius: float
    load_angle: float


def load_diameter(
    teeth: int,
    virtual_teeth: float,
    tip_diameter: float,
    virtual_contact_ratio: float,
    pair: GearPair,
) -> float:
    """Diameter d_en of the outer point of single pair contact in modules, eq. 22 to 28; signed.

    From the tips one goes (eps_alpha,n - 1) base pitches back along the line of action: inward on
    an external gear, outward on a ring. With eps_alpha,n <= 1 the load stays at the tip.
    """
    module, alpha = pair.module, pair.rack.pressure_angle
    reference = virtual_teeth
    tip = reference + (tip_diameter - pair.reference_diameter(teeth)) / module
    base = reference * math.cos(alpha)
    back = math.pi * math.cos(alpha) * max(virtual_contact_ratio - 1.0, 0.0)
    sign = math.copysign(1.0, teeth)
    roll = math.sqrt(0.25 * (tip * tip - base * base)) - sign * back
    return sign * 2.0 * math.sqrt(roll * roll + 0.25 * base * base)


def tooth_form(
    virtual_teeth: float,
    shift: float,
    rack: BasicRack,
    load_point_diameter: float,
    cutter: PinionCutter | None = None,
) -> ToothForm:
    """Y_F and Y_S for a load on the circle `load_point_diameter` (modules), eq. 9, 18 to 38.

    Y_F = 6 h_Fe cos(alpha_Fen)/(s_Fn^2 cos(alpha_n)), lengths in modules;
    Y_S = (1.2 + 0.13 L) q_s^(1/(1.21 + 2.3/L)), L = s_Fn/h_Fe.

    Parameters
    ----------
    virtual_teeth : float
        z_n, negative for an internal gear.
    shift : float
        x.
    load_point_diameter : float
        d_en/m_n, signed like the teeth.
    cutter : PinionCutter, optional
        Of a ring.

    Raises
    ------
    GeometryError
        There is no tooth to bend (see :func:`root_section`), or the load acts below its root.

    Examples
    --------
    Load at the tip of z = 20, x = 0; the standard's charts read 2.80 and 1.55:

    >>> form = tooth_form(20.0, 0.0, BasicRack(), 22.0)
    >>> round(form.form_factor, 2), round(form.stress_correction, 2)
    (2.8, 1.55)
    """
    section = root_section(virtual_teeth, shift, rack, cutter)
    alpha = rack.pressure_angle
    alpha_load = math.acos(min(virtual_teeth * math.cos(alpha) / load_point_diameter, 1.0))
    half_thickness = (0.5 * math.pi + 2.0 * math.tan(alpha) * shift) / virtual_teeth
    half_thickness += involute(alpha) - involute(alpha_load)
    load_angle = alpha_load - half_thickness
    lever = math.cos(half_thickness) - math.sin(half_thickness) * math.tan(load_angle)
    arm = 0.5 * (lever * load_point_diameter - section.height)
    if arm <= 0.0:
        raise GeometryError(
            f"on a gear of {abs(virtual_teeth):g} teeth the load acts below the critical section "
            "of the root; raise its profile shift."
        )
    factor = 6.0 * arm * math.cos(load_angle) / (section.chord**2 * math.cos(alpha))
    notch = section.chord / (2.0 * section.fillet_radius)
    slenderness = section.chord / arm
    exponent = 1.0 / (1.21 + 2.3 / slenderness)
    return ToothForm(
        form_factor=factor,
        stress_correction=(1.2 + 0.13 * slenderness) * notch**exponent,
        notch_parameter=notch,
        chord=section.chord,
        moment_arm=arm,
        fillet_radius=section.fillet_radius,
        load_angle=load_angle,
    )


def pair_tooth_forms(pair: GearPair) -> tuple[ToothForm, ToothForm]:
    """Tooth form of pinion and wheel, each loaded at its outer point of single pair contact."""
    ratio = pair.transverse_contact_ratio / math.cos(pair.base_helix_angle) ** 2
    forms = []
    for teeth, virtual, shift, tip in zip(
        pair.teeth, pair.virtual_teeth, pair.shifts, pair.tip_diameters, strict=True
    ):
        diameter = load_diameter(teeth, virtual, tip, ratio, pair)
        cutter = pair.ring_cutter if teeth < 0 else None
        forms.append(tooth_form(virtual, shift, pair.rack, diameter, cutter))
    return forms[0], forms[1]
