"""Rule, reason and source of the checks of :mod:`.drive`, and of the solids' collisions."""

from __future__ import annotations

from cqdd_design.gearbox.balance import BALANCING_PLANES
from cqdd_design.gearbox.checks import allowables as limits
from cqdd_design.gearbox.checks.guide_row import HOUSE, PAPER, CheckGuide

_EFFICIENCY = "motor catalogue; losses of the gearbox, cqdd_design.gearbox.losses"
_SCREEN = f"catalogue and an assumed efficiency of {limits.REDUCER_EFFICIENCY:g}, a first screen"
_LOW, _HIGH = limits.COMPUTED_EFFICIENCIES
_SCREENED = (
    "The first screen of a search takes the catalogue's torque, n and "
    f"{limits.REDUCER_EFFICIENCY:g}; losses leave {_LOW:g} to {_HIGH:g} at ratio 10 and a "
    "friction of 0.08, for which the motor needs "
    f"{100.0 * (limits.REDUCER_EFFICIENCY / _HIGH - 1.0):.0f} to "
    f"{100.0 * (limits.REDUCER_EFFICIENCY / _LOW - 1.0):.0f} % more torque."
)

_ASKED_FOR = "exit code 4 from `check` where reducer.balance.counterweights is true"

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
        exception=_ASKED_FOR,
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
        exception=_ASKED_FOR,
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
        "Peak torque of motor and driver at standstill",
        "N*m",
        "min",
        "least of driver, voltage and motor's peak torque at rest, after friction >= peak torque",
        "The motor has to reach the peak torque through the gearbox, about to turn against its "
        "friction, which is kept at the continuous and at the peak torque that are asked for, and "
        f"beyond that goes on growing as up to it. {_SCREENED}",
        _EFFICIENCY,
        basis=_SCREEN,
    ),
    CheckGuide(
        "MOTOR-CONTINUOUS",
        "Torque held for ever at its speed",
        "N*m",
        "min",
        "torque whose heat winding and parts stand for ever at the continuous speed >= continuous "
        "torque",
        "Copper, iron, drag and the gearbox's friction warm the winding to what the air carries "
        "off; driver and voltage count too, and what THERMAL-RISE and THERMAL-CLEARANCE ask of all "
        "parts, to two per cent, from below. The speed is the input speed, unless continuous_speed "
        "gives it one of its own. Under a duty its own heat decides instead. "
        f"{_SCREENED}",
        _EFFICIENCY,
        basis=_SCREEN,
    ),
    CheckGuide(
        "MOTOR-SPEED",
        "Motor speed under the continuous torque",
        "rpm",
        "min",
        "fastest at which voltage, driver and motor give the continuous torque, motor hot or "
        "cold >= input speed",
        "What the winding's resistance takes of the voltage is no speed. Where continuous_speed "
        "gives the continuous torque a speed of its own, that torque is judged there, and none is "
        "asked at the input speed. The first screen takes the speed without load, KV U.",
        "motor catalogue",
        basis=_SCREEN,
    ),
    CheckGuide(
        "MOTOR-BORE",
        "Ring inside the motor's stator",
        "mm",
        "max",
        "D_ring <= stator bore - 2 walls",
        "The reducer sits inside the stator, and the housing's wall round the ring, a millimetre "
        "at 72 mm and in proportion to the ring, between the two.",
        f"motor catalogue; {PAPER}, section III-A",
    ),
    CheckGuide(
        "MOTOR-DATA",
        "Motor data that the lines need",
        "",
        "min",
        "known figures of: peak torque, stator bore, rotor inertia, resistance, torque constant, "
        "drag",
        "What is not known cannot be judged: without these figures nothing says that the motor "
        "is enough. Shown only where one is missing.",
        "motor catalogue",
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
    CheckGuide(
        "CONTACT-REACH",
        "Torque up to which the gearbox has an equilibrium",
        "N*m",
        "min",
        "torque with a contact equilibrium at every crank angle, both senses >= peak torque",
        "Beyond it parts would have to move farther than a quarter of the eccentricity: teeth "
        "jump, or nothing holds. Shown only where it is less than the peak torque.",
        "contact equilibrium, cqdd_design.gearbox.contact",
        basis="contact equilibrium of perfect parts, driving with friction",
    ),
    CheckGuide(
        "DUTY-ENVELOPE",
        "Steps of the duty beyond motor, driver or peak torque",
        "",
        "max",
        "steps outside the torque and speed that driver, voltage and motor reach, cold or hot, or "
        "above the peak torque <= 0",
        "What the actuator cannot do it will not do: the load runs away or stands; and what is "
        "above the peak torque no part is judged for. Shown only with a duty.",
        "motor catalogue; losses of the gearbox",
        basis="operating points of the simulated actuator",
    ),
)
