"""Plain numpy twin of the compiled contact equilibrium and of its force laws.

It solves the same equations with dense matrices, whole arrays of contacts at once, and a plain
halving line search on the energy; slow, and meant to be.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cqdd_design.errors import ContactError
from cqdd_design.gearbox.contact import laws
from cqdd_design.gearbox.contact.laws import LineLaw
from cqdd_design.gearbox.contact.model import ContactModel

FloatArray = NDArray[np.float64]


def law_force(
    law: LineLaw, coefficient: ArrayLike, series: ArrayLike, closed: ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Force and stiffness of contacts pressed together by `closed`: plain twin of
    the compiled one.

    Parameters
    ----------
    law, coefficient, series
        As in :func:`laws.approach`; they broadcast with `closed`.
    closed : array_like
        Approach, m; at or below zero the contact is open and carries nothing.

    Returns
    -------
    force, stiffness : array
        N and N/m.
    """
    delta, c, s = np.broadcast_arrays(
        np.asarray(closed, dtype=float),
        np.asarray(coefficient, dtype=float),
        np.asarray(series, dtype=float),
    )
    touching = delta > 0.0
    safe = np.where(touching, delta, 1.0)
    if law.model == "linear":
        load, slope = safe / (c + s), c + s
    elif law.model == "palmgren":
        # In u = F^0.1 the law is a polynomial, c u^9 + s u^10: convex, so Newton's method from
        # the upper bound never overshoots.
        with np.errstate(divide="ignore", over="ignore"):
            u = np.minimum((safe / c) ** (1.0 / 9.0), np.where(s > 0.0, safe / s, np.inf) ** 0.1)
        for _ in range(60):
            residual = u**9 * (c + s * u) - safe
            step = residual / (u**8 * (9.0 * c + 10.0 * s * u))
            u = u - step
            if np.all(np.abs(step) <= 1e-16 * u):
                break
        load = u**10
        slope = 0.9 * c / u + s
    else:
        limit = laws.force_limit(law, c)
        edge = limit * (c + s - law.logarithm * np.log(limit))
        steepest = c + s - law.logarithm * (np.log(limit) + 1.0)
        load = np.minimum(safe / (c + s), limit)
        for _ in range(100):
            slope = c + s - law.logarithm * (np.log(load) + 1.0)
            off = load * (c + s - law.logarithm * np.log(load)) - np.minimum(safe, edge)
            new = np.clip(load - off / slope, 0.1 * load, limit)
            done = np.all(np.abs(new - load) <= 1e-16 * load)
            load = new
            if done:
                break
        beyond = safe > edge
        slope = np.where(beyond, steepest, c + s - law.logarithm * (np.log(load) + 1.0))
        load = np.where(beyond, limit + (safe - edge) / steepest, load)
    return np.where(touching, load, 0.0), np.where(touching, 1.0 / slope, 0.0)


@dataclass(frozen=True, eq=False)
class PlainState:
    """Equilibrium at one angle.

    Attributes
    ----------
    state : array (3 + 3 D,)
        Carrier X, Y, gamma and every disc's x, y, theta, angles times the pin circle, m.
    force : array (D, C)
        N.
    cam_force : array (D, 2)
        N.
    energy : float
        E - T gamma, J.
    """

    state: FloatArray
    force: FloatArray
    cam_force: FloatArray
    energy: float


def solve_plain(
    model: ContactModel,
    rows: FloatArray,
    gaps: FloatArray,
    coefficient: FloatArray,
    offset: FloatArray,
    half_play: FloatArray,
    torque: float,
) -> PlainState:
    """Find the equilibrium of one state; arguments as in `equilibrium_kernel.solve_state`.

    Raises
    ------
    ContactError
        When it is not found in 500 steps.
    """
    discs, contacts = gaps.shape
    teeth, size = model.tooth_count, 3 + 3 * discs
    pull = torque / model.pin_circle_radius
    bed = model.carrier_stiffness or 0.0
    free = np.ones(size, dtype=bool)
    if not bed:
        free[:2] = False
    # Column by column: closing of every contact per unit of every coordinate.
    closing = np.zeros((discs, contacts, size))
    for d in range(discs):
        closing[d, :, 3 + 3 * d : 6 + 3 * d] = -rows[d]
        closing[d, teeth:, :3] = rows[d, teeth:]
    parts = (
        (model.ring_law, slice(None, teeth), np.zeros((discs, 1))),
        (model.pin_law, slice(teeth, None), model.pin_series[:, None]),
    )

    def evaluate(q: FloatArray) -> tuple[float, FloatArray, FloatArray, FloatArray, FloatArray]:
        delta = closing @ q - gaps
        force, stiff = np.zeros_like(delta), np.zeros_like(delta)
        energy = -pull * q[2] + 0.5 * bed * float(q[:2] @ q[:2])
        for law, part, series in parts:
            c = coefficient[:, part]
            force[:, part], stiff[:, part] = law_force(law, c, series, delta[:, part])
            energy += float(laws.stored_energy(law, c, series, force[:, part]).sum())
        gradient = np.einsum("dk,dks->s", force, closing)
        gradient[:2] += bed * q[:2]
        gradient[2] -= pull
        hessian = np.einsum("dks,dk,dkr->sr", closing, stiff, closing)
        hessian[[0, 1], [0, 1]] += bed
        cam_force = np.zeros((discs, 2))
        for d in range(discs):
            away = q[3 + 3 * d : 5 + 3 * d] - offset[d]
            rho = float(np.hypot(*away))
            over = rho - half_play[d]
            if over <= 0.0:
                continue
            k, p = model.cam.stiffness, model.cam.exponent
            load, slope = k * over**p, p * k * over ** (p - 1.0)
            unit = away / rho
            energy += load * over / (p + 1.0)
            cam_force[d] = -load * unit
            at = slice(3 + 3 * d, 5 + 3 * d)
            gradient[at] += load * unit
            along = np.outer(unit, unit)
            hessian[at, at] += slope * along + load / rho * (np.eye(2) - along)
        return energy, gradient, hessian, force, cam_force

    q = np.zeros(size)
    energy, gradient, hessian, force, cam_force = evaluate(q)
    for _ in range(500):
        scale = max(abs(pull), float(force.max(initial=0.0)))
        if np.abs(gradient[free]).max() <= 1e-12 * scale:
            break
        ridge = 1e-9 * max(float(np.trace(hessian)), 1.0)
        step = np.zeros(size)
        damped = hessian + ridge * np.eye(size)
        step[free] = np.linalg.solve(damped[np.ix_(free, free)], -gradient[free])
        share = min(1.0, 1e-3 / float(np.abs(step).max()))
        for _ in range(60):
            trial = evaluate(q + share * step)
            if trial[0] <= energy or abs(trial[1] @ step) <= 0.5 * abs(gradient @ step):
                break
            share *= 0.5
        else:
            break
        q = q + share * step
        energy, gradient, hessian, force, cam_force = trial
    scale = max(abs(pull), float(force.max(initial=0.0)))
    if np.abs(gradient[free]).max() > 1e-8 * scale:
        raise ContactError(f"no equilibrium at {torque:g} N*m in 500 plain steps; lower it.")
    return PlainState(q, force, cam_force, energy)
