"""Shoulder screws (ISO 7379 and the commercial small sizes), and the fit of output pins.

And the screws that go through the columns of a carrier, with their bores.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

from cqdd_design.catalog.fits import fit_limits
from cqdd_design.catalog.reader import number, optional_number, read_rows
from cqdd_design.catalog.threads import thread_sizes
from cqdd_design.errors import CatalogError

_SHOULDER_LENGTHS = (4, 5, 6, 8, 10, 12, 16, 20, 25, 30, 40, 50, 60, 70, 80, 90, 100, 120)
"""Of shoulders, mm (ISO 7379:1983; the shortest are those of the sizes below it)."""
_BORE_SHARE = 0.6
"""Most of a column's diameter that its bore takes: seven eighths of its stiffness stay."""
LEAST_COLUMN = 3e-3
"""Least diameter of a column, m: a tube over an M1.6 screw, the smallest there is."""
_LARGEST_COLUMN_SCREW = 16e-3
"""The largest thread of a column, m: that of the largest cap screw that layouts know."""


@dataclass(frozen=True)
class ShoulderScrew:
    """A shoulder screw.

    Attributes
    ----------
    name : str
        System, shoulder diameter and thread, such as ``metric 4 mm M3``.
    thread : str
        Thread designation.
    shoulder_diameter : float
        Nominal, m.
    shoulder_diameter_max, shoulder_diameter_min : float
        Limits of the ground shoulder, m (f9 for metric screws; nominal where the source has none).
    head_diameter, head_height, thread_length, socket_size : float or None
        m; None where the source gives none.
    standard_lengths : str
        Range of shoulder lengths, as printed, mm.
    standard : str
        ISO 7379, or empty: sizes that are sold beside it, below its 6.5 mm and between its own.
    source : str
        Where the row comes from.
    """

    name: str
    thread: str
    shoulder_diameter: float
    shoulder_diameter_max: float
    shoulder_diameter_min: float
    head_diameter: float | None
    head_height: float | None
    thread_length: float | None
    socket_size: float | None
    standard_lengths: str
    standard: str
    source: str

    @property
    def mean_diameter(self) -> float:
        """Mean of the shoulder's limits, m: what a fit is measured to."""
        return 0.5 * (self.shoulder_diameter_min + self.shoulder_diameter_max)

    @property
    def lengths(self) -> tuple[float, ...]:
        """Lengths of shoulder that are sold, m; none where the source gives no range."""
        if "-" not in self.standard_lengths:
            return ()
        shortest, longest = (float(mm) for mm in self.standard_lengths.split("-"))
        return tuple(1e-3 * mm for mm in _SHOULDER_LENGTHS if shortest <= mm <= longest)

    def designation(self, length: float) -> str:
        """To order one with a shoulder of some length, m.

        Examples
        --------
        >>> find_shoulder_screw(8e-3).designation(25e-3)
        'ISO 7379 8 f9 x 25 M6'
        >>> find_shoulder_screw(4e-3).designation(25e-3)
        'shoulder screw 4 f9 x 25 M3'
        """
        size = f"{self.shoulder_diameter * 1e3:g} f9 x {length * 1e3:.4g}"
        if self.standard:
            return f"{self.standard} {size} {self.thread}"
        unit = "" if self.thread.startswith("M") else " mm"
        return f"shoulder screw {size}{unit} {self.thread}"


@functools.lru_cache(maxsize=1)
def shoulder_screws() -> dict[str, ShoulderScrew]:
    """All shoulder screws by name, in file order."""
    table = {}
    for row in read_rows("shoulder_screws.csv"):
        nominal = number(row, "shoulder_d_mm", 1e-3)
        name = f"{row['system']} {row['shoulder_d_mm'].removesuffix('.0')} mm {row['thread']}"
        table[name] = ShoulderScrew(
            name=name,
            thread=row["thread"],
            shoulder_diameter=nominal,
            shoulder_diameter_max=optional_number(row, "d_max_mm", 1e-3) or nominal,
            shoulder_diameter_min=optional_number(row, "d_min_mm", 1e-3) or nominal,
            head_diameter=optional_number(row, "head_d_mm", 1e-3),
            head_height=optional_number(row, "head_h_mm", 1e-3),
            thread_length=optional_number(row, "thread_len_mm", 1e-3),
            socket_size=optional_number(row, "socket_mm", 1e-3),
            standard_lengths=row["std_lengths_mm"],
            standard=row["standard"],
            source=row["source"],
        )
    return table


def find_shoulder_screw(diameter: float) -> ShoulderScrew:
    """The shoulder screw whose nominal shoulder is `diameter` (m), metric rows first.

    Raises
    ------
    CatalogError
        With the nearest sizes, when there is none within 1 um.

    Examples
    --------
    >>> find_shoulder_screw(0.004).thread
    'M3'
    """
    table = shoulder_screws()
    for screw in table.values():
        if abs(screw.shoulder_diameter - diameter) < 1e-6:
            return screw
    by_distance = sorted(table.values(), key=lambda s: abs(s.shoulder_diameter - diameter))
    sizes = " or ".join(f"{s.shoulder_diameter * 1e3:g} mm" for s in by_distance[:2])
    raise CatalogError(
        f"no shoulder screw has a {diameter * 1e3:g} mm shoulder; the nearest are {sizes}."
    )


def pin_diameter_limits(diameter: float) -> tuple[float, float]:
    """Least and greatest real diameter of an output pin of a nominal size, m.

    From the catalogue's shoulder screw of that size, else the f9 limits that such screws have.

    Examples
    --------
    >>> [round(1e3 * d, 3) for d in pin_diameter_limits(4e-3)]
    [3.96, 3.99]
    """
    try:
        screw = find_shoulder_screw(diameter)
    except CatalogError:
        zone = fit_limits("f9", diameter)
        return diameter + zone.lower, diameter + zone.upper
    return screw.shoulder_diameter_min, screw.shoulder_diameter_max


@dataclass(frozen=True)
class ColumnScrew:
    """The screw through a column, m.

    Attributes
    ----------
    thread : float
        Nominal diameter of the metric thread.
    bore : float
        Of the column over it.
    """

    thread: float
    bore: float


def column_screw(diameter: float) -> ColumnScrew:
    """The largest screw, up to M16, whose bore leaves a column (m) a wall of a fifth of it.

    Raises
    ------
    CatalogError
        Below `LEAST_COLUMN`.

    Examples
    --------
    >>> column_screw(6e-3)
    ColumnScrew(thread=0.003, bore=0.0032)
    """
    most = _BORE_SHARE * diameter * 1e3
    fitting = [
        row
        for row in thread_sizes().values()
        if row.fine * 1e3 <= most + 1e-9 and row.diameter <= _LARGEST_COLUMN_SCREW
    ]
    if diameter < LEAST_COLUMN or not fitting:
        raise CatalogError(
            f"no screw goes through a column of {diameter * 1e3:g} mm; the least is "
            f"{LEAST_COLUMN * 1e3:g} mm."
        )
    return ColumnScrew(fitting[-1].diameter, fitting[-1].fine)
