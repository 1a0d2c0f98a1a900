"""Masses of hexagon socket head cap screws (ISO 4762)."""

from __future__ import annotations

import functools
from dataclasses import dataclass

from cqdd_design.catalog.reader import column, read_records

_DIGITS = 6


@dataclass(frozen=True)
class CapScrewMass:
    """A size of screw and what it weighs.

    Attributes
    ----------
    thread, length : float
        m.
    mass : float
        kg, rounded as the chart has it.
    source : str
        Where the row comes from.
    """

    thread: float = column("thread_mm", 1e-3)
    length: float = column("length_mm", 1e-3)
    mass: float = column("mass_g", 1e-3)
    source: str = column("source")


@functools.lru_cache(maxsize=1)
def cap_screw_masses() -> tuple[CapScrewMass, ...]:
    """Every size that the chart has, the thinnest and shortest first."""
    return tuple(read_records("cap_screws.csv", CapScrewMass))


def cap_screw_mass(thread: float, length: float) -> float | None:
    """Mass of a screw (m), kg; None where the chart does not have its size.

    Examples
    --------
    >>> round(1e3 * cap_screw_mass(3e-3, 10e-3), 3), cap_screw_mass(3e-3, 11e-3)
    (0.9, None)
    """
    return _by_size().get((round(thread, _DIGITS), round(length, _DIGITS)))


@functools.lru_cache(maxsize=1)
def _by_size() -> dict[tuple[float, float], float]:
    return {
        (round(one.thread, _DIGITS), round(one.length, _DIGITS)): one.mass
        for one in cap_screw_masses()
    }
