"""Curvature of the disc against closed forms and a source's pressures.

Groups of ``data/published_examples.csv``:

* ``curvature``: undercut limit (least convex radius of the path of the tooth centres) and valley
  radius, closed forms of CN105404737A; Wang, Luo, Su 2016 (Mechanism and Machine Theory 102,
  135-148) prints the second branch with (1 - K1)^2, which is a misprint.
* ``cycloid contact``: radii of curvature at lobe tip and pit of the discs of Krol, Wiklo,
  Olejarczyk, Kolodziejczyk, Siemiatkowska 2019, doi 10.1007/978-3-030-20131-9_103. There m is K1,
  q the tooth radius, zs the lobes.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from published_rows import Row, inputs, label, published_rows

from cqdd_design.geometry import trochoid
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.trochoid import locus_curvature, undercut_radius_limit

Compared = Callable[..., None]
LIMITS = published_rows("curvature", "least convex radius")
VALLEYS = published_rows("curvature", "radius of the locus in the valley")
KROL = published_rows("cycloid contact", "radius of the flank")


def test_no_row_is_missing() -> None:
    assert len(LIMITS) + len(VALLEYS) == len(published_rows("curvature"))
    assert len(KROL) == 6


@pytest.mark.parametrize(
    ("row", "radius"),
    [(row, "undercut_radius_limit") for row in LIMITS]
    + [(row, "locus_valley_radius") for row in VALLEYS],
    ids=lambda one: one if isinstance(one, str) else label(one),
)
def test_radii_of_the_locus(row: Row, radius: str, compared: Compared) -> None:
    given = inputs(row)

    def ours() -> float:
        # Looked up each time: `compared` exchanges it in its module.
        size = (given["R"] * 1e-3, given["E"] * 1e-3)
        return 1e3 * float(getattr(trochoid, radius)(given["N"], *size))

    compared(row, ours, getattr(trochoid, radius))


@pytest.mark.parametrize("row", KROL, ids=label)
def test_krol_disc_radii(row: Row, compared: Compared) -> None:
    given = inputs(row)
    lobes = int(given["zs"])
    pitch = given["e"] * (lobes + 1) / given["m"]
    at = math.pi / lobes if row["quantity"].endswith("tip") else 0.0

    def ours() -> float:
        disc = CycloidDisc(lobes, pitch * 1e-3, given["e"] * 1e-3, given["q"] * 1e-3)
        return 1e3 / float(disc.curvature(at))

    compared(row, ours, CycloidDisc.curvature)


def test_krol_form_is_the_same_curve() -> None:
    """Krol's u, v (with a lobe, not a valley, on +x) are our flank turned by half a lobe pitch."""
    e, q, m, zs = 2.8e-3, 3.5e-3, 0.7, 15
    a = np.linspace(0.0, 2.0 * math.pi, 1500)
    turn = np.arctan2(np.sin(zs * a), 1.0 / m + np.cos(zs * a))
    R = e * (zs + 1) / m
    u = R * np.cos(a) + e * np.cos((zs + 1) * a) - q * np.cos(a + turn)
    v = R * np.sin(a) + e * np.sin((zs + 1) * a) - q * np.sin(a + turn)
    disc = CycloidDisc(zs, R, e, q)
    ours = disc.flank(a + math.pi / zs) @ np.array([1.0, 1j]) * np.exp(-1j * math.pi / zs)
    assert np.abs(ours - (u + 1j * v)).max() < 1e-16 * 1e3


@pytest.mark.parametrize(
    ("n", "R", "e"), [(11, 0.050, 0.0015), (10, 0.045, 0.002), (8, 0.04, 1e-3)]
)
def test_closed_form_limit_is_the_numeric_minimum_and_the_misprint_is_not(
    n: int, R: float, e: float
) -> None:
    t = np.linspace(0.0, math.pi / n, 400_001)
    numeric = 1.0 / locus_curvature(n, R, e, t).max()
    assert float(undercut_radius_limit(n, R, e)) == pytest.approx(numeric, rel=1e-9)
    K = e * (n + 1) / R
    misprint = R * (1.0 - K) ** 2 / (1.0 + (n + 1) * K)
    assert abs(misprint / numeric - 1.0) > 0.5
