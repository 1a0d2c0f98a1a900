"""Where every contact stands at the nominal pose, over crank angle, with its rates of change.

The equilibrium is linearised at one state, the nominal pose at each crank angle. A contact is a
row (n_x, n_y, h): its unit force on the disc and that force's arm. With a disc displaced by
(x, y, theta) against what it touches, the contact closes by -(n_x x + n_y y + h theta) - gap.
Rates over crank angle are exact derivatives at a fixed displacement, found from the velocity of
the disc against the tooth; they give the torque ripple by the envelope theorem.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.geometry.contours import FloatArray, as_complex, as_points
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.kinematics import carrier_angle, disc_pose
from cqdd_design.geometry.meshing import project, tooth_centres


@dataclass(frozen=True, eq=False)
class RingTable:
    """Ring contacts at A crank angles on D discs with T teeth.

    Attributes
    ----------
    rows : array (A, D, T, 3)
        n_x, n_y, h: unit force on the disc, and its arm about the disc's nominal centre, m.
    gap : array (A, D, T)
        m; negative is interference.
    rates : array (A, D, T, 3)
        Derivatives over crank angle of the normal's angle (1), of h (m) and of the gap (m).
    parameter, parameter_rate : array (A, D, T)
        Place on the disc's profile (rad) and its derivative.
    point : array (A, D, T, 2)
        On the disc's flank, in the ring's frame, m.
    equivalent_radius, radius_rate : array (A, D, T)
        R_eq of tooth and flank (m), and the derivative of its logarithm (1).
    centre_curvature : array (A, D, T)
        Curvature at the tooth's centre of the curve parallel to the flank through it, 1/m.
    """

    rows: FloatArray
    gap: FloatArray
    rates: FloatArray
    parameter: FloatArray
    parameter_rate: FloatArray
    point: FloatArray
    equivalent_radius: FloatArray
    radius_rate: FloatArray
    centre_curvature: FloatArray


def nearest_parameter(disc: CycloidDisc, centres: FloatArray, guess: FloatArray) -> FloatArray:
    """Parameter of the flank point nearest to each tooth centre, given a close guess.

    The generated flank is parallel to its locus, so the foot on the locus is the foot on the
    flank; Newton's method from the conjugate parameter squares its error each time. Turned flanks
    are piecewise and go through the bracketed search instead.
    """
    if disc.is_turned:
        return project(disc, centres).parameter
    flank = disc.generated
    wanted = as_complex(centres)
    t = guess.copy()
    for _ in range(20):
        normal = flank.normal(t)
        apart = (wanted - flank.locus(t)) * np.conj(normal)
        # Along the counter-clockwise tangent i n, and out of the locus.
        nearness = 1.0 + flank.locus_bend(t) * apart.real
        if np.any(nearness <= 0.0):
            break
        step = apart.imag / (flank.locus_speed(t) * nearness)
        t = t + step
        if np.abs(step).max(initial=0.0) < 1e-14:
            return np.asarray(t)
    # Not converged, or beyond a centre of curvature, where the foot is not the nearest point.
    return project(disc, centres).parameter


def _bend_slope(disc: CycloidDisc, t: FloatArray) -> FloatArray:
    """Derivative of the flank's curvature over its parameter, by central differences."""
    step = 1e-4 * disc.half_pitch
    return np.asarray((disc.rates(t + step)[1] - disc.rates(t - step)[1]) / (2.0 * step))


def ring_table(
    model: ContactModel, crank_angle: FloatArray, turned: FloatArray | None = None
) -> RingTable:
    """Ring contacts of every disc at the nominal pose, or turned from it about its centre.

    Parameters
    ----------
    crank_angle : array (A,)
        rad.
    turned : array (A, D), optional
        rad, counter-clockwise; default the nominal pose.
    """
    disc, n = model.disc, model.lobe_count
    own = crank_angle[:, None] + model.phases
    turn, shift = disc_pose(disc, own)
    if turned is not None:
        turn = turn * np.exp(1j * turned)
    turn, shift = turn[..., None], shift[..., None]
    tooth = as_complex(tooth_centres(disc))
    seen = (tooth - shift) / turn
    teeth = 2.0 * np.pi * np.arange(n + 1) / (n + 1)
    t = nearest_parameter(disc, as_points(seen), teeth + own[..., None] / n)
    foot, outward = disc.profile(t)
    distance = ((seen - foot) * np.conj(outward)).real
    speed, bend = disc.rates(t)
    # The tooth centre's velocity in the disc's frame: the ring turns by +1/n against the disc,
    # whose centre goes round at e i exp(i phi).
    drift = (1j / n) * seen - 1j * shift / turn
    along = (drift * np.conj(outward)).imag / (1.0 + bend * distance)
    normal = -outward * turn
    arm_vector = tooth - shift
    spin = -1.0 / n + bend * along
    moved = -1j * shift
    arm = (np.conj(arm_vector) * normal).imag
    arm_rate = (np.conj(moved) * normal).imag + (np.conj(arm_vector) * 1j * normal).imag * spin
    radius = 1.0 / (1.0 / disc.tooth_radius + bend)
    return RingTable(
        rows=np.stack([normal.real, normal.imag, arm], axis=-1),
        gap=distance - disc.tooth_radius + model.roller_play,
        rates=np.stack([spin, arm_rate, (drift * np.conj(outward)).real], axis=-1),
        parameter=np.asarray(np.mod(t, 2.0 * np.pi)),
        parameter_rate=along / speed,
        point=as_points(foot * turn + shift),
        equivalent_radius=radius,
        radius_rate=-radius * _bend_slope(disc, t) * along / speed,
        centre_curvature=bend / (1.0 + bend * distance),
    )


def pin_table(
    model: ContactModel, crank_angle: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Output-pin contacts of every disc at the nominal pose.

    Parameters
    ----------
    crank_angle : array (A,)
        rad.

    Returns
    -------
    rows : array (A, D, P, 3)
        n_x, n_y, h: unit force on the disc (-u, u its crank direction) and its arm, which is the
        same about the disc's centre and, for the pin, about the ring's.
    rates : array (A, D, P, 2)
        Derivatives over crank angle of the normal's angle (1) and of h (m).
    pin_angle : array (A, P)
        Angle of every pin in the ring's frame, rad.
    """
    n, count, radius = model.lobe_count, model.pin_count, model.pin_circle_radius
    own = crank_angle[:, None, None] + model.phases[:, None]
    # `kinematics.output_pin_angles`, summed in the order that these tables have always had: a
    # rounding of the angle shows in the last digit of every force.
    around = 2.0 * np.pi * np.arange(count) / count
    pins = model.hole_clocking + around + carrier_angle(n, crank_angle)[:, None]
    ahead = own - pins[:, None, :]
    cosine, sine = (np.broadcast_to(f(own), ahead.shape) for f in (np.cos, np.sin))
    arm_rate = -radius * np.cos(ahead) * (1.0 + 1.0 / n)
    rows = np.stack([-cosine, -sine, -radius * np.sin(ahead)], axis=-1)
    return rows, np.stack([np.ones_like(ahead), arm_rate], axis=-1), pins
