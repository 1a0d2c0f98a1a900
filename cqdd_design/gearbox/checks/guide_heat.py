"""Rule, reason and source of the checks of :mod:`.heat`."""

from __future__ import annotations

from cqdd_design.catalog.motors import WINDING_MOST
from cqdd_design.gearbox.checks import allowables as limits
from cqdd_design.gearbox.checks.guide_row import NETWORK, CheckGuide

_NETWORK = f"{NETWORK}, cqdd_design.machine.thermal_parts"

ROWS = (
    CheckGuide(
        "THERMAL-RISE",
        "Steady temperature of winding, grease and housing",
        "degC",
        "max",
        f"winding <= {WINDING_MOST:g}, warmest greased part <= {limits.GREASE_MOST:g} and what its "
        "lubricant bears, "
        "housing and parts of the gearbox <= what their material bears",
        "At the duty, or at the continuous torque and input speed for ever, parts settle where "
        "their losses are carried off: by still air alone, or by what drive.thermal_resistance "
        "states; over a duty each is judged at its hottest moment. Shown is the part that uses "
        "most of the rise it is allowed. Losses are those of "
        "parts at these temperatures: their clearances, films and grease, copper and magnets. "
        "Where warm parts have none it is judged by those at 20 degC, and never passes by them.",
        f"{_NETWORK}; limits: IEC 60085 class E, SKF LGMT 2, catalogue of materials",
        basis=NETWORK,
    ),
    CheckGuide(
        "THERMAL-CLEARANCE",
        "Overlap of parts between coldest start and hottest state",
        "um",
        "max",
        "max over states of (overlap that no motion removes - that as drawn) <= "
        f"{limits.BINDING_OVERLAP:g}",
        "A carrier of aluminium grows away from discs of steel, and discs that are warmer than "
        "their ring fill it. Parts that overlap press on each other without load: friction and "
        "heat rise, and the gearbox may stall. Looked at are the coldest start, states on the way "
        "from it, and the steady one.",
        f"{_NETWORK}; backlash of rigid parts, cqdd_design.gearbox.heat.expansion",
        basis=NETWORK,
    ),
)
