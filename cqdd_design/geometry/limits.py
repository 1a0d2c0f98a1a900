"""Where a disc stops existing, and the sentences that say so with the nearest fix."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from cqdd_design.errors import GeometryError
from cqdd_design.geometry.tip import largest_rotation
from cqdd_design.geometry.trochoid import undercut_radius_limit

if TYPE_CHECKING:
    from cqdd_design.geometry.cycloid import CycloidDisc

FEWEST_LOBES = 3
# Limits are not allowed values themselves: a round one is told as the next number inside.
_STRICT = 1e-9


def rounded_down(value: float, digits: int = 3) -> float:
    """Return `value` > 0 rounded down to `digits` significant digits.

    Examples
    --------
    >>> rounded_down(1.9387)
    1.93
    """
    return _rounded(value * (1.0 - _STRICT), digits, math.floor)


def rounded_up(value: float, digits: int = 3) -> float:
    """Return `value` > 0 rounded up to `digits` significant digits."""
    return _rounded(value * (1.0 + _STRICT), digits, math.ceil)


def _rounded(value: float, digits: int, how: Callable[[float], int]) -> float:
    places = digits - 1 - math.floor(math.log10(value))
    scale = 10.0 ** abs(places)
    return how(value * scale) / scale if places >= 0 else how(value / scale) * scale


def millimetres(value: float) -> str:
    """Return a length in m as it is shown to people, such as ``2.4 mm``."""
    return f"{value * 1e3:.6g} mm"


def _at_most(limit: float) -> str:
    return f"{rounded_down(limit * 1e3):.6g} mm"


def _at_least(limit: float) -> str:
    return f"{rounded_up(limit * 1e3):.6g} mm"


def _bisect(holds: Callable[[float], bool], low: float, high: float) -> float:
    """Boundary between `low`, where `holds` is true, and `high`, where it is not."""
    for _ in range(80):
        middle = 0.5 * (low + high)
        if holds(middle):
            low = middle
        else:
            high = middle
    return low


def largest_eccentricity(lobe_count: int, ring_pitch_radius: float, tooth_radius: float) -> float:
    """Eccentricity (m) below which a tooth of this radius does not undercut the disc.

    The undercut limit falls steadily from R to 0 as K1 goes from 0 to 1, so the boundary is one.
    """
    return _bisect(
        lambda e: float(undercut_radius_limit(lobe_count, ring_pitch_radius, e)) > tooth_radius,
        0.0,
        ring_pitch_radius / (lobe_count + 1),
    )


def smallest_pitch_radius(lobe_count: int, eccentricity: float, tooth_radius: float) -> float:
    """Ring pitch radius (m) above which a tooth of this radius does not undercut the disc."""
    low = eccentricity * (lobe_count + 1)
    high = 2.0 * max(low, tooth_radius)
    while float(undercut_radius_limit(lobe_count, high, eccentricity)) <= tooth_radius:
        high *= 2.0
    return _bisect(
        lambda R: float(undercut_radius_limit(lobe_count, R, eccentricity)) > tooth_radius,
        high,
        low,
    )


def refuse_impossible_flank(disc: CycloidDisc) -> None:
    """Raise where no disc outline of these numbers exists; they need not make sense.

    Raises
    ------
    GeometryError
        Naming the value, the limit and the nearest fix, in the keys of the design file.
    """
    lobe_count, tooth_radius = disc.lobe_count, disc.tooth_radius
    if not (math.isfinite(lobe_count) and lobe_count >= FEWEST_LOBES and lobe_count % 1 == 0):
        raise GeometryError(
            f"ratio {lobe_count} gives no disc; it is the number of lobes, a whole number of "
            f"{FEWEST_LOBES} or more."
        )
    lengths = {
        "ring_pitch_radius": disc.ring_pitch_radius,
        "eccentricity": disc.eccentricity,
        "ring_pin_diameter": 2.0 * tooth_radius,
    }
    for key, value in lengths.items():
        if not (math.isfinite(value) and value > 0.0):
            raise GeometryError(f"{key} is {millimetres(value)}; it must be above 0 mm.")
    for key, value in {"equidistant": disc.equidistant, "radial": disc.radial}.items():
        if not math.isfinite(value):
            raise GeometryError(f"modification.{key} is {millimetres(value)}; it must be finite.")
    _refuse_overlapping_teeth(lobe_count, disc.ring_pitch_radius, tooth_radius)
    _refuse_modification(disc)
    _refuse_undercut(disc)


def _refuse_overlapping_teeth(
    lobe_count: int, ring_pitch_radius: float, tooth_radius: float
) -> None:
    """Raise where neighbouring ring teeth touch: r >= R sin(pi/(n+1))."""
    step = math.sin(math.pi / (lobe_count + 1))
    if tooth_radius >= ring_pitch_radius * step:
        raise GeometryError(
            f"ring_pin_diameter {millimetres(2.0 * tooth_radius)} is above "
            f"{_at_most(2.0 * ring_pitch_radius * step)}, where the {lobe_count + 1} ring teeth "
            f"overlap on ring_pitch_radius {millimetres(ring_pitch_radius)}; lower it, or raise "
            f"ring_pitch_radius to {_at_least(tooth_radius / step)}."
        )


def _refuse_modification(disc: CycloidDisc) -> None:
    tooth_radius = disc.tooth_radius
    if tooth_radius + disc.equidistant <= 0.0:
        raise GeometryError(
            f"modification.equidistant {millimetres(disc.equidistant)} takes away the whole tooth "
            f"radius of {millimetres(tooth_radius)}; raise it above {millimetres(-tooth_radius)}."
        )
    largest = largest_rotation(disc.lobe_count)
    if not 0.0 <= disc.rotation <= largest:
        arcmin = 60.0 * math.degrees(1.0)
        raise GeometryError(
            f"modification.rotation {disc.rotation * arcmin:.6g} arcmin is outside 0 to "
            f"{rounded_down(largest * arcmin):.6g} arcmin, an eighth of half a lobe pitch on "
            f"{disc.lobe_count} lobes; choose a value between."
        )


def _refuse_undercut(disc: CycloidDisc) -> None:
    lobe_count, eccentricity, radial = disc.lobe_count, disc.eccentricity, disc.radial
    # A modification that grows the disc leaves the ring's own teeth as large as they are.
    pitch = disc.ring_pitch_radius - max(radial, 0.0)
    tooth = disc.tooth_radius + max(disc.equidistant, 0.0)
    limit = 0.0
    if pitch > 0.0:
        limit = float(undercut_radius_limit(lobe_count, pitch, eccentricity))
    if tooth < limit:
        return
    enough = smallest_pitch_radius(lobe_count, eccentricity, tooth) + max(radial, 0.0)
    fix = f"raise ring_pitch_radius to {_at_least(enough)}"
    allowed = largest_eccentricity(lobe_count, pitch, tooth) if pitch > tooth else 0.0
    if allowed <= 0.0:
        raise GeometryError(
            f"ring_pitch_radius {millimetres(disc.ring_pitch_radius)} with modification.radial "
            f"{millimetres(radial)} and modification.equidistant {millimetres(disc.equidistant)} "
            f"leaves no disc at any eccentricity; reduce the modification, or {fix}."
        )
    raise GeometryError(
        f"eccentricity {millimetres(eccentricity)} is above {_at_most(allowed)}, where the disc "
        f"undercuts at ring_pin_diameter {millimetres(2.0 * disc.tooth_radius)}; lower it, or "
        f"{fix}."
    )
