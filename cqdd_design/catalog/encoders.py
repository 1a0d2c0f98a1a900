"""Magnetic encoders at the end of a shaft: sensors, and the diametric magnets that they read."""

from __future__ import annotations

import functools
from dataclasses import dataclass

from cqdd_design.catalog.reader import column, read_records


@dataclass(frozen=True)
class EncoderSensor:
    """A sensor that reads the angle of a magnet on the axis, or of a ring that it stands beside.

    Attributes
    ----------
    name : str
        Maker and type.
    bits : int
        Of an absolute angle over one turn.
    most_speed_rpm : float or None
        Up to which it reads; None where the source gives none.
    place : str
        Where it stands: ``axis``, under the magnet, or ``side``, beside a ring round the shaft.
    magnet_diameter, magnet_height : float
        Of the diametric magnet that it is made for, m.
    least_gap, most_gap : float or None
        From the magnet to the face of its package, or to the edge of its board, m.
    source : str
        Where the row comes from.
    """

    name: str = column("name")
    bits: int = column("bits")
    most_speed_rpm: float | None = column("most_rpm")
    place: str = column("place")
    magnet_diameter: float = column("magnet_mm", 1e-3)
    magnet_height: float = column("magnet_height_mm", 1e-3)
    least_gap: float | None = column("least_gap_mm", 1e-3)
    most_gap: float = column("most_gap_mm", 1e-3)
    source: str = column("source")


@dataclass(frozen=True)
class EncoderMagnet:
    """A disc magnet, magnetised across its axis, m."""

    name: str = column("name")
    diameter: float = column("d_mm", 1e-3)
    height: float = column("h_mm", 1e-3)
    material: str = column("material")
    source: str = column("source")


@functools.lru_cache(maxsize=1)
def encoder_sensors() -> tuple[EncoderSensor, ...]:
    """All sensors, in file order: those of fewer bits first."""
    return tuple(read_records("encoders.csv", EncoderSensor))


@functools.lru_cache(maxsize=1)
def encoder_magnets() -> tuple[EncoderMagnet, ...]:
    """All magnets, in file order."""
    return tuple(read_records("encoder_magnets.csv", EncoderMagnet))


def sensors_with(bits: int, *, beside: bool = False) -> tuple[EncoderSensor, ...]:
    """Sensors of at least so many bits, those of fewest first.

    Parameters
    ----------
    beside : bool
        Whether they stand beside a ring magnet round the shaft instead of under the shaft's end.

    Examples
    --------
    >>> [one.name for one in sensors_with(14)][:2]
    ['ams AS5047P', 'ams AS5048A']
    >>> [one.name for one in sensors_with(14, beside=True)]
    ['MPS MA732', 'MPS MA600']
    """
    place = "side" if beside else "axis"
    fitting = (one for one in encoder_sensors() if one.bits >= bits and one.place == place)
    return tuple(sorted(fitting, key=lambda one: one.bits))


def magnets_of(diameter: float, height: float) -> tuple[EncoderMagnet, ...]:
    """Magnets of a size (m) that are known by name."""
    return tuple(
        one
        for one in encoder_magnets()
        if abs(one.diameter - diameter) < 1e-6 and abs(one.height - height) < 1e-6
    )
