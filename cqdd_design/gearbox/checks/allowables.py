"""Every limit of the gearbox checks, each a named constant with its source. None is tuned.

Limits that depend on a material come as :class:`Allowable`: the value with the sentence that says
how it was obtained, so a report never shows a limit whose origin is hidden. Where the catalogue
has no basis for a limit the allowable is zero and says so: the part is then not shown to hold.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cqdd_design.catalog.adhesives import SAFETY, RetainingCompound
from cqdd_design.catalog.dowels import SHEAR_STRENGTH
from cqdd_design.catalog.materials import HARDENED_HRC as RACEWAY_HRC
from cqdd_design.catalog.materials import Material
from cqdd_design.catalog.tightening import STRIPPING_SAFETY
from cqdd_design.geometry.runners import LEAST_WALL

UNEVEN_SHARING = 1.15
"""Factor on rigid-law ring and pin forces for unequal discs, pitch errors and deflection (design
practice; Wang, Luo and Su 2016 take 0.55 instead of 0.5 for two discs). Clearance is not in it: the
contact equilibrium with the usual clearances gives ring forces 1.3 to 1.6 times the rigid ones."""

# Geometry ---------------------------------------------------------------------------------------
SHORTENING_LEAST, SHORTENING_MOST = 0.3, 0.85
"""K1: below, the lobes are shallow and forces grow as 1/K1; above, valleys sharpen and the tips
near undercut (range of the tables in Wang, Luo and Su 2016, 0.42 to 0.9, widened at the bottom)."""
UNDERCUT_SHARE = 0.9
"""Most of the undercut limit that the tooth radius may take (10 % of reserve for the offset)."""
TOOTH_OVERLAP_SHARE = 0.85
"""Most of R sin(pi/(n+1)), the radius at which neighbouring ring teeth touch (space for relief)."""
RING_WALL = 2.5e-3
"""Least wall of the ring outside its deepest relief, m (house rule for 60 to 90 mm rings)."""
LIGAMENT = 1.5e-3
"""Least material between holes, bore and lobes of a disc, m (house rule; ten EDM cuts)."""
SLEEVE_WALL = LEAST_WALL
"""Least wall of a sleeve on an output pin, m (thinnest drawn or ground bush commonly sold)."""
SHAFT_CORE_SHARE = 0.25
"""Least core radius common to neighbouring eccentrics, as a share of the cam bearing's bore."""

# Contact ----------------------------------------------------------------------------------------
FIRST_YIELD_FACTOR = 1.67
"""Peak line-contact pressure at first yield, p0 = 1.67 S_y: shear 0.300 p0 reaches S_y/2 below
the surface (Johnson 1985, Contact Mechanics, section 6.1, Tresca)."""
HARDENED_STATIC_PRESSURE = 2500e6
"""Static pressure for steel through-hardened to 58 HRC and more, Pa (bearing steel practice; far
below the 4000 MPa of ISO 76 because flanks are not super-finished)."""
HARDENED_FATIGUE_PRESSURE = 1500e6
"""Fatigue pressure for flanks of 58 HRC and more, Pa (ISO 6336-5, quality MQ, sigma_Hlim)."""
HARDENED_HRC = RACEWAY_HRC
"""Hardness from which the two limits above hold."""
AGMA_SLOPE, AGMA_BASE = 2.22e6, 200e6
"""Through-hardened steel, grade 1: 2.22 HB + 200 MPa at 1e7 cycles (AGMA 2101-D04, contact stress
numbers of through-hardened steel)."""
AGMA_LEAST_HB, AGMA_MOST_HB = 180.0, 400.0
"""Range of the line above. Harder steel gets the value at 400 HB; softer steel continues it."""
STEEL_MODULUS = (180e9, 220e9)
"""Young's moduli by which a catalogue row counts as steel, Pa."""
STRENGTH_PER_BRINELL = 3.45e6
"""Ultimate strength of steel per Brinell point, Pa (ASTM A370): used where no hardness is given."""
ROCKWELL_C = (
    (20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0, 65.0),
    (226.0, 253.0, 286.0, 327.0, 371.0, 421.0, 481.0, 560.0, 654.0, 739.0),
)
"""HRC and the Brinell numbers that go with them (ASTM E140, table 1, carbide ball)."""
ROCKWELL_B = ((80.0, 85.0, 90.0, 95.0, 100.0), (150.0, 165.0, 185.0, 210.0, 240.0))
"""HRB and the Brinell numbers that go with them (ASTM E140, table 2)."""

# Output pins ------------------------------------------------------------------------------------
PIN_SAFETY_AT_PEAK = 1.2
"""On the yield strength at the peak torque."""
SHEAR_YIELD_SHARE = 0.58
"""Yield in shear over yield in tension (von Mises, 1/sqrt 3)."""
PAPER_SHEAR_SHARE = 0.5
"""Allowable shear over ultimate strength in the paper's pin figure: 35 of 70 ksi."""
PIN_FATIGUE_SHARE = 0.25
"""Pulsating bending stress over ultimate strength where the catalogue tables none: the share that
the tabled shoulder screws have."""

# Edges of discs and ring ------------------------------------------------------------------------
STEEL_ENDURANCE_SHARE, STEEL_ENDURANCE_MOST = 0.5, 700e6
"""Endurance limit of a polished steel specimen in rotating bending over its ultimate strength, and
the most of it, Pa (Budynas and Nisbett 2020, section 6-7): used where the catalogue has none."""
MACHINED_FACTOR, MACHINED_EXPONENT = 4.51, -0.265
"""Surface factor of machined steel, 4.51 S_u^-0.265 with MPa (Budynas and Nisbett 2015, table 6-2),
for edges that were wire-cut and trimmed."""
ENDURANCE_RELIABILITY = 0.814
"""Of endurance limits, which are those that half of the specimens survive: what 99 % survive, where
they scatter by 8 % (Budynas and Nisbett 2020, reliability factor, 1 - 0.08 x 2.326)."""

# Cam bearing ------------------------------------------------------------------------------------
STATIC_SAFETY = 1.0
"""Least C0/P at the peak torque (ISO 76: normal operation without shocks)."""

# Rotor on the shaft's stub ----------------------------------------------------------------------
AIR_GAP_SHARE = 0.5
"""Most of a motor's air gap that its rotor may take: as much again stays before it touches (house
rule, on a pull that is overstated)."""

# Toleranced gearboxes ----------------------------------------------------------------------------
BINDING_SHARE = 0.05
"""Torque that turns a gearbox without load, over the continuous torque, from which it binds."""
YIELD_SAMPLES = 256
"""Gearboxes drawn for the yield: a share of 95 % is known to 3 points (two standard errors)."""

# Balance, motor, manufacture --------------------------------------------------------------------
LEAST_BALANCED_DISCS = 2
"""Fewest discs that balance statically without counterweights, at any ratio."""
BALANCE_GRADE = 6.3e-3
"""Permissible centre-of-mass speed of the rotating parts, m/s: G 6.3 (ISO 21940-11, machinery in
general)."""
SHAKING_SHARE = 0.1
"""Most of the cam load at the continuous torque that inertia may add (house rule)."""
REDUCER_EFFICIENCY = 0.88
"""Assumed forward efficiency in the motor check: the low end of measured steel cycloid drives, 88
to 94 % (cycloidgen, efficiency guide)."""
COMPUTED_EFFICIENCIES = (0.71, 0.76)
"""What the loss model gives instead for designs of ratio 10 with a friction of 0.08, at
peak and at continuous torque: said with the check, not used by it."""


@dataclass(frozen=True)
class Allowable:
    """A limit with its origin.

    Attributes
    ----------
    value : float
        Pa; zero when nothing in the catalogue supports a limit.
    basis : str
        A clause such as "2.22 x 335 HB + 200 MPa (AISI 4140 Q&T 540C)".
    """

    value: float
    basis: str


def weaker(first: Allowable, second: Allowable) -> Allowable:
    """Return the lower of two limits; the first when equal."""
    return second if second.value < first.value else first


def is_steel(material: Material) -> bool:
    """Whether the elastic modulus is that of a steel."""
    return STEEL_MODULUS[0] <= material.youngs_modulus <= STEEL_MODULUS[1]


def brinell_estimate(material: Material) -> tuple[float, str] | None:
    """Brinell hardness of a steel and how it was obtained; None without any basis.

    Printed HB first, then printed HRC or HRB through ASTM E140, then the ultimate strength
    through ASTM A370. A printed range counts with its least value.
    """
    if material.brinell_hardness is not None:
        return material.brinell_hardness, f"{material.brinell_hardness:.0f} HB"
    words = material.hardness.split("HRB")[0].split("-") if "HRB" in material.hardness else None
    if words is not None:
        least = float(words[0].strip(" ~"))
        value = float(np.interp(least, *ROCKWELL_B))
        return value, f"{value:.0f} HB from {least:g} HRB by ASTM E140"
    if material.rockwell_hardness is not None:
        value = float(np.interp(material.rockwell_hardness, *ROCKWELL_C))
        return value, f"{value:.0f} HB from {material.rockwell_hardness:g} HRC by ASTM E140"
    if material.ultimate_strength is not None and is_steel(material):
        value = material.ultimate_strength / STRENGTH_PER_BRINELL
        return value, f"{value:.0f} HB estimated from the ultimate strength by ASTM A370"
    return None


def is_hardened(material: Material) -> bool:
    """Whether the surface has 58 HRC or more."""
    return material.is_hardened


def contact_limit_static(material: Material) -> Allowable:
    """Largest Hertz pressure at the peak torque: first yield below the surface.

    Case-hardened steel is held to the yield strength of its core, because the catalogue does not
    know the depth of the case. Other metals and polymers are held to the lower of first yield and
    the value their source quotes.

    Examples
    --------
    >>> from cqdd_design.catalog.materials import find_material
    >>> round(contact_limit_static(find_material("AISI 4140 Q&T 540C")).value / 1e6)
    1393
    """
    if is_hardened(material) and material.treatment != "case-hardened":
        return Allowable(
            HARDENED_STATIC_PRESSURE,
            f"{HARDENED_STATIC_PRESSURE / 1e6:.0f} MPa for steel hardened to {HARDENED_HRC:g} HRC "
            f"({material.name})",
        )
    if material.yield_strength is None:
        return Allowable(0.0, f"no yield strength in the catalogue for {material.name}")
    strength = material.yield_strength
    value = FIRST_YIELD_FACTOR * strength
    basis = f"{FIRST_YIELD_FACTOR:g} x S_y {strength / 1e6:.0f} MPa ({material.name})"
    quoted = material.contact_allowable
    if not is_steel(material) and quoted is not None and quoted < value:
        return Allowable(quoted, f"{quoted / 1e6:.0f} MPa quoted for {material.name}")
    return Allowable(value, basis)


def contact_limit_fatigue(material: Material) -> Allowable:
    """Largest Hertz pressure at the continuous torque: pitting.

    Only steels have published rolling-contact strengths here; for anything else the limit is zero
    and says so.

    Examples
    --------
    >>> from cqdd_design.catalog.materials import find_material
    >>> round(contact_limit_fatigue(find_material("AISI 4140 Q&T 540C")).value / 1e6)
    944
    """
    if not is_steel(material):
        return Allowable(0.0, f"no contact fatigue strength is known for {material.name}")
    if is_hardened(material):
        return Allowable(
            HARDENED_FATIGUE_PRESSURE,
            f"{HARDENED_FATIGUE_PRESSURE / 1e6:.0f} MPa at {HARDENED_HRC:g} HRC ({material.name})",
        )
    estimate = brinell_estimate(material)
    if estimate is None:
        return Allowable(0.0, f"no hardness and no strength is known for {material.name}")
    hardness, words = estimate
    used = min(hardness, AGMA_MOST_HB)
    remark = ""
    if hardness > AGMA_MOST_HB:
        remark = f", held at {AGMA_MOST_HB:.0f} HB where the rule ends"
    elif hardness < AGMA_LEAST_HB:
        remark = f", an estimate below the {AGMA_LEAST_HB:.0f} HB where the rule begins"
    return Allowable(
        AGMA_SLOPE * used + AGMA_BASE,
        f"{AGMA_SLOPE / 1e6:g} x {used:.0f} HB + {AGMA_BASE / 1e6:g} MPa "
        f"({material.name}, {words}{remark})",
    )


def pin_limit_peak(material: Material) -> Allowable:
    """Bending stress, and mean pressure on the projected area, at the peak torque: S_y/1.2."""
    return _yield_share(material, 1.0, "S_y")


def pin_shear_limit_peak(material: Material) -> Allowable:
    """Mean shear stress of an output pin at the peak torque, 0.58 S_y/1.2."""
    return _yield_share(material, SHEAR_YIELD_SHARE, f"{SHEAR_YIELD_SHARE:g} S_y")


def _yield_share(material: Material, share: float, symbol: str) -> Allowable:
    if material.yield_strength is None:
        return Allowable(0.0, f"no yield strength in the catalogue for {material.name}")
    value = share * material.yield_strength / PIN_SAFETY_AT_PEAK
    strength = material.yield_strength / 1e6
    return Allowable(
        value, f"{symbol}/{PIN_SAFETY_AT_PEAK:g}, S_y {strength:.0f} MPa ({material.name})"
    )


def pin_bending_limit_continuous(material: Material, *, duty_reverses: bool) -> Allowable:
    """Greatest bending stress of an output pin at the continuous torque.

    One sense of torque loads a pin from nothing to the full stress and back (pulsating). When the
    duty reverses the torque, the same stress swings both ways; the amplitude allowed is then the
    one on the same Goodman line, (s/2)/(1 - s/(2 S_u)) for the pulsating limit s.

    Examples
    --------
    >>> from cqdd_design.catalog.materials import find_material
    >>> screw = find_material("Alloy steel 12.9 (ISO 7379)")
    >>> round(pin_bending_limit_continuous(screw, duty_reverses=False).value / 1e6)
    300
    """
    ultimate = material.ultimate_strength
    if ultimate is None:
        return Allowable(0.0, f"no ultimate strength in the catalogue for {material.name}")
    if material.pulsating_strength is not None:
        value, words = material.pulsating_strength, material.pulsating_basis
    else:
        value = PIN_FATIGUE_SHARE * ultimate
        words = f"S_u/{1.0 / PIN_FATIGUE_SHARE:g} of {material.name}"
        if material.fatigue_strength is not None and material.fatigue_strength < value:
            value, words = material.fatigue_strength, f"endurance limit of {material.name}"
    if not duty_reverses:
        return Allowable(value, f"{value / 1e6:.0f} MPa pulsating, {words}")
    half = 0.5 * value
    reversed_value = half / (1.0 - half / ultimate)
    return Allowable(
        reversed_value,
        f"{reversed_value / 1e6:.0f} MPa reversed, on the Goodman line of "
        f"{value / 1e6:.0f} MPa pulsating ({words})",
    )


def edge_limit_peak(material: Material) -> Allowable:
    """Stress along an edge of a disc or ring at the peak torque: S_y/1.2, as for pins."""
    return _yield_share(material, 1.0, "S_y")


def edge_limit_fatigue(material: Material) -> Allowable:
    """Reversed stress that an edge of a disc or ring bears for ever.

    The endurance limit of the catalogue, or half the ultimate strength of a steel that has none
    there; of a steel times the surface factor of a machined part. Of it what 99 % of parts survive.

    Examples
    --------
    >>> from cqdd_design.catalog.materials import find_material
    >>> round(edge_limit_fatigue(find_material("AISI 4140 Q&T 540C")).value / 1e6)
    284
    """
    ultimate, endurance = material.ultimate_strength, material.fatigue_strength
    words = "endurance limit"
    if endurance is None and ultimate is not None and is_steel(material):
        share = STEEL_ENDURANCE_SHARE * ultimate
        endurance, words = share, f"{STEEL_ENDURANCE_SHARE:g} S_u"
        if share > STEEL_ENDURANCE_MOST:
            endurance, words = STEEL_ENDURANCE_MOST, "endurance limit of strong steels"
    if endurance is None or ultimate is None:
        return Allowable(0.0, f"no endurance limit is known for {material.name}")
    told = f"{words} {endurance / 1e6:.0f} MPa ({material.name})"
    sure = f"{ENDURANCE_RELIABILITY:g} (99 % survive)"
    if not is_steel(material):
        return Allowable(ENDURANCE_RELIABILITY * endurance, f"{sure} x {told}")
    surface = min(MACHINED_FACTOR * (ultimate / 1e6) ** MACHINED_EXPONENT, 1.0)
    return Allowable(
        ENDURANCE_RELIABILITY * surface * endurance,
        f"{sure} x {surface:.2f} (machined) x {told}",
    )


def shaft_limit_peak(material: Material) -> Allowable:
    """Von Mises stress of a shaft at the peak torque: S_y/1.2, as for pins."""
    return _yield_share(material, 1.0, "S_y")


def shaft_limit_fatigue(material: Material, diameter: float) -> Allowable:
    """Reversed stress that a shaft of a diameter (m) bears for ever: that of an edge, by its size.

    The size factor of bending and torsion is 1.24 d^-0.107 from 2.79 to 51 mm (Budynas and Nisbett
    2020, eq. 6-19), and no more than 1.

    Examples
    --------
    >>> from cqdd_design.catalog.materials import find_material
    >>> round(shaft_limit_fatigue(find_material("AISI 4140 Q&T 540C"), 10e-3).value / 1e6)
    275
    """
    edge = edge_limit_fatigue(material)
    size = min(1.24 * min(max(1e3 * diameter, 2.79), 51.0) ** -0.107, 1.0)
    return Allowable(size * edge.value, f"{size:.2f} (size) x {edge.basis}")


# Dowels ----------------------------------------------------------------------------------------
DOWEL_SAFETY = 1.5
"""Against breaking in shear, at the peak torque."""


def dowel_limit_shear() -> Allowable:
    """Shear stress of a ground dowel at the peak torque.

    Examples
    --------
    >>> round(dowel_limit_shear().value / 1e6)
    597
    """
    return Allowable(
        SHEAR_STRENGTH / DOWEL_SAFETY,
        f"{SHEAR_STRENGTH / 1e6:.0f} MPa/{DOWEL_SAFETY:g}, hardened ground pins in single shear",
    )


def dowel_limit_seat(*materials: Material) -> Allowable:
    """Mean pressure of a dowel on the weaker of its seats at the peak torque: S_y/1.2.

    DIN 6892 (method C) lets keys press as hard as 0.9 S_y.
    """
    return min((_yield_share(one, 1.0, "S_y") for one in materials), key=lambda limit: limit.value)


# Screws ---------------------------------------------------------------------------------------
SLIP_SAFETY = 1.2
"""On slipping at the peak torque (VDI 2230, section 5.5.6: static loads)."""
THREAD_SAFETY = STRIPPING_SAFETY
"""On stripping at the greatest preload, which stated tightening torques leave."""
PROOF_SHARE = 0.88
"""Proof stress over yield strength of class 12.9, 970 of 1100 MPa (ISO 898-1, table 3)."""


def screw_limit(material: Material, share: float = PROOF_SHARE) -> Allowable:
    """Tension of a screw at its greatest preload; by a share of 1, its stress in use (VDI 2230).

    Examples
    --------
    >>> from cqdd_design.catalog.materials import find_material
    >>> round(screw_limit(find_material("Alloy steel 12.9 (ISO 7379)")).value / 1e6)
    950
    """
    strength = material.yield_strength
    if strength is None:
        return Allowable(0.0, f"no yield strength in the catalogue for {material.name}")
    return Allowable(share * strength, f"{share:g} S_y {strength / 1e6:.0f} MPa ({material.name})")


# Bell -----------------------------------------------------------------------------------------
BOND_SAFETY = SAFETY
"""On the strength of a retaining compound, which layouts of the bell's hub take too."""


def bond_limit(compound: RetainingCompound, hub: Material, temperature: float) -> Allowable:
    """Shear stress of a bonded joint of a steel shaft and a hub at a temperature, deg C.

    Examples
    --------
    >>> from cqdd_design.catalog.adhesives import ROTOR_COMPOUND
    >>> from cqdd_design.catalog.materials import find_material
    >>> round(bond_limit(ROTOR_COMPOUND, find_material("7075-T6"), 22.0).value / 1e6, 2)
    6.25
    """
    on, hot = compound.share_on(hub), compound.share_at(temperature)
    return Allowable(
        compound.strength * on * hot / BOND_SAFETY,
        f"{compound.strength / 1e6:g} MPa of {compound.name} on steel x {on:g} ({hub.name}) x "
        f"{hot:.2f} ({temperature:.0f} degC)/{BOND_SAFETY:g}; {compound.source}",
    )


# Retention -------------------------------------------------------------------------------------
LEAST_WALL_BETWEEN_HOLES = 0.4e-3
"""Between drilled holes, and from them to rims, m (house rule: less tears in drilling)."""

# Heat ------------------------------------------------------------------------------------------
GREASE_MOST = 120.0
"""Grease at the teeth, pins and bearings, deg C: upper limit of a lithium grease of NLGI 2 (SKF
LGMT 2, operating range -30 to 120 deg C); bearing steel is stabilised to the same."""
HOUSING_MOST = 120.0
"""Housing of a material whose limit the catalogue does not have, deg C."""
BINDING_OVERLAP = 0.1
"""Overlap of rigid parts, um, that still counts as touching: what the search itself leaves."""
