r"""The finished disc outline: the generated flank with its modification, and its exact geometry.

The unmodified outline is the flank of `trochoid`. Three modifications shrink it where positive:
``equidistant`` and ``radial`` change the tooth that generates it, ``rotation`` turns each flank
toward its lobe axis and rounds the two corners this leaves::

            tip arc, centre on the lobe axis
           ..---..
          /       \         each flank turned by delta toward the axis
         |    :    |
    ____/     :     \____   valley: arc about the disc's centre over 2 delta
              : lobe axis
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cqdd_design.errors import GeometryError
from cqdd_design.geometry.contours import ComplexArray, FloatArray, as_points
from cqdd_design.geometry.limits import (
    at_least,
    at_most,
    largest_eccentricity,
    millimetres,
    rounded_down,
    smallest_pitch_radius,
)
from cqdd_design.geometry.tip import TipArc, fit_tip_arc, largest_rotation
from cqdd_design.geometry.trochoid import (
    GeneratedFlank,
    locus_valley_radius,
    undercut_radius_limit,
)

if TYPE_CHECKING:
    from cqdd_design.design import Design

FEWEST_LOBES = 3
# Below this the arcs of tip and valley are as short as the rounding of their coordinates.
_LEAST_ROTATION = 1e-7


@dataclass(frozen=True)
class CycloidDisc:
    """A cycloid disc outline with its modification, finished profile included.

    Attributes
    ----------
    lobe_count : int
        n, 3 or more. The ring has n + 1 teeth.
    ring_pitch_radius, eccentricity, tooth_radius : float
        R, e and r of the gearbox (nominal), m.
    equidistant : float
        Added to the tooth radius used for generation, m; positive leaves that gap at every tooth.
    radial : float
        Taken from the pitch radius used for generation, m; positive shrinks the disc.
    rotation : float
        Angle by which each flank is turned toward its lobe axis, rad, not negative. The finished
        profile lies inside the intersection of the profiles turned by plus and minus this angle:
        at the valley an arc about the disc's centre spans the gap, at the tip an arc centred on
        the lobe axis is tangent to both flanks, so it is tangent-continuous and mirror-symmetric.
    throw : float
        Added to the eccentricity used for generation, m: what heat makes of a disc that is warmer
        than its shaft.

    The parameter `t` (rad) of every method runs once round the disc from the valley on +x, one
    lobe in 2 pi/n. Without rotation it is the ring tooth's parameter: at crank angle phi, tooth k
    touches at t = 2 pi k/(n+1) + phi/n.

    Raises
    ------
    GeometryError
        When no such disc exists: K1 not below one, undercut, too much modification.
    """

    lobe_count: int
    ring_pitch_radius: float
    eccentricity: float
    tooth_radius: float
    equidistant: float = 0.0
    radial: float = 0.0
    rotation: float = 0.0
    throw: float = 0.0

    def __post_init__(self) -> None:
        """Refuse a disc that cannot exist."""
        _refuse_impossible(self)
        if self.is_turned:
            _ = self.tip_arc

    @classmethod
    def from_design(cls, design: Design) -> CycloidDisc:
        """Read the disc outline of a design; equal outlines are made, and searched, once."""
        reducer, change = design.reducer, design.reducer.modification
        try:
            return _disc_of(
                reducer.ratio,
                reducer.ring_pitch_radius,
                reducer.eccentricity,
                reducer.tooth_diameter / 2.0,
                change.equidistant,
                change.radial,
                change.rotation,
            )
        except GeometryError as error:
            # A disc knows its teeth, not which key of a design has their size.
            raise GeometryError(
                str(error).replace("ring_pin_diameter", reducer.tooth_key)
            ) from None

    @property
    def ring_tooth_count(self) -> int:
        """Teeth of the ring, one more than lobes on the disc."""
        return self.lobe_count + 1

    @property
    def shortening_coefficient(self) -> float:
        """K1 of the gearbox, from the nominal pitch radius."""
        return self.eccentricity * (self.lobe_count + 1) / self.ring_pitch_radius

    @property
    def undercut_radius_limit(self) -> float:
        """Largest tooth radius the generating locus allows, m."""
        g = self.generated
        return float(undercut_radius_limit(g.lobe_count, g.pitch_radius, g.eccentricity))

    @cached_property
    def generated(self) -> GeneratedFlank:
        """The flank as generated, before rotation."""
        return GeneratedFlank(
            self.lobe_count,
            self.ring_pitch_radius - self.radial,
            self.eccentricity + self.throw,
            self.tooth_radius + self.equidistant,
        )

    @property
    def unmodified(self) -> CycloidDisc:
        """The disc conjugate to the nominal ring."""
        return _disc_of(
            self.lobe_count, self.ring_pitch_radius, self.eccentricity, self.tooth_radius
        )

    @property
    def is_turned(self) -> bool:
        """Whether the flanks are turned; by less than 1e-7 rad, a few nanometres, they are not."""
        return self.rotation >= _LEAST_ROTATION

    @property
    def half_pitch(self) -> float:
        """Angle from a valley to the next tip, pi/n, rad."""
        return math.pi / self.lobe_count

    @property
    def valley_distance(self) -> float:
        """Distance of the valleys from the disc's centre, m."""
        g = self.generated
        return g.pitch_radius - g.eccentricity - g.tooth_radius

    @property
    def tip_distance(self) -> float:
        """Distance of the lobe tips from the disc's centre, m."""
        if self.is_turned:
            return abs(self.tip_arc.centre) + self.tip_arc.radius
        g = self.generated
        return g.pitch_radius + g.eccentricity - g.tooth_radius

    @property
    def min_convex_radius(self) -> float:
        """Least convex radius of curvature of the finished flank and tip, m."""
        g = self.generated
        sharpest = g.sharpest_parameter()
        if self.is_turned:
            sharpest = min(sharpest, self.tip_arc.parameter)
            return min(1.0 / float(g.curvature(np.asarray(sharpest))), self.tip_arc.radius)
        return 1.0 / float(g.curvature(np.asarray(sharpest)))

    @property
    def min_concave_radius(self) -> float:
        """Least concave radius of curvature, at the valleys, m; the wire must be finer."""
        g = self.generated
        valley = locus_valley_radius(g.lobe_count, g.pitch_radius, g.eccentricity)
        return float(valley) + g.tooth_radius

    @cached_property
    def breaks(self) -> tuple[float, ...]:
        """Parameters in [0, pi/n] between which the finished profile is one analytic curve."""
        if not self.is_turned:
            return (0.0, self.half_pitch)
        return (
            0.0,
            self.rotation,
            self.rotation + self.tip_arc.parameter,
            self.half_pitch,
        )

    @cached_property
    def tip_arc(self) -> TipArc:
        """The arc that rounds the tips; only where `rotation` is above zero."""
        return fit_tip_arc(self.generated, self.rotation)

    def locus(self, t: ArrayLike) -> FloatArray:
        """Path (..., 2) of the nominal tooth centres in the disc's frame, m."""
        g = self.unmodified.generated
        return as_points(g.locus(np.asarray(t, dtype=float)))

    def flank(self, t: ArrayLike) -> FloatArray:
        """Points (..., 2) of the finished profile, m."""
        return as_points(self.profile(np.asarray(t, dtype=float))[0])

    def normal(self, t: ArrayLike) -> FloatArray:
        """Outward unit normals (..., 2) of the finished profile."""
        return as_points(self.profile(np.asarray(t, dtype=float))[1])

    def tangent(self, t: ArrayLike) -> FloatArray:
        """Counter-clockwise unit tangents (..., 2) of the finished profile."""
        return as_points(1j * self.profile(np.asarray(t, dtype=float))[1])

    def curvature(self, t: ArrayLike) -> FloatArray:
        """Signed curvature (...) of the finished profile, 1/m; positive where convex.

        It jumps where a turned flank meets its arcs; on the joint itself it is the flank's.
        """
        return self.rates(np.asarray(t, dtype=float))[1]

    def speed(self, t: ArrayLike) -> FloatArray:
        """Length of profile per parameter (...), m/rad."""
        return self.rates(np.asarray(t, dtype=float))[0]

    def profile(self, t: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        """Point (m) and outward normal (...) as complex numbers: what the methods above wrap."""
        if not self.is_turned:
            normal = self.generated.normal(t)
            return self.generated.locus(t) - self.generated.tooth_radius * normal, normal
        lobe, inner, mirrored = self._fold(t)
        point, normal = self._half_lobe(inner)
        turn = np.exp(2j * self.half_pitch * lobe)
        axis = np.exp(2j * self.half_pitch)
        return (
            turn * np.where(mirrored, axis * np.conj(point), point),
            turn * np.where(mirrored, axis * np.conj(normal), normal),
        )

    def _fold(self, t: FloatArray) -> tuple[FloatArray, FloatArray, NDArray[np.bool_]]:
        """Lobe number, parameter in [0, pi/n], and whether it lies past the lobe axis."""
        pitch = 2.0 * self.half_pitch
        lobe = np.asarray(np.floor(t / pitch))
        inner = t - lobe * pitch
        mirrored = inner > self.half_pitch
        return lobe, np.clip(np.where(mirrored, pitch - inner, inner), 0.0, None), mirrored

    def _half_lobe(self, s: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        g, tip, delta = self.generated, self.tip_arc, self.rotation
        flank_parameter = np.clip(s - delta, 0.0, tip.parameter)
        turn = np.exp(1j * delta)
        normal = turn * g.normal(flank_parameter)
        point = turn * g.point(flank_parameter)
        dwell = np.exp(1j * np.minimum(s, delta))
        on_tip = np.exp(1j * (tip.start_angle + tip.sweep * self._tip_fraction(s)))
        past = s > delta + tip.parameter
        return (
            np.where(
                s < delta,
                self.valley_distance * dwell,
                np.where(past, tip.centre + tip.radius * on_tip, point),
            ),
            np.where(s < delta, dwell, np.where(past, on_tip, normal)),
        )

    def _tip_fraction(self, s: FloatArray) -> FloatArray:
        start = self.rotation + self.tip_arc.parameter
        return np.clip((s - start) / (self.half_pitch - start), 0.0, 1.0)

    def rates(self, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Speed (m/rad) and curvature (1/m) of the finished profile in one call."""
        if not self.is_turned:
            return self.generated.speed(t), self.generated.curvature(t)
        g, tip, delta = self.generated, self.tip_arc, self.rotation
        s = self._fold(t)[1]
        flank_parameter = np.clip(s - delta, 0.0, tip.parameter)
        past = s > delta + tip.parameter
        tip_speed = tip.radius * tip.sweep / (self.half_pitch - delta - tip.parameter)
        on_flank = np.where(past, tip_speed, g.speed(flank_parameter))
        bend = np.where(past, 1.0 / tip.radius, g.curvature(flank_parameter))
        return (
            np.where(s < delta, self.valley_distance, on_flank),
            np.where(s < delta, 1.0 / self.valley_distance, bend),
        )


@lru_cache(maxsize=16)
def _disc_of(*numbers: float) -> CycloidDisc:
    lobe_count, *lengths = numbers
    return CycloidDisc(int(lobe_count), *lengths)


def _refuse_impossible(disc: CycloidDisc) -> None:
    """Raise where no disc outline of these numbers exists, with the nearest fix in file keys."""
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
            f"{at_most(2.0 * ring_pitch_radius * step)}, where the {lobe_count + 1} ring teeth "
            f"overlap on ring_pitch_radius {millimetres(ring_pitch_radius)}; lower it, or raise "
            f"ring_pitch_radius to {at_least(tooth_radius / step)}."
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
    fix = f"raise ring_pitch_radius to {at_least(enough)}"
    allowed = largest_eccentricity(lobe_count, pitch, tooth) if pitch > tooth else 0.0
    if allowed <= 0.0:
        raise GeometryError(
            f"ring_pitch_radius {millimetres(disc.ring_pitch_radius)} with modification.radial "
            f"{millimetres(radial)} and modification.equidistant {millimetres(disc.equidistant)} "
            f"leaves no disc at any eccentricity; reduce the modification, or {fix}."
        )
    raise GeometryError(
        f"eccentricity {millimetres(eccentricity)} is above {at_most(allowed)}, where the disc "
        f"undercuts at ring_pin_diameter {millimetres(2.0 * disc.tooth_radius)}; lower it, or "
        f"{fix}."
    )
