"""Curvature of the disc against published and recomputed values.

Sources, row by row in ``data/published_examples.csv``:

* group ``curvature``: undercut limit (least convex radius of the path of the tooth centres) and
  valley radius, closed forms of CN105404737A; Wang, Luo, Su 2016 (Mechanism and Machine Theory
  102, 135-148) prints the second branch with (1 - K1)^2, which is a misprint.
* group ``cycloid_contact``: radii of curvature at lobe tip and pit of the discs of Krol, Wiklo,
  Olejarczyk, Kolodziejczyk, Siemiatkowska 2019, doi 10.1007/978-3-030-20131-9_103. There m is K1,
  q the tooth radius, zs the lobes.
"""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest

from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.trochoid import (
    locus_curvature,
    locus_valley_radius,
    undercut_radius_limit,
)

DATA = Path(__file__).parent / "data" / "published_examples.csv"


def _rows(group: str, *quantities: str) -> list[dict[str, str]]:
    with DATA.open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["group"] == group]
    return [row for row in rows if any(row["quantity"].startswith(q) for q in quantities)]


def _inputs(row: dict[str, str]) -> dict[str, float]:
    pairs = (item.split("=") for item in row["inputs"].split(";"))
    return {key.strip(): float(value.split()[0]) for key, value in pairs}


def _name(row: dict[str, str]) -> str:
    return f"{row['case']}-{row['quantity'][:12]}"


LIMITS = _rows("curvature", "min convex radius")
VALLEYS = _rows("curvature", "concave radius")
KROL = _rows("cycloid_contact", "rho_lobe", "rho_pit")


def test_every_published_row_is_used() -> None:
    assert len(LIMITS) == len(VALLEYS) == 2
    assert len(LIMITS) + len(VALLEYS) == len(_rows("curvature", ""))
    assert len(KROL) == 6


@pytest.mark.parametrize("row", LIMITS, ids=_name)
def test_undercut_limit(row: dict[str, str]) -> None:
    given = _inputs(row)
    found = 1e3 * float(undercut_radius_limit(given["N"], given["R"] * 1e-3, given["E"] * 1e-3))
    assert found == pytest.approx(float(row["value"]), abs=float(row["tol"]))


@pytest.mark.parametrize("row", VALLEYS, ids=_name)
def test_valley_radius(row: dict[str, str]) -> None:
    given = _inputs(row)
    found = 1e3 * float(locus_valley_radius(given["N"], given["R"] * 1e-3, given["E"] * 1e-3))
    assert found == pytest.approx(float(row["value"]), abs=float(row["tol"]))


@pytest.mark.parametrize("row", KROL, ids=_name)
def test_krol_disc_radii(row: dict[str, str]) -> None:
    given = _inputs(row)
    lobes = int(given["zs"])
    pitch = given["e"] * (lobes + 1) / given["m"]
    disc = CycloidDisc(lobes, pitch * 1e-3, given["e"] * 1e-3, given["q"] * 1e-3)
    at = math.pi / lobes if row["quantity"] == "rho_lobe" else 0.0
    found = 1e3 / float(disc.curvature(at))
    assert found == pytest.approx(float(row["value"]), abs=float(row["tol"]))


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
