"""What the checks of dowels, of bonds and of screws mean."""

from __future__ import annotations

from cqdd_design.catalog.tightening import (
    GRIP_FRICTION,
    SHEAR_SHARE,
    TIGHTENING_FACTOR,
    UTILISATION,
)
from cqdd_design.gearbox.checks import allowables as limits
from cqdd_design.gearbox.checks.guide_row import CheckGuide

_EQUILIBRIUM = "contact equilibrium of perfect parts, driving with friction"
_VDI = "VDI 2230 part 1 (2015), concentric clamping"
_ROLOFF = "Wittel and others 2017, Roloff/Matek Maschinenelemente, section 9.3"

ROWS = (
    CheckGuide(
        "DOWEL-SHEAR",
        "Shear of the dowels of ring and output, peak torque",
        "MPa",
        "max",
        "ring: tau = F/(d l) along its seam; output: F/(pi/4 d^2); F = T/(0.75 N R) <= "
        f"strength/{limits.DOWEL_SAFETY:g}",
        "The ring takes the output's torque and the crank's, and nothing but its dowels holds it "
        "where the clamp's friction is not counted; the output's flange likewise.",
        f"{_ROLOFF}; share of several: DIN 6892; ASME B18.8.2 (strength), ISO 8734 (sizes)",
        basis=_EQUILIBRIUM,
    ),
    CheckGuide(
        "DOWEL-BEARING",
        "Pressure of dowels and output pins on their seats, peak torque",
        "MPa",
        "max",
        "ring: p = 2 F/(d l), half a dowel in either part; output: F/(d l); F = T/(0.75 N R); "
        "pins: 4 F/(d l) + 6 M/(d l^2) at the mouth of their seats in plate and cap <= "
        f"S_y/{limits.PIN_SAFETY_AT_PEAK:g} of the weaker seat",
        "A seat in aluminium or plastic that yields lets ring, flange or pin give way a little at "
        "every change of sense.",
        f"{_ROLOFF}; share of several: DIN 6892",
        basis=_EQUILIBRIUM,
    ),
    CheckGuide(
        "BELL-JOINT",
        "Shear of the bond of rotor bell and shaft, motor's peak torque",
        "MPa",
        "max",
        "tau = 2 T/(pi d^2 l) <= strength of the compound x share on the bell x share at its "
        f"temperature/{limits.BOND_SAFETY:g}",
        "All that the motor gives goes through the hub of its bell, which nothing but a retaining "
        "compound holds on the shaft's stub; of a hub longer than two diameters no more counts.",
        "Wittel and others 2017, Roloff/Matek Maschinenelemente, section 5.1 (bonded hubs); ISO "
        "10123 (strength)",
        basis="torque at the driver's current, at most the motor's peak; hub as drawn; temperature "
        "of the thermal network",
    ),
    CheckGuide(
        "CAM-JOINT",
        "Shear of the bond of a third disc's loose cam and the shaft, peak torque",
        "MPa",
        "max",
        "tau = 2 T/(pi d^2 l), T = e F_t of its disc's force <= strength of the compound x share "
        f"at its temperature/{limits.BOND_SAFETY:g}; the press fit, whose zones may leave play, "
        "counts for nothing",
        "A bearing cannot pass two lobes, so a third disc's cam is put on the shaft afterwards. "
        "What its disc asks of the motor goes through that joint; where it gives way the cam turns "
        "out of its phase, and the gearbox jams. No lasting strength of such a bond is known: what "
        "the duty asks of it is told beside the peak.",
        "Wittel and others 2017, Roloff/Matek Maschinenelemente, section 5.1 (bonded hubs); ISO "
        "10123 (strength)",
        basis=f"{_EQUILIBRIUM}; temperature of the thermal network",
    ),
    CheckGuide(
        "SCREW-SLIP",
        "Screwed joints, least clamping force over what holds them at peak torque",
        "",
        "min",
        f"mu (F_M/alpha_A - F_Z - F_th - F_A)/F_Q >= {limits.SLIP_SAFETY:g}, mu {GRIP_FRICTION:g}, "
        f"alpha_A {TIGHTENING_FACTOR:g}, F_M of the stated tightening torque",
        "A joint that slips wears, loosens its screws and shears them. Short screws lose a third "
        "of their preload as faces settle, and some in the cold, where aluminium shrinks by more "
        "than they do (F_th, at environment.coldest).",
        f"{_VDI}, slipping and embedding",
        basis=_EQUILIBRIUM,
    ),
    CheckGuide(
        "SCREW-PRELOAD",
        "Screws, tension as they are tightened or stress in use",
        "MPa",
        "max",
        f"F_M/A_S <= {limits.PROOF_SHARE:g} S_y; F_M = what {UTILISATION:g} S_y in tension and "
        "torsion, the seat of the head at its S_y and the thread all bear, in plastics of known "
        "creep for long; in use sqrt(((F_M + F_th)/A_S)^2 + 3 (tau_M/2)^2) <= S_y",
        "More torque gains nothing: screw, seat or thread yields. Less lets the joint slip. Warm "
        "aluminium stretches its screws.",
        f"{_VDI}, table A1, eq. R8/4; ISO 898-1",
    ),
    CheckGuide(
        "SCREW-THREAD",
        "Threads of screws, stripping over the greatest preload",
        "",
        "min",
        f"F_mG/F_M >= {limits.THREAD_SAFETY:g}, F_mG = {SHEAR_SHARE:g} S_u pi d (m - 0.8 P) "
        "(1/2 + (d - D_2) tan 30deg/P) of the part it is in",
        "Aluminium and plastic strip before the screw breaks where too few turns engage.",
        f"{_VDI}, section 5.5.5",
    ),
    CheckGuide(
        "SCREW-CREEP",
        "Screwed joints in plastic, clamping force after 1000 h over what holds them at peak",
        "",
        "min",
        f"mu (F_V delta/delta_c - F_A)/F_Q >= {limits.SLIP_SAFETY:g}: delta of screw and plastic "
        "when new, delta_c with E_c after 1000 h at 23 degC",
        "A plastic under a head and round a thread goes on yielding, and a stiff screw loses its "
        "tension in hours. Such screws are tightened no further than seat and thread "
        "bear for long.",
        f"{_VDI}, resilience; ISO 899-1 by makers' sheets; Crawford, Plastics Engineering (moduli "
        "of creep in formulas of elastic bodies)",
        basis=_EQUILIBRIUM,
    ),
    CheckGuide(
        "SCREW-TOOL-ACCESS",
        "Screws that no key turns as the machine is put together",
        "",
        "max",
        "steps of the order of assembly at which a part in place is in the way of the screws' key, "
        "and neither does its long arm stand out 20 mm of what is within 10 mm of it nor, above "
        "what is lower, turn by 60 deg with the short arm in the socket; and 1 where there is no "
        "order = 0",
        "A screw that cannot be tightened at its step holds nothing.",
        "the parts as drawn, cqdd_design.solids.tool_access; ISO 2936",
    ),
)
