"""Plain numpy equilibrium of contacts with a plate and a cap that turn, and bodies that yield.

Unknown are the rigid motions u (carrier X and Y, turn of the plate, turn of the cap, every disc)
and the forces f >= 0 of all contacts. A contact closes by B u - gap, of which its own law takes
the approach and a matrix W what the bodies in series yield under every force:

    B u - gap = approach(f) + W f    where f > 0,    B u - gap <= W f    where f = 0.

Forces push along P, which is B without friction; P' f, with the springs of cams and carrier,
balances the load. Newton's method on (u, approach) from a known state, with a step that halves, and
with W, the cap's part and friction raised from nothing where one step does not lead to the end.
Dense matrices, one crank angle at a time; slow, and meant to be.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from contact_friction_plain import rubbing
from contact_plain import law_force
from numpy.typing import NDArray

from cqdd_design.gearbox.contact.kernel_values import Toleranced
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.pin_beam import PinBeam
from cqdd_design.gearbox.contact.states import NominalStates

FloatArray = NDArray[np.float64]

_LEAST_RISE = 2.0**-10


@dataclass(frozen=True, eq=False)
class PlainCarrier:
    """Equilibrium at one angle.

    Attributes
    ----------
    plate, cap : float
        Turns times the pin circle, m.
    carrier : array (2,)
        Its displacement, m.
    discs : array (D, 3)
        x, y, theta times the pin circle, m.
    force, tangential : array (D, C)
        N.
    cam_force : array (D, 2)
        On the disc, N.
    balance : array (4 + 3 D,)
        What is left over, N; the order is that of the motions.
    torsional : float
        Tangent dT/dgamma of the plate, N m/rad.
    reached : float
        Share of compliance and friction that was reached; below 1 there is no equilibrium.
    """

    plate: float
    cap: float
    carrier: FloatArray
    discs: FloatArray
    force: FloatArray
    tangential: FloatArray
    cam_force: FloatArray
    balance: FloatArray
    torsional: float
    reached: float


class CarrierProblem:
    """The equations of one crank angle."""

    def __init__(
        self,
        model: ContactModel,
        states: NominalStates,
        changed: Toleranced,
        a: int,
        torque: float,
        beam: PinBeam,
        *,
        friction: FloatArray | None = None,
        bodies: FloatArray | None = None,
        floating: bool = False,
    ) -> None:
        """Arguments as in `contact_sweep`, and

        beam : PinBeam
            Of every pin.
        friction : array (D, C), optional
            Signed share of the force along the normal turned counter-clockwise.
        bodies : array (D C, D C), optional
            Compliance of bodies besides the pins, m/N.
        floating : bool
            Whether the cap moves sideways too, on the pins alone; its motion follows the discs'.
        """
        self.model = model
        self.rows, self.gaps = states.rows[a], changed.gaps[a]
        self.coefficient = states.coefficient[a]
        self.offset, self.half_play = changed.offset[a], changed.half_play
        self.length = states.length
        self.pull = torque / states.length
        self.rub = rubbing(model, states, a)
        shape = self.gaps.shape
        self.friction = np.zeros(shape) if friction is None else friction
        self.bodies = np.zeros((self.gaps.size,) * 2) if bodies is None else bodies
        self.beam = beam
        self.floating = floating
        self.size = 4 + 3 * shape[0] + 2 * floating
        self.free = np.ones(self.size, dtype=bool)
        bed = model.carrier_stiffness or 0.0
        self.free[:2] = bool(bed)
        self.springs = np.zeros((self.size, self.size))
        self.springs[0, 0] = self.springs[1, 1] = bed
        # Where nothing joins plate and cap, no force reaches the cap either; any spring holds it.
        join = model.pin_count * beam.joint or 1.0
        apart = join * np.array([[1.0, -1.0], [-1.0, 1.0]])
        self.springs[2:4, 2:4] = apart
        for i in range(2 * floating):
            both = np.array([i, self.size - 2 + i])
            self.springs[np.ix_(both, both)] += apart

    def matrices(self, share: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """B and P, (D C, U), and W with `share` of what is new in them."""
        discs, contacts = self.gaps.shape
        teeth = self.model.tooth_count
        closing = np.zeros((discs, contacts, self.size))
        push = np.zeros_like(closing)
        m = share * self.friction
        for d in range(discs):
            at = slice(4 + 3 * d, 7 + 3 * d)
            n, h = self.rows[d, :, :2], self.rows[d, :, 2]
            t = np.stack([-n[:, 1], n[:, 0]], axis=-1)
            closing[d, :, at] = -self.rows[d]
            push[d, :, at] = -self.rows[d] - m[d, :, None] * np.column_stack(
                [t, self.rub.disc_arm[d] / self.length]
            )
            turned = h + m[d] * self.rub.carrier_arm[d] / self.length
            cap = share * self.beam.at_cap[d]
            pins = slice(teeth, None)
            along = (n + m[d, :, None] * t)[pins]
            closing[d, pins, :2], push[d, pins, :2] = n[pins], along
            if self.floating:
                closing[d, pins, :2], push[d, pins, :2] = (1.0 - cap) * n[pins], (1.0 - cap) * along
                closing[d, pins, -2:], push[d, pins, -2:] = cap * n[pins], cap * along
            for row, value in ((closing, h), (push, turned)):
                row[d, pins, 2] = (1.0 - cap) * value[pins]
                row[d, pins, 3] = cap * value[pins]
        return (
            closing.reshape(-1, self.size),
            push.reshape(-1, self.size),
            self.compliance(share),
        )

    def compliance(self, share: float) -> FloatArray:
        """W: the forces of all discs on a pin bend it at every disc; normals see their part."""
        discs, contacts = self.gaps.shape
        teeth = self.model.tooth_count
        w = share * self.bodies.reshape(discs, contacts, discs, contacts).copy()
        n = self.rows[..., :2]
        pushed = n + share * self.friction[..., None] * np.stack([-n[..., 1], n[..., 0]], axis=-1)
        held = np.diag(self.model.pin_series)
        influence = held + share * (self.beam.influence - held)
        for k in range(teeth, contacts):
            for d in range(discs):
                for e in range(discs):
                    w[d, k, e, k] += influence[d, e] * float(n[d, k] @ pushed[e, k])
        return w.reshape(self.gaps.size, self.gaps.size)

    def laws(self, approach: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Forces and stiffnesses of all contacts, (D C,)."""
        a = approach.reshape(self.gaps.shape)
        force, stiff = np.zeros_like(a), np.zeros_like(a)
        teeth = self.model.tooth_count
        for law, part in (
            (self.model.ring_law, slice(None, teeth)),
            (self.model.pin_law, slice(teeth, None)),
        ):
            force[:, part], stiff[:, part] = law_force(
                law, self.coefficient[:, part], 0.0, a[:, part]
            )
        return force.ravel(), stiff.ravel()

    def cams(self, u: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Forces of cams (D, 2), their residual (U,) and stiffness (U, U)."""
        discs = len(self.gaps)
        force, residual = np.zeros((discs, 2)), np.zeros(self.size)
        stiff = np.zeros((self.size, self.size))
        k, p = self.model.cam.stiffness, self.model.cam.exponent
        for d in range(discs):
            at = slice(4 + 3 * d, 6 + 3 * d)
            away = u[at] - self.offset[d]
            rho = float(np.hypot(*away))
            over = rho - self.half_play[d]
            if over <= 0.0:
                continue
            load, slope = k * over**p, p * k * over ** (p - 1.0)
            unit = away / rho
            along = np.outer(unit, unit)
            force[d] = -load * unit
            residual[at] = load * unit
            stiff[at, at] = slope * along + load / rho * (np.eye(2) - along)
        return force, residual, stiff

    def residual(
        self, u: FloatArray, approach: FloatArray, matrices: tuple[FloatArray, ...]
    ) -> tuple[FloatArray, FloatArray]:
        """What balance (N) and closings (m) lack."""
        closing, push, w = matrices
        force, _ = self.laws(approach)
        balance = push.T @ force + self.springs @ u + self.cams(u)[1]
        balance[2] -= self.pull
        balance[~self.free] = 0.0
        return balance, approach + w @ force - closing @ u + self.gaps.ravel()

    def solved(
        self, u: FloatArray, approach: FloatArray, share: float
    ) -> tuple[FloatArray, FloatArray] | None:
        """The state next to a start, or None."""
        matrices = self.matrices(share)
        closing, push, w = matrices
        free = self.free
        u, approach = u.copy(), approach.copy()
        balance, gap = self.residual(u, approach, matrices)
        for _ in range(100):
            force, stiff = self.laws(approach)
            scale = max(abs(self.pull), float(force.max()))
            soft = scale / max(float(stiff.max()), 1e-30)
            size = max(np.abs(balance).max() / scale, np.abs(gap).max() / soft)
            if size < 1e-12:
                return u, approach
            # (1 + W S) da = B du - gap, and P' S da + K du = -balance.
            inner = np.linalg.inv(np.eye(len(stiff)) + w * stiff)
            matrix = self.springs + self.cams(u)[2]
            matrix += push.T @ (stiff[:, None] * (inner @ closing))
            right = -balance + push.T @ (stiff * (inner @ gap))
            ridge = 1e-13 * np.abs(np.diag(matrix)).max() * np.eye(self.size)
            du = np.zeros(self.size)
            du[free] = np.linalg.solve((matrix + ridge)[np.ix_(free, free)], right[free])
            da = inner @ (closing @ du - gap)
            part = min(1.0, 1e-4 / float(np.abs(du).max()))
            for _ in range(30):
                trial = self.residual(u + part * du, approach + part * da, matrices)
                better = max(np.abs(trial[0]).max() / scale, np.abs(trial[1]).max() / soft)
                if better < size:
                    break
                part *= 0.5
            else:
                return (u, approach) if size < 1e-9 else None
            u, approach = u + part * du, approach + part * da
            balance, gap = trial
        return None

    def torsional(self, u: FloatArray, approach: FloatArray) -> float:
        """Torque over the plate's turn, all other motions free, N m/rad."""
        closing, push, w = self.matrices(1.0)
        _, stiff = self.laws(approach)
        inner = np.linalg.inv(np.eye(len(stiff)) + w * stiff)
        matrix = self.springs + self.cams(u)[2] + push.T @ (stiff[:, None] * (inner @ closing))
        # A disc that nothing touches stays where it is.
        matrix += 1e-13 * np.abs(np.diag(matrix)).max() * np.eye(self.size)
        unit = np.zeros(self.size)
        unit[2] = 1.0
        moved = np.zeros(self.size)
        moved[self.free] = np.linalg.solve(matrix[np.ix_(self.free, self.free)], unit[self.free])
        return float(self.length**2 / moved[2])


def solve_carrier_plain(problem: CarrierProblem, start: FloatArray) -> PlainCarrier:
    """Find the equilibrium from that of held plates without friction.

    Parameters
    ----------
    start : array (3 + 3 D,)
        As `ContactSweep.state_vectors` holds it.
    """
    u = np.concatenate([start[:3], start[2:3], start[3:], np.zeros(2 * problem.floating)])
    closing, _, w = problem.matrices(0.0)
    closed = closing @ u - problem.gaps.ravel()
    force = np.zeros_like(closed)
    teeth = problem.model.tooth_count
    series = np.zeros(problem.gaps.shape)
    series[:, teeth:] = problem.model.pin_series[:, None]
    for law, part in (
        (problem.model.ring_law, slice(None, teeth)),
        (problem.model.pin_law, slice(teeth, None)),
    ):
        shaped = force.reshape(problem.gaps.shape)
        shaped[:, part] = law_force(
            law,
            problem.coefficient[:, part],
            series[:, part],
            closed.reshape(problem.gaps.shape)[:, part],
        )[0]
    begun = problem.solved(u, closed - w @ force, 0.0)
    if begun is None:
        raise AssertionError("the start is not the equilibrium of held plates")
    reached, rise, known = 0.0, 1.0, begun
    while reached < 1.0 and rise > _LEAST_RISE:
        share = min(reached + rise, 1.0)
        found = problem.solved(*known, share)
        if found is None:
            rise *= 0.5
            continue
        known, reached = found, share
    u, approach = known
    force, _ = problem.laws(approach)
    shape = problem.gaps.shape
    return PlainCarrier(
        plate=float(u[2]),
        cap=float(u[3]),
        carrier=u[:2],
        discs=u[4 : 4 + 3 * shape[0]].reshape(-1, 3),
        force=force.reshape(shape),
        tangential=reached * problem.friction * force.reshape(shape),
        cam_force=problem.cams(u)[0],
        balance=problem.residual(u, approach, problem.matrices(reached))[0],
        torsional=problem.torsional(u, approach),
        reached=reached,
    )
