"""Rule, reason and source of what is judged only where the requirements ask for it."""

from __future__ import annotations

from cqdd_design.gearbox.checks.guide_row import DRAWN, NETWORK, CheckGuide

_ASKED = "the requirements"
_SOLIDS = "solids in closed form"
_EQUILIBRIUM = "contact equilibrium of perfect parts"

ROWS = (
    CheckGuide(
        "BACKLASH",
        "Backlash of 95 % of the gearboxes",
        "arcmin",
        "max",
        "95th percentile of drawn gearboxes <= the required backlash",
        "A position is known no better than the play of what stands between it and the encoder.",
        _ASKED,
        basis=DRAWN,
    ),
    CheckGuide(
        "LOST-MOTION",
        "Lost motion at 3 % of the continuous torque",
        "arcmin",
        "max",
        "mean range of the output between -3 % and +3 % <= the required lost motion; of perfect "
        "parts, or of those drawn where their 95th percentile of backlash is larger",
        "Backlash and the first, soft part of the teeth's give: what a small load moves.",
        "the requirements; definition of lost motion in catalogues of precision gears",
        basis=_EQUILIBRIUM,
    ),
    CheckGuide(
        "STIFFNESS",
        "Stiffness of 95 % of the gearboxes",
        "N*m/arcmin",
        "min",
        "5th percentile of drawn gearboxes, at 20 degC and at least clearance, >= the required "
        "stiffness",
        "A soft joint swings: the first mode of a limb is that of its inertia on this spring.",
        _ASKED,
        basis=DRAWN,
    ),
    CheckGuide(
        "EFFICIENCY",
        "Efficiency of the gearbox",
        "",
        "min",
        "work out over work in while the motor drives >= the required efficiency",
        "What is lost is heat, and torque that the motor has to give beside the load's.",
        _ASKED,
        basis="losses by the equilibrium",
    ),
    CheckGuide(
        "MASS",
        "Mass of the actuator",
        "kg",
        "max",
        "mass <= the required mass",
        "Every joint carries the ones behind it.",
        _ASKED,
        basis=_SOLIDS,
    ),
    CheckGuide(
        "REFLECTED-INERTIA",
        "Inertia felt at the output",
        "kg*m^2",
        "max",
        "ratio^2 times that of the crank with the rotor <= the required reflected inertia",
        "What meets an obstacle is this inertia, not the limb's alone.",
        _ASKED,
        basis=_SOLIDS,
    ),
    CheckGuide(
        "SURFACE-TEMPERATURE",
        "Temperature of housing and cover",
        "degC",
        "max",
        "the warmer of both <= the required surface temperature",
        "People touch it, and what is glued to it has a limit of its own.",
        _ASKED,
        basis=NETWORK,
    ),
    CheckGuide(
        "BORE",
        "Bore through the middle",
        "mm",
        "min",
        "hole through the shaft >= the required bore",
        "Cables and shafts go through it, past an encoder that stands beside the shaft.",
        _ASKED,
        basis="the drawn parts",
    ),
    CheckGuide(
        "PEAK-AT-SPEED",
        "Peak torque at the speed asked for",
        "N*m",
        "min",
        "torque at the required speed at peak >= the required peak torque",
        "A motor's torque falls where its EMF takes the supply's voltage.",
        "motor catalogue; losses of the gearbox",
        basis="operating points of the simulated actuator",
    ),
    CheckGuide(
        "SHOCK-STOP",
        "Torque of a rigid stop",
        "N*m",
        "max",
        "torque when the output stops at the required shock speed <= what the gearbox carries",
        "Legs hit things: rotor and crank run on, and the gearbox is the spring that stops them. "
        "The motor is off; what it asks where it drives on is told beside.",
        "time simulation of the stopped output; static limits of the checks",
        basis="simulated actuator, its phases open",
    ),
)
