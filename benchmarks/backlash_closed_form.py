"""The closed form of backlash that searches make small, fitted to toleranced gearboxes.

    python benchmarks/backlash_closed_form.py [gearboxes]

Gearboxes of ratios 6 to 20 with 1 to 3 discs, 4 to 12 output pins and five fits, drawn at random,
64 of each with the usual tolerances and rigid bodies; those of which any jams are left out. The
backlash that 95 % of the 64 stay below is fitted as 2 q/(n e) + (a + b/(N_w D)) c/R_w by least
squares of relative misses; what `sizing.goals.backlash_angle` has, and misses by it, stand below.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from cqdd_design.design import Design, load_design
from cqdd_design.errors import CqddError
from cqdd_design.machine import resolve
from cqdd_design.sizing import goals
from cqdd_design.sizing.spaces import FITS
from cqdd_design.verdict.drawn import drawn_gearboxes

ARCMIN = 180.0 * 60.0 / np.pi
_DRAWN = 64


def drawn_design(base: Design, draw: np.random.Generator) -> Design:
    """A gearbox of random sizes; it may not exist."""
    ratio, radius = int(draw.choice([6, 8, 10, 14, 20])), draw.uniform(22e-3, 32e-3)
    fit = FITS[draw.integers(1, len(FITS))]
    return base.replacing(
        {
            "requirements.ratio": ratio,
            "reducer.ratio": ratio,
            "reducer.ring_pitch_radius": radius,
            "reducer.eccentricity": min(draw.uniform(0.55, 0.85) * radius / (ratio + 1), 2.6e-3),
            "reducer.ring_pin_diameter": 0.54 * np.pi * radius / (ratio + 1),
            "reducer.disc_count": int(draw.choice([1, 2, 2, 3])),
            "reducer.disc_thickness": 5e-3,
            "reducer.modification.equidistant": fit.equidistant,
            "reducer.output_pins.count": int(draw.choice([4, 5, 6, 8, 10, 12])),
            "reducer.output_pins.diameter": float(draw.choice([3e-3, 4e-3, 5e-3])),
            "reducer.output_pins.circle_radius": draw.uniform(0.6, 0.68) * radius,
            "reducer.output_pins.hole_clearance": fit.hole_clearance,
            "reducer.ring.outer_diameter": 2.0 * radius + 12e-3,
            "reducer.cam_bearing.designation": "6803" if radius > 27e-3 else "6801",
        }
    )


def main(wanted: int) -> None:
    """Print the fit."""
    draw = np.random.default_rng(1)
    base = load_design(Path(__file__).parents[1] / "designs" / "cqdd-10.toml")
    rows = []
    while len(rows) < wanted:
        try:
            design = drawn_design(base, draw)
            found = drawn_gearboxes(resolve(design), _DRAWN, sensitivity=False, rigid=True)
        except CqddError:
            continue
        if found.continuous.lost:
            continue
        reducer = design.reducer
        pins, own = reducer.output_pins, found.continuous.columns["backlash_arcmin"]
        teeth = 2.0 * reducer.modification.equidistant / (reducer.ratio * reducer.eccentricity)
        play = pins.hole_clearance / pins.circle_radius
        shared = play / (pins.count * reducer.disc_count)
        rows.append((ARCMIN * teeth, ARCMIN * play, ARCMIN * shared, np.quantile(own, 0.95)))
    teeth, play, shared, told = np.array(rows).T
    terms = np.stack([play, shared], axis=1) / told[:, None]
    best = np.linalg.lstsq(terms, 1.0 - teeth / told, rcond=None)[0]
    print(f"{wanted} gearboxes, backlash {told.min():.1f} to {told.max():.1f} arcmin")
    for name, (a, b) in (("fitted", best), ("taken", (goals.PINS_PLAY, goals.FEW_PINS_PLAY))):
        miss = 100.0 * ((teeth + a * play + b * shared) / told - 1.0)
        print(
            f"{name:7s} a {a:.2f}, b {b:.2f}: {miss.std():.0f} % r.m.s. about {miss.mean():+.0f}, "
            f"{miss.min():+.0f} to {miss.max():+.0f} %"
        )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 70)
