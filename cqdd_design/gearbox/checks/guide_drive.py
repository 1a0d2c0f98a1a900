"""Rule, reason and source of the checks of :mod:`.drive`, and of the solids' collisions."""

from __future__ import annotations

from cqdd_design.gearbox.balance import BALANCING_PLANES
from cqdd_design.gearbox.checks import allowables as limits
from cqdd_design.gearbox.checks.guide_row import HOUSE, PAPER, CheckGuide

_EFFICIENCY = "motor catalogue; efficiency assumed at the low end of measured steel cycloid drives"
_LOW, _HIGH = limits.COMPUTED_EFFICIENCIES
_COMPUTED = (
    f"The efficiency of {limits.REDUCER_EFFICIENCY:g} is assumed: the losses that `analyse` "
    f"computes leave {_LOW:g} to {_HIGH:g} at ratio 10 and a friction of 0.08, for which the motor "
    f"needs {100.0 * (limits.REDUCER_EFFICIENCY / _HIGH - 1.0):.0f} to "
    f"{100.0 * (limits.REDUCER_EFFICIENCY / _LOW - 1.0):.0f} % more torque."
)

ROWS = (
    CheckGuide(
        "BALANCE-STATIC",
        "Static unbalance of the crank",
        "g*mm",
        "max",
        f"|sum m r| <= sum m G/omega, G {1e3 * limits.BALANCE_GRADE:g}",
        "A shaking force at every turn of the input; one disc alone has it, two or three cancel. "
        "Counted are discs, cam bearings and eccentrics, and balance weights as they are drawn.",
        f"ISO 21940-11, grade G {1e3 * limits.BALANCE_GRADE:g}",
        "warn",
    ),
    CheckGuide(
        "BALANCE-COUPLE",
        "Shaking couple against the cam load",
        "N",
        "max",
        f"|sum m r z| omega^2/(D b) <= {limits.SHAKING_SHARE:g} P_continuous",
        "Discs in different planes leave a couple that shakes the shaft's bearings.",
        HOUSE,
        "warn",
    ),
    CheckGuide(
        "BALANCE-WEIGHTS",
        "Balance weights that can be built",
        "",
        "min",
        f"weights drawn >= {BALANCING_PLANES} where balance.counterweights = true",
        "The weights sit on the motor's bell in two planes, which together cancel force and "
        "couple. Where they find no place, or not enough room, nothing is balanced and the machine "
        "as designed cannot be built. Shown only then.",
        "layout of the parts",
    ),
    CheckGuide(
        "DISC-COUNT",
        "Number of discs",
        "",
        "min",
        f"D >= {limits.LEAST_BALANCED_DISCS} "
        "(the paper: N_Z = 2 for an even ratio, 3 for an odd one)",
        "Two discs opposite each other balance statically at any ratio. The paper's rule is "
        "reported, not imposed: balance does not depend on the parity of the ratio, and three "
        "discs in the same length carry less.",
        f"{PAPER}, section III-B; statics of rotating masses",
        "warn",
    ),
    CheckGuide(
        "MOTOR-PEAK",
        "Motor peak torque",
        "N*m",
        "max",
        f"T_peak/(n eta) <= T_motor,peak, eta = {limits.REDUCER_EFFICIENCY:g}",
        f"The motor has to reach the peak torque through the reducer and its losses. {_COMPUTED}",
        _EFFICIENCY,
        "warn",
    ),
    CheckGuide(
        "MOTOR-CONTINUOUS",
        "Motor rated torque",
        "N*m",
        "max",
        f"T_continuous/(n eta) <= T_motor,rated, eta = {limits.REDUCER_EFFICIENCY:g}",
        f"Above its rated torque the winding overheats in continuous duty. {_COMPUTED}",
        _EFFICIENCY,
        "warn",
    ),
    CheckGuide(
        "MOTOR-SPEED",
        "Motor no-load speed",
        "rpm",
        "min",
        "KV U >= input speed",
        "At the supply voltage the motor has to reach the input speed at all.",
        "motor catalogue",
        "warn",
    ),
    CheckGuide(
        "MOTOR-BORE",
        "Ring inside the motor's stator",
        "mm",
        "max",
        "D_ring <= stator bore",
        "The reducer sits inside the stator.",
        f"motor catalogue; {PAPER}, section III-A",
        "warn",
    ),
    CheckGuide(
        "MOTOR-DATA",
        "Motor data that the checks need",
        "",
        "min",
        "known figures of: peak torque, rated torque, speed constant, stator bore",
        "What is not known cannot be checked: without these figures nothing says that the motor "
        "is enough. Shown only where one is missing, or a geared actuator stands for a motor.",
        "motor catalogue",
        "warn",
    ),
    CheckGuide(
        "ASSEMBLY-CLEAR",
        "Solids that run into each other",
        "",
        "max",
        "overlaps thicker than the facets of both meshes <= 0",
        "A part in the wrong phase, or too long, shows as an overlap somewhere in a revolution.",
        "intersection of the solids' meshes at every crank angle (`check --assembly`)",
    ),
)
