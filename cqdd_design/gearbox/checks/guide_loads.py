"""Rule, reason and source of the checks of :mod:`.loads`."""

from __future__ import annotations

from cqdd_design.gearbox.checks import allowables as limits
from cqdd_design.gearbox.checks.guide_row import (
    HOUSE,
    JOHNSON,
    PAPER,
    PITTING,
    RIGID,
    SCREENED,
    SHIGLEY,
    WANG,
    CheckGuide,
)

_YIELD = f"S_y/{limits.PIN_SAFETY_AT_PEAK:g}"
_PAPER_SHEAR = f"S_u/{1.0 / limits.PAPER_SHEAR_SHARE:g}"
_PRESSURE = "p0 = sqrt(F E*/(pi b R_eq)) <= "
_RING, _PIN = ("RING", "at the ring"), ("PIN", "of pins in holes")
_PEAK = ("PEAK", f"{limits.FIRST_YIELD_FACTOR:g} S_y", JOHNSON)
_CONTINUOUS = (
    "CONTINUOUS",
    f"what lasts the required hours over the duty, {limits.AGMA_SLOPE / 1e6:g} HB + "
    f"{limits.AGMA_BASE / 1e6:g} MPa at 1e7 cycles",
    PITTING,
)

_CONTACTS = tuple(
    CheckGuide(
        f"CONTACT-{place}-{load}",
        f"Hertz pressure {where}, {load.lower()} torque",
        "MPa",
        "max",
        _PRESSURE + limit,
        f"Above it {what}. {SCREENED}",
        source,
        basis=RIGID,
    )
    for (place, where), (load, limit, source), what in (
        (_RING, _PEAK, "the material yields below the surface and the flank dents"),
        (_RING, _CONTINUOUS, "the flank pits before its hours are over"),
        (_PIN, _PEAK, "pin or hole yields below the surface"),
        (_PIN, _CONTINUOUS, "pin or hole pits before its hours are over"),
    )
)

ROWS = (
    *_CONTACTS,
    CheckGuide(
        "PIN-PAPER",
        "Output pins by the paper's method",
        "N*m",
        "min",
        f"N_w (pi/4) d^2 ({_PAPER_SHEAR}) R_w >= peak torque",
        "The paper's own figure: every pin in single shear at full load and full radius at once. "
        "It leaves out sharing, bending and fatigue, and is reported for comparison.",
        f"{PAPER}, section III-A",
        basis="the paper's method, for comparison",
    ),
    CheckGuide(
        "PIN-SHARED",
        "Output pins in shear with load sharing",
        "N*m",
        "min",
        f"D N_w R_w F/k >= peak torque, F = (pi/4) d^2 {_PAPER_SHEAR}, k = 4 (even N_w)",
        "The paper's shear strength with the torque shared as rigid discs share it.",
        f"{PAPER} (strength); rigid sharing: Kudryavtsev 1966; {WANG}",
        basis="the paper's strength and rigid sharing, for comparison",
    ),
    CheckGuide(
        "PIN-SHEAR-PEAK",
        "Shear stress of the output pins, peak torque",
        "MPa",
        "max",
        f"tau = F/((pi/4) d^2) <= {limits.SHEAR_YIELD_SHARE:g} {_YIELD}",
        f"A pin sheared past yield takes a set and the sharing is lost. {SCREENED}",
        SHIGLEY,
        basis=RIGID,
    ),
    CheckGuide(
        "PIN-BENDING-PEAK",
        "Bending stress of the output pins, peak torque",
        "MPa",
        "max",
        f"sigma = 32 M/(pi d^3) <= {_YIELD}, M from the forces of all discs on a slender "
        "beam between plate and cap, which turns until the pins' and columns' torque on it is zero",
        "Thin pins bend long before they shear; a bent pin jams in its holes. A cap that hangs on "
        f"the pins bears none of the torque: they carry it to the plate, bent there. {SCREENED}",
        f"beam theory; {SHIGLEY}; {WANG} (pin stress)",
        basis=RIGID,
    ),
    CheckGuide(
        "PIN-BENDING-CONTINUOUS",
        "Bending stress of the output pins, continuous torque",
        "MPa",
        "max",
        "sigma = 32 M/(pi d^3) <= what lasts the required hours over the duty",
        "Every pin is loaded and unloaded once per disc and relative turn: a million cycles in a "
        f"day's running. {SCREENED}",
        f"about S_u/{1.0 / limits.PIN_FATIGUE_SHARE:g} for shoulder screws ({HOUSE}); "
        "Goodman line where the duty reverses",
        basis=RIGID,
    ),
    CheckGuide(
        "PIN-BEARING-PEAK",
        "Mean pressure of pins in holes, peak torque",
        "MPa",
        "max",
        f"F/(d b) <= {_YIELD} of the weaker part",
        f"Above it the hole stretches. {SCREENED}",
        SHIGLEY,
        basis=RIGID,
    ),
    CheckGuide(
        "PIN-RUBBING",
        "Pressure times speed of plastics at the output pins",
        "MPa m/s",
        "max",
        "p v <= what the plastic bears dry on steel, p = mean F/(d b), v = e (1 + 1/n) omega; of "
        "plain sleeves, where they turn on their pin",
        "Above it the surface softens and wears away within hours. Judged at the continuous torque "
        "and its speed, under a duty at its step of the most power, where a disc, pin or "
        "sleeve of plastic slides; needles roll.",
        "maker's handbook, named with the limit (`cqdd-design catalog rubbing`)",
        basis="contact equilibrium of perfect parts, driving with friction",
    ),
    CheckGuide(
        "BEARING-STATIC",
        "Cam bearing, static safety at peak torque",
        "",
        "min",
        f"C0/P >= {limits.STATIC_SAFETY:g}, "
        "P = |sum of ring forces + sum of pin forces| of one disc",
        "Beyond C0 the balls dent the raceway. The output-pin reaction counts: leaving it out "
        f"understates P by a fifth and overstates the life almost twofold. {SCREENED}",
        "ISO 76:2006",
        basis=RIGID,
    ),
    CheckGuide(
        "BEARING-LIFE",
        "Cam bearings together, basic rating life over the duty",
        "h",
        "min",
        "L10h = 1e6 (C/P)^p/(60 rpm (1 + 1/n)) >= required life",
        "The crank turns faster against the disc than against the housing. Of several bearings "
        "the first to fail counts, on the load as it varies over the period and the duty; the "
        f"first screen takes the greatest load on one. {SCREENED}",
        "ISO 281:2007",
        basis=RIGID,
    ),
    CheckGuide(
        "BEARING-RACEWAY",
        "Disc hard enough to be a raceway",
        "HRC",
        "min",
        f"disc hardness >= {limits.HARDENED_HRC:g} HRC where a needle cage has no outer ring",
        "Needles running in softer steel wear and pit it within hours.",
        f"ISO 76 and ISO 281 presume raceways of {limits.HARDENED_HRC:g} HRC and more",
    ),
)
