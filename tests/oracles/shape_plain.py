"""Plain numpy twins of ``cqdd_design.sizing.shape_kernel``: whole arrays of ring stages at once."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cqdd_design.gearbox.checks import allowables
from cqdd_design.geometry.conjugate import SecondEnvelope
from cqdd_design.geometry.contours import ComplexArray, FloatArray
from cqdd_design.geometry.trochoid import GeneratedFlank, shortening_coefficient
from cqdd_design.sizing.frame import Frame
from cqdd_design.sizing.shape_kernel import (
    AREA_POINTS,
    ENVELOPE_POINTS,
    FILLET_TRIALS,
    PROFILE_POINTS,
)
from cqdd_design.sizing.shape_limits import SAMPLING_GUARD, BoolArray, RingSizes, valley_distance


def _flank(frame: Frame, ring: RingSizes, spare: int = 1) -> Any:
    """Generated flank of many discs, designs on the first axis and `spare` more to come."""
    own = (slice(None),) + (None,) * spare
    columns: tuple[Any, ...] = (
        (ring.pitch_radius - frame.radial)[own],
        ring.eccentricity[own],
        (ring.tooth_radius + frame.equidistant)[own],
    )
    return GeneratedFlank(frame.lobe_count, *columns)


def _even_parameter(
    flank: Any, place: FloatArray, crowding: float
) -> tuple[FloatArray, FloatArray]:
    """Disc parameters (G, P) and their rates for places along one lobe, -pi to pi, valley at 0.

    Even steps of t leap through sharp valleys; even steps of place do not:
    tan(n t/2) = ((1 - K1)/(1 + K1))^crowding tan(place/2). One follows the bend of the valley,
    a half suits integrals over the whole lobe.
    """
    sharpness = ((1.0 - flank.shortening) / (1.0 + flank.shortening)) ** crowding
    cosine, sine = np.cos(0.5 * place), np.sin(0.5 * place)
    parameter = 2.0 / flank.lobe_count * np.arctan2(sharpness * sine, cosine)
    rate = sharpness / (cosine**2 + (sharpness * sine) ** 2) / flank.lobe_count
    return parameter, rate


def largest_pin_circle(
    frame: Frame, ring: RingSizes, hole_radius: FloatArray, offset: FloatArray
) -> FloatArray:
    """As `shape_limits.largest_pin_circle`."""
    clear = hole_radius + allowables.LIGAMENT + SAMPLING_GUARD
    spare = len(np.broadcast_shapes(clear.shape, offset.shape)) - 1
    own = (slice(None),) + (None,) * spare

    def limits(point: ComplexArray) -> FloatArray:
        """Largest pin circles for one profile point of each candidate."""
        rho, turn = np.abs(point), np.angle(point) - offset
        reach = clear * clear - (rho * np.sin(turn)) ** 2
        here = rho * np.cos(turn) - np.sqrt(np.maximum(reach, 0.0))
        return np.where(reach > 0.0, here, np.inf)

    places, step = np.linspace(-0.3 * np.pi, 0.9 * np.pi, PROFILE_POINTS, retstep=True)
    coarse = _flank(frame, ring)
    profile = coarse.point(_even_parameter(coarse, places, 1.0)[0])
    sampled = np.stack([limits(point[own]) for point in profile.T])
    at = np.clip(sampled.argmin(axis=0), 1, PROFILE_POINTS - 2)
    shift, _ = _parabola(*(np.take_along_axis(sampled, (at + k)[None], 0)[0] for k in (-1, 0, 1)))
    nearest = places[at] + step * shift
    flank = _flank(frame, ring, spare)
    refined = [
        limits(flank.point(_even_parameter(flank, nearest + k * step, 1.0)[0]))
        for k in (-0.25, 0.0, 0.25)
    ]
    least = np.minimum(_parabola(*refined)[1], sampled.min(axis=0))
    # Without a profile point in reach of the hole the valley circle decides.
    valley = valley_distance(frame, ring)[own]
    return np.minimum(np.where(np.isinf(least), valley - clear, least), frame.pin_circle_limit)


def _parabola(
    before: FloatArray, middle: FloatArray, after: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Place (in steps from the middle) and value of the least of a parabola through three values.

    Where they hold no minimum between them: the middle, and the least of the three.
    """
    inside = np.isfinite(before) & np.isfinite(after) & (middle <= before) & (middle <= after)
    left, right = np.where(inside, before, 1.0), np.where(inside, after, 1.0)
    bend = left + right - 2.0 * np.where(inside, middle, 0.0)
    slope = 0.5 * (right - left)
    shift = np.where(inside & (bend > 0.0), -slope / np.where(bend > 0.0, bend, 1.0), 0.0)
    least = np.minimum(np.minimum(before, after), middle)
    return shift, np.where(inside, middle + 0.5 * slope * shift, least)


def relief_passes_wire(frame: Frame, ring: RingSizes) -> BoolArray:
    """As `shape_limits.relief_passes_wire`."""
    R, e, r = ring.pitch_radius, ring.eccentricity, ring.tooth_radius
    n, half = frame.lobe_count, math.pi / (frame.lobe_count + 1)
    root = ring.root_radius(frame)
    across = R * math.cos(half)
    groove = (root * root + R * R - 2.0 * root * across - r * r) / (2.0 * (root + r - across))
    least = np.maximum(frame.wire_radius, 0.5 * (root - R - r))
    passes = np.zeros(R.shape, dtype=bool)
    open_ = np.flatnonzero(groove >= least)
    columns: tuple[Any, ...] = tuple(v[open_, None] for v in (R, e, r))
    envelope = SecondEnvelope(GeneratedFlank(n, *columns))
    start = np.arccos(shortening_coefficient(n, R[open_], e[open_])) / n
    share = np.linspace(0.0, 1.0, ENVELOPE_POINTS)
    points = envelope.point(start[:, None] + (envelope.end - start)[:, None] * share)
    for trial in np.linspace(0.0, 1.0, FILLET_TRIALS):
        fillet = least[open_] * (groove[open_] / least[open_]) ** trial
        clear, slim = _fillet_fits(R[open_], r[open_], root[open_], fillet, points)
        passes[open_[(clear >= frame.relief_clearance) & ~slim]] = True
        undecided = (clear >= frame.relief_clearance) & slim
        if not undecided.any():
            break
        open_, points = open_[undecided], points[undecided]
    return passes


def _fillet_fits(
    R: FloatArray,
    r: FloatArray,
    root: FloatArray,
    fillet: FloatArray,
    swept: ComplexArray,
) -> tuple[FloatArray, BoolArray]:
    """Clearance of a fillet from the swept disc, and whether it leaves the tooth no neck."""
    reach = root - fillet
    cosine = (reach * reach + R * R - (r + fillet) ** 2) / (2.0 * R * reach)
    to_root = np.arccos(np.clip(cosine, -1.0, 1.0))
    centre = reach * np.exp(1j * to_root)
    to_tooth = np.pi - np.angle(centre - R)
    away = swept - centre[:, None]
    angle = np.angle(away)
    beside = (angle >= -to_tooth[:, None]) & (angle <= to_root[:, None])
    ends = np.stack(
        [centre + fillet * np.exp(-1j * to_tooth), centre + fillet * np.exp(1j * to_root)], axis=1
    )
    to_ends = np.abs(swept[:, :, None] - ends[:, None, :]).min(axis=-1)
    clear = np.where(beside, fillet[:, None] - np.abs(away), to_ends).min(axis=1)
    slim = (to_tooth > 0.5 * np.pi) & (centre.imag <= fillet)
    return clear, slim


def profile_integrals(frame: Frame, ring: RingSizes) -> tuple[FloatArray, FloatArray]:
    """Areas (G,), m^2, and polar moments about the centre (G,), m^4, of lobed outlines.

    By Green's theorem, without holes; the trapezoidal rule is spectral here.
    """
    flank = _flank(frame, ring)
    step = 2.0 * np.pi / AREA_POINTS
    place = np.asarray(step * (np.arange(AREA_POINTS) + 0.5) - np.pi, dtype=np.float64)
    t, rate = _even_parameter(flank, place, 0.5)
    normal = flank.normal(t)
    point = flank.locus(t) - flank.tooth_radius * normal
    speed = flank.locus_speed(t) * (1.0 - flank.tooth_radius * flank.locus_bend(t))
    swept = (point * np.conj(normal)).real * speed * rate * (frame.lobe_count * step)
    squared = point.real**2 + point.imag**2
    return 0.5 * swept.sum(axis=-1), 0.25 * (squared * swept).sum(axis=-1)
