"""Rule, reason and source of the checks of :mod:`.runners`."""

from __future__ import annotations

from cqdd_design.gearbox.checks import allowables as limits
from cqdd_design.gearbox.checks.guide_row import (
    HOUSE,
    RIGID,
    SCREENED,
    SHIGLEY,
    CheckGuide,
)

_HARD = f"ISO 76 and ISO 281 presume raceways of {limits.HARDENED_HRC:g} HRC and more"


def _rows(prefix: str, name: str, pins: str, load: str, turn: str) -> tuple[CheckGuide, ...]:
    """The checks of sleeves, or of rollers."""
    return (
        CheckGuide(
            f"GEO-{prefix}-WALL",
            f"Wall of the {name}s",
            "mm",
            "min",
            f"(d_{name} - d_pin)/2 >= {1e3 * limits.SLEEVE_WALL:g} mm, "
            "from the outside of the needle cage where there is one",
            "Thinner bushes cannot be bought or ground, and crack under line load.",
            HOUSE,
        ),
        CheckGuide(
            f"{prefix}-STATIC",
            f"Needles of the {name}s, static safety at peak torque",
            "",
            "min",
            f"C0/P >= {limits.STATIC_SAFETY:g}, P = F, F {load} on one disc",
            f"Beyond C0 the needles dent pin and {name}, which then turn no more. {SCREENED}",
            "ISO 76:2006",
            basis=RIGID,
        ),
        CheckGuide(
            f"{prefix}-LIFE",
            f"Needles of the {name}s, basic rating life at continuous torque",
            "h",
            "min",
            f"L10h = 1e6 (C/P)^(10/3)/(60 rpm {turn}) >= required life, of all together "
            "over the duty",
            f"A {name} rolls on the disc as fast as the surface that passes it. {SCREENED}",
            "ISO 281:2007",
            basis=RIGID,
        ),
        CheckGuide(
            f"{prefix}-RACEWAY",
            f"{pins} hard enough to be a raceway",
            "HRC",
            "min",
            f"hardness of the pins, and of {name}s of the same steel, >= "
            f"{limits.HARDENED_HRC:g} HRC where needles run on them",
            "Needles running on softer steel wear and pit it within hours.",
            _HARD,
        ),
    )


ROWS = (
    *_rows("SLEEVE", "sleeve", "Output pins", "of one output pin", "2 e (1 + 1/n)/d_sleeve"),
    *_rows("ROLLER", "roller", "Ring pins", "of one tooth", "2 (R + (n+1) e - r)/(n d_roller)"),
    *(
        CheckGuide(
            f"RING-PIN-BENDING-{load.upper()}",
            f"Bending stress of ring pins under rollers, {load} torque",
            "MPa",
            "max",
            f"sigma = 32 M/(pi d^3) <= {limit}, M = F (a(L-a)/L - b/8)",
            "A pin in a pocket is backed all along; under rollers it spans from housing to clamp. "
            f"{SCREENED}",
            f"beam theory; {SHIGLEY}",
            basis=RIGID,
        )
        for load, limit in (
            ("peak", f"S_y/{limits.PIN_SAFETY_AT_PEAK:g}"),
            ("continuous", "pulsating fatigue strength"),
        )
    ),
)
