"""What every check of the gearbox means: rule, reason and source, independent of any design.

:data:`CHECK_GUIDE` is what ``cqdd-design explain`` prints and what the checks are built from, so
the two cannot disagree.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from cqdd_design.errors import UsageError, did_you_mean

_HOUSE = "house rule, fixed in cqdd_design.gearbox.checks.allowables"
_PAPER = "Zhu, Tanaka, Rafeedi and Hong 2024, arXiv:2410.16591"
_JOHNSON = "Johnson 1985, Contact Mechanics, eq. 4.45 (pressure) and section 6.1 (first yield)"
_PITTING = "Johnson 1985, eq. 4.45; AGMA 2101-D04 grade 1, ISO 6336-5 MQ (strengths)"
_WANG = "Wang, Luo and Su 2016, Mech. Mach. Theory 102, 135-148"
_SHIGLEY = "Budynas and Nisbett, Shigley's Mechanical Engineering Design, pinned joints"


@dataclass(frozen=True)
class CheckGuide:
    """What one check means.

    Attributes
    ----------
    id, title, unit, sense, formula, why, source, severity
        As in :class:`cqdd_design.results.Check`.
    """

    id: str
    title: str
    unit: str
    sense: Literal["max", "min"]
    formula: str
    why: str
    source: str
    severity: Literal["fail", "warn"] = "fail"


_ROWS = (
    CheckGuide(
        "GEO-K1-LEAST",
        "Shortening coefficient, least",
        "",
        "min",
        "K1 = e (n+1)/R >= 0.3",
        "Shallow lobes: tooth and cam forces grow as 1/K1, and backlash grows with them.",
        f"{_WANG} (range of K1); {_HOUSE}",
    ),
    CheckGuide(
        "GEO-K1-MOST",
        "Shortening coefficient, most",
        "",
        "max",
        "K1 = e (n+1)/R <= 0.85",
        "Above it the valleys sharpen and the lobes come near to undercut.",
        f"{_WANG} (range of K1); {_HOUSE}",
    ),
    CheckGuide(
        "GEO-UNDERCUT",
        "Tooth radius against undercut",
        "mm",
        "max",
        "r <= 0.9 rho_min, rho_min = least convex radius of the tooth-centre locus",
        "A tooth as large as the sharpest bend of its path cuts a cusp into the lobe, and near it "
        "the equivalent radius of the contact vanishes.",
        "CN105404737A (2016), undercut limit; 10 % reserve: " + _HOUSE,
    ),
    CheckGuide(
        "GEO-TOOTH-OVERLAP",
        "Space between ring teeth",
        "mm",
        "max",
        "r <= 0.85 R sin(pi/(n+1))",
        "Neighbouring ring teeth must leave room for the relief between them.",
        _HOUSE,
    ),
    CheckGuide(
        "GEO-RING-WALL",
        "Ring wall outside the relief",
        "mm",
        "min",
        "wall = D_ring/2 - R_root >= 2.5 mm",
        "A thin ring ovalises under the tooth forces and spoils the sharing.",
        _HOUSE,
    ),
    CheckGuide(
        "GEO-LIGAMENT-HOLES",
        "Ligament between output holes",
        "mm",
        "min",
        "2 R_w sin(pi/N_w) - d_hole >= 1.5 mm",
        "The web between holes carries the pin forces across the disc.",
        _HOUSE,
    ),
    CheckGuide(
        "GEO-LIGAMENT-PROFILE",
        "Ligament, output hole to lobed profile",
        "mm",
        "min",
        "least distance of hole edge and flank >= 1.5 mm",
        "Tooth and pin forces meet here; a thin web cracks or gives way under the lobe.",
        _HOUSE,
    ),
    CheckGuide(
        "GEO-LIGAMENT-BORE",
        "Ligament, output hole to bearing bore",
        "mm",
        "min",
        "R_w - (d_hole + D_bearing)/2 >= 1.5 mm",
        "The web that seats the cam bearing's outer ring must stay round under load.",
        _HOUSE,
    ),
    CheckGuide(
        "GEO-LIGAMENT-RIM",
        "Ligament, bearing bore to lobed profile",
        "mm",
        "min",
        "R_valley - D_bearing/2 >= 1.5 mm",
        "The rim between the cam bearing and the valleys carries every force of the disc.",
        _HOUSE,
    ),
    CheckGuide(
        "GEO-SLEEVE-WALL",
        "Wall of the sleeves",
        "mm",
        "min",
        "(d_sleeve - d_pin)/2 >= 0.5 mm",
        "Thinner bushes cannot be bought or ground, and crack under line load.",
        _HOUSE,
    ),
    CheckGuide(
        "FIT-PIN-HOLE",
        "Tightest fit of pin in hole",
        "um",
        "min",
        "clearance - (d_pin,max - d_pin,mean) >= 0",
        "The hole clearance counts to the mean pin. With the largest pin of its tolerance band a "
        "negative rest means that the stack jams once a turn.",
        "ISO 286-2 (f9 shoulder); limits of the catalogue's screw",
    ),
    CheckGuide(
        "SPACE-DIAMETER",
        "Ring inside the required diameter",
        "mm",
        "max",
        "D_ring <= requirements.outer_diameter",
        "The gearbox has to fit the space asked for.",
        "requirements of the design file",
    ),
    CheckGuide(
        "SPACE-LENGTH",
        "Disc pack inside the required length",
        "mm",
        "max",
        "D b + (D-1) s <= requirements.length",
        "The gearbox has to fit the space asked for.",
        "requirements of the design file",
    ),
    CheckGuide(
        "CONTACT-RING-PEAK",
        "Hertz pressure at the ring, peak torque",
        "MPa",
        "max",
        "p0 = sqrt(1.15 F E*/(pi b R_eq)) <= 1.67 S_y",
        "Above it the material yields below the surface and the flank dents.",
        _JOHNSON,
    ),
    CheckGuide(
        "CONTACT-RING-CONTINUOUS",
        "Hertz pressure at the ring, continuous torque",
        "MPa",
        "max",
        "p0 = sqrt(1.15 F E*/(pi b R_eq)) <= 2.22 HB + 200 MPa",
        "Above it the flank pits within some 1e7 load cycles.",
        _PITTING,
    ),
    CheckGuide(
        "CONTACT-PIN-PEAK",
        "Hertz pressure of pins in holes, peak torque",
        "MPa",
        "max",
        "p0 = sqrt(1.15 F E*/(pi b R_eq)) <= 1.67 S_y",
        "Above it pin or hole yields below the surface.",
        _JOHNSON,
    ),
    CheckGuide(
        "CONTACT-PIN-CONTINUOUS",
        "Hertz pressure of pins in holes, continuous torque",
        "MPa",
        "max",
        "p0 = sqrt(1.15 F E*/(pi b R_eq)) <= 2.22 HB + 200 MPa",
        "Above it pin or hole pits within some 1e7 load cycles.",
        _PITTING,
    ),
    CheckGuide(
        "PIN-PAPER",
        "Output pins by the paper's method",
        "N*m",
        "min",
        "N_w (pi/4) d^2 (S_u/2) R_w >= peak torque",
        "The paper's own figure: every pin in single shear at full load and full radius at once. "
        "It leaves out sharing, bending and fatigue, and is reported for comparison.",
        f"{_PAPER}, section III-A",
    ),
    CheckGuide(
        "PIN-SHARED",
        "Output pins in shear with load sharing",
        "N*m",
        "min",
        "D N_w R_w F/k >= peak torque, F = (pi/4) d^2 S_u/2, k = 4 (even N_w)",
        "The paper's shear strength with the torque shared as rigid discs share it.",
        f"{_PAPER} (strength); rigid sharing: Kudryavtsev 1966; {_WANG}",
    ),
    CheckGuide(
        "PIN-SHEAR-PEAK",
        "Shear stress of the output pins, peak torque",
        "MPa",
        "max",
        "tau = 1.15 F/((pi/4) d^2) <= 0.58 S_y/1.2",
        "A pin sheared past yield takes a set and the sharing is lost.",
        _SHIGLEY,
    ),
    CheckGuide(
        "PIN-BENDING-PEAK",
        "Bending stress of the output pins, peak torque",
        "MPa",
        "max",
        "sigma = 32 M/(pi d^3) <= S_y/1.2, M = 1.15 F (a(L-a)/L - b/8) or 1.15 F a (cantilever)",
        "Thin pins bend long before they shear; a bent pin jams in its holes.",
        f"beam theory; {_SHIGLEY}; {_WANG} (pin stress)",
    ),
    CheckGuide(
        "PIN-BENDING-CONTINUOUS",
        "Bending stress of the output pins, continuous torque",
        "MPa",
        "max",
        "sigma = 32 M/(pi d^3) <= pulsating fatigue strength",
        "Every pin is loaded and unloaded once per disc and relative turn: a million cycles in a "
        "day's running.",
        "about S_u/4 for shoulder screws (" + _HOUSE + "); Goodman line where the duty reverses",
    ),
    CheckGuide(
        "PIN-BEARING-PEAK",
        "Mean pressure of pins in holes, peak torque",
        "MPa",
        "max",
        "1.15 F/(d b) <= S_y/1.2 of the weaker part",
        "Above it the hole stretches.",
        _SHIGLEY,
    ),
    CheckGuide(
        "BEARING-STATIC",
        "Cam bearing, static safety at peak torque",
        "",
        "min",
        "C0/P >= 1, P = |sum of ring forces + sum of pin forces| of one disc",
        "Beyond C0 the balls dent the raceway. The output-pin reaction counts: leaving it out "
        "understates P by a fifth and overstates the life almost twofold.",
        "ISO 76:2006",
    ),
    CheckGuide(
        "BEARING-LIFE",
        "Cam bearing, basic rating life at continuous torque",
        "h",
        "min",
        "L10h = 1e6 (C/P)^p/(60 rpm (1 + 1/n)) >= 1000 h",
        "The crank turns faster against the disc than against the housing.",
        "ISO 281:2007",
    ),
    CheckGuide(
        "BEARING-WIDTH",
        "Cam bearing inside the disc",
        "mm",
        "max",
        "B <= b",
        "A wider bearing runs into that of the neighbouring disc.",
        _HOUSE,
    ),
    CheckGuide(
        "BEARING-CORE",
        "Shaft core between the eccentrics",
        "mm",
        "min",
        "d_bore >= 4 e, so that the core d_bore/2 - e is at least a quarter of the bore",
        "Neighbouring eccentrics overlap only over this core, which carries the input torque.",
        _HOUSE,
    ),
    CheckGuide(
        "BEARING-RACEWAY",
        "Disc hard enough to be a raceway",
        "HRC",
        "min",
        "disc hardness >= 58 HRC where a needle cage has no outer ring",
        "Needles running in softer steel wear and pit it within hours.",
        "ISO 76 and ISO 281 presume raceways of 58 HRC and more",
    ),
    CheckGuide(
        "BALANCE-STATIC",
        "Static unbalance of the crank",
        "g*mm",
        "max",
        "|sum m r| <= sum m G/omega, G 6.3",
        "A shaking force at every turn of the input; one disc alone has it, two or three cancel.",
        "ISO 21940-11, grade G 6.3",
        "warn",
    ),
    CheckGuide(
        "BALANCE-COUPLE",
        "Shaking couple against the cam load",
        "N",
        "max",
        "|sum m r z| omega^2/(D b) <= 0.1 P_continuous",
        "Discs in different planes leave a couple that shakes the shaft's bearings.",
        _HOUSE,
        "warn",
    ),
    CheckGuide(
        "DISC-COUNT",
        "Number of discs",
        "",
        "min",
        "N >= 2 (the paper: N_Z = 2 for an even ratio, 3 for an odd one)",
        "Two discs opposite each other balance statically at any ratio. The paper's rule is "
        "reported, not imposed: balance does not depend on the parity of the ratio, and three "
        "discs in the same length carry less.",
        f"{_PAPER}, section III-B; statics of rotating masses",
        "warn",
    ),
    CheckGuide(
        "EDM-DISC",
        "Wire in the disc's valleys",
        "mm",
        "max",
        "d_wire/2 + gap <= least concave radius of the disc",
        "A wire coarser than the valley cannot follow it.",
        "geometry of wire EDM",
    ),
    CheckGuide(
        "EDM-HOLE",
        "Wire in the output holes",
        "mm",
        "max",
        "d_wire/2 + gap <= d_hole/2",
        "A wire coarser than the hole cannot cut it.",
        "geometry of wire EDM",
    ),
    CheckGuide(
        "EDM-RING",
        "Wire in the ring's reliefs",
        "mm",
        "max",
        "d_wire/2 + gap <= least concave radius of the ring",
        "A wire coarser than the relief between two teeth cannot follow it.",
        "geometry of wire EDM",
    ),
    CheckGuide(
        "MOTOR-PEAK",
        "Motor peak torque",
        "N*m",
        "max",
        "T_peak/(n eta) <= T_motor,peak, eta = 0.88",
        "The motor has to reach the peak torque through the reducer and its losses.",
        "motor catalogue; efficiency assumed at the low end of measured steel cycloid drives",
        "warn",
    ),
    CheckGuide(
        "MOTOR-CONTINUOUS",
        "Motor rated torque",
        "N*m",
        "max",
        "T_continuous/(n eta) <= T_motor,rated, eta = 0.88",
        "Above its rated torque the winding overheats in continuous duty.",
        "motor catalogue; efficiency assumed at the low end of measured steel cycloid drives",
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
        f"motor catalogue; {_PAPER}, section III-A",
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

CHECK_GUIDE: dict[str, CheckGuide] = {row.id: row for row in _ROWS}


def check_guide(check_id: str) -> CheckGuide:
    """Look up the meaning of the check called `check_id`, in any case of letters.

    Raises
    ------
    UsageError
        With the nearest identifiers, when there is none.

    Examples
    --------
    >>> check_guide("bearing-life").unit
    'h'
    """
    row = CHECK_GUIDE.get(check_id.strip().upper())
    if row is None:
        raise UsageError(f"there is no check '{check_id}'{did_you_mean(check_id, CHECK_GUIDE)}.")
    return row
