"""Plain numpy equilibrium of the contacts with Coulomb friction at ring teeth and output pins.

Every contact slides all the time while the crank turns, in a direction that the kinematics alone
gives, so that its friction is a known share m of its normal force, along the normal turned a
quarter turn counter-clockwise: m = -mu (sign of the slip along that tangent) (sense of the crank).
A contact then pushes along a line that differs from the one it closes along; the matrix of Newton's
method is not symmetric and no energy exists. The coefficient of friction is raised from zero, where
the minimum of the energy is known, in steps that halve where the method fails. Dense matrices, one
crank angle at a time; slow, and meant to be.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from contact_plain import law_force
from numpy.typing import NDArray

from cqdd_design.gearbox.contact.kernel_values import Toleranced
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.states import NominalStates
from cqdd_design.gearbox.contact.tables import nearest_parameter
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.contours import as_complex, as_points
from cqdd_design.geometry.meshing import tooth_centres

FloatArray = NDArray[np.float64]

DRIVE, BACKDRIVE = 1.0, -1.0
"""Sense of the power: from the crank to the carrier, and back."""

_LEAST_RISE = 2.0**-9
"""Share of the coefficient of friction below which no further rise is tried."""


@dataclass(frozen=True, eq=False)
class Rubbing:
    """Where friction acts at one crank angle; C = teeth + pins.

    Attributes
    ----------
    slip : array (D, C)
        Velocity of the disc against its partner along the tangent (-n_y, n_x), per radian of the
        crank, m/rad.
    disc_arm, carrier_arm : array (D, C)
        Moment of a unit tangential force about the disc's nominal centre and about the ring's, m.
    """

    slip: FloatArray
    disc_arm: FloatArray
    carrier_arm: FloatArray


def rubbing(model: ContactModel, states: NominalStates, a: int) -> Rubbing:
    """Slip and levers of every contact at the nominal pose of one crank angle.

    A disc turns by -1/n about its pitch point P, so that at c it slides by -(c - P).n/n on the
    ring; against the carrier all of its points move by e (1 + 1/n) across the crank.
    """
    n, teeth = model.lobe_count, model.tooth_count
    normal = states.rows[a, :, :, :2]
    own = states.crank_angle[a] + model.phases
    crank = np.stack([np.cos(own), np.sin(own)], axis=-1)[:, None, :]
    centre = model.eccentricity * crank
    pins = states.pin_angle[a]
    at = model.pin_circle_radius * np.stack([np.cos(pins), np.sin(pins)], axis=-1)
    point = np.concatenate(
        [states.ring.point[a], at + model.pin_contact_radius * normal[:, teeth:]], axis=1
    )
    slip = -np.sum((point - (n + 1) * centre) * normal, axis=-1) / n
    across = model.eccentricity * (1.0 + 1.0 / n) * np.stack([-crank[..., 1], crank[..., 0]], -1)
    tangent = np.stack([-normal[..., 1], normal[..., 0]], axis=-1)
    slip[:, teeth:] = np.sum(across * tangent[:, teeth:], axis=-1)
    return Rubbing(
        slip=slip,
        # r x (i n) = r.n: the arm of a force along the tangent is the projection on the normal.
        disc_arm=np.sum((point - centre) * normal, axis=-1),
        carrier_arm=np.sum(point * normal, axis=-1),
    )


@dataclass(frozen=True, eq=False)
class PlainFriction:
    """Equilibrium with friction at one angle.

    Attributes
    ----------
    state : array (3 + 3 D,)
        As :attr:`.contact_plain.PlainState.state`.
    force, tangential : array (D, C)
        Normal force, and force on the disc along (-n_y, n_x), N.
    cam_force : array (D, 2)
        On the disc, N.
    friction_work : float
        sum |tau slip|, N m per radian of the crank.
    input_torque : float
        On the crank, counter-clockwise, that holds the cam forces at the nominal centres, N m.
    reached : float
        Share of the coefficients of friction at which this state is; below 1 there is no
        equilibrium with more of it, and the machine jams.
    """

    state: FloatArray
    force: FloatArray
    tangential: FloatArray
    cam_force: FloatArray
    friction_work: float
    input_torque: float
    reached: float


class _Balance:
    """Residual and Jacobian of one crank angle over the state, for signed coefficients `m`."""

    def __init__(
        self,
        model: ContactModel,
        states: NominalStates,
        changed: Toleranced,
        a: int,
        torque: float,
    ) -> None:
        self.model = model
        self.gaps, self.coefficient = changed.gaps[a].copy(), states.coefficient[a]
        self.offset, self.half_play = changed.offset[a], changed.half_play
        self.rub = rubbing(model, states, a)
        self.pull = torque / states.length
        self.bed = model.carrier_stiffness or 0.0
        rows, teeth = states.rows[a], model.tooth_count
        discs, contacts = self.gaps.shape
        size = 3 + 3 * discs
        self.free = np.ones(size, dtype=bool)
        self.free[:2] = bool(self.bed)
        self.closing = np.zeros((discs, contacts, size))
        self.tangent = np.zeros((discs, contacts, size))
        """Generalised force of a unit tangential force on the disc, and of its reaction."""
        for d in range(discs):
            at = slice(3 + 3 * d, 6 + 3 * d)
            along = np.stack([-rows[d, :, 1], rows[d, :, 0]], axis=-1)
            self.closing[d, :, at] = -rows[d]
            self.closing[d, teeth:, :3] = rows[d, teeth:]
            self.tangent[d, :, at] = np.column_stack([along, self.rub.disc_arm[d] / states.length])
            self.tangent[d, teeth:, :3] = -np.column_stack(
                [along[teeth:], self.rub.carrier_arm[d, teeth:] / states.length]
            )

    def at(
        self, q: FloatArray, m: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Residual (N), Jacobian (N/m), normal forces and cam forces."""
        model, teeth = self.model, self.model.tooth_count
        delta = self.closing @ q - self.gaps
        force, stiff = np.zeros_like(delta), np.zeros_like(delta)
        none = np.zeros((len(delta), 1))
        for law, part, series in (
            (model.ring_law, slice(None, teeth), none),
            (model.pin_law, slice(teeth, None), model.pin_series[:, None]),
        ):
            force[:, part], stiff[:, part] = law_force(
                law, self.coefficient[:, part], series, delta[:, part]
            )
        # What resists a displacement: the normal force along the closing, less friction's push.
        pushed = self.closing - m[..., None] * self.tangent
        residual = np.einsum("dk,dks->s", force, pushed)
        jacobian = np.einsum("dks,dk,dkr->sr", pushed, stiff, self.closing)
        residual[:2] += self.bed * q[:2]
        jacobian[[0, 1], [0, 1]] += self.bed
        residual[2] -= self.pull
        cam_force = np.zeros((len(delta), 2))
        for d in range(len(delta)):
            at = slice(3 + 3 * d, 5 + 3 * d)
            away = q[at] - self.offset[d]
            rho = float(np.hypot(*away))
            over = rho - self.half_play[d]
            if over <= 0.0:
                continue
            k, p = model.cam.stiffness, model.cam.exponent
            load, slope = k * over**p, p * k * over ** (p - 1.0)
            unit = away / rho
            cam_force[d] = -load * unit
            residual[at] += load * unit
            along = np.outer(unit, unit)
            jacobian[at, at] += slope * along + load / rho * (np.eye(2) - along)
        return residual, jacobian, force, cam_force

    def solved(self, start: FloatArray, m: FloatArray) -> FloatArray | None:
        """The balanced state next to `start`, or None; Newton's method that halves its steps."""
        q, free = start.copy(), self.free
        residual, jacobian, force, _ = self.at(q, m)
        for _ in range(60):
            scale = max(abs(self.pull), float(force.max(initial=0.0)))
            size = float(np.abs(residual[free]).max())
            if size <= 1e-12 * scale:
                return q
            ridge = 1e-13 * float(np.abs(np.diag(jacobian)).max())
            damped = jacobian[np.ix_(free, free)] + ridge * np.eye(int(free.sum()))
            step = np.zeros_like(q)
            step[free] = np.linalg.solve(damped, -residual[free])
            share = min(1.0, 1e-4 / float(np.abs(step).max()))
            for _ in range(12):
                trial = self.at(q + share * step, m)
                if float(np.abs(trial[0][free]).max()) < size:
                    break
                share *= 0.5
            else:
                # Rounding of the closings is all that is left.
                return q if size <= 1e-10 * scale else None
            q = q + share * step
            residual, jacobian, force, _ = trial
        return None


class _Following(_Balance):
    """The same with points, normals and arms of the bodies where they are, not where they should.

    Linear about the state `q`: closings, and what they push along, are exact there. The cam's
    force goes through the displaced centre, about which the moments of a disc are taken.
    """

    def __init__(
        self,
        model: ContactModel,
        states: NominalStates,
        changed: Toleranced,
        a: int,
        torque: float,
        q: FloatArray,
    ) -> None:
        super().__init__(model, states, changed, a, torque)
        n, teeth, length, disc = model.lobe_count, model.tooth_count, states.length, model.disc
        own = states.crank_angle[a] + model.phases
        turn, shift = kinematics.disc_pose(disc, own)
        tooth = as_complex(tooth_centres(disc))
        pins = model.pin_circle_radius * np.exp(1j * states.pin_angle[a])
        carried = complex(q[0], q[1]) + pins * np.exp(1j * q[2] / length)
        changes = changed.gaps[a] - states.gaps[a]
        for d in range(len(self.gaps)):
            x, y, swing = q[3 + 3 * d : 6 + 3 * d]
            centre = shift[d] + complex(x, y)
            tilt = np.exp(1j * swing / length)
            seen = (tooth - centre) / (turn[d] * tilt)
            t = nearest_parameter(disc, as_points(seen), states.ring.parameter[a, d])
            foot, outward = disc.profile(t)
            hole = centre + pins * tilt
            apart = carried - hole
            normal = np.concatenate([-outward * turn[d] * tilt, apart / np.abs(apart)])
            point = np.concatenate(
                [
                    foot * turn[d] * tilt + centre,
                    carried + model.pin_contact_radius * normal[teeth:],
                ]
            )
            gap = np.concatenate(
                [
                    ((seen - foot) * np.conj(outward)).real - disc.tooth_radius + model.roller_play,
                    model.hole_radius
                    + model.sleeve_play
                    - model.pin_contact_radius
                    - np.abs(apart),
                ]
            )
            tangent = 1j * normal
            about = point - centre
            at = slice(3 + 3 * d, 6 + 3 * d)
            for rows, way, sign in ((self.closing, normal, -1.0), (self.tangent, tangent, 1.0)):
                arm = (np.conj(about) * way).imag / length
                rows[d, :, at] = sign * np.column_stack([way.real, way.imag, arm])
                held = (np.conj(point - complex(q[0], q[1])) * way).imag / length
                rows[d, teeth:, :3] = -sign * np.column_stack([way.real, way.imag, held])[teeth:]
            self.gaps[d] = gap + changes[d] + self.closing[d] @ q
            # Slip of the points where they are, as the nominal motion carries them.
            pitch = centre + n * shift[d]
            moved = np.concatenate(
                [
                    -1j / n * (point[:teeth] - pitch),
                    1j * (1.0 + 1.0 / n) * np.full(len(pins), shift[d]),
                ]
            )
            self.rub.slip[d] = (moved * np.conj(tangent)).real


def solve_following(
    model: ContactModel,
    states: NominalStates,
    changed: Toleranced,
    a: int,
    torque: float,
    coefficients: tuple[float, float],
    sense: float,
    start: FloatArray,
) -> PlainFriction:
    """As :func:`solve_friction_plain`, with normals that follow the bodies.

    `start` is the state with nominal normals, with friction or without it.
    """
    q = start
    for _ in range(20):
        balance = _Following(model, states, changed, a, torque, q)
        m = _shares(model, balance.rub, torque, coefficients, sense)
        found = balance.solved(q, m)
        if found is None:
            raise AssertionError("no equilibrium with normals that follow the bodies")
        change = float(np.abs(found - q).max())
        q = found
        if change < 1e-13:
            break
    else:
        raise AssertionError("normals and bodies do not settle")
    return _result(model, states, a, balance, q, m, 1.0)


def solve_friction_plain(
    model: ContactModel,
    states: NominalStates,
    changed: Toleranced,
    a: int,
    torque: float,
    coefficients: tuple[float, float],
    sense: float,
    start: FloatArray,
) -> PlainFriction:
    """Find the equilibrium with friction at one crank angle.

    Parameters
    ----------
    states, changed
        From `nominal_states` and `error_states`; `a` is the index of the angle.
    torque : float
        On the carrier, N m.
    coefficients : pair of float
        mu at ring teeth and at output pins.
    sense : float
        :data:`DRIVE` or :data:`BACKDRIVE`. A driven carrier turns against its torque, and it
        turns against the crank: the crank of a drive turns with the torque on the carrier.
    start : array (3 + 3 D,)
        The frictionless equilibrium.
    """
    balance = _Balance(model, states, changed, a, torque)
    full = _shares(model, balance.rub, torque, coefficients, sense)
    reached, rise = 0.0, 1.0
    begun = balance.solved(start, 0.0 * full)
    if begun is None:
        raise AssertionError("the start is not the frictionless equilibrium")
    q, before = begun, (0.0, begun)
    while reached < 1.0 and rise > _LEAST_RISE:
        share = min(reached + rise, 1.0)
        known = reached - before[0]
        guess = q + (q - before[1]) * ((share - reached) / known) if known > 0.0 else q
        found = balance.solved(guess, share * full)
        if found is None and known > 0.0:
            found = balance.solved(q, share * full)
        if found is None:
            rise *= 0.5
            continue
        before, q, reached = (reached, q), found, share
    return _result(model, states, a, balance, q, reached * full, reached)


def _shares(
    model: ContactModel,
    rub: Rubbing,
    torque: float,
    coefficients: tuple[float, float],
    sense: float,
) -> FloatArray:
    """Signed friction over normal force of every contact, (D, C)."""
    turning = sense * (1.0 if torque >= 0.0 else -1.0)
    mu = np.where(np.arange(rub.slip.shape[1]) < model.tooth_count, *coefficients)
    return np.asarray(-np.sign(rub.slip) * turning * mu)


def _result(
    model: ContactModel,
    states: NominalStates,
    a: int,
    balance: _Balance,
    q: FloatArray,
    m: FloatArray,
    reached: float,
) -> PlainFriction:
    _, _, force, cam_force = balance.at(q, m)
    tangential = m * force
    centre = kinematics.disc_centre(model.eccentricity, states.crank_angle[a], model.phases)
    moment = centre[:, 0] * cam_force[:, 1] - centre[:, 1] * cam_force[:, 0]
    return PlainFriction(
        state=q,
        force=force,
        tangential=tangential,
        cam_force=cam_force,
        friction_work=float(np.abs(tangential * balance.rub.slip).sum()),
        input_torque=float(moment.sum()),
        reached=reached,
    )
