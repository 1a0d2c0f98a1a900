"""Ratings of needle bearings by the ISO formulas, for the rows the catalogue marks computed."""

from __future__ import annotations

import numpy as np

from cqdd_design.catalog.needles import NeedleSet

#: Factor f_c of ISO 281:2007, table 7, over D_we / D_pw.
_ISO_281_TABLE_7 = np.array(
    [
        (0.01, 52.1),
        (0.02, 60.8),
        (0.03, 66.5),
        (0.04, 70.7),
        (0.05, 74.1),
        (0.06, 76.9),
        (0.07, 79.2),
        (0.08, 81.2),
        (0.09, 82.8),
        (0.10, 84.2),
        (0.12, 86.4),
        (0.14, 87.7),
        (0.16, 88.5),
        (0.18, 88.8),
        (0.20, 88.7),
        (0.22, 88.2),
        (0.24, 87.5),
        (0.26, 86.4),
        (0.28, 85.2),
        (0.30, 83.8),
    ]
)


def dynamic_rating(needles: NeedleSet) -> float:
    """Basic dynamic radial load rating C_r, N.

    ISO 281:2007, eq. for radial roller bearings, one row, contact angle zero:
    C_r = b_m f_c L_we^(7/9) Z^(3/4) D_we^(29/27) with lengths in mm; b_m = 1 for drawn cups and
    1.1 for needles on ground raceways.
    """
    ratio = needles.diameter / needles.pitch_diameter
    f_c = float(np.interp(ratio, _ISO_281_TABLE_7[:, 0], _ISO_281_TABLE_7[:, 1]))
    b_m = 1.0 if needles.drawn_cup else 1.1
    length, diameter = needles.length * 1e3, needles.diameter * 1e3
    rating: float = b_m * f_c * length ** (7 / 9) * needles.count ** (3 / 4) * diameter ** (29 / 27)
    return rating


def static_rating(needles: NeedleSet) -> float:
    """Basic static radial load rating C_0r, N.

    ISO 76:2006, eq. for radial roller bearings: C_0r = 44 (1 - D_we/D_pw) Z L_we D_we, mm.
    """
    ratio = needles.diameter / needles.pitch_diameter
    return 44.0 * (1.0 - ratio) * needles.count * needles.length * needles.diameter * 1e6
