"""The disc as a part: outline, bore, holes, ligaments, and its exact area integrals.

Holes stand at ``clocking + p/n + 2 pi j/N`` in the frame of the disc's own lobes, with p the crank
phase of the disc: the lobes of a phased disc are turned by -p/n in the world, its holes are not::

         valley on +x            p = 2 pi d / D for disc d of D
        .-'''-.                  p/n = 18 deg for the second of two 10-lobe discs
       ( o (+) o )--- x
        '-...-'

Where columns tie the carrier's cap to its plate, their holes stand midway between output holes
(:mod:`.columns`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.errors import UsageError
from cqdd_design.geometry.biarc import fit_biarcs, mirrored_contour
from cqdd_design.geometry.columns import column_hole_diameter, column_offsets
from cqdd_design.geometry.contours import (
    ArcContour,
    Circle,
    FloatArray,
    Moments,
    PlanarPart,
    as_points,
    gauss_rule,
)
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.kinematics import crank_phases, hole_clocking_in_disc
from cqdd_design.geometry.meshing import project
from cqdd_design.geometry.output_pins import mean_pin_diameter

if TYPE_CHECKING:
    from cqdd_design.design import Design

_PANEL_POINTS = 40
_MOST_PANELS = 64


@dataclass(frozen=True)
class Ligament:
    """The thinnest material between two edges of a disc.

    Attributes
    ----------
    kind : str
        ``hole to hole``, ``hole to profile``, ``hole to bore`` or ``bore to profile``; with columns
        also ``column to hole``, ``column to profile`` and ``column to bore``, of their holes.
    thickness : float
        m; zero or less means the edges meet.
    where : str
        Which disc, which holes.
    """

    kind: str
    thickness: float
    where: str


def hole_diameter(design: Design) -> float:
    """Diameter of the output holes: pin (or sleeve) + 2 e + clearance, m.

    A pin counts with the mean of its limits of size: a 4 mm shoulder screw to f9 has 3.975 mm.
    """
    reducer, pins = design.reducer, design.reducer.output_pins
    runner = pins.sleeve_diameter or mean_pin_diameter(pins)
    return float(runner + 2.0 * reducer.eccentricity + pins.hole_clearance)


def crank_phase(design: Design, disc_index: int) -> float:
    """Crank phase 2 pi d / D of disc d, counted from 0, rad."""
    count = design.reducer.disc_count
    if not 0 <= disc_index < count:
        raise UsageError(f"disc {disc_index} does not exist; the design has 0 to {count - 1}.")
    return float(crank_phases(count)[disc_index])


def first_hole_angle(design: Design, disc_index: int) -> float:
    """Angle of the first output hole of a disc from a valley of its own lobes, rad."""
    phase, clocking = crank_phase(design, disc_index), design.reducer.output_pins.hole_clocking
    return float(hole_clocking_in_disc(design.reducer.ratio, clocking, phase))


def hole_centres(design: Design, disc_index: int = 0) -> FloatArray:
    """Centres (N, 2) of the output holes in the frame of the disc's own lobes, m."""
    pins = design.reducer.output_pins
    first = first_hole_angle(design, disc_index)
    turns = first + 2.0 * math.pi * np.arange(pins.count) / pins.count
    return as_points(pins.circle_radius * np.exp(1j * turns))


def column_hole_centres(design: Design, disc_index: int = 0) -> FloatArray:
    """Centres (N_c, 2) of the holes for columns in the frame of the disc's own lobes, m."""
    turns = first_hole_angle(design, disc_index) + column_offsets(design.reducer)
    return as_points(design.reducer.output_pins.circle_radius * np.exp(1j * turns))


def disc_holes(design: Design, disc_index: int) -> tuple[Circle, ...]:
    """Round holes of a disc beside its bore: output holes in order, then those for columns."""
    output, column = hole_diameter(design) / 2.0, column_hole_diameter(design.reducer) / 2.0
    return (
        *(Circle(centre, output) for centre in hole_centres(design, disc_index)),
        *(Circle(centre, column) for centre in column_hole_centres(design, disc_index)),
    )


@lru_cache(maxsize=64)
def lobed_outline(disc: CycloidDisc, tolerance: float) -> ArcContour:
    """Outline of the finished disc in arcs, within `tolerance` (m) of the exact curve.

    Starts at the valley on +x; every lobe has the same arcs, mirrored about its axis.
    """
    chain = fit_biarcs(
        lambda t: disc.profile(t)[0],
        lambda t: 1j * disc.profile(t)[1],
        disc.breaks,
        tolerance,
    )
    return mirrored_contour(chain, disc.lobe_count)


def disc_contour(
    design: Design, disc_index: int, *, bore_diameter: float, tolerance: float | None = None
) -> PlanarPart:
    """One disc as it is cut: lobed outline, bore, output holes, holes for columns.

    Parameters
    ----------
    disc_index : int
        From 0; decides how the holes stand against the lobes.
    bore_diameter : float
        Outside diameter of the cam bearing, m.
    tolerance : float, optional
        Most distance of the outline from the exact profile, m; the design's
        ``edm.profile_tolerance`` where left out.

    Returns
    -------
    PlanarPart
        In the frame of the disc's lobes: centre at the origin, a valley on +x. Holes: the bore
        first, then those of `disc_holes`.
    """
    allowed = design.edm.profile_tolerance if tolerance is None else tolerance
    outline = lobed_outline(CycloidDisc.from_design(design), allowed)
    bore = Circle(np.zeros(2), bore_diameter / 2.0)
    holes = disc_holes(design, disc_index)
    return PlanarPart(f"disc {disc_index + 1}", outline, (bore, *holes))


def ligaments(design: Design, *, bore_diameter: float) -> tuple[Ligament, ...]:
    """Thinnest material of each kind over all discs, thinnest first.

    Parameters
    ----------
    bore_diameter : float
        m, as for `disc_contour`.

    Returns
    -------
    tuple of Ligament
        Distances from holes to the profile are to its nearest point, not to the valley circle.
    """
    disc = CycloidDisc.from_design(design)
    pins = design.reducer.output_pins
    hole, column = hole_diameter(design), column_hole_diameter(design.reducer)
    found = [
        Ligament(
            "hole to hole",
            float(ligament_hole_to_hole(pins.circle_radius, pins.count, hole)),
            "between neighbouring output holes",
        ),
        Ligament(
            "hole to bore",
            float(ligament_hole_to_bore(pins.circle_radius, hole, bore_diameter)),
            "between each output hole and the bore",
        ),
        Ligament(
            "bore to profile",
            disc.valley_distance - bore_diameter / 2.0,
            "between the bore and each valley",
        ),
        _to_profile(design, disc, "hole", "output hole", hole_centres, hole),
    ]
    if column > 0.0:
        # Twice as many places on the circle, the holes of both kinds in turn.
        between = ligament_hole_to_hole(pins.circle_radius, 2 * pins.count, (hole + column) / 2.0)
        found += [
            Ligament(
                "column to hole",
                float(between),
                "between each hole for a column and its output holes",
            ),
            Ligament(
                "column to bore",
                float(ligament_hole_to_bore(pins.circle_radius, column, bore_diameter)),
                "between each hole for a column and the bore",
            ),
            _to_profile(design, disc, "column", "column hole", column_hole_centres, column),
        ]
    return tuple(sorted(found, key=lambda one: one.thickness))


def _to_profile(
    design: Design,
    disc: CycloidDisc,
    kind: str,
    name: str,
    centres: Callable[[Design, int], FloatArray],
    hole: float,
) -> Ligament:
    """The least material between holes of one kind and the profile, over all discs."""
    worst, where = math.inf, ""
    for index in range(design.reducer.disc_count):
        depths = -project(disc, centres(design, index)).distance
        nearest = int(depths.argmin())
        if depths[nearest] < worst - 1e-12:
            worst = float(depths[nearest])
            where = f"between {name} {nearest + 1} of disc {index + 1} and the profile"
    return Ligament(f"{kind} to profile", worst - hole / 2.0, where)


def ligament_hole_to_hole(
    circle_radius: ArrayLike, hole_count: ArrayLike, hole: ArrayLike
) -> FloatArray:
    """Material between neighbouring holes of diameter `hole`, m; arguments broadcast."""
    R, N, d = (np.asarray(v, dtype=float) for v in (circle_radius, hole_count, hole))
    return np.asarray(2.0 * R * np.sin(math.pi / N) - d)


def ligament_hole_to_bore(
    circle_radius: ArrayLike, hole: ArrayLike, bore_diameter: ArrayLike
) -> FloatArray:
    """Material between a hole and the bore, m; arguments broadcast."""
    R, d, bore = (np.asarray(v, dtype=float) for v in (circle_radius, hole, bore_diameter))
    return np.asarray(R - (d + bore) / 2.0)


def _half_lobe_integrals(disc: CycloidDisc, panels: int) -> FloatArray:
    """Area, polar second moment and length over the half lobe from 0 to pi/n."""
    nodes, weights = gauss_rule(_PANEL_POINTS)
    total = np.zeros(3)
    for begin, end in pairwise(disc.breaks):
        step = (end - begin) / panels
        at = begin + step * (np.arange(panels)[:, None] + nodes)
        speed = disc.speed(at) * step * weights
        point, normal = disc.profile(at)
        swept = (point * np.conj(normal)).real * speed
        total += [swept.sum() / 2.0, (np.abs(point) ** 2 * swept).sum() / 4.0, speed.sum()]
    return total


@lru_cache(maxsize=256)
def _profile_integrals(disc: CycloidDisc) -> tuple[float, float, float]:
    panels, before = 1, _half_lobe_integrals(disc, 1)
    while panels < _MOST_PANELS:
        panels *= 2
        now = _half_lobe_integrals(disc, panels)
        done = np.abs(now - before).max() <= 1e-15 * np.abs(now).max()
        before = now
        if done:
            break
    area, polar, length = 2.0 * disc.lobe_count * before
    return float(area), float(polar), float(length)


def profile_moments(disc: CycloidDisc) -> Moments:
    """Area and second moments of the lobed outline without holes, by Green's theorem.

    Gauss quadrature of the exact finished curve, refined until it no longer changes: good to
    about 14 digits. With three or more lobes the outline has no preferred axis, so xx = yy.
    """
    area, polar, _ = _profile_integrals(disc)
    return Moments(area, 0.0, 0.0, polar / 2.0, polar / 2.0, 0.0)


def profile_perimeter(disc: CycloidDisc) -> float:
    """Length of the lobed outline, m."""
    return _profile_integrals(disc)[2]


def disc_moments(design: Design, disc_index: int, *, bore_diameter: float) -> Moments:
    """Exact area and second moments of one disc with its bore and holes.

    About the disc's centre; times thickness and density they are mass and inertia. Arguments as
    for `disc_contour`.
    """
    total = profile_moments(CycloidDisc.from_design(design))
    total = total - Circle(np.zeros(2), bore_diameter / 2.0).moments()
    for hole in disc_holes(design, disc_index):
        total = total - hole.moments()
    return total
