"""Rule, reason and source of the checks of :mod:`.bodies`."""

from __future__ import annotations

from cqdd_design.catalog.materials import DESIGN_STRAIN
from cqdd_design.gearbox.checks import allowables as limits
from cqdd_design.gearbox.checks.guide_row import (
    BODIES,
    FINITE_ELEMENTS,
    GOODMAN,
    HOUSE,
    CheckGuide,
)

_PARTS = (
    ("LIGAMENT", "round the holes of a disc", "A ligament that {} opens its hole"),
    ("ROOT", "along the lobes of a disc", "A lobe that {} no longer meshes"),
    ("RING", "along the teeth of the ring, in a rigid housing", "A ring that {} loses its teeth"),
)

_EDGES = tuple(
    row
    for part, where, why in _PARTS
    for row in (
        CheckGuide(
            f"{part}-STRESS",
            f"Stress {where}, peak torque",
            "MPa",
            "max",
            f"|sigma| <= S_y/{limits.PIN_SAFETY_AT_PEAK:g}",
            f"{why.format('yields')}. Contacts and fits are left out: their pressure is judged by "
            "itself.",
            f"{BODIES}; limit: {HOUSE}",
            basis=FINITE_ELEMENTS,
        ),
        CheckGuide(
            f"{part}-FATIGUE",
            f"Reversed stress {where}, continuous torque or duty",
            "MPa",
            "max",
            "sigma_a/(1 - sigma_m/S_u) <= S_e",
            f"{why.format('cracks')}: the same place is pulled and pressed at every turn of the "
            "crank. Compression is given no credit.",
            f"{BODIES}; {GOODMAN}",
            basis=FINITE_ELEMENTS,
        ),
    )
)
ROWS = (
    *_EDGES,
    CheckGuide(
        "PLASTIC-CREEP",
        "Strain of plastic discs and ring, continuous torque or duty held",
        "%",
        "max",
        f"|sigma|/E_c <= {100.0 * DESIGN_STRAIN:g} %, E_c after 1000 h at 23 degC",
        "A plastic goes on yielding under a load that it bears at once, the more the warmer it is; "
        "the greatest stress of a turn is held where the crank stops.",
        f"{BODIES}; ISO 899-1 by makers' sheets; Crawford, Plastics Engineering, p. 19",
        basis=FINITE_ELEMENTS,
    ),
    CheckGuide(
        "PIN-CREEP",
        "Strain of plastic output pins, continuous torque held",
        "%",
        "max",
        f"sigma/E_c <= {100.0 * DESIGN_STRAIN:g} %, sigma of PIN-BENDING-CONTINUOUS, E_c after "
        "1000 h at 23 degC",
        "A pin that stays bent takes its load on one end, and lets the output turn on.",
        "ISO 899-1 by makers' sheets; Crawford, Plastics Engineering, p. 19",
    ),
    CheckGuide(
        "HOUSING-CREEP",
        "Strain of plastic housing, covers and carrier, continuous torque or duty held",
        "%",
        "max",
        f"|sigma|/E_c <= {100.0 * DESIGN_STRAIN:g} %, sigma the greatest nominal stress of seats, "
        "floor, walls, lips, flanges, plate and cap, E_c after 1000 h at 23 degC",
        "Seats that widen lose their bearings and pins, and walls that give way let ring and "
        "motor stand askew. External loads count in full; a pin's seat holds the pin alone, as "
        "once its screw's preload is gone (SCREW-CREEP).",
        "Young and Budynas 2002, Roark's Formulas, sections 8.1 and 10.1, table 11.2; Wittel and "
        "others 2017, Roloff/Matek Maschinenelemente, section 9.3; forces of the contact "
        "equilibrium, cqdd_design.machine.held_stress; ISO 899-1 by makers' sheets; Crawford, "
        "Plastics Engineering, p. 19",
    ),
)
