"""The rigid load law of both stages, for one design or for many at once.

One disc at crank phase 0 is computed. The disc at phase p of a stack is the same disc met at crank
angle phi + p with its holes clocked p/n further (:mod:`.kinematics`), so every function takes the
disc's own crank angle ``phi + p`` and its own clocking; :mod:`.loads` does that bookkeeping.

Axes: arguments that describe designs broadcast to a leading shape ``...`` (a scalar is one
design); ``crank_angle`` is one-dimensional, length A. Forces are those on the disc. A positive
torque is one with which the disc turns the carrier counter-clockwise; a negative one loads the
other flanks. (The contact equilibrium states the torque on the carrier, which is its opposite.)

Because every ring normal passes through the pitch point P = (n+1) e u, and P - C = n e u from the
disc centre C, the lever arm of tooth i is h_i = n e (u x d_i), and the tangential part of the ring
resultant is T/(n e) at every angle, whatever the sharing. The output pins push along -u only. The
cam bearing therefore carries the tangential T/(n e) together with the radial difference of both
stages.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.geometry import kinematics
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.trochoid import locus_curvature, shortening_coefficient


def _columns(*values: ArrayLike, extra: int) -> list[FloatArray]:
    """Each value as a float array with `extra` trailing axes of length one."""
    return [np.asarray(v, dtype=float)[(...,) + (None,) * extra] for v in values]


def ring_tooth_angles(lobe_count: int) -> FloatArray:
    """Angles 2 pi i/(n+1) of the ring teeth, shape (n+1,), rad."""
    return 2.0 * np.pi * np.arange(lobe_count + 1) / (lobe_count + 1)


def ring_flank_parameters(lobe_count: int, crank_angle: ArrayLike) -> FloatArray:
    """Disc parameter phi/n + alpha_i at which each ring tooth touches, shape (A, n+1), rad."""
    angle = np.asarray(crank_angle, dtype=float)[:, None]
    return np.asarray(angle / lobe_count + ring_tooth_angles(lobe_count))


def ring_directions(
    lobe_count: int, shortening: FloatArray, crank_angle: ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Radial and tangential parts of the ring normals in the crank's frame.

    Unit vectors from tooth centre Q_i = R e^{i alpha} to P = K1 R u, seen along u and its left
    normal: (K1 - cos theta, sin theta)/D with theta = phi - alpha, D = |1 - K1 e^{i theta}|.
    `shortening` is (...); both results are (..., A, n+1).
    """
    (k1,) = _columns(shortening, extra=2)
    theta = np.asarray(crank_angle, dtype=float)[:, None] - ring_tooth_angles(lobe_count)
    cosine = np.cos(theta)
    distance = np.sqrt(1.0 + k1 * k1 - 2.0 * k1 * cosine)
    return (k1 - cosine) / distance, np.sin(theta) / distance


def _shared(torque: FloatArray, arms: FloatArray) -> FloatArray:
    """Share a torque (..., 1, 1): T h/sum(h^2) over the loaded side, h of the torque's sign."""
    loaded = np.maximum(arms * np.where(torque < 0.0, -1.0, 1.0), 0.0)
    result: FloatArray = np.abs(torque) * loaded / np.sum(loaded * loaded, axis=-1, keepdims=True)
    return result


def ring_forces(
    lobe_count: int,
    ring_pitch_radius: ArrayLike,
    eccentricity: ArrayLike,
    disc_torque: ArrayLike,
    crank_angle: ArrayLike,
) -> FloatArray:
    """Return the forces of the ring teeth on one disc by the rigid law F_i = T h_i/sum(h^2).

    The disc is taken to turn about its own centre as a rigid body against equal springs with no
    gap, so approach is proportional to the lever arm and only one side is loaded (Kudryavtsev
    1966; Yang and Blanche 1990). It is the limit for one disc without modification.

    Parameters
    ----------
    lobe_count : int
        n, at least 3.
    ring_pitch_radius, eccentricity, disc_torque : array_like (...)
        R and e in m, torque of this disc in N m; they broadcast.
    crank_angle : array_like (A,)
        Crank angle of this disc, rad.

    Returns
    -------
    array (..., A, n+1)
        Forces in N, zero on the unloaded side.

    Examples
    --------
    Release notes of cycloidgen 7.2: R 50, e 1.5, n 11, 2.5 N m on one disc.

    >>> print(round(float(ring_forces(11, 0.05, 0.0015, 2.5, [0.0]).max()), 3))
    49.859
    """
    k1 = shortening_coefficient(lobe_count, ring_pitch_radius, eccentricity)
    e, torque = _columns(eccentricity, disc_torque, extra=2)
    _, tangential = ring_directions(lobe_count, k1, crank_angle)
    # h_i = n e sin(theta_i)/D_i; positive arms carry a positive torque.
    return _shared(torque, lobe_count * e * tangential)


def ring_contact_curvature(
    lobe_count: int, ring_pitch_radius: ArrayLike, eccentricity: ArrayLike, crank_angle: ArrayLike
) -> FloatArray:
    """Curvature of the tooth-centre locus where each ring tooth touches, (..., A, n+1), 1/m.

    Tooth i touches at the disc parameter phi/n + alpha_i. Convex positive; goes into
    :func:`.hertz.ring_equivalent_radius`.
    """
    radius, e = _columns(ring_pitch_radius, eccentricity, extra=2)
    parameter = ring_flank_parameters(lobe_count, crank_angle)
    return locus_curvature(lobe_count, radius, e, parameter)


def ring_radial_force(
    lobe_count: int,
    ring_pitch_radius: ArrayLike,
    eccentricity: ArrayLike,
    disc_torque: ArrayLike,
    crank_angle: ArrayLike,
) -> FloatArray:
    """Part of the ring resultant along the crank direction u, shape (..., A), N.

    The part across u is T/(n e) at every angle.
    """
    force = ring_forces(lobe_count, ring_pitch_radius, eccentricity, disc_torque, crank_angle)
    k1 = shortening_coefficient(lobe_count, ring_pitch_radius, eccentricity)
    radial, _ = ring_directions(lobe_count, k1, crank_angle)
    return np.asarray(np.sum(force * radial, axis=-1))


def output_pin_forces(
    lobe_count: int,
    pin_count: int,
    pin_circle_radius: ArrayLike,
    disc_torque: ArrayLike,
    crank_angle: ArrayLike,
    hole_clocking: ArrayLike = 0.0,
) -> FloatArray:
    """Return the forces of the output pins on one disc, shared by arms R_w sin(phi - beta_j).

    Parameters
    ----------
    lobe_count, pin_count : int
        n and N_w.
    pin_circle_radius, disc_torque, hole_clocking : array_like (...)
        R_w in m, torque of this disc in N m, clocking of this disc's holes in rad.
    crank_angle : array_like (A,)
        Crank angle of this disc, rad.

    Returns
    -------
    array (..., A, N_w)
        Forces in N, all along -u. The peak over a period is 4 T/(N_w R_w) for even N_w.
    """
    radius, torque = _columns(pin_circle_radius, disc_torque, extra=2)
    pins = kinematics.output_pin_angles(lobe_count, pin_count, hole_clocking, crank_angle)
    angle = np.asarray(crank_angle, dtype=float)[:, None]
    return _shared(torque, radius * np.sin(angle - pins))


def peak_pin_force_factor(pin_count: int) -> float:
    """Peak of F R_w N_w/T over a period for the rigid law: 4 for even N_w.

    For even N_w the loaded half has sum(sin^2) = N_w/4 at every angle, and the peak is at
    sin = 1. For odd N_w the loaded side gains and loses a pin: the peak is a little above 4 for
    5, 9, 13 pins and a little below for 3, 7, 11, and is found by refining a grid.

    Examples
    --------
    >>> print(peak_pin_force_factor(6))
    4.0
    >>> print(round(peak_pin_force_factor(5), 3))
    4.198
    """
    if pin_count % 2 == 0:
        return 4.0
    low, high = 0.0, 2.0 * np.pi / pin_count
    pins = 2.0 * np.pi * np.arange(pin_count) / pin_count
    best = 0.0
    for _ in range(4):
        angle = np.linspace(low, high, 401)
        sine = np.maximum(np.sin(angle[:, None] - pins), 0.0)
        factor = pin_count * sine.max(axis=1) / np.sum(sine * sine, axis=1)
        at = int(np.argmax(factor))
        best = float(factor[at])
        low, high = float(angle[max(at - 1, 0)]), float(angle[min(at + 1, angle.size - 1)])
    return best


def cam_load(
    lobe_count: int,
    eccentricity: ArrayLike,
    disc_torque: ArrayLike,
    ring_radial: FloatArray,
    pin_force_sum: FloatArray,
) -> FloatArray:
    """Force of the cam bearing on one disc in the crank's frame, output-pin reaction included.

    Equilibrium of the disc: cam = -(sum of ring forces + sum of pin forces).

    Parameters
    ----------
    lobe_count : int
        n.
    eccentricity, disc_torque : array_like (...)
        e in m and the disc's signed torque in N m.
    ring_radial : array (..., A)
        From :func:`ring_radial_force`, N.
    pin_force_sum : array (..., A)
        Sum of :func:`output_pin_forces` over the pins, N.

    Returns
    -------
    array (..., A, 2)
        Parts along u and along the left normal of u, N; the second is -T/(n e).
    """
    e, torque = _columns(eccentricity, disc_torque, extra=1)
    along = -(ring_radial - pin_force_sum)
    across = np.broadcast_to(-torque / (lobe_count * e), along.shape)
    return np.stack([along, across], axis=-1)
