"""The exact curves behind the contours of discs and rings, for measuring files against.

A ring's curve is put together again from its circles and from the second envelope, by a road of
its own: the pieces of half a tooth pitch, mirrored about its end and repeated n + 1 times.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.exporting.edm.loops import ComplexArray, ExactCurve, FloatArray
from cqdd_design.geometry.conjugate import SecondEnvelope, active_angle, swept_radius
from cqdd_design.geometry.contours import as_complex, gauss_rule
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.disc import profile_moments, profile_perimeter
from cqdd_design.geometry.grooves import edge_radius
from cqdd_design.geometry.relief import solid_relief
from cqdd_design.geometry.ring import pocket_radius

if TYPE_CHECKING:
    from cqdd_design.design import Design

_PANELS, _NODES = 32, 24


@dataclass(frozen=True, eq=False)
class Piece:
    """A smooth stretch over a fraction from 0 to 1: points (m), unit tangents, speed (m)."""

    point: Callable[[FloatArray], ComplexArray]
    tangent: Callable[[FloatArray], ComplexArray]
    speed: Callable[[FloatArray], FloatArray]

    def length_and_area(self) -> tuple[float, float]:
        """Length (m), and area (m^2) of the sector swept from the origin, by Gauss quadrature."""
        nodes, weights = gauss_rule(_NODES)
        at = (np.arange(_PANELS)[:, None] + nodes) / _PANELS
        step = self.speed(at) * weights / _PANELS
        swept = (np.conj(self.point(at)) * self.tangent(at)).imag * step
        return float(step.sum()), 0.5 * float(swept.sum())


def arc_piece(centre: complex, radius: float, start: float, sweep: float) -> Piece:
    """Arc from angle `start` over `sweep` (rad), clockwise where negative."""
    return Piece(
        lambda u: np.asarray(centre + radius * np.exp(1j * (start + sweep * u))),
        lambda u: np.asarray(math.copysign(1.0, sweep) * 1j * np.exp(1j * (start + sweep * u))),
        lambda u: np.full(np.shape(u), radius * abs(sweep)),
    )


def mirrored_curve(pieces: Sequence[Piece], count: int, corners: int) -> ExactCurve:
    """Repeat half a sector, mirrored about its end, to `count` equal sectors.

    Parameters
    ----------
    pieces : sequence of Piece
        End to end from the +x axis to the axis at pi/count.
    count : int
        Sectors in a full turn.
    corners : int
        Joints of a whole sector at which the direction jumps.
    """
    sizes = np.array([piece.length_and_area() for piece in pieces])
    half = math.pi / count
    ends = half * np.cumsum(sizes[:, 0]) / sizes[:, 0].sum()
    begins = np.concatenate([[0.0], ends[:-1]])
    axis = cmath.exp(2j * half)

    def evaluate(t: FloatArray, of: str) -> ComplexArray:
        sector = np.floor(t / (2.0 * half))
        inner = t - 2.0 * half * sector
        back = inner > half
        inner = np.where(back, 2.0 * half - inner, inner)
        which = np.minimum(np.searchsorted(ends, inner), len(pieces) - 1)
        fraction = (inner - begins[which]) / (ends - begins)[which]
        values = np.zeros(np.shape(t), dtype=complex)
        for number, piece in enumerate(pieces):
            here = which == number
            values[here] = getattr(piece, of)(fraction[here])
        sign = 1.0 if of == "point" else -1.0
        mirrored = np.where(back, sign * axis * np.conj(values), values)
        return np.asarray(mirrored * np.exp(2j * half * sector))

    return ExactCurve(
        point=lambda t: evaluate(t, "point"),
        tangent=lambda t: evaluate(t, "tangent"),
        breaks=_repeated(np.append(0.0, ends), count),
        corners=corners * count,
        perimeter=2.0 * count * float(sizes[:, 0].sum()),
        area=2.0 * count * float(sizes[:, 1].sum()),
    )


def chained_curve(pieces: Sequence[Piece]) -> ExactCurve:
    """Pieces end to end all the way round, without a corner."""
    sizes = np.array([piece.length_and_area() for piece in pieces])
    ends = 2.0 * math.pi * np.cumsum(sizes[:, 0]) / sizes[:, 0].sum()
    begins = np.concatenate([[0.0], ends[:-1]])

    def evaluate(t: FloatArray, of: str) -> ComplexArray:
        turned = np.mod(t, 2.0 * math.pi)
        which = np.minimum(np.searchsorted(ends, turned), len(pieces) - 1)
        fraction = (turned - begins[which]) / (ends - begins)[which]
        values = np.zeros(np.shape(t), dtype=complex)
        for number, piece in enumerate(pieces):
            here = which == number
            values[here] = getattr(piece, of)(fraction[here])
        return values

    return ExactCurve(
        point=lambda t: evaluate(t, "point"),
        tangent=lambda t: evaluate(t, "tangent"),
        breaks=np.append(begins, 2.0 * math.pi),
        corners=0,
        perimeter=float(sizes[:, 0].sum()),
        area=float(sizes[:, 1].sum()),
    )


def grooved_curve(radius: float, angles: Sequence[float], groove: float) -> ExactCurve:
    """Outside of a ring with half grooves (radii, m): by the circles that make it.

    A fillet of radius f touches the outside from within and the groove g from without: the
    triangle of axis, its centre and the groove's has the sides R - f, g + f and R.
    """
    R, g, f = radius, groove, edge_radius(groove)
    half = math.acos(1.0 - ((g + f) ** 2 - f * f) / (2.0 * R * (R - f)))
    # Angle at the fillet's centre between the lines to the axis and to the groove's centre.
    at_fillet = math.acos(((R - f) ** 2 + (g + f) ** 2 - R * R) / (2.0 * (R - f) * (g + f)))
    at_groove = math.pi - half - at_fillet
    turn = math.pi - at_fillet
    pieces = []
    following = [*angles[1:], angles[0] + 2.0 * math.pi]
    for at, after in zip(angles, following, strict=True):
        axis = cmath.exp(1j * at)
        before, behind = (cmath.rect(R - f, at + side * half) for side in (-1.0, 1.0))
        pieces += [
            arc_piece(before, f, at - half, turn),
            arc_piece(R * axis, g, at + math.pi + at_groove, -2.0 * at_groove),
            arc_piece(behind, f, at + half - turn, turn),
            arc_piece(0.0, R, at + half, after - at - 2.0 * half),
        ]
    return chained_curve(pieces)


def _repeated(half: FloatArray, count: int) -> FloatArray:
    """Breaks of half a sector, mirrored about its end, over the full turn."""
    pitch = 2.0 * math.pi / count
    sector = np.append(half[:-1], pitch - half[:0:-1])
    return np.append((pitch * np.arange(count)[:, None] + sector).ravel(), 2.0 * math.pi)


def disc_curve(design: Design) -> ExactCurve:
    """Finished outline of the discs, from the closed form."""
    disc = CycloidDisc.from_design(design)
    return ExactCurve(
        point=lambda t: as_complex(disc.flank(t)),
        tangent=lambda t: as_complex(disc.tangent(t)),
        breaks=_repeated(np.asarray(disc.breaks), disc.lobe_count),
        corners=0,
        perimeter=profile_perimeter(disc),
        area=profile_moments(disc).area,
    )


def ring_curve(design: Design) -> ExactCurve:
    """Inner contour of the ring: its teeth, and what joins them."""
    disc = CycloidDisc.from_design(design).unmodified
    clearance = design.reducer.ring.relief_clearance
    kind = design.reducer.ring_type
    corners = 0
    if kind == "conjugate":
        pieces = _conjugate_pieces(disc)
    elif kind == "pinwheel":
        pieces, corners = _pinwheel_pieces(disc, clearance, pocket_radius(design)), 2
    else:
        pieces = _solid_pieces(disc, clearance)
    return mirrored_curve(pieces, disc.ring_tooth_count, corners)


def _tooth_piece(disc: CycloidDisc, angle: float) -> Piece:
    """From the apex of tooth 0 to `angle` from its inward radial."""
    return arc_piece(disc.ring_pitch_radius, disc.tooth_radius, math.pi, -angle)


def _solid_pieces(disc: CycloidDisc, clearance: float) -> list[Piece]:
    relief = solid_relief(disc, clearance)
    half = math.pi / disc.ring_tooth_count
    pieces = [
        _tooth_piece(disc, relief.tooth_angle),
        arc_piece(
            relief.fillet_centre,
            relief.fillet_radius,
            -relief.tooth_angle,
            relief.tooth_angle + relief.root_angle,
        ),
    ]
    if half - relief.root_angle > 1e-9:
        root = arc_piece(0.0, relief.root_radius, relief.root_angle, half - relief.root_angle)
        pieces.append(root)
    return pieces


def _conjugate_pieces(disc: CycloidDisc) -> list[Piece]:
    envelope = SecondEnvelope.of(disc)
    start, span = envelope.start, envelope.end - envelope.start
    return [
        _tooth_piece(disc, active_angle(disc)),
        Piece(
            lambda u: envelope.point(start + span * u),
            lambda u: np.asarray(1j * envelope.normal(start + span * u)),
            lambda u: np.asarray(span * envelope.speed(start + span * u)),
        ),
    ]


def _pinwheel_pieces(disc: CycloidDisc, clearance: float, pocket: float) -> list[Piece]:
    """Half a pocket about pin 0, then the bore from where the two circles meet."""
    R, r = disc.ring_pitch_radius, pocket
    bore = swept_radius(disc) + clearance
    x = (bore * bore - r * r + R * R) / (2.0 * R)
    corner = complex(x, math.sqrt(bore * bore - x * x))
    half = math.pi / disc.ring_tooth_count
    return [
        arc_piece(R, r, 0.0, cmath.phase(corner - R)),
        arc_piece(0.0, bore, cmath.phase(corner), half - cmath.phase(corner)),
    ]
