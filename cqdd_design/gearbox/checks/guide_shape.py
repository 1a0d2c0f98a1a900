"""Rule, reason and source of the checks of :mod:`.shape`."""

from __future__ import annotations

from cqdd_design.gearbox.checks import allowables as limits
from cqdd_design.gearbox.checks.guide_row import HOUSE, WANG, CheckGuide

_LIGAMENTS = tuple(
    CheckGuide(
        f"GEO-LIGAMENT-{part}",
        title,
        "mm",
        "min",
        f"{distance} >= {1e3 * limits.LIGAMENT:g} mm",
        why,
        HOUSE,
    )
    for part, title, distance, why in (
        (
            "HOLES",
            "Ligament between output holes",
            "2 R_w sin(pi/N_w) - d_hole",
            "The web between holes carries the pin forces across the disc.",
        ),
        (
            "PROFILE",
            "Ligament, output hole to lobed profile",
            "least distance of hole edge and flank",
            "Tooth and pin forces meet here; a thin web cracks or gives way under the lobe.",
        ),
        (
            "BORE",
            "Ligament, output hole to bearing bore",
            "R_w - (d_hole + D_bearing)/2",
            "The web that seats the cam bearing's outer ring must stay round under load.",
        ),
        (
            "RIM",
            "Ligament, bearing bore to lobed profile",
            "R_valley - D_bearing/2",
            "The rim between the cam bearing and the valleys carries every force of the disc.",
        ),
        (
            "COLUMN",
            "Ligament beside the carrier's columns",
            "least distance of a column's hole and the output holes, the bore or the flank",
            "Holes for columns take the webs between the output holes, which carry the pin forces.",
        ),
    )
)

_WIRES = tuple(
    CheckGuide(
        f"EDM-{part}",
        f"Wire in the {where}",
        "mm",
        "max",
        f"d_wire/2 + gap <= {radius}",
        f"A wire coarser than the {what} it.",
        "geometry of wire EDM",
    )
    for part, where, radius, what in (
        (
            "DISC",
            "disc's valleys",
            "least concave radius of the disc",
            "valley cannot follow",
        ),
        ("HOLE", "output holes", "d_hole/2", "hole cannot cut"),
        (
            "RING",
            "ring's reliefs",
            "least concave radius of the ring",
            "relief between two teeth cannot follow",
        ),
    )
)

ROWS = (
    CheckGuide(
        "GEO-K1-LEAST",
        "Shortening coefficient, least",
        "",
        "min",
        f"K1 = e (n+1)/R >= {limits.SHORTENING_LEAST:g}",
        "Shallow lobes: tooth and cam forces grow as 1/K1, and backlash grows with them.",
        f"{WANG} (range of K1); {HOUSE}",
    ),
    CheckGuide(
        "GEO-K1-MOST",
        "Shortening coefficient, most",
        "",
        "max",
        f"K1 = e (n+1)/R <= {limits.SHORTENING_MOST:g}",
        "Above it the valleys sharpen and the lobes come near to undercut.",
        f"{WANG} (range of K1); {HOUSE}",
    ),
    CheckGuide(
        "GEO-UNDERCUT",
        "Tooth radius against undercut",
        "mm",
        "max",
        f"r <= {limits.UNDERCUT_SHARE:g} rho_min, "
        "rho_min = least convex radius of the tooth-centre locus",
        "A tooth as large as the sharpest bend of its path cuts a cusp into the lobe, and near it "
        "the equivalent radius of the contact vanishes.",
        "CN105404737A (2016), undercut limit; "
        f"{100.0 * (1.0 - limits.UNDERCUT_SHARE):.0f} % reserve: {HOUSE}",
    ),
    CheckGuide(
        "GEO-TOOTH-OVERLAP",
        "Space between ring teeth",
        "mm",
        "max",
        f"r <= {limits.TOOTH_OVERLAP_SHARE:g} R sin(pi/(n+1))",
        "Neighbouring ring teeth must leave room for the relief between them.",
        HOUSE,
    ),
    CheckGuide(
        "GEO-RING-WALL",
        "Ring wall outside the relief",
        "mm",
        "min",
        f"wall = D_ring/2 - R_root >= {1e3 * limits.RING_WALL:g} mm",
        "A thin ring ovalises under the tooth forces and spoils the sharing.",
        HOUSE,
    ),
    *_LIGAMENTS,
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
        "BEARING-WIDTH",
        "Cam bearing inside the disc",
        "mm",
        "max",
        "B <= b",
        "A wider bearing runs into that of the neighbouring disc.",
        HOUSE,
    ),
    CheckGuide(
        "BEARING-CORE",
        "Shaft core between the eccentrics",
        "mm",
        "min",
        f"d_bore >= {1.0 / (0.5 - limits.SHAFT_CORE_SHARE):g} e, "
        "so that the core d_bore/2 - e is at least a quarter of the bore",
        "Neighbouring eccentrics overlap only over this core, which carries the input torque.",
        HOUSE,
    ),
    CheckGuide(
        "SPACE-DIAMETER",
        "Ring inside the required diameter",
        "mm",
        "max",
        "D_ring <= requirements.outer_diameter",
        "The gearbox has to fit the space asked for.",
        "requirements of the design file",
        exception="only a warning where requirements.outer_diameter is not stated",
    ),
    CheckGuide(
        "SPACE-LENGTH",
        "Disc pack inside the required length",
        "mm",
        "max",
        "D b + (D-1) s <= requirements.length",
        "The gearbox has to fit the space asked for.",
        "requirements of the design file",
        exception="only a warning where requirements.length is not stated",
    ),
    *_WIRES,
)
