"""The fixed ring as a part, in its three forms, with n + 1 teeth and tooth 0 on +x.

``solid``
    One wire-cut body: teeth are arcs of the tooth radius on the pitch circle, joined by a relief.
``conjugate``
    One wire-cut body whose contour is the exact boundary of what the disc sweeps: the disc is in
    contact with every tooth twice, and nothing is relieved.
``pinwheel``
    A body with a bore that clears the disc and a round pocket for each pin; the pins are parts of
    their own and touch the disc. With rollers on the pins it is these that touch, the pockets
    clear them, and the pins are held beyond the discs.

The teeth are nominal: clearance comes from the modification of the disc.
"""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.errors import GeometryError
from cqdd_design.geometry.biarc import ArcChain, fit_biarcs, mirrored_contour
from cqdd_design.geometry.conjugate import SecondEnvelope, active_angle, swept_radius
from cqdd_design.geometry.contours import (
    ArcContour,
    Circle,
    FloatArray,
    Moments,
    PlanarPart,
    gauss_rule,
)
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.limits import millimetres, rounded_down, rounded_up
from cqdd_design.geometry.meshing import tooth_centres
from cqdd_design.geometry.relief import solid_relief

if TYPE_CHECKING:
    from cqdd_design.design import Design

_PANELS = 32
_PANEL_POINTS = 40


def ring_root_radius(design: Design) -> float:
    """Farthest the ring's inner contour reaches from its centre, m.

    Solid: R + 2 e - r + clearance. Conjugate: R + 2 e - r. Pinwheel: R and the pockets' radius.
    """
    disc = CycloidDisc.from_design(design)
    if design.reducer.ring_type == "pinwheel":
        return disc.ring_pitch_radius + pocket_radius(design)
    if design.reducer.ring_type == "conjugate":
        return swept_radius(disc)
    return swept_radius(disc) + design.reducer.ring.relief_clearance


def ring_min_concave_radius(design: Design) -> float:
    """Least concave radius of the inner contour, m: the wire and its gap must be finer.

    Solid: the fillet beside the teeth. Conjugate: the second envelope's sharpest place. Pinwheel:
    the pockets.
    """
    disc = CycloidDisc.from_design(design).unmodified
    if design.reducer.ring_type == "pinwheel":
        return pocket_radius(design)
    if design.reducer.ring_type == "conjugate":
        return 1.0 / _sharpest_bend(disc)
    return solid_relief(disc, design.reducer.ring.relief_clearance).fillet_radius


@lru_cache(maxsize=64)
def _sharpest_bend(disc: CycloidDisc) -> float:
    """Largest curvature of the second envelope, 1/m, to the square of a fine grid's step."""
    envelope = SecondEnvelope.of(disc)
    grid = np.linspace(envelope.start, envelope.end, 4097)
    return float(envelope.curvature(grid).max())


def ring_contour(design: Design, tolerance: float | None = None) -> PlanarPart:
    """Return the ring as it is cut.

    Parameters
    ----------
    tolerance : float, optional
        Most distance of a conjugate contour from the exact curve, m; the design's
        ``edm.profile_tolerance`` where left out. The other types are exact arcs.

    Returns
    -------
    PlanarPart
        Outer circle; one inner contour, counter-clockwise from the +x axis, where it starts on the
        apex of tooth 0 (pinwheel: on the bottom of its pocket).

    Raises
    ------
    GeometryError
        When there is no wall, no relief, or no pocket that holds a pin.
    """
    allowed = design.edm.profile_tolerance if tolerance is None else tolerance
    _refuse_thin_ring(design)
    disc = CycloidDisc.from_design(design).unmodified
    inner = _inner_contour(
        disc,
        design.reducer.ring_type,
        design.reducer.ring.relief_clearance,
        pocket_radius(design),
        allowed,
    )
    outer = Circle(np.zeros(2), design.reducer.ring.outer_diameter / 2.0)
    return PlanarPart("ring", outer, (inner,))


def pocket_radius(design: Design) -> float:
    """Radius of the pockets of a pinwheel ring, m: of its pins, or clear of the rollers on them."""
    reducer = design.reducer
    clear = reducer.ring.relief_clearance if reducer.ring.roller_diameter else 0.0
    return 0.5 * reducer.tooth_diameter + clear


def ring_pins(design: Design) -> tuple[Circle, ...]:
    """What touches the disc of a pinwheel ring, pins or their rollers; empty for other types."""
    if design.reducer.ring_type != "pinwheel":
        return ()
    disc = CycloidDisc.from_design(design)
    return tuple(Circle(centre, disc.tooth_radius) for centre in tooth_centres(disc))


def _refuse_thin_ring(design: Design) -> None:
    """Raise where the inner contour breaks through the outside."""
    outer = design.reducer.ring.outer_diameter
    least = 2.0 * ring_root_radius(design)
    if outer <= least:
        raise GeometryError(
            f"ring.outer_diameter {millimetres(outer)} leaves no wall outside the inner contour "
            f"of a {design.reducer.ring_type} ring, which reaches {millimetres(least)}; raise it "
            f"to {rounded_up((least + 5e-3) * 1e3):.6g} mm, or lower ring_pitch_radius."
        )


@lru_cache(maxsize=64)
def _inner_contour(
    disc: CycloidDisc, ring_type: str, clearance: float, pocket: float, tolerance: float
) -> ArcContour:
    if ring_type == "conjugate":
        chain = _conjugate_chain(disc, tolerance)
    elif ring_type == "pinwheel":
        chain = _pinwheel_chain(disc, clearance, pocket)
    else:
        chain = _solid_chain(disc, clearance)
    return mirrored_contour(chain, disc.ring_tooth_count)


def _quarter(sweep: float) -> float:
    return math.tan(sweep / 4.0)


def _solid_chain(disc: CycloidDisc, clearance: float) -> ArcChain:
    """Half a tooth, a fillet, and half of the root arc where the fillet leaves one."""
    relief = solid_relief(disc, clearance)
    R, r = disc.ring_pitch_radius, disc.tooth_radius
    half = math.pi / disc.ring_tooth_count
    points = [
        complex(R - r),
        R - r * np.exp(-1j * relief.tooth_angle),
        relief.root_radius * np.exp(1j * relief.root_angle),
    ]
    bulges = [-_quarter(relief.tooth_angle), _quarter(relief.tooth_angle + relief.root_angle)]
    if half - relief.root_angle > 1e-9:
        points.append(relief.root_radius * np.exp(1j * half))
        bulges.append(_quarter(half - relief.root_angle))
    return ArcChain(np.array(points), np.array(bulges), 0.0)


def _conjugate_chain(disc: CycloidDisc, tolerance: float) -> ArcChain:
    """Half of a tooth's active arc, then the second envelope to midway between two teeth."""
    envelope = SecondEnvelope.of(disc)
    fitted = fit_biarcs(
        envelope.point,
        lambda t: np.asarray(1j * envelope.normal(t)),
        (envelope.start, envelope.end),
        tolerance,
    )
    apex = disc.ring_pitch_radius - disc.tooth_radius
    return ArcChain(
        np.concatenate([[apex], fitted.points]),
        np.concatenate([[-_quarter(active_angle(disc))], fitted.bulges]),
        fitted.deviation,
    )


def _pinwheel_chain(disc: CycloidDisc, clearance: float, pocket: float) -> ArcChain:
    """Half of a pin's pocket, then half of the bore to the next."""
    R, r = disc.ring_pitch_radius, pocket
    bore = swept_radius(disc) + clearance
    cosine = (bore * bore - R * R - r * r) / (2.0 * R * r)
    wrap = math.acos(min(max(cosine, -1.0), 1.0))
    # Forces on a pin lean up to asin(K1) from the outward radial; the pocket must lie behind them.
    # A pocket that clears a roller bears none, and need only be there.
    rollers = pocket > disc.tooth_radius
    half = math.pi / disc.ring_tooth_count
    corner = R + r * np.exp(1j * wrap)
    if rollers and (r >= R * math.sin(half) or abs(cosine) >= 1.0):
        fix = "lower it, or raise ring_pitch_radius"
        if abs(cosine) >= 1.0:
            fix = "the disc sweeps past them; raise it, or lower eccentricity"
        raise GeometryError(
            f"ring.roller_diameter {millimetres(2.0 * disc.tooth_radius)} leaves no ring between "
            f"the pockets that clear the rollers by {millimetres(clearance)}: {fix}."
        )
    if not rollers and wrap <= active_angle(disc):
        most = math.sqrt(R * R + r * r + 2.0 * R * r * math.cos(active_angle(disc))) - R + r
        raise GeometryError(
            f"ring_pin_diameter {millimetres(2.0 * r)} is too small for pockets in a pinwheel "
            f"ring: its bore must clear the disc, so a pocket holds {math.degrees(wrap):.3g} deg "
            f"to each side of the radial, and forces lean to "
            f"{math.degrees(active_angle(disc)):.3g} deg. 2 x eccentricity + "
            f"ring.relief_clearance must be below {rounded_down(most * 1e3):.6g} mm; raise "
            f'ring_pin_diameter, lower eccentricity, or use ring_type = "solid".'
        )
    points = np.array([complex(R + r), corner, bore * np.exp(1j * half)])
    bulges = np.array([_quarter(wrap), _quarter(half - float(np.angle(corner)))])
    return ArcChain(points, bulges, 0.0)


def ring_moments(design: Design) -> Moments:
    """Exact area and second moments of the ring without separate pins.

    Returns
    -------
    Moments
        About the ring's centre. A conjugate contour is integrated on the exact curve, not on its
        arcs.
    """
    part = ring_contour(design)
    if design.reducer.ring_type != "conjugate":
        return part.moments()
    area, polar = _conjugate_integrals(CycloidDisc.from_design(design).unmodified)
    return part.outer.moments() - Moments(area, 0.0, 0.0, polar / 2.0, polar / 2.0, 0.0)


def _conjugate_integrals(disc: CycloidDisc) -> FloatArray:
    """Area and polar second moment inside the conjugate contour."""
    nodes, weights = gauss_rule(_PANEL_POINTS)
    envelope = SecondEnvelope.of(disc)
    limit = active_angle(disc)
    total = np.zeros(2)
    for begin, end in pairwise(np.linspace(0.0, 1.0, _PANELS + 1)):
        u = begin + (end - begin) * nodes
        t = envelope.start + (envelope.end - envelope.start) * u
        tooth = np.exp(-1j * limit * u)
        pieces = (
            (
                disc.ring_pitch_radius - disc.tooth_radius * tooth,
                1j * disc.tooth_radius * limit * tooth,
            ),
            (
                envelope.point(t),
                1j * envelope.normal(t) * envelope.speed(t) * (envelope.end - envelope.start),
            ),
        )
        for point, slope in pieces:
            swept = (np.conj(point) * slope).imag * weights * (end - begin)
            total += [swept.sum() / 2.0, (np.abs(point) ** 2 * swept).sum() / 4.0]
    return np.asarray(2.0 * disc.ring_tooth_count * total)
