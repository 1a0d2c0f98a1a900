"""Kinematics of the cycloid stage: ratios, phases, poses, periods and relative speeds.

Frame of the fixed ring: ring tooth i stands at angle 2 pi i/(n+1); the crank angle phi runs
counter-clockwise from +x; at phi = 0 disc 0 has a lobe valley on +x. ``n`` is the number of lobes
on the disc, ``n + 1`` the number of ring teeth. Every function takes arrays and broadcasts.

Where disc, carrier and crank stand is written here once; drawings, solids and mechanics read it.
The compiled kernels write the same two lines with ``math`` and say so.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.geometry.contours import ComplexArray, FloatArray

if TYPE_CHECKING:
    from cqdd_design.geometry.cycloid import CycloidDisc


def ratio_ring_fixed(lobe_count: int) -> int:
    """Signed speed ratio, input over output, with the ring held and the carrier as output.

    The paper prints Z_R = -Z_np/(Z_np - Z_nt) = -Z_nt; with 11 ring teeth and 10 lobes its middle
    term is -11 and its right term -10. The right term is the correct one.

    Examples
    --------
    >>> ratio_ring_fixed(10)
    -10
    """
    return -lobe_count


def ratio_carrier_fixed(lobe_count: int) -> int:
    """Signed speed ratio, input over output, with the carrier held and the ring as output.

    Examples
    --------
    >>> ratio_carrier_fixed(10)
    11
    """
    return lobe_count + 1


def crank_phases(disc_count: int) -> FloatArray:
    """Crank phase 2 pi d/D of every disc d of a stack, shape (D,), rad."""
    return 2.0 * np.pi * np.arange(disc_count) / disc_count


def carrier_angle(lobe_count: int, crank_angle: ArrayLike) -> FloatArray:
    """Angle -phi/n of the carrier for an ideal gearbox with the ring fixed, rad."""
    return -np.asarray(crank_angle, dtype=float) / lobe_count


def output_pin_angles(
    lobe_count: int, pin_count: int, hole_clocking: ArrayLike, crank_angle: ArrayLike
) -> FloatArray:
    """Angles -phi/n + clocking + 2 pi j/N_w of the output pins in the ring's frame, rad.

    Parameters
    ----------
    lobe_count, pin_count : int
        n and N_w.
    hole_clocking : array_like (...)
        rad.
    crank_angle : array_like (A,)
        phi, rad.

    Returns
    -------
    array (..., A, N_w)
    """
    clocking = np.asarray(hole_clocking, dtype=float)[..., None, None]
    carrier = carrier_angle(lobe_count, crank_angle)[:, None]
    return np.asarray(carrier + clocking + 2.0 * np.pi * np.arange(pin_count) / pin_count)


def turned_with_carrier(lobe_count: int, crank_angle: ArrayLike, vectors: FloatArray) -> FloatArray:
    """Vectors of the carrier's (or a disc's) frame in the ring's frame, by the carrier's angle.

    Parameters
    ----------
    lobe_count : int
        n.
    crank_angle : array_like (A,)
        phi, rad.
    vectors : array (..., 2)
        In the frame that turns by -phi/n.

    Returns
    -------
    array (A, ..., 2)
    """
    extra = (None,) * (vectors.ndim - 1)
    back = carrier_angle(lobe_count, crank_angle)
    cosine, sine = np.cos(back)[:, *extra], np.sin(back)[:, *extra]
    x, y = vectors[..., 0], vectors[..., 1]
    return np.stack([cosine * x - sine * y, sine * x + cosine * y], axis=-1)


def crank_direction(crank_angle: ArrayLike, crank_phase: ArrayLike = 0.0) -> FloatArray:
    """Unit vector u = (cos, sin)(phi + p) from the ring's centre to a disc's, (..., 2)."""
    turned = np.asarray(crank_angle, dtype=float) + np.asarray(crank_phase, dtype=float)
    return np.stack([np.cos(turned), np.sin(turned)], axis=-1)


def crank_meets_carrier(lobe_count: int, place: float) -> float:
    """Crank angle at which the crank points to a place on the carrier, rad.

    `place` is the angle of the place at crank angle 0; the carrier turns back while the crank
    comes: phi = place - phi/n.
    """
    return place / (1.0 + 1.0 / lobe_count)


def disc_centre(
    eccentricity: ArrayLike, crank_angle: ArrayLike, crank_phase: ArrayLike = 0.0
) -> FloatArray:
    """Centre of a disc in the ring's frame.

    Parameters
    ----------
    eccentricity : array_like
        e in m.
    crank_angle, crank_phase : array_like
        phi and the disc's phase p in rad; all three broadcast.

    Returns
    -------
    array (..., 2)
        e (cos(phi + p), sin(phi + p)) in m.
    """
    e = np.asarray(eccentricity, dtype=float)[..., None]
    return np.asarray(e * crank_direction(crank_angle, crank_phase))


def lobe_pattern_rotation(
    lobe_count: int, crank_angle: ArrayLike, crank_phase: ArrayLike = 0.0
) -> FloatArray:
    """Rotation -(phi + p)/n of a disc's lobe pattern, rad.

    The holes of the same disc follow the carrier, so they stand p/n further round against the
    lobes than those of the disc at phase 0 (:func:`hole_clocking_in_disc`).
    """
    turned = np.asarray(crank_angle, dtype=float) + np.asarray(crank_phase, dtype=float)
    return np.asarray(-turned / lobe_count, dtype=float)


def disc_pose(disc: CycloidDisc, crank_angle: ArrayLike) -> tuple[ComplexArray, ComplexArray]:
    """Pose of the disc in the ring's frame as complex numbers (turn, shift).

    A point d of the disc stands at ``turn * d + shift`` with turn = exp(-i phi/n) and
    shift = e exp(i phi). For the disc at crank phase p, pass phi + p.

    Parameters
    ----------
    crank_angle : array_like (...)
        phi, rad.
    """
    phi = np.asarray(crank_angle, dtype=float)
    turn = np.asarray(np.exp(-1j * phi / disc.lobe_count))
    return turn, np.asarray(disc.eccentricity * np.exp(1j * phi))


def hole_clocking_in_disc(
    lobe_count: int, hole_clocking: ArrayLike, crank_phase: ArrayLike
) -> FloatArray:
    """Angle of the first hole from a valley in the lobe frame of the disc at phase p, rad.

    A disc at phase p therefore behaves as the disc at phase 0 of a stack clocked p/n further.
    """
    clocking = np.asarray(hole_clocking, dtype=float)
    return np.asarray(clocking + np.asarray(crank_phase, dtype=float) / lobe_count, dtype=float)


def pitch_point(
    lobe_count: int,
    eccentricity: ArrayLike,
    crank_angle: ArrayLike,
    crank_phase: ArrayLike = 0.0,
) -> FloatArray:
    """Instantaneous centre of a disc on the fixed ring: (n + 1) e along the disc's crank.

    Returns
    -------
    array (..., 2)
        In m. The normal at every ring tooth passes through this point.
    """
    return (lobe_count + 1) * disc_centre(eccentricity, crank_angle, crank_phase)


def ring_period(lobe_count: int) -> float:
    """Crank angle after which the ring-stage forces repeat, up to renumbering teeth: 2 pi/(n+1).

    Examples
    --------
    >>> round(math.degrees(ring_period(11)), 9)
    30.0
    """
    return 2.0 * math.pi / (lobe_count + 1)


def output_period(lobe_count: int, pin_count: int) -> float:
    """Crank angle after which the output-pin forces repeat: 2 pi n/(N_w (n+1)).

    The pins turn backwards with the carrier, so the crank meets the next pin after less than
    2 pi/N_w.
    """
    return 2.0 * math.pi * lobe_count / (pin_count * (lobe_count + 1))


def mesh_period(lobe_count: int, pin_count: int) -> float:
    """Crank angle after which both stages repeat together: 2 pi n/((n+1) gcd(n, N_w)).

    Examples
    --------
    >>> round(math.degrees(mesh_period(10, 5)), 6)
    65.454545
    """
    shared = math.gcd(lobe_count, pin_count)
    return 2.0 * math.pi * lobe_count / ((lobe_count + 1) * shared)


def imperfect_period(lobe_count: int) -> float:
    """Crank angle after which a gearbox with part errors repeats: one output turn, 2 pi n."""
    return 2.0 * math.pi * lobe_count


def cam_bearing_speed_ring_fixed(lobe_count: int, input_speed: ArrayLike) -> FloatArray:
    """Speed of the crank relative to the disc with the ring fixed: (1 + 1/n) of the input.

    The disc turns backwards at 1/n of the input, so the bearing between them turns faster than
    the input.
    """
    return np.asarray(input_speed, dtype=float) * (1.0 + 1.0 / lobe_count)
