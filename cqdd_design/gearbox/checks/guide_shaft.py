"""What the checks of the shaft and of its bearings and the output's mean."""

from __future__ import annotations

from cqdd_design.gearbox.checks import allowables as limits
from cqdd_design.gearbox.checks.guide_row import CheckGuide

_EQUILIBRIUM = "contact equilibrium of perfect parts, driving with friction"
_PULL = (
    "Maxwell's stress on a first-order field in the gap, magnets of the height that pulls most, "
    "cqdd_design.solids.rotor_pull"
)
_STATICS = "statics of the shaft, cqdd_design.machine.shaft_strength"
_BUDYNAS = "Budynas and Nisbett 2020, Shigley's Mechanical Engineering Design, section 7-4"

ROWS = (
    CheckGuide(
        "SHAFT-STRENGTH",
        "Stress of the eccentric shaft, peak torque",
        "MPa",
        "max",
        f"sqrt(sigma^2 + 3 tau^2) <= S_y/{limits.PIN_SAFETY_AT_PEAK:g} at every change of section",
        "The cam bearing's bore and the eccentricity leave a thin core and thinner journals; the "
        "motor's torque passes through the lower one.",
        f"{_BUDYNAS}; {_STATICS}",
        basis=_EQUILIBRIUM,
    ),
    CheckGuide(
        "SHAFT-FATIGUE",
        "Reversed stress of the eccentric shaft over the duty",
        "MPa",
        "max",
        "sigma_a/(1 - sigma_m/S_u) <= S_e, von Mises with the notch factors of the shoulders",
        "What turns with the crank bends the shaft always the same way, but each start from rest "
        "and each change of sense is a cycle, and shoulders concentrate it.",
        f"{_BUDYNAS}; Young and Budynas 2002, Roark's Formulas, table 17.1 (shoulders in bending); "
        f"Pilkey and Pilkey 2008, chart 3.12 (in torsion); {_STATICS}",
        basis=_EQUILIBRIUM,
    ),
    CheckGuide(
        "SHAFT-CAM-WALL",
        "Stress of a third disc's loose cam at its thin side, tightest fit",
        "MPa",
        "max",
        f"sqrt(s^2 + s p + p^2) <= S_y/{limits.PIN_SAFETY_AT_PEAK:g}: s round the bore and p "
        "across it of an eccentric ring pressed on a solid core, p with 4 F/(pi d l) of its "
        "disc's force",
        "The wall between bore and lobe is about a millimetre where it is thinnest, and has to "
        "stretch more than the rest. A ring that yields or cracks there no longer bears its lobe. "
        "Cold or hot it is the same: cam and shaft are of one steel. Left out: bending of the "
        "shaft, which SHAFT-FATIGUE judges with the notch of a hub that is pressed on.",
        "Muskhelishvili 1953, Some Basic Problems of the Mathematical Theory of Elasticity, "
        "sections 32 and 41; cqdd_design.gearbox.eccentric_ring",
        basis=f"{_EQUILIBRIUM}; fit by the zones that are drawn",
    ),
    CheckGuide(
        "SUPPORT-STATIC",
        "Support bearings of the shaft, static safety at peak torque",
        "",
        "min",
        f"C0/P >= {limits.STATIC_SAFETY:g}, P from the forces of all discs on the shaft and of the "
        "rotor on its stub",
        "The discs' forces are a couple that its two bearings hold, and the motor's rotor pulls "
        "at a lever on them; beyond C0 they take dents. They are chosen by the room that the cam "
        "bearing's bore leaves.",
        f"ISO 76:2006; {_STATICS}",
        basis=_EQUILIBRIUM,
    ),
    CheckGuide(
        "SUPPORT-LIFE",
        "Support bearings of the shaft together, basic rating life over the duty",
        "h",
        "min",
        "L10h = 1e6 (C/P)^3/(60 rpm) >= required life, of both together over the duty",
        "They turn as fast as the motor. The one in the carrier turns against it, 1 + 1/n times "
        "as fast as the crank.",
        f"ISO 281:2007; {_STATICS}",
        basis=_EQUILIBRIUM,
    ),
    CheckGuide(
        "SHAFT-ROTOR-GAP",
        "Share of the motor's air gap that its rotor takes off centre",
        "%",
        "max",
        f"(e + y)/g <= {100.0 * limits.AIR_GAP_SHARE:g} %, e = g/10, y of shaft, balls and web "
        "under k (e + y), weight and unbalance; k = pi D l B^2/(2 mu_0 (g + h))",
        "A rotor off its stator's axis is pulled farther off by its own magnets. What carries it, "
        "the shaft's stub and the web of bell or hub, has to be stiffer than that pull grows, or "
        "the rotor touches.",
        f"{_PULL}; Timoshenko 1955, Strength of Materials (stepped beam; Kirchhoff's plate); "
        "Harris and Kotzalas 2006, Rolling Bearing Analysis (balls); limit: house rule",
        basis="parts as drawn, at the input speed",
    ),
    CheckGuide(
        "SHAFT-STUB",
        "Reversed stress of the shaft at its stub, duty and the pull on the rotor",
        "MPa",
        "max",
        "sigma_a of the duty + K_f F a/W <= S_e, F on the rotor, a to where the stub begins",
        "The rotor's weight and pull stand still while the shaft turns under them: each turn is a "
        "cycle, on top of what the discs do.",
        f"{_BUDYNAS}; {_PULL}; {_STATICS}",
        basis=_EQUILIBRIUM,
    ),
    CheckGuide(
        "OUTPUT-STATIC",
        "Output bearing, static safety at peak torque and external loads",
        "",
        "min",
        f"C0/P0 >= {limits.STATIC_SAFETY:g}; crossed rollers: P0 = F_r + 2 M/d_p + 0.44 F_a; "
        "balls: 0.6 F_r + 0.5 (F_a + 4.37 M/d_p), at least F_r, and 4 (F_a + 4.37 M/d_p) (2 of the "
        "diameter series 2 to 4)",
        "Pins and shaft push the carrier from one side and tilt it, and what hangs on the joint "
        "(requirements.external_moment, external_axial, external_radial) adds to that.",
        "THK, General Catalog, Cross-Roller Ring; SKF, Rolling bearings, deep groove ball "
        "bearings, loads; ISO 76:2006; Harris and Kotzalas 2006, Rolling "
        "Bearing Analysis (balls under a moment)",
        basis=_EQUILIBRIUM,
    ),
    CheckGuide(
        "OUTPUT-LIFE",
        "Output bearing, basic rating life over the duty",
        "h",
        "min",
        "L10h = 1e6 (C/P)^p/(60 rpm) >= required life at the output's speed; crossed rollers: "
        "P = F_r + 2 M/d_p + 0.45 F_a (0.67 and 0.67 beyond F_a = 1.5 of the rest)",
        "It turns slowly, but carries all that the joint carries.",
        "THK, General Catalog, Cross-Roller Ring; ISO 281:2007",
        basis=_EQUILIBRIUM,
    ),
    CheckGuide(
        "OUTPUT-PRELOAD",
        "Output bearing, likely preload by its seats and by heat",
        "um",
        "max",
        "what seats (3 sigma) and the growth of plate and cover take of the clearance of the class "
        "to order, less that clearance, as fitted, at the coldest start and settled <= what the "
        "preloaded class CC0 has, 8 to 10 um on the diameter; balls 5 um (house value)",
        "Beyond it the bearing runs hard and hot: its friction is more than losses count with, and "
        "its life less.",
        "Lame's tubes (Timoshenko and Goodier 1970, section 28); THK, General Catalog, "
        "Cross-Roller Ring (radial clearance); ISO 5753-1; ISO 492",
        basis="closed form",
    ),
)
