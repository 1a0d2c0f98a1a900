"""How rough surfaces are by the way they are made, and how hard plastics may rub."""

from __future__ import annotations

import functools
from dataclasses import dataclass

from cqdd_design.catalog.reader import column, find, read_records


@dataclass(frozen=True)
class Finish:
    """A way to make a surface.

    Attributes
    ----------
    mean_roughness, rms_roughness : float
        Ra and Rq, m; Rq = 1.25 Ra, that of heights that are spread normally, where a source gives
        one of the two.
    source : str
        Where the row comes from.
    """

    name: str = column("name")
    mean_roughness: float = column("Ra_um", 1e-6)
    rms_roughness: float = column("Rq_um", 1e-6)
    source: str = column("source")


@dataclass(frozen=True)
class RubbingLimit:
    """What a plastic bears that rubs on steel without lubricant.

    Attributes
    ----------
    material : str
        A row of the materials.
    limit : float
        Pressure on the projected area times speed, Pa m/s.
    source : str
        Where the row comes from.
    """

    material: str = column("material")
    limit: float = column("pv_MPa_m_s", 1e6)
    source: str = column("source")


@functools.lru_cache(maxsize=1)
def finishes() -> dict[str, Finish]:
    """All finishes by name, in file order."""
    return {one.name: one for one in read_records("finishes.csv", Finish)}


def find_finish(name: str) -> Finish:
    """The finish called `name`.

    Raises
    ------
    CatalogError
        With the nearest names, when there is none.

    Examples
    --------
    >>> find_finish("ground").mean_roughness
    4e-07
    """
    return find(name, finishes(), "finish")


@functools.lru_cache(maxsize=1)
def rubbing_limits() -> dict[str, RubbingLimit]:
    """Plastics whose limit is known, by material."""
    return {one.material: one for one in read_records("rubbing_limits.csv", RubbingLimit)}
