"""Contact equilibrium of a cycloid stack by plain numpy and scipy, written from the mechanics only.

Shares nothing with the package's contact engine: every spring is inverted here, the contacts are
built here from the exact profile, and scipy minimises the energy. Slow and simple on purpose.

Frame: fixed ring, crank at angle phi, disc d at crank angle phi + 2 pi d/D. Forces are on the disc.
Unknowns (x, y, theta) of every disc from its nominal pose, then the carrier's angle gamma.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy import optimize

from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.meshing import project

Law = Callable[[np.ndarray], np.ndarray]


class Spring:
    """A unilateral spring given by its approach delta(F), concave and rising in F.

    Parameters
    ----------
    approach, slope, stored : callable
        delta(F), its derivative, and its integral from 0 to F.
    """

    def __init__(self, approach: Law, slope: Law, integral: Law) -> None:
        self.approach, self.slope, self.integral = approach, slope, integral

    def force(self, delta: np.ndarray) -> np.ndarray:
        """F(delta), zero where delta is not above zero."""
        pressed = delta > 0.0
        wanted = np.where(pressed, delta, 1e-6)
        force = np.full(delta.shape, 1.0)
        # Left of the root a concave curve's tangents stay left of it: Newton climbs and cannot
        # overshoot.
        for _ in range(400):
            high = self.approach(force) > wanted
            if not high.any():
                break
            force = np.where(high, 0.1 * force, force)
        for _ in range(200):
            step = (wanted - self.approach(force)) / self.slope(force)
            force = force + np.maximum(step, -0.5 * force)
            if np.all(np.abs(step) <= 4e-16 * force):
                break
        return np.where(pressed, force, 0.0)

    def stiffness(self, force: np.ndarray) -> np.ndarray:
        """dF/d delta at F, zero where F is zero."""
        return np.where(force > 0.0, 1.0 / self.slope(np.where(force > 0.0, force, 1.0)), 0.0)

    def energy(self, delta: np.ndarray, force: np.ndarray) -> np.ndarray:
        """Work stored at delta: F delta less the complementary work."""
        safe = np.where(force > 0.0, force, 1.0)
        return np.where(force > 0.0, safe * delta - self.integral(safe), 0.0)


def palmgren(length: float, series: float = 0.0, softness: float = 1.0) -> Spring:
    """delta = 3.84e-5 F^0.9/L^0.8 mm (N, mm) and a compliance `series` (m/N) behind it.

    `softness` is how much softer than steel on steel the pair is.
    """
    a = softness * 3.84e-8 / (1e3 * length) ** 0.8
    return Spring(
        lambda F: a * F**0.9 + series * F,
        lambda F: 0.9 * a * F**-0.1 + series,
        lambda F: a * F**1.9 / 1.9 + 0.5 * series * F**2,
    )


def linear(stiffness: float | np.ndarray, series: float = 0.0) -> Spring:
    """F = k delta, with a compliance behind it."""
    c = 1.0 / np.asarray(stiffness) + series
    return Spring(lambda F: c * F, lambda F: c + 0.0 * F, lambda F: 0.5 * c * F**2)


def johnson(
    length: float,
    radius: np.ndarray,
    bodies: tuple[tuple[float, float, float], tuple[float, float, float]],
    series: float = 0.0,
) -> Spring:
    """Johnson (1985) eq. 5.57: each body (F/L)(1-nu^2)/(pi E) (2 ln(2 d/a) - nu/(1-nu)).

    `bodies` are (E, nu, depth d); `radius` is the equivalent radius of every contact.
    """
    (E1, nu1, d1), (E2, nu2, d2) = bodies
    s1, s2 = (1 - nu1**2) / E1, (1 - nu2**2) / E2
    # a^2 = 4 (F/L) R (s1 + s2)/pi, so delta = F (P - Q ln F).
    ring = 4.0 * np.asarray(radius) * (s1 + s2) / (np.pi * length)
    P = 0.0
    for s, nu, d in ((s1, nu1, d1), (s2, nu2, d2)):
        P = P + s / (np.pi * length) * (np.log(4.0 * d * d / ring) - nu / (1 - nu))
    Q = (s1 + s2) / (np.pi * length)
    return Spring(
        lambda F: F * (P + series - Q * np.log(F)),
        lambda F: P + series - Q - Q * np.log(F),
        lambda F: 0.5 * F**2 * (P + series + 0.5 * Q - Q * np.log(F)),
    )


@dataclass(frozen=True)
class Faults:
    """Part errors of one gearbox as plain arrays; missing ones are zero."""

    tooth_position: np.ndarray | float = 0.0
    tooth_radius: np.ndarray | float = 0.0
    disc_profile: np.ndarray | None = None
    hole_position: np.ndarray | float = 0.0
    hole_radius: np.ndarray | float = 0.0
    pin_position: np.ndarray | float = 0.0
    pin_radius: np.ndarray | float = 0.0
    cam_centre: np.ndarray | float = 0.0
    cam_play: np.ndarray | float = 0.0
    output_axis: np.ndarray | float = 0.0


@dataclass(frozen=True)
class Machine:
    """Everything the equilibrium needs, SI; springs are `Spring` values.

    `ring_spring` maps the equivalent radii (n+1,) of the contacts of one disc to their spring.
    `pin_springs` has one spring per disc. The cam spring is F = cam_stiffness d^cam_exponent
    beyond half its play.
    """

    disc: CycloidDisc
    disc_count: int
    pin_count: int
    pin_circle_radius: float
    clocking: float
    hole_radius: float
    pin_radius: float
    ring_spring: Callable[[np.ndarray], Spring]
    pin_springs: tuple[Spring, ...]
    cam_stiffness: float
    cam_exponent: float
    cam_play: float
    carrier_stiffness: float | None = None
    faults: Faults = field(default_factory=Faults)


@dataclass(frozen=True)
class Contacts:
    """Contacts of one disc at the nominal pose: complex plane numbers."""

    centre: complex
    ring_gap: np.ndarray
    ring_normal: np.ndarray
    ring_point: np.ndarray
    ring_parameter: np.ndarray
    ring_spring: Spring
    pin_gap: np.ndarray
    pin_normal: np.ndarray
    pin_point: np.ndarray
    cam_shift: complex
    half_play: float


@dataclass(frozen=True)
class Solution:
    """One solved state; axes as in the package's sweep without the angle."""

    ring_force: np.ndarray
    ring_normal: np.ndarray
    ring_point: np.ndarray
    ring_parameter: np.ndarray
    pin_force: np.ndarray
    pin_normal: np.ndarray
    pin_point: np.ndarray
    cam_force: np.ndarray
    displacement: np.ndarray
    gamma: float
    carrier_displacement: np.ndarray
    energy: float
    stiffness: float
    residual: float


def _plane(values: np.ndarray) -> np.ndarray:
    return np.stack([np.real(values), np.imag(values)], axis=-1)


def _complex(values: np.ndarray | float) -> np.ndarray | float:
    return values @ np.array([1.0, 1j]) if isinstance(values, np.ndarray) else values


def _of(values: np.ndarray | float, d: int) -> np.ndarray | float:
    return values[d] if isinstance(values, np.ndarray) else values


def build_contacts(machine: Machine, phi: float, d: int) -> Contacts:
    """All contacts of disc d at crank angle phi, at its nominal pose."""
    disc, faults = machine.disc, machine.faults
    n, e = disc.lobe_count, disc.eccentricity
    crank = phi + 2.0 * np.pi * d / machine.disc_count
    u = np.exp(1j * crank)
    centre, lobes = e * u, np.exp(-1j * crank / n)
    teeth = disc.ring_pitch_radius * np.exp(2j * np.pi * np.arange(n + 1) / (n + 1))
    foot = project(disc, _plane((teeth - centre) / lobes))
    outward = _complex(foot.normal) * lobes
    moved = _complex(faults.tooth_position)
    gap = foot.distance - disc.tooth_radius - faults.tooth_radius
    gap = gap + (np.conj(outward) * moved).real
    if faults.disc_profile is not None:
        cosine, sine = faults.disc_profile[d]
        order = np.outer(foot.parameter, 1 + np.arange(len(cosine)))
        gap = gap - np.cos(order) @ cosine - np.sin(order) @ sine
    kappa = disc.curvature(foot.parameter)
    radius = 1.0 / (1.0 / disc.tooth_radius + kappa)
    beta = (
        -phi / n
        + machine.clocking
        + 2.0 * np.pi * np.arange(machine.pin_count) / (machine.pin_count)
    )
    pins = machine.pin_circle_radius * np.exp(1j * beta)
    # The pin lies e behind the middle of its hole, seen along the crank.
    push = -u
    turned = np.exp(-1j * phi / n)
    apart = (_complex(faults.pin_position) - _complex(_of(faults.hole_position, d))) * turned
    # The carrier's axis stands in the housing, and half of its way off the shaft's does.
    axis = complex(_complex(faults.output_axis))
    apart = apart + axis
    pin_gap = (
        machine.hole_radius
        + _of(faults.hole_radius, d)
        - machine.pin_radius
        - faults.pin_radius
        - e
        - (np.conj(push) * apart).real
    ) + np.zeros(machine.pin_count)
    along = _of(faults.cam_centre, d)
    shift = complex(_complex(along)) * u if isinstance(along, np.ndarray) else 0j
    shift = shift + 0.5 * axis
    return Contacts(
        centre=complex(centre),
        ring_gap=gap,
        ring_normal=-outward,
        ring_point=_complex(foot.point) * lobes + centre,
        ring_parameter=foot.parameter,
        ring_spring=machine.ring_spring(radius),
        pin_gap=pin_gap,
        pin_normal=np.full(machine.pin_count, push),
        pin_point=pins + machine.pin_radius * push,
        cam_shift=shift,
        half_play=0.5 * (machine.cam_play + float(_of(faults.cam_play, d))),
    )


class Equilibrium:
    """Energy of one state and its derivatives, unknowns scaled to about one."""

    LENGTH, ANGLE = 1e-6, 1e-5

    def __init__(self, machine: Machine, phi: float, torque: float) -> None:
        self.machine, self.phi, self.torque = machine, phi, torque
        self.contacts = [build_contacts(machine, phi, d) for d in range(machine.disc_count)]
        D = machine.disc_count
        self.free = machine.carrier_stiffness is not None
        self.size = 3 * D + (3 if self.free else 1)
        self.scale = np.array(
            [self.LENGTH, self.LENGTH, self.ANGLE] * D
            + [self.ANGLE]
            + ([self.LENGTH] * 2 if self.free else [])
        )
        self.unit = max(abs(torque), 1e-12) * self.ANGLE
        self.rows = [self._rows(d) for d in range(D)]

    def _rows(self, d: int) -> tuple[np.ndarray, np.ndarray]:
        """Derivative of approach by the unknowns: ring (n+1, size), pins (N_w, size)."""
        c = self.contacts[d]
        ring = np.zeros((len(c.ring_gap), self.size))
        pins = np.zeros((len(c.pin_gap), self.size))
        for rows, normal, point in (
            (ring, c.ring_normal, c.ring_point),
            (pins, c.pin_normal, c.pin_point),
        ):
            # The force pushes the disc away; going against it is approach.
            rows[:, 3 * d] = -normal.real
            rows[:, 3 * d + 1] = -normal.imag
            rows[:, 3 * d + 2] = -(np.conj(point - c.centre) * normal).imag
        g = 3 * self.machine.disc_count
        pins[:, g] = (np.conj(c.pin_point) * c.pin_normal).imag
        if self.free:
            pins[:, g + 1], pins[:, g + 2] = c.pin_normal.real, c.pin_normal.imag
        return ring, pins

    def states(self, q: np.ndarray) -> list[tuple[np.ndarray, np.ndarray, complex]]:
        """Approach of ring and pins and offset in the cam bearing, for every disc."""
        out = []
        for d, c in enumerate(self.contacts):
            ring, pins = self.rows[d]
            offset = complex(q[3 * d], q[3 * d + 1]) - c.cam_shift
            out.append((ring @ q - c.ring_gap, pins @ q - c.pin_gap, offset))
        return out

    def evaluate(self, q: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
        """E - T gamma with gradient and Hessian, SI."""
        m = self.machine
        g = 3 * m.disc_count
        total = -self.torque * q[g]
        slope, bend = np.zeros(self.size), np.zeros((self.size, self.size))
        slope[g] -= self.torque
        for d, (ring, pins, offset) in enumerate(self.states(q)):
            c = self.contacts[d]
            for delta, spring, rows in (
                (ring, c.ring_spring, self.rows[d][0]),
                (pins, m.pin_springs[d], self.rows[d][1]),
            ):
                force = spring.force(delta)
                total += float(spring.energy(delta, force).sum())
                slope += rows.T @ force
                bend += rows.T @ (spring.stiffness(force)[:, None] * rows)
            far = abs(offset)
            over = far - c.half_play
            if over > 0.0:
                K, p = m.cam_stiffness, m.cam_exponent
                out = np.array([offset.real, offset.imag]) / far
                total += K * over ** (p + 1.0) / (p + 1.0)
                at = slice(3 * d, 3 * d + 2)
                slope[at] += K * over**p * out
                dyad = np.outer(out, out)
                bend[at, at] += K * p * over ** (p - 1.0) * dyad
                bend[at, at] += K * over**p / far * (np.eye(2) - dyad)
        if self.free:
            k = float(m.carrier_stiffness)  # type: ignore[arg-type]
            at = slice(g + 1, g + 3)
            total += 0.5 * k * float(q[at] @ q[at])
            slope[at] += k * q[at]
            bend[g + 1, g + 1] += k
            bend[g + 2, g + 2] += k
        return total, slope, bend

    def solve(self, start: np.ndarray | None = None) -> np.ndarray:
        """The minimum: trust-exact from rest, then the root of the gradient."""
        s, unit = self.scale, self.unit

        def value(z: np.ndarray) -> float:
            return self.evaluate(z * s)[0] / unit

        def gradient(z: np.ndarray) -> np.ndarray:
            return self.evaluate(z * s)[1] * s / unit

        def hessian(z: np.ndarray) -> np.ndarray:
            return self.evaluate(z * s)[2] * np.outer(s, s) / unit

        z = np.zeros(self.size) if start is None else start / s
        z = optimize.minimize(
            value,
            z,
            jac=gradient,
            hess=hessian,
            method="trust-exact",
            options={
                "gtol": 1e-8,
                "maxiter": 2000,
                "initial_trust_radius": 1.0,
                "max_trust_radius": 1e6,
            },
        ).x
        polished = optimize.root(gradient, z, jac=hessian, method="hybr", options={"xtol": 1e-15})
        if np.abs(gradient(polished.x)).max() < np.abs(gradient(z)).max():
            z = polished.x
        for _ in range(20):
            # A last few Newton steps where the two above stop short of rounding.
            step = np.linalg.lstsq(hessian(z), -gradient(z), rcond=1e-13)[0]
            better = np.abs(gradient(z + step)).max() < np.abs(gradient(z)).max()
            if not better:
                break
            z = z + step
        return z * s

    def result(self, q: np.ndarray) -> Solution:
        """Forces and the rest at unknowns q."""
        m = self.machine
        D, g = m.disc_count, 3 * m.disc_count
        energy, slope, bend = self.evaluate(q)
        ring, pins, cam = [], [], []
        for d, (approach, pin_approach, offset) in enumerate(self.states(q)):
            c = self.contacts[d]
            ring.append(c.ring_spring.force(approach))
            pins.append(m.pin_springs[d].force(pin_approach))
            over = abs(offset) - c.half_play
            pull = m.cam_stiffness * over**m.cam_exponent if over > 0.0 else 0.0
            cam.append(-pull * offset / abs(offset) if pull else 0j)
        unit = np.zeros(self.size)
        unit[g] = 1.0
        scaled = bend * np.outer(self.scale, self.scale)
        compliance = np.linalg.lstsq(scaled, unit * self.scale, rcond=1e-13)[0] @ (
            unit * self.scale
        )
        load = max(max((f.max() for f in ring), default=0.0), 1e-30)
        return Solution(
            ring_force=np.array(ring),
            ring_normal=_plane(np.array([c.ring_normal for c in self.contacts])),
            ring_point=_plane(np.array([c.ring_point for c in self.contacts])),
            ring_parameter=np.array([c.ring_parameter for c in self.contacts]),
            pin_force=np.array(pins),
            pin_normal=_plane(np.array([c.pin_normal for c in self.contacts])),
            pin_point=_plane(np.array([c.pin_point for c in self.contacts])),
            cam_force=_plane(np.array(cam)),
            displacement=q[:g].reshape(D, 3),
            gamma=float(q[g]),
            carrier_displacement=q[g + 1 : g + 3] if self.free else np.zeros(2),
            energy=energy,
            stiffness=1.0 / float(compliance) if compliance > 0.0 else 0.0,
            residual=float(np.abs(slope[:g].reshape(D, 3)[:, :2]).max() / load),
        )


def solve(machine: Machine, phi: float, torque: float, start: np.ndarray | None = None) -> Solution:
    """The equilibrium at one crank angle and torque (N m on the carrier, counter-clockwise)."""
    state = Equilibrium(machine, phi, torque)
    return state.result(state.solve(start))
